#!/usr/bin/python3
"""Writes network.safetensors: what PyTorch, in double precision, makes of the paper's network.

Independent of the code under test: BatchNorm and AdamW are written out from the Keras documentation, SSIM with a
full two-dimensional window.  Run in this folder with PyTorch 1.13: ./make_network.py
"""
import json
import struct

import numpy as np
import torch
import torch.nn.functional as F

WIDTHS = (8, 16, 32)
EPSILON, MOMENTUM = 1e-3, 0.99
W_L1, W_SSIM, W_MSE = 0.5, 0.4, 0.1
HEIGHT, WIDTH, BATCH = 36, 44, 2  # no level's width is a multiple of 8 or 16


def stages():
    """(name, in, out) of every pair of convolutions, in the order of the data."""
    below = 1
    for level, width in enumerate(WIDTHS[:-1]):
        yield f"enc{level + 1}", below, width
        below = width
    yield "bottleneck", below, WIDTHS[-1]
    for level in reversed(range(len(WIDTHS) - 1)):
        yield f"dec{level + 1}", WIDTHS[level + 1] + WIDTHS[level], WIDTHS[level]


def make_parameters(generator):
    """Weights of a plausible size; statistics and affine parameters away from their initial values."""
    def uniform(*shape, low=-1.0, high=1.0):
        return low + (high - low) * torch.rand(*shape, generator=generator, dtype=torch.float64)

    values = {}
    for stage, below, width in stages():
        for number, channels in ((1, below), (2, width)):
            limit = (6 / (9 * (channels + width))) ** 0.5
            values[f"{stage}.conv{number}.weight"] = limit * uniform(width, channels, 3, 3)
            values[f"{stage}.bn{number}.weight"] = uniform(width, low=0.7, high=1.3)
            values[f"{stage}.bn{number}.bias"] = uniform(width, low=-0.2, high=0.2)
            values[f"{stage}.bn{number}.running_mean"] = uniform(width, low=-0.3, high=0.3)
            values[f"{stage}.bn{number}.running_var"] = uniform(width, low=0.2, high=1.5)
    values["out.weight"] = uniform(1, WIDTHS[0], 1, 1)
    values["out.bias"] = uniform(1)
    # Single precision is what the file holds and what the network under test starts from.
    return {name: value.float().double() for name, value in values.items()}


def block(x, values, stage, training, statistics):
    for number in (1, 2):
        x = F.conv2d(x, values[f"{stage}.conv{number}.weight"], padding=1)
        mean, variance = (values[f"{stage}.bn{number}.running_{what}"] for what in ("mean", "var"))
        if training:
            mean, variance = x.mean((0, 2, 3)), x.var((0, 2, 3), unbiased=False)
            statistics[f"{stage}.bn{number}"] = mean.detach(), variance.detach()
        shape = (1, -1, 1, 1)
        x = (x - mean.view(shape)) / (variance.view(shape) + EPSILON).sqrt()
        x = x * values[f"{stage}.bn{number}.weight"].view(shape) + values[f"{stage}.bn{number}.bias"].view(shape)
        x = F.relu(x)
    return x


def network(x, values, training, statistics=None):
    skips = []
    for level in range(len(WIDTHS) - 1):
        x = block(x, values, f"enc{level + 1}", training, statistics)
        skips.append(x)
        x = F.max_pool2d(x, 2)
    x = block(x, values, "bottleneck", training, statistics)
    for level in reversed(range(len(WIDTHS) - 1)):
        x = F.interpolate(x, scale_factor=2, mode="bilinear", align_corners=False)
        x = block(torch.cat((x, skips[level]), 1), values, f"dec{level + 1}", training, statistics)
    return torch.sigmoid(F.conv2d(x, values["out.weight"], values["out.bias"]))


def ssim(x, y):
    """Per image, (N): 11x11 Gaussian of standard deviation 1.5, valid windows, range 1."""
    t = torch.arange(11, dtype=torch.float64) - 5
    window = torch.exp(-(t[:, None] ** 2 + t[None, :] ** 2) / (2 * 1.5 ** 2))
    window = (window / window.sum())[None, None]
    mean_x, mean_y = F.conv2d(x, window), F.conv2d(y, window)
    variance_x = F.conv2d(x * x, window) - mean_x ** 2
    variance_y = F.conv2d(y * y, window) - mean_y ** 2
    covariance = F.conv2d(x * y, window) - mean_x * mean_y
    c1, c2 = 0.01 ** 2, 0.03 ** 2
    luminance = (2 * mean_x * mean_y + c1) / (mean_x ** 2 + mean_y ** 2 + c1)
    return (luminance * (2 * covariance + c2) / (variance_x + variance_y + c2)).mean((1, 2, 3))


