/* SPDX-License-Identifier: BSD-3-Clause */
/* Rig files; contracts as in <ptie/rig.h>. */
#ifndef PTIE_RUN_RIG_H
#define PTIE_RUN_RIG_H

#include <ptie/rig.h>

#include "base/status.h"

void ptie_rig_defaults(ptie_rig *rig);
ptie_status ptie_rig_read(ptie_rig *rig, const char *path);
/* The rig as INI text; NULL when memory is short.  Freed with ptie_free. */
char *ptie_rig_print(const ptie_rig *rig);

#endif
