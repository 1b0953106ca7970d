#!/usr/bin/env python3
"""Writes the seed files for ply_fuzz, stl_fuzz, obj_fuzz and pcd_fuzz beside this script: a tetrahedron or a few
points in every kind of file that the readers know."""
import pathlib
import struct

HERE = pathlib.Path(__file__).parent
VERTICES = [(0, 0, 0), (40, 0, 0), (0, 40, 0), (0, 0, 40)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
NORMALS = [(-0.577, -0.577, -0.577), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def write(target, name, content):
    folder = HERE / target
    folder.mkdir(exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def ply_header(form, vertex, rest):
    return f"ply\nformat {form} 1.0\ncomment seed\n{vertex}{rest}end_header\n"


def ply():
    xyz = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    normals = "property float nx\nproperty float ny\nproperty float nz\n"
    face = "element face 4\nproperty list uchar int vertex_indices\n"
    rows = "".join(f"{x} {y} {z}\n" for x, y, z in VERTICES)
    write("ply_fuzz", "ascii.ply",
          ply_header("ascii", xyz, face) + rows + "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES))
    write("ply_fuzz", "quad.ply",
          ply_header("ascii", xyz, "element face 1\nproperty list uchar int vertex_index\n") + rows + "4 0 1 2 3\n")
    write("ply_fuzz", "cloud.ply", ply_header("ascii", xyz + normals, "").replace("\n", "\r\n") + "".join(
        " ".join(map(str, v + n)) + "\r\n" for v, n in zip(VERTICES, NORMALS)))
    strip = "element tristrips 1\nproperty list int int vertex_indices\n"
    write("ply_fuzz", "strip.ply", ply_header("ascii", xyz, strip) + rows + "8 0 2 1 3 -1 1 2 3\n")
    for form, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        body = b"".join(struct.pack(order + "6f", *v, *n) for v, n in zip(VERTICES, NORMALS))
        body += b"".join(struct.pack(order + "B3i", 3, *f) for f in FACES)
        write("ply_fuzz", form + ".ply", ply_header(form, xyz + normals, face).encode() + body)
    odd = ("element camera 1\nproperty list uchar double intrinsics\nproperty short id\n"
           "element vertex 4\nproperty uchar red\nproperty double z\nproperty double y\nproperty double x\n"
           "property list ushort float uv\n")
    body = struct.pack("<B2dh", 2, 500, 500, 7)
    body += b"".join(struct.pack("<B3dH2f", 9, z, y, x, 2, 0.5, 0.5) for x, y, z in VERTICES)
    body += b"".join(struct.pack("<B6fB3I", 6, *[0.5] * 6, 3, *f) for f in FACES)
    write("ply_fuzz", "odd.ply", ply_header(
        "binary_little_endian", odd,
        "element face 4\nproperty list uchar float texcoord\nproperty list uchar uint vertex_indices\n").encode() + body)


def stl():
    text = "solid seed\n"
    body = b""
    for face in FACES:
        corners = [VERTICES[i] for i in face]
        text += " facet normal 0 0 0\n  outer loop\n"
        text += "".join(f"   vertex {x}.0 {y} {z}e0\n" for x, y, z in corners)
        text += "  endloop\n endfacet\n"
        body += struct.pack("<12fH", 0, 0, 0, *[c for corner in corners for c in corner], 0)
    text += "endsolid seed\n"
    write("stl_fuzz", "ascii.stl", text)
    write("stl_fuzz", "upper.stl", text.upper() + text)
    write("stl_fuzz", "binary.stl", b"seed".ljust(80, b"\0") + struct.pack("<I", len(FACES)) + body)
    write("stl_fuzz", "solid_binary.stl", b"solid seed".ljust(80) + struct.pack("<I", len(FACES)) + body)


def obj():
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES)
    normals = "".join(f"vn {x} {y} {z}\n" for x, y, z in NORMALS)
    write("obj_fuzz", "plain.obj", "# seed\n" + vertices + "".join(f"f {a+1} {b+1} {c+1}\n" for a, b, c in FACES))
    write("obj_fuzz", "full.obj", "mtllib a.mtl\no seed\n" + vertices + "vt 0 0\n" + normals + "usemtl m\ns off\n" +
          "".join(f"f {a+1}/1/{a+1} {b+1}/1/{b+1} {c+1}/1/{c+1}\n" for a, b, c in FACES))
    write("obj_fuzz", "normals.obj", vertices + normals + "f 1//1 2//2 3//3 4//4\n")
    write("obj_fuzz", "negative.obj", vertices + "f -4/1 -3 -2 -1\nf -4 \\\n -2 \\\n -3\n")


def lzf(data):
    """Literal runs only: enough for a seed."""
    return b"".join(bytes([len(data[i:i + 32]) - 1]) + data[i:i + 32] for i in range(0, len(data), 32))


def pcd():
    def header(fields, sizes, types, counts, data, points=4):
        return ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
                f"FIELDS {fields}\nSIZE {sizes}\nTYPE {types}\nCOUNT {counts}\nWIDTH {points}\nHEIGHT 1\n"
                f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA {data}\n")

    xyz = ("x y z", "4 4 4", "F F F", "1 1 1")
    full = ("x y z normal_x normal_y normal_z", "4 4 4 4 4 4", "F F F F F F", "1 1 1 1 1 1")
    odd = ("intensity x y z tag", "2 8 8 8 1", "U F F F I", "3 1 1 1 2")
    rows = [v + n for v, n in zip(VERTICES, NORMALS)]
    write("pcd_fuzz", "ascii.pcd",
          header(*xyz, "ascii", 5) + "".join(f"{x} {y} {z}\n" for x, y, z in VERTICES) + "nan nan nan\n")
    write("pcd_fuzz", "binary.pcd", header(*full, "binary").encode() + b"".join(struct.pack("<6f", *r) for r in rows))
    write("pcd_fuzz", "odd.pcd", header(*odd, "binary").encode() +
          b"".join(struct.pack("<3H3d2b", 1, 2, 3, *v, 4, 5) for v in VERTICES))
    columns = b"".join(struct.pack("<4f", *[row[i] for row in rows]) for i in range(6))
    packed = lzf(columns)
    write("pcd_fuzz", "compressed.pcd",
          header(*full, "binary_compressed").encode() + struct.pack("<II", len(packed), len(columns)) + packed)


for make in (ply, stl, obj, pcd):
    make()
