/* SPDX-License-Identifier: BSD-3-Clause */
/* The files beside a simulated recording, and the rigs among them. */
#ifndef PTIE_SIMULATE_RIG_H
#define PTIE_SIMULATE_RIG_H

#include <ptie/simulate.h>

#include "base/status.h"

enum { PTIE_SIMULATED_PATH = 4096 };

/* "" for a file that is not written. */
typedef struct ptie_simulated_files {
    char reference[PTIE_SIMULATED_PATH], dark[PTIE_SIMULATED_PATH], target[PTIE_SIMULATED_PATH]; /* as the recording */
    char truth[PTIE_SIMULATED_PATH];                                /* HDF5 */
    char true_rig[PTIE_SIMULATED_PATH]; /* the rig as `ptie rig calibrate` ought to find it */
} ptie_simulated_files;

/* PTIE_EINVAL for a name that is too long. */
ptie_status ptie_simulate_name_files(ptie_simulated_files *files, const ptie_simulate_params *params);
/* params->rig as a lab knows it, and files->true_rig. */
ptie_status ptie_simulate_write_rigs(const ptie_simulate_params *params, const ptie_simulated_files *files);

#endif
