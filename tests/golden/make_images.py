#!/usr/bin/python3
"""Writes the images that tests/io reads: by NumPy, PIL, tifffile, h5py, and a PNG encoder of its own.

Pixel (x, y) of frame t holds f = x + 10 y + 50 t (0 .. 146), 7 x 5 pixels, 3 frames; signed types hold
f - 20, floating-point types f / 2 - 20.  Usage: make_images.py [FOLDER]
"""
import pathlib
import struct
import sys
import zlib

import h5py
import numpy as np
import tifffile
from PIL import Image

OUT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "images")
T, H, W = 3, 5, 7
t, y, x = np.mgrid[:T, :H, :W]
F = x + 10 * y + 50 * t


def stack(dtype):
    kind = np.dtype(dtype).kind
    values = {"u": F, "i": F - 20, "f": F / 2 - 20}[kind]
    return values.astype(dtype)


def write_npy():
    for kind in ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"]:
        np.save(OUT / f"{kind}.npy", stack("<" + kind))
        if kind[1] != "1":
            np.save(OUT / f"{kind}_big.npy", stack(">" + kind))
    np.save(OUT / "one_frame.npy", stack("<f4")[0])
    for version in (2, 3):
        with open(OUT / f"version{version}.npy", "wb") as file:
            np.lib.format.write_array(file, stack("<u2"), version=(version, 0))
    np.save(OUT / "bad_fortran.npy", np.asfortranarray(stack("<f4")[0]))
    np.save(OUT / "bad_rank.npy", np.arange(4.0))
    np.save(OUT / "bad_complex.npy", stack("<f4").astype("<c8"))
    np.save(OUT / "bad_struct.npy", np.zeros((2, 2), [("shape", "<f4"), ("b", "<i4")]))
    np.save(OUT / "bad_empty.npy", np.zeros((0, 5, 7), "<f4"))
    frames = stack("<f4")
    frames[1, 2, 3] = np.nan
    np.save(OUT / "bad_nan.npy", frames)


def chunk(kind, data):
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def packed(image, depth):
    """Rows of samples (H, W * channels) as PNG scan lines without filter."""
    lines = b""
    for row in image:
        bits = np.unpackbits(row.astype(">u2").view("u1").reshape(-1, 2), axis=1)[:, 16 - depth:]
        lines += b"\0" + np.packbits(bits.ravel()).tobytes()
    return lines


def png(name, image, depth, colour=0, extra=b"", interlaced=False, channels=1):
    pixels = image.reshape(H, W, channels)
    if interlaced:
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
        parts = [pixels[y0::dy, x0::dx] for x0, y0, dx, dy in passes]
    else:
        parts = [pixels]
    lines = b"".join(packed(p.reshape(p.shape[0], -1), depth) for p in parts if p.size)
    header = struct.pack(">IIBBBBB", W, H, depth, colour, 0, 0, interlaced)
    (OUT / name).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra +
                             chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def write_png():
    f = F[0]
    for depth in (1, 2, 4, 8, 16):
        png(f"grey{depth}.png", f % 2**depth, depth)
    png("interlaced.png", f, 8, interlaced=True)
    png("interlaced16.png", f, 16, interlaced=True)
    grey_palette = chunk(b"PLTE", bytes(v for i in range(64) for v in (i, i, i)))
    png("palette.png", f, 8, 3, grey_palette)
    png("bad_palette.png", f, 8, 3, chunk(b"PLTE", bytes(v for i in range(64) for v in (i, 0, 0))))
    png("opaque.png", np.stack([f, f * 0 + 255], -1), 8, 4, channels=2)
    png("bad_alpha.png", np.stack([f, f + 100], -1), 8, 4, channels=2)
    png("bad_key.png", f, 8, 0, chunk(b"tRNS", b"\0\x17"))
    Image.fromarray(np.stack([f] * 3, -1).astype("u1")).save(OUT / "rgb_grey.png")
    Image.fromarray(np.stack([f, f, f + 1], -1).astype("u1")).save(OUT / "bad_colour.png")
    Image.fromarray(f.astype("<u2")).save(OUT / "pil16.png")


def write_tiff():
    def save(name, data, **options):
        tifffile.imwrite(OUT / name, data, photometric=options.pop("photometric", "minisblack"),
                         metadata=options.pop("metadata", None), datetime=None, software=None, **options)

    for kind in ["u1", "u2", "i2", "u4", "f4", "f8"]:
        save(f"{kind}.tif", stack("<" + kind))
    save("big_endian.tif", stack(">u2"), byteorder=">")
    save("bigtiff.tif", stack("<f4"), bigtiff=True)
    save("bigtiff_big_endian.tif", stack(">f4"), bigtiff=True, byteorder=">")
    save("strips.tif", stack("<u2"), rowsperstrip=2)
    save("tiles.tif", stack("<u2"), tile=(16, 16))
    save("deflate.tif", stack("<u2"), compression="zlib", predictor=False)
    save("imagej.tif", stack("<f4"), imagej=True, resolution=(0.5, 0.5),
         metadata={"axes": "TYX", "unit": "um", "finterval": 0.25})
    Image.fromarray(F[0].astype("u1")).save(OUT / "lzw.tif", compression="tiff_lzw")
    save("bad_white.tif", stack("<u1"), photometric="miniswhite")
    save("bad_rgb.tif", np.stack([F[0]] * 3, -1).astype("u1"), photometric="rgb")
    with tifffile.TiffWriter(OUT / "bad_pages.tif") as tiff:
        tiff.write(F[0].astype("u1"), photometric="minisblack", metadata=None)
        tiff.write(F[0, :4].astype("u1"), photometric="minisblack", metadata=None)


def write_hdf5():
    def create(name, **options):
        return h5py.File(OUT / name, "w", **options)

    with create("only.h5") as f:
        f.create_dataset("deep/frames", data=stack("<u2"), chunks=(2, 3, 4), compression="gzip")
        f.create_dataset("deep/times", data=np.arange(3.0))
        f["names"] = "text"
    with create("block.h5", userblock_size=512) as f:
        f["frame"] = stack(">f8")[0]
    with create("nexus.h5") as f:
        f.attrs["default"] = "entry"
        f.create_group("entry").attrs["default"] = "plot"
        plot = f.create_group("entry/plot")
        plot.attrs["signal"] = "phase"
        plot["phase"] = stack("<f4")
        plot["phase"].attrs["units"] = "rad"
        plot["other"] = stack("<f4") + 1
        plot["x"] = np.arange(W) * 2.0
        plot["x"].attrs["units"] = np.bytes_("um")
        plot["time"] = np.arange(T) * 0.5
        plot["time"].attrs["units"] = "ms"
    with create("several.h5") as f:
        f["plus"] = stack("<u1")
        f["minus"] = stack("<i4")
        f["link"] = h5py.SoftLink("/plus")
        f["line"] = np.arange(5)
        f["volume"] = np.zeros((2, 2, 2, 2))
    with create("bad_none.h5") as f:
        f["line"] = np.arange(5)


OUT.mkdir(exist_ok=True)
write_npy()
write_png()
write_tiff()
write_hdf5()
