/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings that we write: what comes back, what others read, and nothing left when it fails. */
#include "support/files.h"

#include <math.h>
#include <unistd.h>

#include "io/nexus.h"
#include "io/recording.h"
#include "io/tiff_tail.h"

enum { T = 3, H = 5, W = 7, PIXELS = H * W };

static const ptie_recording_info info = {.width_px = W,
                                         .height_px = H,
                                         .frames = T,
                                         .unit = "rad",
                                         .frame_rate_hz = 25000,
                                         .pixel_m = 9.53e-5};

static float value_at(int64_t t, size_t i) {
    return 0.25f * (float)i - 3 + 100 * (float)t;
}

static void fill(float frame[PIXELS], int64_t t) {
    for (size_t i = 0; i < PIXELS; i++) frame[i] = value_at(t, i);
}

/* Announces `announced` frames and writes `frames` of them. */
static ptie_status write_frames(const char *path, int64_t announced, int64_t frames,
                                bool overwrite) {
    ptie_writer *writer;
    ptie_recording_info planned = info;
    float frame[PIXELS];
    planned.frames = announced;
    PTIE_TRY(ptie_writer_create(&writer, path, "phase", &planned, overwrite));
    for (int64_t t = 0; t < frames; t++) {
        fill(frame, t);
        ptie_status status = ptie_writer_append(writer, frame);
        if (status != PTIE_OK) {
            ptie_writer_discard(writer);
            return status;
        }
    }
    return ptie_writer_close(writer);
}

/* `slack`: largest error, as a part of a frame's range. */
static void check_frames(const char *path, const char *format, const char *sample, int64_t frames,
                         double slack) {
    ptie_recording *recording;
    float frame[PIXELS];
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *found = ptie_recording_get_info(recording);
    assert_string_equal(found->format, format);
    assert_string_equal(found->sample, sample);
    assert_int_equal(found->frames, frames);
    assert_int_equal(found->width_px, W);
    assert_int_equal(found->height_px, H);
    for (int64_t t = 0; t < frames; t++) {
        const double range = (double)value_at(t, PIXELS - 1) - (double)value_at(t, 0);
        assert_ok(ptie_recording_read(recording, t, frame));
        for (size_t i = 0; i < PIXELS; i++)
            assert_near((double)frame[i], (double)value_at(t, i), slack * range);
    }
    ptie_recording_close(recording);
}

/* Unit, pixel and rate come back; TIFF keeps nine digits of them. */
static void check_notes(const char *path) {
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *found = ptie_recording_get_info(recording);
    assert_string_equal(found->unit, "rad");
    assert_near(found->pixel_m / info.pixel_m, 1,
                1e-7); /* libtiff reads resolutions as float: 2^-24 */
    assert_near(found->frame_rate_hz / info.frame_rate_hz, 1, 1e-8);
    ptie_recording_close(recording);
}

/* 16 bits keep half a step; the value is then rounded to float: half an ulp of 203 in a range
 * of 8.5. */
static const double png_slack = 0.5 / 65535 + 0x1p-17 / 8.5;

static void what_is_written_is_read(void **state) {
    (void)state;
    static const char *const names[][2] = {{"a.npy", "NPY"},
                                           {"a.tif", "TIFF"},
                                           {"b.TIFF", "TIFF"},
                                           {"a.h5", "HDF5"},
                                           {"a.hdf5", "HDF5"}};
    for (size_t i = 0; i < 5; i++) {
        const char *path = support_temporary(names[i][0]);
        assert_ok(write_frames(path, T, T, false));
        check_frames(path, names[i][1], "f32", T, 0);
        assert_fails(write_frames(path, T, T, false), PTIE_EEXIST, names[i][0]);
        assert_ok(write_frames(path, 0, T, true)); /* number of frames not announced */
        check_frames(path, names[i][1], "f32", T, 0);
        if (strcmp(names[i][1], "NPY") != 0) check_notes(path);
    }
    const char *pattern = support_temporary("png_%03d.png");
    assert_ok(write_frames(pattern, T, T, false));
    assert_true(support_exists(support_temporary("png_002.png")));
    check_frames(pattern, "PNG sequence", "f32", T, png_slack);
    check_notes(pattern);
    assert_ok(write_frames(support_temporary("one.png"), 1, 1, false));
    check_frames(support_temporary("one.png"), "PNG", "f32", 1, png_slack);
}

