/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/h5_driver.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include "base/memory.h"

/* What travels in the access list. */
typedef struct settings {
    int *failure;
} settings;

typedef struct driver_file {
    H5FD_t base; /* first: HDF5 sees only this */
    int descriptor;
    haddr_t allocated; /* end of the address space */
    haddr_t end;       /* of what is in the file */
    int *failure;
} driver_file;

static driver_file *of(H5FD_t *base) {
    return (driver_file *)base;
}

static const driver_file *of_const(const H5FD_t *base) {
    return (const driver_file *)base;
}

static H5FD_t *driver_open(const char *path, unsigned flags, hid_t access, haddr_t largest) {
    (void)largest;
    const settings *info = H5Pget_driver_info(access);
    int create = (flags & H5F_ACC_CREAT ? O_CREAT : 0) | (flags & H5F_ACC_TRUNC ? O_TRUNC : 0);
    if (!info) return NULL;
    driver_file *file = ptie_alloc(1, sizeof *file);
    if (!file) {
        *info->failure = ENOMEM;
        return NULL;
    }
    file->failure = info->failure;
    file->descriptor = open(path, O_RDWR | O_CLOEXEC | create, 0666);
    if (file->descriptor < 0) {
        *file->failure = errno;
        ptie_free(file);
        return NULL;
    }
    off_t end = lseek(file->descriptor, 0, SEEK_END);
    file->end = end > 0 ? (haddr_t)end : 0;
    return &file->base;
}

static void remember(const driver_file *file) {
    if (*file->failure == 0) *file->failure = errno;
}

static herr_t driver_close(H5FD_t *base) {
    driver_file *file = of(base);
    if (close(file->descriptor) != 0) remember(file);
    ptie_free(file);
    return 0;
}

static herr_t driver_query(const H5FD_t *base, unsigned long *flags) {
    (void)base;
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

static haddr_t driver_get_eoa(const H5FD_t *base, H5FD_mem_t type) {
    (void)type;
    return of_const(base)->allocated;
}

static herr_t driver_set_eoa(H5FD_t *base, H5FD_mem_t type, haddr_t address) {
    (void)type;
    of(base)->allocated = address;
    return 0;
}

static haddr_t driver_get_eof(const H5FD_t *base, H5FD_mem_t type) {
    (void)type;
    return of_const(base)->end;
}

/* What lies behind the end of the file reads as zero. */
static herr_t driver_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                          size_t size, void *buffer) {
    (void)type, (void)transfer;
    unsigned char *next = buffer;
    while (size > 0) {
        ssize_t now = pread(of(base)->descriptor, next, size, (off_t)address);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) return -1;
        if (now == 0) break;
        next += now;
        address += (haddr_t)now;
        size -= (size_t)now;
    }
    memset(next, 0, size);
    return 0;
}

static herr_t driver_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                           size_t size, const void *buffer) {
    (void)type, (void)transfer;
    driver_file *file = of(base);
    const unsigned char *next = buffer;
    while (size > 0 && *file->failure == 0) {
        ssize_t now = pwrite(file->descriptor, next, size, (off_t)address);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) {
            remember(file);
            break;
        }
        next += now;
        address += (haddr_t)now;
        size -= (size_t)now;
    }
    if (address + size > file->end) file->end = address + size;
    return 0;
}

static herr_t driver_truncate(H5FD_t *base, hid_t transfer, hbool_t closing) {
    (void)transfer, (void)closing;
    driver_file *file = of(base);
    if (file->end == file->allocated) return 0;
    if (*file->failure == 0 && ftruncate(file->descriptor, (off_t)file->allocated) != 0)
        remember(file);
    file->end = file->allocated;
    return 0;
}

static const H5FD_class_t driver_class = {
#if H5_VERSION_GE(1, 13, 0)
    .version = H5FD_CLASS_VERSION,
    .value = 512, /* first of the range for private use */
#endif
    .name = "ptie",
    .maxaddr = INT64_MAX,
    .fc_degree = H5F_CLOSE_STRONG,
    .fapl_size = sizeof(settings),
    .open = driver_open,
    .close = driver_close,
    .query = driver_query,
    .get_eoa = driver_get_eoa,
    .set_eoa = driver_set_eoa,
    .get_eof = driver_get_eof,
    .read = driver_read,
    .write = driver_write,
    .truncate = driver_truncate,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

herr_t ptie_h5_use_driver(hid_t access, int *failure) {
    /* Registered once and never given back: HDF5 1.10 calls through the class after the file that
       held its last reference is closed.  Under the lock of h5.c, like every HDF5 call. */
    static hid_t driver = H5I_INVALID_HID;
    if (H5Iget_type(driver) != H5I_VFL) driver = H5FDregister(&driver_class);
    return driver < 0 ? -1 : H5Pset_driver(access, driver, &(settings){failure});
}
