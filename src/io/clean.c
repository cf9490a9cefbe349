/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/clean.h"

#include <stdbool.h>
#include <string.h>

/* Bytes of the UTF-8 character that begins here, 0 if none does (RFC 3629). */
static size_t character_bytes(const unsigned char *text, size_t bytes) {
    const unsigned char first = text[0];
    const size_t length = first < 0x80   ? 1
                          : first < 0xc2 ? 0
                          : first < 0xe0 ? 2
                          : first < 0xf0 ? 3
                                         : 4;
    if (length == 0 || length > bytes || first > 0xf4) return 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    const bool overlong = (first == 0xe0 && text[1] < 0xa0) || (first == 0xf0 && text[1] < 0x90);
    const bool outside = (first == 0xed && text[1] > 0x9f) || (first == 0xf4 && text[1] > 0x8f);
    return overlong || outside ? 0 : length;
}

void ptie_clean_utf8(char *text, size_t bytes) {
    for (size_t i = 0; i < bytes;) {
        const size_t length = character_bytes((const unsigned char *)text + i, bytes - i);
        if (length == 0) text[i] = '?';
        i += length ? length : 1;
    }
}

static bool is_blank(char c) {
    return (unsigned char)c <= ' ' || c == 127;
}

void ptie_clean_copy(char *out, size_t capacity, const char *text, size_t length) {
    length = strnlen(text, length);
    while (length > 0 && is_blank(*text)) text++, length--;
    while (length > 0 && is_blank(text[length - 1])) length--;
    if (length >= capacity) {
        length = capacity - 1;
        while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80) length--;
    }
    memcpy(out, text, length);
    out[length] = 0;
    ptie_clean_utf8(out, length);
    for (size_t i = 0; i < length; i++)
        if (is_blank(out[i])) out[i] = ' ';
}
