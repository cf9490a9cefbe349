/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/pack.h"

#include <libdeflate.h>

#include "base/memory.h"

struct ptie_packer {
    struct libdeflate_compressor *compressor;
    size_t samples, sample_bytes, bound;
    unsigned char *shuffled;
};

ptie_status ptie_packer_create(ptie_packer **out, size_t samples, size_t sample_bytes) {
    ptie_packer *packer;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&packer, 1, sizeof *packer, "compression"));
    packer->samples = samples;
    packer->sample_bytes = sample_bytes;
    ptie_status status = ptie_alloc_status(&packer->shuffled, samples, sample_bytes, "compression");
    packer->compressor = libdeflate_alloc_compressor(PTIE_PACK_LEVEL);
    if (status == PTIE_OK && !packer->compressor)
        status = PTIE_FAIL(PTIE_ENOMEM, "compression: out of memory");
    if (status != PTIE_OK) {
        ptie_packer_free(packer);
        return status;
    }
    packer->bound = libdeflate_zlib_compress_bound(packer->compressor, samples * sample_bytes);
    *out = packer;
    return PTIE_OK;
}

void ptie_packer_free(ptie_packer *packer) {
    if (!packer) return;
    if (packer->compressor) libdeflate_free_compressor(packer->compressor);
    ptie_free(packer->shuffled);
    ptie_free(packer);
}

size_t ptie_packer_bound(const ptie_packer *packer) {
    return packer->bound;
}

/* All first bytes, then all second bytes, ...: those of an exponent are alike and compress. */
static void shuffle(const ptie_packer *packer, const unsigned char *frame) {
    for (size_t b = 0; b < packer->sample_bytes; b++) {
        unsigned char *plane = packer->shuffled + b * packer->samples;
        for (size_t i = 0; i < packer->samples; i++) plane[i] = frame[i * packer->sample_bytes + b];
    }
}

size_t ptie_pack(ptie_packer *packer, unsigned char *packed, const unsigned char *frame) {
    shuffle(packer, frame);
    return libdeflate_zlib_compress(packer->compressor, packer->shuffled,
                                    packer->samples * packer->sample_bytes, packed, packer->bound);
}
