/* SPDX-License-Identifier: BSD-3-Clause */
/* One row per epoch: as CSV (which reads back to the same numbers) and as JSON. */
#ifndef PTIE_TRAIN_HISTORY_H
#define PTIE_TRAIN_HISTORY_H

#include <ptie/train.h>

#include "base/text.h"

/* Appends the rows as CSV with a header line. */
void ptie_history_print(ptie_text *csv, const ptie_epoch *epochs, size_t count);
/* Reads what ptie_history_print wrote; *epochs is malloc'ed.  `where` names the text in messages.
 */
ptie_status ptie_history_parse(ptie_epoch **epochs, size_t *count, const char *csv,
                               const char *where);

/* Rewrites <path>.history.csv and <path>.history.json. */
ptie_status ptie_history_write(const char *path, const ptie_epoch *epochs, size_t count);
/* ptie_history_read. */
ptie_status ptie_history_load(ptie_epoch **epochs, size_t *count, const char *path);

/* Row with the smallest validation loss, the first of equals; `count` if there is none. */
size_t ptie_history_best(const ptie_epoch *epochs, size_t count);

#endif
