"""ONNX Runtime: all threads on one call, or one call per thread; int8 by its own quantiser."""
import concurrent.futures

import numpy as np
import onnxruntime
from onnxruntime import quantization

from shared import Candidate, single_and_batched


def versions():
    return {"ONNX Runtime": onnxruntime.__version__}


def session(path, threads):
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    inner = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
    return lambda frames: inner.run(None, {"noisy": frames})[0]


def side_by_side(path, threads):
    """Every thread with a session of its own and frames one at a time."""
    pool = concurrent.futures.ThreadPoolExecutor(threads)
    alone = [session(path, 1) for _ in range(threads)]

    def work(thread, frames):
        return [alone[thread](frame[None]) for frame in frames]

    def run(frames):
        parts = pool.map(work, range(threads), np.array_split(frames, threads))
        return np.concatenate([estimate for part in parts for estimate in part])
    return run


class Calibration(quantization.CalibrationDataReader):
    """A few of the frames, one by one."""

    def __init__(self, frames):
        self.frames = iter(frames)

    def get_next(self):
        frame = next(self.frames, None)
        return None if frame is None else {"noisy": frame[None]}


def quantised(shared):
    """Weights and activations in int8, ranges from eight of the frames."""
    path = str(shared.folder / "network-int8.onnx")
    quantization.quantize_static(str(shared.graph), path, Calibration(shared.noisy[:8]),
                                 quant_format=quantization.QuantFormat.QDQ, per_channel=True)
    return path


def candidates(shared):
    for row, suffix, path in (("", "", lambda: str(shared.graph)), ("-reduced", ", int8", lambda: quantised(shared))):
        yield from single_and_batched(row, "all threads" + suffix, lambda batch, p=path: session(p(), shared.threads))
        yield Candidate("frames" + row, "one frame per thread" + suffix,
                        lambda p=path: side_by_side(p(), shared.threads))
