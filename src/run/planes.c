/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/planes.h"

ptie_solver_params ptie_rig_solver(const ptie_rig *rig, int32_t width_px, int32_t height_px) {
    ptie_solver_params p = {
        .struct_size = sizeof p,
        .width_px = width_px,
        .height_px = height_px,
        .pixel_m = rig->pixel_m * rig->binning,
        .wavelength_m = rig->wavelength_m,
        .plane_count = 1,
        .z_m = {rig->defocus_plus_m},
        .boundary = rig->boundary,
        .cutoff_m = rig->cutoff_m,
    };
    if (rig->planes != PTIE_PLANES_PAIR) p.z_m[p.plane_count++] = 0;
    if (rig->planes != PTIE_PLANES_REFERENCE) p.z_m[p.plane_count++] = rig->defocus_minus_m;
    return p;
}

void ptie_rig_order(const float **planes, const float *i_plus, const float *i_zero, const float *i_minus) {
    const float *const images[] = {i_plus, i_zero, i_minus};
    for (int i = 0; i < 3; i++)
        if (images[i]) *planes++ = images[i];
}
