/* SPDX-License-Identifier: BSD-3-Clause */
/* Video: the bytes of Y4M, colours that come back, and ffmpeg as it may behave. */
#include "support/files.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/recording.h"

enum { T = 3, H = 5, W = 7, PIXELS = H * W };

static const ptie_recording_info size = {.width_px = W, .height_px = H};

/* Frame t, pixel i: 7 i + t. */
static ptie_status write_with(ptie_writer_job job) {
    ptie_writer *writer;
    float frame[PIXELS];
    job.name = "phase";
    PTIE_TRY(ptie_io_create(&writer, &job));
    for (int t = 0; t < T; t++) {
        for (int i = 0; i < PIXELS; i++) frame[i] = (float)(7 * i + t);
        ptie_status status = ptie_io_append(writer, frame);
        if (status != PTIE_OK) {
            ptie_io_discard(writer);
            return status;
        }
    }
    return ptie_io_complete(writer);
}

static ptie_status write_video(const char *path) {
    return write_with((ptie_writer_job){.path = path, .info = size, .overwrite = true});
}

/* The file is `header`, then frames of FRAME and `expected(t, i)`. */
static void check_grey(const char *path, const char *header, int (*expected)(int t, int i)) {
    size_t bytes;
    unsigned char *data = support_read(path, &bytes), *at = data + strlen(header);
    assert_memory_equal(data, header, strlen(header));
    assert_int_equal(bytes, strlen(header) + T * (6 + PIXELS));
    for (int t = 0; t < T; t++) {
        assert_memory_equal(at, "FRAME\n", 6);
        at += 6;
        for (int i = 0; i < PIXELS; i++) assert_int_equal(*at++, expected(t, i));
    }
    free(data);
}

static int as_stored(int t, int i) {
    return 7 * i + t;
}

/* 0 .. 119 become 0 .. 255, what is above is cut. */
static int in_range(int t, int i) {
    const int value = 7 * i + t;
    return value > 119 ? 255 : (int)lrint(value * 255.0 / 119);
}

/* The first frame's extent is 0 .. 238. */
static int by_first(int t, int i) {
    const int value = 7 * i + t;
    return value > 238 ? 255 : (int)lrint(value * 255.0 / 238);
}

static void grey_levels_are_the_values(void **state) {
    (void)state;
    static const char at_25[] = "YUV4MPEG2 W7 H5 F25:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n";
    const char *path = support_temporary("grey.y4m");
    ptie_writer_job job = {.path = path, .info = size, .overwrite = true};
    snprintf(job.info.sample, sizeof job.info.sample, "u8");
    assert_ok(write_with(job));
    check_grey(path, at_25, as_stored);
    job.info.sample[0] = 0;
    assert_ok(write_with(job));
    check_grey(path, at_25, by_first);
    job.high = 119;
    job.played_hz = 29.97;
    assert_ok(write_with(job));
    check_grey(path, "YUV4MPEG2 W7 H5 F2997:100 Ip A1:1 Cmono XCOLORRANGE=FULL\n", in_range);
}

/* Decoded by the inverse of BT.601.  Y', Cb, Cr are rounded to 0.5, which moves red by 1.164 / 2 + 1.596 / 2, green less, blue
 * by 1.164 / 2 + 2.017 / 2 = 1.59. */
