/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/output.h"

#include <math.h>
#include <stdio.h>

#include <ptie/version.h>

#include "base/memory.h"
#include "base/text.h"
#include "run/rig.h"
#include "run/run.h"

#define METRICS "/entry/metrics"
#define PROCESS "/entry/process_1"

/* NeXus NXprocess: program, version, and everything that decided the result. */
static ptie_status write_process(ptie_h5 *h5, const ptie_run_params *params) {
    PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "NX_class", "NXprocess"));
    PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "program", "ptie"));
    PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "version", PTIE_VERSION_STRING));
    PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "recording", ptie_run_name(params)));
    if (params->provenance) PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "command", params->provenance));
    if (params->model) PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "model", ptie_model_name(params->model)));
    char *rig = ptie_rig_print(params->rig);
    if (!rig) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", params->output);
    ptie_status status = ptie_h5_set_text(h5, PROCESS, "rig", rig);
    ptie_free(rig);
    return status;
}

ptie_status ptie_output_create(ptie_h5 **out, const ptie_run_params *params, const ptie_nexus_axes *axes) {
    static const ptie_nexus_signal phase = {
        .name = "phase", .long_name = "Phase by the transport-of-intensity equation", .unit = "rad"};
    static const ptie_nexus_signal denoised = {.name = "denoised", .long_name = "Denoised phase", .unit = "rad"};
    /* The best map comes first: it is what viewers show. */
    const ptie_nexus_signal signals[] = {params->model ? denoised : phase, phase};
    PTIE_TRY(ptie_h5_create(out, params->output, params->overwrite));
    PTIE_TRY(ptie_nexus_begin(*out, axes, signals, params->model ? 2 : 1));
    return write_process(*out, params);
}

static ptie_status write_column(ptie_h5 *h5, const char *map, int metric, const double *values,
                                int64_t frames) {
    char path[128];
    uint64_t length = (uint64_t)frames;
    double *column;
    snprintf(path, sizeof path, METRICS "/%s/%s", map, ptie_run_metric_name(metric));
    PTIE_TRY(ptie_h5_dataset(h5, path, PTIE_H5_F64, 1, &length, 0));
    PTIE_TRY(ptie_alloc_status(&column, length, sizeof *column, path));
    for (int64_t t = 0; t < frames; t++) column[t] = values[t * PTIE_RUN_METRICS + metric];
    ptie_status status = ptie_h5_write(h5, path, PTIE_H5_F64, 0, length, column);
    ptie_free(column);
    return status;
}

ptie_status ptie_output_metrics(ptie_h5 *h5, const char *map, const double *values, int64_t frames) {
    for (int metric = 0; metric < PTIE_RUN_METRICS; metric++) {
        bool known = false;
        for (int64_t t = 0; t < frames; t++) known |= !isnan(values[t * PTIE_RUN_METRICS + metric]);
        if (!known) continue; /* no truth to compare with */
        PTIE_TRY(write_column(h5, map, metric, values, frames));
    }
    return PTIE_OK;
}

ptie_status ptie_output_regions(ptie_h5 *h5, const uint8_t *labels, int32_t width_px, int32_t height_px) {
    const uint64_t dims[2] = {(uint64_t)height_px, (uint64_t)width_px};
    PTIE_TRY(ptie_h5_dataset(h5, METRICS "/regions", PTIE_H5_U8, 2, dims, 0));
    PTIE_TRY(ptie_h5_set_text(h5, METRICS "/regions", "long_name", "0 nowhere, 1 jet, 2 background"));
    return ptie_h5_write(h5, METRICS "/regions", PTIE_H5_U8, 0, dims[0], labels);
}

static void print_columns(ptie_text *text, const char *map) {
    for (int metric = 0; metric < PTIE_RUN_METRICS; metric++)
        ptie_text_append(text, ",%s_%s", map, ptie_run_metric_name(metric));
}

static void print_values(ptie_text *text, const double *values) {
    for (int metric = 0; metric < PTIE_RUN_METRICS; metric++) {
        if (isnan(values[metric]))
            ptie_text_append(text, ",");
        else
            ptie_text_append(text, ",%.9g", values[metric]);
    }
}

ptie_status ptie_output_csv(ptie_output_file *csv, const ptie_run_params *params, const double *phase,
                            const double *denoised, int64_t frames) {
    ptie_text text = {0};
    FILE *stream;
    ptie_text_append(&text, "frame");
    print_columns(&text, "phase");
    if (denoised) print_columns(&text, "denoised");
    ptie_text_append(&text, "\n");
    for (int64_t t = 0; t < frames; t++) {
        ptie_text_append(&text, "%lld", (long long)(params->first + t * params->step));
        print_values(&text, phase + t * PTIE_RUN_METRICS);
        if (denoised) print_values(&text, denoised + t * PTIE_RUN_METRICS);
        ptie_text_append(&text, "\n");
    }
    ptie_status status = text.failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", csv->path)
                                     : ptie_output_stream(csv, &stream);
    if (status == PTIE_OK) {
        fwrite(text.data, 1, text.length, stream);
        status = ptie_close_written(stream, csv->path);
    }
    ptie_text_free(&text);
    return status;
}
