/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the frames of a simulation go: signals of an HDF5 file side by side, or a recording of one image per frame. */
#ifndef PTIE_SIMULATE_FILM_H
#define PTIE_SIMULATE_FILM_H

#include <ptie/simulate.h>

#include "io/h5.h"
#include "io/recording.h"

enum { PTIE_FILM_IMAGES = 3 };

typedef struct ptie_film {
    ptie_h5 *h5;         /* or NULL, then */
    ptie_writer *writer; /* one image per frame */
    const char *data_set[PTIE_FILM_IMAGES];
    int32_t images;
} ptie_film;

/* Intensities of both planes and the true phase in one file: what `params` simulate without a camera. */
ptie_status ptie_film_open_planes(ptie_film *film, const ptie_simulate_params *params);
/* Counts of both sensors of a camera in one HDF5 file. */
ptie_status ptie_film_open_sensors(ptie_film *film, const char *path, const ptie_simulate_params *params,
                                   int64_t frames);
/* One image per frame, in any format. */
ptie_status ptie_film_open_image(ptie_film *film, const char *path, const char *name, const ptie_recording_info *info,
                                 const ptie_simulate_params *params);
/* image: film->images pointers to height x width floats. */
ptie_status ptie_film_append(ptie_film *film, int64_t frame, const float *const *image);
/* Completes the file if status is PTIE_OK, else leaves none and returns status. */
ptie_status ptie_film_close(ptie_film *film, ptie_status status);

#endif
