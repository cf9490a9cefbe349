/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigs that come from callers. */
#ifndef PTIE_API_RIG_H
#define PTIE_API_RIG_H

#include <ptie/rig.h>

#include "base/status.h"

/* Reads a caller's rig and checks it.  PTIE_EINVAL. */
ptie_status ptie_rig_take(ptie_rig *rig, const ptie_rig *given, const char *where);
/* A file of the rig gives way to the caller's; `file` NULL: it stays. */
ptie_status ptie_rig_replace(char path[512], const char *file, const char *where);

#endif
