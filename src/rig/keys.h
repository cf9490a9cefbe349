/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of rig files, as a table that reads, checks, prints and explains them. */
#ifndef PTIE_RIG_KEYS_H
#define PTIE_RIG_KEYS_H

#include <ptie/rig.h>

#include "base/ini.h"

/* What a plane's section says; NaN where it says nothing. */
typedef struct ptie_plane_keys {
    double defocus_m, gain, shift_x_px, shift_y_px, magnification, rotation_rad;
} ptie_plane_keys;

/* A rig as a person writes it: pitch of the sensor and magnification instead of the pixel at the
   object, one defocus for all planes unless they differ, planes as sums of channels. */
typedef struct ptie_rig_file {
    ptie_rig rig;
    double pitch_m, magnification, defocus_m;
    int set, polarity;
    char planes[PTIE_ROLES][512];
    ptie_plane_keys plane[PTIE_ROLES];
} ptie_rig_file;

extern const ptie_ini_key ptie_rig_keys[];
extern const size_t ptie_rig_key_count;

/* NULL-terminated: "pair", ... in the order of ptie_plane_set. */
extern const char *const ptie_set_names[];

/* Planes in units of 'defocus'. */
extern const double ptie_plane_steps[PTIE_ROLES];

/* A file that says nothing, but for the keys that every rig must have. */
void ptie_rig_file_defaults(ptie_rig_file *file);

#endif
