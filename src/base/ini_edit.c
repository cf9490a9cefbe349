/* SPDX-License-Identifier: BSD-3-Clause */
/* One key of an INI text set, everything else as it was: comments, order, empty lines. */
#include <ctype.h>
#include <string.h>

#include "base/ini.h"

/* Where a key stands in a text: a line that sets it, one that shows it behind a semicolon, or the place for it. */
typedef struct place {
    const char *set, *shown; /* beginnings of lines, or NULL */
    const char *end;         /* behind the section's last line that is not empty; NULL: no such section */
} place;

static const char *skip_blanks(const char *text) {
    while (*text == ' ' || *text == '\t') text++;
    return text;
}

static const char *next_line(const char *line) {
    const char *end = strchr(line, '\n');
    return end ? end + 1 : line + strlen(line);
}

/* "key =", "key:"; returns what follows, or NULL. */
static const char *behind_key(const char *line, const char *key) {
    const char *c = skip_blanks(line);
    const size_t length = strlen(key);
    if (strncmp(c, key, length) != 0) return NULL;
    c = skip_blanks(c + length);
    return *c == '=' || *c == ':' ? skip_blanks(c + 1) : NULL;
}

static bool begins_section(const char *line, const char *section) {
    const size_t length = strlen(section);
    return *line == '[' && strncmp(line + 1, section, length) == 0 && line[1 + length] == ']';
}

static place find(const char *text, const char *section, const char *key) {
    place p = {0};
    bool inside = *section == 0;
    if (inside) p.end = text;
    for (const char *line = text; *line; line = next_line(line)) {
        const char *c = skip_blanks(line);
        if (*c == '[') inside = begins_section(c, section);
        if (!inside) continue;
        if (!isspace((unsigned char)*c)) p.end = next_line(line);
        if (behind_key(c, key)) p.set = line;
        if (*c == ';' && !p.shown && behind_key(c + 1, key)) p.shown = line;
    }
    return p;
}

/* The comment behind a value, with the white space before it; or the end of the line. */
static const char *find_comment(const char *value) {
    const char *c = value;
    while (*c && *c != '\n' && *c != '\r' && !(*c == ';' && isspace((unsigned char)c[-1]))) c++;
    while (c > value && (c[-1] == ' ' || c[-1] == '\t')) c--;
    return c;
}

/* The rest of a line behind its old value; a comment stays in its column where there is room.  `now`: the column
   where the new value ends. */
static void append_tail(ptie_text *out, const char *line, const char *old, ptrdiff_t now) {
    const char *comment = skip_blanks(find_comment(old)), *end = next_line(line);
    const ptrdiff_t column = comment - line;
    if (*comment == ';') ptie_text_append(out, "%*s", (int)(column > now + 1 ? column - now : 1), "");
    ptie_text_append(out, "%.*s", (int)(end - comment), comment);
}

void ptie_ini_edit(ptie_text *out, const char *text, const char *section, const char *key, const char *value) {
    const place p = find(text, section, key);
    const char *line = p.set ? p.set : p.shown;
    if (line) {
        const char *shown = p.set ? line : strchr(line, ';') + 1; /* a line that shows a key loses its semicolon */
        const char *old = behind_key(shown, key);
        const char *name = p.set ? line : skip_blanks(shown);
        ptie_text_append(out, "%.*s%.*s%s", (int)(line - text), text, (int)(old - name), name, value);
        append_tail(out, line, old, old - name + (ptrdiff_t)strlen(value));
        ptie_text_append(out, "%s", next_line(line));
        return;
    }
    const char *end = p.end ? p.end : text + strlen(text);
    const char *open_line = end > text && end[-1] != '\n' ? "\n" : "";
    ptie_text_append(out, "%.*s%s", (int)(end - text), text, open_line);
    if (!p.end) ptie_text_append(out, "%s[%s]\n", end > text ? "\n" : "", section);
    ptie_text_append(out, "%s = %s\n%s", key, value, end);
}
