/* SPDX-License-Identifier: BSD-3-Clause */
/* Everything the numbers of a run depend on, as lines of text: a run may go on where another stopped if, and only
   if, these are equal. */
#ifndef PTIE_RUN_SETTINGS_H
#define PTIE_RUN_SETTINGS_H

#include <ptie/run.h>

#include "base/text.h"

/* Of data: FNV-1a over 64-bit words.  Begin with PTIE_HASH_BEGIN. */
#define PTIE_HASH_BEGIN UINT64_C(0xcbf29ce484222325)
uint64_t ptie_hash(uint64_t hash, const void *data, size_t bytes);

/* planes: hash of the first and the last frame as the solver gets them; it knows the recordings, the reference,
   and what prepares them. */
ptie_status ptie_run_settings(ptie_text *text, const ptie_run_params *params, int64_t frames, uint64_t planes);

#endif
