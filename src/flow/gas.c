/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/gas.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Gladstone-Dale constants from refractivities at 0 C, 1 atm, 589 nm (Kaye & Laby). */
static const ptie_gas gases[PTIE_GASES] = {
    [PTIE_AIR] = {2.260e-4, 1.400, 287.05},
    [PTIE_NITROGEN] = {2.376e-4, 1.400, 296.80},
    [PTIE_HELIUM] = {1.960e-4, 1.667, 2077.1},
    [PTIE_ARGON] = {1.593e-4, 1.667, 208.13},
    [PTIE_CARBON_DIOXIDE] = {2.292e-4, 1.289, 188.92},
    [PTIE_HYDROGEN] = {1.534e-3, 1.405, 4124.2},
    [PTIE_METHANE] = {6.204e-4, 1.304, 518.28},
};

const ptie_gas *ptie_gas_get(ptie_gas_kind kind) {
    return &gases[kind];
}

double ptie_gas_density(const ptie_gas *gas, double pressure_pa, double temperature_k) {
    return pressure_pa / (gas->constant * temperature_k);
}

double ptie_gas_refractivity(const ptie_gas *gas, double pressure_pa, double temperature_k) {
    return gas->gladstone * ptie_gas_density(gas, pressure_pa, temperature_k);
}

double ptie_ambient_refractivity(void) {
    return ptie_gas_refractivity(&gases[PTIE_AIR], PTIE_AMBIENT_PA, PTIE_AMBIENT_K);
}

double ptie_electron_phase(double wavelength_m, double column) {
    const double electron_radius_m = 2.8179403262e-15; /* classical */
    return -electron_radius_m * wavelength_m * column;
}

double ptie_isentropic_density(double gamma, double mach) {
    return pow(1 + (gamma - 1) / 2 * mach * mach, -1 / (gamma - 1));
}

double ptie_shock_density(double gamma, double mach) {
    double m2 = mach * mach;
    return (gamma + 1) * m2 / ((gamma - 1) * m2 + 2);
}

double ptie_oblique_deflection(double gamma, double mach, double beta) {
    double m2 = mach * mach, s = sin(beta);
    return atan(2 / tan(beta) * (m2 * s * s - 1) / (m2 * (gamma + cos(2 * beta)) + 2));
}

double ptie_prandtl_meyer(double gamma, double mach) {
    double root = sqrt(mach * mach - 1), g = sqrt((gamma + 1) / (gamma - 1));
    return g * atan(root / g) - atan(root);
}

double ptie_prandtl_meyer_mach(double gamma, double angle) {
    double low = 1, high = 50;
    for (int i = 0; i < 60; i++) { /* the angle grows with the Mach number */
        double middle = (low + high) / 2;
        if (ptie_prandtl_meyer(gamma, middle) < angle)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

ptie_underexpanded ptie_underexpand(const ptie_gas *gas, double pressure_ratio, double total_k) {
    const double g = gas->gamma, total_pa = pressure_ratio * PTIE_AMBIENT_PA;
    const double first_zero = 2.404825557695773; /* of J0 */
    ptie_underexpanded jet = {0};
    double m2 = 2 / (g - 1) * (pow(pressure_ratio, (g - 1) / g) - 1);
    double expansion = (1 + (g - 1) / 2 * m2) / ((g + 1) / 2);
    jet.mach = sqrt(m2);
    jet.diameter = sqrt(pow(expansion, (g + 1) / (2 * (g - 1))) / jet.mach);
    jet.exit_pressure = total_pa * pow(2 / (g + 1), g / (g - 1));
    jet.exit_density = ptie_gas_density(gas, jet.exit_pressure, 2 * total_k / (g + 1));
    jet.density = ptie_gas_density(gas, total_pa, total_k) * ptie_isentropic_density(g, jet.mach);
    jet.cell = PI / first_zero * jet.diameter * sqrt(m2 - 1);
    if (pressure_ratio > 5) { /* below, the shocks of a cell meet in a point: diamonds */
        jet.disk = 0.645 * sqrt(pressure_ratio);
        jet.disk_diameter = 0.36 * sqrt(pressure_ratio - 3.9);
    }
    return jet;
}
