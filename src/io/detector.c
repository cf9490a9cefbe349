/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/detector.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

#define INSTRUMENT "/entry/instrument"
#define DETECTOR INSTRUMENT "/detector"

typedef enum fact_kind { TEXT, NUMBER, INTEGER } fact_kind; /* char[], double, int32_t */

typedef struct fact {
    const char *name;
    fact_kind kind;
    size_t offset, bytes; /* of the field */
} fact;

#define FACT(kind, field)                                                                          \
    {#field, kind, offsetof(ptie_recording_info, field), sizeof((ptie_recording_info){0}.field)}

static const fact facts[] = {
    FACT(TEXT, camera),      FACT(TEXT, date),          FACT(TEXT, comment),
    FACT(NUMBER, exposure_s), FACT(NUMBER, black_level), FACT(NUMBER, white_level),
    FACT(INTEGER, bit_depth), FACT(INTEGER, roi_x_px),   FACT(INTEGER, roi_y_px),
};

enum { FACTS = sizeof facts / sizeof *facts, LARGEST_INTEGER = 32768 };

static ptie_status write_fact(ptie_h5 *h5, const fact *f, const char *field) {
    double number;
    int32_t integer;
    switch (f->kind) {
    case TEXT: return ptie_h5_set_text(h5, DETECTOR, f->name, field);
    case NUMBER:
        memcpy(&number, field, sizeof number);
        return ptie_h5_set_number(h5, DETECTOR, f->name, number);
    case INTEGER:
        memcpy(&integer, field, sizeof integer);
        return ptie_h5_set_integer(h5, DETECTOR, f->name, integer);
    }
    return PTIE_OK;
}

/* All fields are 0 or "" when unknown. */
static bool is_known(const fact *f, const char *field) {
    static const char zeros[sizeof(double)];
    return f->kind == TEXT ? *field != 0 : memcmp(field, zeros, f->bytes) != 0;
}

ptie_status ptie_detector_write(ptie_h5 *h5, const ptie_recording_info *info) {
    const char *fields = (const char *)info;
    bool begun = false;
    for (size_t i = 0; i < FACTS; i++) {
        const fact *f = &facts[i];
        if (!is_known(f, fields + f->offset)) continue;
        if (!begun) {
            PTIE_TRY(ptie_h5_set_text(h5, INSTRUMENT, "NX_class", "NXinstrument"));
            PTIE_TRY(ptie_h5_set_text(h5, DETECTOR, "NX_class", "NXdetector"));
            begun = true;
        }
        PTIE_TRY(write_fact(h5, f, fields + f->offset));
    }
    return PTIE_OK;
}

static void read_fact(ptie_h5 *h5, const fact *f, char *field) {
    char *text;
    double number;
    int64_t whole;
    if (f->kind == TEXT && ptie_h5_get_text(h5, DETECTOR, f->name, &text) == PTIE_OK) {
        snprintf(field, f->bytes, "%s", text);
        ptie_free(text);
    } else if (f->kind == NUMBER && ptie_h5_get_number(h5, DETECTOR, f->name, &number) == PTIE_OK) {
        if (isfinite(number)) memcpy(field, &number, sizeof number);
    } else if (f->kind == INTEGER && ptie_h5_get_integer(h5, DETECTOR, f->name, &whole) == PTIE_OK) {
        const int32_t integer = (int32_t)whole;
        if (whole >= 0 && whole <= LARGEST_INTEGER) memcpy(field, &integer, sizeof integer);
    }
}

void ptie_detector_read(ptie_h5 *h5, ptie_recording_info *info) {
    if (!ptie_h5_exists(h5, DETECTOR)) return;
    for (size_t i = 0; i < FACTS; i++) read_fact(h5, &facts[i], (char *)info + facts[i].offset);
}
