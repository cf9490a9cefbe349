/* SPDX-License-Identifier: BSD-3-Clause */
/* A recording as another file; contract as ptie_convert in <ptie/convert.h>. */
#ifndef PTIE_RUN_CONVERT_H
#define PTIE_RUN_CONVERT_H

#include <ptie/convert.h>

#include "base/pool.h"

/* colours: 256 of 0xRRGGBB for params->colours; NULL: grey. */
ptie_status ptie_convert_recording(ptie_pool *pool, const ptie_convert_params *params,
                                   const uint32_t *colours, ptie_progress progress);

#endif
