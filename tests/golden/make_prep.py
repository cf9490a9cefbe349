#!/usr/bin/env python3
"""Writes prep.txt: an image under similarity transforms, by SciPy's cubic splines in double precision.

The image is made of ratios of integers, so that tests/prep makes the same bits.
usage: make_prep.py > prep.txt
"""
import numpy as np
from scipy import ndimage

WIDTH, HEIGHT = 29, 22
TRANSFORMS = [(0.25, -0.5, 1, 0), (1.3, -2.7, 1.02, 0.03), (-4.75, 3.1, 0.9, -0.4), (0, 0, 1, 1.5707963267948966)]


def image():
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.int64)
    return ((x * x + 3 * y * y + x * y) % 97).astype(np.float32) / np.float32(97)


print("# shift_x shift_y magnification rotation, then", HEIGHT, "rows of", WIDTH)
for shift_x, shift_y, magnification, rotation in TRANSFORMS:
    c, s = magnification * np.cos(rotation), magnification * np.sin(rotation)
    matrix = np.array([[c, s], [-s, c]])  # (y, x)
    centre = np.array([(HEIGHT - 1) / 2, (WIDTH - 1) / 2])
    offset = centre + (shift_y, shift_x) - matrix @ centre
    out = ndimage.affine_transform(image().astype(np.float64), matrix, offset, order=3, mode="reflect")
    print(shift_x, shift_y, magnification, rotation)
    for row in out:
        print(*(f"{value:.7f}" for value in row))
