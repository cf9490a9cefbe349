/* SPDX-License-Identifier: BSD-3-Clause */
/* Rig files: what is read, what is refused and with which line. */
#include "support/support.h"

#include <ptie/run.h>

#include "base/memory.h"
#include "run/rig.h"

static const char *write_rig(const char *text) {
    const char *path = support_temporary("lab.ini");
    support_write(path, text, strlen(text));
    return path;
}

static void a_full_rig_is_read(void **state) {
    (void)state;
    ptie_rig rig;
    const char *path = write_rig("[optics]\nwavelength = 633 nm\npixel = 20 um ; on the sensor\n"
                                 "magnification = 0.5\ndefocus = 10 mm\n"
                                 "[planes]\nlayout = reference\nreference = noflow.png\n"
                                 "[recording]\nframe_rate = 25 kHz\n"
                                 "[flow]\npolarity = negative\n"
                                 "[solver]\nbinning = 4\nboundary = periodic\ncutoff = 3 cm\nzero_border = no\n");
    assert_ok(ptie_rig_load(&rig, path));
    assert_near(rig.wavelength_m, 633e-9, 1e-20);
    assert_near(rig.pixel_m, 40e-6, 1e-18); /* at the object */
    assert_near(rig.defocus_plus_m, 10e-3, 1e-15);
    assert_near(rig.defocus_minus_m, -10e-3, 1e-15);
    assert_int_equal(rig.planes, PTIE_PLANES_REFERENCE);
    assert_int_equal(rig.polarity, -1);
    assert_int_equal(rig.binning, 4);
    assert_int_equal(rig.boundary, PTIE_PERIODIC);
    assert_near(rig.cutoff_m, 0.03, 1e-15);
    assert_near(rig.frame_rate_hz, 25000, 0);
    assert_false(rig.zero_border);
    assert_string_equal(rig.reference, support_temporary("noflow.png")); /* relative to the rig */
}

static void defaults_and_unequal_steps(void **state) {
    (void)state;
    ptie_rig rig;
    assert_ok(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\n"
                                            "defocus_plus = 5 mm\ndefocus_minus = -8 mm\n")));
    assert_near(rig.defocus_plus_m, 5e-3, 1e-15);
    assert_near(rig.defocus_minus_m, -8e-3, 1e-15);
    assert_int_equal(rig.planes, PTIE_PLANES_PAIR);
    assert_int_equal(rig.polarity, 0);
    assert_int_equal(rig.binning, 1);
    assert_int_equal(rig.boundary, PTIE_MIRROR);
    assert_true(rig.zero_border);
}

static void a_printed_rig_reads_back(void **state) {
    (void)state;
    ptie_rig rig, back;
    assert_ok(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 7 mm\n"
                                            "[planes]\nplus = /entry/data/plus\nminus = /entry/data/minus\n")));
    char *text = ptie_rig_print(&rig);
    assert_non_null(text);
    assert_ok(ptie_rig_load(&back, write_rig(text)));
    ptie_free(text);
    assert_memory_equal(&back.wavelength_m, &rig.wavelength_m, sizeof rig.wavelength_m);
    assert_true(back.pixel_m == rig.pixel_m && back.defocus_plus_m == rig.defocus_plus_m &&
                back.defocus_minus_m == rig.defocus_minus_m);
    assert_string_equal(back.plus, "/entry/data/plus");
    assert_string_equal(back.minus, "/entry/data/minus");
}

static void bad_rigs_get_one_line(void **state) {
    (void)state;
    ptie_rig rig = {.polarity = 7};
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\npixel = 20 um\ndefocus = 1 mm\n")), PTIE_EINVAL,
                 "lab.ini: missing key 'wavelength' in [optics]");
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\n")), PTIE_EINVAL,
                 "missing key 'defocus'");
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532\n")), PTIE_EFORMAT,
                 "lab.ini:2: wavelength: expected a length such as 532 nm or 10 mm, found '532'");
    assert_fails(ptie_rig_load(&rig, write_rig("[planes]\nlayout = refrence\n")), PTIE_ENAME,
                 "did you mean 'reference'?");
    assert_fails(ptie_rig_load(&rig, write_rig("[solvr]\nbinning = 2\n")), PTIE_ENAME, "did you mean [solver]?");
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\n"
                                               "defocus_plus = 1 mm\ndefocus_minus = 2 mm\n")),
                 PTIE_EINVAL, "defocus_minus must lie below defocus_plus");
    assert_fails(ptie_rig_load(&rig, support_temporary("none.ini")), PTIE_EIO, "No such file");
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\n"
                                               "defocus_plus = 10 mm\n")),
                 PTIE_EINVAL, "missing key 'defocus_minus'");
    assert_fails(ptie_rig_load(&rig, write_rig("[optics]\nwavelength = 532 nm\npixel = 20 um\n"
                                               "defocus = 10 mm\ndefocus_minus = 0 mm\n")),
                 PTIE_EINVAL, "'defocus' does not go with");
    assert_int_equal(rig.polarity, 7); /* untouched by every failure */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_rig_is_read),
        cmocka_unit_test(defaults_and_unequal_steps),
        cmocka_unit_test(a_printed_rig_reads_back),
        cmocka_unit_test(bad_rigs_get_one_line),
    };
    return cmocka_run_group_tests_name("rig", tests, NULL, NULL);
}
