/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/camera.h> from outside: arguments, sizes, one exposure. */
#include "support/support.h"

#include <stdlib.h>

#include <ptie/camera.h>

enum { SIDE = 16, PIXELS = SIDE * SIDE };

static void arguments_are_checked(void **state) {
    (void)state;
    ptie_camera_params p;
    ptie_camera *camera;
    float image[PIXELS] = {0}, *images[2] = {image, NULL};
    ptie_camera_params_init(&p);
    assert_fails(ptie_camera_create(NULL, &p, SIDE, SIDE, 20e-6, 1), PTIE_EINVAL, "out");
    assert_fails(ptie_camera_create(&camera, &p, 1, SIDE, 20e-6, 1), PTIE_EINVAL, "width_px");
    assert_fails(ptie_camera_create(&camera, &p, SIDE, SIDE, 0, 1), PTIE_EINVAL, "pixel_m");
    p.bits = 20;
    assert_fails(ptie_camera_create(&camera, &p, SIDE, SIDE, 20e-6, 1), PTIE_EINVAL, "bits");
    assert_null(camera);
    p.bits = 12;
    assert_ok(ptie_camera_create(&camera, &p, SIDE, SIDE, 20e-6, 1));
    void *scratch = ptie_scratch_alloc(ptie_camera_scratch_bytes(camera) + 64);
    assert_fails(ptie_camera_expose(camera, images, image, image, PTIE_EXPOSE_FLOW, 0, scratch), PTIE_EINVAL, "counts");
    images[1] = image;
    assert_fails(ptie_camera_expose(camera, images, NULL, image, PTIE_EXPOSE_FLOW, 0, scratch), PTIE_EINVAL, "plus");
    assert_fails(ptie_camera_expose(camera, images, image, image, PTIE_EXPOSE_FLOW, -1, scratch), PTIE_EINVAL, "frame");
    assert_fails(ptie_camera_light(camera, NULL), PTIE_EINVAL, "i_zero");
    ptie_scratch_free(scratch);
    ptie_camera_free(camera);
    ptie_camera_free(NULL);
}

static void an_exposure_counts_light(void **state) {
    (void)state;
    ptie_camera_params p;
    ptie_camera *camera;
    float plane[PIXELS], dark[PIXELS], light[PIXELS], *images[1] = {light};
    ptie_camera_params_init(&p);
    p.layout = PTIE_CAMERA_MOSAIC;
    p.minus_shift_x_px = 1;
    assert_ok(ptie_camera_create(&camera, &p, SIDE, SIDE, 20e-6, 1));
    assert_int_equal(ptie_camera_sensors(camera), 1);
    assert_ok(ptie_camera_light(camera, plane));
    void *scratch = ptie_scratch_alloc(ptie_camera_scratch_bytes(camera));
    assert_ok(ptie_camera_expose(camera, images, plane, plane, PTIE_EXPOSE_FLOW, 7, scratch));
    images[0] = dark;
    assert_ok(ptie_camera_expose(camera, images, NULL, NULL, PTIE_EXPOSE_DARK, 7, scratch));
    double bright = 0, none = 0;
    for (int i = 0; i < PIXELS; i++) bright += (double)light[i] / PIXELS, none += (double)dark[i] / PIXELS;
    /* 20,000 electrons are 2015.5 counts with a noise of 14.4; black is 64 with one of 2: five standard errors. */
    assert_near(bright, 64 + 2015.5, 5 * 14.4 / SIDE);
    assert_near(none, 64, 5 * 2.1 / SIDE);
    ptie_scratch_free(scratch);
    ptie_camera_free(camera);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(an_exposure_counts_light),
    };
    return cmocka_run_group_tests_name("api camera", tests, NULL, NULL);
}
