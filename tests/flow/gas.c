/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas dynamics against closed forms and tables (NACA 1135). */
#include "support/support.h"

#include <math.h>

#include "flow/diffusion.h"
#include "flow/exhaust.h"
#include "flow/gas.h"

static const double degree = 3.14159265358979323846 / 180;
static const double wavenumber = 2 * 3.14159265358979323846 / 532e-9;

static void shocks_follow_rankine_and_hugoniot(void **state) {
    (void)state;
    assert_near(ptie_shock_density(1.4, 1), 1, 1e-15);
    assert_near(ptie_shock_density(1.4, 2), 8.0 / 3, 1e-14);
    /* (g+1) M^2 / ((g-1) M^2 + 2) = 6 - 30 / (M^2 + 5): 6 - 3e-5 at M = 1000. */
    assert_near(ptie_shock_density(1.4, 1e3), 6, 3.1e-5);
    /* p1 = rho1 = 1: with the pressure that momentum asks for, energy is kept. */
    for (double mach = 1.1; mach < 5; mach += 0.7) {
        double u1 = mach * sqrt(1.4), rho2 = ptie_shock_density(1.4, mach), u2 = u1 / rho2;
        double p2 = 1 + u1 * u1 - rho2 * u2 * u2;
        assert_near(3.5 * p2 / rho2 + u2 * u2 / 2, 3.5 + u1 * u1 / 2, 1e-13 * (3.5 + u1 * u1));
    }
}

static void oblique_shocks_turn_the_flow(void **state) {
    (void)state;
    /* M = 2, 10 deg: beta = 39.31 deg in the tables; their last digit is 0.005 deg, the slope is
     * 0.9. */
    assert_near(ptie_oblique_deflection(1.4, 2, 39.31 * degree) / degree, 10, 0.01);
    assert_near(ptie_oblique_deflection(1.4, 2, asin(0.5)), 0, 1e-15);   /* a Mach wave */
    assert_near(ptie_oblique_deflection(1.4, 3, 90 * degree), 0, 1e-15); /* a normal shock */
}

static void expansions_follow_prandtl_and_meyer(void **state) {
    (void)state;
    assert_near(ptie_prandtl_meyer(1.4, 1), 0, 1e-15);
    /* Tables to 0.005 deg. */
    assert_near(ptie_prandtl_meyer(1.4, 2) / degree, 26.38, 0.005);
    assert_near(ptie_prandtl_meyer(1.4, 5) / degree, 76.92, 0.005);
    /* The limit is 90 deg (sqrt(6) - 1); at M it lacks (g + 1) / (g - 1) - 1 = 5 / M rad. */
    assert_near(ptie_prandtl_meyer(1.4, 1e6) / degree, 90 * (sqrt(6) - 1), 5e-6 / degree * 1.001);
    for (double mach = 1.05; mach < 8; mach *= 1.5)
        assert_near(ptie_prandtl_meyer_mach(1.4, ptie_prandtl_meyer(1.4, mach)), mach, 1e-9 * mach);
    assert_near(ptie_isentropic_density(1.4, 1), pow(1.2, -2.5), 1e-15);
    assert_near(ptie_isentropic_density(1.4, 2), 0.2300, 5e-5);
}

/* Air from 5 bar at 293 K through a bore of 1 mm; values computed by hand to the digits given. */
static void an_underexpanded_jet_has_the_known_numbers(void **state) {
    (void)state;
    const ptie_gas *air = ptie_gas_get(PTIE_AIR);
    ptie_underexpanded jet = ptie_underexpand(air, 5e5 / PTIE_AMBIENT_PA, 293);
    assert_near(jet.mach, 1.70, 0.005);
    assert_near(jet.diameter, 1.156, 0.001);
    assert_near(jet.cell, 2.08, 0.005);
    assert_near(jet.exit_density, 3.77, 0.005);
    assert_near(jet.density, 1.90, 0.005);
    assert_near(jet.disk, 0, 0); /* 4.93 bar ratio: diamonds */
    jet = ptie_underexpand(air, 10, 293);
    assert_near(jet.disk, 0.645 * sqrt(10), 1e-12);
    /* Mass flow through the exit (sonic) and through the ideally expanded jet is the same. */
    double sonic = sqrt(1.4 * 287.05 * 2 * 293 / 2.4);
    double jet_k = PTIE_AMBIENT_PA / (287.05 * jet.density),
           speed = jet.mach * sqrt(1.4 * 287.05 * jet_k);
    assert_near(jet.density * speed * jet.diameter * jet.diameter, jet.exit_density * sonic,
                1e-9 * jet.exit_density * sonic);
}

