"""Fills the folder the peers share.  usage: prepare.py LIBRARY MODEL GOLDEN DATASET FOLDER

The frames, what ptie's library makes of them, the weights, and the network as ONNX with BatchNorm folded.
"""
import ctypes
import pathlib
import shutil
import sys

import h5py
import numpy as np
import torch

import network
from shared import read_safetensors

FRAMES = 32


def expect(status, library):
    if status != 0:
        library.ptie_last_error.restype = ctypes.c_char_p
        raise RuntimeError(library.ptie_last_error().decode())


def denoise(path, model_path, noisy):
    """Estimates of ptie's network for frames in [0, 1]."""
    library = ctypes.CDLL(path)
    context, model, denoiser = (ctypes.c_void_p() for _ in range(3))
    height, width = noisy.shape[2:]
    expect(library.ptie_ctx_create(ctypes.byref(context), None), library)
    expect(library.ptie_model_load(ctypes.byref(model), str(model_path).encode()), library)
    expect(library.ptie_denoiser_create(ctypes.byref(denoiser), context, model, width, height, None), library)
    library.ptie_denoiser_scratch_bytes.restype = ctypes.c_size_t
    library.ptie_scratch_alloc.restype = ctypes.c_void_p
    scratch = ctypes.c_void_p(library.ptie_scratch_alloc(
        ctypes.c_size_t(library.ptie_denoiser_scratch_bytes(denoiser))))
    clean = np.empty_like(noisy)
    for source, target in zip(noisy, clean):
        expect(library.ptie_denoiser_run(denoiser, ctypes.c_void_p(target.ctypes.data),
                                         ctypes.c_void_p(source.ctypes.data), scratch), library)
    library.ptie_scratch_free(scratch)
    library.ptie_denoiser_free(denoiser)
    library.ptie_model_free(model)
    library.ptie_ctx_free(context)
    return clean


def export(weights, frames, path):
    program = torch.onnx.export(network.load(weights).eval(), (torch.from_numpy(frames),), dynamo=True, verbose=False,
                                input_names=["noisy"], output_names=["clean"],
                                dynamic_shapes=({0: torch.export.Dim("batch")},))
    program.save(path)


def main():
    library, model, golden, dataset = sys.argv[1:5]
    folder = pathlib.Path(sys.argv[5])
    shutil.copy(model, folder / "model.safetensors")
    shutil.copy(golden, folder / "golden.safetensors")
    with h5py.File(dataset) as file:
        maps = {name: file[name][:FRAMES][:, None] for name in ("noisy", "clean")}
    maps["expected"] = denoise(library, model, maps["noisy"])
    for name, values in maps.items():
        np.save(folder / f"{name}.npy", values)
    export(read_safetensors(model), maps["noisy"][:2], folder / "network.onnx")


main()
