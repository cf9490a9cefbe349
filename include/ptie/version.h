/* SPDX-License-Identifier: BSD-3-Clause */
/* The only place the version is written; meson.build reads it from here. */
#ifndef PTIE_VERSION_H
#define PTIE_VERSION_H

#include <ptie/export.h>

#define PTIE_VERSION_MAJOR 0
#define PTIE_VERSION_MINOR 1
#define PTIE_VERSION_PATCH 0
#define PTIE_VERSION_STRING "0.1.0"

/* Version of the library that is running, as "major.minor.patch".  A program compares it with
   PTIE_VERSION_STRING to learn that header and library belong together.  Static; never freed.
   Thread-safe. */
PTIE_API const char *ptie_version(void);

#endif
