"""One peer in a process of its own.  usage: worker.py PEER FOLDER THREADS

Answers one JSON line for every JSON line on standard input: ["versions"], ["candidates"],
["prepare", row, name] -> how far its results are from ptie's: the largest difference, and what PSNR in dB is lost;
["measure", row, name, seconds] -> durations of the calls.
"""
import ctypes
import importlib
import json
import os
import signal
import sys

import numpy as np

from shared import Shared, durations, psnr_db

GOLDEN_STEPS, GOLDEN_RATE = 10, 1e-3


class Worker:
    def __init__(self, peer, folder, threads):
        self.shared = Shared(folder, int(threads))
        self.peer = importlib.import_module("peer_" + peer)
        self.known = {(c.row, c.name): c for c in self.peer.candidates(self.shared)}
        self.calls = {}

    def versions(self):
        return self.peer.versions()

    def candidates(self):
        return list(self.known)

    def prepare(self, row, name):
        """Keeps a call for `measure`."""
        make = self.known[row, name].prepare
        return self.prepare_training(row, name, make) if row == "training" else self.prepare_inference(row, name, make)

    def prepare_inference(self, row, name, make):
        count = 1 if row in ("frame", "frame-reduced") else None
        noisy, clean, expected = (maps[:count] for maps in (self.shared.noisy, self.shared.clean, self.shared.expected))
        run = make()
        self.calls[row, name] = lambda: run(noisy)
        estimates = run(noisy)
        return {"difference": float(np.abs(estimates - expected).max()),
                "psnr_lost_db": psnr_db(expected, clean) - psnr_db(estimates, clean)}

    def prepare_training(self, row, name, make):
        """The difference is that of the losses over ten steps from what ptie's own tests expect."""
        s = self.shared
        step = make(s.golden, GOLDEN_RATE, 0.0)
        losses = [step(s.golden["noisy"], s.golden["clean"]) for _ in range(GOLDEN_STEPS)]
        trained = make(s.weights, 1e-6, 0.1)
        trained(s.noisy, s.clean)
        self.calls[row, name] = lambda: trained(s.noisy, s.clean)
        return {"difference": float(np.abs(losses - s.golden["step_losses"]).max())}

    def measure(self, row, name, seconds):
        call = self.calls[row, name]
        call()
        return durations(call, seconds)


def answer(worker, request):
    """What a framework raises is reported, so that one candidate's failure costs only that candidate."""
    try:
        return {"value": getattr(worker, request[0])(*request[1:])}
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}"}


def die_with_parent():
    """Also while stopped, when nothing would notice."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGKILL)


def main():
    die_with_parent()
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever the frameworks print goes to the log
    worker = Worker(*sys.argv[1:])
    for line in sys.stdin:
        print(json.dumps(answer(worker, json.loads(line))), file=answers, flush=True)


main()
