"""Where the virtual environment is, and how programs of it are run.  Needs nothing but Python itself."""
import os
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PYTHON = ROOT / "build-peers/bin/python"
# Memory that is freed stays with the process.  Without this PyTorch trains at a third of its speed.
ALLOCATOR = "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=100000000000:glibc.malloc.top_pad=67108864"


def variables(threads):
    """The environment in which frameworks are quick and quiet, and see no graphics card."""
    return dict(os.environ, OMP_NUM_THREADS=str(threads), GLIBC_TUNABLES=ALLOCATOR, CUDA_VISIBLE_DEVICES="",
                TF_CPP_MIN_LOG_LEVEL="2", TORCHINDUCTOR_CACHE_DIR=str(ROOT / "build-peers/inductor"))


def expect_environment(parser):
    if not PYTHON.exists():
        parser.error("no environment yet: run bench/peers/setup first")
