/* SPDX-License-Identifier: BSD-3-Clause */
/* What fuzz targets share.  A target is a file with one LLVMFuzzerTestOneInput.  With libFuzzer it searches
 * (tools/fuzz); with replay.c it runs once over files that are kept, as a test. */
#ifndef PTIE_TESTS_FUZZ_H
#define PTIE_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include <ptie/status.h>

/* The target's entry: always 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes);

/* Ends the process with a report unless `condition`: what libFuzzer counts as a crash. */
#define FUZZ_CHECK(condition) fuzz_check((condition), #condition, __FILE__, __LINE__)
void fuzz_check(bool condition, const char *text, const char *file, int line);

/* Path of a file of this content in a folder of this process.  The file stays open and is written anew each
   time, which costs a tenth of making one. */
const char *fuzz_file(const char *name, const void *data, size_t bytes);

/* A copy with a NUL behind it, to be freed: text that ends where the input does. */
char *fuzz_text(const uint8_t *data, size_t bytes);

/* What every failure owes: a known status other than "out of memory" (sizes are limited before), and one
   line of printable text that names `where`. */
void fuzz_status(ptie_status status, const char *where);

/* Opens a recording, checks what it says of itself, and reads its first, middle and last frame.  `where`: what
   failures name, the path or the folder of a sequence. */
void fuzz_recording(const char *path, const char *where);

/* A file of as many bytes as size[0] + 256 size[1] says: frames for a header beside it. */
const char *fuzz_frames(const char *name, const uint8_t size[2]);
/* A recording in two files of one stem, which failures name. */
void fuzz_pair(const char *frames, const char *header);

#endif
