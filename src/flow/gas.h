/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas dynamics behind the physical family: refractivity, isentropic flow, shocks, expansions,
   under-expanded jets.  docs/math.md (F6)-(F9), (F11). */
#ifndef PTIE_FLOW_GAS_H
#define PTIE_FLOW_GAS_H

#include "base/random.h"

#define PTIE_AMBIENT_PA 101325.0
#define PTIE_AMBIENT_K 293.15
/* sqrt(2 pi): path through a Gaussian of standard deviation 1. */
#define PTIE_GAUSSIAN_DEPTH 2.5066282746310002

typedef struct ptie_gas {
    double gladstone; /* Gladstone-Dale constant (n - 1) / rho, m^3/kg, visible light */
    double gamma;     /* ratio of specific heats */
    double constant;  /* specific gas constant, J/(kg K) */
} ptie_gas;

typedef enum ptie_gas_kind {
    PTIE_AIR,
    PTIE_NITROGEN,
    PTIE_HELIUM,
    PTIE_ARGON,
    PTIE_CARBON_DIOXIDE,
    PTIE_HYDROGEN,
    PTIE_METHANE,
    PTIE_GASES
} ptie_gas_kind;

const ptie_gas *ptie_gas_get(ptie_gas_kind kind);

double ptie_gas_density(const ptie_gas *gas, double pressure_pa, double temperature_k);
/* n - 1 */
double ptie_gas_refractivity(const ptie_gas *gas, double pressure_pa, double temperature_k);
/* n - 1 of the undisturbed air */
double ptie_ambient_refractivity(void);

/* Phase (rad) behind free electrons of `column` per m^2: negative. */
double ptie_electron_phase(double wavelength_m, double column);

/* rho / rho0 of isentropic flow. */
double ptie_isentropic_density(double gamma, double mach);
/* rho2 / rho1 across a normal shock. */
double ptie_shock_density(double gamma, double mach);
/* Angle (rad) by which an oblique shock of angle beta deflects the flow. */
double ptie_oblique_deflection(double gamma, double mach, double beta);
/* Prandtl-Meyer angle (rad), and the Mach number that has it. */
double ptie_prandtl_meyer(double gamma, double mach);
double ptie_prandtl_meyer_mach(double gamma, double angle);

/* A choked nozzle of diameter 1 that exhausts into air.  Lengths in nozzle diameters. */
typedef struct ptie_underexpanded {
    double mach, diameter;        /* of the ideally expanded jet */
    double exit_pressure;         /* Pa */
    double exit_density, density; /* at the exit, ideally expanded; kg/m^3 */
    double cell;                  /* length of the first shock cell (Prandtl-Pack) */
    double disk, disk_diameter;   /* Mach disk: distance, diameter; 0 without one */
} ptie_underexpanded;
/* pressure_ratio = p0 / ambient, above the choking limit. */
ptie_underexpanded ptie_underexpand(const ptie_gas *gas, double pressure_ratio, double total_k);

#endif