static void colours_come_back(void **state) {
    (void)state;
    uint32_t colours[256];
    size_t bytes;
    const char *path = support_temporary("colour.y4m");
    for (uint32_t i = 0; i < 256; i++) colours[i] = i << 16 | (i * 37 % 256) << 8 | (255 - i);
    assert_ok(write_with((ptie_writer_job){
        .path = path, .info = size, .low = 0, .high = 255, .colours = colours, .overwrite = true}));
    unsigned char *data = support_read(path, &bytes);
    static const char header[] = "YUV4MPEG2 W7 H5 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\nFRAME\n";
    assert_memory_equal(data, header, strlen(header));
    assert_int_equal(bytes, strlen(header) - 6 + T * (6 + 3 * PIXELS));
    const unsigned char *plane = data + strlen(header);
    for (int i = 0; i < PIXELS; i++) {
        const double y = 255 / 219.0 * (plane[i] - 16), cb = 255 / 112.0 * (plane[PIXELS + i] - 128),
                     cr = 255 / 112.0 * (plane[2 * PIXELS + i] - 128);
        const uint32_t colour = colours[7 * i];
        assert_near(y + (1 - 0.299) * cr, colour >> 16, 1.39);
        assert_near(y + (1 - 0.114) * cb, colour & 255, 1.60);
        assert_near(y - (0.114 * (1 - 0.114) * cb + 0.299 * (1 - 0.299) * cr) / 0.587, colour >> 8 & 255, 1.19);
    }
    free(data);
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    support_check_full_disk(support_temporary("full.y4m"), write_video);
    support_check_full_disk(support_temporary("full.mat"), write_video);
}

static void a_discarded_video_leaves_nothing(void **state) {
    (void)state;
    static const char *const names[] = {"gone.y4m", "gone.mat"};
    for (int i = 0; i < 2; i++) {
        ptie_writer *writer;
        const float frame[PIXELS] = {0};
        const char *path = support_temporary(names[i]);
        assert_ok(ptie_io_create(&writer, &(ptie_writer_job){.path = path, .name = "phase", .info = size}));
        assert_ok(ptie_io_append(writer, frame));
        ptie_io_discard(writer);
        support_assert_nothing_left(path);
    }
}

static void a_mat_file_has_a_largest_size(void **state) {
    (void)state;
    const char *path = support_temporary("large.mat");
    ptie_writer_job job = {.path = path, .name = "phase", .info = size};
    job.info.width_px = job.info.height_px = 1024;
    job.info.frames = 512; /* 2^31 bytes */
    ptie_writer *writer;
    assert_fails(ptie_io_create(&writer, &job), PTIE_EUNSUPPORTED,
                 "expected at most 511 frames of 4194304 bytes, found 512); write .h5");
    support_assert_nothing_left(path);
}

/* --- ffmpeg --------------------------------------------------------------------------------------
 */

/* Makes a script the only ffmpeg there is; NULL: there is none.  Returns the PATH to restore. */
static char *pretend_ffmpeg(const char *script) {
    const char *folder = support_temporary("bin");
    char file[1100];
    char *path = strdup(getenv("PATH"));
    mkdir(folder, 0777);
    snprintf(file, sizeof file, "%s/ffmpeg", folder);
    remove(file);
    if (script) {
        support_write(file, script, strlen(script));
        assert_int_equal(chmod(file, 0755), 0);
    }
    setenv("PATH", folder, 1);
    return path;
}

static void restore_path(char *path) {
    setenv("PATH", path, 1);
    free(path);
}

/* The last argument is "file:NAME.part"; what comes in goes there. */
#define TAKE_NAME "#!/bin/sh\nfor name; do :; done\n"

static void ffmpeg_gets_the_video(void **state) {
    (void)state;
    size_t bytes, expected;
    const char *path = support_temporary("out.mp4"), *same = support_temporary("same.y4m");
    char *before = pretend_ffmpeg(TAKE_NAME "/bin/cat > \"${name#file:}\"\n");
    assert_ok(write_video(path));
    restore_path(before);
    assert_ok(write_video(same));
    unsigned char *sent = support_read(path, &bytes), *own = support_read(same, &expected);
    assert_int_equal(bytes, expected);
    assert_memory_equal(sent, own, bytes);
    free(sent);
    free(own);
}

