/* SPDX-License-Identifier: BSD-3-Clause */
/* Figures as files: size, colours, gaps, and nothing left behind by a failure. */
#include "support/support.h"

#include <math.h>
#include <png.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <ptie/figure.h>

#include "report/colormap.h"

typedef struct picture {
    int width, height;
    unsigned char *rgb;
} picture;

/* Decoded by libpng, which checks every CRC. */
static picture decode(const char *path) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, path));
    image.format = PNG_FORMAT_RGB;
    picture p = {(int)image.width, (int)image.height, malloc(PNG_IMAGE_SIZE(image))};
    assert_true(png_image_finish_read(&image, NULL, p.rgb, 0, NULL));
    return p;
}

static uint32_t pixel(const picture *p, int x, int y) {
    const unsigned char *c = p->rgb + 3 * ((size_t)y * (size_t)p->width + (size_t)x);
    return (uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | c[2];
}

/* Number of pixels of one colour, and where their middle is. */
static int find(const picture *p, uint32_t rgb, double *x_mean, double *y_mean) {
    int count = 0;
    *x_mean = *y_mean = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            if (pixel(p, x, y) == rgb) count++, *x_mean += x, *y_mean += y;
    *x_mean /= count;
    *y_mean /= count;
    return count;
}

static const char *drawn(const char *name, const ptie_panel *panel, double width_mm) {
    const char *path = support_temporary(name);
    ptie_panels figure = {.panels = panel, .rows = 1, .columns = 1, .width_mm = width_mm};
    assert_ok(ptie_figure_panels(path, &figure, true));
    return path;
}

static void maps_have_the_colours_of_their_values(void **state) {
    (void)state;
    const float data[] = {0.1f, 0.35f, 0.7f, 0.95f};
    for (int map = PTIE_GRAY; map <= PTIE_VIRIDIS; map++) {
        ptie_panel panel = {.data = data, .width_px = 2, .height_px = 2, .low = 0, .high = 1};
        panel.colormap = (ptie_colormap)map;
        picture p = decode(drawn("quarters.png", &panel, 60));
        double x[4], y[4];
        int count[4];
        for (int i = 0; i < 4; i++)
            count[i] = find(&p, ptie_colour(panel.colormap, (double)data[i]), &x[i], &y[i]);
        assert_true(x[0] < x[1] && x[2] < x[3] && y[0] < y[2] && y[1] < y[3]);
        assert_near(y[0], y[1], 3); /* the colour bar may add a few pixels of the same colour */
        for (int i = 1; i < 4; i++) assert_near(count[i], count[0], 0.05 * count[0]);
        free(p.rgb);
    }
}

static void pngs_have_300_dpi(void **state) {
    (void)state;
    const float data[] = {0, 1};
    ptie_panel panel = {.data = data, .width_px = 2, .height_px = 1, .title = "µ"};
    const char *path = drawn("dpi.png", &panel, 88);
    picture p = decode(path);
    assert_int_equal(p.width, (int)lround(88 / 25.4 * 300));
    free(p.rgb);
    size_t bytes;
    unsigned char *file = support_read(path, &bytes);
    static const unsigned char resolution[] = {'p',  'H', 'Y', 's',  0,    0, 0x2e,
                                               0x23, 0,   0,   0x2e, 0x23, 1};
    assert_memory_equal(file + 37, resolution, sizeof resolution);
    free(file);
}

static void large_maps_are_averaged(void **state) {
    (void)state;
    enum { N = 2048 };
    float *data = malloc(sizeof *data * N * N);
    for (int i = 0; i < N * N; i++) data[i] = (float)((i + i / N) % 2); /* chessboard */
    ptie_panel panel = {.data = data, .width_px = N, .height_px = N, .low = 0, .high = 1};
    const char *path = drawn("chess.png", &panel, 60);
    picture p = decode(path);
    /* A printed pixel covers 4.2^2 squares: |mean - 1/2| <= 1/2 * (area of the odd square)/(area).
     */
    for (int i = -100; i < 100; i++) {
        uint32_t found = pixel(&p, p.width / 3 + i, p.height / 2 + i) & 255;
        assert_in_range(found, 127 - 15, 128 + 15);
    }
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_true(info.st_size < 300000);
    free(p.rgb);
    free(data);
}

static void missing_values_have_their_own_colour(void **state) {
    (void)state;
    float data[64];
    double x, y;
    for (int i = 0; i < 64; i++) data[i] = i == 9 ? NAN : (float)i;
    ptie_panel panel = {.data = data, .width_px = 8, .height_px = 8, .colormap = PTIE_DIVERGING};
    picture p = decode(drawn("nan.png", &panel, 60));
    int count = find(&p, PTIE_NAN_COLOUR, &x, &y);
    double side = sqrt(count) * 8;
    assert_true(side > 0.5 * p.width && side < p.width);
    free(p.rgb);
    for (int i = 0; i < 64; i++) data[i] = NAN;
    p = decode(drawn("nan.png", &panel, 60));
    assert_true(find(&p, PTIE_NAN_COLOUR, &x, &y) > 50 * count);
    free(p.rgb);
}

static void outliers_do_not_set_the_range(void **state) {
    (void)state;
    enum { N = 100 };
    static float data[N * N];
    for (int i = 0; i < N * N; i++) data[i] = (float)(i % N) / N;
    data[17] = 1e9f;
    data[4711] = -1e9f;
    ptie_panel panel = {.data = data, .width_px = N, .height_px = N};
    picture p = decode(drawn("outliers.png", &panel, 60));
    double x, y;
    assert_true(find(&p, 0x000000, &x, &y) > 0.004 * p.width * p.width); /* the first column */
    uint32_t middle = pixel(&p, (int)(0.4 * p.width), p.height / 2) & 255;
    assert_in_range(middle, 100, 156);
    free(p.rgb);
}

/* Rows and columns of different map sizes, an empty place, titles, a shared bar: only that it
 * works. */
static void grids_of_any_shape_are_drawn(void **state) {
    (void)state;
    static float data[300 * 40];
    for (int i = 0; i < 300 * 40; i++) data[i] = (float)sin(i * 0.01);
    ptie_panel panels[6] = {
        {.data = data, .width_px = 300, .height_px = 40, .title = "wide", .unit = "rad"},
        {.data = data, .width_px = 40, .height_px = 300, .pixel_m = 1e-6},
        {0},
        {.data = data, .width_px = 1, .height_px = 1, .pixel_m = 0.3},
        {.data = data, .width_px = 100, .height_px = 120, .low = -1, .high = 1},
        {.data = data, .width_px = 3, .height_px = 40, .colormap = PTIE_DIVERGING}};
    const char *rows[] = {"first row", NULL};
    ptie_panels figure = {
        .panels = panels, .rows = 2, .columns = 3, .row_titles = rows, .title = "All"};
    assert_ok(ptie_figure_panels(support_temporary("grid.png"), &figure, true));
    assert_ok(ptie_figure_panels(support_temporary("grid.svg"), &figure, true));
    figure.rows = 3, figure.columns = 2, figure.row_titles = NULL, figure.width_mm = 40;
    assert_ok(ptie_figure_panels(support_temporary("grid.png"), &figure, true));
}

/* Every tag that opens closes, in order. */
static void assert_well_formed(const char *text) {
    const char *open[64];
    size_t depth = 0, tags = 0;
    for (const char *c = strchr(text, '<'); c; c = strchr(c, '<')) {
        const char *name = ++c, *end = strchr(c, '>');
        assert_non_null(end);
        tags++;
        c = end;
        if (*name == '?' || *name == '!' || end[-1] == '/') continue;
        bool closing = *name == '/';
        size_t length = strcspn(name + closing, " >\n");
        if (!closing) {
            assert_true(depth < 64);
            open[depth++] = name;
        } else {
            assert_true(depth-- > 0);
            assert_memory_equal(open[depth], name + 1, length);
        }
    }
    assert_int_equal(depth, 0);
    assert_true(tags > 20);
}

static ptie_axes falling_curve(double x[20], double y[20], ptie_curve *curve) {
    for (int i = 0; i < 20; i++) x[i] = i + 1, y[i] = exp(-i / 4.0);
    *curve = (ptie_curve){.x = x, .y = y, .count = 20, .label = "loss <&>", .colour = 0};
    return (ptie_axes){
        .curves = curve, .count = 1, .title = "Loss", .x_label = "epoch", .y_label = "loss"};
}

static void svgs_are_well_formed(void **state) {
    (void)state;
    double x[20], y[20];
    ptie_curve curve;
    ptie_axes axes[2] = {falling_curve(x, y, &curve), falling_curve(x, y, &curve)};
    const char *path = support_temporary("curves.svg");
    size_t bytes;
    assert_ok(ptie_figure_curves(path, axes, 2, "Ünïcode <&>", 0, true));
    unsigned char *text = support_read(path, &bytes);
    assert_memory_equal(text, "<?xml", 5);
    assert_well_formed((char *)text);
    free(text);
}

static void curves_have_gaps_at_missing_values(void **state) {
    (void)state;
    double x[20], y[20], from, y_mean, without;
    ptie_curve curve;
    ptie_axes axes = falling_curve(x, y, &curve);
    curve.label = NULL;
    const char *path = support_temporary("gap.png");
    assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 90, true));
    picture whole = decode(path);
    int all = find(&whole, ptie_curve_colour(0), &from, &y_mean);
    for (int i = 0; i < 10; i++) y[i] = i % 2 ? (double)NAN : HUGE_VAL;
    y[0] = 1; /* keeps the range */
    axes.log_y = false;
    assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 90, true));
    picture gap = decode(path);
    int some = find(&gap, ptie_curve_colour(0), &without, &y_mean);
    assert_true(some > 100 && some < 0.7 * all && without > from + 50);
    free(whole.rgb);
    free(gap.rgb);
}

