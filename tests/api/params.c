/* SPDX-License-Identifier: BSD-3-Clause */
/* Parameter structs of older and newer callers. */
#include "support/support.h"

#include <math.h>

#include "api/params.h"
#include "base/memory.h"

/* The library's version of a struct, what it was before `c` came, and what it will be. */
typedef struct now {
    uint32_t struct_size;
    int32_t a;
    double b, c;
} now;

typedef struct before {
    uint32_t struct_size;
    int32_t a;
    double b;
} before;

typedef struct later {
    now known;
    double d;
} later;

static now defaults(void) {
    return (now){.struct_size = sizeof(now), .a = 1, .b = 2, .c = 3};
}

static void the_same_version_is_copied(void **state) {
    (void)state;
    const now given = {.struct_size = sizeof given, .a = 7, .b = 8, .c = 9};
    now own = defaults();
    assert_ok(ptie_params_read(&own, sizeof own, &given, "f"));
    assert_memory_equal(&own, &given, sizeof own);
}

static void an_older_caller_gets_defaults_for_the_rest(void **state) {
    (void)state;
    const before given = {.struct_size = sizeof given, .a = 7, .b = 8};
    now own = defaults();
    assert_ok(ptie_params_read(&own, sizeof own, &given, "f"));
    assert_true(own.struct_size == sizeof(now) && own.a == 7 && own.b == 8 && own.c == 3);
}

static void a_newer_caller_may_not_ask_for_what_is_unknown(void **state) {
    (void)state;
    later given = {.known = {.struct_size = sizeof given, .a = 7, .b = 8, .c = 9}};
    now own = defaults();
    assert_ok(ptie_params_read(&own, sizeof own, &given, "f"));
    assert_true(own.struct_size == sizeof(now) && own.a == 7 && own.c == 9);
    given.d = 1;
    own = defaults();
    assert_fails(
        ptie_params_read(&own, sizeof own, &given, "f"), PTIE_EINVAL,
        "f: params of a newer version set a field that this version does not have (expected "
        "struct_size 24, found 32)");
    assert_int_equal(own.a, 1);
}

static void params_must_be_initialised(void **state) {
    (void)state;
    now own = defaults(), given = defaults();
    static const uint32_t sizes[] = {0, 3, 0xcdcdcdcd};
    for (int i = 0; i < 3; i++) {
        given.struct_size = sizes[i];
        assert_fails(
            ptie_params_read(&own, sizeof own, &given, "f"), PTIE_EINVAL,
            "f: params are not initialised (expected struct_size 24 as *_params_init sets it");
    }
    assert_fails(ptie_params_read(&own, sizeof own, NULL, "f"), PTIE_EINVAL,
                 "f: params is missing (expected a pointer, found NULL)");
}

static void ranges_include_their_ends(void **state) {
    (void)state;
    assert_ok(ptie_check_integer(2, 2, 5, "f", "n"));
    assert_ok(ptie_check_integer(5, 2, 5, "f", "n"));
    assert_fails(ptie_check_integer(1, 2, 5, "f", "n"), PTIE_EINVAL,
                 "f: n is out of range (expected 2..5, found 1)");
    assert_fails(ptie_check_integer(6, 2, 5, "f", "n"), PTIE_EINVAL, "found 6");
    assert_ok(ptie_check_number(0.5, 0.5, 1, "f", "x"));
    assert_ok(ptie_check_number(1, 0.5, 1, "f", "x"));
    assert_fails(ptie_check_number(1.5, 0.5, 1, "f", "x"), PTIE_EINVAL,
                 "f: x is out of range (expected 0.5..1, found 1.5)");
    assert_fails(ptie_check_number((double)NAN, 0.5, 1, "f", "x"), PTIE_EINVAL, "found nan");
    assert_ok(ptie_check_positive(1e-300, "f", "x"));
    assert_fails(ptie_check_positive(0, "f", "x"), PTIE_EINVAL, "expected a number > 0, found 0");
    assert_fails(ptie_check_positive((double)INFINITY, "f", "x"), PTIE_EINVAL, "found inf");
    assert_fails(ptie_check_positive((double)NAN, "f", "x"), PTIE_EINVAL, "found nan");
}

static void scratch_must_be_aligned(void **state) {
    (void)state;
    unsigned char *scratch = ptie_alloc(2, PTIE_ALIGNMENT);
    assert_ok(ptie_check_scratch(scratch, "f"));
    assert_ok(ptie_check_scratch(scratch + PTIE_ALIGNMENT, "f"));
    assert_fails(ptie_check_scratch(scratch + 32, "f"), PTIE_EINVAL,
                 "f: scratch is not aligned (expected a multiple of 64");
    assert_fails(ptie_check_scratch(NULL, "f"), PTIE_EINVAL, "f: scratch is missing");
    ptie_free(scratch);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_version_is_copied),
        cmocka_unit_test(an_older_caller_gets_defaults_for_the_rest),
        cmocka_unit_test(a_newer_caller_may_not_ask_for_what_is_unknown),
        cmocka_unit_test(params_must_be_initialised),
        cmocka_unit_test(ranges_include_their_ends),
        cmocka_unit_test(scratch_must_be_aligned),
    };
    return cmocka_run_group_tests_name("params", tests, NULL, NULL);
}
