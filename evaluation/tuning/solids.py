"""Closed meshes in millimetres: low-polygon primitives as a CAD program exports them, and solids given by a signed
distance (negative inside), meshed by dual contouring, which keeps sharp edges and always closes the surface."""
import numpy as np

# -- signed distances: each takes points (n, 3) and returns (n,) ------------------------------------------------


def at(part, origin=(0, 0, 0), turn=np.eye(3)):
    """`part`, turned and then moved."""
    origin, turn = np.asarray(origin, float), np.asarray(turn, float)
    return lambda p: part((p - origin) @ turn)


def box(half, rounding=0.0):
    half = np.asarray(half, float) - rounding

    def distance(p):
        q = np.abs(p) - half
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0) - rounding

    return distance


def ball(radius):
    return lambda p: np.linalg.norm(p, axis=1) - radius


def ellipsoid(radii):
    radii = np.asarray(radii, float)

    def distance(p):
        k0, k1 = np.linalg.norm(p / radii, axis=1), np.linalg.norm(p / radii**2, axis=1)
        return k0 * (k0 - 1) / np.maximum(k1, 1e-9)

    return distance


def rod(radius, half, axis=2):
    """A cylinder along a coordinate axis."""

    def distance(p):
        around = np.delete(p, axis, axis=1)
        q = np.stack([np.linalg.norm(around, axis=1) - radius, np.abs(p[:, axis]) - half], axis=1)
        return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)

    return distance


def capsule(a, b, radius_a, radius_b=None):
    """A rounded bar from a to b; its radius changes evenly."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    radius_b = radius_a if radius_b is None else radius_b

    def distance(p):
        share = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        return np.linalg.norm(p - a - share[:, None] * (b - a), axis=1) - radius_a - share * (radius_b - radius_a)

    return distance


def ring(radius, tube, axis=2):
    def distance(p):
        around = np.linalg.norm(np.delete(p, axis, axis=1), axis=1)
        return np.hypot(around - radius, p[:, axis]) - tube

    return distance


def prism(corners, apothem, half):
    """A regular prism along z."""
    angles = 2 * np.pi * np.arange(corners) / corners
    sides = np.stack([np.cos(angles), np.sin(angles)])
    return lambda p: np.maximum((p[:, :2] @ sides).max(axis=1) - apothem, np.abs(p[:, 2]) - half)


def below(normal, offset):
    """The half space n x < offset."""
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    return lambda p: p @ normal - offset


def union(*parts):
    return lambda p: np.min([part(p) for part in parts], axis=0)


def common(*parts):
    return lambda p: np.max([part(p) for part in parts], axis=0)


def cut(part, *holes):
    return lambda p: np.maximum(part(p), -np.min([hole(p) for hole in holes], axis=0))


def blend(width, *parts):
    """A union whose joints are filled, as clay is."""

    def distance(p):
        result = parts[0](p)
        for part in parts[1:]:
            other = part(p)
            h = np.maximum(width - np.abs(result - other), 0) / width
            result = np.minimum(result, other) - h * h * width / 4
        return result

    return distance


def bumpy(part, height, wavelength, seed):
    """`part` with low-frequency relief: waves in random directions."""
    rng = np.random.default_rng(seed)
    waves = [(wave / np.linalg.norm(wave) * 2 * np.pi / (wavelength * rng.uniform(0.7, 1.6)), rng.uniform(0, 2 * np.pi))
             for wave in rng.normal(size=(8, 3))]
    return lambda p: part(p) - height / 3 * sum(np.sin(p @ wave + phase) for wave, phase in waves)


# -- meshes: (vertices (n, 3), triangles (m, 3)), counter-clockwise seen from outside ------------------------------


def dual_contour(solid, low, high, cells=90):
    """The surface where `solid` is 0, with about `cells` cells along the box's diagonal."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    step = np.linalg.norm(high - low) / cells
    low = low - 2.37 * step  # off the faces of what is given by round numbers
    counts = np.ceil((high + 2 * step - low) / step).astype(int) + 1
    grid = [low[k] + step * np.arange(counts[k]) for k in range(3)]
    values = np.concatenate([
        solid(np.stack(np.meshgrid([x], grid[1], grid[2], indexing='ij'), axis=-1).reshape(-1, 3)) for x in grid[0]
    ]).reshape(counts)
    strides = np.array([counts[1] * counts[2], counts[2], 1])
    cell_of, quads, points = [], [], []
    for axis in range(3):
        first = np.moveaxis(values, axis, 0)[:-1]
        second = np.moveaxis(values, axis, 0)[1:]
        found = np.argwhere((first < 0) != (second < 0))
        found = np.insert(found[:, 1:], axis, found[:, 0], axis=1)
        side_1, side_2 = strides[(axis + 1) % 3], strides[(axis + 2) % 3]
        start = found @ strides
        around = np.stack([start, start - side_1, start - side_1 - side_2, start - side_2], axis=1)
        leaves = values.reshape(-1)[start] < 0  # the edge leaves the solid: the quad faces along the axis
        quads.append(np.where(leaves[:, None], around, around[:, ::-1]))
        cell_of.append(around)
        points.append(crossings(solid, low + step * found, axis, step))
    corner, quads, p = np.concatenate(cell_of), np.concatenate(quads), np.concatenate(points)
    vertices, numbers = cell_vertices(solid, p, corner, low, step, counts)
    return vertices, split_quads(vertices, numbers[quads])


