"""PyTorch: eager or compiled, NCHW or channels-last; float32, and bfloat16 where autocast sees fit."""
import torch

import network
from shared import Candidate, single_and_batched

LAYOUTS = (("", torch.contiguous_format), (", channels-last", torch.channels_last))
WAYS = (("eager", lambda function: function), ("compiled", lambda function: torch.compile(function, dynamic=False)))


def versions():
    return {"PyTorch": torch.__version__}


def inference(shared, compiled, layout, reduced):
    model = network.folded(network.load(shared.weights)).to(memory_format=layout)

    @compiled
    def estimate(x):
        with torch.autocast("cpu", torch.bfloat16, enabled=reduced):
            return model(x).float()

    @torch.inference_mode()
    def run(frames):
        return estimate(torch.from_numpy(frames).contiguous(memory_format=layout)).numpy()
    return run


def training(compiled, layout, tensors, rate, dropout):
    model = network.load(tensors, dropout).train().to(memory_format=layout)
    optimiser, row = network.optimiser(model, rate), network.gauss_row()

    @compiled
    def mean_loss(noisy, clean):
        return network.scores(model(noisy), clean, row)[0].mean()

    def step(noisy, clean):
        optimiser.zero_grad()
        loss = mean_loss(*(torch.from_numpy(maps).contiguous(memory_format=layout) for maps in (noisy, clean)))
        loss.backward()
        optimiser.step()
        return loss.item()
    return step


def candidates(shared):
    torch.set_num_threads(shared.threads)
    torch._inductor.config.freezing = True  # weights are constants: they are packed for oneDNN
    torch._dynamo.config.recompile_limit = 1000  # all candidates share their lines of code
    for way, compiled in WAYS:
        for suffix, layout in LAYOUTS:
            yield Candidate("training", way + suffix,
                            lambda *a, c=compiled, f=layout: training(c, f, *a))
            for row, precision, reduced in (("", "", False), ("-reduced", ", bf16", True)):
                yield from single_and_batched(
                    row, way + suffix + precision,
                    lambda batch, c=compiled, f=layout, r=reduced: inference(shared, c, f, r))