/* Two frames of counts: from 0 up to `largest` in equal steps, and back. */
static ptie_status write_counts(const char *path, const char *sample, float largest) {
    ptie_writer *writer;
    float frame[PIXELS];
    ptie_recording_info counts = info;
    counts.frames = 2;
    snprintf(counts.sample, sizeof counts.sample, "%s", sample);
    PTIE_TRY(ptie_writer_create(&writer, path, "counts", &counts, true));
    for (int t = 0; t < 2; t++) {
        for (size_t i = 0; i < PIXELS; i++)
            frame[i] = largest / 34 * (float)(t ? PIXELS - 1 - i : i);
        ptie_status status = ptie_writer_append(writer, frame);
        if (status != PTIE_OK) {
            ptie_writer_discard(writer);
            return status;
        }
    }
    return ptie_writer_close(writer);
}

static void check_counts(const char *path, const char *sample, float largest) {
    ptie_recording *recording;
    float frame[PIXELS];
    assert_ok(ptie_recording_open(&recording, path));
    assert_string_equal(ptie_recording_get_info(recording)->sample, sample);
    for (int t = 0; t < 2; t++) {
        assert_ok(ptie_recording_read(recording, t, frame));
        for (size_t i = 0; i < PIXELS; i++)
            assert_true(frame[i] == largest / 34 * (float)(t ? PIXELS - 1 - i : i));
    }
    ptie_recording_close(recording);
}

static void integers_stay_integers(void **state) {
    (void)state;
    static const char *const names[] = {"counts.npy", "counts.tif", "counts.h5", "counts_%d.png"};
    for (size_t i = 0; i < 4; i++) {
        const char *path = support_temporary(names[i]);
        assert_ok(write_counts(path, "u8", 34 * 7));
        check_counts(path, "u8", 34 * 7);
        assert_ok(write_counts(path, "u12", 34 * 1927)); /* up to 65518 */
        check_counts(path, "u16", 34 * 1927);
        if (i == 3) continue;
        assert_ok(write_counts(path, "i16", 34 * 1928)); /* float32 */
        check_counts(path, "f32", 34 * 1928);
    }
}

static void what_is_no_integer_is_refused(void **state) {
    (void)state;
    static const char *const names[] = {"no.npy", "no.tif", "no.h5", "no_%d.png"};
    for (size_t i = 0; i < 4; i++) {
        const char *path = support_temporary(names[i]);
        assert_fails(write_counts(path, "u8", 34 * 8), PTIE_ENUMERIC,
                     "at x=4, y=4 expected a whole number of 8 bits, found 256");
        assert_fails(write_counts(path, "u16", 17), PTIE_ENUMERIC,
                     "at x=1, y=0 expected a whole number of 16 bits, found 0.5");
        assert_fails(write_counts(path, "u16", -34), PTIE_ENUMERIC, "found -1");
        assert_fails(write_counts(path, "u16", 34 * 1928), PTIE_ENUMERIC, "found 65552");
        support_assert_nothing_left(i == 3 ? support_temporary("no_0.png") : path);
    }
}

/* info->frame_rate_hz is that of the frames in the file, also when a step lies between them. */
static void a_stepped_recording_keeps_its_rate(void **state) {
    (void)state;
    ptie_writer *writer;
    ptie_recording *recording;
    float frame[PIXELS];
    ptie_recording_info stepped = info;
    const char *path = support_temporary("stepped.h5");
    stepped.first_frame = 10;
    stepped.frame_step = 4;
    assert_ok(ptie_writer_create(&writer, path, "phase", &stepped, false));
    for (int64_t t = 0; t < T; t++) {
        fill(frame, t);
        assert_ok(ptie_writer_append(writer, frame));
    }
    assert_ok(ptie_writer_close(writer));
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *found = ptie_recording_get_info(recording);
    assert_int_equal(found->first_frame, 10);
    assert_int_equal(found->frame_step, 4);
    /* Times 10/R and 14/R, R = 4 * 25 kHz, are rounded to 2^-53; their difference is 2.5 times smaller. */
    assert_near(found->frame_rate_hz / info.frame_rate_hz, 1, 0x1p-49);
    ptie_recording_close(recording);
}

