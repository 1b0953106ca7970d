#!/usr/bin/python3
"""Makes the sets on which the verdict's weights are fitted and checked (README.md beside this file).

make_sets.py FOLDER [--images 90] [--sets fit_a fit_b held_out fit_worn] [--program edgepose] [--phantom edgepose-phantom]
"""
import argparse
import json
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import objects
import solids
from png16 import read_png16
from scenes import Body, Pile, about_z, camera_at, random_rotation, rotation_between

SETS = {'fit_a': range(1, 9), 'fit_b': range(9, 17), 'held_out': range(17, 25), 'fit_worn': (2, 3, 5, 8, 11, 13, 14, 15)}
KINDS = ('alone', 'table', 'wall', 'clutter', 'heap')  # of image k: k mod 5
SENSORS = ('ideal', 'laser', 'structured_light', 'time_of_flight')
SENSOR_SHARES = (0.16, 0.24, 0.3, 0.3)
NEAREST = {'ideal': 150, 'laser': 150, 'structured_light': 310, 'time_of_flight': 260}  # [mm] that is measured
LEAST_VISIBLE = 0.15  # share of the silhouette; what shows less, to the sensor, is taken out of the scene
LEAST_PIXELS = 250


def noise_mm(sensor, distance, focal):
    """One sigma at `distance` mm, as the presets of `edgepose render` have it."""
    metres = distance / 1000
    return {'ideal': 0.0, 'laser': 0.25, 'structured_light': 0.088 * distance * metres / (focal * 0.075),
            'time_of_flight': 0.7 + 0.6 * metres * metres}[sensor]


def is_measurable(body, sensor, distance, focal, slack=1.0):
    """What the sensor shows too coarsely is no fair question (docs/matcher.md, known limits)."""
    return (noise_mm(sensor, distance, focal) < 0.011 * slack * body.diameter
            and focal * body.diameter / distance > 45 / slack)


def random_camera(rng):
    width, height = ((640, 480), (640, 576))[rng.integers(2)]
    focal = rng.uniform(480, 620) if height == 480 else rng.uniform(480, 540)
    return {'width': width, 'height': height, 'fx': round(focal, 3), 'fy': round(focal * rng.uniform(0.995, 1.005), 3),
            'cx': round((width - 1) / 2 + rng.normal(0, 6), 3), 'cy': round((height - 1) / 2 + rng.normal(0, 6), 3)}


def is_inside(camera, points, nearest):
    """All in the image, and none too near to be measured."""
    if (points[:, 2] < nearest).any(): return False
    u = camera['fx'] * points[:, 0] / points[:, 2] + camera['cx']
    v = camera['fy'] * points[:, 1] / points[:, 2] + camera['cy']
    across = (u > 4) & (u < camera['width'] - 5)
    return bool((across & (v > 4) & (v < camera['height'] - 5)).all())


# -- one scene of each kind: [(body or box name, rotation, position)] in the world, and the view ---------------


