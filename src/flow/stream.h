/* SPDX-License-Identifier: BSD-3-Clause */
/* A stream of gas from a source: it widens, meanders, and its boundary is folded by turbulence that
   it carries downstream.  Plumes of every kind are profiles over the coordinates it gives.
   docs/math.md (F5). */
#ifndef PTIE_FLOW_STREAM_H
#define PTIE_FLOW_STREAM_H

#include "flow/turbulence.h"

typedef struct ptie_stream {
    ptie_turbulence turbulence;
    float radius, spread;              /* half-width at the source, its growth per unit */
    float onset;                       /* distance over which the turbulence sets in */
    float folding;                     /* displacement by the turbulence, in half-widths */
    float sway, sway_wave, sway_phase; /* meandering: amplitude in half-widths, rad per unit, rad */
    float reach;  /* half-widths beyond which there is nothing to see; 6 unless set */
    double speed; /* units per second */
} ptie_stream;

/* Ranges a stream is drawn from; all in units but `folding`. */
typedef struct ptie_stream_ranges {
    double radius_low, radius_high, spread_low, spread_high, folding_low, folding_high;
} ptie_stream_ranges;

/* `length`: how far downstream it is seen. */
ptie_status ptie_stream_draw(ptie_stream *stream, const ptie_scene *scene, ptie_random *random,
                             const ptie_stream_ranges *ranges, double length);
void ptie_stream_free(ptie_stream *stream);

/* Where a point lies in the stream. */
typedef struct ptie_parcel {
    float x;      /* downstream, folded */
    float across; /* from the folded centre line, in half-widths; either sign */
    float width;  /* local half-width, units */
    float gust;   /* fluctuation of what it carries: zero mean, at most about 2 */
} ptie_parcel;

/* The same of a line of points. */
typedef struct ptie_parcels {
    float x[PTIE_LINE], across[PTIE_LINE], width[PTIE_LINE], gust[PTIE_LINE];
} ptie_parcels;
void ptie_stream_line(const ptie_stream *stream, ptie_parcels *parcels, const float *x,
                      const float *y);

PTIE_INLINE ptie_parcel ptie_parcel_of(const ptie_parcels *parcels, int i) {
    return (ptie_parcel){parcels->x[i], parcels->across[i], parcels->width[i], parcels->gust[i]};
}

#endif
