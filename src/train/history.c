/* SPDX-License-Identifier: BSD-3-Clause */
#include "train/history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#define MAX_HISTORY_BYTES (1 << 26)

/* The columns after `epoch`, in the order of the file. */
typedef struct column {
    const char *name;
    size_t offset;
    bool is_count; /* uint64_t, else double */
} column;

#define TRAIN(field) offsetof(ptie_epoch, train) + offsetof(ptie_scores, field)
#define VALIDATION(field) offsetof(ptie_epoch, validation) + offsetof(ptie_scores, field)

static const column columns[] = {
    {"learning_rate", offsetof(ptie_epoch, learning_rate), false},
    {"seconds", offsetof(ptie_epoch, seconds), false},
    {"train_loss", TRAIN(loss), false},
    {"train_psnr_db", TRAIN(psnr_db), false},
    {"train_mae", TRAIN(mae), false},
    {"train_ssim", TRAIN(ssim), false},
    {"train_samples", TRAIN(samples), true},
    {"validation_loss", VALIDATION(loss), false},
    {"validation_psnr_db", VALIDATION(psnr_db), false},
    {"validation_mae", VALIDATION(mae), false},
    {"validation_ssim", VALIDATION(ssim), false},
    {"validation_samples", VALIDATION(samples), true},
};
enum { COLUMNS = sizeof columns / sizeof *columns };

static double get_number(const ptie_epoch *epoch, const column *c) {
    double value;
    memcpy(&value, (const char *)epoch + c->offset, sizeof value);
    return value;
}

static uint64_t get_count(const ptie_epoch *epoch, const column *c) {
    uint64_t value;
    memcpy(&value, (const char *)epoch + c->offset, sizeof value);
    return value;
}

void ptie_history_print(ptie_text *csv, const ptie_epoch *epochs, size_t count) {
    ptie_text_append(csv, "epoch");
    for (int i = 0; i < COLUMNS; i++) ptie_text_append(csv, ",%s", columns[i].name);
    ptie_text_append(csv, "\n");
    for (size_t e = 0; e < count; e++) {
        ptie_text_append(csv, "%d", epochs[e].epoch);
        for (int i = 0; i < COLUMNS; i++)
            if (columns[i].is_count)
                ptie_text_append(csv, ",%llu",
                                 (unsigned long long)get_count(&epochs[e], &columns[i]));
            else
                ptie_text_append(csv, ",%.17g", get_number(&epochs[e], &columns[i]));
        ptie_text_append(csv, "\n");
    }
}

/* Reads ",value" at *text and moves on. */
static bool parse_column(const char **text, ptie_epoch *epoch, const column *c) {
    if (*(*text)++ != ',') return false;
    char *end;
    void *field = (char *)epoch + c->offset;
    if (c->is_count) {
        const uint64_t value = strtoull(*text, &end, 10);
        memcpy(field, &value, sizeof value);
    } else {
        const double value = ptie_scan_number(*text, &end);
        memcpy(field, &value, sizeof value);
    }
    const bool found = end != *text;
    *text = end;
    return found;
}

static bool parse_row(const char **text, ptie_epoch *epoch) {
    char *end;
    epoch->epoch = (int32_t)strtol(*text, &end, 10);
    if (end == *text) return false;
    *text = end;
    for (int i = 0; i < COLUMNS; i++)
        if (!parse_column(text, epoch, &columns[i])) return false;
    return *(*text)++ == '\n';
}

/* An upper bound: lines, and no more than there is text for, each number having a digit and a comma. */
static size_t count_rows(const char *text) {
    size_t lines = 0, length = 0;
    for (; text[length]; length++) lines += text[length] == '\n';
    const size_t most = length / (2 * (COLUMNS + 1)) + 1;
    return lines < most ? lines : most;
}

