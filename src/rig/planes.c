/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/planes.h"

#include <math.h>

#define LEAST_STEP_M 1e-9

const char *const ptie_role_names[PTIE_ROLES] = {"plus", "minus", "zero", "plus2", "minus2"};

/* Bit i: the set has plane i. */
static const uint8_t set_roles[PTIE_SETS] = {
    [PTIE_SET_PAIR] = 1 << PTIE_PLUS | 1 << PTIE_MINUS,
    [PTIE_SET_TRIPLE] = 1 << PTIE_PLUS | 1 << PTIE_MINUS | 1 << PTIE_ZERO,
    [PTIE_SET_FIVE] = (1 << PTIE_ROLES) - 1,
    [PTIE_SET_REFERENCE] = 1 << PTIE_PLUS,
};

bool ptie_set_has(ptie_plane_set set, int role) {
    return set_roles[set] >> role & 1;
}

ptie_plane_set ptie_rig_set(const ptie_rig *rig) {
    int roles = 0, set = 0;
    for (int i = 0; i < PTIE_ROLES; i++) roles |= rig->plane[i].used << i;
    while (set < PTIE_SETS &&
           (set_roles[set] != roles || (set == PTIE_SET_REFERENCE) != rig->one_plane))
        set++;
    return (ptie_plane_set)set;
}

int32_t ptie_rig_planes(const ptie_rig *rig, ptie_role role[PTIE_ROLES], double z_m[PTIE_ROLES]) {
    int32_t count = 0;
    for (int i = 0; i < PTIE_ROLES; i++) {
        const bool stands_for_focus = rig->one_plane && i == PTIE_ZERO;
        if (!rig->plane[i].used && !stands_for_focus) continue;
        role[count] = (ptie_role)i;
        z_m[count++] = stands_for_focus ? 0 : rig->plane[i].defocus_m;
    }
    return count;
}

ptie_status ptie_rig_check_planes(const ptie_rig *rig, const char *where) {
    ptie_role role[PTIE_ROLES];
    double z_m[PTIE_ROLES];
    const int32_t count = ptie_rig_planes(rig, role, z_m);
    if (ptie_rig_set(rig) == PTIE_SETS)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "%s: the planes make no set (expected plus and minus, these and zero, all five, "
            "or plus and one_plane)",
            where);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = 0; j < i; j++)
            if (fabs(z_m[i] - z_m[j]) < LEAST_STEP_M)
                return PTIE_FAIL(PTIE_EINVAL,
                                 "%s: defocus: '%s' and '%s' are one plane (expected different "
                                 "distances, found %g m and %g m)",
                                 where, ptie_role_names[role[j]], ptie_role_names[role[i]], z_m[j],
                                 z_m[i]);
    if (z_m[0] < z_m[1] && !rig->one_plane)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: defocus: '%s' must lie below 'plus' (found %g m and %g m)", where,
                         ptie_role_names[role[1]], z_m[1], z_m[0]);
    return PTIE_OK;
}

double ptie_rig_pixel_m(const ptie_rig *rig) {
    return rig->pixel_m * rig->binning * (rig->layout == PTIE_LAYOUT_MOSAIC ? 2 : 1);
}

double ptie_rig_linear_period_m(const ptie_rig *rig) {
    double farthest_m = 0;
    for (int i = 0; i < PTIE_ROLES; i++)
        if (rig->plane[i].used) farthest_m = fmax(farthest_m, fabs(rig->plane[i].defocus_m));
    return sqrt(ptie_chi(rig->wavelength_m, farthest_m, 1) / PTIE_LINEAR_CHI); /* chi falls as 1 / period^2 */
}

ptie_solver_params ptie_rig_solver(const ptie_rig *rig, int32_t width_px, int32_t height_px) {
    ptie_role role[PTIE_ROLES];
    ptie_solver_params p = {
        .struct_size = sizeof p,
        .width_px = width_px,
        .height_px = height_px,
        .pixel_m = ptie_rig_pixel_m(rig),
        .wavelength_m = rig->wavelength_m,
        .boundary = rig->boundary,
        .method = rig->method,
        .cutoff_m = rig->cutoff_m > 0 ? rig->cutoff_m : 0,
        .max_iterations = rig->max_iterations,
    };
    p.plane_count = ptie_rig_planes(rig, role, p.z_m);
    return p;
}
