/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/simulate.h"

#include <math.h>
#include <string.h>

#include <ptie/version.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/text.h"
#include "io/nexus.h"
#include "optics/optics.h"

#define PLUS PTIE_NEXUS_DATA "/plus"
#define MINUS PTIE_NEXUS_DATA "/minus"
#define TRUTH_GROUP "/entry/truth"
#define TRUTH TRUTH_GROUP "/phase"

#define PARAMETRIC_RAD 1.0 /* phase of the value 1 unless the caller says */

/* One block of frames, as many as there are threads. */
typedef struct simulation {
    const ptie_simulate_params *params;
    ptie_optics *optics;
    size_t pixels, block, scratch_bytes;
    int64_t first;               /* frame of the block */
    float factor;                /* of the rendered flow, to rad */
    float *phase, *plus, *minus; /* (block, H, W) */
    unsigned char *scratch;      /* one part per worker */
} simulation;

static ptie_status render(const simulation *s, int64_t frame, float *phase) {
    ptie_flow_params flow = s->params->flow;
    flow.time_s += (double)frame / s->params->frame_rate_hz;
    PTIE_TRY(ptie_flow_render(phase, &flow));
    for (size_t i = 0; i < s->pixels; i++) phase[i] *= s->factor;
    return PTIE_OK;
}

static ptie_status simulate_frame(void *context, size_t i, int32_t worker) {
    simulation *s = context;
    const ptie_simulate_params *p = s->params;
    float *phase = s->phase + i * s->pixels, *plus = s->plus + i * s->pixels,
          *minus = s->minus + i * s->pixels;
    int64_t frame = s->first + (int64_t)i;
    PTIE_TRY(render(s, frame, phase));
    PTIE_TRY(ptie_optics_defocus(s->optics, plus, minus, phase, NULL,
                                 s->scratch + (size_t)worker * s->scratch_bytes));
    ptie_add_gaussian_noise(plus, s->pixels, p->noise, p->flow.seed, PTIE_STREAM_NOISE_PLUS,
                            (uint64_t)frame);
    ptie_add_gaussian_noise(minus, s->pixels, p->noise, p->flow.seed, PTIE_STREAM_NOISE_MINUS,
                            (uint64_t)frame);
    return PTIE_OK;
}

/* A physical flow is scaled by what frame 0 needs, so that it still grows and fades as it does. */
static ptie_status find_factor(simulation *s) {
    const ptie_simulate_params *p = s->params;
    s->factor = 1;
    if (p->flow.family == PTIE_PARAMETRIC) {
        s->factor = (float)(p->amplitude_rad > 0 ? p->amplitude_rad : PARAMETRIC_RAD);
    } else if (p->amplitude_rad > 0) {
        float peak = 0;
        PTIE_TRY(render(s, 0, s->phase));
        for (size_t i = 0; i < s->pixels; i++) peak = fmaxf(peak, fabsf(s->phase[i]));
        if (peak > 0) s->factor = (float)p->amplitude_rad / peak;
    }
    return PTIE_OK;
}

static ptie_status prepare(simulation *s, ptie_pool *pool) {
    const ptie_simulate_params *p = s->params;
    ptie_optics_params optics;
    ptie_optics_params_init(&optics);
    optics.width_px = p->flow.width_px;
    optics.height_px = p->flow.height_px;
    optics.pixel_m = p->flow.pixel_m;
    optics.wavelength_m = p->flow.wavelength_m;
    optics.defocus_m = p->defocus_m;
    optics.boundary = p->boundary;
    optics.propagation = p->propagation;
    PTIE_TRY(ptie_optics_plan(&s->optics, &optics));
    s->pixels = (size_t)p->flow.width_px * (size_t)p->flow.height_px;
    s->block = (size_t)ptie_pool_threads(pool);
    s->scratch_bytes = ptie_optics_scratch(s->optics);
    PTIE_TRY(ptie_alloc_status(&s->phase, s->block, s->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&s->plus, s->block, s->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&s->minus, s->block, s->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&s->scratch, s->block, s->scratch_bytes, "scratch of the optics"));
    return find_factor(s);
}

static ptie_status describe_truth(ptie_h5 *h5, const ptie_simulate_params *p) {
    const uint64_t dims[3] = {(uint64_t)p->frames, (uint64_t)p->flow.height_px,
                              (uint64_t)p->flow.width_px};
    PTIE_TRY(ptie_h5_set_text(h5, TRUTH_GROUP, "NX_class", "NXdata"));
    PTIE_TRY(ptie_h5_set_text(h5, TRUTH_GROUP, "signal", "phase"));
    PTIE_TRY(ptie_h5_dataset(h5, TRUTH, PTIE_H5_F32, 3, dims, 1));
    PTIE_TRY(ptie_h5_set_text(h5, TRUTH, "long_name", "True phase"));
    return ptie_h5_set_text(h5, TRUTH, "units", "rad");
}

static ptie_status describe_simulation(ptie_h5 *h5, const ptie_simulate_params *p) {
    static const char process[] = "/entry/process_1";
    PTIE_TRY(ptie_h5_set_text(h5, process, "NX_class", "NXprocess"));
    PTIE_TRY(ptie_h5_set_text(h5, process, "program", "ptie"));
    PTIE_TRY(ptie_h5_set_text(h5, process, "version", ptie_version()));
    if (p->provenance) PTIE_TRY(ptie_h5_set_text(h5, process, "command", p->provenance));
    PTIE_TRY(ptie_h5_set_text(h5, process, "morphology", p->flow.morphology));
    PTIE_TRY(ptie_h5_set_text(h5, process, "family",
                              p->flow.family == PTIE_PHYSICAL ? "physical" : "parametric"));
    PTIE_TRY(ptie_h5_set_integer(h5, process, "seed", (int64_t)p->flow.seed));
    PTIE_TRY(ptie_h5_set_integer(h5, process, "index", (int64_t)p->flow.index));
    PTIE_TRY(ptie_h5_set_number(h5, process, "wavelength_m", p->flow.wavelength_m));
    PTIE_TRY(ptie_h5_set_number(h5, process, "defocus_m", p->defocus_m));
    return ptie_h5_set_number(h5, process, "noise", p->noise);
}

