/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of a run as a table (.csv) that grows with it, in "<path>.part" until the run is complete. */
#ifndef PTIE_RUN_TABLE_H
#define PTIE_RUN_TABLE_H

#include "base/file.h"
#include "run/measure.h"

typedef struct ptie_table {
    ptie_output_file file;
    FILE *stream;
    bool denoised;
} ptie_table;

/* Writes the head.  Nothing happens when params->metrics_csv is NULL, also below. */
ptie_status ptie_table_open(ptie_table *table, const ptie_run_params *params);
/* frame: its number in the recording. */
ptie_status ptie_table_append(ptie_table *table, int64_t frame, const double *row);
ptie_status ptie_table_complete(ptie_table *table);
/* keep: leaves the part.  Fine on a table that is not open. */
void ptie_table_abandon(ptie_table *table, bool keep);

#endif
