/* SPDX-License-Identifier: BSD-3-Clause */
/* Model files: what loads is saved and loads again. */
#include "fuzz.h"

#include "nn/nn.h"
#include "support/support.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    const char *path = fuzz_file("input.safetensors", data, bytes);
    ptie_model *model, *again;
    ptie_status status = ptie_nn_load(&model, path);
    fuzz_status(status, path);
    FUZZ_CHECK((status == PTIE_OK) == (model != NULL));
    if (status != PTIE_OK) return 0;
    const char *saved = support_temporary("saved.safetensors");
    FUZZ_CHECK(ptie_nn_save(model, saved, true) == PTIE_OK);
    FUZZ_CHECK(ptie_nn_load(&again, saved) == PTIE_OK);
    ptie_nn_free(model);
    ptie_nn_free(again);
    return 0;
}
