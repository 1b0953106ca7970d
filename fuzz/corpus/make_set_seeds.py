#!/usr/bin/env python3
"""Writes the first inputs of the fuzzers for depth images, cameras, test sets, results, plans and models."""
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).parent


def seed(target, name, content):
    folder = HERE / target
    folder.mkdir(exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(width, height, bits, colour, rows, extra=b"", interlace=0):
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, interlace)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(rows)) +
            chunk(b"IEND", b""))


def grey16(width, height, filter_type=0):
    row = lambda y: bytes([filter_type]) + b"".join(struct.pack(">H", 500 + 7 * x + y) for x in range(width))
    return b"".join(row(y) for y in range(height))


T = "depth_png_fuzz"
seed(T, "grey16.png", png(8, 6, 16, 0, grey16(8, 6)))
for f in range(1, 5):
    seed(T, f"filter{f}.png", png(5, 4, 16, 0, grey16(5, 4, f)))
seed(T, "text.png", png(3, 2, 16, 0, grey16(3, 2), chunk(b"tEXt", b"Comment\0depth") + chunk(b"zTXt", b"a\0\0" + zlib.compress(b"b" * 500))))
seed(T, "transparent.png", png(3, 2, 16, 0, grey16(3, 2), chunk(b"tRNS", b"\1\2") + chunk(b"gAMA", b"\0\0\xb1\x8f")))
seed(T, "interlaced.png", png(1, 1, 16, 0, grey16(1, 1), interlace=1))
seed(T, "zero.png", png(4, 4, 16, 0, bytes(9 * 4)))
seed(T, "grey8.png", png(4, 4, 8, 0, bytes(5 * 4)))
seed(T, "rgb.png", png(2, 2, 8, 2, bytes(7 * 2)))
seed(T, "huge.png", png(16384, 16384, 16, 0, b"\0"))
seed(T, "signature.png", b"\x89PNG\r\n\x1a\n")

K = "[600.5, 0, 320.25, 0, 601.5, 240.75, 0, 0, 1]"
CAMERAS = '{"0": {"cam_K": %s, "depth_scale": 0.1}, "3": {"cam_K": %s}}' % (K, K.replace("600.5", "700"))
T = "camera_fuzz"
seed(T, "numbers.txt", "600,601.5,320,240.25")
seed(T, "scene_camera.json", CAMERAS)
seed(T, "camera.json", '{"cx": 325.2, "cy": 242, "depth_scale": 0.5, "fx": 572.4, "fy": 573.5, "height": 480, "width": 640}')
seed(T, "calibration.yaml", "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: %s\n"
     "distortion_coefficients:\n  data: [0.1, 0, 0, 0, 0]\n" % K)
seed(T, "echo.yaml", 'header:\n  frame_id: "camera"\nheight: 480\nwidth: 640\nD: [0.0]\nK: %s\n---\n' % K)
seed(T, "block.yaml", "k:\n- 600\n- 0\n- 320\n- 0\n- 600\n- 240\n- 0\n- 0\n- 1\nd: []\n# remark\n")
seed(T, "anchors.yaml", "a: &x [1, 2]\nb: *x\n<<: {c: |\n  text\n}\n? {d: e}\n: !!str 'f'\n")

T = "bop_set_fuzz"
seed(T, "objects.json", 'o{"1": {"diameter": 50, "name": "a"}, "2": {"diameter": 120.5, "symmetries_discrete": '
     '[[-1,0,0,10,0,-1,0,20,0,0,1,0,0,0,0,1]]}, "3": {"diameter": 9, "symmetries_continuous": '
     '[{"axis": [0,0,2], "offset": [1,2,3]}]}}')
seed(T, "cameras.json", "c" + CAMERAS)
seed(T, "truth.json", 't{"0": [{"cam_R_m2c": [0,-1,0,1,0,0,0,0,1], "cam_t_m2c": [10,-20,800], "obj_id": 2}], "1": []}')
seed(T, "visibility.json", 'v{"0": [{"px_count_visib": 1200, "visib_fract": 0.75, "occlusion": 0.5}, {}]}')
seed(T, "pose.xf", "x0 -1 0 10\n1 0 0 -20\n0 0 1 -800\n0 0 0 1\n")

T = "bop_results_fuzz"
seed(T, "header.csv", "scene_id,im_id,obj_id,score,R,t,time\n1,12,5,0.75,0 -1 0 1 0 0 0 0 1,10 -20.5 800,0.125\n")
seed(T, "two.csv", "1,2,3,5e-1,1.0 0 0 0 1 0 0  0 1, 1 2 3e2,-1\r\n\r\n1,2,4,-3,1 0 0 0 1 0 0 0 1,0 0 0,0\n")

T = "drill_plan_fuzz"
TARGET = ('{"name": "%s", "entry_mm": [-14, 12.5, 8], "axis": [0, -2, 0], "depth_mm": 35, "diameter_mm": 3.5, '
          '"tolerance_mm": 1, "tolerance_deg": 3}')
seed(T, "plan.json", '{"model": "m", "model_diameter_mm": 93.5, "targets": [%s, %s]}' % (TARGET % "l", TARGET % "r"))
seed(T, "empty.json", '{"model": "m", "model_diameter_mm": 93.5, "targets": []}')

T = "model_file_fuzz"
seed(T, "raw", b"redgepose" + struct.pack("<IIQQ4d4I6d", 1, 5, 512, 0, .1, .02, .01, .02, 6, 0, 5, 0, *[0.] * 6))
seed(T, "sealed", b"s" + bytes(8) + struct.pack("<IIQQ4d4I6d", 0, 1, 0, 0, .1, .02, .01, .02, 1, 0, 0, 0, *[0.] * 6) + bytes(400))
seed(T, "patch", b"p" + b"".join(struct.pack("<IB", 2 * at + 1, 7) + bytes(8) for at in (24, 64, 128, 140)))
seed(T, "patch_far", b"p" + struct.pack("<IB", 20000, 3) + b"\xff" * 4 + struct.pack("<IB", 3000, 0) + b"\1")
