/* SPDX-License-Identifier: BSD-3-Clause */
/* How a call says that it failed: a status, and one line for a person.
 *
 * Every function that can fail returns ptie_status and hands results out through its first pointer
 * parameters.  On failure those are NULL (handles) or untouched (buffers), nothing is left
 * half-written, and ptie_last_error() tells what failed, where, what was expected, what was found.
 * The library never prints, exits or aborts.
 */
#ifndef PTIE_STATUS_H
#define PTIE_STATUS_H

#include <ptie/export.h>

/* Values are pinned: 1-9 arguments, 10-19 resources, 20-39 file format, 40-49 numeric, 60-69 state. */
typedef enum ptie_status {
    PTIE_OK = 0,
    PTIE_EINVAL = 1,       /* an argument is outside its documented range */
    PTIE_ESIZE = 2,        /* sizes that must agree do not */
    PTIE_ENAME = 3,        /* unknown name: preset, key, morphology, CPU level, ... */
    PTIE_ENOMEM = 10,      /* out of memory */
    PTIE_EIO = 11,         /* the operating system refused a read, a write or a rename */
    PTIE_EEXIST = 12,      /* the output exists and overwriting was not asked for */
    PTIE_EFORMAT = 20,     /* not a file of the expected kind, or damaged */
    PTIE_EUNSUPPORTED = 21,/* a valid file, with a feature this version does not read */
    PTIE_ENUMERIC = 40,    /* NaN or infinity where a finite number is needed */
    PTIE_ESTATE = 60,      /* call out of order */
    PTIE_ECANCELLED = 61   /* a progress callback asked to stop */
} ptie_status;

/* Short name of a status, such as "invalid argument".  Static; never NULL.  Thread-safe. */
PTIE_API const char *ptie_status_name(ptie_status status);

/* The line that belongs to this thread's most recent failing call:
   "<where>: <what failed> (expected <this>, found <that>)".  Empty if nothing failed yet.  Valid until
   the next failing call on the same thread.  A failure on a worker thread is handed to the thread
   that called the library. */
PTIE_API const char *ptie_last_error(void);

/* A call's progress: `done` of `total` units are finished.  Called on the thread that called the
   library.  Return 0 to go on, anything else to stop the call, which then cleans up and returns
   PTIE_ECANCELLED.  A callback that needs text gets it in `note` ("epoch 3/20 loss 0.21"), else NULL. */
typedef int (*ptie_progress_fn)(void *user, uint64_t done, uint64_t total, const char *note);

typedef struct ptie_progress {
    ptie_progress_fn report; /* NULL: no reports, the call cannot be cancelled */
    void *user;
} ptie_progress;

#endif
