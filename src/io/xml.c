/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/xml.h"

#include <expat.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "io/clean.h"

enum { PATH_BYTES = 512, TEXT_BYTES = 512, VALUE_BYTES = 256 };

typedef struct xml {
    char path[PATH_BYTES], text[TEXT_BYTES];
    size_t path_length, text_length;
    int too_deep; /* open elements whose names no longer fit into the path */
    bool leaf;    /* the element at hand has no children so far */
    ptie_xml_fn take;
    void *user;
} xml;

static const char *local_name(const char *name) {
    const char *colon = strrchr(name, ':');
    return colon ? colon + 1 : name;
}

static void take_value(xml *x, const char *path, const char *text, size_t length) {
    char value[VALUE_BYTES];
    ptie_clean_copy(value, sizeof value, text, length);
    x->take(x->user, path, value);
}

static void take_attributes(xml *x, const char *const *attributes) {
    char path[2 * PATH_BYTES];
    for (; attributes[0]; attributes += 2) {
        snprintf(path, sizeof path, "%s@%.*s", x->path, PATH_BYTES - 2, local_name(attributes[0]));
        take_value(x, path, attributes[1], strlen(attributes[1]));
    }
}

static void XMLCALL on_start(void *user, const char *name, const char **attributes) {
    xml *x = user;
    name = local_name(name);
    const size_t length = strlen(name), slash = x->path_length > 0;
    x->leaf = true;
    x->text_length = 0;
    if (x->too_deep || x->path_length + slash + length >= PATH_BYTES) {
        x->too_deep++;
        return;
    }
    if (slash) x->path[x->path_length++] = '/';
    memcpy(x->path + x->path_length, name, length + 1);
    x->path_length += length;
    take_attributes(x, attributes);
}

static void XMLCALL on_end(void *user, const char *name) {
    xml *x = user;
    (void)name;
    if (x->too_deep) {
        x->too_deep--;
        return;
    }
    if (x->leaf) take_value(x, x->path, x->text, x->text_length);
    x->leaf = false;
    const char *slash = strrchr(x->path, '/');
    x->path_length = slash ? (size_t)(slash - x->path) : 0;
    x->path[x->path_length] = 0;
}

static void XMLCALL on_text(void *user, const char *text, int length) {
    xml *x = user;
    const size_t room = TEXT_BYTES - x->text_length;
    const size_t taken = (size_t)length < room ? (size_t)length : room;
    memcpy(x->text + x->text_length, text, taken);
    x->text_length += taken;
}

static ptie_status parse(XML_Parser parser, const char *text, size_t bytes, const char *where) {
    if (bytes > INT_MAX) return PTIE_FAIL(PTIE_EFORMAT, "%s: XML too long", where);
    if (XML_Parse(parser, text, (int)bytes, true) == XML_STATUS_OK) return PTIE_OK;
    const enum XML_Error reason = XML_GetErrorCode(parser);
    if (reason == XML_ERROR_NO_MEMORY) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", where);
    return PTIE_FAIL(PTIE_EFORMAT, "%s: damaged XML (line %llu): %s", where,
                     (unsigned long long)XML_GetCurrentLineNumber(parser), XML_ErrorString(reason));
}

ptie_status ptie_xml_read(const char *text, size_t bytes, const char *where, ptie_xml_fn take,
                          void *user) {
    xml x = {.take = take, .user = user};
    XML_Parser parser = XML_ParserCreate("UTF-8");
    if (!parser) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", where);
    XML_SetUserData(parser, &x);
    XML_SetElementHandler(parser, on_start, on_end);
    XML_SetCharacterDataHandler(parser, on_text);
    const ptie_status status = parse(parser, text, bytes, where);
    XML_ParserFree(parser);
    return status;
}
