/* SPDX-License-Identifier: BSD-3-Clause */
/* Histories of trainings: what is read prints as text that reads back to the same numbers. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "train/history.h"

static bool read_and_print(const char *text, ptie_text *printed) {
    ptie_epoch *epochs;
    size_t count;
    ptie_status status = ptie_history_parse(&epochs, &count, text, "history.csv");
    fuzz_status(status, "history.csv");
    if (status != PTIE_OK) return false;
    FUZZ_CHECK(ptie_history_best(epochs, count) <= count);
    ptie_history_print(printed, epochs, count);
    ptie_history_free(epochs);
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    char *text = fuzz_text(data, bytes);
    ptie_text once = {0}, twice = {0};
    if (read_and_print(text, &once)) {
        FUZZ_CHECK(read_and_print(once.data, &twice));
        FUZZ_CHECK(strcmp(once.data, twice.data) == 0);
    }
    ptie_text_free(&once);
    ptie_text_free(&twice);
    free(text);
    return 0;
}
