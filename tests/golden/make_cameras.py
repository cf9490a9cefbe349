#!/usr/bin/python3
"""Writes small recordings as cameras and programs lay them out, for tests/io: Photron MRAW with CIH and CIHX.

Frame t holds, in counts, f * (x + 10 y + 50 t) with f = 1 (8 bits), 7 (10 bits), 27 (12 and 16 bits); 7 x 5 pixels,
3 frames.  Bits are laid out one by one here, from NumPy's unpackbits.  Usage: make_cameras.py [FOLDER]
"""
import pathlib
import struct
import sys

import numpy as np

OUT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "cameras")
T, H, W = 3, 5, 7
t, y, x = np.mgrid[:T, :H, :W]
F = x + 10 * y + 50 * t
FACTOR = {8: 1, 10: 7, 12: 27, 16: 27}


def packed(values, bits):
    """Most significant bit first, without gaps; the last byte is filled with zeros."""
    words = values.astype(">u2").ravel().view("u1").reshape(-1, 2)
    return np.packbits(np.unpackbits(words, axis=1)[:, 16 - bits:].ravel()).tobytes()


def stored(frame, bits, row_bytes=0):
    if row_bytes:
        return b"".join(packed(row, bits).ljust(row_bytes, b"\xaa") for row in frame)
    if bits in (10, 12):
        return packed(frame, bits)
    return frame.astype("u1" if bits == 8 else "<u2").tobytes()


def cih(bits, depth, side="Lower", frames=T):
    lines = ["#Camera Information Header", "Date : 2024/2/29", "Time : 23:59", "Camera Type :FASTCAM Test",
             "Record Rate(fps) : 60000", "Shutter Speed(s) : 1/800000", "Trigger Mode : Start",
             "Original Total Frame : 677", f"Total Frame : {frames}", "Start Frame : 49300", "Save Step : 36",
             f"Image Width : {W}", f"Image Height: {H}", "Color Type : Mono", f"Color Bit : {bits}",
             "File Format : MRaw", f"EffectiveBit Depth : {depth}", f"EffectiveBit Side : {side}",
             "Comment Text : gr\xfc\xdfe", "Shutter Type2(nsec) : 1250", "", "#Versions", "Image Width : 99", "END"]
    return "\r\n".join(lines).encode("latin-1")


def cihx(bits, depth):
    xml = f"""<?xml version="1.0" encoding="utf-8"?>
<cih><fileInfo><date>2024/2/29</date><time>23:59</time></fileInfo>
<imageFileInfo><fileFormat>Mraw</fileFormat><resolution><width>98</width><height>97</height></resolution></imageFileInfo>
<imageDataInfo><resolution><width>{W}</width><height>{H}</height></resolution>
<colorInfo><type>Raw</type><bit>{bits}</bit></colorInfo>
<effectiveBit><depth>{depth}</depth><side>Lower</side></effectiveBit>
<segmentPos><sensorXpos>129</sensorXpos><sensorYpos>64</sensorYpos></segmentPos></imageDataInfo>
<frameInfo><recordedFrame>400</recordedFrame><totalFrame>{T}</totalFrame><skipFrame>2500</skipFrame></frameInfo>
<basicInfo><comment>a &lt; b &amp; c</comment></basicInfo>
<recordInfo><recordRate>50000</recordRate><shutterSpeed>200000</shutterSpeed>
<triggerMode><mode>7</mode></triggerMode></recordInfo>
<deviceInfo><deviceName>FASTCAM Test X</deviceName><resolution><width>96</width></resolution></deviceInfo></cih>
""".replace("\n", "\r\n").encode()
    at = 256 + 12 + 48
    frames = bytes(range(40))
    sections = struct.pack("<IIQQ", 0, 0, at, len(xml)) + struct.pack("<IIQQ", 4, 0, at + len(xml), len(frames))
    note = b"!!! This file can not be edited. !!!".ljust(256, b"\0")
    return note + b"CIHX" + struct.pack("<II", 1, 2) + sections + xml + frames


def write_photron(name, bits, header, ending, shift=0, row_bytes=0):
    frames = F * FACTOR[bits] << shift
    (OUT / f"{name}.mraw").write_bytes(b"".join(stored(frame, bits, row_bytes) for frame in frames))
    (OUT / f"{name}.{ending}").write_bytes(header)


OUT.mkdir(exist_ok=True)
for bits, depth in ((8, 12), (10, 10), (12, 12), (16, 12)):
    write_photron(f"u{bits}", bits, cih(bits, depth), "cih")
write_photron("higher", 16, cih(16, 12, "Higher"), "cih", shift=4)
write_photron("padded", 12, cih(12, 12), "cih", row_bytes=16)
write_photron("xml", 12, cihx(12, 12), "cihx")
write_photron("short", 16, cih(16, 12, frames=9), "cih")