ptie_status ptie_history_parse(ptie_epoch **epochs, size_t *count, const char *csv,
                               const char *where) {
    *epochs = NULL;
    *count = 0;
    ptie_text header = {0};
    ptie_history_print(&header, NULL, 0);
    const size_t length = header.length;
    const bool printed = !header.failed, known = printed && strncmp(csv, header.data, length) == 0;
    ptie_text_free(&header);
    if (!printed) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", where);
    if (!known)
        return PTIE_FAIL(PTIE_EFORMAT, "%s:1: not a training history (unknown columns)", where);

    const char *text = csv + length;
    const size_t most = count_rows(text) + 1; /* one more for a last half row */
    ptie_epoch *rows = calloc(most, sizeof *rows);
    if (!rows) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", where);
    size_t n = 0;
    for (; *text; n++)
        if (n == most || !parse_row(&text, &rows[n]) || rows[n].epoch != (int32_t)n + 1) {
            free(rows);
            return PTIE_FAIL(PTIE_EFORMAT,
                             "%s:%zu: damaged row (expected epoch %zu and %d numbers)", where,
                             n + 2, n + 1, COLUMNS);
        }
    *epochs = rows;
    *count = n;
    return PTIE_OK;
}

static char *side_path(const char *path, const char *suffix, ptie_text *text) {
    ptie_text_append(text, "%s%s", path, suffix);
    return text->failed ? NULL : text->data;
}

static ptie_status write_text(const char *path, const char *suffix, const char *data) {
    ptie_text name = {0};
    const bool named = side_path(path, suffix, &name);
    ptie_status status = named && data
                             ? ptie_write_file(name.data, data, strlen(data), true)
                             : PTIE_FAIL(PTIE_ENOMEM, "%s%s: out of memory", path, suffix);
    ptie_text_free(&name);
    return status;
}

static ptie_status write_csv(const char *path, const ptie_epoch *epochs, size_t count) {
    ptie_text csv = {0};
    ptie_history_print(&csv, epochs, count);
    ptie_status status = write_text(path, ".history.csv", csv.failed ? NULL : csv.data);
    ptie_text_free(&csv);
    return status;
}

/* JSON knows no infinity: null. */
static json_t *json_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *json_row(const ptie_epoch *epoch) {
    json_t *row = json_object();
    json_object_set_new(row, "epoch", json_integer(epoch->epoch));
    for (int i = 0; i < COLUMNS; i++)
        json_object_set_new(row, columns[i].name,
                            columns[i].is_count
                                ? json_integer((json_int_t)get_count(epoch, &columns[i]))
                                : json_number(get_number(epoch, &columns[i])));
    return row;
}

static ptie_status write_json(const char *path, const ptie_epoch *epochs, size_t count) {
    json_t *rows = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(rows, json_row(&epochs[i]));
    char *text = json_dumps(rows, JSON_INDENT(1));
    json_decref(rows);
    ptie_status status = write_text(path, ".history.json", text);
    free(text);
    return status;
}

ptie_status ptie_history_write(const char *path, const ptie_epoch *epochs, size_t count) {
    PTIE_TRY(write_csv(path, epochs, count));
    return write_json(path, epochs, count);
}

ptie_status ptie_history_load(ptie_epoch **epochs, size_t *count, const char *path) {
    *epochs = NULL;
    *count = 0;
    ptie_text name = {0};
    char *text = NULL;
    size_t bytes;
    ptie_status status = side_path(path, ".history.csv", &name)
                             ? ptie_read_file(&text, &bytes, name.data, MAX_HISTORY_BYTES)
                             : PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    if (status == PTIE_OK) status = ptie_history_parse(epochs, count, text, name.data);
    ptie_free(text);
    ptie_text_free(&name);
    return status;
}

void ptie_history_free(ptie_epoch *epochs) {
    free(epochs);
}

size_t ptie_history_best(const ptie_epoch *epochs, size_t count) {
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if (best == count || epochs[i].validation.loss < epochs[best].validation.loss) best = i;
    return best;
}
