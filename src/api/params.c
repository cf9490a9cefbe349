/* SPDX-License-Identifier: BSD-3-Clause */
#include "api/params.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* No parameter struct comes near this; a larger struct_size is memory that nobody initialised. */
#define LONGEST_STRUCT 65536u
#define LONGEST_NAME 63

ptie_status ptie_params_read(void *params, size_t size, const void *given, const char *where) {
    PTIE_TRY(ptie_check_pointer(given, where, "params"));
    const unsigned char *bytes = given;
    const uint32_t own_size = (uint32_t)size;
    uint32_t given_size;
    memcpy(&given_size, bytes, sizeof given_size);
    if (given_size < sizeof given_size || given_size > LONGEST_STRUCT)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: params are not initialised (expected struct_size %u as *_params_init "
                         "sets it, found %u)",
                         where, own_size, given_size);
    for (uint32_t i = own_size; i < given_size; i++)
        if (bytes[i] != 0)
            return PTIE_FAIL(PTIE_EINVAL,
                             "%s: params of a newer version set a field that this version does not "
                             "have (expected struct_size %u, found %u)",
                             where, own_size, given_size);
    memcpy(params, given, given_size < own_size ? given_size : own_size);
    memcpy(params, &own_size, sizeof own_size);
    return PTIE_OK;
}

ptie_status ptie_check_pointer(const void *pointer, const char *where, const char *name) {
    if (pointer) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is missing (expected a pointer, found NULL)", where,
                     name);
}

ptie_status ptie_check_integer(int64_t value, int64_t low, int64_t high, const char *where,
                               const char *name) {
    if (value >= low && value <= high) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is out of range (expected %lld..%lld, found %lld)", where,
                     name, (long long)low, (long long)high, (long long)value);
}

ptie_status ptie_check_positive(double value, const char *where, const char *name) {
    if (isfinite(value) && value > 0) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is out of range (expected a number > 0, found %g)", where,
                     name, value);
}

ptie_status ptie_check_number(double value, double low, double high, const char *where,
                              const char *name) {
    if (value >= low && value <= high) return PTIE_OK; /* false for NaN */
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is out of range (expected %g..%g, found %g)", where, name,
                     low, high, value);
}

ptie_status ptie_check_scratch(const void *scratch, const char *where) {
    PTIE_TRY(ptie_check_pointer(scratch, where, "scratch"));
    if ((uintptr_t)scratch % PTIE_ALIGNMENT == 0) return PTIE_OK;
    return PTIE_FAIL(
        PTIE_EINVAL,
        "%s: scratch is not aligned (expected a multiple of %d as ptie_scratch_alloc gives, "
        "found %p)",
        where, PTIE_ALIGNMENT, scratch);
}

ptie_status ptie_check_name(const char *name, const char *where) {
    PTIE_TRY(ptie_check_pointer(name, where, "name"));
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    size_t length = strlen(name);
    if (length >= 1 && length <= LONGEST_NAME && strspn(name, letters) == length) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL,
                     "%s: name (expected 1 to %d letters, digits, '_' or '-', found '%s')", where,
                     LONGEST_NAME, name);
}