def crossings(solid, start, axis, step):
    """Where grid edges meet the surface, by halving."""
    low, high = np.zeros(len(start)), np.full(len(start), step)
    inside = solid(start) < 0
    for _ in range(14):
        middle = (low + high) / 2
        p = start.copy()
        p[:, axis] += middle
        same = (solid(p) < 0) == inside
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    p = start.copy()
    p[:, axis] += (low + high) / 2
    return p


def cell_vertices(solid, p, corner, low, step, counts):
    """One vertex a cell: nearest to the tangent planes of its crossings, held to the cell."""
    h = 1e-3 * step
    normals = np.stack([solid(p + h * e) - solid(p - h * e) for e in np.eye(3)], axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    cells, index = np.unique(corner, return_inverse=True)
    index = index.reshape(corner.shape)
    flat, repeat = index.reshape(-1), corner.shape[1]

    def total(values):
        return np.bincount(flat, np.repeat(values, repeat), len(cells))

    count = total(np.ones(len(p)))
    mean = np.stack([total(p[:, k]) for k in range(3)], axis=1) / count[:, None]
    squares = np.stack([total(normals[:, i] * normals[:, j]) for i in range(3) for j in range(3)], axis=1)
    offset = np.einsum('ij,ij->i', normals, p)
    right = np.stack([total(normals[:, k] * offset) for k in range(3)], axis=1)
    left = squares.reshape(-1, 3, 3)
    right -= np.einsum('nij,nj->ni', left, mean)
    vertices = mean + np.linalg.solve(left + 0.01 * count[:, None, None] * np.eye(3), right[..., None])[..., 0]
    origin = low + step * np.stack(np.unravel_index(cells, counts), axis=1)
    numbers = np.zeros(int(np.prod(counts)), int)
    numbers[cells] = np.arange(len(cells))
    return np.clip(vertices, origin + 0.01 * step, origin + 0.99 * step), numbers


def split_quads(vertices, quads):
    a, b, c, d = (vertices[quads[:, k]] for k in range(4))
    short = (np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1))[:, None]
    one = np.where(short, quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    two = np.where(short, quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.concatenate([one, two])


def revolve(profile, sides=64):
    """(radius, z) pairs from bottom to top, turned about z; ends with radius 0 or are closed by a flat face."""
    profile = [(float(r), float(z)) for r, z in profile]
    if profile[0][0] > 0: profile.insert(0, (0.0, profile[0][1]))
    if profile[-1][0] > 0: profile.append((0.0, profile[-1][1]))
    angles = 2 * np.pi * np.arange(sides) / sides
    vertices = [np.array([[0, 0, profile[0][1]]])]
    for r, z in profile[1:-1]:
        vertices.append(np.stack([r * np.cos(angles), r * np.sin(angles), np.full(sides, z)], axis=1))
    vertices.append(np.array([[0, 0, profile[-1][1]]]))
    i, j = np.arange(sides), (np.arange(sides) + 1) % sides
    rings = len(profile) - 2
    triangles = [np.stack([np.zeros(sides, int), 1 + j, 1 + i], axis=1)]
    for k in range(rings - 1):
        here, above = 1 + k * sides, 1 + (k + 1) * sides
        triangles.append(np.stack([here + i, here + j, above + j], axis=1))
        triangles.append(np.stack([here + i, above + j, above + i], axis=1))
    last = 1 + (rings - 1) * sides
    triangles.append(np.stack([last + i, last + j, np.full(sides, 1 + rings * sides)], axis=1))
    return np.concatenate(vertices), np.concatenate(triangles)


def block(size, low=None):
    """A box of 12 triangles, about the origin or from the corner `low`."""
    size = np.asarray(size, float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size
    corners = corners - size / 2 if low is None else corners + low
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def doughnut(radius, tube, around=96, across=32):
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing='ij')
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    r = radius + tube * np.cos(b)
    vertices = np.stack([r * np.cos(a), r * np.sin(a), tube * np.sin(b)], axis=-1).reshape(-1, 3)

    def number(i, j):
        return ((i % around) * across + j % across).reshape(-1)

    corners = [number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)]
    return vertices, np.concatenate([np.stack([corners[0], corners[1], corners[2]], axis=1),
                                     np.stack([corners[0], corners[2], corners[3]], axis=1)])


# -- what one asks of a mesh ------------------------------------------------------------------------------------


def outermost(vertices, directions=4000, seed=0):
    """The vertices farthest in some direction: enough for extents, diameters and where the body rests."""
    rng = np.random.default_rng(seed)
    chosen = [np.argmax(vertices @ d) for d in rng.normal(size=(directions, 3))]
    return vertices[np.unique(chosen)]


def diameter(vertices):
    """Largest distance between two points."""
    p = outermost(vertices)
    return float(np.sqrt(max(((p - q)**2).sum(axis=1).max() for q in p)))


def volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum('ij,ij->', a, np.cross(b, c)) / 6)


