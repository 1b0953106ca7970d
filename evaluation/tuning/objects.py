"""The 24 objects: what they are, how they are made, and their symmetries as BOP declares them."""
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from solids import (at, ball, bumpy, below, blend, block, box, capsule, common, cut, doughnut, dual_contour,
                    ellipsoid, prism, read_ply, revolve, ring, rod, union)


def turn(axis, degrees):
    """Rotation about a coordinate axis."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


AROUND_Z = [[0, 0, 1]]
FLIP = [turn(0, 180)]


def turns(count, flips=False):
    """The rotations of a regular prism about z, the identity left out."""
    about = [turn(2, 360 * k / count) for k in range(count)]
    return about[1:] + ([t @ turn(0, 180) for t in about] if flips else [])


def cylinder():
    return revolve([(25, -55), (25, 55)])


def bracket():
    body = union(at(box([45, 30, 5]), (0, 0, 5)), at(box([5, 30, 30]), (-40, 0, 30)),
                 common(at(box([14, 4, 14]), (-21, 18, 24)), below([1, 0, 1], (-7 + 10) / np.sqrt(2))))
    return dual_contour(cut(body, at(rod(6, 20), (15, 12, 5)), at(rod(6, 20), (30, -14, 5)),
                            at(rod(9, 20, axis=0), (-40, -8, 40))), (-45, -30, 0), (45, 30, 60))


def pebble():
    shape = blend(25, ellipsoid([58, 46, 40]), at(ball(26), (38, 20, 22)))
    return dual_contour(bumpy(shape, 9, 75, seed=3), (-80, -70, -62), (88, 74, 68))


def mug():
    body = cut(rod(42, 48), at(rod(38, 48), (0, 0, 5)))
    handle = cut(at(ring(27, 6, axis=1), (44, 0, 2)), rod(40, 60))
    return dual_contour(union(body, handle), (-42, -42, -48), (78, 42, 48), cells=110)


def long_rod():
    return revolve([(9, -150), (9, 150)], sides=32)


def stepped_plate():
    body = union(at(box([80, 50, 6]), (0, 0, 6)), at(box([45, 50, 8]), (-35, 0, 14)),
                 at(box([22, 30, 12]), (-58, -20, 22)), at(box([10, 10, 10]), (55, 32, 14)))
    return dual_contour(cut(body, at(rod(12, 60), (45, -15, 0))), (-80, -50, 0), (80, 50, 36))


def torus():
    return doughnut(60, 17)


def statue():
    shape = blend(
        14, capsule((0, 0, 38), (0, 4, 95), 32, 22), at(ellipsoid([38, 22, 18]), (0, 4, 100)),
        at(ball(20), (0, -2, 142)),
        capsule((34, 4, 100), (44, -24, 62), 10, 8), capsule((-34, 4, 100), (-30, -36, 108), 10, 8),
        capsule((0, -18, 140), (0, -26, 134), 6, 4))
    return dual_contour(union(bumpy(shape, 3, 40, seed=8), at(rod(42, 8), (0, 0, 6))), (-66, -62, -4), (66, 52, 176))


def brick():
    return block([120, 80, 45])


def gear():
    def teeth(p):
        angle = np.arctan2(p[:, 1], p[:, 0])
        radius = 46 + 5 * np.clip(1.8 * np.cos(16 * angle), -1, 1)
        return np.maximum(0.8 * (np.hypot(p[:, 0], p[:, 1]) - radius), np.abs(p[:, 2]) - 8)

    body = union(teeth, at(rod(20, 14), (0, 0, 8)))
    return dual_contour(cut(body, rod(9, 60)), (-53, -53, -8), (53, 53, 22), cells=110)


def bottle():
    return revolve([(30, -110), (35, -106), (35, 20), (33, 38), (26, 56), (17, 70), (14, 80), (14, 98), (17, 99),
                    (17, 110)])


def tee():
    body = union(rod(22, 62), at(rod(20, 32, axis=0), (32, 0, 0)), at(rod(27, 7), (0, 0, 55)),
                 at(rod(27, 7), (0, 0, -55)))
    return dual_contour(cut(body, rod(16, 80), at(rod(14, 40, axis=0), (40, 0, 0))), (-27, -27, -62), (64, 27, 62),
                        cells=100)


def cone():
    return revolve([(50, -55), (50, -47), (6, 51), (3, 55)])


def spiky():
    rng = np.random.default_rng(14)
    arms = []
    for direction in ((1, 0.2, 0.3), (-0.5, 1, 0.1), (-0.4, -0.8, 0.6), (0.1, 0.3, -1), (0.3, 0.5, 0.9)):
        end = np.array(direction) / np.linalg.norm(direction) * rng.uniform(62, 92)
        arms.append(capsule((0, 0, 0), end, 18, rng.uniform(8, 15)))
    return dual_contour(bumpy(blend(18, ball(38), *arms), 4, 50, seed=14), (-90, -90, -100), (105, 95, 95), cells=110)


def vertebra(phantom_program):
    """The sample's vertebra phantom."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([phantom_program, folder], check=True, stdout=subprocess.DEVNULL)
        return read_ply(Path(folder) / 'phantom' / 'phantom.ply')


