/* SPDX-License-Identifier: BSD-3-Clause */
/* The --data / --preset options of train and evaluate. */
#ifndef CLI_SAMPLES_H
#define CLI_SAMPLES_H

#include "cli.h"

typedef struct samples {
    const char *data, *preset; /* as given; one of them */
    int64_t count;             /* of a preset */
    uint64_t seed;
    ptie_preset *loaded;
    ptie_dataset *dataset;
} samples;

/* clang-format off */
#define SAMPLES_DEFAULTS {.count = 25000, .seed = 1}
#define SAMPLES_OPTIONS(s)                                                                         \
    {'d', "data", OPTION_TEXT, &(s).data, "FILE", .help = "data set file (.h5)"},                  \
    {'p', "preset", OPTION_TEXT, &(s).preset, "NAME",                                              \
     .help = "or: draw from a preset, without a file; paper, realistic, or an INI file"},          \
    {'n', "count", OPTION_INT64, &(s).count, "N", .low = 3, .high = INT32_MAX,                     \
     .help = "samples of the preset, all splits together"},                                        \
    {0, "data-seed", OPTION_SEED, &(s).seed, "N", .help = "which samples of the preset"}
/* clang-format on */

/* GO_ON with an open data set, or the exit code after a message. */
int open_samples(samples *samples, const char *name);
void close_samples(samples *samples);

#endif