def is_closed(triangles):
    """Every edge is used as often in one direction as in the other."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    size = int(triangles.max()) + 1
    return np.array_equal(np.sort(edges[:, 0] * size + edges[:, 1]), np.sort(edges[:, 1] * size + edges[:, 0]))


def surface_points(vertices, triangles, count, rng):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    pick = rng.choice(len(triangles), count, p=area / area.sum())
    u, v = rng.uniform(size=(2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[pick] + u * (b - a)[pick] + v * (c - a)[pick]


def write_ply(path, vertices, triangles):
    rows = np.zeros(len(triangles), [('n', 'u1'), ('v', '<i4', 3)])
    rows['n'], rows['v'] = 3, triangles
    with open(path, 'wb') as file:
        file.write((f'ply\nformat binary_little_endian 1.0\ncomment unit: millimetre\n'
                    f'element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n'
                    f'element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n').encode())
        file.write(vertices.astype('<f4').tobytes())
        file.write(rows.tobytes())


def read_ply(path):
    """A binary triangle PLY whose vertices have float properties only, as this project writes them."""
    with open(path, 'rb') as file:
        header = []
        while not header or header[-1] != 'end_header':
            header.append(file.readline().decode().strip())
        counts = [int(line.split()[-1]) for line in header if line.startswith('element')]
        floats = sum(line.startswith('property float') for line in header)
        vertices = np.frombuffer(file.read(4 * floats * counts[0]), '<f4').reshape(-1, floats)[:, :3]
        triangles = np.frombuffer(file.read(13 * counts[1]), [('n', 'u1'), ('v', '<i4', 3)])['v']
    return vertices.astype(float), triangles.copy()
