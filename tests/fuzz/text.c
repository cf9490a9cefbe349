/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities and whole numbers: the first byte chooses the quantity.  What is read prints as a text that
 * reads back to the same number. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>

#include "base/text.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes < 1) return 0;
    const ptie_quantity quantity = (ptie_quantity)(data[0] % (PTIE_SPEED + 1));
    char *text = fuzz_text(data + 1, bytes - 1), printed[PTIE_QUANTITY_BYTES];
    double value, again;
    int64_t number;
    if (!ptie_parse_quantity(text, quantity, &value)) {
        FUZZ_CHECK(isfinite(value));
        FUZZ_CHECK(!ptie_parse_quantity(ptie_print_quantity(printed, value, quantity), quantity, &again));
        FUZZ_CHECK(again == value);
    }
    if (ptie_parse_integer(text, -1000, 1000, &number)) FUZZ_CHECK(number >= -1000 && number <= 1000);
    free(text);
    return 0;
}