static void phases_have_the_known_size_and_sign(void **state) {
    (void)state;
    const ptie_gas *air = ptie_gas_get(PTIE_AIR), *helium = ptie_gas_get(PTIE_HELIUM);
    double ambient = ptie_ambient_refractivity();
    assert_near(ambient, 2.72e-4, 0.005e-4);
    ptie_underexpanded jet = ptie_underexpand(air, 5e5 / PTIE_AMBIENT_PA, 293);
    assert_near(wavenumber * 1e-3 * (air->gladstone * jet.exit_density - ambient), 6.8, 0.06);
    assert_near(wavenumber * 1e-3 * (air->gladstone * jet.density - ambient), 1.9, 0.06);
    double light = ptie_gas_refractivity(helium, PTIE_AMBIENT_PA, PTIE_AMBIENT_K) - ambient;
    assert_near(wavenumber * 1e-3 * light, -2.8, 0.06);
    double burnt = ptie_gas_refractivity(air, PTIE_AMBIENT_PA, 7 * PTIE_AMBIENT_K) - ambient;
    assert_near(wavenumber * 1e-2 * burnt, -27.6, 0.06);
    assert_near(ptie_electron_phase(532e-9, 1e23 * 1e-3), -0.15, 0.0005);
}

/* The sum of exp(-t^2 / 2 s^2) over a grid of spacing s / 4 is its integral, to better than 1e-15. */
static double gaussian_sum(double s) {
    double sum = 0;
    for (int i = -40; i <= 40; i++) sum += exp(-0.5 * (i / 4.0) * (i / 4.0)) * s / 4;
    return sum;
}

/* What flows through every cross-section of a plume, and what a puff holds, stays what it was: seen
   along the third direction, the integral of the path over the others. */
static void diffusion_keeps_the_gas(void **state) {
    (void)state;
    const ptie_diffusion d = {.start = 0.03f, .lag = 0.1f};
    const double start = (double)d.start, pi = 3.14159265358979323846;
    for (float way = 0; way < 3; way += 0.25f) {
        double growth = (double)ptie_diffusion_growth(&d, way), sigma = start * growth;
        assert_near(sigma * sigma, start * start * (1 + (double)way / 0.1), 1e-6 * sigma * sigma);
        double plume = gaussian_sum(sigma) * (double)ptie_plume_depth(&d, (float)growth);
        double puff = pow(gaussian_sum(sigma), 2) * (double)ptie_puff_depth(&d, (float)growth);
        /* Pure gas of the source: 2 pi s0^2 and (2 pi)^(3/2) s0^3, less the sqrt(2 pi) that the depth
           leaves out.  Floats round. */
        assert_near(plume, sqrt(2 * pi) * start * start, 5e-7 * plume);
        assert_near(puff, 2 * pi * pow(start, 3), 5e-7 * puff);
    }
}

/* The gas with the given refractivity at rest. */
static bool is_a_gas(double refractivity) {
    for (int kind = 0; kind < PTIE_GASES; kind++) {
        double known = ptie_gas_refractivity(ptie_gas_get((ptie_gas_kind)kind), PTIE_AMBIENT_PA,
                                             PTIE_AMBIENT_K);
        if (fabs(refractivity / known - 1) < 1e-6) return true; /* floats round */
    }
    return false;
}

/* On the axis just behind the Mach disk the light crosses the jet's gas, and within the disk's radius
   gas at rest instead of it. */
static void the_axis_behind_a_mach_disk_is_at_rest(void **state) {
    (void)state;
    const ptie_scene scene = {.width = 256, .height = 256, .pixel_m = 20e-6, .wavelength_m = 532e-9};
    const double unit_m = 256 * 20e-6;
    int seen = 0;
    for (uint64_t seed = 0; seed < 200; seed++) {
        ptie_exhaust e;
        ptie_random random;
        ptie_random_init(&random, seed, PTIE_STREAM_FLOW, 0);
        ptie_exhaust_draw(&e, &scene, &random, 0.03f);
        if (e.disk == 0 || e.disk > 0.6f * e.core) continue; /* no disk, or mixed before it */
        seen++;
        assert_true(is_a_gas((double)(e.behind + e.air) / (wavenumber * unit_m)));
        e.cell_height[0] = 0; /* without the waves that follow */
        const float x = nextafterf(e.disk, 1), chord = ptie_projection_at(&e.disc, 0);
        const ptie_parcel axis = {.x = x, .across = 0, .width = e.radius};
        const double expected = (double)chord * ((double)e.gas * (double)(e.radius - e.disk_radius) +
                                                 (double)e.behind * (double)e.disk_radius);
        const double size = (double)chord * (fabs((double)e.gas) * (double)e.radius +
                                             fabs((double)e.behind) * (double)e.disk_radius);
        assert_near((double)ptie_exhaust_at(&e, &axis, x, 0), expected, 1e-6 * size);
        /* Far downstream the slug is gone by e^-9, the jet's own gas is left. */
        const ptie_parcel far = {.x = 0, .across = 0, .width = e.radius};
        assert_near((double)ptie_exhaust_at(&e, &far, 10 * e.disk, 0),
                    (double)(chord * e.gas * e.radius), 2e-4 * size);
    }
    assert_true(seen > 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shocks_follow_rankine_and_hugoniot),
        cmocka_unit_test(oblique_shocks_turn_the_flow),
        cmocka_unit_test(expansions_follow_prandtl_and_meyer),
        cmocka_unit_test(an_underexpanded_jet_has_the_known_numbers),
        cmocka_unit_test(phases_have_the_known_size_and_sign),
        cmocka_unit_test(diffusion_keeps_the_gas),
        cmocka_unit_test(the_axis_behind_a_mach_disk_is_at_rest),
    };
    return cmocka_run_group_tests_name("flow/gas", tests, NULL, NULL);
}
