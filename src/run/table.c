/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/table.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "base/text.h"

/* The truth's own numbers are in the result file. */
static bool shown(const ptie_table *table, int which) {
    if (which >= PTIE_ROW_OF_FRAME) return true;
    const int map = which / PTIE_RUN_METRICS;
    return map == PTIE_OF_PHASE || (map == PTIE_OF_DENOISED && table->denoised);
}

/* Whole lines at a time, so that a reader meanwhile sees no halves. */
static ptie_status put(ptie_table *table, ptie_text *line) {
    ptie_status status = PTIE_OK;
    if (line->failed)
        status = PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", table->file.path);
    else if (fwrite(line->data, 1, line->length, table->stream) != line->length || fflush(table->stream) != 0)
        status = PTIE_FAIL(PTIE_EIO, "%s: cannot write: %s", table->file.path, strerror(errno));
    ptie_text_free(line);
    return status;
}

static ptie_status put_head(ptie_table *table) {
    ptie_text line = {0};
    ptie_text_append(&line, "frame");
    for (int i = 0; i < PTIE_ROW; i++) {
        const ptie_row_name name = ptie_run_row_name(i);
        if (!shown(table, i)) continue;
        if (i >= PTIE_ROW_OF_FRAME)
            ptie_text_append(&line, ",%s", name.name);
        else
            ptie_text_append(&line, ",%s_%s", name.group, name.name);
    }
    ptie_text_append(&line, "\n");
    return put(table, &line);
}

ptie_status ptie_table_open(ptie_table *table, const ptie_run_params *params) {
    *table = (ptie_table){.denoised = params->model};
    if (!params->metrics_csv) return PTIE_OK;
    PTIE_TRY(ptie_output_open(&table->file, params->metrics_csv, params->overwrite));
    PTIE_TRY(ptie_output_stream(&table->file, &table->stream));
    return put_head(table);
}

ptie_status ptie_table_append(ptie_table *table, int64_t frame, const double *row) {
    if (!table->stream) return PTIE_OK;
    ptie_text line = {0};
    ptie_text_append(&line, "%lld", (long long)frame);
    for (int i = 0; i < PTIE_ROW; i++) {
        if (!shown(table, i)) continue;
        if (isnan(row[i]))
            ptie_text_append(&line, ",");
        else
            ptie_text_append(&line, ",%.9g", row[i]);
    }
    ptie_text_append(&line, "\n");
    return put(table, &line);
}

ptie_status ptie_table_complete(ptie_table *table) {
    if (!table->stream) return PTIE_OK;
    const ptie_status status = ptie_close_written(table->stream, table->file.path);
    table->stream = NULL;
    return status == PTIE_OK ? ptie_output_commit(&table->file) : status;
}

void ptie_table_abandon(ptie_table *table, bool keep) {
    if (table->stream) fclose(table->stream);
    table->stream = NULL;
    if (keep)
        ptie_output_keep(&table->file);
    else
        ptie_output_discard(&table->file);
}
