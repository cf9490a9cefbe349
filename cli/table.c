/* SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void table_set(table *t, int row, int column, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(t->cell[row][column], CELL_BYTES, format, arguments);
    va_end(arguments);
    if (row >= t->rows) t->rows = row + 1;
    if (column >= t->columns) t->columns = column + 1;
}

/* Characters of UTF-8 text. */
static int text_width(const char *text) {
    int width = 0;
    for (; *text; text++) width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

void table_print(const table *t) {
    int width[TABLE_COLUMNS] = {0};
    for (int r = 0; r < t->rows; r++)
        for (int c = 0; c < t->columns; c++) {
            int cell = text_width(t->cell[r][c]);
            if (cell > width[c]) width[c] = cell;
        }
    for (int r = 0; r < t->rows; r++) {
        for (int c = 0; c < t->columns; c++) {
            const char *text = t->cell[r][c];
            int space = width[c] - text_width(text);
            if (c == 0)
                printf("%s%*s", text, space, "");
            else
                printf("   %*s%s", space, "", text);
        }
        putchar('\n');
    }
}

void table_print_markdown(const table *t) {
    for (int r = 0; r < t->rows; r++) {
        for (int c = 0; c < t->columns; c++) printf("| %s ", t->cell[r][c]);
        printf("|\n");
        for (int c = 0; r == 0 && c < t->columns; c++) printf(c ? "|--:" : "|:--");
        if (r == 0) printf("|\n");
    }
}

void stat_text(char text[CELL_BYTES], ptie_stat stat) {
    if (isnan(stat.mean)) {
        snprintf(text, CELL_BYTES, "-");
        return;
    }
    double size = fmax(fabs(stat.mean), fabs(stat.std));
    int decimals = size > 0 && isfinite(size) ? 2 - (int)floor(log10(size)) : 2;
    decimals = decimals < 0 ? 0 : decimals > 9 ? 9 : decimals;
    if (stat.std > 0)
        snprintf(text, CELL_BYTES, "%.*f ± %.*f", decimals, stat.mean, decimals, stat.std);
    else /* of one frame */
        snprintf(text, CELL_BYTES, "%.*f", decimals, stat.mean);
}
