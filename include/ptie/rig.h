/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigs: how a set-up is built, written down once.  Which light, which planes, where they lie on the
 * sensor, what the camera does to them, how they are solved.  A rig is an INI file; docs/formats.md
 * has its keys.
 *
 * Lengths are in m at the object, angles in rad, shifts in pixels of the recording.
 */
#ifndef PTIE_RIG_H
#define PTIE_RIG_H

#include <ptie/preprocess.h>
#include <ptie/solver.h>

/* The planes a set-up may record, by their distance from focus: I+, I-, I0, and the outer pair. */
typedef enum ptie_role {
    PTIE_PLUS,
    PTIE_MINUS,
    PTIE_ZERO,
    PTIE_PLUS2,
    PTIE_MINUS2,
    PTIE_ROLES
} ptie_role;

/* What is taken off the phase outside the flow. */
typedef enum ptie_background {
    PTIE_BACKGROUND_NONE = 0,
    PTIE_BACKGROUND_PLANE = 1,
    PTIE_BACKGROUND_ZERNIKE = 2 /* low orders */
} ptie_background;

/* ptie_rig.cutoff_m in place of a length: chosen from the recording, as PTIE_CUTOFF_NOISE and
 * PTIE_CUTOFF_L_CURVE do. */
#define PTIE_CUTOFF_AUTO (-1.0)
#define PTIE_CUTOFF_CORNER (-2.0)

typedef struct ptie_plane {
    bool used;
    double defocus_m; /* z, |z| <= 1e3 */
    char source[512]; /* SEPARATE: data set of an HDF5 recording ("/entry/data/plus"), or "" */
    double mix[PTIE_CHANNELS]; /* other layouts: plane = sum of mix[c] * channel c */
    double gain;               /* multiplies the plane, default 1 */
    /* Where the plane lies on the grid of I+: a point at r from the frame's centre there is found
       at shift + magnification * rotation(r) from the centre here.  Defaults 0, 0, 1, 0. */
    double shift_x_px, shift_y_px, magnification, rotation_rad;
} ptie_plane;

typedef struct ptie_rig {
    uint32_t struct_size; /* set by ptie_rig_init */

    double wavelength_m;          /* default 532e-9 */
    double pixel_m;               /* at the object: sensor pitch / magnification */
    ptie_plane plane[PTIE_ROLES]; /* default: I+ and I- at +-10 mm */
    bool one_plane; /* I+ alone, against its own no-flow reference, which then stands for I0 */

    ptie_layout layout;
    int32_t
        angle_deg[PTIE_CHANNELS]; /* MOSAIC: polarisers of the sensor's top left cell, row-major */
    int32_t roi_x,
        roi_y; /* MOSAIC: where the recorded region begins on the sensor; only odd or even counts */
    ptie_demosaic demosaic; /* default BILINEAR */

    /* Recordings; paths relative to the rig file, "" for none.  Their frames are averaged. */
    char reference[512]; /* no flow, as the recording in size and layout */
    char dark[512];      /* no light */
    char mask[512];      /* image of a plane's size: 0 = opaque */
    bool flat_field; /* divide each plane by its own reference, where there is one; default true */
    bool match_gain; /* scale planes to equal means over the light, default true */
    double mask_below; /* opaque where the planes' mean is below this share of its median; 0 =
                          nowhere */
    ptie_background background;
    int64_t still_first,
        still_end; /* frames without flow, end excluded: their median phase is taken off */

    /* The camera, where it is known: 0 else. */
    double saturation_counts; /* largest value the sensor gives */
    double electrons_per_count;
    double read_noise_electrons;

    ptie_boundary boundary;    /* default PTIE_MIRROR */
    ptie_solver_method method; /* default PTIE_SOLVE_DIRECT */
    int32_t max_iterations;    /* of an iterating method, default 100 */
    double cutoff_m;  /* Tikhonov cut-off period of the solver, 0 = off; or PTIE_CUTOFF_AUTO,
                         PTIE_CUTOFF_CORNER */
    int32_t binning;  /* average n x n pixels before solving, default 1 */
    bool zero_border; /* pin the mean: median of the frame's border = 0, default true */

    int32_t polarity;     /* sign of the flow's phase: +1, -1 (hot gas), 0 = judge each frame */
    ptie_rect still;      /* region without flow, pixels of the phase: its mean is 0; empty: none */
    double frame_rate_hz; /* 0: as the recording says */
} ptie_rig;

