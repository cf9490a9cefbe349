/* SPDX-License-Identifier: BSD-3-Clause */
/* Synthetic recordings; contract as in <ptie/simulate.h>, arguments already checked. */
#ifndef PTIE_SIMULATE_SIMULATE_H
#define PTIE_SIMULATE_SIMULATE_H

#include <ptie/simulate.h>

#include "base/pool.h"

ptie_status ptie_simulate_run(ptie_pool *pool, const ptie_simulate_params *params,
                              ptie_progress progress);

#endif
