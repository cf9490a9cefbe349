/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/cihx.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "io/endian.h"

enum { NOTE_BYTES = 256, SECTIONS = 2, XML_AT = NOTE_BYTES + 12 + 24 * SECTIONS };

/* Text as XML has it. */
static void escape(ptie_text *xml, const char *text, size_t length) {
    for (size_t i = 0; i < length && text[i]; i++) switch (text[i]) {
        case '&': ptie_text_append(xml, "&amp;"); break;
        case '<': ptie_text_append(xml, "&lt;"); break;
        case '>': ptie_text_append(xml, "&gt;"); break;
        default: ptie_text_append(xml, "%c", (unsigned char)text[i] < ' ' ? ' ' : text[i]);
        }
}

static void add_text(ptie_text *xml, const char *name, const char *text, size_t length) {
    ptie_text_append(xml, "<%s>", name);
    escape(xml, text, length);
    ptie_text_append(xml, "</%s>\r\n", name);
}

static void add_files(ptie_text *xml, const ptie_recording_info *info) {
    const size_t day = strcspn(info->date, " ");
    ptie_text_append(xml, "<fileInfo>\r\n<version>1.0</version>\r\n");
    add_text(xml, "date", info->date, day);
    add_text(xml, "time", info->date[day] ? info->date + day + 1 : "", sizeof info->date);
    ptie_text_append(
        xml,
        "</fileInfo>\r\n<imageFileInfo>\r\n<fileFormat>Mraw</fileFormat>\r\n</imageFileInfo>\r\n");
}

static void add_images(ptie_text *xml, const ptie_recording_info *info, int color_bit) {
    ptie_text_append(xml,
                     "<imageDataInfo>\r\n<resolution>\r\n<width>%d</width>\r\n<height>%d</"
                     "height>\r\n</resolution>\r\n",
                     info->width_px, info->height_px);
    ptie_text_append(xml, "<colorInfo>\r\n<type>Mono</type>\r\n<bit>%d</bit>\r\n</colorInfo>\r\n",
                     color_bit);
    ptie_text_append(
        xml, "<effectiveBit>\r\n<depth>%d</depth>\r\n<side>Lower</side>\r\n</effectiveBit>\r\n",
        info->bit_depth);
    ptie_text_append(xml,
                     "<segmentPos>\r\n<sensorXpos>%d</sensorXpos>\r\n<sensorYpos>%d</"
                     "sensorYpos>\r\n</segmentPos>\r\n"
                     "</imageDataInfo>\r\n",
                     info->roi_x_px, info->roi_y_px);
}

/* `shutterSpeed` is the reciprocal of the exposure, whatever its name says. */
static void add_recording(ptie_text *xml, const ptie_recording_info *info) {
    const long long frames = info->frames, skip = info->skip > 1 ? info->skip : 1;
    ptie_text_append(
        xml,
        "<frameInfo>\r\n<recordedFrame>%lld</recordedFrame>\r\n<totalFrame>%lld</totalFrame>\r\n"
        "<startFrame>0</startFrame>\r\n<skipFrame>%lld</skipFrame>\r\n</frameInfo>\r\n",
        frames, frames, skip);
    ptie_text_append(xml, "<basicInfo>\r\n");
    add_text(xml, "comment", info->comment, sizeof info->comment);
    ptie_text_append(xml, "</basicInfo>\r\n<recordInfo>\r\n<recordRate>%.15g</recordRate>\r\n",
                     info->frame_rate_hz * (double)skip);
    ptie_text_append(xml,
                     "<shutterSpeed>%.9g</shutterSpeed>\r\n<shutterSpeedNsec>%.15g</"
                     "shutterSpeedNsec>\r\n</recordInfo>\r\n",
                     info->exposure_s > 0 ? 1 / info->exposure_s : 0, info->exposure_s * 1e9);
    ptie_text_append(xml, "<deviceInfo>\r\n");
    add_text(xml, "deviceName", info->camera, sizeof info->camera);
    ptie_text_append(xml, "</deviceInfo>\r\n");
}

static void write_section(FILE *out, uint64_t type, uint64_t offset, uint64_t bytes) {
    ptie_write_le(out, type, 8);
    ptie_write_le(out, offset, 8);
    ptie_write_le(out, bytes, 8);
}

/* The second section, of data per frame, is empty. */
static void write_envelope(FILE *out, uint64_t xml_bytes) {
    static const char note[NOTE_BYTES] = "!!! This file can not be edited. !!!";
    fwrite(note, 1, sizeof note, out);
    fwrite("CIHX", 1, 4, out);
    ptie_write_le(out, 1, 4); /* version */
    ptie_write_le(out, SECTIONS, 4);
    write_section(out, 0, XML_AT, xml_bytes);
    write_section(out, 4, XML_AT + xml_bytes, 0);
}

ptie_status ptie_cihx_write(FILE *out, const ptie_recording_info *info, int color_bit) {
    ptie_text xml = {0};
    ptie_text_append(&xml, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<cih>\r\n");
    add_files(&xml, info);
    add_images(&xml, info, color_bit);
    add_recording(&xml, info);
    ptie_text_append(&xml, "</cih>\r\n");
    const bool failed = xml.failed;
    if (!failed) {
        write_envelope(out, xml.length);
        fwrite(xml.data, 1, xml.length, out);
    }
    ptie_text_free(&xml);
    return failed ? PTIE_FAIL(PTIE_ENOMEM, "CIHX header: out of memory") : PTIE_OK;
}
