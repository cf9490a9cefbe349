/* SPDX-License-Identifier: BSD-3-Clause */
/* What tests share: cmocka with its prerequisites, statuses, temporary files, numbers. */
#ifndef PTIE_TESTS_SUPPORT_H
#define PTIE_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <ptie/status.h>

/* The call succeeds; on failure the message of the library is shown. */
#define assert_ok(call) support_assert_ok((call), #call, __FILE__, __LINE__)
/* The call fails with `status` and its message contains `fragment`. */
#define assert_fails(call, status, fragment)                                                       \
    support_assert_fails((call), (status), (fragment), #call, __FILE__, __LINE__)
/* |found - expected| <= bound; prints all of them and the ratio. */
#define assert_near(found, expected, bound)                                                        \
    support_assert_near((found), (expected), (bound), #found, __FILE__, __LINE__)

void support_assert_ok(ptie_status status, const char *call, const char *file, int line);
void support_assert_fails(ptie_status status, ptie_status expected, const char *fragment,
                          const char *call, const char *file, int line);
void support_assert_near(double found, double expected, double bound, const char *what,
                         const char *file, int line);

/* ||a - b|| / ||b||, in double. */
double support_relative_error(const float *a, const float *b, size_t count);

/* A fresh folder for this process, removed with its content at exit; the path of a file in it.
   The result is one of eight static buffers. */
const char *support_temporary(const char *name);
/* Path of a file in the source tree ("tests/golden/x.npy"). */
const char *support_source(const char *name);
/* Path of a file among the real recordings ("plume/flow_00.png"), or NULL: then call skip(). */
const char *support_data(const char *name);

bool support_exists(const char *path);
/* Whole file into malloc'ed memory. */
unsigned char *support_read(const char *path, size_t *bytes);
void support_write(const char *path, const void *data, size_t bytes);

#endif
