/* SPDX-License-Identifier: BSD-3-Clause */
#include "measures.h"

#include <math.h>
#include <stdio.h>

#include "json.h"
#include "table.h"

const char *measure_name(int which) {
    static const char *const names[MEASURES] = {"MGM (rad/px)", "SBR",        "BNS (rad)",
                                                "CNR",          "RMSE (rad)", "correlation",
                                                "signal kept",  "residual"};
    return names[which];
}

const char *measure_key(int which) {
    static const char *const keys[MEASURES] = {
        "mgm", "sbr", "bns", "cnr", "rmse_rad", "correlation", "signal_kept", "residual"};
    return keys[which];
}

ptie_stat *measure_in(ptie_run_row *row, int which) {
    ptie_stat *const fields[MEASURES] = {&row->mgm,         &row->sbr,      &row->bns,
                                         &row->cnr,         &row->rmse_rad, &row->correlation,
                                         &row->signal_kept, &row->residual};
    return fields[which];
}

static bool known(measured *columns, int count, int which) {
    for (int c = 0; c < count; c++)
        if (!isnan(measure_in(&columns[c].row, which)->mean)) return true;
    return false;
}

void print_measures(measured *columns, int count) {
    table t = {.rows = 0};
    int row = 0;
    for (int c = 0; c < count; c++) table_set(&t, 0, c + 1, "%s", columns[c].name);
    for (int k = 0; k < MEASURES; k++) {
        if (!known(columns, count, k)) continue; /* there is no truth to compare with */
        table_set(&t, ++row, 0, "%s", measure_name(k));
        for (int c = 0; c < count; c++) {
            char text[CELL_BYTES];
            stat_text(text, *measure_in(&columns[c].row, k));
            table_set(&t, row, c + 1, "%s", text);
        }
    }
    if (row > 0) table_print(&t);
}

void print_measures_json(measured *columns, int count) {
    for (int c = 0; c < count; c++) {
        printf("  ");
        json_text(stdout, columns[c].key);
        printf(": {");
        for (int k = 0; k < MEASURES; k++) {
            printf("%s\"%s\": {\"mean\": ", k ? ", " : "", measure_key(k));
            json_number(stdout, measure_in(&columns[c].row, k)->mean);
            printf(", \"std\": ");
            json_number(stdout, measure_in(&columns[c].row, k)->std);
            printf("}");
        }
        printf("}%s\n", c + 1 < count ? "," : "");
    }
}
