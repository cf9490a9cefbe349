/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/optics.h>: arguments checked, then inward. */
#include <ptie/optics.h>

#include <math.h>

#include "api/params.h"
#include "optics/optics.h"

static ptie_status check_params(const ptie_optics_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->width_px, 2, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(p->height_px, 2, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_number(p->pixel_m, 1e-9, 1, where, "pixel_m"));
    PTIE_TRY(ptie_check_number(p->wavelength_m, 1e-12, 1e-2, where, "wavelength_m"));
    PTIE_TRY(ptie_check_number(fabs(p->defocus_m), 1e-9, 1e3, where, "magnitude of defocus_m"));
    PTIE_TRY(ptie_check_integer(p->boundary, PTIE_PERIODIC, PTIE_MIRROR, where, "boundary"));
    return ptie_check_integer(p->propagation, PTIE_TIE_SPECTRAL, PTIE_ANGULAR_SPECTRUM, where,
                              "propagation");
}

ptie_status ptie_optics_create(ptie_optics **out, ptie_ctx *ctx, const ptie_optics_params *params) {
    static const char where[] = "ptie_optics_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    ptie_optics_params known;
    ptie_optics_params_init(&known);
    PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_params(&known, where));
    return ptie_optics_plan(out, &known);
}

size_t ptie_optics_scratch_bytes(const ptie_optics *optics) {
    return optics ? ptie_optics_scratch(optics) : 0;
}

ptie_status ptie_optics_run(const ptie_optics *optics, float *i_plus, float *i_minus,
                            const float *phase_rad, const float *i_zero, void *scratch) {
    static const char where[] = "ptie_optics_run";
    PTIE_TRY(ptie_check_pointer(optics, where, "optics"));
    PTIE_TRY(ptie_check_pointer(i_plus, where, "i_plus"));
    PTIE_TRY(ptie_check_pointer(i_minus, where, "i_minus"));
    PTIE_TRY(ptie_check_pointer(phase_rad, where, "phase_rad"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    return ptie_optics_defocus(optics, i_plus, i_minus, phase_rad, i_zero, scratch);
}
