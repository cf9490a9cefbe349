/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/exhaust.h"

#include <math.h>

#include "flow/gas.h"

#define MODES PTIE_EXHAUST_MODES
#define SQRT_PI 1.7724538509f

/* Zeros of J0. */
static const double zeros[MODES] = {2.404825557695773, 5.520078110286311, 8.653727912911013};

static double bessel_mode(double radius, const void *zero) {
    return radius < 1 ? j0(*(const double *)zero * radius) : 0;
}

/* Pressure waves in the jet (Pack 1950), as density; finer modes die sooner. */
static void set_cells(ptie_exhaust *e, const ptie_gas *gas, const ptie_underexpanded *jet,
                      double rad_per_density, double fade) {
    double excess = (jet->exit_pressure - PTIE_AMBIENT_PA) / (gas->gamma * PTIE_AMBIENT_PA);
    double height = rad_per_density * jet->density * fmin(excess, 0.5); /* the theory is linear */
    for (int i = 0; i < MODES; i++) {
        double z = zeros[i];
        e->cell_wave[i] = (float)(z / ((double)e->radius * sqrt(jet->mach * jet->mach - 1)));
        e->cell_height[i] = (float)(height * 2 / (z * j1(z)));
        e->cell_fade[i] = (float)(fade * zeros[0] / z);
        ptie_projection_fill(&e->cell[i], bessel_mode, &zeros[i], 1);
    }
}

/* Behind the disk the gas is slow again, at about its total temperature and the pressure of the
 * air. */
static void set_disk(ptie_exhaust *e, const ptie_gas *gas, const ptie_underexpanded *jet,
                     double path, double total_k) {
    double diameter = 2 * (double)e->nozzle, air = path * ptie_ambient_refractivity();
    e->disk = (float)(jet->disk * diameter);
    e->disk_radius = (float)(jet->disk_diameter * diameter / 2);
    e->air = (float)air;
    e->exit = (float)(path * gas->gladstone * jet->exit_density - air);
    e->behind = (float)(path * ptie_gas_refractivity(gas, PTIE_AMBIENT_PA, total_k) - air);
}

static const ptie_gas *gas_draw(ptie_random *random) {
    static const ptie_gas_kind kinds[] = {
        PTIE_AIR,
        PTIE_AIR,
        PTIE_AIR,
        PTIE_NITROGEN,
        PTIE_HELIUM,
        PTIE_HELIUM,
        PTIE_ARGON,
        PTIE_CARBON_DIOXIDE,
        PTIE_CARBON_DIOXIDE,
        PTIE_HYDROGEN,
    };
    return ptie_gas_get(kinds[ptie_random_integer(random, 0, sizeof kinds / sizeof *kinds - 1)]);
}

void ptie_exhaust_draw(ptie_exhaust *exhaust, const ptie_scene *scene, ptie_random *random,
                       float nozzle) {
    const ptie_gas *gas = gas_draw(random);
    bool choked = ptie_chance(random, 0.6);
    double ratio = ptie_random_log_uniform(random, 2.2, 14);
    double warm_k = ptie_random_uniform(random, 320, 700);
    double fade_cells = ptie_random_uniform(random, 2, 8);
    double edge = ptie_random_uniform(random, 0.05, 0.3);
    double path = ptie_scene_rad(scene); /* rad per unit and n - 1 */
    double air_rad = path * ptie_ambient_refractivity(), density;
    const bool is_air = gas == ptie_gas_get(PTIE_AIR) || gas == ptie_gas_get(PTIE_NITROGEN);
    *exhaust = (ptie_exhaust){.nozzle = nozzle, .radius = nozzle};
    ptie_projection_fill_disc(&exhaust->disc, edge);
    if (choked) {
        ptie_underexpanded jet = ptie_underexpand(gas, ratio, PTIE_AMBIENT_K);
        density = jet.density;
        exhaust->radius = nozzle * (float)jet.diameter;
        if (jet.disk > 0) set_disk(exhaust, gas, &jet, path, PTIE_AMBIENT_K);
        set_cells(exhaust, gas, &jet, path * gas->gladstone,
                  fade_cells * jet.cell * 2 * (double)nozzle);
    } else { /* at ambient pressure; air would not show unless it is warm */
        density = ptie_gas_density(gas, PTIE_AMBIENT_PA, is_air ? warm_k : PTIE_AMBIENT_K);
    }
    double air = ptie_gas_density(ptie_gas_get(PTIE_AIR), PTIE_AMBIENT_PA, PTIE_AMBIENT_K);
    double core =
        5.4 * sqrt(density / air); /* diameters until the concentration on the axis falls */
    exhaust->core = 2 * exhaust->radius * (float)fmin(fmax(core, 3), 12);
    exhaust->gas = (float)(path * gas->gladstone * density - air_rad);
}

static float disc(const ptie_exhaust *e, float radius, float y) {
    return radius * ptie_projection_at(&e->disc, y / radius);
}

/* The first cell with a Mach disk: a barrel, ever thinner inside, in a shell of gas that its shock
   has compressed. */
static float barrel(const ptie_exhaust *e, float width, float x, float y) {
    float t = x / e->disk, s = 1 - t, way = x / e->nozzle;
    float outer = e->nozzle + (width - e->nozzle) * t * (2 - t);
    float inner = s * s * e->nozzle + 2 * s * t * 1.2f * width + t * t * e->disk_radius;
    float inside = (e->exit + e->air) / (1 + way * way) - e->air; /* free expansion: x^-2 */
    return disc(e, outer, y) * e->gas + disc(e, fminf(inner, 0.92f * outer), y) * (inside - e->gas);
}

/* Behind the disk a dense, slow slug that the jet drags along; it takes the place of the jet's gas. */
static float slug(const ptie_exhaust *e, float x, float y) {
    return disc(e, e->disk_radius, y) * (e->behind - e->gas) * expf(1 - x / e->disk);
}

static float cells(const ptie_exhaust *e, float x, float y) {
    float sum = 0, r = y / e->radius;
    if (fabsf(r) >= 1) return 0;
    for (int i = 0; i < MODES; i++)
        sum += e->cell_height[i] * expf(-x / e->cell_fade[i]) * cosf(e->cell_wave[i] * x) *
               ptie_projection_at(&e->cell[i], r);
    return sum * e->radius;
}

float ptie_exhaust_at(const ptie_exhaust *e, const ptie_parcel *p, float x, float y) {
    if (x < 0 || fabsf(p->across) > 3.5f) return 0;
    if (x < e->disk) return barrel(e, p->width, x, y);
    float mixed = ptie_smoothstep((p->x - 0.6f * e->core) / e->core);
    float value = 0;
    if (mixed < 1) value += (1 - mixed) * disc(e, p->width, p->across * p->width);
    if (mixed > 0) {
        float concentration = fminf(1, e->core / fmaxf(p->x, 1e-3f));
        value += mixed * concentration * SQRT_PI * p->width * expf(-p->across * p->across);
    }
    value *= e->gas * fmaxf(0, 1 + 0.25f * p->gust);
    if (e->cell_height[0] != 0) value += cells(e, x - e->disk, y);
    if (e->disk > 0) value += slug(e, x, y);
    return value;
}