static void a_constant_png_is_exact(void **state) {
    (void)state;
    ptie_writer *writer;
    ptie_recording *recording;
    const ptie_recording_info one = {.width_px = 2, .height_px = 1, .frames = 1};
    float frame[2] = {-1.2345678f, -1.2345678f};
    const char *path = support_temporary("constant.png");
    assert_ok(ptie_writer_create(&writer, path, "phase", &one, false));
    assert_ok(ptie_writer_append(writer, frame));
    assert_ok(ptie_writer_close(writer));
    assert_ok(ptie_recording_open(&recording, path));
    frame[1] = 0;
    assert_ok(ptie_recording_read(recording, 0, frame));
    assert_true(frame[0] == -1.2345678f && frame[1] == -1.2345678f);
    ptie_recording_close(recording);
}

static void nothing_appears_before_the_end(void **state) {
    (void)state;
    static const char *const names[] = {"c.npy", "c.tif", "c.h5", "c_%d.png"};
    float frame[PIXELS];
    for (size_t i = 0; i < 4; i++) {
        ptie_writer *writer;
        const char *path = support_temporary(names[i]);
        const char *file = i == 3 ? support_temporary("c_0.png") : path;
        fill(frame, 0);
        assert_ok(ptie_writer_create(&writer, path, "phase", &info, false));
        assert_ok(ptie_writer_append(writer, frame));
        assert_false(support_exists(file));
        ptie_writer_discard(writer);
        support_assert_nothing_left(file);
    }
    ptie_writer_discard(NULL);
}

static void the_number_of_frames_is_kept(void **state) {
    (void)state;
    static const char *const names[] = {"d.npy", "d.tif", "d.h5", "d_%d.png"};
    for (size_t i = 0; i < 4; i++) {
        const char *path = support_temporary(names[i]);
        const char *file = i == 3 ? support_temporary("d_0.png") : path;
        assert_fails(write_frames(path, T, T - 1, false), PTIE_ESTATE, "expected 3, found 2");
        support_assert_nothing_left(file);
        assert_fails(write_frames(path, T, T + 1, false), PTIE_ESTATE,
                     "too many frames (expected 3)");
        support_assert_nothing_left(file);
        assert_fails(write_frames(path, 0, 0, false), PTIE_ESTATE, "expected 1, found 0");
        support_assert_nothing_left(file);
    }
}

static void several_frames_need_a_pattern(void **state) {
    (void)state;
    const char *path = support_temporary("single.png");
    assert_fails(write_frames(path, T, T, false), PTIE_EINVAL, "expected a pattern such as");
    assert_fails(write_frames(path, 0, 2, false), PTIE_EINVAL, "expected a pattern such as");
    support_assert_nothing_left(path);
}

static void a_png_in_the_way_keeps_all(void **state) {
    (void)state;
    const char *second = support_temporary("way_1.png");
    support_write(second, "mine", 4);
    assert_fails(write_frames(support_temporary("way_%d.png"), T, T, false), PTIE_EEXIST,
                 "way_1.png");
    support_assert_nothing_left(support_temporary("way_0.png"));
    assert_true(support_exists(second));
}

/* An older sequence of six frames, rewritten with three. */
static void a_shorter_png_sequence_replaces_all_of_the_longer(void **state) {
    (void)state;
    char name[16];
    const char *pattern = support_temporary("old_%d.png");
    for (int i = T; i < T + 3; i++) {
        snprintf(name, sizeof name, "old_%d.png", i);
        support_write(support_temporary(name), "old", 3);
    }
    support_write(support_temporary("old_99.png"), "other", 5);
    for (int announced = 0; announced <= T; announced += T)
        assert_fails(write_frames(pattern, announced, T, false), PTIE_EEXIST,
                     "old_3.png: exists already, behind the last of 3 frames");
    support_assert_nothing_left(support_temporary("old_0.png"));
    support_assert_nothing_left(support_temporary("old_2.png"));
    assert_ok(write_frames(pattern, T, T, true));
    for (int i = 0; i < T + 3; i++) {
        snprintf(name, sizeof name, "old_%d.png", i);
        assert_int_equal(support_exists(support_temporary(name)), i < T);
    }
    assert_true(support_exists(support_temporary("old_99.png")));
}

