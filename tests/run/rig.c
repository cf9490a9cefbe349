/* SPDX-License-Identifier: BSD-3-Clause */
/* Rig files: what is read, what is refused and with which line. */
#include "support/support.h"

#include <stdlib.h>

#include <ptie/rig.h>

#include "base/memory.h"
#include "rig/rig.h"
#include "rig/keys.h"

#define OPTICS "[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n"
#define MOSAIC OPTICS "[planes]\nlayout = mosaic\nmosaic = crysta\n"

static const char *write_rig(const char *text) {
    const char *path = support_temporary("lab.ini");
    support_write(path, text, strlen(text));
    return path;
}

static ptie_rig load(const char *text) {
    ptie_rig rig;
    assert_ok(ptie_rig_load(&rig, write_rig(text)));
    return rig;
}

static void a_full_rig_is_read(void **state) {
    (void)state;
    const ptie_rig rig = load(
        "[optics]\nwavelength = 633 nm\npixel = 20 um ; on the sensor\nmagnification = 0.5\n"
        "[planes]\nset = reference\nlayout = mosaic\nmosaic = 90 45 135 0\nroi_x = 1\nroi_y = 3\n"
        "plus = 0.98*45 + 0.02*135\n"
        "[plus]\ndefocus = 7 mm\ngain = 1.1\n"
        "[recording]\nframe_rate = 25 kHz\nreference = noflow.png\ndark = "
        "/d/dark.tif\nstill_frames = 3:50\n"
        "[camera]\nsaturation = 4095\nelectrons_per_count = 2.5\nread_noise = 24\n"
        "[preprocess]\ndemosaic = fourier\nflat_field = no\nmatch_gain = no\nmask_below = 10 %\n"
        "background = zernike\n"
        "[flow]\npolarity = negative\nstill = 0,0,40,30\n"
        "[solver]\nbinning = 4\nboundary = periodic\nmethod = us-tie\niterations = 7\ncutoff = 3 "
        "cm\n"
        "zero_border = no\n");
    const ptie_plane *plus = &rig.plane[PTIE_PLUS];
    assert_true(rig.wavelength_m == 633e-9 && rig.pixel_m == 40e-6); /* at the object */
    assert_true(rig.one_plane && plus->used && !rig.plane[PTIE_MINUS].used);
    assert_int_equal(rig.layout, PTIE_LAYOUT_MOSAIC);
    assert_memory_equal(rig.angle_deg, ((int32_t[]){90, 45, 135, 0}), sizeof rig.angle_deg);
    assert_true(rig.roi_x == 1 && rig.roi_y == 3);
    assert_memory_equal(plus->mix, ((double[]){0, 0.98, 0.02, 0}), sizeof plus->mix);
    assert_true(plus->defocus_m == 7e-3 && plus->gain == 1.1);
    assert_string_equal(rig.reference, support_temporary("noflow.png")); /* relative to the rig */
    assert_string_equal(rig.dark, "/d/dark.tif");
    assert_true(rig.still_first == 3 && rig.still_end == 50);
    assert_true(rig.saturation_counts == 4095 && rig.electrons_per_count == 2.5 &&
                rig.read_noise_electrons == 24);
    assert_int_equal(rig.demosaic, PTIE_DEMOSAIC_FOURIER);
    assert_false(rig.flat_field || rig.match_gain || rig.zero_border);
    assert_true(rig.mask_below == 0.1);
    assert_int_equal(rig.background, PTIE_BACKGROUND_ZERNIKE);
    assert_int_equal(rig.polarity, -1);
    assert_memory_equal(&rig.still, (&(ptie_rect){0, 0, 40, 30}), sizeof rig.still);
    assert_int_equal(rig.binning, 4);
    assert_int_equal(rig.boundary, PTIE_PERIODIC);
    assert_true(rig.method == PTIE_SOLVE_US_TIE && rig.max_iterations == 7);
    assert_true(rig.cutoff_m == 0.03 && rig.frame_rate_hz == 25000);
}

