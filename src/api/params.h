/* SPDX-License-Identifier: BSD-3-Clause */
/* Argument checks of the public functions.  `where` is the function's name; messages read
 * "<where>: <what> ... (expected <this>, found <that>)".
 */
#ifndef PTIE_API_PARAMS_H
#define PTIE_API_PARAMS_H

#include "base/status.h"

/* Reads a caller's parameter struct, which begins with its uint32_t struct_size, over the defaults
   that `params` (of `size` bytes) already holds.  A shorter struct comes from an older caller: the
   fields it does not have keep their defaults.  A longer one comes from a newer caller: accepted if
   what this version does not know is zero.  PTIE_EINVAL otherwise, and when `given` is NULL or was
   not initialised. */
ptie_status ptie_params_read(void *params, size_t size, const void *given, const char *where);

ptie_status ptie_check_pointer(const void *pointer, const char *where, const char *name);
ptie_status ptie_check_integer(int64_t value, int64_t low, int64_t high, const char *where,
                               const char *name);
ptie_status ptie_check_number(double value, double low, double high, const char *where,
                              const char *name);
/* Finite and > 0. */
ptie_status ptie_check_positive(double value, const char *where, const char *name);
/* What a map is called: a word of files and paths, 1 to 63 letters, digits, '_' and '-'. */
ptie_status ptie_check_name(const char *name, const char *where);
/* Not NULL and aligned as plans need it. */
ptie_status ptie_check_scratch(const void *scratch, const char *where);

#endif