static void arguments_are_checked(void **state) {
    (void)state;
    ptie_writer *writer = NULL;
    ptie_recording *recording = NULL;
    const char *path = support_temporary("bad.npy");
    ptie_recording_info bad = info;
    bad.width_px = 0;
    assert_fails(ptie_writer_create(&writer, path, "phase", &bad, false), PTIE_EINVAL, "width_px");
    bad = info, bad.pixel_m = (double)NAN;
    assert_fails(ptie_writer_create(&writer, path, "phase", &bad, false), PTIE_EINVAL, "pixel_m");
    bad = info, memset(bad.unit, 'a', sizeof bad.unit);
    assert_fails(ptie_writer_create(&writer, path, "phase", &bad, false), PTIE_EINVAL, "unit");
    assert_fails(ptie_writer_create(&writer, path, "a/b", &info, false), PTIE_EINVAL, "name");
    assert_fails(ptie_writer_create(&writer, path, "", &info, false), PTIE_EINVAL, "name");
    assert_fails(ptie_writer_create(&writer, NULL, "phase", &info, false), PTIE_EINVAL, "path");
    assert_fails(ptie_writer_create(NULL, path, "phase", &info, false), PTIE_EINVAL, "out");
    assert_fails(ptie_writer_create(&writer, support_temporary("a.jpg"), "phase", &info, false),
                 PTIE_EUNSUPPORTED, "a.jpg: cannot write this kind of file");
    assert_fails(
        ptie_writer_create(&writer, support_temporary("no/such/a.npy"), "phase", &info, false),
        PTIE_EIO, "No such file");
    assert_fails(ptie_writer_append(NULL, NULL), PTIE_EINVAL, "writer");
    assert_fails(ptie_writer_close(NULL), PTIE_EINVAL, "writer");
    assert_fails(ptie_recording_open(&recording, NULL), PTIE_EINVAL, "path");
    assert_fails(ptie_recording_read(NULL, 0, NULL), PTIE_EINVAL, "recording");
    assert_null(ptie_recording_get_info(NULL));
    ptie_recording_close(NULL);
    support_assert_nothing_left(path);
}

static void a_png_holds_finite_values(void **state) {
    (void)state;
    ptie_writer *writer;
    float frame[PIXELS];
    const char *path = support_temporary("nan.png");
    ptie_recording_info one = info;
    one.frames = 1;
    fill(frame, 0);
    frame[8] = (float)NAN;
    assert_ok(ptie_writer_create(&writer, path, "phase", &one, false));
    assert_fails(ptie_writer_append(writer, frame), PTIE_ENUMERIC,
                 "nan.png: value is not finite (at x=1, y=1");
    assert_fails(ptie_writer_close(writer), PTIE_EIO, "could not be written");
    support_assert_nothing_left(path);
}

static ptie_status write_example(const char *path) {
    return write_frames(path, 1, 1, true);
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    static const char *const names[] = {"full.npy", "full.tif", "full.h5", "full.png"};
    for (size_t i = 0; i < 4; i++)
        support_check_full_disk(support_temporary(names[i]), write_example);
}

/* Makes the ".part" of a path the device that is always full. */
static void a_full_device_is_reported(void **state) {
    (void)state;
    static const char *const names[] = {"device.npy", "device.tif", "device.png", "device.h5"};
    if (!support_exists("/dev/full")) skip();
    for (size_t i = 0; i < 4; i++) {
        char part[1100];
        const char *path = support_temporary(names[i]);
        snprintf(part, sizeof part, "%s.part", path);
        assert_int_equal(symlink("/dev/full", part), 0);
        assert_fails(write_example(path), PTIE_EIO, "No space left on device");
        assert_non_null(strstr(ptie_last_error(), path));
        support_assert_nothing_left(path);
    }
}