def spoon():
    bowl = cut(common(ellipsoid([36, 25, 16]), below([0, 0, 1], 2)), ellipsoid([33, 22, 13]))
    handle = blend(6, capsule((-33, 0, 0), (-90, 0, 12), 4, 4), capsule((-90, 0, 12), (-160, 0, 6), 4, 8))
    return dual_contour(union(bowl, handle), (-170, -26, -17), (37, 26, 22), cells=150)


def egg():
    u = np.linspace(-np.pi / 2, np.pi / 2, 40)
    vertices, triangles = revolve([(np.cos(a), np.sin(a)) if 0 < k < 39 else (0, np.sign(a)) for k, a in enumerate(u)])
    return vertices * [48, 40, 33], triangles


def hexagon():
    return revolve([(36, -34), (36, 34)], sides=6)


def channel():
    body = cut(box([75, 30, 25]), at(box([80, 24, 25]), (0, 0, 6)), at(box([80, 10, 25]), (0, 30, 32)),
               at(box([25, 10, 20]), (50, -30, 20)))
    return dual_contour(cut(body, at(rod(8, 60), (-40, 5, 0))), (-75, -30, -25), (75, 30, 25), cells=120)


def screw():
    profile = [(11, -50)]
    for k in range(11):
        profile += [(11, -50 + 6 * k + 1), (8.5, -50 + 6 * k + 3), (8.5, -50 + 6 * k + 4), (11, -50 + 6 * k + 6)]
    z, r = np.array([p[1] for p in profile]), np.array([p[0] for p in profile])

    def shank(p):
        return np.maximum(0.75 * (np.hypot(p[:, 0], p[:, 1]) - np.interp(p[:, 2], z, r)), np.abs(p[:, 2] + 10) - 40)

    head = common(at(prism(6, 19, 8), (0, 0, 38)), at(ball(34), (0, 0, 18)))
    return dual_contour(union(shank, head), (-22, -22, -50), (22, 22, 46), cells=110)


def half_shell():
    return dual_contour(cut(common(ball(62), below([0, 0, -1], 0)), ball(56)), (-62, -62, 0), (62, 62, 62), cells=100)


def animal():
    shape = blend(
        12, capsule((-55, 0, 62), (48, 0, 70), 27, 24), capsule((48, 0, 75), (78, 6, 108), 18, 13),
        at(ellipsoid([24, 14, 15]), (88, 8, 116)), capsule((45, 14, 60), (52, 18, 6), 11, 8),
        capsule((45, -14, 60), (40, -20, 6), 11, 8), capsule((-50, 16, 55), (-58, 18, 6), 12, 8),
        capsule((-50, -16, 55), (-44, -20, 6), 12, 8), capsule((-70, 0, 70), (-108, -14, 92), 9, 5))
    return dual_contour(bumpy(shape, 2.5, 35, seed=22), (-118, -42, -6), (116, 42, 136), cells=130)


