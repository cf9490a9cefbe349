/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/pattern.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"

bool ptie_pattern_find(ptie_pattern *pattern, const char *path) {
    const char *slash = strrchr(path, '/');
    const char *percent = strchr(slash ? slash : path, '%');
    if (!percent) return false;
    bool padded = percent[1] == '0' && percent[2] >= '1' && percent[2] <= '9';
    const char *end = percent + (padded ? 3 : 1);
    if (*end != 'd' || strchr(end, '%')) return false;
    *pattern = (ptie_pattern){.text = path,
                              .before = (size_t)(percent - path),
                              .after = (size_t)(end + 1 - path),
                              .digits = padded ? percent[2] - '0' : 1};
    return true;
}

ptie_status ptie_pattern_name(const ptie_pattern *pattern, int64_t number, char *path,
                              size_t bytes) {
    int length = snprintf(path, bytes, "%.*s%0*lld%s", (int)pattern->before, pattern->text,
                          pattern->digits, (long long)number, pattern->text + pattern->after);
    if (length >= 0 && (size_t)length < bytes) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: path too long (expected less than %zu bytes)", pattern->text,
                     bytes);
}

int64_t ptie_pattern_number(const ptie_pattern *pattern, const char *path) {
    char digits[20];
    int64_t number;
    size_t length = strlen(path), tail = strlen(pattern->text + pattern->after);
    if (length <= pattern->before + tail || strncmp(path, pattern->text, pattern->before) != 0)
        return -1;
    if (strcmp(path + length - tail, pattern->text + pattern->after) != 0) return -1;
    size_t count = length - tail - pattern->before;
    if (count >= sizeof digits || strspn(path + pattern->before, "0123456789") < count) return -1;
    snprintf(digits, sizeof digits, "%.*s", (int)count, path + pattern->before);
    if (!ptie_parse_integer(digits, 0, INT64_MAX, &number)) return -1;
    bool exact =
        count == (size_t)pattern->digits || (count > (size_t)pattern->digits && digits[0] != '0');
    return exact ? number : -1;
}
