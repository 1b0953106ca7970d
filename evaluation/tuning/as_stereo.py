#!/usr/bin/python3
"""Makes of a set what a stereo camera that matches windows would have seen of it: outlines grow by half a window
("foreground fattening"), surfaces are smoothed over it, errors are the same in whole patches, disparities are steps.

as_stereo.py SET NEW_SET [--seed 1]

The models and the truth stay as they are.
"""
import argparse
import json
import shutil
from pathlib import Path

import numpy as np
from scipy import ndimage

from png16 import read_png16, write_png16

BASELINE = 75.0  # mm
STEP = 1 / 8     # pixels of disparity


def as_stereo(depth_mm, focal, rng):
    """depth_mm: HxW, 0 where nothing was measured; the same back."""
    half = int(rng.integers(1, 4))  # window of 3, 5 or 7 pixels
    far = np.where(depth_mm > 0, depth_mm, np.inf)
    fattened = ndimage.minimum_filter(far, 2 * half + 1)
    smooth = ndimage.median_filter(np.where(np.isinf(fattened), 1e6, fattened), 2 * half + 1)
    seen = smooth < 1e5
    disparity = focal * BASELINE / np.where(seen, smooth, 1e3)
    patches = ndimage.gaussian_filter(rng.normal(size=depth_mm.shape), half + 1)
    disparity += rng.uniform(0.04, 0.14) * patches / patches.std()
    disparity = np.round(disparity / STEP) * STEP
    return np.where(seen & (disparity > 1), focal * BASELINE / np.maximum(disparity, 1), 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('set', type=Path)
    parser.add_argument('new_set', type=Path)
    parser.add_argument('--seed', type=int, default=1)
    options = parser.parse_args()
    shutil.copytree(options.set, options.new_set, ignore=shutil.ignore_patterns('overlays', 'distractors'))
    folder = options.new_set / 'test' / '000001'
    cameras = json.loads((folder / 'scene_camera.json').read_text())
    for image, camera in cameras.items():
        file = folder / 'depth' / f'{int(image):06d}.png'
        rng = np.random.default_rng([options.seed, int(image)])
        depth = as_stereo(read_png16(file) * camera['depth_scale'], camera['cam_K'][0], rng)
        write_png16(file, np.minimum(np.round(depth / camera['depth_scale']), 65535).astype(np.uint16))


if __name__ == '__main__':
    main()
