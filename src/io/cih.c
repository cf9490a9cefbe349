/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/cih.h"

#include <stddef.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/clean.h"
#include "io/xml.h"

#define LARGEST (64 << 20) /* bytes; the binary block of a CIHX grows with the frames */

typedef enum kind { INTEGER, NUMBER, TEXT } kind;

/* Where a value stands in either kind of header, and where it goes. */
static const struct field {
    const char *key, *path;
    kind kind;
    size_t offset, bytes;
} fields[] = {
#define FIELD(member) offsetof(ptie_cih, member), sizeof((ptie_cih){0}.member)
    {"Image Width", "cih/imageDataInfo/resolution/width", INTEGER, FIELD(width)},
    {"Image Height", "cih/imageDataInfo/resolution/height", INTEGER, FIELD(height)},
    {"Total Frame", "cih/frameInfo/totalFrame", INTEGER, FIELD(frames)},
    {"Original Total Frame", "cih/frameInfo/recordedFrame", INTEGER, FIELD(recorded)},
    {"Start Frame", "cih/frameInfo/startFrame", INTEGER, FIELD(start)},
    {"Save Step", "cih/frameInfo/skipFrame", INTEGER, FIELD(skip)},
    {"Color Bit", "cih/imageDataInfo/colorInfo/bit", INTEGER, FIELD(color_bit)},
    {"Color Type", "cih/imageDataInfo/colorInfo/type", TEXT, FIELD(color)},
    {"EffectiveBit Depth", "cih/imageDataInfo/effectiveBit/depth", INTEGER, FIELD(depth)},
    {"EffectiveBit Side", "cih/imageDataInfo/effectiveBit/side", TEXT, FIELD(side)},
    {"", "cih/imageDataInfo/segmentPos/sensorXpos", INTEGER, FIELD(x)},
    {"", "cih/imageDataInfo/segmentPos/sensorYpos", INTEGER, FIELD(y)},
    {"File Format", "cih/imageFileInfo/fileFormat", TEXT, FIELD(format)},
    {"Record Rate(fps)", "cih/recordInfo/recordRate", NUMBER, FIELD(rate_hz)},
    {"Shutter Type2(nsec)", "cih/recordInfo/shutterSpeedNsec", NUMBER, FIELD(exposure_ns)},
    {"Shutter Speed(s)", "cih/recordInfo/shutterSpeed", TEXT, FIELD(shutter)},
    {"Trigger Mode", "cih/recordInfo/triggerMode/mode", TEXT, FIELD(trigger)},
    {"Camera Type", "cih/deviceInfo/deviceName", TEXT, FIELD(camera)},
    {"Date", "cih/fileInfo/date", TEXT, FIELD(date)},
    {"Time", "cih/fileInfo/time", TEXT, FIELD(time)},
    {"Comment Text", "cih/basicInfo/comment", TEXT, FIELD(comment)},
#undef FIELD
};

static void set(ptie_cih *cih, const struct field *field, const char *text, size_t length) {
    char value[256];
    double number;
    void *target = (char *)cih + field->offset;
    ptie_clean_copy(value, sizeof value, text, length);
    if (field->kind == TEXT)
        ptie_clean_copy(target, field->bytes, value, sizeof value);
    else if (field->kind == INTEGER)
        (void)ptie_parse_integer(value, INT64_MIN, INT64_MAX, target);
    else if (!ptie_parse_quantity(value, PTIE_NUMBER, &number))
        memcpy(target, &number, sizeof number);
}

static const char *trim(const char *text, size_t *length) {
    while (*length > 0 && (*text == ' ' || *text == '\t')) text++, --*length;
    while (*length > 0 && (unsigned char)text[*length - 1] <= ' ') --*length;
    return text;
}

/* "Key : Value", "Key: Value", "Key :Value". */
static void take_line(ptie_cih *cih, const char *line, size_t length) {
    const char *colon = memchr(line, ':', length);
    if (!colon) return;
    size_t key_length = (size_t)(colon - line);
    const char *key = trim(line, &key_length);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (strlen(fields[i].key) == key_length && memcmp(fields[i].key, key, key_length) == 0 &&
            key_length > 0)
            set(cih, &fields[i], colon + 1, length - (size_t)(colon + 1 - line));
}

/* The camera's section is the first: up to an empty line, "END", or the next '#'. */
static ptie_status read_lines(ptie_cih *cih, const char *text) {
    for (const char *line = strchr(text, '\n'); line; line = strchr(line, '\n')) {
        line++;
        size_t length = strcspn(line, "\n");
        const char *begin = trim(line, &length);
        if (length == 0 || *begin == '#' || (length == 3 && memcmp(begin, "END", 3) == 0)) break;
        take_line(cih, begin, length);
    }
    return PTIE_OK;
}

static void take_value(void *user, const char *path, const char *value) {
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (strcmp(fields[i].path, path) == 0) set(user, &fields[i], value, strlen(value));
}

/* The XML is found by its root, so that a file whose envelope was lost still reads. */
static ptie_status read_xml(ptie_cih *cih, char *data, size_t bytes, const char *path) {
    static const char first[] = "<cih>", last[] = "</cih>";
    char *begin = memmem(data, bytes, first, sizeof first - 1);
    const char *end =
        begin ? memmem(begin, bytes - (size_t)(begin - data), last, sizeof last - 1) : NULL;
    if (!end)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: not a CIHX header, or cut (expected <cih> ... </cih>)",
                         path);
    const size_t length = (size_t)(end - begin) + sizeof last - 1;
    ptie_clean_utf8(begin, length);
    return ptie_xml_read(begin, length, path, take_value, cih);
}

ptie_status ptie_cih_read(ptie_cih *cih, const char *path) {
    static const char title[] = "#Camera Information Header";
    char *data;
    size_t bytes;
    *cih = (ptie_cih){0};
    PTIE_TRY(ptie_read_file(&data, &bytes, path, LARGEST));
    const ptie_status status = strncmp(data, title, sizeof title - 1) == 0
                                   ? read_lines(cih, data)
                                   : read_xml(cih, data, bytes, path);
    ptie_free(data);
    return status;
}
