/* SPDX-License-Identifier: BSD-3-Clause */
/* Small whole jobs, from files to files, on one thread beside the caller's. */
#ifndef PTIE_TESTS_PIPELINES_H
#define PTIE_TESTS_PIPELINES_H

#include <ptie/status.h>

enum { PIPELINE_OUTPUTS = 3 };

typedef struct pipeline {
    const char *name;
    ptie_status (*run)(void);
    const char *outputs[PIPELINE_OUTPUTS]; /* file names for pipeline_path; NULL behind the last */
    bool keeps; /* what is finished stays in ".part" files, and running it again goes on from there */
} pipeline;

extern const pipeline pipelines[];
extern const int pipeline_count;

/* Inputs of all pipelines. */
void pipelines_prepare(void);
/* A file of theirs; stays valid. */
const char *pipeline_path(const char *name);

#endif
