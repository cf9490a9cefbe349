/* SPDX-License-Identifier: BSD-3-Clause */
/* An engine in a build without vector kernels: scalar ones, whatever the processor could do. */
#include "support/support.h"

#include <stdlib.h>

#include "kernel/engine.h"
#include "kernel/kernel.h"

static void starts_with_what_is_built(void **state) {
    (void)state;
    ptie_engine engine;
    unsetenv("PTIE_CPU");
    assert_ok(ptie_engine_start(&engine, 1, NULL));
    assert_int_equal(engine.level, PTIE_CPU_SCALAR);
    assert_ptr_equal(engine.kernels, ptie_kernels_of(PTIE_CPU_SCALAR));
    ptie_engine_stop(&engine);
}

static void refuses_what_is_not(void **state) {
    (void)state;
    ptie_engine engine;
    assert_fails(ptie_engine_start(&engine, 1, "avx2"), PTIE_ENAME, "up to 'scalar'");
    ptie_engine_stop(&engine);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_with_what_is_built),
        cmocka_unit_test(refuses_what_is_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