def disc():
    return revolve([(65, -13), (65, 13)], sides=96)


def spanner():
    head = cut(at(rod(27, 7), (80, 0, 0)), at(box([26, 11, 20]), (98, 7, 0), turn(2, 22)))
    eye = cut(at(rod(21, 9), (-85, 0, 0)), at(prism(6, 12, 30), (-85, 0, 0)))
    return dual_contour(union(head, eye, at(box([72, 10, 4.5]))), (-106, -28, -9), (108, 28, 9), cells=130)


# name, maker, continuous axes, discrete rotations. Which sets they go to: make_sets.py.
OBJECTS = {
    1: ('cylinder', cylinder, AROUND_Z, FLIP),
    2: ('bracket', bracket, [], []),
    3: ('pebble', pebble, [], []),
    4: ('mug', mug, [], []),
    5: ('long_rod', long_rod, AROUND_Z, FLIP),
    6: ('stepped_plate', stepped_plate, [], []),
    7: ('torus', torus, AROUND_Z, FLIP),
    8: ('statue', statue, [], []),
    9: ('brick', brick, [], turns(2, flips=True)),
    10: ('gear', gear, [], turns(16)),
    11: ('bottle', bottle, AROUND_Z, []),
    12: ('tee', tee, [], FLIP),
    13: ('cone', cone, AROUND_Z, []),
    14: ('spiky', spiky, [], []),
    15: ('vertebra', None, [], []),
    16: ('spoon', spoon, [], []),
    17: ('egg', egg, [], turns(2, flips=True)),
    18: ('hexagon', hexagon, [], turns(6, flips=True)),
    19: ('channel', channel, [], []),
    20: ('screw', screw, [], turns(6)),
    21: ('half_shell', half_shell, AROUND_Z, []),
    22: ('animal', animal, [], []),
    23: ('disc', disc, AROUND_Z, FLIP),
    24: ('spanner', spanner, [], []),
}


TURNED = (10, 20)  # have their discrete symmetries about z
SCALES = {10: 0.7, 18: 0.75, 20: 0.65, 22: 1.45}


def make_object(number, phantom_program):
    """Vertices about the middle of their box (an axis of symmetry stays where it is), and triangles."""
    name, maker, continuous, discrete = OBJECTS[number]
    vertices, triangles = maker() if maker else vertebra(phantom_program)
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    if continuous or number in TURNED: middle[:2] = 0
    return (vertices - middle) * SCALES.get(number, 1), triangles


def make_distractors(seed):
    """Things that no model is of: planks, wedges, lumps, bent tubes, caps."""
    rng = np.random.default_rng(seed)
    length, radius = rng.uniform(70, 110), rng.uniform(9, 14)
    bend = length * rng.uniform(0.3, 0.8)
    wedge = common(box([40, 30, 25]), below([1, 0, 1.5], rng.uniform(2, 8)))
    return [
        block([rng.uniform(140, 220), rng.uniform(35, 60), rng.uniform(8, 16)]),
        dual_contour(wedge, (-40, -30, -25), (40, 30, 25), cells=60),
        dual_contour(bumpy(ellipsoid(rng.uniform(25, 45, 3)), 6, 60, int(rng.integers(1 << 30))), (-60, -60, -60),
                     (60, 60, 60), cells=90),
        dual_contour(blend(8, capsule((0, 0, 0), (length, 0, 0), radius), capsule((0, 0, 0), (0, bend, 0), radius)),
                     (-15, -15, -15), (length + 15, bend + 15, 15), cells=90),
        dual_contour(cut(common(ball(45), below([0, 0, 1], rng.uniform(-15, 10))), ball(40)), (-45, -45, -45),
                     (45, 45, 12), cells=80),
    ]
