/* SPDX-License-Identifier: BSD-3-Clause */
/* The phase of frames without flow, which is not flow (P11). */
#ifndef PTIE_RUN_BACKGROUND_H
#define PTIE_RUN_BACKGROUND_H

#include "rig/prepare.h"
#include "run/worker.h"

/* Gives the plan the median phase of the rig's still frames, if it names some: of at most 31 of
   them, spread over their range. */
ptie_status ptie_background_measure(ptie_frame_plan *plan, ptie_source *source,
                                    const ptie_prepare *prepare, const ptie_rig *rig);

#endif
