/* SPDX-License-Identifier: BSD-3-Clause */
/* What we write, opened by the programs that people use: SciPy, Octave and ImageJ.  NumPy, h5py, tifffile and PIL are in
 * writers.c. */
#include "support/files.h"

#include <ptie/recording.h>

enum { T = 3, H = 5, W = 7, PIXELS = H * W };

/* Frame t, pixel i holds step * i + 100 t: in other programs 0.25 * (7 y + x) + 100 t. */
static void write(const char *path, const char *sample, float step) {
    ptie_writer *writer;
    float frame[PIXELS];
    const ptie_recording_info info = {.width_px = W,
                                      .height_px = H,
                                      .unit = "rad",
                                      .frame_rate_hz = 25000,
                                      .pixel_m = 2e-5,
                                      .first_frame = 10,
                                      .frame_step = 2};
    ptie_recording_info all = info;
    snprintf(all.sample, sizeof all.sample, "%s", sample);
    assert_ok(ptie_writer_create(&writer, path, "phase-1", &all, true));
    for (int t = 0; t < T; t++) {
        for (size_t i = 0; i < PIXELS; i++) frame[i] = step * (float)i + 100 * (float)t;
        assert_ok(ptie_writer_append(writer, frame));
    }
    assert_ok(ptie_writer_close(writer));
}

static void scipy_reads_mat(void **state) {
    (void)state;
    static const char program[] =
        "import numpy as np, scipy.io, sys\n"
        "m = scipy.io.loadmat(sys.argv[1])\n"
        "t, y, x = np.mgrid[:3, :5, :7]\n"
        "step = .25 if 'single' in sys.argv[1] else 1\n"
        "want = (step * (7 * y + x) + 100 * t).transpose(1, 2, 0)\n"
        "found = m['phase_1']\n"
        "assert found.dtype == {'e': 'f4', '8': 'u1', '6': 'u2'}[sys.argv[1][-5]]\n"
        "assert found.shape == (5, 7, 3) and (found == want).all()\n"
        "assert m['unit'] == ['rad'] and m['frame_rate_hz'] == 25000 and m['pixel_m'] == 2e-5\n"
        "assert m['first_frame'] == 10 and m['frame_step'] == 2\n";
    write(support_temporary("single.mat"), "f32", .25f);
    support_python(program, support_temporary("single.mat"));
    write(support_temporary("u8.mat"), "u8", 1); /* 3 x 35 bytes: not a multiple of 8 */
    support_python(program, support_temporary("u8.mat"));
    write(support_temporary("u16.mat"), "u12", 1);
    support_python(program, support_temporary("u16.mat"));
}

static void octave_reads_mat(void **state) {
    (void)state;
    write(support_temporary("octave.mat"), "f32", .25f);
    support_octave("m = load(argv(){1});\n"
                   "[y, x, t] = ndgrid(0:4, 0:6, 0:2);\n"
                   "assert(class(m.phase_1), 'single');\n"
                   "assert(double(m.phase_1), 0.25 * (7 * y + x) + 100 * t);\n"
                   "assert(m.unit, 'rad'); assert(m.frame_rate_hz, 25000); assert(m.pixel_m, 2e-5);\n"
                   "assert(m.first_frame, 10); assert(m.frame_step, 2);\n",
                   support_temporary("octave.mat"));
}

/* Its load knows no attributes and turns dimensions round: H5's [T, H, W] is W x H x T. */
static void octave_reads_hdf5(void **state) {
    (void)state;
    write(support_temporary("octave.h5"), "f32", .25f);
    support_octave("m = load('-hdf5', argv(){1});\n"
                   "[x, y, t] = ndgrid(0:6, 0:4, 0:2);\n"
                   "assert(double(m.entry.data.phase_1), 0.25 * (7 * y + x) + 100 * t);\n"
                   "assert(m.entry.data.time(:), [10 12 14]' / 50000, 1e-15);\n",
                   support_temporary("octave.h5"));
}

static void octave_reads_images(void **state) {
    (void)state;
    static const char program[] = "[x, y] = meshgrid(0:6, 0:4);\n"
                                  "file = argv(){1};\n"
                                  "if (strcmp(file(end-2:end), 'tif')) a = imread(file, 2); t = 1;\n"
                                  "else a = imread(file); t = 2; end\n"
                                  "assert(class(a), 'uint16');\n"
                                  "assert(double(a), 1000 * (7 * y + x) + 100 * t);\n";
    write(support_temporary("octave.tif"), "u16", 1000);
    support_octave(program, support_temporary("octave.tif"));
    write(support_temporary("octave_%d.png"), "u16", 1000);
    support_octave(program, support_temporary("octave_2.png"));
}

/* Size, frames, scale, interval, and every pixel, by the classes Fiji opens TIFFs with. */
static void imagej_reads_tiff(void **state) {
    (void)state;
    static const char program[] =
        "imp = new ij.io.Opener().openImage(bsh.args[0]);\n"
        "check(imp != null, \"nothing opened\");\n"
        "c = imp.getCalibration();\n"
        "bits = bsh.args[0].endsWith(\"u16.tif\") ? 16 : bsh.args[0].endsWith(\"u8.tif\") ? 8 : 32;\n"
        "step = bits == 32 ? .25f : 1f;\n"
        "check(imp.getWidth() == 7 && imp.getHeight() == 5, imp);\n"
        "check(imp.getNChannels() == 1 && imp.getNSlices() == 1 && imp.getNFrames() == 3, imp);\n"
        "check(imp.getBitDepth() == bits, imp.getBitDepth());\n"
        "check(c.getUnit().equals(\"\\u00b5m\"), c);\n"
        "check(Math.abs(c.pixelWidth / 20 - 1) < 1e-8 && c.pixelHeight == c.pixelWidth, c.pixelWidth);\n"
        "check(Math.abs(c.frameInterval * 25000 - 1) < 1e-8, c.frameInterval);\n"
        "for (t = 0; t < 3; t++) for (y = 0; y < 5; y++) for (x = 0; x < 7; x++) {\n"
        "    found = imp.getStack().getProcessor(t + 1).getf(x, y);\n"
        "    check(found == step * (7 * y + x) + 100 * t, \"x=\" + x + \" y=\" + y + \" found \" + found);\n"
        "}\n";
    write(support_temporary("f32.tif"), "f32", .25f);
    support_imagej(program, support_temporary("f32.tif"));
    write(support_temporary("u16.tif"), "u16", 1);
    support_imagej(program, support_temporary("u16.tif"));
    write(support_temporary("u8.tif"), "u8", 1);
    support_imagej(program, support_temporary("u8.tif"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scipy_reads_mat),     cmocka_unit_test(octave_reads_mat),
        cmocka_unit_test(octave_reads_hdf5),   cmocka_unit_test(octave_reads_images),
        cmocka_unit_test(imagej_reads_tiff),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
