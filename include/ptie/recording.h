/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings: frames over time, in files of many kinds.  docs/formats.md.
 *
 * Reads   Photron MRAW (with its CIH or CIHX), Phantom CINE, MATLAB v5 to v7.3, raw frames with a JSON file, NPY, PNG (grey; colour is refused), TIFF (single, multi-page, integers and float), HDF5 (any
 *         numeric 2-D or 3-D data set: "file.h5:/path/in/file"), a folder or a pattern with one %d or %0Nd
 *         ("flow_%02d.png") as numbered frames.
 * Writes  NPY, TIFF, HDF5 (NeXus), each of float32 or of 8- or 16-bit integers; PNG (8- or 16-bit integers, or
 *         16 bit with the scale in its text chunks; a pattern for several frames); MRAW with its CIHX
 *         (counts of a camera); MAT version 5; video (Y4M; MP4 where ffmpeg is installed).
 */
#ifndef PTIE_RECORDING_H
#define PTIE_RECORDING_H

#include <ptie/status.h>

typedef struct ptie_recording_info {
    int32_t width_px, height_px;
    int64_t frames;
    char format[16];     /* "PNG", "TIFF", "NPY", "HDF5", "PNG sequence", ... */
    char sample[16];     /* stored sample type: "u8", "u16", "f32", ... */
    char dataset[256];   /* path inside an HDF5 file, else "" */
    char unit[16];       /* "rad", "counts", ... or "" */
    double frame_rate_hz;/* of the frames in the file; 0 if it does not say */
    double pixel_m;      /* 0 if the file does not say */
    /* Frame t was frame first_frame + t * frame_step of the recording it was made from; 0 and 1 unless the file
       (HDF5) says so. */
    int64_t first_frame, frame_step;
    /* What cameras write beside the frames; 0 or "" if the file does not say. */
    char camera[64];     /* model, serial number */
    char date[32];       /* as the file has it: "2017/7/13 13:13" */
    char comment[128];
    char trigger[48];    /* "start", "at frame 120" */
    char warning[192];   /* what is wrong with a file that can be read all the same, such as cut short */
    double exposure_s;
    int32_t bit_depth;   /* effective: counts are 0 .. 2^bit_depth - 1 */
    double black_level, white_level; /* counts of no light and of full scale */
    int32_t roi_x_px, roi_y_px;      /* corner of the frame on the sensor; its parity is that of a mosaic */
    int64_t recorded;    /* frames that the header announces */
    int64_t skip;        /* of the frames exposed, every skip-th was kept; frame_rate_hz is that of the kept */
    bool bottom_up;      /* stored with the bottom row first (frames are handed out top row first) */
} ptie_recording_info;

/* Frames first, first + step, ... below end, as a Python slice; end 0 = all there are. */
typedef struct ptie_frame_range { int64_t first, end, step; } ptie_frame_range;

typedef struct ptie_recording ptie_recording;

/* Opens for reading; the kind is found from the content, not from the name.  Errors: PTIE_EIO (with the
   system's reason; a directory without frames), PTIE_EFORMAT, PTIE_EUNSUPPORTED, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_recording_open(ptie_recording **out, const char *path);
PTIE_API void ptie_recording_close(ptie_recording *recording); /* NULL is fine */
PTIE_API const ptie_recording_info *ptie_recording_get_info(const ptie_recording *recording);

/* info (out): what ptie_recording_open would say; and of a Photron header whose .mraw file is missing what it tells
   all the same, with frames = 0 and a warning.  Errors as for ptie_recording_open. */
PTIE_API PTIE_NODISCARD ptie_status ptie_recording_describe(ptie_recording_info *info, const char *path);

/* frame (out): height x width values as stored, converted to float.  Not thread-safe per recording.
   Errors: PTIE_EINVAL (frame number), PTIE_ESIZE (a file of a sequence unlike the first), PTIE_EIO,
   PTIE_EFORMAT, PTIE_EUNSUPPORTED, PTIE_ENOMEM, PTIE_ENUMERIC (NaN or infinity: names the pixel). */
PTIE_API PTIE_NODISCARD ptie_status ptie_recording_read(ptie_recording *recording, int64_t frame,
                                                        float *data);

typedef struct ptie_writer ptie_writer;

/* Creates a file for `info->frames` frames (0: not known yet) of one map; the kind is chosen by the ending of `path`:
   .h5 .hdf5 .tif .tiff .npy .mat .png .y4m .mp4 .mraw (docs/formats.md).  `name` is what the map is ("phase",
   "denoised"): letters, digits, '_', '-'.  info->unit, frame_rate_hz, pixel_m are stored where the format can.
   info->sample says how values are stored: "u1" to "u8" as 8-bit integers, "u9" to "u16" as 16-bit integers, anything
   else, "" too, as float32.
     .png   a sequence replaces all of an older one, or none: frames with the next numbers are removed with `overwrite`,
            and PTIE_EEXIST without
     .mraw  rounds to counts 0 .. 2^info->bit_depth - 1 (0: 12) and clips; 12 bits are packed unless info->sample is
            "u16", others take 16; "X.cihx" beside it says frame rate, exposure, corner on the sensor, camera, date, comment
     .y4m   grey, "u8" as it is, else the extent of the first frame; .mp4 the same by the program ffmpeg
   The file appears under `path` only at ptie_writer_close.  Errors: PTIE_EINVAL, PTIE_EEXIST, PTIE_EIO, PTIE_ENOMEM,
   PTIE_EUNSUPPORTED (ending; a MAT variable of 2 GiB; no ffmpeg). */
PTIE_API PTIE_NODISCARD ptie_status ptie_writer_create(ptie_writer **out, const char *path,
                                                       const char *name,
                                                       const ptie_recording_info *info,
                                                       bool overwrite);
/* Appends one frame of height x width floats.  Errors: PTIE_EINVAL (a second frame for one PNG), PTIE_ESTATE
   (more frames than announced), PTIE_EIO, PTIE_ENOMEM, PTIE_ENUMERIC (PNG, MRAW, video: NaN or infinity; integers: a value that
   is not one of the sample type), PTIE_EEXIST. */
PTIE_API PTIE_NODISCARD ptie_status ptie_writer_append(ptie_writer *writer, const float *frame);
/* Completes the file and frees the writer, also on failure (then no file is left).  Errors: PTIE_EIO,
   PTIE_ESTATE (fewer frames than announced, or none). */
PTIE_API PTIE_NODISCARD ptie_status ptie_writer_close(ptie_writer *writer);
/* Frees the writer and leaves no file.  NULL is fine. */
PTIE_API void ptie_writer_discard(ptie_writer *writer);

#endif
