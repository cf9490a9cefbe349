/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of a recording of phase maps, printed as the paper's Table 3. */
#ifndef CLI_MEASURES_H
#define CLI_MEASURES_H

#include <ptie/run.h>

enum { MGM, SBR, BNS, CNR, RMSE, CORRELATION, SIGNAL_KEPT, RESIDUAL, MEASURES };

/* For people, "MGM (rad/px)", and for programs, "mgm". */
const char *measure_name(int which);
const char *measure_key(int which);
ptie_stat *measure_in(ptie_run_row *row, int which);

/* One column of the table. */
typedef struct measured {
    const char *name; /* "TIE phase" */
    const char *key;  /* in JSON: "phase" */
    ptie_run_row row;
} measured;

void print_measures(measured *columns, int count);
/* "key": {...}, one per column, without the braces around them. */
void print_measures_json(measured *columns, int count);

#endif
