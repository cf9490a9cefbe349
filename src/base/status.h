/* SPDX-License-Identifier: BSD-3-Clause */
/* How the library's inside reports failure.  PTIE_FAIL originates a failure and writes this thread's
   message; PTIE_TRY forwards one and leaves the message alone. */
#ifndef PTIE_BASE_STATUS_H
#define PTIE_BASE_STATUS_H

#include <ptie/status.h>

/* Longest message, with its NUL; longer ones are cut. */
#define PTIE_MESSAGE_BYTES 512

/* Message grammar: "<where>: <what failed> (expected <this>, found <that>)". */
ptie_status ptie_fail(ptie_status status, const char *format, ...) PTIE_PRINTF(2, 3);

/* The thread's message buffer, for handing a worker's message to the calling thread. */
void ptie_set_message(const char *message);

#define PTIE_FAIL(status, ...) ptie_fail((status), __VA_ARGS__)

#define PTIE_TRY(call)                                                                             \
    do {                                                                                           \
        ptie_status try_status_ = (call);                                                          \
        if (try_status_ != PTIE_OK) return try_status_;                                            \
    } while (0)

/* The same inside a function with one `done:` label and a local `status`. */
#define PTIE_TRY_DONE(call)                                                                        \
    do {                                                                                           \
        status = (call);                                                                           \
        if (status != PTIE_OK) goto done;                                                          \
    } while (0)

/* Reports progress; PTIE_ECANCELLED when the callback asks to stop. */
ptie_status ptie_progress_report(ptie_progress progress, uint64_t done, uint64_t total,
                                 const char *note);

#endif
