/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/html.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"

#define LARGEST_FIGURE ((size_t)256 << 20)

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<style>\n"
    "body { font: 16px/1.5 sans-serif; color: #222; max-width: 60em; margin: 2em auto; padding: 0 1em; }\n"
    "h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; border-bottom: 1px solid #ccc; }\n"
    "table { border-collapse: collapse; } th, td { padding: 0.15em 1.2em 0.15em 0; text-align: left; }\n"
    "td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }\n"
    "figure { margin: 1em 0; } figure img { width: 100%; } figcaption { color: #555; font-size: 0.9em; }\n"
    "pre { background: #f5f5f5; padding: 0.8em; overflow-x: auto; font-size: 0.85em; }\n"
    "ul.warnings li { background: #fff3cd; margin: 0.3em 0; padding: 0.2em 0.6em; }\n"
    "</style>\n<title>";

void ptie_html_escaped(ptie_html *html, const char *text) {
    static const char special[] = "<>&\"";
    static const char *const names[] = {"&lt;", "&gt;", "&amp;", "&quot;"};
    while (*text) {
        const size_t plain = strcspn(text, special);
        ptie_text_append(&html->text, "%.*s", (int)plain, text);
        text += plain;
        if (*text) ptie_text_append(&html->text, "%s", names[strchr(special, *text++) - special]);
    }
}

void ptie_html_heading(ptie_html *html, const char *heading) {
    ptie_text_append(&html->text, "<h2>%s</h2>\n", heading);
}

ptie_status ptie_html_open(ptie_html *html, const char *path, bool overwrite, const char *title) {
    *html = (ptie_html){0};
    PTIE_TRY(ptie_output_open(&html->file, path, overwrite));
    snprintf(html->figure, sizeof html->figure, "%s.png", html->file.part);
    ptie_text_append(&html->text, "%s", head);
    ptie_html_escaped(html, title);
    ptie_text_append(&html->text, "</title></head><body>\n<h1>");
    ptie_html_escaped(html, title);
    ptie_text_append(&html->text, "</h1>\n");
    return PTIE_OK;
}

/* Base64: three bytes become four characters. */
static void encode(char *out, const unsigned char *data, size_t bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes; i += 3) {
        const uint32_t second = i + 1 < bytes ? data[i + 1] : 0, third = i + 2 < bytes ? data[i + 2] : 0;
        const uint32_t word = (uint32_t)data[i] << 16 | second << 8 | third;
        *out++ = digits[word >> 18];
        *out++ = digits[word >> 12 & 63];
        *out++ = i + 1 < bytes ? digits[word >> 6 & 63] : '=';
        *out++ = i + 2 < bytes ? digits[word & 63] : '=';
    }
    *out = 0;
}

ptie_status ptie_html_figure(ptie_html *html, const char *caption) {
    char *picture, *encoded = NULL;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&picture, &bytes, html->figure, LARGEST_FIGURE));
    unlink(html->figure);
    const ptie_status status = ptie_alloc_status(&encoded, (bytes + 2) / 3 * 4 + 1, 1, html->file.path);
    if (status == PTIE_OK) {
        encode(encoded, (const unsigned char *)picture, bytes);
        ptie_text_append(&html->text, "<figure><img alt=\"\" src=\"data:image/png;base64,%s\"><figcaption>", encoded);
        ptie_html_escaped(html, caption);
        ptie_text_append(&html->text, "</figcaption></figure>\n");
    }
    ptie_free(picture);
    ptie_free(encoded);
    return status;
}

static ptie_status write_page(const ptie_html *html) {
    FILE *stream;
    if (html->text.failed) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", html->file.path);
    PTIE_TRY(ptie_output_stream(&html->file, &stream));
    fwrite(html->text.data, 1, html->text.length, stream);
    return ptie_close_written(stream, html->file.path);
}

ptie_status ptie_html_close(ptie_html *html) {
    ptie_text_append(&html->text, "</body></html>\n");
    ptie_status status = write_page(html);
    if (status == PTIE_OK) status = ptie_output_commit(&html->file);
    ptie_html_discard(html);
    return status;
}

void ptie_html_discard(ptie_html *html) {
    if (html->file.path) unlink(html->figure);
    ptie_text_free(&html->text);
    ptie_output_discard(&html->file);
}
