/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets: everything that decides what samples look like; contracts as in <ptie/dataset.h>. */
#ifndef PTIE_TRAIN_PRESET_H
#define PTIE_TRAIN_PRESET_H

#include <ptie/dataset.h>

#include "flow/flow.h"

struct ptie_preset {
    char name[64];
    int base; /* built-in preset that gives the keys a file leaves out */
    int32_t width_px, height_px;
    ptie_flow_mix mix;
    ptie_range amplitude_rad; /* uniform; a parametric map in [0, 1] is multiplied by it */
    double wavelength_m, pixel_m, defocus_m;
    int propagation, boundary; /* ptie_propagation, ptie_boundary */
    ptie_range noise;          /* relative standard deviation per image, log-uniform */
    char *text;                /* the preset as INI */
};

/* Loads a built-in preset, or an INI file if `name` contains '/' or ends in ".ini". */
ptie_status ptie_preset_read(ptie_preset **out, const char *name);

#endif
