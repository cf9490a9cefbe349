/* SPDX-License-Identifier: BSD-3-Clause */
/* Help texts of the commands, at most 80 columns wide. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "options.h"

/* Prints purpose, examples, usage and options on stdout; returns exit code 0. */
int print_help(const command_usage *usage);

#endif