static void curves_without_a_point_are_drawn(void **state) {
    (void)state;
    double x[20], y[20];
    ptie_curve curve;
    ptie_axes axes = falling_curve(x, y, &curve);
    const char *path = support_temporary("odd.png");
    for (int log_y = 0; log_y < 2; log_y++) {
        axes.log_y = log_y;
        for (int i = 0; i < 20; i++) y[i] = (double)NAN;
        assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 60, true));
        for (int i = 0; i < 20; i++) y[i] = -1;
        assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 60, true));
        y[3] = 1e-99, y[4] = 1e99, y[5] = 1e300;
        assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 60, true));
        curve.count = 1;
        assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 60, true));
        curve.count = 0;
        assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 60, true));
        curve.count = 20;
    }
}

static void assert_nothing_left(const char *path) {
    char part[1100];
    snprintf(part, sizeof part, "%s.part", path);
    assert_false(support_exists(part));
}

static void failures_leave_no_file(void **state) {
    (void)state;
    const float data[] = {0, 1};
    ptie_panel panel = {.data = data, .width_px = 2, .height_px = 1};
    ptie_panels figure = {.panels = &panel, .rows = 1, .columns = 1};
    const char *path = support_temporary("figure.jpg");
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EUNSUPPORTED,
                 "ending in .png or .svg");
    assert_false(support_exists(path));
    path = support_temporary("folder.png");
    assert_int_equal(mkdir(path, 0700), 0);
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EIO, "directory");
    assert_nothing_left(path);
    path = support_temporary("there.png");
    support_write(path, "mine", 4);
    assert_fails(ptie_figure_panels(path, &figure, false), PTIE_EEXIST, "exists already");
    assert_nothing_left(path);
    assert_fails(ptie_figure_panels(support_temporary("no/such/folder.svg"), &figure, true),
                 PTIE_EIO, "No such file");
    const char *wrong[] = {"\xff", "\xc3", "\xe2\x82", "a\x80", "\xf0\x90\x80z"};
    path = support_temporary("title.png");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        panel.title = wrong[i];
        assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "title is not UTF-8");
    }
    assert_false(support_exists(path));
    assert_nothing_left(path);
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    float data[64 * 64];
    for (int i = 0; i < 64 * 64; i++) data[i] = (float)(i * 7919 % 1009);
    ptie_panel panel = {.data = data, .width_px = 64, .height_px = 64};
    ptie_panels figure = {.panels = &panel, .rows = 1, .columns = 1};
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = (struct rlimit){.rlim_cur = 1000, .rlim_max = before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    const char *names[] = {support_temporary("full.png"), support_temporary("full.svg")};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        ptie_status status = ptie_figure_panels(names[i], &figure, true);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0); /* so that messages can be printed */
        assert_fails(status, PTIE_EIO, "File too large");
        assert_false(support_exists(names[i]));
        assert_nothing_left(names[i]);
    }
}

