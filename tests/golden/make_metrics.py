#!/usr/bin/env python3
"""Writes metrics.txt: the metrics of small images by NumPy and SciPy.

The images are ratios of integers, so that tests/metrics makes the same bits.
usage: make_metrics.py > metrics.txt
"""
import numpy as np
from scipy import ndimage

SIZES = [(11, 11), (16, 12), (13, 40), (64, 48)]


def images(width, height):
    y, x = np.mgrid[0:height, 0:width].astype(np.int64)
    truth = (x * x + 3 * y * y + x * y) % 997
    estimate = (7 * truth + (x * 7919 + y * 104729) % 400) % 7979
    return (estimate.astype(np.float32) / np.float32(7979), truth.astype(np.float32) / np.float32(997))


def ssim(a, b, data_range):
    def mean(image):  # truncate: a radius of 5
        return ndimage.gaussian_filter(image, 1.5, truncate=3.5, mode="constant")[5:-5, 5:-5]

    c1, c2 = (0.01 * data_range) ** 2, (0.03 * data_range) ** 2
    ma, mb = mean(a), mean(b)
    va, vb, cov = mean(a * a) - ma**2, mean(b * b) - mb**2, mean(a * b) - ma * mb
    return np.mean((2 * ma * mb + c1) * (2 * cov + c2) / ((ma**2 + mb**2 + c1) * (va + vb + c2)))


def comparison(a, b, data_range):
    mse = np.mean((a - b) ** 2)
    return [10 * np.log10(data_range**2 / mse), np.mean(np.abs(a - b)), np.sqrt(mse), ssim(a, b, data_range),
            np.corrcoef(a.ravel(), b.ravel())[0, 1]]


def flow(image, width, height):
    """Jet: the left half (edges included); background: the last quarter of the columns."""
    dy, dx = np.gradient(image)
    jet, background = image[:, : width // 2], image[:, width - width // 4 :]
    return [np.hypot(dx, dy)[:, : width // 2].mean(), jet.mean() / background.mean(), background.std(),
            abs(jet.mean() - background.mean()) / np.sqrt(jet.var() + background.var())]


print("# width height range  psnr mae rmse ssim correlation  mgm sbr bns cnr")
for width, height in SIZES:
    for data_range in (1.0, 2.5):
        a, b = (image.astype(np.float64) for image in images(width, height))
        row = comparison(a, b, data_range) + flow(a, width, height)
        print(width, height, data_range, *(f"{value:.15g}" for value in row))
