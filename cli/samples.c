/* SPDX-License-Identifier: BSD-3-Clause */
#include "samples.h"

int open_samples(samples *s, const char *name) {
    if (!s->data == !s->preset)
        return misused("%s: expected --data FILE or --preset NAME%s", name,
                       s->data ? ", not both" : "");
    ptie_status status;
    if (s->data) {
        status = ptie_dataset_open(&s->dataset, s->data);
    } else {
        status = ptie_preset_load(&s->loaded, s->preset);
        if (status == PTIE_OK)
            status = ptie_dataset_from_preset(&s->dataset, s->loaded, s->seed, (uint64_t)s->count);
    }
    return status == PTIE_OK ? GO_ON : failed(status);
}

void close_samples(samples *s) {
    ptie_dataset_free(s->dataset);
    ptie_preset_free(s->loaded);
}