static void arguments_are_checked(void **state) {
    (void)state;
    const float data[] = {0, 1};
    ptie_panel panel = {.data = data, .width_px = 2, .height_px = 1, .low = 1, .high = 0};
    ptie_panels figure = {.panels = &panel, .rows = 1, .columns = 1};
    const char *path = support_temporary("never.png");
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "expected low <= high");
    panel.low = panel.high = (double)NAN;
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "expected low <= high");
    panel.low = panel.high = 0, panel.width_px = 0;
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "width_px");
    panel.width_px = 2, figure.width_mm = 5;
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "width_mm");
    figure.width_mm = 0, figure.rows = 0;
    assert_fails(ptie_figure_panels(path, &figure, true), PTIE_EINVAL, "rows");
    assert_fails(ptie_figure_panels(NULL, &figure, true), PTIE_EINVAL, "path");
    assert_fails(ptie_figure_curves(path, NULL, 1, NULL, 0, true), PTIE_EINVAL, "axes");
    assert_false(support_exists(path));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_have_the_colours_of_their_values),
        cmocka_unit_test(pngs_have_300_dpi),
        cmocka_unit_test(large_maps_are_averaged),
        cmocka_unit_test(missing_values_have_their_own_colour),
        cmocka_unit_test(outliers_do_not_set_the_range),
        cmocka_unit_test(grids_of_any_shape_are_drawn),
        cmocka_unit_test(svgs_are_well_formed),
        cmocka_unit_test(curves_have_gaps_at_missing_values),
        cmocka_unit_test(curves_without_a_point_are_drawn),
        cmocka_unit_test(failures_leave_no_file),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
