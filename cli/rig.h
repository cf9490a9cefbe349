/* SPDX-License-Identifier: BSD-3-Clause */
/* The commands below 'ptie rig'. */
#ifndef CLI_RIG_H
#define CLI_RIG_H

int rig_new(int argc, char **argv);
int rig_check(int argc, char **argv);
int rig_calibrate(int argc, char **argv);

#endif
