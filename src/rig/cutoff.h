/* SPDX-License-Identifier: BSD-3-Clause */
/* A cut-off chosen from the recording itself, docs/math.md (M15), (M16). */
#ifndef PTIE_RIG_CUTOFF_H
#define PTIE_RIG_CUTOFF_H

#include "rig/prepare.h"

/* cutoff_m (out): the rig's, or, where that says so, the median of the choices for frames spread evenly over
   frame = first + i step, i < count. */
ptie_status ptie_run_cutoff(double *cutoff_m, const ptie_rig *rig, ptie_source *source,
                            const ptie_prepare *preparation, int64_t first, int64_t count, int64_t step);

#endif