static void a_cutoff_can_be_left_to_the_recording(void **state) {
    (void)state;
    assert_true(load(OPTICS "[solver]\ncutoff = auto\n").cutoff_m == PTIE_CUTOFF_AUTO);
    assert_true(load(OPTICS "[solver]\ncutoff = l-curve\n").cutoff_m == PTIE_CUTOFF_CORNER);
    assert_true(load(OPTICS "[solver]\ncutoff = 0\n").cutoff_m == 0);
    ptie_rig rig;
    assert_fails(ptie_rig_load(&rig, write_rig(OPTICS "[solver]\ncutoff = -1 m\n")), PTIE_EFORMAT,
                 "a length such as 3 mm, 0, auto or l-curve");
}

static void defaults_and_unequal_steps(void **state) {
    (void)state;
    ptie_rig rig = load("[optics]\nwavelength = 532 nm\npixel = 20 um\n[plus]\ndefocus = 5 mm\n"
                        "[minus]\ndefocus = -8 mm\n");
    assert_true(rig.plane[PTIE_PLUS].defocus_m == 5e-3 && rig.plane[PTIE_MINUS].defocus_m == -8e-3);
    assert_int_equal(rig.layout, PTIE_LAYOUT_SEPARATE);
    assert_int_equal(rig.polarity, 0);
    assert_int_equal(rig.binning, 1);
    assert_int_equal(rig.boundary, PTIE_MIRROR);
    assert_true(rig.zero_border && rig.flat_field && rig.match_gain);
    assert_true(rig.plane[PTIE_MINUS].gain == 1 && rig.plane[PTIE_MINUS].magnification == 1);
    rig = load(OPTICS "[planes]\nset = five\n[plus2]\ndefocus = 30 mm\n");
    const double z_m[PTIE_ROLES] = {10e-3, -10e-3, 0, 30e-3, -20e-3};
    for (int i = 0; i < PTIE_ROLES; i++)
        assert_true(rig.plane[i].used && rig.plane[i].defocus_m == z_m[i]);
    rig = load(
        OPTICS
        "[minus]\nshift_x = 0.25\nshift_y = -1.5\nmagnification = 1.002\nrotation = 0.5 mrad\n");
    const ptie_plane *minus = &rig.plane[PTIE_MINUS];
    assert_true(minus->shift_x_px == 0.25 && minus->shift_y_px == -1.5 &&
                minus->magnification == 1.002 && minus->rotation_rad == 5e-4);
}

