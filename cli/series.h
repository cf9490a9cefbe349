/* SPDX-License-Identifier: BSD-3-Clause */
/* Metrics of several recordings of phase, frame by frame, in the same regions. */
#ifndef CLI_SERIES_H
#define CLI_SERIES_H

#include "cli.h"
#include "measures.h"

enum { MOST_SERIES = 5 }; /* the last place is the truth's */

/* One recording and what was measured of each of its frames. */
typedef struct series {
    char path[PATH_BYTES];
    const char *name, *key;
    ptie_recording *recording;
    double *value[MEASURES]; /* (frames) each */
} series;

typedef struct series_set {
    series series[MOST_SERIES];
    int count;
    const series *truth; /* the last series, or NULL */
    int64_t frames;
    int64_t first_frame, frame_step; /* of the recording, as in ptie_recording_info */
    int32_t width, height;
    size_t pixels;
    float *map, *true_map;
    uint8_t *labels;
} series_set;

/* Opens the recordings and, unless NULL, the truth, which is measured beside them; checks that they
   fit.  A single file that 'ptie run' wrote gives two series.  GO_ON, or the exit code after a
   message. */
int open_series(series_set *set, const operand_list *files, const char *truth);
/* Labels the regions: the rectangles, or, if `jet` is empty, what the mean of the last map
 * proposes.  GO_ON, or the exit code after a message. */
int label_regions(series_set *set, ptie_rect jet, ptie_rect background);
/* Measures frame t of every series. */
ptie_status measure_frame(series_set *set, int64_t t);
/* Mean and standard deviation over frames. */
ptie_run_row summarise_series(const series_set *set, int which);
void close_series(series_set *set); /* fine on a zeroed one */

#endif
