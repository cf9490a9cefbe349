/* SPDX-License-Identifier: BSD-3-Clause */
/* Pieces of an HTML page. */
#ifndef PTIE_REPORT_HTML_H
#define PTIE_REPORT_HTML_H

#include "base/file.h"
#include "base/text.h"

/* A page on its way.  Failed appends show in text.failed. */
typedef struct ptie_html {
    ptie_text text;
    ptie_output_file file;
    char figure[4096]; /* where figures are drawn before they are taken in: "<path>.part.png" */
} ptie_html;

ptie_status ptie_html_open(ptie_html *html, const char *path, bool overwrite, const char *title);
/* Text of others: <, >, & and quotes lose their meaning. */
void ptie_html_escaped(ptie_html *html, const char *text);
void ptie_html_heading(ptie_html *html, const char *heading);
/* Takes in the picture that was drawn to html->figure, and removes it. */
ptie_status ptie_html_figure(ptie_html *html, const char *caption);
/* Writes the page, or leaves none; frees in any case. */
ptie_status ptie_html_close(ptie_html *html);
void ptie_html_discard(ptie_html *html);

#endif
