/* SPDX-License-Identifier: BSD-3-Clause */
/* A table of text on stdout: first column left-aligned, the others right-aligned. */
#ifndef CLI_TABLE_H
#define CLI_TABLE_H

#include <ptie/run.h>

enum { TABLE_ROWS = 256, TABLE_COLUMNS = 8, CELL_BYTES = 64 };

typedef struct table {
    char cell[TABLE_ROWS][TABLE_COLUMNS][CELL_BYTES];
    int rows, columns;
} table;

/* Sets a cell; the table grows to hold it. */
void table_set(table *table, int row, int column, const char *format, ...) PTIE_PRINTF(4, 5);
void table_print(const table *table);
/* The same for a Markdown file; row 0 is its heading. */
void table_print_markdown(const table *table);

/* "0.0738 ± 0.0124", with three digits of the larger of the two; "-" where there is no mean. */
void stat_text(char text[CELL_BYTES], ptie_stat stat);

#endif
