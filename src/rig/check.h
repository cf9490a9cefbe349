/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigs against recordings; contracts as in <ptie/rig.h>, arguments already checked. */
#ifndef PTIE_RIG_CHECK_H
#define PTIE_RIG_CHECK_H

#include <ptie/rig.h>

#include "base/status.h"

ptie_status ptie_rig_compare(const ptie_rig *rig, const char *recording,
                             const char *const plane[PTIE_ROLES], const char *target,
                             ptie_rig_report *report);
ptie_status ptie_rig_measure(ptie_plane_calibration calibration[PTIE_ROLES], const ptie_rig *rig,
                             const char *recording, const char *const plane[PTIE_ROLES]);

#endif
