"""What all peers share: the paper's network as data, ptie's model files, the frames, and what a candidate is."""
import dataclasses
import json
import pathlib
import struct
import time
import typing

import numpy as np

# (stage, channels in, channels out), in the order of the data.
STAGES = (("enc1", 1, 8), ("enc2", 8, 16), ("bottleneck", 16, 32), ("dec2", 48, 16), ("dec1", 24, 8))
BATCHES = (1, 8, 32)  # what a peer may cut the 32 frames into


@dataclasses.dataclass
class Candidate:
    """One way to run one row of the table.

    Inference: prepare() gives a function of frames (N, 1, H, W) that returns the estimates.  Training:
    prepare(tensors, rate, dropout) gives a function of a noisy and a clean batch that takes a step and returns
    the loss before it.
    """
    row: str
    name: str
    prepare: typing.Callable


class Shared:
    """The folder that `prepare.py` fills, and the number of threads."""

    def __init__(self, folder, threads):
        self.folder, self.threads = pathlib.Path(folder), threads
        self.noisy, self.clean, self.expected = (np.load(self.folder / f"{name}.npy")
                                                 for name in ("noisy", "clean", "expected"))
        self.weights, self.golden = (read_safetensors(self.folder / f"{name}.safetensors")
                                     for name in ("model", "golden"))
        self.graph = self.folder / "network.onnx"


def read_safetensors(path):
    """Tensors of a model file by name, float32."""
    with open(path, "rb") as file:
        length, = struct.unpack("<Q", file.read(8))
        header, raw = json.loads(file.read(length)), file.read()
    header.pop("__metadata__", None)
    return {name: np.frombuffer(raw[slice(*entry["data_offsets"])], "<f4").reshape(entry["shape"])
            for name, entry in header.items()}


def in_batches(run, batch):
    """The same for any number of frames, `batch` at a time."""
    def run_all(frames):
        estimates = np.empty_like(frames)
        for i in range(0, len(frames), batch):
            estimates[i:i + batch] = run(frames[i:i + batch])
        return estimates
    return run_all


def single_and_batched(row, name, make):
    """Candidates for one frame and for all of them; make(batch) prepares a function of `batch` frames."""
    yield Candidate("frame" + row, name, lambda: make(1))
    for batch in BATCHES:
        yield Candidate("frames" + row, f"{name}, batch {batch}",
                        lambda batch=batch: in_batches(make(batch), batch))


def psnr_db(estimates, clean):
    """Mean over frames, MAX = 1."""
    return float(np.mean(-10 * np.log10(((estimates - clean) ** 2).mean((1, 2, 3), dtype="f8"))))


def durations(call, seconds):
    """How long each call takes, in seconds; repeated until `seconds` have passed, at least once."""
    taken, end = [], time.perf_counter() + seconds
    while not taken or time.perf_counter() < end:
        start = time.perf_counter()
        call()
        taken.append(time.perf_counter() - start)
    return taken
