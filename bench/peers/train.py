"""Trains the paper's network in PyTorch on a data set file of `ptie dataset`, with ptie's recipe and scores.

usage: train.py DATA HISTORY.csv EPOCHS RATE SEED THREADS.  Independent of ptie's library: its own network, loss, optimiser, schedule, order and dropout.  Writes one row per
epoch, with the columns of ptie's history files.
"""
import csv
import math
import sys
import time

import h5py
import numpy as np
import torch

import network

BATCH = 32
SCORES = ("loss", "psnr_db", "mae", "ssim", "samples")
COLUMNS = ("epoch", "learning_rate", "seconds", *(f"{split}_{score}" for split in ("train", "validation")
                                                  for score in SCORES))


def read_split(file, split):
    """Noisy and clean maps (N, 1, H, W) of one split."""
    first, last = dict(line.split() for line in file.attrs["split"])[split].split(":")
    return [torch.from_numpy(file[name][int(first):int(last)])[:, None] for name in ("noisy", "clean")]


def read(path):
    with h5py.File(path) as file:
        return {split: read_split(file, split) for split in ("train", "validation")}


def learning_rate(base, step, steps_per_epoch, epochs):
    """Cosine by epoch, times a linear warm-up over the first epoch; steps count from 0."""
    return base * 0.5 * (1 + math.cos(math.pi * (step // steps_per_epoch) / epochs)) * \
        min(1, (step + 1) / steps_per_epoch)


class Means:
    """Means over samples of the scores of each."""

    def __init__(self):
        self.sums, self.samples = np.zeros(4), 0

    def add(self, scores):
        loss, square, absolute, ssim = (score.detach().double() for score in scores)
        self.sums += [float(score.sum()) for score in (loss, -10 * torch.log10(square), absolute, ssim)]
        self.samples += len(loss)

    def values(self):
        return [*self.sums / self.samples, self.samples]


@torch.no_grad()
def score(model, maps, row):
    model.eval()
    means = Means()
    for noisy, clean in zip(*(part.split(BATCH) for part in maps)):
        means.add(network.scores(model(noisy), clean, row))
    return means.values()


class Training:
    def __init__(self, data, rate, epochs):
        self.data, self.rate, self.epochs = data, rate, epochs
        self.model, self.row = network.Network(), network.gauss_row()
        self.optimiser = network.optimiser(self.model, rate)
        self.step = 0
        self.steps_per_epoch = math.ceil(len(data["train"][0]) / BATCH)

    def take_step(self, noisy, clean):
        """Its scores, as they were before it."""
        for group in self.optimiser.param_groups:
            group["lr"] = learning_rate(self.rate, self.step, self.steps_per_epoch, self.epochs)
        self.optimiser.zero_grad()
        scores = network.scores(self.model(noisy), clean, self.row)
        scores[0].mean().backward()
        self.optimiser.step()
        self.step += 1
        return scores

    def run_epoch(self):
        """A row of the history, without its number."""
        start = time.perf_counter()
        self.model.train()
        means = Means()
        noisy, clean = self.data["train"]
        for batch in torch.randperm(len(noisy)).split(BATCH):
            means.add(self.take_step(noisy[batch], clean[batch]))
        validation = score(self.model, self.data["validation"], self.row)
        rate = self.optimiser.param_groups[0]["lr"]
        return [rate, time.perf_counter() - start, *means.values(), *validation]


def main():
    data, history = sys.argv[1:3]
    epochs, rate, seed, threads = (kind(text) for kind, text in zip((int, float, int, int), sys.argv[3:]))
    torch.set_num_threads(threads)
    torch.manual_seed(seed)
    training = Training(read(data), rate, epochs)
    with open(history, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        rows.writerows([epoch, *training.run_epoch()] for epoch in range(1, epochs + 1))


main()
