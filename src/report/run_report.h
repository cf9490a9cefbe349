/* SPDX-License-Identifier: BSD-3-Clause */
/* The report of a run's result; contract as in <ptie/report.h>, arguments already checked. */
#ifndef PTIE_REPORT_RUN_REPORT_H
#define PTIE_REPORT_RUN_REPORT_H

#include "base/status.h"

ptie_status ptie_draw_report(const char *path, const char *result, bool overwrite);

#endif
