/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench_results.h"

#include <math.h>
#include <string.h>

#include <ptie/version.h>

#include "json.h"
#include "table.h"

enum { NAME, THREADS, MEDIAN, UNIT, RANGE, GFLOPS, SHARE };

/* Four digits without an exponent; "-" for what is not known. */
static const char *number_text(char text[CELL_BYTES], double value) {
    if (isfinite(value))
        snprintf(text, CELL_BYTES, "%.*f", value < 10 ? 3 : value < 100 ? 2 : value < 1000, value);
    else
        snprintf(text, CELL_BYTES, "-");
    return text;
}

static void set_result(table *t, int row, const ptie_bench_result *r) {
    char low[CELL_BYTES], high[CELL_BYTES], text[CELL_BYTES];
    table_set(t, row, NAME, "  %s", r->name);
    table_set(t, row, THREADS, "%d", r->threads);
    table_set(t, row, MEDIAN, "%s", number_text(text, r->median));
    table_set(t, row, UNIT, "%s", r->unit);
    if (r->samples > 1)
        table_set(t, row, RANGE, "%.28s .. %.28s", number_text(low, r->low),
                  number_text(high, r->high));
    if (isfinite(r->gflops)) table_set(t, row, GFLOPS, "%s", number_text(text, r->gflops));
    if (isfinite(r->peak_share)) table_set(t, row, SHARE, "%.0f %%", 100 * r->peak_share);
}

void print_bench_table(const bench_results *b, bool markdown) {
    static const char *const titles[] = {"",      "threads", "median", "",
                                         "range", "GFLOP/s", "of peak"};
    table t = {.rows = 0};
    for (int c = 0; c <= SHARE; c++) table_set(&t, 0, c, "%s", titles[c]);
    for (size_t i = 0; i < b->count && t.rows < TABLE_ROWS - 1; i++) {
        const bool first = i == 0 || strcmp(b->results[i].group, b->results[i - 1].group) != 0;
        if (first) table_set(&t, t.rows, NAME, markdown ? "**%s**" : "%s", b->results[i].group);
        set_result(&t, t.rows, &b->results[i]);
    }
    printf("ptie %s, commit %s, %s%s", ptie_version(), b->machine.commit, b->machine.compiler,
           markdown ? "; " : "\n");
    printf("%s, %s, %d thread%s, %g s per measurement\n\n", b->machine.processor, b->level,
           b->threads, b->threads > 1 ? "s" : "", b->seconds);
    if (markdown)
        table_print_markdown(&t);
    else
        table_print(&t);
}

static void json_member(FILE *out, const char *key, const char *text) {
    fprintf(out, "  \"%s\": ", key);
    json_text(out, text);
    fprintf(out, ",\n");
}

static void print_result(FILE *out, const ptie_bench_result *r) {
    const struct {
        const char *key;
        double value;
    } numbers[] = {{"threads", r->threads},
                   {"samples", r->samples},
                   {"median", r->median},
                   {"low", r->low},
                   {"high", r->high},
                   {"gflops", r->gflops},
                   {"peak_gflops", r->peak_gflops},
                   {"peak_share", r->peak_share}};
    fprintf(out, "    {\"group\": ");
    json_text(out, r->group);
    fprintf(out, ", \"name\": ");
    json_text(out, r->name);
    fprintf(out, ", \"unit\": ");
    json_text(out, r->unit);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        fprintf(out, ", \"%s\": ", numbers[i].key);
        json_number(out, numbers[i].value);
    }
    fprintf(out, "}");
}

void print_bench_json(FILE *out, const bench_results *b) {
    fprintf(out, "{\n");
    json_member(out, "version", ptie_version());
    json_member(out, "commit", b->machine.commit);
    json_member(out, "compiler", b->machine.compiler);
    json_member(out, "processor", b->machine.processor);
    json_member(out, "level", b->level);
    fprintf(out, "  \"threads\": %d,\n  \"seconds\": ", b->threads);
    json_number(out, b->seconds);
    fprintf(out, ",\n  \"results\": [");
    for (size_t i = 0; i < b->count; i++) {
        fprintf(out, i ? ",\n" : "\n");
        print_result(out, &b->results[i]);
    }
    fprintf(out, "\n  ]\n}\n");
}
