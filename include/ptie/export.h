/* SPDX-License-Identifier: BSD-3-Clause */
/* What every public header needs: C linkage, visibility, "look at the result". */
#ifndef PTIE_EXPORT_H
#define PTIE_EXPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define PTIE_EXTERN extern "C"
#else
#define PTIE_EXTERN extern
#endif

#if defined(__GNUC__)
#define PTIE_API PTIE_EXTERN __attribute__((visibility("default")))
#define PTIE_NODISCARD __attribute__((warn_unused_result))
#define PTIE_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define PTIE_API PTIE_EXTERN
#define PTIE_NODISCARD
#define PTIE_PRINTF(text, first)
#endif

#endif
