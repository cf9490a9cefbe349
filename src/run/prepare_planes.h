/* SPDX-License-Identifier: BSD-3-Clause */
/* Planes of a recording as a file; contract as in <ptie/prepare.h>, arguments already checked. */
#ifndef PTIE_RUN_PREPARE_PLANES_H
#define PTIE_RUN_PREPARE_PLANES_H

#include <ptie/prepare.h>

#include "base/pool.h"

ptie_status ptie_prepare_recording(ptie_pool *pool, const ptie_prepare_params *params,
                                   ptie_progress progress);

#endif
