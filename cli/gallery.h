/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef CLI_GALLERY_H
#define CLI_GALLERY_H

#include <ptie/flow.h>

/* Draws every morphology of both families, with size, optics and seed of `flow`.  Returns an exit
 * code. */
int draw_gallery(const char *path, const ptie_flow_params *flow, bool force);

#endif
