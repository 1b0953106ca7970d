"""Where things stand: resting poses, heaps, cameras. World: millimetres, z up, the table's top at z = 0."""
import numpy as np

from solids import outermost, surface_points

GRID = 4.0  # [mm] of the height maps in which things are stacked
SPAN = 1600.0  # [mm] their side


def random_rotation(rng):
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def rotation_between(a, b):
    """The smallest rotation that takes direction a to b."""
    v, c = np.cross(a, b), float(np.dot(a, b))
    if c < -1 + 1e-9:
        side = np.eye(3)[np.argmin(np.abs(a))]
        n = np.cross(a, side) / np.linalg.norm(np.cross(a, side))
        return 2 * np.outer(n, n) - np.eye(3)
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + k + k @ k / (1 + c)


def about_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class Body:
    """A mesh with what placing it needs."""

    def __init__(self, number, path, vertices, triangles, diameter):
        rng = np.random.default_rng(number)
        self.number, self.path, self.diameter = number, path, diameter
        self.vertices, self.triangles = vertices, triangles
        self.hull = outermost(vertices, 1500)
        self.points = surface_points(vertices, triangles, 25000, rng)
        self.centre = self.points.mean(axis=0)

    def resting(self, rng):
        """A rotation in which it lies still: rolled downhill from a random one until its centre is lowest."""
        down = rng.normal(size=3)
        down /= np.linalg.norm(down)

        def height(d):
            return (self.hull @ d).max() - self.centre @ d

        lowest, step = height(down), 0.5
        while step > 2e-4:
            tries = down + step * rng.normal(size=(16, 3))
            tries /= np.linalg.norm(tries, axis=1)[:, None]
            heights = (self.hull @ tries.T).max(axis=0) - tries @ self.centre
            best = np.argmin(heights)
            if heights[best] < lowest - 1e-9: down, lowest = tries[best], heights[best]
            else: step /= 2
        return about_z(rng.uniform(0, 2 * np.pi)) @ rotation_between(down, np.array([0, 0, -1.0]))


class Pile:
    """Things dropped straight down onto what lies there already."""

    def __init__(self):
        side = int(SPAN / GRID)
        self.top, self.side = np.zeros((side, side)), side

    def drop(self, body, rotation, x, y):
        """The position at which it touches, never overlapping; the pile then includes it."""
        p = body.points @ rotation.T
        cells = np.floor((p[:, :2] + [x, y] + SPAN / 2) / GRID).astype(int)
        if (cells < 0).any() or (cells >= self.side).any(): return None
        flat = cells @ [self.side, 1]
        under, over = np.full(self.side**2, np.inf), np.full(self.side**2, -np.inf)
        np.minimum.at(under, flat, p[:, 2])
        np.maximum.at(over, flat, p[:, 2])
        used = np.isfinite(under)
        top = self.top.reshape(-1)
        z = (top[used] - under[used]).max()
        top[used] = np.maximum(top[used], over[used] + z)
        return np.array([x, y, z])


def camera_at(target, elevation, azimuth, roll, distance):
    """Rotation and translation from the world to a camera that looks at the target: x right, y down."""
    ahead = -np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])  # level, whatever the elevation
    rotation = about_z(roll) @ np.stack([right, np.cross(ahead, right), ahead])
    return rotation, -rotation @ (np.asarray(target) - distance * ahead)
