"""The paper's network, loss, scores and optimiser as a PyTorch user writes them (docs/math-network.md)."""
import torch
import torch.nn.functional as F
from torch import nn

from shared import STAGES

EPSILON, MOMENTUM = 1e-3, 0.99  # of BatchNorm, as in Keras; PyTorch counts momentum from the other end
WEIGHT_DECAY = 0.004
SSIM_SIDE, SSIM_SIGMA = 11, 1.5


class Stage(nn.Module):
    """Two 3x3 convolutions, each with BatchNorm and ReLU."""

    def __init__(self, below, width):
        super().__init__()
        self.conv1, self.bn1 = self.layer(below, width)
        self.conv2, self.bn2 = self.layer(width, width)

    @staticmethod
    def layer(below, width):
        convolution = nn.Conv2d(below, width, 3, padding=1, bias=False)
        fans = 9 * (below + width)
        nn.init.uniform_(convolution.weight, -(6 / fans) ** 0.5, (6 / fans) ** 0.5)  # Glorot, as Keras
        return convolution, nn.BatchNorm2d(width, eps=EPSILON, momentum=1 - MOMENTUM)

    def forward(self, x):
        x = F.relu(self.bn1(self.conv1(x)))
        return F.relu(self.bn2(self.conv2(x)))


class Network(nn.Module):
    """U-Net 8-16-32; member names are those of ptie's model files."""

    def __init__(self, dropout=0.1):
        super().__init__()
        for name, below, width in STAGES:
            setattr(self, name, Stage(below, width))
        self.dropout = nn.Dropout(dropout)
        self.out = nn.Conv2d(STAGES[-1][2], 1, 1)
        limit = (6 / (STAGES[-1][2] + 1)) ** 0.5
        nn.init.uniform_(self.out.weight, -limit, limit)
        nn.init.zeros_(self.out.bias)

    def forward(self, x):
        first = self.enc1(x)
        second = self.enc2(F.max_pool2d(first, 2))
        deepest = self.dropout(self.bottleneck(F.max_pool2d(second, 2)))
        upper = self.dec2(torch.cat((double(deepest), second), 1))
        return torch.sigmoid(self.out(self.dec1(torch.cat((double(upper), first), 1))))


def double(x):
    return F.interpolate(x, scale_factor=2, mode="bilinear", align_corners=False)


def load(tensors, dropout=0.1):
    """The network with the weights of a model file, for training or inference."""
    network = Network(dropout)
    missing, _ = network.load_state_dict({name: torch.tensor(value) for name, value in tensors.items()},
                                         strict=False)
    if any("num_batches" not in name for name in missing):
        raise ValueError(f"model file lacks {missing}")
    return network


def folded(network):
    """The same network for inference, BatchNorm folded into the convolutions."""
    network = network.eval()
    for name, _, _ in STAGES:
        stage = getattr(network, name)
        for number in "12":
            convolution, norm = getattr(stage, "conv" + number), getattr(stage, "bn" + number)
            setattr(stage, "conv" + number, nn.utils.fusion.fuse_conv_bn_eval(convolution, norm))
            setattr(stage, "bn" + number, nn.Identity())
    return network


def gauss_row():
    t = torch.arange(SSIM_SIDE, dtype=torch.float32) - SSIM_SIDE // 2
    row = torch.exp(-t ** 2 / (2 * SSIM_SIGMA ** 2))
    return row / row.sum()


def windowed(maps, row):
    """Gaussian means over valid windows; the window is separable, and all maps go through it together."""
    maps = F.conv2d(maps, row.view(1, 1, 1, -1))
    return F.conv2d(maps, row.view(1, 1, -1, 1))


def ssim(x, y, row):
    """Mean over each map (N), range 1."""
    n = x.shape[0]
    means = windowed(torch.cat((x, y, x * x, y * y, x * y)), row)
    mean_x, mean_y, square_x, square_y, product = (means[i * n:(i + 1) * n] for i in range(5))
    c1, c2 = 0.01 ** 2, 0.03 ** 2
    luminance = (2 * mean_x * mean_y + c1) / (mean_x ** 2 + mean_y ** 2 + c1)
    structure = (2 * (product - mean_x * mean_y) + c2) / \
        (square_x - mean_x ** 2 + square_y - mean_y ** 2 + c2)
    return (luminance * structure).mean((1, 2, 3))


def scores(estimate, clean, row):
    """Per map (N): loss, mean square, mean absolute difference, SSIM."""
    d = estimate - clean
    absolute, square = d.abs().mean((1, 2, 3)), (d ** 2).mean((1, 2, 3))
    weighted = ((1 + 4 * clean) * d ** 2).mean((1, 2, 3))
    similarity = ssim(estimate, clean, row)
    return 0.5 * absolute + 0.4 * (1 - similarity) + 0.1 * weighted, square, absolute, similarity


def optimiser(network, rate):
    """AdamW; Keras' constants."""
    return torch.optim.AdamW(network.parameters(), lr=rate, betas=(0.9, 0.999), eps=1e-7,
                             weight_decay=WEIGHT_DECAY)
