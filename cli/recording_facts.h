/* SPDX-License-Identifier: BSD-3-Clause */
/* What a person wants to know of a recording. */
#ifndef CLI_RECORDING_FACTS_H
#define CLI_RECORDING_FACTS_H

#include <ptie/ptie.h>

#include "facts.h"

/* Opens the recording and adds what its file says and what its first frame holds. */
ptie_status add_recording(facts *facts, const char *path);

#endif
