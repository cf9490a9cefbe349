/* SPDX-License-Identifier: BSD-3-Clause */
/* What the tests of files share: damage, full disks, Python as the other reader. */
#ifndef PTIE_TESTS_FILES_H
#define PTIE_TESTS_FILES_H

#include "support/support.h"

typedef ptie_status (*support_file_fn)(const char *path);

/* Neither `path` nor its ".part" is there. */
void support_assert_nothing_left(const char *path);

/* `write` succeeds and leaves `path`; then the disk is full after every 64th part of the size:
   PTIE_EIO with the name of the file, and nothing is left. */
void support_check_full_disk(const char *path, support_file_fn write);

/* `read` succeeds on the whole file and fails with PTIE_EFORMAT, PTIE_EIO or PTIE_EUNSUPPORTED and
   the name of the file on its first 0 .. size-1 bytes; from size-padding on it may succeed as well.
 */
void support_check_truncations(const char *path, support_file_fn read, size_t padding);

/* `read` survives the file at `path` with any one byte 0, 255 or off by one; a failure names the file. */
void support_check_changes(const char *path, support_file_fn read);

/* The check sum of PNG and zlib, and its byte order there. */
uint32_t support_crc32(const unsigned char *data, size_t bytes);
void support_put_be32(unsigned char *bytes, uint32_t value);

/* Runs a program of other software with `path` as its argument, which fails by its exit status; skips the test, and
 * says so, where that software is not installed.  Octave: argv(){1} is the path, an error() fails.  ImageJ: BeanShell
 * with ImageJ's classes, bsh.args[0] is the path; check(condition, found) and exceptions fail. */
void support_python(const char *program, const char *path);
void support_octave(const char *program, const char *path);
void support_imagej(const char *program, const char *path);

#endif