def losses(estimate, clean):
    """loss, mean |d|, SSIM, weighted and plain mean square, each (N)."""
    d = estimate - clean
    l1 = d.abs().mean((1, 2, 3))
    wmse = ((1 + 4 * clean) * d ** 2).mean((1, 2, 3))
    similarity = ssim(estimate, clean)
    return W_L1 * l1 + W_SSIM * (1 - similarity) + W_MSE * wmse, l1, similarity, wmse, (d ** 2).mean((1, 2, 3))


class AdamW:
    """Keras: decay first and decoupled, bias correction in the rate, epsilon outside the root."""

    def __init__(self, rate, decay, beta1=0.9, beta2=0.999, epsilon=1e-7):
        self.rate, self.decay, self.beta1, self.beta2, self.epsilon = rate, decay, beta1, beta2, epsilon
        self.moments, self.step_number = {}, 0

    def step(self, values, gradients):
        self.step_number += 1
        t = self.step_number
        rate = self.rate * (1 - self.beta2 ** t) ** 0.5 / (1 - self.beta1 ** t)
        for name, g in gradients.items():
            first, second = self.moments.get(name, (torch.zeros_like(g), torch.zeros_like(g)))
            first = first + (g - first) * (1 - self.beta1)
            second = second + (g * g - second) * (1 - self.beta2)
            self.moments[name] = first, second
            values[name] = values[name] - values[name] * self.rate * self.decay
            values[name] = values[name] - rate * first / (second.sqrt() + self.epsilon)


def training_step(values, noisy, clean, names):
    """Estimate, losses and gradients of the batch's mean loss; updates the running statistics of `values`."""
    leaves = {name: values[name].clone().requires_grad_(name in names) for name in values}
    statistics = {}
    estimate = network(noisy, leaves, True, statistics)
    parts = losses(estimate, clean)
    parts[0].mean().backward()
    for norm, (mean, variance) in statistics.items():
        values[f"{norm}.running_mean"] = MOMENTUM * values[f"{norm}.running_mean"] + (1 - MOMENTUM) * mean
        values[f"{norm}.running_var"] = MOMENTUM * values[f"{norm}.running_var"] + (1 - MOMENTUM) * variance
    return estimate.detach(), torch.stack([p.detach() for p in parts], 1), {n: leaves[n].grad for n in names}


def write_safetensors(path, tensors, notes):
    header, data = {"__metadata__": notes}, b""
    for name, value in tensors.items():
        raw = np.ascontiguousarray(value.detach().numpy().astype("<f4")).tobytes()
        header[name] = {"dtype": "F32", "shape": list(value.shape), "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


def normalised(x):
    low, high = x.amin((2, 3), True), x.amax((2, 3), True)
    return (x - low) / (high - low)


def main():
    generator = torch.Generator().manual_seed(20)
    values = make_parameters(generator)
    names = [name for name in values if "running" not in name]
    fine = torch.rand(BATCH, 1, HEIGHT + 8, WIDTH + 8, generator=generator, dtype=torch.float64)
    clean = normalised(F.avg_pool2d(fine, 9, 1)).float().double()
    noise = torch.randn(BATCH, 1, HEIGHT, WIDTH, generator=generator, dtype=torch.float64)
    noisy = (clean + 0.2 * noise).float().double()

    golden = dict(values, noisy=noisy, clean=clean, inference=network(noisy, values, False))
    optimiser, step_losses = AdamW(1e-3, 0.004), []
    for step in range(10):
        estimate, parts, gradients = training_step(values, noisy, clean, names)
        step_losses.append(parts[:, 0].mean())
        if step == 0:
            golden["estimate"], golden["parts"] = estimate, parts
            golden.update({f"gradient.{name}": gradients[name] for name in names})
            golden.update({f"after.{name}": value for name, value in values.items() if "running" in name})
        optimiser.step(values, gradients)
    golden["step_losses"] = torch.stack(step_losses)

    x = noisy.clone().requires_grad_(True)
    ssim(x, clean).sum().backward()
    golden["ssim"], golden["ssim_gradient"] = ssim(noisy, clean), x.grad

    vector = {"v": torch.tensor([0.5, -1.0, 2.0, 0.0, 1e-3], dtype=torch.float64)}
    given = torch.tensor([[0.1, -0.2, 3.0, 1e-4, 0.0], [0.3, 0.1, -2.0, 1e-4, 1e-8], [-0.1, 0.2, 1.0, -1e-3, 0.0]],
                         dtype=torch.float64)
    golden["adamw_start"], golden["adamw_gradients"] = vector["v"], given
    optimiser = AdamW(1e-2, 0.1)
    for g in given:
        optimiser.step(vector, {"v": g})
    golden["adamw_end"] = vector["v"]

    notes = {"format": "ptie", "ptie.arch": "unet-8-16-32", "ptie.in_channels": "1", "ptie.output": "sigmoid",
             "ptie.dropout": "0", "ptie.bn_eps": "0.001", "ptie.bn_momentum": "0.99", "ptie.normalise": "minmax"}
    write_safetensors("network.safetensors", golden, notes)


main()
