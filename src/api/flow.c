/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/flow.h"

#include <string.h>

#include "api/params.h"
#include "base/text.h"
#include "flow/morphology.h"

#define WHERE "ptie_flow_render"

void ptie_flow_params_init(ptie_flow_params *params) {
    *params = (ptie_flow_params){.struct_size = sizeof *params,
                                 .width_px = 256,
                                 .height_px = 256,
                                 .pixel_m = 20e-6,
                                 .wavelength_m = 532e-9,
                                 .family = PTIE_PARAMETRIC,
                                 .morphology = "mix"};
}

int32_t ptie_morphology_count(void) {
    return PTIE_MORPHOLOGIES;
}

const char *ptie_morphology_name(int32_t which) {
    const ptie_morphology *morphology = ptie_morphology_get(which);
    return morphology ? morphology->name : NULL;
}

const char *ptie_morphology_title(int32_t which) {
    const ptie_morphology *morphology = ptie_morphology_get(which);
    return morphology ? morphology->title : NULL;
}

/* PTIE_MORPHOLOGIES stands for "mix". */
static ptie_status find_morphology(int32_t *which, const char *name) {
    const char *words[PTIE_MORPHOLOGIES + 2] = {0};
    for (int32_t i = 0; i < PTIE_MORPHOLOGIES; i++) words[i] = ptie_morphology_name(i);
    words[PTIE_MORPHOLOGIES] = "mix";
    const char *nearest = ptie_nearest_word(name, words);
    for (*which = 0; words[*which] != nearest;) ++*which;
    if (strcmp(nearest, name) == 0) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENAME, WHERE ": unknown morphology '%s' (did you mean '%s'?)", name,
                     nearest);
}

static ptie_status check(const ptie_flow_params *params) {
    PTIE_TRY(ptie_check_integer(params->width_px, 16, 32768, WHERE, "width_px"));
    PTIE_TRY(ptie_check_integer(params->height_px, 16, 32768, WHERE, "height_px"));
    PTIE_TRY(ptie_check_number(params->pixel_m, 1e-9, 1, WHERE, "pixel_m"));
    PTIE_TRY(ptie_check_number(params->wavelength_m, 1e-12, 1e-2, WHERE, "wavelength_m"));
    PTIE_TRY(ptie_check_integer(params->family, PTIE_PARAMETRIC, PTIE_PHYSICAL, WHERE, "family"));
    PTIE_TRY(ptie_check_number(params->time_s, 0, 1e6, WHERE, "time_s")); /* eleven days; moving structures are counted */
    return ptie_check_pointer(params->morphology, WHERE, "morphology");
}

ptie_status ptie_flow_render(float *phase, const ptie_flow_params *params) {
    ptie_flow_params own;
    int32_t which;
    ptie_flow_params_init(&own);
    PTIE_TRY(ptie_check_pointer(phase, WHERE, "phase"));
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, WHERE));
    PTIE_TRY(check(&own));
    PTIE_TRY(find_morphology(&which, own.morphology));
    if (which < PTIE_MORPHOLOGIES) return ptie_flow_single(phase, which, &own);
    ptie_flow_mix mix =
        own.family == PTIE_PHYSICAL ? ptie_flow_mix_realistic() : ptie_flow_mix_paper();
    return ptie_flow_compose(phase, &mix, &own, NULL);
}
