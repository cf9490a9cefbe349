/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/settings.h"

#include <string.h>

#include <ptie/version.h>

#include "base/memory.h"
#include "nn/nn.h"
#include "rig/rig.h"

uint64_t ptie_hash(uint64_t hash, const void *data, size_t bytes) {
    const unsigned char *next = data;
    for (; bytes > 0; bytes -= bytes < 8 ? bytes : 8, next += 8) {
        uint64_t word = 0;
        memcpy(&word, next, bytes < 8 ? bytes : 8);
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
        hash ^= hash >> 29; /* words, unlike bytes, need their upper bits brought down */
    }
    return hash;
}

static ptie_status append_model(ptie_text *text, const ptie_model *model) {
    ptie_tensor_view *tensors;
    ptie_note *notes;
    size_t count, note_count;
    uint64_t hash = PTIE_HASH_BEGIN;
    PTIE_TRY(ptie_nn_tensors(model, &tensors, &count, &notes, &note_count));
    for (size_t i = 0; i < count; i++) {
        size_t bytes = sizeof(float);
        for (int32_t d = 0; d < tensors[i].rank; d++) bytes *= (size_t)tensors[i].shape[d];
        hash = ptie_hash(hash, tensors[i].data, bytes);
    }
    ptie_free(tensors);
    ptie_free(notes);
    ptie_text_append(text, "model = %s %016llx\n", ptie_model_name(model), (unsigned long long)hash);
    return PTIE_OK;
}

static void append_rect(ptie_text *text, const char *name, ptie_rect r) {
    ptie_text_append(text, "%s = %d,%d,%d,%d\n", name, r.x_px, r.y_px, r.width_px, r.height_px);
}

ptie_status ptie_run_settings(ptie_text *text, const ptie_run_params *params, int64_t frames, uint64_t planes) {
    ptie_text_append(text, "version = %s\n", PTIE_VERSION_STRING);
    ptie_text_append(text, "planes = %016llx\n", (unsigned long long)planes);
    ptie_text_append(text, "frames = %lld from %lld in steps of %lld\n", (long long)frames,
                     (long long)params->frames.first, (long long)params->frames.step);
    if (params->model) PTIE_TRY(append_model(text, params->model));
    ptie_text_append(text, "fast = %s\n", params->fast ? "yes" : "no");
    ptie_text_append(text, "truth = %s\n", params->truth ? params->truth : "");
    append_rect(text, "jet", params->jet);
    append_rect(text, "background", params->background);
    char *rig = ptie_rig_print(params->rig);
    ptie_text_append(text, "%s", rig ? rig : "");
    text->failed |= !rig;
    ptie_free(rig);
    return text->failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", params->output) : PTIE_OK;
}