static void numpy_reads_npy(void **state) {
    (void)state;
    const char *path = support_temporary("python.npy");
    assert_ok(write_frames(path, 0, T, true));
    support_python("import numpy as np, sys\n"
                   "m = np.load(sys.argv[1], mmap_mode='r')\n"
                   "t, i = np.mgrid[:3, :35]\n"
                   "assert m.shape == (3, 5, 7) and m.dtype == '<f4' and m.offset % 64 == 0\n"
                   "assert (m.reshape(3, 35) == i / 4 - 3 + 100 * t).all()\n",
                   path);
}

static const char read_tiff[] =
    "import numpy as np, sys, tifffile\n"
    "with tifffile.TiffFile(sys.argv[1]) as f:\n"
    "    a, meta, tags, big = f.asarray(), f.imagej_metadata, f.pages[0].tags, f.is_bigtiff\n"
    "    assert len(f.pages) == 3 and (f.pages[1].asarray() == a[1]).all()\n"
    "t, i = np.mgrid[:3, :35]\n"
    "assert a.shape == (3, 5, 7) and a.dtype == '<f4' and (a.reshape(3, 35) == i / 4 - 3 + 100 * "
    "t).all()\n"
    "assert meta['images'] == meta['frames'] == 3 and meta['unit'] == 'um' and meta['vunit'] == "
    "'rad'\n"
    "assert abs(meta['finterval'] * 25000 - 1) < 1e-8\n"
    "n, d = tags['XResolution'].value\n"
    "assert abs(d / n / 95.3 - 1) < 1e-7 and tags['ResolutionUnit'].value == 1\n"
    "assert tifffile.memmap(sys.argv[1], mode='r').shape == (3, 5, 7)\n"
    "assert big == ('big' in sys.argv[1].rsplit('/', 1)[1])\n";

static void tifffile_reads_tiff(void **state) {
    (void)state;
    const char *path = support_temporary("python.tif");
    assert_ok(write_frames(path, T, T, true));
    support_python(read_tiff, path);
}

static void a_large_tiff_is_a_bigtiff(void **state) {
    (void)state;
    static const char space[PTIE_TIFF_DATA] = {0};
    float frame[PIXELS];
    const char *path = support_temporary("big.tif");
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    fwrite(space, 1, sizeof space, out);
    for (int64_t t = 0; t < T; t++) {
        fill(frame, t);
        fwrite(frame, sizeof frame, 1, out);
    }
    const ptie_writer_job job = {.info = info, .stored = {'f', 4}};
    assert_ok(ptie_tiff_write_tail(out, &job, 100)); /* 100 bytes are "too large" already */
    assert_int_equal(fclose(out), 0);
    check_frames(path, "TIFF", "f32", T, 0);
    check_notes(path);
    support_python(read_tiff, path);
}

static void pil_reads_png(void **state) {
    (void)state;
    const char *path = support_temporary("python.png");
    assert_ok(write_frames(path, 1, 1, true));
    support_python("import numpy as np, sys\n"
                   "from PIL import Image\n"
                   "image = Image.open(sys.argv[1])\n"
                   "image.load()\n"
                   "codes, note = np.asarray(image).astype(float), image.text\n"
                   "value = float(note['ptie:offset']) + float(note['ptie:scale']) * codes\n"
                   "want = np.arange(35).reshape(5, 7) / 4 - 3\n"
                   "assert codes.min() == 0 and codes.max() == 65535\n"
                   "assert abs(value - want).max() <= np.ptp(want) * .5000001 / 65535\n"
                   "assert note['ptie:unit'] == 'rad' and note['ptie:name'] == 'phase'\n"
                   "assert float(note['ptie:pixel_m']) == 9.53e-5\n",
                   path);
}