PTIE_API void ptie_rig_init(ptie_rig *rig);

/* Reads an INI file.  Errors: PTIE_EIO, PTIE_ENAME (unknown section, key or channel, with the
   nearest valid one), PTIE_EFORMAT (line, value, expected unit), PTIE_EINVAL (missing wavelength,
   pixel, defocus or plane; planes at one distance). */
PTIE_API PTIE_NODISCARD ptie_status ptie_rig_load(ptie_rig *rig, const char *path);

/* A key of a rig file and its value, as text: {"minus", "shift_x", "0.25"}. */
typedef struct ptie_rig_setting {
    const char *section, *key, *value;
} ptie_rig_setting;

/* Writes a rig file: `from` with these settings and everything else, comments too, as it was; or,
   where `from` is NULL, a new one that explains every key, for a wavelength of 532 nm, pixels of 20
   um and planes at +-10 mm unless the settings say otherwise.  `to` may be `from`.  What would not
   load is not written.  Errors: those of ptie_rig_load; PTIE_EEXIST. */
PTIE_API PTIE_NODISCARD ptie_status ptie_rig_edit(const char *to, const char *from,
                                                  const ptie_rig_setting *settings, size_t count,
                                                  bool overwrite);

/* ---- Is a rig right for a recording? ---- */

typedef enum ptie_verdict {
    PTIE_GOOD,
    PTIE_DOUBTFUL, /* the result is worse than it could be */
    PTIE_WRONG     /* the result means nothing */
} ptie_verdict;

typedef struct ptie_rig_finding {
    const char *name; /* "saturation"; static */
    ptie_verdict verdict;
    double value;   /* the number that decided, in the unit its text says; NaN if it could not be
                       measured */
    char text[240]; /* one line for people */
} ptie_rig_finding;

enum { PTIE_RIG_FINDINGS = 16 };
typedef struct ptie_rig_report {
    ptie_rig_finding finding[PTIE_RIG_FINDINGS];
    int32_t count;
} ptie_rig_report;

/* Compares a rig with a recording, of which it reads some frames: sizes, saturation, exposure,
   whether a mosaic is one (P14), the planes' means, flat field, mask, registration left over (P7),
   at which periods linear TIE still holds (P13), noise and what it will be in the phase (M8).
   recording, plane: as in ptie_run_params; plane may be NULL. target: frames of a target in the
   object's plane, without which registration is not measured; NULL: none. A finding that is wrong
   is no error.  Errors: those of reading. */
PTIE_API PTIE_NODISCARD ptie_status ptie_rig_check(const ptie_rig *rig, const char *recording,
                                                   const char *const plane[PTIE_ROLES],
                                                   const char *target, ptie_rig_report *report);

/* ---- Calibration ---- */

typedef struct ptie_plane_calibration {
    bool measured; /* false for I+, planes that are not used, and those that show nothing in common
                    */
    ptie_registration where;     /* on the grid of I+, with standard deviations */
    double gain, gain_deviation; /* that brings the plane's mean to that of I+; its standard
                                    deviation over frames */
} ptie_plane_calibration;

/* Measures where the planes lie and their gains in frames without flow, best of a target in the
   object's plane: the rig's own registration and gains are not used.  Planes are divided by the
   rig's reference, unless `recording` is it, which takes out dust on the sensor: it lies at the
   same place in every plane, wherever that is.  recording, plane: as in ptie_rig_check.  Errors:
   those of reading; PTIE_EINVAL (a rig of one plane). */
PTIE_API PTIE_NODISCARD ptie_status
ptie_rig_calibrate(ptie_plane_calibration calibration[PTIE_ROLES], const ptie_rig *rig,
                   const char *recording, const char *const plane[PTIE_ROLES]);

#endif