/* Every layout's channels, by name; printed and read back they are the same rig, byte by byte. */
static void every_layout_prints_as_it_reads(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double plus[PTIE_CHANNELS], minus[PTIE_CHANNELS];
    } cases[] = {
        {OPTICS "[planes]\nplus = /entry/data/plus\nminus = /entry/data/minus\n", {0}, {0}},
        {MOSAIC "plus = 0\nminus = 90\n", {1, 0, 0, 0}, {0, 0, 0, 1}},
        {MOSAIC "plus = 0.5*0+0.5*45\nminus = -0.02*135 + 1.02 * 90\n",
         {.5, .5, 0, 0},
         {0, 0, -.02, 1.02}},
        {OPTICS "[planes]\nlayout = side-by-side\nplus = right\nminus = left\n", {0, 1}, {1, 0}},
        {OPTICS "[planes]\nlayout = top-bottom\nplus = top\nminus = 2*bottom - top\n",
         {1, 0},
         {-1, 2}},
        {OPTICS "[planes]\nlayout = quadrants\nplus = tl\nminus = br\n",
         {1, 0, 0, 0},
         {0, 0, 0, 1}},
        {OPTICS
         "[planes]\nset = triple\n[minus]\nshift_x = 0.1\ngain = 0.9\n[zero]\nrotation = 1 deg\n",
         {0},
         {0}},
        {OPTICS
         "[planes]\nset = reference\n[recording]\nstill_frames = 0:9\n[flow]\nstill = 1,2,3,4\n",
         {0},
         {0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ptie_rig rig = load(cases[i].text);
        assert_memory_equal(rig.plane[PTIE_PLUS].mix, cases[i].plus, sizeof cases[i].plus);
        assert_memory_equal(rig.plane[PTIE_MINUS].mix, cases[i].minus, sizeof cases[i].minus);
        char *text = ptie_rig_print(&rig);
        assert_non_null(text);
        const ptie_rig back = load(text);
        char *again = ptie_rig_print(&back);
        assert_string_equal(again, text);
        assert_memory_equal(back.plane, rig.plane, sizeof rig.plane);
        assert_true(back.still_end == rig.still_end && back.one_plane == rig.one_plane &&
                    back.pixel_m == rig.pixel_m);
        ptie_free(text);
        ptie_free(again);
    }
}

static void bad_rigs_get_one_line(void **state) {
    (void)state;
    static const struct {
        const char *text;
        ptie_status status;
        const char *message;
    } cases[] = {
        {"[optics]\npixel = 20 um\ndefocus = 1 mm\n", PTIE_EINVAL,
         "lab.ini: missing key 'wavelength' in [optics]"},
        {"[optics]\nwavelength = 532 nm\npixel = 20 um\n", PTIE_EINVAL, "missing key 'defocus'"},
        {"[optics]\nwavelength = 532\n", PTIE_EFORMAT,
         "lab.ini:2: wavelength: expected a length such as 532 nm or 10 mm, found '532'"},
        {"[planes]\nset = refrence\n", PTIE_ENAME,
         "lab.ini:2: set: unknown value 'refrence' (did you mean 'reference'?)"},
        {"[planes]\nlayout = mosiac\n", PTIE_ENAME, "did you mean 'mosaic'?"},
        {"[solvr]\nbinning = 2\n", PTIE_ENAME, "did you mean [solver]?"},
        {"[minus]\nshiftx = 2\n", PTIE_ENAME,
         "unknown key 'shiftx' in [minus] (did you mean 'shift_x'?)"},
        {"[minus]\nrotation = 2\n", PTIE_EFORMAT, "rotation: expected"},
        {"[planes]\nmosaic = soni\n", PTIE_EFORMAT,
         "lab.ini:2: mosaic: expected sony, crysta or four different angles"},
        {"[planes]\nmosaic = 0 45 90 45\n", PTIE_EFORMAT, "four different angles"},
        {"[planes]\nmosaic = 0 45 90 180\n", PTIE_EFORMAT, "four different angles"},
        {"[planes]\nmosaic = 0 45 90 135 0\n", PTIE_EFORMAT, "four different angles"},
        {"[plus]\nshift_x = 2\n", PTIE_ENAME, "unknown key 'shift_x' in [plus]"},
        {"[recording]\nstill_frames = 5:5\n", PTIE_EFORMAT, "frames such as 0:100"},
        {"[flow]\nstill = 1,2,0,4\n", PTIE_EFORMAT, "a rectangle x,y,width,height"},
        {MOSAIC "plus = 0\n", PTIE_EINVAL, "missing key 'minus' in [planes]"},
        {MOSAIC "plus = 0\nminus = left\n", PTIE_EFORMAT,
         "lab.ini: [planes] minus: expected channels of the layout such as '0' or '0.98*0 + "
         "0.02*45', found 'left'"},
        {MOSAIC "plus = 0\nminus = 0.5*\n", PTIE_EFORMAT, "found '0.5*'"},
        {MOSAIC "plus = 0\nminus = 45 90\n", PTIE_EFORMAT, "found '45 90'"},
        {MOSAIC "plus = 0\nminus = 45 - 45\n", PTIE_EFORMAT, "found '45 - 45'"},
        {OPTICS "[planes]\nlayout = mosaic\nplus = 0\nminus = 90\n", PTIE_EINVAL,
         "missing key 'mosaic'"},
        {OPTICS "[planes]\nplus = entry/data\n", PTIE_EFORMAT,
         "expected a data set such as /entry/data/plus"},
        {OPTICS "[planes]\nzero = /entry/data\n", PTIE_EINVAL, "zero has no place in set 'pair'"},
        {OPTICS "[minus]\ndefocus = 10 mm\n", PTIE_EINVAL, "'plus' and 'minus' are one plane"},
        {OPTICS "[minus]\ndefocus = 11 mm\n", PTIE_EINVAL, "'minus' must lie below 'plus'"},
    };
    ptie_rig rig = {.polarity = 7};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_fails(ptie_rig_load(&rig, write_rig(cases[i].text)), cases[i].status,
                     cases[i].message);
    assert_fails(ptie_rig_load(&rig, support_temporary("none.ini")), PTIE_EIO, "No such file");
    assert_int_equal(rig.polarity, 7); /* untouched by every failure */
}

static char *edit(const char *from, const char *section, const char *key, const char *value) {
    const ptie_rig_setting setting = {section, key, value};
    char to[256];
    size_t bytes;
    snprintf(to, sizeof to, "%s", support_temporary("edited.ini"));
    assert_ok(ptie_rig_edit(to, from ? write_rig(from) : NULL, &setting, 1, true));
    return (char *)support_read(to, &bytes);
}

/* A key is replaced, uncovered, added to its section, or brings its section along; all else stays.
 */
static void editing_keeps_the_rest(void **state) {
    (void)state;
    static const struct {
        const char *before, *key, *after;
    } cases[] = {
        {"[minus]\ngain = 1     ; measured\n; end\n", "gain",
         "[minus]\ngain = 1.25  ; measured\n; end\n"},
        {"[minus]\r\n  gain:1 ; x\r\n", "gain", "[minus]\r\n  gain:1.25 ; x\r\n"},
        {"[minus]\n; gain = 1            ; of it\nshift_x = 1\n", "gain",
         "[minus]\ngain = 1.25           ; of it\nshift_x = 1\n"},
        {"[minus]\nshift_x = 1\n\n[flow]\n", "gain",
         "[minus]\nshift_x = 1\ngain = 1.25\n\n[flow]\n"},
        {"[flow]\npolarity = auto", "gain", "[flow]\npolarity = auto\n\n[minus]\ngain = 1.25\n"},
        {"[plus]\ngain = 3\n[minus]\n", "gain", "[plus]\ngain = 3\n[minus]\ngain = 1.25\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char before[512], after[512];
        snprintf(before, sizeof before,
                 "[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 1 mm\n%s",
                 cases[i].before);
        snprintf(after, sizeof after,
                 "[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 1 mm\n%s",
                 cases[i].after);
        char *found = edit(before, "minus", cases[i].key, "1.25");
        assert_string_equal(found, after);
        free(found);
    }
}

static void a_new_rig_has_every_key_and_loads(void **state) {
    (void)state;
    ptie_rig rig;
    char *text = edit(NULL, "planes", "set", "five");
    assert_ok(ptie_rig_load(&rig, write_rig(text)));
    assert_true(rig.plane[PTIE_MINUS2].used && rig.plane[PTIE_PLUS2].defocus_m == 20e-3);
    for (size_t i = 0; i < ptie_rig_key_count; i++) {
        char line[80];
        snprintf(line, sizeof line, "%s = ", ptie_rig_keys[i].name);
        assert_non_null(strstr(text, line));
        assert_non_null(ptie_rig_keys[i].help);
    }
    free(text);
    const ptie_rig_setting bad = {"optics", "pixel", "20"};
    assert_fails(ptie_rig_edit(support_temporary("bad.ini"), NULL, &bad, 1, true), PTIE_EFORMAT,
                 "bad.ini:6: pixel: expected a length");
    assert_false(support_exists(support_temporary("bad.ini")));
    assert_fails(ptie_rig_edit(support_temporary("edited.ini"), NULL, NULL, 0, false), PTIE_EEXIST,
                 "edited.ini");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_rig_is_read),
        cmocka_unit_test(a_cutoff_can_be_left_to_the_recording),
        cmocka_unit_test(defaults_and_unequal_steps),
        cmocka_unit_test(every_layout_prints_as_it_reads),
        cmocka_unit_test(bad_rigs_get_one_line),
        cmocka_unit_test(editing_keeps_the_rest),
        cmocka_unit_test(a_new_rig_has_every_key_and_loads),
    };
    return cmocka_run_group_tests_name("rig", tests, NULL, NULL);
}