static void ffmpeg_may_be_missing(void **state) {
    (void)state;
    const char *path = support_temporary("missing.mp4");
    char *before = pretend_ffmpeg(NULL);
    assert_fails(write_video(path), PTIE_EUNSUPPORTED,
                 "missing.mp4: cannot start ffmpeg: No such file or directory (expected it in PATH");
    restore_path(before);
    support_assert_nothing_left(path);
}

/* It says why and ends: before reading, so that we write to nobody, and after the last frame. */
static void ffmpeg_may_fail(void **state) {
    (void)state;
    static const char *const scripts[] = {
        "#!/bin/sh\necho 'Unknown encoder libx264' >&2\necho more >&2\nexit 1\n",
        "#!/bin/sh\n/bin/cat >/dev/null\necho 'Unknown encoder libx264' >&2\nexit 1\n"};
    const char *path = support_temporary("failed.mp4");
    for (int i = 0; i < 2; i++) {
        char *before = pretend_ffmpeg(scripts[i]);
        assert_fails(write_video(path), PTIE_EIO, "failed.mp4: ffmpeg failed: Unknown encoder libx264");
        restore_path(before);
        support_assert_nothing_left(path);
    }
}

static void ffmpeg_ends_with_a_discarded_video(void **state) {
    (void)state;
    ptie_writer *writer;
    char script[2300], *end;
    size_t bytes;
    const char *path = support_temporary("stopped.mp4"), *pid = support_temporary("pid");
    snprintf(script, sizeof script, "#!/bin/sh\necho $$ > '%s.new'\n/bin/mv '%s.new' '%s'\nexec /bin/sleep 600\n", pid,
             pid, pid);
    char *before = pretend_ffmpeg(script);
    assert_ok(ptie_io_create(&writer, &(ptie_writer_job){.path = path, .name = "phase", .info = size}));
    for (int i = 0; i < 1000 && !support_exists(pid); i++) usleep(10000);
    unsigned char *text = support_read(pid, &bytes);
    const long process = strtol((const char *)text, &end, 10);
    assert_int_equal(kill((pid_t)process, 0), 0);
    ptie_io_discard(writer);
    assert_int_equal(kill((pid_t)process, 0), -1);
    restore_path(before);
    support_assert_nothing_left(path);
    free(text);
}

/* Through the real one and back: 8-bit grey, lossy. */
static void ffmpeg_writes_mp4(void **state) {
    (void)state;
    if (system("command -v ffmpeg >/dev/null && ffmpeg -v error -encoders | grep -q libx264") != 0) {
        print_message("# ffmpeg with libx264 is not installed\n");
        skip();
    }
    char command[2300];
    size_t bytes;
    const char *path = support_temporary("real.mp4"), *back = support_temporary("back.y4m");
    assert_ok(write_video(path));
    snprintf(command, sizeof command, "ffmpeg -v error -y -i '%s' -pix_fmt gray '%s' 1>&2", path, back);
    assert_int_equal(system(command), 0);
    unsigned char *data = support_read(back, &bytes);
    static const char header[] = "YUV4MPEG2 W8 H6 F25:1"; /* sides made even */
    assert_memory_equal(data, header, strlen(header));
    const unsigned char *frame = (const unsigned char *)strstr((const char *)data, "FRAME\n") + 6;
    double sum = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) sum += fabs(frame[8 * y + x] - 7.0 * (7 * y + x) * 255 / 238);
    assert_true(sum / PIXELS < 8); /* x264 at crf 18 on 7 x 5 px of ramp: measured 2.39 */
    free(data);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grey_levels_are_the_values),
        cmocka_unit_test(colours_come_back),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(a_discarded_video_leaves_nothing),
        cmocka_unit_test(a_mat_file_has_a_largest_size),
        cmocka_unit_test(ffmpeg_gets_the_video),
        cmocka_unit_test(ffmpeg_may_be_missing),
        cmocka_unit_test(ffmpeg_may_fail),
        cmocka_unit_test(ffmpeg_ends_with_a_discarded_video),
        cmocka_unit_test(ffmpeg_writes_mp4),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
