/* SPDX-License-Identifier: BSD-3-Clause */
/* A recording of phase through a model; contract as ptie_denoise in <ptie/run.h>. */
#ifndef PTIE_RUN_DENOISE_H
#define PTIE_RUN_DENOISE_H

#include <ptie/run.h>

#include "kernel/engine.h"

ptie_status ptie_denoise_recording(const ptie_engine *engine, const ptie_denoise_params *params,
                                   ptie_progress progress);

#endif
