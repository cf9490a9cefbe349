/* SPDX-License-Identifier: BSD-3-Clause */
/* What a reader of a run's result should know before believing it. */
#ifndef PTIE_RUN_WARNINGS_H
#define PTIE_RUN_WARNINGS_H

#include "rig/source.h"
#include "run/measure.h"

/* Adds lines to summary->warning.  of_frame: PTIE_FRAME_NUMBERS running numbers; early, late: the phase's mean in
   the background over the first and the last tenth of the frames. */
void ptie_run_warn(ptie_run_summary *summary, const ptie_source *source, const ptie_rig *rig,
                   const ptie_running *of_frame, const ptie_running *early, const ptie_running *late);

#endif
