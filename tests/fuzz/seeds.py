#!/usr/bin/env python3
"""Makes the seed corpora of the fuzz targets, from the golden files, the examples and the smallest model, and
the dictionaries of those that read words.

Writes DIR/<target>/<name> and DIR/<target>.dict.  usage: seeds.py DIR
"""
import json
import pathlib
import re
import shutil
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests/golden"
# Formats by the endings of their files; a folder of inputs that are kept is named like its target.
ENDINGS = {"npy": [".npy"], "png": [".png"], "tiff": [".tif"], "cine": [".cine"], "mat": [".mat"]}
# Headers with their frames beside them: endings of both, and what the target wants before the header.
PAIRS = {"mraw": [(".cih", ".mraw", b"t"), (".cihx", ".mraw", b"x")],
         "raw": [(".json", ".raw", b""), (".json", ".f32", b"")]}
KEYS = {"rig": "src/rig/keys.c", "preset": "src/train/preset.c"}  # tables of words
LARGEST = 16384  # bytes; larger inputs only slow the search down


def smallest_model():
    """safetensors of the U-Net with two levels of one channel."""
    tensors, data, shapes = {}, b"", {}
    for block, channels in (("enc1", 1), ("bottleneck", 1), ("dec1", 2)):
        for conv, inputs in ((1, channels), (2, 1)):
            shapes[f"{block}.conv{conv}.weight"] = [1, inputs, 3, 3]
            for name in ("weight", "bias", "running_mean", "running_var"):
                shapes[f"{block}.bn{conv}.{name}"] = [1]
    shapes.update({"out.weight": [1, 1, 1, 1], "out.bias": [1]})
    for name, shape in shapes.items():
        count = shape[0] * shape[1] * shape[2] * shape[3] if len(shape) == 4 else 1
        tensors[name] = {"dtype": "F32", "shape": shape, "data_offsets": [len(data), len(data) + 4 * count]}
        data += struct.pack("<f", 0.5) * count
    tensors["__metadata__"] = {
        "format": "ptie", "ptie.arch": "unet-1-1", "ptie.in_channels": "1", "ptie.output": "sigmoid",
        "ptie.dropout": "0.1", "ptie.bn_eps": "0.001", "ptie.bn_momentum": "0.99", "ptie.normalise": "minmax"}
    header = json.dumps(tensors, separators=(",", ":")).encode()
    return struct.pack("<Q", len(header)) + header + data


def seeds(target):
    """Names and contents of a target's seeds."""
    for path in sorted(GOLDEN.glob("[ci]*/*")):
        if path.suffix in ENDINGS.get(target, []):
            yield path.name, path.read_bytes()
        for header, frames, kind in PAIRS.get(target, []):
            beside = path.with_suffix(frames)
            if path.suffix == header and beside.exists():
                yield path.name, struct.pack("<H", min(beside.stat().st_size, 65535)) + kind + path.read_bytes()
    if target in ("rig", "preset"):
        for path in sorted((ROOT / "examples").glob("*.ini")) + [ROOT / "tests/cli/small.ini"]:
            yield path.name, path.read_bytes()
    if target == "history":
        rows = (ROOT / "models/paper.history.csv").read_bytes().splitlines(keepends=True)
        yield "two-epochs", b"".join(rows[:3])
    if target in ("model", "safetensors"):
        yield "smallest", smallest_model()
        header = b'{"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},"__metadata__":{"k":"v"}}'
        yield "one-tensor", struct.pack("<Q", len(header)) + header + bytes(8)
    if target == "sequence":
        yield "folder", b"\nflow_2.npy\nflow_10.npy"
        yield "pattern", b"flow_%02d.npy\nflow_01.npy\nflow_10.npy\nflow_100.npy\nother.npy"
        yield "kinds", b"\na.npy\nb.npy"
    if target == "text":
        for i, text in enumerate((b"3e-4", b"532 nm", b"40 us", b"25 kHz", b"30 deg", b"300 m/s")):
            yield f"quantity{i}", bytes([i]) + text


def words(target):
    """The dictionary kept for a target, or the words in the source of its keys."""
    kept = ROOT / f"tests/fuzz/dictionaries/{target}.dict"
    if kept.exists():
        return kept.read_text(encoding="utf-8")
    source = (ROOT / KEYS[target]).read_text(encoding="utf-8") if target in KEYS else ""
    return "".join(f'"{word}"\n' for word in sorted(set(re.findall(r'"([a-z_-]{3,})"', source))))


def main():
    folder = pathlib.Path(sys.argv[1])
    for source in sorted((ROOT / "tests/fuzz").glob("*.c")):
        target = source.stem
        if target in ("fuzz", "replay"):
            continue
        (folder / target).mkdir(parents=True, exist_ok=True)
        if words(target):
            (folder / f"{target}.dict").write_text(words(target), encoding="utf-8")
        for name, content in seeds(target):
            if len(content) <= LARGEST:
                (folder / target / name).write_bytes(content)
        for path in (GOLDEN / "fuzz").glob(f"{target}-*"):
            shutil.copy(path, folder / target)


main()
