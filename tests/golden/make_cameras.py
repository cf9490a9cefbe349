#!/usr/bin/python3
"""Writes small recordings as cameras and programs lay them out, for tests/io: Photron MRAW with CIH and CIHX,
Phantom CINE.

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


def setup(length, flip, bits):
    """Vendor's SETUP block of that length; what lies beyond it must not be read."""
    block = bytearray(14000)
    fields = {0: ("H", 65535), 2: ("H", 10), 140: ("2s", b"ST"), 142: ("H", length), 743: ("I", 4711), 760: ("i", flip),
              768: ("I", 90000), 772: ("I", 10), 792: ("I", 73), 896: ("I", bits), 1568: ("I", 9700),
              1596: ("9s", b"a  \xe4 plume"), 5732: ("i", 64), 5736: ("i", 1014 if bits == 10 else 4064),
              12432: ("5s", b"v2512"), 13472: ("d", 90000.5)}
    for at, (kind, value) in fields.items():
        struct.pack_into("<" + kind, block, at, value)
    return bytes(block[:length])


def write_cine(name, bits, packing=0, flip=0, length=13600, real_bits=12, stamps=True):
    head, images = bytearray(44), bytearray(40)
    tags = b""
    if stamps:  # 9 kHz, across a full second
        times = [(2**32 - 2**32 // 9000 + i * 2**32 // 9000) for i in range(T)]
        body = b"".join(struct.pack("<II", v % 2**32 & ~3 | 1, 1700000000 + v // 2**32) for v in times)
        tags = struct.pack("<IHH", 12, 1003, 0) + b"\0" * 4 + struct.pack("<IHH", 8 + len(body), 1002, 0) + body
    offsets_at = 84 + length + len(tags)
    frames = [frame if packing or flip else frame[::-1] for frame in F * FACTOR[bits]]
    if packing and flip:
        frames = [frame[::-1] for frame in frames]
    pixels = [stored(frame, bits) for frame in frames]
    at, table, images_data = offsets_at + 8 * T, b"", b""
    for i, data in enumerate(pixels):
        note = b"n" * i
        table += struct.pack("<q", at)
        image = struct.pack("<I", 8 + len(note)) + note + struct.pack("<I", len(data)) + data
        at += len(image)
        images_data += image
    struct.pack_into("<2sHHHiIiIIIIII", head, 0, b"CI", 44, 0, 1, -1000, 1001, -2, T, 44, 84, offsets_at, 7, 1700000000)
    struct.pack_into("<IiiHHIIiiII", images, 0, 40, W, H, 1, bits if packing == 0 else 16, packing, len(pixels[0]), 50000,
                     50000, 0, 0)
    (OUT / f"{name}.cine").write_bytes(bytes(head) + bytes(images) + setup(length, flip, real_bits) + tags + table + images_data)


OUT.mkdir(exist_ok=True)
for bits, depth in ((8, 12), (10, 10), (12, 12), (16, 12)):
    write_photron(f"u{bits}", bits, cih(bits, depth), "cih")
write_photron("higher", 16, cih(16, 12, "Higher"), "cih", shift=4)
write_photron("padded", 12, cih(12, 12), "cih", row_bytes=16)
write_photron("xml", 12, cihx(12, 12), "cihx")
write_photron("short", 16, cih(16, 12, frames=9), "cih")
write_cine("plain8", 8, real_bits=8, length=1600)
write_cine("plain16", 16, flip=1)
write_cine("old", 16, length=144, stamps=False)
write_cine("packed10", 10, packing=256, real_bits=10, length=5740)
write_cine("packed12", 12, packing=1024, flip=1, length=5740)
