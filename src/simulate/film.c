/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulate/film.h"

#include "io/nexus.h"

#define PLUS PTIE_NEXUS_DATA "/plus"
#define MINUS PTIE_NEXUS_DATA "/minus"
#define TRUTH_GROUP "/entry/truth"
#define TRUTH TRUTH_GROUP "/phase"

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
    static const char process[] = PTIE_NEXUS_PROCESS;
    PTIE_TRY(ptie_nexus_process(h5, NULL, p->provenance));
    PTIE_TRY(ptie_h5_set_text(h5, process, "morphology", p->flow.morphology));
    PTIE_TRY(ptie_h5_set_text(h5, process, "family",
                              p->flow.family == PTIE_PHYSICAL ? "physical" : "parametric"));
    PTIE_TRY(ptie_h5_set_integer(h5, process, "seed", (int64_t)p->flow.seed));
    PTIE_TRY(ptie_h5_set_integer(h5, process, "index", (int64_t)p->flow.index));
    PTIE_TRY(ptie_h5_set_number(h5, process, "wavelength_m", p->flow.wavelength_m));
    return ptie_h5_set_number(h5, process, "defocus_m", p->defocus_m);
}

/* The pair of planes, in `unit`. */
static ptie_status begin(ptie_h5 *h5, const ptie_simulate_params *p, int64_t frames, const char *unit,
                         ptie_h5_type type) {
    const ptie_nexus_signal planes[] = {
        {.name = "plus", .long_name = "Intensity beyond focus", .unit = unit, .type = type},
        {.name = "minus", .long_name = "Intensity before focus", .unit = unit, .type = type}};
    const ptie_nexus_axes axes = {.frames = (uint64_t)frames,
                                  .width_px = p->flow.width_px,
                                  .height_px = p->flow.height_px,
                                  .frame_rate_hz = p->frame_rate_hz,
                                  .pixel_m = p->flow.pixel_m};
    return ptie_nexus_begin(h5, &axes, planes, 2);
}

static ptie_status describe_planes(ptie_h5 *h5, const ptie_simulate_params *p) {
    PTIE_TRY(begin(h5, p, p->frames, "I/I0", PTIE_H5_F32));
    PTIE_TRY(describe_truth(h5, p));
    PTIE_TRY(describe_simulation(h5, p));
    return ptie_h5_set_number(h5, PTIE_NEXUS_PROCESS, "noise", p->noise);
}

static ptie_status describe_sensors(ptie_h5 *h5, const ptie_simulate_params *p, int64_t frames) {
    PTIE_TRY(begin(h5, p, frames, "counts", PTIE_H5_U16));
    return describe_simulation(h5, p);
}

ptie_status ptie_film_open_planes(ptie_film *film, const ptie_simulate_params *params) {
    *film = (ptie_film){.data_set = {PLUS, MINUS, TRUTH}, .images = 3};
    PTIE_TRY(ptie_h5_create(&film->h5, params->output, params->overwrite));
    ptie_status status = describe_planes(film->h5, params);
    return status == PTIE_OK ? status : ptie_film_close(film, status);
}

ptie_status ptie_film_open_sensors(ptie_film *film, const char *path, const ptie_simulate_params *params,
                                   int64_t frames) {
    *film = (ptie_film){.data_set = {PLUS, MINUS}, .images = 2};
    PTIE_TRY(ptie_h5_create(&film->h5, path, params->overwrite));
    ptie_status status = describe_sensors(film->h5, params, frames);
    return status == PTIE_OK ? status : ptie_film_close(film, status);
}

ptie_status ptie_film_open_image(ptie_film *film, const char *path, const char *name, const ptie_recording_info *info,
                                 const ptie_simulate_params *params) {
    const ptie_writer_job job = {.path = path, .name = name, .info = *info, .overwrite = params->overwrite,
                                 .command = params->provenance};
    *film = (ptie_film){.images = 1};
    return ptie_io_create(&film->writer, &job);
}

ptie_status ptie_film_append(ptie_film *film, int64_t frame, const float *const *image) {
    if (film->writer) return ptie_io_append(film->writer, image[0]);
    for (int32_t i = 0; i < film->images; i++)
        PTIE_TRY(ptie_h5_write(film->h5, film->data_set[i], PTIE_H5_F32, (uint64_t)frame, 1, image[i]));
    return PTIE_OK;
}

ptie_status ptie_film_close(ptie_film *film, ptie_status status) {
    const ptie_film closing = *film;
    *film = (ptie_film){0};
    if (status == PTIE_OK) return closing.h5 ? ptie_h5_close(closing.h5) : ptie_io_complete(closing.writer);
    ptie_h5_discard(closing.h5);
    ptie_io_discard(closing.writer);
    return status;
}
