/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/tiff_notes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "io/clean.h"
#include "io/xml.h"

/* --- ImageJ: lines "key=value" ---------------------------------------------------------------- */

static bool value_of(const char *text, const char *key, char value[32]) {
    size_t length = strlen(key);
    for (; text; text = strchr(text, '\n')) {
        text += *text == '\n';
        if (strncmp(text, key, length) != 0 || text[length] != '=') continue;
        snprintf(value, 32, "%.*s", (int)strcspn(text + length + 1, "\r\n"), text + length + 1);
        return true;
    }
    return false;
}

/* Of one `name` in SI units; 0 if it is no such unit. */
static double unit_of(const char *name, ptie_quantity quantity) {
    char text[80];
    double value;
    const bool micron = strncmp(name, "micron", 6) == 0 || strcmp(name, "\\u00B5m") == 0;
    snprintf(text, sizeof text, "1 %.60s", micron ? "um" : name);
    return ptie_parse_quantity(text, quantity, &value) ? 0 : value;
}

static double number_of(const char *text) {
    double number;
    return ptie_parse_quantity(text, PTIE_NUMBER, &number) || number <= 0 ? 0 : number;
}

static int64_t take_imagej(ptie_recording_info *info, const char *text, double per_unit) {
    char value[32];
    int64_t images = 0;
    if (value_of(text, "unit", value) && per_unit > 0)
        info->pixel_m = unit_of(value, PTIE_LENGTH) / per_unit;
    if (value_of(text, "finterval", value) && number_of(value) > 0)
        info->frame_rate_hz = 1 / number_of(value);
    if (value_of(text, "vunit", value))
        ptie_clean_copy(info->unit, sizeof info->unit, value, sizeof value);
    if (value_of(text, "images", value) && !ptie_parse_integer(value, 1, INT64_MAX, &images))
        images = 0;
    return images;
}

/* --- OME: XML of the 2016-06 schema ----------------------------------------------------------- */

typedef struct ome {
    char pixel[64], pixel_unit[64], interval[64], interval_unit[64], date[64], comment[256];
} ome;

/* Of several images the first one counts. */
static void take_value(void *user, const char *path, const char *value) {
    ome *o = user;
    const struct {
        const char *path;
        char *out;
        size_t bytes;
    } wanted[] = {{"OME/Image/Pixels@PhysicalSizeX", o->pixel, sizeof o->pixel},
                  {"OME/Image/Pixels@PhysicalSizeXUnit", o->pixel_unit, sizeof o->pixel_unit},
                  {"OME/Image/Pixels@TimeIncrement", o->interval, sizeof o->interval},
                  {"OME/Image/Pixels@TimeIncrementUnit", o->interval_unit, sizeof o->interval_unit},
                  {"OME/Image/AcquisitionDate", o->date, sizeof o->date},
                  {"OME/Image/Description", o->comment, sizeof o->comment}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        if (strcmp(path, wanted[i].path) == 0 && !*wanted[i].out)
            ptie_clean_copy(wanted[i].out, wanted[i].bytes, value, strlen(value));
}

/* Without units they are um and s (the schema's defaults). */
static void take_ome(ptie_recording_info *info, const char *xml) {
    ome o = {0};
    if (ptie_xml_read(xml, strlen(xml), "OME", take_value, &o) != PTIE_OK) {
        snprintf(info->warning, sizeof info->warning,
                 "the OME description is damaged: no pixel size, no frame rate");
        return;
    }
    info->pixel_m = number_of(o.pixel) * unit_of(*o.pixel_unit ? o.pixel_unit : "um", PTIE_LENGTH);
    const double interval_s =
        number_of(o.interval) * unit_of(*o.interval_unit ? o.interval_unit : "s", PTIE_TIME);
    info->frame_rate_hz = interval_s > 0 ? 1 / interval_s : 0;
    ptie_clean_copy(info->date, sizeof info->date, o.date, sizeof o.date);
    ptie_clean_copy(info->comment, sizeof info->comment, o.comment, sizeof o.comment);
}

int64_t ptie_tiff_notes(ptie_recording_info *info, const char *description, double per_unit) {
    const char *xml = description + strspn(description, " \r\n\t\xef\xbb\xbf");
    int64_t images = 0;
    if (strncmp(description, "ImageJ=", 7) == 0)
        images = take_imagej(info, description, per_unit);
    else if (*xml == '<' && strstr(xml, "<OME"))
        take_ome(info, xml);
    if (!isfinite(info->pixel_m)) info->pixel_m = 0;
    if (!isfinite(info->frame_rate_hz)) info->frame_rate_hz = 0;
    return images;
}
