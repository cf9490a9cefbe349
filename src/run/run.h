/* SPDX-License-Identifier: BSD-3-Clause */
/* The pipeline inside the library; contract as in <ptie/run.h>, arguments already checked. */
#ifndef PTIE_RUN_RUN_H
#define PTIE_RUN_RUN_H

#include <ptie/run.h>

#include "kernel/engine.h"

/* The recording in messages and provenance: that of all planes, or of I+. */
const char *ptie_run_name(const ptie_run_params *params);

ptie_status ptie_run_pipeline(const ptie_engine *engine, const ptie_run_params *params,
                              ptie_run_summary *summary, ptie_progress progress);

#endif
