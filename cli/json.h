/* SPDX-License-Identifier: BSD-3-Clause */
/* Values as JSON. */
#ifndef CLI_JSON_H
#define CLI_JSON_H

#include <stdio.h>

/* null if the number is not finite. */
void json_number(FILE *out, double value);
/* null for NULL. */
void json_text(FILE *out, const char *text);

#endif
