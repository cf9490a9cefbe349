/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/stream.h"

#include <math.h>

#define TWO_PI 6.28318530717958647693

ptie_status ptie_stream_draw(ptie_stream *stream, const ptie_scene *scene, ptie_random *random,
                             const ptie_stream_ranges *ranges, double length) {
    *stream = (ptie_stream){.reach = 6};
    stream->radius = ptie_draw_log(random, ranges->radius_low, ranges->radius_high);
    stream->spread = ptie_draw(random, ranges->spread_low, ranges->spread_high);
    stream->folding = ptie_draw(random, ranges->folding_low, ranges->folding_high);
    stream->onset = stream->radius * ptie_draw(random, 2, 12);
    stream->sway = ptie_chance(random, 0.5) ? ptie_draw(random, 0.05, 0.35) : 0;
    stream->sway_wave = ptie_draw(random, 0.2, 0.9) / stream->radius;
    stream->speed = ptie_speed_draw(scene, random);
    double sway_start = ptie_random_uniform(random, 0, TWO_PI);
    double turns = (double)stream->sway_wave * stream->speed * scene->time_s;
    stream->sway_phase = (float)fmod(sway_start + turns, TWO_PI);
    double width = (double)(stream->radius + stream->spread * 0.4f * (float)length);
    double outer = width * ptie_random_log_uniform(random, 2.5, 8);
    double inner = ptie_random_uniform(random, 0.04, 0.2);
    ptie_turbulence_params params =
        ptie_turbulence_draw(scene, random, outer, inner, stream->speed);
    return ptie_turbulence_create(&stream->turbulence, &params);
}

void ptie_stream_free(ptie_stream *stream) {
    ptie_turbulence_free(&stream->turbulence);
}

PTIE_CLONES void ptie_stream_line(const ptie_stream *stream, ptie_parcels *parcels, const float *x,
                                  const float *y) {
    const ptie_stream s = *stream; /* what is stored below cannot be a part of it */
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS] = {0};
    float width[PTIE_LINE], grown[PTIE_LINE];
    int seen = 0;
    for (int i = 0; i < PTIE_LINE; i++) {
        width[i] = s.radius + s.spread * ptie_maxf(x[i], 0);
        /* Folds of four standard deviations away from anything: there the turbulence is spared. */
        seen |= fabsf(y[i]) <= width[i] * (s.reach + 4 * s.folding);
    }
    if (seen) ptie_turbulence_line(&s.turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++) grown[i] = ptie_smoothstep(x[i] / s.onset) * width[i];
    for (int i = 0; i < PTIE_LINE; i++) {
        float wave = ptie_sinf(s.sway_wave * x[i] - s.sway_phase + field[i][3]);
        float folded = x[i] + s.folding * grown[i] * field[i][0];
        float local = s.radius + s.spread * ptie_maxf(folded, 0);
        parcels->x[i] = folded;
        parcels->across[i] =
            (y[i] + grown[i] * (s.folding * field[i][1] - s.sway * wave)) / local;
        parcels->width[i] = local;
        parcels->gust[i] = grown[i] / width[i] * field[i][2];
    }
}