def alone(rng, bodies, index):
    """Nothing else in the image. Every other time the view is nearly along an axis of the object."""
    rotation = random_rotation(rng)
    if (index + index // 8) % 2:
        axis = np.eye(3)[rng.integers(3)] * rng.choice([-1, 1])
        tilt = rng.normal(size=3) * np.radians(3)
        away = np.array([-1, 0, 0]) + np.cross(tilt, [-1, 0, 0])
        rotation = rotation_between(axis, away / np.linalg.norm(away))
    return [(bodies[0], rotation, np.zeros(3))], [], (0.0, 0.0, rng.uniform(-np.pi, np.pi))


def spread(rng, bodies, radius, upright_share, pile):
    """Drops the bodies about the middle; None if one falls off the map."""
    placed = []
    for body in bodies:
        rotation = body.resting(rng) if rng.uniform() < upright_share else random_rotation(rng)
        away, angle = radius * np.sqrt(rng.uniform()), rng.uniform(0, 2 * np.pi)
        position = pile.drop(body, rotation, away * np.cos(angle), away * np.sin(angle))
        if position is None: return None
        placed.append((body, rotation, position))
    return placed


def table(rng, bodies, index):
    """At rest on a table, side by side."""
    for radius in np.linspace(40, 500, 40):
        placed = spread(rng, bodies, radius, 1, Pile())
        if placed and all((r @ b.hull.T).min(axis=1)[2] + p[2] < 6 for b, r, p in placed): break
    return placed, ['table'], (np.radians(rng.uniform(25, 88)), rng.uniform(0, 6.3), rng.normal(0, 0.15))


def wall(rng, bodies, index):
    """At rest on a floor, each a little or no way off a wall."""
    placed, left = [], 0.0
    for body in bodies:
        rotation = body.resting(rng)
        hull = body.hull @ rotation.T
        gap = rng.choice([0, rng.uniform(0, 15), rng.uniform(15, 120)])
        x = left - hull[:, 0].min()
        placed.append((body, rotation, np.array([x, -gap - hull[:, 1].max(), -hull[:, 2].min()])))
        left = x + hull[:, 0].max() + rng.uniform(2, 50)
    placed = [(b, r, p - [left / 2, 0, 0]) for b, r, p in placed]
    return placed, ['table', 'wall'], (np.radians(rng.uniform(3, 50)), np.radians(-90 + rng.uniform(-35, 35)),
                                       rng.normal(0, 0.1))


def clutter(rng, bodies, index):
    mean = np.mean([b.diameter for b in bodies])
    placed = spread(rng, bodies, mean * rng.uniform(0.5, 0.9), 0.7, Pile())
    return placed, ['table'], (np.radians(rng.uniform(15, 75)), rng.uniform(0, 6.3), rng.normal(0, 0.2))


def heap(rng, bodies, index):
    mean = np.mean([b.diameter for b in bodies])
    placed = spread(rng, bodies, mean * rng.uniform(0.3, 0.6), 0.5, Pile())
    return placed, ['table'], (np.radians(rng.uniform(10, 60)), rng.uniform(0, 6.3), rng.normal(0, 0.3))


ARRANGE = {'alone': alone, 'table': table, 'wall': wall, 'clutter': clutter, 'heap': heap}
OWN_BODIES = {'alone': (1, 1), 'table': (2, 4), 'wall': (2, 4), 'clutter': (5, 6), 'heap': (7, 7)}
FOREIGN_BODIES = {'alone': (0, 0), 'table': (0, 1), 'wall': (0, 1), 'clutter': (0, 2), 'heap': (0, 2)}
OCCLUDERS = {'alone': (0, 0), 'table': (0, 1), 'wall': (0, 1), 'clutter': (1, 2), 'heap': (1, 3)}


def arrange(rng, kind, index, models, distractors):
    """A scene whose objects are all in the image and large enough to be measured; None if the dice fell badly."""
    sensor, camera = SENSORS[rng.choice(4, p=SENSOR_SHARES)], random_camera(rng)
    distance = np.exp(rng.uniform(np.log(400), np.log(2000)))
    wanted = int(rng.integers(OWN_BODIES[kind][0], OWN_BODIES[kind][1] + 1))
    while True:
        fair = [m for m in models if is_measurable(m, sensor, distance, camera['fx'])]
        if len(fair) >= wanted: break
        distance *= 0.93
        if distance < 400: return None
    # Alone, every object has its turn.
    turn = models[(index // len(KINDS)) % len(models)]
    if kind == 'alone':
        fair = [turn] if turn in fair else fair
    rarely = np.array([m.diameter**-1.5 for m in fair])  # small ones are measurable in fewer images
    own = [fair[i] for i in rng.choice(len(fair), wanted, replace=False, p=rarely / rarely.sum())]
    foreign = [distractors[i] for i in
               rng.permutation(len(distractors))[:rng.integers(FOREIGN_BODIES[kind][0], FOREIGN_BODIES[kind][1] + 1)]]
    bodies = own + foreign
    bodies = [bodies[i] for i in rng.permutation(len(bodies))]
    placed, backdrop, (elevation, azimuth, roll) = ARRANGE[kind](rng, bodies, index // len(KINDS))
    if not placed: return None
    points = np.concatenate([b.hull @ r.T + p for b, r, p in placed if b in own])
    target = (points.min(axis=0) + points.max(axis=0)) / 2
    shift = rng.uniform(-0.25, 0.25, 2) if kind == 'alone' else rng.uniform(-0.05, 0.05, 2)
    for _ in range(30):
        rotation, translation = camera_at(target, elevation, azimuth, roll, distance)
        translation = translation + np.array([*(shift * distance), 0])
        if is_inside(camera, points @ rotation.T + translation, NEAREST[sensor]): break
        distance *= 1.06
        shift *= 0.9
    else: return None
    if distance > 2100 or not all(is_measurable(b, sensor, distance, camera['fx'], 1.25) for b in own): return None
    scene = [(b, rotation @ r, rotation @ p + translation) for b, r, p in placed]
    for _ in range(rng.integers(OCCLUDERS[kind][0], OCCLUDERS[kind][1] + 1)):
        scene.append(occluder(rng, [s for s in scene if s[0] in own], scene, distractors))
    back = [(name, rotation, rotation @ back_position(name, points, rng) + translation) for name in backdrop]
    return {'kind': kind, 'sensor': sensor, 'camera': camera, 'distance': distance, 'own': own, 'placed': scene,
            'backdrop': back}


def occluder(rng, own, scene, distractors):
    """A thing held between the camera and one of the objects, nearer than everything else."""
    body = distractors[rng.integers(len(distractors))]
    hidden, _, centre = own[rng.integers(len(own))]
    nearest = min(((b.hull @ r.T + t)[:, 2]).min() for b, r, t in scene)
    depth = max(220.0, nearest - 0.55 * body.diameter - rng.uniform(0, 60))
    aside = np.array([*rng.normal(0, 0.3 * hidden.diameter, 2), 0])
    return body, random_rotation(rng), (centre + aside) * depth / centre[2]


def back_position(name, points, rng):
    """Where the backdrop's own middle of its face goes: under the objects, or behind them (y = 0)."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    if name == 'wall': return np.array([middle[0], 0, 0])
    return np.array([middle[0] + rng.uniform(-150, 150), middle[1] + rng.uniform(-150, 150), 0])


# -- rendering ------------------------------------------------------------------------------------------------


def entry(path, number, rotation, translation):
    return {'cam_R_m2c': [float(x) for x in rotation.reshape(-1)], 'cam_t_m2c': [float(x) for x in translation],
            'obj_id': number, 'mesh': str(path)}


class Renderer:
    def __init__(self, program, folder, scene):
        self.program, self.folder, self.camera = program, folder, scene['camera']

    def render(self, items, output, sensor, seed, overlay=None):
        listing = self.folder / 'scene.json'
        listing.write_text(json.dumps({'0': items}))
        c = self.camera
        subprocess.run([self.program, 'render', '--scene', str(listing), '--threads', '1', '--sensor', sensor,
                        '--seed', str(seed), '--camera', f"{c['fx']},{c['fy']},{c['cx']},{c['cy']}",
                        '--size', f"{c['width']}x{c['height']}", '-o', str(output)]
                       + (['--overlay', str(overlay)] if overlay else []), check=True, stdout=subprocess.DEVNULL)

    def depth(self, items):
        """True depth in tenths of millimetres, far where nothing is."""
        self.render(items, self.folder / 'part.png', 'ideal', 0)
        depth = read_png16(self.folder / 'part.png').astype(np.int32)
        return np.where(depth > 0, depth, 1 << 30)


def visibilities(layers, others):
    """Of each layer: pixels in all, and the mask of those that nothing else hides."""
    result = []
    for i, layer in enumerate(layers):
        rest = np.min([others] + layers[:i] + layers[i + 1:], axis=0)
        there = layer < 1 << 30
        result.append((int(there.sum()), there & (layer <= rest)))
    return result


def bounding_box(mask):
    v, u = np.nonzero(mask)
    return [int(u.min()), int(v.min()), int(u.max() - u.min() + 1), int(v.max() - v.min() + 1)] if len(u) else [-1] * 4


def worn(body, folder, rng):
    """The body as it really is: no mesh is true to its object. A little larger or smaller, warped by about a
    hundredth of its diameter, and in every other case partly covered by a layer of something."""
    d = body.diameter
    vertices = body.vertices * (1 + rng.normal(0, 0.008))
    for _ in range(3):
        wave, phase = rng.normal(size=3) * 2 * np.pi / d, rng.uniform(0, 2 * np.pi, 3)
        vertices = vertices + 0.005 * d * np.sin((body.vertices @ wave)[:, None] + phase)
    triangles = body.triangles
    if rng.uniform() < 0.5:
        corners = vertices[triangles]
        normals = np.zeros_like(vertices)
        for k in range(3): np.add.at(normals, triangles[:, k], np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-9)[:, None]
        direction = rng.normal(size=3)
        side = corners.mean(axis=1) @ (direction / np.linalg.norm(direction))
        layer = vertices + rng.uniform(0.015, 0.05) * d * normals
        triangles = np.concatenate([triangles, triangles[side > np.quantile(side, rng.uniform(0.5, 0.85))] + len(vertices)])
        vertices = np.concatenate([vertices, layer])
    path = folder / f'worn_{body.number}.ply'
    solids.write_ply(path, vertices, triangles)
    return path


def make_image(job):
    """Renders image k of a set; returns what its JSON files say of it."""
    set_folder, set_number, k, seed, models, distractors, program, draw = job
    scratch = set_folder / 'scratch' / str(k)
    scratch.mkdir(parents=True, exist_ok=True)
    kind = KINDS[k % len(KINDS)]
    noise_seed = int(np.random.default_rng([seed, set_number, k]).integers(1 << 31))
    overlay = set_folder / 'overlays' / f'{k:06d}.png' if draw else None
    for attempt in range(1000):
        rng = np.random.default_rng([seed, set_number, k, attempt])
        scene = arrange(rng, kind, k, models, distractors)
        if not scene: continue
        renderer = Renderer(program, scratch, scene)
        own = [item for item in scene['placed'] if item[0] in scene['own']]
        foreign = [entry(b.path, 0, r, t) for b, r, t in scene['placed'] if b not in scene['own']]
        backdrop = [entry(set_folder / 'distractors' / f'{name}.ply', 0, r, t) for name, r, t in scene['backdrop']]
        path = {b.number: b.path for b, _, _ in own}
        if set_folder.name.endswith('worn'): path = {b.number: worn(b, scratch, rng) for b, _, _ in own}
        entries = [entry(path[b.number], b.number, r, t) for b, r, t in own]
        layers = [renderer.depth([e]) for e in entries]
        others = np.full_like(layers[0], 1 << 30)
        if foreign + backdrop: others = renderer.depth(foreign + backdrop)
        while entries:  # takes out what hardly shows; others may show more then
            renderer.render(entries + foreign + backdrop, scratch / 'scene.png', scene['sensor'], noise_seed, overlay)
            measured = read_png16(scratch / 'scene.png') > 0
            seen = visibilities(layers, others)
            shares = [(mask & measured).sum() / max(LEAST_PIXELS / LEAST_VISIBLE, count) for count, mask in seen]
            worst = int(np.argmin(shares))
            if shares[worst] >= LEAST_VISIBLE: break
            del entries[worst], layers[worst]
        if entries: break
    else: raise RuntimeError(f'image {k}: no arrangement fits')
    (scratch / 'scene.png').rename(set_folder / 'test' / '000001' / 'depth' / f'{k:06d}.png')
    info = [{'px_count_all': count, 'px_count_visib': int(mask.sum()), 'px_count_valid': int((mask & measured).sum()),
             'visib_fract': round(float(mask.sum() / count), 4), 'bbox_obj': bounding_box(layer < 1 << 30),
             'bbox_visib': bounding_box(mask)} for layer, (count, mask) in zip(layers, seen)]
    c = scene['camera']
    unit = json.loads((scratch / 'scene_camera.json').read_text())['depth_scale']
    camera = {'cam_K': [c['fx'], 0.0, c['cx'], 0.0, c['fy'], c['cy'], 0.0, 0.0, 1.0], 'depth_scale': unit,
              'width': c['width'], 'height': c['height']}
    truth = [{key: e[key] for key in ('cam_R_m2c', 'cam_t_m2c', 'obj_id')} for e in entries]
    note = {'kind': kind, 'sensor': scene['sensor'], 'distance_mm': round(scene['distance'], 1), 'attempt': attempt,
            'noise_seed': noise_seed, 'distractors': len(foreign)}
    for file in scratch.iterdir():
        file.unlink()
    scratch.rmdir()
    return k, truth, info, camera, note


# -- a whole set ----------------------------------------------------------------------------------------------


def model_info(number, vertices):
    name, _, continuous, discrete = objects.OBJECTS[number]
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    info = {'name': name, 'diameter': solids.diameter(vertices)}
    for k, letter in enumerate('xyz'):
        info[f'min_{letter}'], info[f'size_{letter}'] = float(low[k]), float(high[k] - low[k])
    if continuous: info['symmetries_continuous'] = [{'axis': axis, 'offset': [0, 0, 0]} for axis in continuous]
    if discrete:
        info['symmetries_discrete'] = [
            np.block([[r, np.zeros((3, 1))], [np.zeros((1, 3)), 1]]).reshape(-1).round(12).tolist() for r in discrete]
    return info


def make_models(folder, numbers, seed, phantom):
    (folder / 'models').mkdir(parents=True, exist_ok=True)
    (folder / 'distractors').mkdir(exist_ok=True)
    models, info = [], {}
    for number in numbers:
        vertices, triangles = objects.make_object(number, phantom)
        if not solids.is_closed(triangles): raise RuntimeError(f'object {number}: its mesh is not closed')
        path = folder / 'models' / f'obj_{number:06d}.ply'
        solids.write_ply(path, vertices, triangles)
        info[str(number)] = model_info(number, vertices)
        models.append(Body(number, path, vertices, triangles, info[str(number)]['diameter']))
        print(f"{folder.name}: {number} {info[str(number)]['name']}, {len(triangles)} triangles, "
              f"{info[str(number)]['diameter']:.1f} mm", flush=True)
    (folder / 'models' / 'models_info.json').write_text(json.dumps(info, indent=1))
    distractors = []
    for number, (vertices, triangles) in enumerate(objects.make_distractors(seed)):
        path = folder / 'distractors' / f'{number}.ply'
        solids.write_ply(path, vertices, triangles)
        distractors.append(Body(100 + number, path, vertices, triangles, solids.diameter(vertices)))
    # Their faces, not their middles, are at the origin.
    solids.write_ply(folder / 'distractors' / 'table.ply', *solids.block([1300, 1100, 25], low=[-650, -550, -25]))
    solids.write_ply(folder / 'distractors' / 'wall.ply', *solids.block([1600, 20, 1200], low=[-800, 0, -100]))
    return models, distractors


def write_json(path, content):
    """One line an image."""
    lines = [f' "{k}": {json.dumps(content[k])}' for k in sorted(content)]
    path.write_text('{\n' + ',\n'.join(lines) + '\n}\n')


def make_set(folder, name, options, pool):
    set_number = list(SETS).index(name)
    models, distractors = make_models(folder, SETS[name], [options.seed, 1000 + set_number], options.phantom)
    scene_folder = folder / 'test' / '000001'
    (scene_folder / 'depth').mkdir(parents=True, exist_ok=True)
    (folder / 'overlays').mkdir(exist_ok=True)
    jobs = [(folder, set_number, k, options.seed, models, distractors, options.program, k < options.overlays)
            for k in range(options.images)]
    files = {'scene_gt': {}, 'scene_gt_info': {}, 'scene_camera': {}, 'scene_notes': {}}
    for done, (k, *contents) in enumerate(pool.map(make_image, jobs)):
        for file, content in zip(files, contents):
            files[file][k] = content
        if done % 10 == 9: print(f'{name}: {done + 1} images', flush=True)
    for file, content in files.items():
        write_json(scene_folder / f'{file}.json', content)
    (folder / 'scratch').rmdir()
    instances = sum(len(t) for t in files['scene_gt'].values())
    shown = [i['visib_fract'] for t in files['scene_gt_info'].values() for i in t]
    print(f"{name}: {options.images} images, {instances} instances, {options.images * len(models) - instances} absent "
          f"pairs; visible share {min(shown):.2f} to {max(shown):.2f}, median {np.median(shown):.2f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=Path, help='the sets go here')
    parser.add_argument('--images', type=int, default=90, help='of each set')
    parser.add_argument('--sets', nargs='+', default=list(SETS), choices=list(SETS))
    parser.add_argument('--program', default='edgepose', help='the program edgepose')
    parser.add_argument('--phantom', default='edgepose-phantom', help='the program edgepose-phantom')
    parser.add_argument('--seed', type=int, default=1, help='of everything; the same seed gives the same sets')
    parser.add_argument('--overlays', type=int, default=20, help='draw outlines over that many first images of a set')
    parser.add_argument('--jobs', type=int, default=2, help='images at the same time')
    options = parser.parse_args()
    with ProcessPoolExecutor(options.jobs) as pool:
        for name in options.sets:
            make_set(options.folder.absolute() / name, name, options, pool)


if __name__ == '__main__':
    sys.exit(main())
