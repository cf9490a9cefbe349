#!/usr/bin/python3
"""Writes small stacks as other programs store them, for tests/io: MATLAB v5, v7 and v7.3, OME, ImageJ's stacks behind
one directory, raw frames with a JSON file.

Pixel (x, y) of frame t holds f = x + 10 y + 50 t (0 .. 146), 7 x 5 pixels, 3 frames; signed types hold f - 20,
floating-point types f / 2 - 20.  Usage: make_containers.py [FOLDER]
"""
import json
import pathlib
import struct
import sys

import h5py
import numpy as np
import scipy.io
import tifffile

OUT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "containers")
T, H, W = 3, 5, 7
t, y, x = np.mgrid[:T, :H, :W]
F = x + 10 * y + 50 * t


def stack(dtype):
    kind = np.dtype(dtype).kind
    return {"u": F, "i": F - 20, "f": F / 2 - 20}[kind].astype(dtype)


def columns(dtype):
    """(H, W, T), as MATLAB has it."""
    return np.moveaxis(stack(dtype), 0, 2)


def write_mat5():
    for name, packed in (("plain", False), ("deflated", True)):
        scipy.io.savemat(OUT / f"{name}.mat", {"pixel_um": 20.0, "axis": np.arange(9.0), "name": "jet",
                                               "stack": columns("f8")}, do_compression=packed)
    scipy.io.savemat(OUT / "several.mat", {"u8": columns("u1"), "i16": columns("i2"), "f32": columns("f4"),
                                           "u16": columns("u2"), "i32": columns("i4"), "z": columns("f4") * 1j})


def big_endian_mat5():
    """By hand: one uint16 matrix whose name fits into its tag."""
    def part(kind, data):
        return struct.pack(">II", kind, len(data)) + data + b"\0" * (-len(data) % 8)
    data = columns(">u2").tobytes(order="F")
    body = (part(6, struct.pack(">II", 11, 0)) + part(5, struct.pack(">iii", H, W, T)) +
            struct.pack(">HH", 2, 1) + b"ab\0\0" + part(4, data))
    head = b"MATLAB 5.0 MAT-file, by hand".ljust(124) + struct.pack(">H", 0x0100) + b"MI"
    (OUT / "big_endian.mat").write_bytes(head + part(14, body))


def write_mat73():
    with h5py.File(OUT / "v73.mat", "w", userblock_size=512) as file:
        for name, value, kind in (("stack", np.transpose(columns("f4")), "single"), ("pixel", [[20.0]], "double"),
                                  ("title", np.array([[106], [101]], "u2"), "char"), ("#refs#/a", F[0], "double")):
            file.create_dataset(name, data=value).attrs["MATLAB_class"] = np.bytes_(kind)
    with open(OUT / "v73.mat", "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Thu Feb 29 12:00:00 2024 HDF5 schema 1.00 .".ljust(124)
                   + b"\0\2IM")


def write_ome():
    notes = {"axes": "TYX", "PhysicalSizeX": 20.5, "PhysicalSizeXUnit": "nm", "TimeIncrement": 40.0,
             "TimeIncrementUnit": "\u00b5s", "Description": "a & b"}
    tifffile.imwrite(OUT / "stack.ome.tif", stack("u2"), ome=True, metadata=notes)
    tifffile.imwrite(OUT / "no_units.ome.tif", stack("f4"), ome=True,
                     metadata={"axes": "TYX", "PhysicalSizeX": 0.5, "TimeIncrement": 0.25})


def write_imagej():
    """As ImageJ lays out more than 4 GiB: one directory, then the images, big-endian."""
    text = b"ImageJ=1.53t\nimages=3\nframes=3\nunit=micron\nfinterval=4.0E-5\nloop=false\n\0"
    data = stack(">f4").tobytes()
    entries = [(256, 4, 1, W), (257, 4, 1, H), (258, 3, 1, 32 << 16), (259, 3, 1, 1 << 16), (262, 3, 1, 1 << 16),
               (270, 2, len(text), 0), (273, 4, 1, 0), (277, 3, 1, 1 << 16), (278, 3, 1, H << 16),
               (279, 4, 1, 4 * H * W), (282, 5, 1, 0), (339, 3, 1, 3 << 16)]
    text_at = 8 + 2 + 12 * len(entries) + 4
    places = {270: text_at, 282: text_at + len(text), 273: text_at + len(text) + 8}
    directory = struct.pack(">H", len(entries))
    directory += b"".join(struct.pack(">HHII", tag, kind, n, places.get(tag, v)) for tag, kind, n, v in entries)
    (OUT / "one_directory.tif").write_bytes(b"MM\0*" + struct.pack(">I", 8) + directory + b"\0" * 4 + text +
                                            struct.pack(">II", 100, 2000) + data)


def write_raw():
    frames = stack("u2")
    rows = b"".join(row.tobytes() + b"\xee" * 6 for frame in frames for row in frame[::-1].astype(">u2"))
    chunks = [rows[i * 100:(i + 1) * 100] + b"gap" for i in range(T)]
    (OUT / "gaps.raw").write_bytes(b"header" + b"".join(chunks))
    (OUT / "gaps.json").write_text(json.dumps({
        "width": W, "height": H, "sample": "u16be", "offset": 6, "row": 20, "stride": 103, "bottom_up": True, "frames": 3,
        "frame_rate": "25 kHz", "pixel": "20 um", "exposure": "2 us", "bit_depth": 12, "unit": "counts", "camera": "mine",
        "comment": "by hand"}, indent=1))
    (OUT / "plain.f32").write_bytes(stack("<f4").tobytes())
    (OUT / "plain.json").write_text('{"width": 7, "height": 5, "sample": "f32"}\n')


OUT.mkdir(exist_ok=True)
write_mat5()
big_endian_mat5()
write_mat73()
write_ome()
write_imagej()
write_raw()
