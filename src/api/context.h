/* SPDX-License-Identifier: BSD-3-Clause */
/* What a context is inside: an engine. */
#ifndef PTIE_API_CONTEXT_H
#define PTIE_API_CONTEXT_H

#include <ptie/context.h>

#include "kernel/engine.h"

struct ptie_ctx {
    ptie_engine engine;
};

#endif
