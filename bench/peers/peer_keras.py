"""TensorFlow/Keras: graphs as TensorFlow runs them (oneDNN) or compiled by XLA; bfloat16 as oneDNN's rewriter does it."""
import keras
import numpy as np
import tensorflow as tf
from keras import layers

from shared import STAGES, Candidate, single_and_batched

WAYS = (("graph", False), ("XLA", True))


def versions():
    return {"TensorFlow": tf.__version__, "Keras": keras.__version__}


def stage(x, name, width):
    for number in "12":
        x = layers.Conv2D(width, 3, padding="same", use_bias=False, name=f"{name}.conv{number}")(x)
        x = layers.BatchNormalization(momentum=0.99, epsilon=1e-3, name=f"{name}.bn{number}")(x)
        x = layers.ReLU()(x)
    return x


def build(side, dropout):
    """The paper's network for square maps, channels last."""
    width = {name: above for name, _, above in STAGES}
    noisy = keras.Input((*side, 1))
    first = stage(noisy, "enc1", width["enc1"])
    second = stage(layers.MaxPool2D()(first), "enc2", width["enc2"])
    x = stage(layers.MaxPool2D()(second), "bottleneck", width["bottleneck"])
    x = layers.Dropout(dropout)(x)
    for name, skip in (("dec2", second), ("dec1", first)):
        x = layers.UpSampling2D(interpolation="bilinear")(x)
        x = stage(layers.Concatenate()([x, skip]), name, width[name])
    return keras.Model(noisy, layers.Conv2D(1, 1, activation="sigmoid", name="out")(x))


def load(tensors, side, dropout=0.1):
    model = build(side, dropout)
    for layer in model.layers:
        if isinstance(layer, layers.Conv2D):
            parts = [tensors[layer.name + ".weight"].transpose(2, 3, 1, 0)]
            layer.set_weights(parts + ([tensors[layer.name + ".bias"]] if layer.use_bias else []))
        elif isinstance(layer, layers.BatchNormalization):
            layer.set_weights([tensors[f"{layer.name}.{part}"]
                               for part in ("weight", "bias", "running_mean", "running_var")])
    return model


def frozen(function):
    """The function with its variables as constants, so that TensorFlow folds BatchNorm."""
    from tensorflow.python.framework.convert_to_constants import convert_variables_to_constants_v2
    constants = convert_variables_to_constants_v2(function)
    return lambda x: constants(x)[0]


def inference(shared, xla, reduced, batch):
    tf.config.optimizer.set_experimental_options({"auto_mixed_precision_onednn_bfloat16": reduced})
    side = shared.noisy.shape[2:]
    model = load(shared.weights, side)
    signature = tf.TensorSpec((batch, *side, 1), tf.float32)
    function = tf.function(lambda x: model(x, training=False), jit_compile=xla)
    estimate = function if xla else frozen(function.get_concrete_function(signature))

    def run(frames):
        x = tf.convert_to_tensor(frames.reshape(-1, *side, 1))
        return estimate(x).numpy().reshape(frames.shape)
    return run


def mean_loss(estimate, clean):
    d = estimate - clean
    ssim = tf.reduce_mean(tf.image.ssim(clean, estimate, 1.0))
    weighted = tf.reduce_mean((1 + 4 * clean) * d ** 2)
    return 0.5 * tf.reduce_mean(tf.abs(d)) + 0.4 * (1 - ssim) + 0.1 * weighted


def training(xla, tensors, rate, dropout):
    optimiser = keras.optimizers.AdamW(rate, weight_decay=0.004, epsilon=1e-7)
    model = None

    @tf.function(jit_compile=xla)
    def update(noisy, clean):
        with tf.GradientTape() as tape:
            loss = mean_loss(model(noisy, training=True), clean)
        optimiser.apply(tape.gradient(loss, model.trainable_variables), model.trainable_variables)
        return loss

    def step(noisy, clean):
        nonlocal model
        if model is None:
            model = load(tensors, noisy.shape[2:], dropout)
            optimiser.build(model.trainable_variables)
        return float(update(*(tf.convert_to_tensor(np.moveaxis(maps, 1, -1)) for maps in (noisy, clean))))
    return step


def candidates(shared):
    tf.config.threading.set_intra_op_parallelism_threads(shared.threads)
    tf.config.threading.set_inter_op_parallelism_threads(1)
    for way, xla in WAYS:
        yield Candidate("training", way, lambda *a, x=xla: training(x, *a))
        yield from single_and_batched("", way, lambda batch, x=xla: inference(shared, x, False, batch))
    yield from single_and_batched("-reduced", "graph, bf16", lambda batch: inference(shared, False, True, batch))
