/* SPDX-License-Identifier: BSD-3-Clause */
/* safetensors: what the file says of its tensors is true of them. */
#include "fuzz.h"

#include <string.h>

#include "io/safetensors.h"

static void use_tensor(const ptie_safetensors *file, size_t i) {
    const ptie_tensor_view *tensor = ptie_safetensors_tensor(file, i);
    size_t count = 1;
    FUZZ_CHECK(tensor->rank >= 0 && tensor->rank <= 4);
    for (int32_t axis = 0; axis < tensor->rank; axis++) count *= (size_t)tensor->shape[axis];
    float sum = 0;
    for (size_t v = 0; v < count; v++) sum += tensor->data[v]; /* all of it is there */
    FUZZ_CHECK(sum == sum || sum != sum);
    FUZZ_CHECK(ptie_safetensors_find(file, tensor->name) == tensor);
}

static void use_note(const ptie_safetensors *file, const ptie_note *note) {
    const char *value = ptie_safetensors_note(file, note->key);
    FUZZ_CHECK(value != NULL && strcmp(value, note->value) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    const char *path = fuzz_file("input.safetensors", data, bytes);
    ptie_safetensors *file;
    ptie_status status = ptie_safetensors_read(&file, path);
    fuzz_status(status, path);
    FUZZ_CHECK((status == PTIE_OK) == (file != NULL));
    if (status != PTIE_OK) return 0;
    const ptie_note *notes;
    const size_t count = ptie_safetensors_notes(file, &notes);
    for (size_t i = 0; i < ptie_safetensors_count(file); i++) use_tensor(file, i);
    for (size_t i = 0; i < count; i++) use_note(file, &notes[i]);
    ptie_safetensors_free(file);
    return 0;
}
