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

ptie_parcel ptie_stream_at(const ptie_stream *stream, float x, float y) {
    float width = stream->radius + stream->spread * (x > 0 ? x : 0);
    /* Folds of four standard deviations away from anything: spare the turbulence. */
    if (fabsf(y) > width * (stream->reach + 4 * stream->folding))
        return (ptie_parcel){.x = x, .across = y / width, .width = width};
    float field[PTIE_TURBULENCE_FIELDS];
    ptie_turbulence_at(&stream->turbulence, x, y, field);
    float grown = ptie_smoothstep(x / stream->onset);
    float fold = stream->folding * grown * width;
    float sway = stream->sway * grown * width;
    float wave = sway > 0 ? sway * sinf(stream->sway_wave * x - stream->sway_phase + field[3]) : 0;
    float folded = x + fold * field[0];
    float local = stream->radius + stream->spread * (folded > 0 ? folded : 0);
    return (ptie_parcel){.x = folded,
                         .across = (y + fold * field[1] - wave) / local,
                         .width = local,
                         .gust = grown * field[2]};
}