static void h5py_reads_hdf5(void **state) {
    (void)state;
    const char *path = support_temporary("python.h5");
    assert_ok(write_frames(path, 0, T, true));
    support_python(
        "import h5py, numpy as np, sys\n"
        "f = h5py.File(sys.argv[1])\n"
        "data = f[f.attrs['default']][f['entry'].attrs['default']]\n"
        "assert f['entry'].attrs['NX_class'] == 'NXentry' and data.attrs['NX_class'] == 'NXdata'\n"
        "assert list(data.attrs['axes']) == ['time', 'y', 'x']\n"
        "phase = data[data.attrs['signal']]\n"
        "t, i = np.mgrid[:3, :35]\n"
        "assert phase.shape == (3, 5, 7) and phase.dtype == '<f4' and phase.chunks == (1, 5, 7)\n"
        "assert (phase[()].reshape(3, 35) == i / 4 - 3 + 100 * t).all()\n"
        "assert phase.attrs['units'] == 'rad' and phase.attrs['interpretation'] == 'image'\n"
        "assert np.allclose(phase.attrs['element_size_um'], [1, 95.3, 95.3], rtol=1e-12)\n"
        "assert np.allclose(data['time'], np.arange(3) / 25000, rtol=1e-15)\n"
        "assert np.allclose(data['x'], np.arange(7) * 9.53e-5, rtol=1e-15)\n"
        "assert data['y'].shape == (5,) and data['y'].attrs['units'] == 'm'\n"
        "assert data['time'].attrs['units'] == 's'\n",
        path);
}

/* Two signals, frames 10, 12, 14 of a recording without scale: what the pipeline writes. */
static void nexus_holds_several_signals(void **state) {
    (void)state;
    static const ptie_nexus_signal signals[] = {
        {.name = "phase", .long_name = "Phase of the gas flow", .unit = "rad"},
        {.name = "denoised", .unit = "rad"}};
    const ptie_nexus_axes axes = {
        .frames = T, .width_px = W, .height_px = H, .first_frame = 10, .frame_step = 2};
    const char *path = support_temporary("nexus.h5");
    ptie_h5 *h5;
    float frame[PIXELS];
    assert_ok(ptie_h5_create(&h5, path, false));
    assert_ok(ptie_nexus_begin(h5, &axes, signals, 2));
    for (int64_t t = 0; t < T; t++) {
        fill(frame, t);
        assert_ok(ptie_h5_write(h5, PTIE_NEXUS_DATA "/phase", PTIE_H5_F32, (uint64_t)t, 1, frame));
        assert_ok(
            ptie_h5_write(h5, PTIE_NEXUS_DATA "/denoised", PTIE_H5_F32, (uint64_t)t, 1, frame));
    }
    assert_ok(ptie_h5_close(h5));
    check_frames(path, "HDF5", "f32", T, 0);
    support_python(
        "import h5py, sys\n"
        "data = h5py.File(sys.argv[1])['entry/data']\n"
        "assert data.attrs['signal'] == 'phase'\n"
        "assert list(data.attrs['auxiliary_signals']) == ['denoised']\n"
        "assert data['phase'].attrs['long_name'] == 'Phase of the gas flow'\n"
        "assert data['denoised'].attrs['long_name'] == 'denoised'\n"
        "assert list(data['time']) == [10, 12, 14] and data['x'].attrs['units'] == 'px'\n",
        path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(integers_stay_integers),
        cmocka_unit_test(what_is_no_integer_is_refused),
        cmocka_unit_test(a_stepped_recording_keeps_its_rate),
        cmocka_unit_test(a_constant_png_is_exact),
        cmocka_unit_test(nothing_appears_before_the_end),
        cmocka_unit_test(the_number_of_frames_is_kept),
        cmocka_unit_test(several_frames_need_a_pattern),
        cmocka_unit_test(a_shorter_png_sequence_replaces_all_of_the_longer),
        cmocka_unit_test(a_png_in_the_way_keeps_all),
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(a_png_holds_finite_values),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(a_full_device_is_reported),
        cmocka_unit_test(numpy_reads_npy),
        cmocka_unit_test(tifffile_reads_tiff),
        cmocka_unit_test(a_large_tiff_is_a_bigtiff),
        cmocka_unit_test(pil_reads_png),
        cmocka_unit_test(h5py_reads_hdf5),
        cmocka_unit_test(nexus_holds_several_signals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
