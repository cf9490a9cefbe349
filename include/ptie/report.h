/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run did and found, as one HTML file to read and to send: parameters, warnings, maps, metrics over time.
 */
#ifndef PTIE_REPORT_H
#define PTIE_REPORT_H

#include <ptie/status.h>

/* Draws the report of a result that ptie_run wrote, complete or on its way ("phase.h5.part": its finished frames).
   The file needs no other: figures are inside it.  It depends on the result alone.  Written whole or not at all.
   Errors: PTIE_EFORMAT (not a result of ptie_run, or without a finished frame), PTIE_EEXIST, PTIE_EIO,
   PTIE_ENOMEM.  Thread-safe. */
PTIE_API PTIE_NODISCARD ptie_status ptie_report_write(const char *html, const char *result, bool overwrite);

#endif
