/* SPDX-License-Identifier: BSD-3-Clause */
/* Rig files; contracts as in <ptie/rig.h>. */
#ifndef PTIE_RIG_RIG_H
#define PTIE_RIG_RIG_H

#include <ptie/rig.h>

#include "base/status.h"

void ptie_rig_defaults(ptie_rig *rig);
ptie_status ptie_rig_read(ptie_rig *rig, const char *path);
/* The text of a rig file; freed with ptie_free. */
ptie_status ptie_rig_read_text(char **text, const char *path);
/* `path` names the text in messages, and is what its paths are relative to. */
ptie_status ptie_rig_parse(ptie_rig *rig, const char *text, const char *path);
ptie_status ptie_rig_change(const char *to, const char *from, const ptie_rig_setting *settings,
                            size_t count, bool overwrite);
/* The rig as INI text; NULL when memory is short.  Freed with ptie_free. */
char *ptie_rig_print(const ptie_rig *rig);

#endif
