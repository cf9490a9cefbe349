"""OpenVINO: latency and throughput hints; bf16 and f16 through its inference precision."""
import numpy as np
import openvino

from shared import Candidate, single_and_batched


def versions():
    return {"OpenVINO": openvino.__version__.split("-")[0]}


def compiled(shared, batch, hint, precision):
    core = openvino.Core()
    model = core.read_model(shared.graph)
    model.reshape([batch, *shared.noisy.shape[1:]])
    return core.compile_model(model, "CPU", {"INFERENCE_NUM_THREADS": shared.threads, "PERFORMANCE_HINT": hint,
                                             "INFERENCE_PRECISION_HINT": precision})


def latency(shared, batch, precision):
    request = compiled(shared, batch, "LATENCY", precision).create_infer_request()
    return lambda frames: request.infer([frames], share_inputs=True, share_outputs=True)[0]


def throughput(shared, precision):
    """Frames one by one, as many at a time as OpenVINO finds best."""
    queue = openvino.AsyncInferQueue(compiled(shared, 1, "THROUGHPUT", precision))
    estimates = np.empty_like(shared.noisy)

    def keep(request, index):
        estimates[index] = request.get_output_tensor().data[0]

    def run(frames):
        for index, frame in enumerate(frames):
            queue.start_async([frame[None]], index, share_inputs=True)
        queue.wait_all()
        return estimates
    queue.set_callback(keep)
    return run


def candidates(shared):
    for row, precision in (("", "f32"), ("-reduced", "bf16"), ("-reduced", "f16")):
        suffix = "" if precision == "f32" else f", {precision}"
        yield from single_and_batched(row, "latency" + suffix,
                                      lambda batch, p=precision: latency(shared, batch, p))
        yield Candidate("frames" + row, "throughput" + suffix, lambda p=precision: throughput(shared, p))