static ptie_status describe(ptie_h5 *h5, const ptie_simulate_params *p) {
    static const ptie_nexus_signal planes[] = {
        {.name = "plus", .long_name = "Intensity beyond focus", .unit = "I/I0"},
        {.name = "minus", .long_name = "Intensity before focus", .unit = "I/I0"}};
    const ptie_nexus_axes axes = {.frames = (uint64_t)p->frames,
                                  .width_px = p->flow.width_px,
                                  .height_px = p->flow.height_px,
                                  .frame_rate_hz = p->frame_rate_hz,
                                  .pixel_m = p->flow.pixel_m};
    PTIE_TRY(ptie_nexus_begin(h5, &axes, planes, 2));
    PTIE_TRY(describe_truth(h5, p));
    return describe_simulation(h5, p);
}

/* Frame by frame, so that the file does not show how long a block was. */
static ptie_status write_block(ptie_h5 *h5, const simulation *s, uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        uint64_t frame = (uint64_t)s->first + i;
        size_t at = (size_t)i * s->pixels;
        PTIE_TRY(ptie_h5_write(h5, PLUS, PTIE_H5_F32, frame, 1, s->plus + at));
        PTIE_TRY(ptie_h5_write(h5, MINUS, PTIE_H5_F32, frame, 1, s->minus + at));
        PTIE_TRY(ptie_h5_write(h5, TRUTH, PTIE_H5_F32, frame, 1, s->phase + at));
    }
    return PTIE_OK;
}

static ptie_status write_frames(ptie_h5 *h5, simulation *s, ptie_pool *pool,
                                ptie_progress progress) {
    uint64_t frames = (uint64_t)s->params->frames;
    for (uint64_t first = 0; first < frames;) {
        uint64_t count = frames - first < s->block ? frames - first : s->block;
        s->first = (int64_t)first;
        PTIE_TRY(ptie_pool_run(pool, (size_t)count, simulate_frame, s));
        PTIE_TRY(write_block(h5, s, count));
        first += count;
        PTIE_TRY(ptie_progress_report(progress, first, frames, NULL));
    }
    return PTIE_OK;
}

static ptie_status write_recording(simulation *s, ptie_pool *pool, ptie_progress progress) {
    ptie_h5 *h5;
    PTIE_TRY(ptie_h5_create(&h5, s->params->output, s->params->overwrite));
    ptie_status status = describe(h5, s->params);
    if (status == PTIE_OK) status = write_frames(h5, s, pool, progress);
    if (status == PTIE_OK) return ptie_h5_close(h5);
    ptie_h5_discard(h5);
    return status;
}

/* As a person would write it. */
static void print_rig(ptie_text *text, const ptie_simulate_params *p) {
    char wavelength[PTIE_QUANTITY_BYTES], pixel[PTIE_QUANTITY_BYTES], defocus[PTIE_QUANTITY_BYTES],
        rate[PTIE_QUANTITY_BYTES];
    ptie_text_append(text, "; The rig of a simulated recording.\n");
    ptie_text_append(text, "[optics]\nwavelength = %s\npixel = %s\ndefocus = %s\n\n",
                     ptie_print_quantity(wavelength, p->flow.wavelength_m, PTIE_LENGTH),
                     ptie_print_quantity(pixel, p->flow.pixel_m, PTIE_LENGTH),
                     ptie_print_quantity(defocus, p->defocus_m, PTIE_LENGTH));
    ptie_text_append(text, "[planes]\nset = pair\nplus = " PLUS "\nminus = " MINUS "\n\n");
    ptie_text_append(text, "[recording]\nframe_rate = %s\n\n",
                     ptie_print_quantity(rate, p->frame_rate_hz, PTIE_RATE));
    ptie_text_append(text, "[flow]\npolarity = %s\n\n",
                     p->flow.family == PTIE_PARAMETRIC ? "positive" : "auto");
    ptie_text_append(text, "[solver]\nboundary = %s\n",
                     p->boundary == PTIE_PERIODIC ? "periodic" : "mirror");
}

static ptie_status write_rig(const ptie_simulate_params *p) {
    ptie_text text = {0};
    print_rig(&text, p);
    ptie_status status = text.failed
                             ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", p->rig)
                             : ptie_write_file(p->rig, text.data, text.length, p->overwrite);
    ptie_text_free(&text);
    return status;
}

/* Finds out before the work whether a file can be written after it. */
static ptie_status check_output(const char *path, bool overwrite) {
    ptie_output_file file;
    PTIE_TRY(ptie_output_open(&file, path, overwrite));
    ptie_output_discard(&file);
    return PTIE_OK;
}

ptie_status ptie_simulate_run(ptie_pool *pool, const ptie_simulate_params *params,
                              ptie_progress progress) {
    simulation s = {.params = params};
    ptie_status status;
    PTIE_TRY(check_output(params->output, params->overwrite));
    if (params->rig) PTIE_TRY(check_output(params->rig, params->overwrite));
    PTIE_TRY_DONE(prepare(&s, pool));
    PTIE_TRY_DONE(write_recording(&s, pool, progress));
    if (params->rig) status = write_rig(params);
done:
    ptie_optics_free(s.optics);
    ptie_free(s.phase);
    ptie_free(s.plus);
    ptie_free(s.minus);
    ptie_free(s.scratch);
    return status;
}
