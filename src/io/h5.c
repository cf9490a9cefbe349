/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 behind one lock, with its error printing off and its error stack turned into one line. */
#include "io/h5.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "io/endian.h"
#include "io/h5_driver.h"
#include "io/input.h"
#include "io/pack.h"

#define REASON_BYTES 160
/* Chunks that are kept decoded: a prime number far above their count, and memory used only as
 * needed. */
#define CACHE_SLOTS 12421
#define CACHE_BYTES ((size_t)64 << 20)

struct ptie_h5 {
    hid_t file;
    char *path;              /* what messages call it */
    ptie_output_file output; /* open while the file is being written */
    hid_t last; /* data set read last: stays open, so that its decoded chunks serve the next rows */
    char *last_path;
    int failure; /* errno of the first write that failed, kept by the driver */
};

static pthread_mutex_t hdf5_mutex = PTHREAD_MUTEX_INITIALIZER;

/* The caller's error printing, put back when the lock is released. */
typedef struct printing {
    H5E_auto2_t function;
    void *data;
} printing;

static printing enter(void) {
    printing saved = {0};
    pthread_mutex_lock(&hdf5_mutex);
    H5Eget_auto2(H5E_DEFAULT, &saved.function, &saved.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return saved;
}

static void leave(printing *saved) {
    H5Eset_auto2(H5E_DEFAULT, saved->function, saved->data);
    pthread_mutex_unlock(&hdf5_mutex);
}

static void close_id(hid_t *id) {
    if (*id >= 0) H5Idec_ref(*id);
}

/* Both undo themselves at the end of the block: the lock last, because it is declared first. */
#define LOCK_HDF5 printing lock_ __attribute__((cleanup(leave), unused)) = enter()
#define SCOPED_ID __attribute__((cleanup(close_id))) hid_t

/* Takes the deepest entry: the reason itself, not its consequences. */
static herr_t take_reason(unsigned depth, const H5E_error2_t *entry, void *data) {
    (void)depth;
    snprintf(data, REASON_BYTES, "%s", entry->desc);
    return 1; /* enough */
}

/* Must come right after the call that failed: the next one clears the stack. */
static ptie_status h5_failure(const ptie_h5 *h5, ptie_status status, const char *what,
                              const char *object) {
    char reason[REASON_BYTES] = "no reason given";
    if (h5->failure == ENOMEM) status = PTIE_ENOMEM;
    if (h5->failure)
        snprintf(reason, sizeof reason, "%s", strerror(h5->failure));
    else
        H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, reason);
    return PTIE_FAIL(status, "%s: cannot %s %s: %s", h5->path, what, object, reason);
}

/* The result of a call that writes. */
static ptie_status written(const ptie_h5 *h5, bool done, const char *what, const char *object) {
    return done && h5->failure == 0 ? PTIE_OK : h5_failure(h5, PTIE_EIO, what, object);
}

static hid_t line_type(void) {
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, PTIE_H5_LINE_BYTES);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

/* Both to be closed. */
static hid_t memory_type(ptie_h5_type type) {
    switch (type) {
    case PTIE_H5_F32: return H5Tcopy(H5T_NATIVE_FLOAT);
    case PTIE_H5_F64: return H5Tcopy(H5T_NATIVE_DOUBLE);
    case PTIE_H5_U8: return H5Tcopy(H5T_NATIVE_UINT8);
    case PTIE_H5_U16: return H5Tcopy(H5T_NATIVE_UINT16);
    case PTIE_H5_U32: return H5Tcopy(H5T_NATIVE_UINT32);
    case PTIE_H5_U64: return H5Tcopy(H5T_NATIVE_UINT64);
    case PTIE_H5_LINE: return line_type();
    }
    return H5I_INVALID_HID;
}

static hid_t stored_type(ptie_h5_type type) {
    switch (type) {
    case PTIE_H5_F32: return H5Tcopy(H5T_IEEE_F32LE);
    case PTIE_H5_F64: return H5Tcopy(H5T_IEEE_F64LE);
    case PTIE_H5_U8: return H5Tcopy(H5T_STD_U8LE);
    case PTIE_H5_U16: return H5Tcopy(H5T_STD_U16LE);
    case PTIE_H5_U32: return H5Tcopy(H5T_STD_U32LE);
    case PTIE_H5_U64: return H5Tcopy(H5T_STD_U64LE);
    case PTIE_H5_LINE: return line_type();
    }
    return H5I_INVALID_HID;
}

/* --- files ---------------------------------------------------------------------------------------
 */

static void h5_free(ptie_h5 *h5) {
    ptie_free(h5->last_path);
    ptie_free(h5->path);
    ptie_free(h5);
}

static ptie_status h5_new(ptie_h5 **out, const char *path) {
    *out = NULL;
    ptie_h5 *h5;
    PTIE_TRY(ptie_alloc_status(&h5, 1, sizeof *h5, path));
    h5->file = h5->last = H5I_INVALID_HID;
    h5->path = ptie_strdup(path);
    if (!h5->path) {
        h5_free(h5);
        return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    }
    *out = h5;
    return PTIE_OK;
}

static ptie_status create_file(ptie_h5 *h5) {
    LOCK_HDF5;
    SCOPED_ID creation = H5Pcreate(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_obj_track_times(creation, false); /* the root group */
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    if (ptie_h5_use_driver(access, &h5->failure) >= 0)
        h5->file = H5Fcreate(h5->output.part, H5F_ACC_TRUNC, creation, access);
    return written(h5, h5->file >= 0, "create", "the file");
}

ptie_status ptie_h5_create(ptie_h5 **out, const char *path, bool overwrite) {
    ptie_h5 *h5;
    *out = NULL;
    PTIE_TRY(h5_new(&h5, path));
    ptie_status status = ptie_output_open(&h5->output, path, overwrite);
    if (status == PTIE_OK) status = create_file(h5);
    if (status != PTIE_OK) {
        ptie_h5_discard(h5);
        return status;
    }
    *out = h5;
    return PTIE_OK;
}

static ptie_status open_file(ptie_h5 *h5) {
    LOCK_HDF5;
    SCOPED_ID access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_file_locking(access, false, true); /* network file systems refuse locks */
    h5->file = H5Fopen(h5->path, H5F_ACC_RDONLY, access);
    return h5->file >= 0 ? PTIE_OK : h5_failure(h5, PTIE_EFORMAT, "open as", "HDF5");
}

ptie_status ptie_h5_open(ptie_h5 **out, const char *path) {
    ptie_h5 *h5;
    *out = NULL;
    PTIE_TRY(ptie_input_check(path, NULL)); /* the system's reason for a missing file */
    PTIE_TRY(h5_new(&h5, path));
    ptie_status status = open_file(h5);
    if (status != PTIE_OK) {
        ptie_h5_discard(h5);
        return status;
    }
    *out = h5;
    return PTIE_OK;
}

/* Closes the HDF5 side: after this nothing more is written. */
static ptie_status close_file(ptie_h5 *h5) {
    LOCK_HDF5;
    close_id(&h5->last);
    return h5->file < 0 ? PTIE_OK : written(h5, H5Fclose(h5->file) >= 0, "write", "the file");
}

ptie_status ptie_h5_close(ptie_h5 *h5) {
    if (!h5) return PTIE_OK;
    ptie_status status = close_file(h5);
    if (status == PTIE_OK && h5->output.part) status = ptie_output_commit(&h5->output);
    ptie_output_discard(&h5->output);
    h5_free(h5);
    return status;
}

void ptie_h5_discard(ptie_h5 *h5) {
    if (!h5) return;
    ptie_status ignored = close_file(h5);
    (void)ignored; /* nothing of it is kept */
    ptie_output_discard(&h5->output);
    h5_free(h5);
}

/* --- data sets -----------------------------------------------------------------------------------
 */

/* How rows are stored.  Filters of every HDF5: nobody needs a plugin to read them. */
typedef struct storage {
    uint64_t chunk_rows; /* 0: contiguous */
    bool packed;         /* bytes shuffled, then deflated */
} storage;

static ptie_status create_set(ptie_h5 *h5, const char *path, ptie_h5_type type, int32_t rank,
                              const uint64_t *dims, storage how) {
    const uint64_t chunk_rows = how.chunk_rows;
    assert(rank >= 1 && rank <= 4 && (dims[0] > 0 || chunk_rows > 0));
    hsize_t size[4], largest[4], chunk[4];
    for (int32_t d = 0; d < rank; d++) chunk[d] = size[d] = largest[d] = dims[d];
    chunk[0] = chunk_rows;
    if (dims[0] == 0) largest[0] = H5S_UNLIMITED;
    LOCK_HDF5;
    SCOPED_ID space = H5Screate_simple(rank, size, largest);
    SCOPED_ID links = H5Pcreate(H5P_LINK_CREATE);
    SCOPED_ID creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    H5Pset_obj_track_times(creation, false);
    if (chunk_rows > 0) {
        H5Pset_chunk(creation, rank, chunk);
    } else {
        H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
        H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    }
    if (how.packed) H5Pset_shuffle(creation), H5Pset_deflate(creation, PTIE_PACK_LEVEL);
    SCOPED_ID stored = stored_type(type);
    SCOPED_ID set = H5Dcreate2(h5->file, path, stored, space, links, creation, H5P_DEFAULT);
    return written(h5, set >= 0, "create", path);
}

ptie_status ptie_h5_dataset(ptie_h5 *h5, const char *path, ptie_h5_type type, int32_t rank,
                            const uint64_t *dims, uint64_t chunk_rows) {
    return create_set(h5, path, type, rank, dims, (storage){.chunk_rows = chunk_rows});
}

ptie_status ptie_h5_dataset_packed(ptie_h5 *h5, const char *path, ptie_h5_type type, int32_t rank,
                                   const uint64_t *dims) {
    return create_set(h5, path, type, rank, dims, (storage){.chunk_rows = 1, .packed = true});
}

static ptie_status open_set(const ptie_h5 *h5, const char *path, hid_t *set) {
    *set = H5Dopen2(h5->file, path, H5P_DEFAULT);
    return *set >= 0 ? PTIE_OK : h5_failure(h5, PTIE_EFORMAT, "open data set", path);
}

/* Shape of an open data set. */
static ptie_status set_shape(const ptie_h5 *h5, const char *path, hid_t set, int32_t *rank,
                             hsize_t dims[4]) {
    SCOPED_ID space = H5Dget_space(set);
    *rank = H5Sget_simple_extent_ndims(space);
    if (*rank < 1 || *rank > 4)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: %s has %d dimensions (expected 1 to 4)", h5->path,
                         path, *rank);
    H5Sget_simple_extent_dims(space, dims, NULL);
    return PTIE_OK;
}

ptie_status ptie_h5_shape(ptie_h5 *h5, const char *path, int32_t *rank, uint64_t dims[4]) {
    LOCK_HDF5;
    hsize_t size[4] = {0};
    SCOPED_ID set = H5I_INVALID_HID;
    PTIE_TRY(open_set(h5, path, &set));
    PTIE_TRY(set_shape(h5, path, set, rank, size));
    for (int32_t d = 0; d < 4; d++) dims[d] = size[d];
    return PTIE_OK;
}

bool ptie_h5_exists(ptie_h5 *h5, const char *path) {
    LOCK_HDF5;
    return H5Oexists_by_name(h5->file, path, H5P_DEFAULT) > 0;
}

ptie_status ptie_h5_sample(ptie_h5 *h5, const char *path, char name[16]) {
    LOCK_HDF5;
    SCOPED_ID set = H5I_INVALID_HID;
    PTIE_TRY(open_set(h5, path, &set));
    SCOPED_ID type = H5Dget_type(set);
    H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: %s does not hold numbers", h5->path, path);
    char letter = kind == H5T_FLOAT ? 'f' : H5Tget_sign(type) == H5T_SGN_NONE ? 'u' : 'i';
    snprintf(name, 16, "%c%zu", letter, 8 * H5Tget_size(type));
    return PTIE_OK;
}

static herr_t list_link(hid_t root, const char *path, const H5L_info_t *link, void *lines) {
    if (link->type != H5L_TYPE_HARD) return 0; /* soft links name what is listed anyway */
    SCOPED_ID object = H5Oopen(root, path, H5P_DEFAULT);
    if (object >= 0 && H5Iget_type(object) == H5I_DATASET) ptie_text_append(lines, "/%s\n", path);
    return 0;
}

ptie_status ptie_h5_list(ptie_h5 *h5, ptie_text *lines) {
    LOCK_HDF5;
    if (H5Lvisit(h5->file, H5_INDEX_NAME, H5_ITER_INC, list_link, lines) < 0)
        return h5_failure(h5, PTIE_EFORMAT, "list", "the data sets");
    return lines->failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", h5->path) : PTIE_OK;
}

typedef struct rows {
    uint64_t first, count;
} rows;

/* Selects rows in the file and makes the matching memory space. */
static ptie_status select_rows(const ptie_h5 *h5, const char *path, hid_t set, rows which,
                               hid_t *file_space, hid_t *memory_space) {
    int32_t rank;
    hsize_t count[4], start[4] = {which.first};
    PTIE_TRY(set_shape(h5, path, set, &rank, count));
    if (which.first > count[0] || which.count > count[0] - which.first)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s has too few rows (expected %llu, found %llu)",
                         h5->path, path, (unsigned long long)(which.first + which.count),
                         (unsigned long long)count[0]);
    count[0] = which.count;
    *file_space = H5Dget_space(set);
    *memory_space = H5Screate_simple(rank, count, NULL);
    H5Sselect_hyperslab(*file_space, H5S_SELECT_SET, start, NULL, count, NULL);
    return PTIE_OK;
}

/* Makes an unlimited data set long enough; does nothing to others. */
static ptie_status grow(ptie_h5 *h5, const char *path, hid_t set, uint64_t needed) {
    int32_t rank;
    hsize_t dims[4], largest[4];
    PTIE_TRY(set_shape(h5, path, set, &rank, dims));
    SCOPED_ID space = H5Dget_space(set);
    H5Sget_simple_extent_dims(space, NULL, largest);
    if (needed <= dims[0] || largest[0] != H5S_UNLIMITED) return PTIE_OK;
    dims[0] = needed;
    return written(h5, H5Dset_extent(set, dims) >= 0, "extend", path);
}

ptie_status ptie_h5_write(ptie_h5 *h5, const char *path, ptie_h5_type type, uint64_t first,
                          uint64_t count, const void *data) {
    LOCK_HDF5;
    SCOPED_ID set = H5I_INVALID_HID, file_space = H5I_INVALID_HID, memory_space = H5I_INVALID_HID;
    PTIE_TRY(open_set(h5, path, &set));
    PTIE_TRY(grow(h5, path, set, first + count));
    PTIE_TRY(select_rows(h5, path, set, (rows){first, count}, &file_space, &memory_space));
    SCOPED_ID memory = memory_type(type);
    herr_t result = H5Dwrite(set, memory, memory_space, file_space, H5P_DEFAULT, data);
    return written(h5, result >= 0, "write", path);
}

ptie_status ptie_h5_write_chunk(ptie_h5 *h5, const char *path, uint64_t row, const void *chunk,
                                size_t bytes) {
    LOCK_HDF5;
    int32_t rank;
    hsize_t dims[4], first[4] = {row};
    SCOPED_ID set = H5I_INVALID_HID;
    PTIE_TRY(open_set(h5, path, &set));
    PTIE_TRY(grow(h5, path, set, row + 1));
    PTIE_TRY(set_shape(h5, path, set, &rank, dims));
    if (row >= dims[0])
        return PTIE_FAIL(PTIE_EINVAL, "%s: %s has no row %llu (expected 0..%llu)", h5->path, path,
                         (unsigned long long)row, (unsigned long long)dims[0] - 1);
    return written(h5, H5Dwrite_chunk(set, H5P_DEFAULT, 0, first, bytes, chunk) >= 0, "write", path);
}

/* Opens a data set to read rows from, with room for the chunks that several rows share. */
static ptie_status open_last(ptie_h5 *h5, const char *path) {
    if (h5->last_path && strcmp(h5->last_path, path) == 0) return PTIE_OK;
    char *copy = ptie_strdup(path);
    if (!copy) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", h5->path);
    close_id(&h5->last);
    ptie_free(h5->last_path);
    h5->last_path = copy;
    SCOPED_ID access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, CACHE_SLOTS, CACHE_BYTES, H5D_CHUNK_CACHE_W0_DEFAULT);
    h5->last = H5Dopen2(h5->file, path, access);
    if (h5->last >= 0) return PTIE_OK;
    ptie_status status = h5_failure(h5, PTIE_EFORMAT, "open data set", path);
    ptie_free(h5->last_path);
    h5->last_path = NULL;
    return status;
}

/* Bytes of a row that is a chunk of its own and stored as it is wanted; 0 if it is not. */
static size_t plain_chunk(hid_t set, hid_t wanted) {
    int32_t rank;
    hsize_t dims[4], chunk[4];
    SCOPED_ID creation = H5Dget_create_plist(set), space = H5Dget_space(set), stored = H5Dget_type(set);
    if (H5Pget_layout(creation) != H5D_CHUNKED || H5Pget_nfilters(creation) != 0 || H5Tequal(stored, wanted) <= 0)
        return 0;
    rank = H5Sget_simple_extent_dims(space, dims, NULL);
    if (H5Pget_chunk(creation, rank, chunk) != rank || chunk[0] != 1) return 0;
    size_t bytes = H5Tget_size(stored);
    for (int32_t d = 1; d < rank; d++) {
        if (chunk[d] != dims[d]) return 0;
        bytes *= dims[d];
    }
    return bytes;
}

/* Reads such a row past HDF5's cache, which would copy it; false: it has to be read in the usual way. */
static bool read_chunk(hid_t set, hid_t wanted, uint64_t row, void *data) {
    const hsize_t start[4] = {row};
    hsize_t there = 0;
    uint32_t filters = 0;
    const size_t bytes = plain_chunk(set, wanted);
    if (bytes == 0 || H5Dget_chunk_storage_size(set, start, &there) < 0 || there != bytes) return false;
    return H5Dread_chunk(set, H5P_DEFAULT, start, &filters, data) >= 0;
}

ptie_status ptie_h5_read(ptie_h5 *h5, const char *path, ptie_h5_type type, uint64_t first,
                         uint64_t count, void *data) {
    LOCK_HDF5;
    SCOPED_ID file_space = H5I_INVALID_HID, memory_space = H5I_INVALID_HID;
    PTIE_TRY(open_last(h5, path));
    PTIE_TRY(select_rows(h5, path, h5->last, (rows){first, count}, &file_space, &memory_space));
    SCOPED_ID memory = memory_type(type);
    if (count == 1 && read_chunk(h5->last, memory, first, data)) return PTIE_OK;
    if (H5Dread(h5->last, memory, memory_space, file_space, H5P_DEFAULT, data) < 0)
        return h5_failure(h5, PTIE_EFORMAT, "read", path);
    return PTIE_OK;
}

ptie_status ptie_h5_place(ptie_h5 *h5, const char *path, ptie_place *place) {
    LOCK_HDF5;
    int32_t rank;
    hsize_t dims[4];
    SCOPED_ID set = H5I_INVALID_HID;
    PTIE_TRY(open_set(h5, path, &set));
    PTIE_TRY(set_shape(h5, path, set, &rank, dims));
    SCOPED_ID type = H5Dget_type(set);
    const haddr_t offset = H5Dget_offset(set);
    if (offset == HADDR_UNDEF || !ptie_machine_is_little())
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: %s is not in one piece that this machine can write",
                         h5->path, path);
    *place = (ptie_place){.offset = offset, .rows = dims[0], .row_bytes = H5Tget_size(type)};
    for (int32_t d = 1; d < rank; d++) place->row_bytes *= dims[d];
    return PTIE_OK;
}

ptie_status ptie_h5_detach(ptie_h5 *h5, ptie_output_file *file) {
    ptie_status status = close_file(h5);
    if (status == PTIE_OK) {
        *file = h5->output;
        h5->output = (ptie_output_file){0};
    }
    ptie_output_discard(&h5->output);
    h5_free(h5);
    return status;
}

/* --- attributes ----------------------------------------------------------------------------------
 */

/* Opens the object, made as a group if it is not there. */
static ptie_status open_object(ptie_h5 *h5, const char *object, hid_t *id) {
    *id = H5Oopen(h5->file, object, H5P_DEFAULT);
    if (*id >= 0) return PTIE_OK;
    SCOPED_ID links = H5Pcreate(H5P_LINK_CREATE), creation = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    H5Pset_obj_track_times(creation, false);
    *id = H5Gcreate2(h5->file, object, links, creation, H5P_DEFAULT);
    return written(h5, *id >= 0, "create group", object);
}

/* Sets or replaces one attribute. */
static ptie_status write_attribute(ptie_h5 *h5, const char *object, const char *name, hid_t stored,
                                   hid_t memory, hid_t space, const void *value) {
    SCOPED_ID owner = H5I_INVALID_HID;
    PTIE_TRY(open_object(h5, object, &owner));
    if (H5Aexists(owner, name) > 0) H5Adelete(owner, name);
    SCOPED_ID attribute = H5Acreate2(owner, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, memory, value) >= 0;
    return written(h5, done, "write attribute", name);
}

/* Variable length, UTF-8: what h5py hands out as str (a fixed length would become bytes). */
static hid_t text_type(void) {
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

ptie_status ptie_h5_set_text(ptie_h5 *h5, const char *object, const char *name, const char *value) {
    LOCK_HDF5;
    SCOPED_ID type = text_type();
    SCOPED_ID space = H5Screate(H5S_SCALAR);
    return write_attribute(h5, object, name, type, type, space, &value);
}

ptie_status ptie_h5_set_texts(ptie_h5 *h5, const char *object, const char *name,
                              const char *const *values, size_t count) {
    LOCK_HDF5;
    SCOPED_ID type = text_type();
    SCOPED_ID space = H5Screate_simple(1, (hsize_t[]){count}, NULL);
    return write_attribute(h5, object, name, type, type, space, values);
}

ptie_status ptie_h5_set_number(ptie_h5 *h5, const char *object, const char *name, double value) {
    LOCK_HDF5;
    SCOPED_ID space = H5Screate(H5S_SCALAR);
    return write_attribute(h5, object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, &value);
}

ptie_status ptie_h5_set_numbers(ptie_h5 *h5, const char *object, const char *name,
                                const double *values, size_t count) {
    LOCK_HDF5;
    SCOPED_ID space = H5Screate_simple(1, (hsize_t[]){count}, NULL);
    return write_attribute(h5, object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, values);
}

ptie_status ptie_h5_set_integer(ptie_h5 *h5, const char *object, const char *name, int64_t value) {
    LOCK_HDF5;
    SCOPED_ID space = H5Screate(H5S_SCALAR);
    return write_attribute(h5, object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, space, &value);
}

/* Opens an attribute that holds one value. */
static ptie_status open_single(const ptie_h5 *h5, const char *object, const char *name,
                               hid_t *attribute, hid_t *type) {
    *attribute = H5Aopen_by_name(h5->file, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (*attribute < 0)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s has no attribute '%s'", h5->path, object, name);
    *type = H5Aget_type(*attribute);
    SCOPED_ID space = H5Aget_space(*attribute);
    hssize_t found = H5Sget_simple_extent_npoints(space);
    if (found != 1)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: attribute '%s' of %s is a list (expected one value, found %lld)",
                         h5->path, name, object, (long long)found);
    return PTIE_OK;
}

static ptie_status read_single(ptie_h5 *h5, const char *object, const char *name, hid_t memory,
                               void *value) {
    LOCK_HDF5;
    SCOPED_ID attribute = H5I_INVALID_HID, type = H5I_INVALID_HID;
    PTIE_TRY(open_single(h5, object, name, &attribute, &type));
    H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: attribute '%s' of %s is not a number", h5->path, name,
                         object);
    return H5Aread(attribute, memory, value) >= 0
               ? PTIE_OK
               : h5_failure(h5, PTIE_EFORMAT, "read attribute", name);
}

ptie_status ptie_h5_get_number(ptie_h5 *h5, const char *object, const char *name, double *value) {
    return read_single(h5, object, name, H5T_NATIVE_DOUBLE, value);
}

ptie_status ptie_h5_get_integer(ptie_h5 *h5, const char *object, const char *name, int64_t *value) {
    return read_single(h5, object, name, H5T_NATIVE_INT64, value);
}

/* A string that HDF5 allocates (the kind h5py writes). */
static ptie_status read_variable_text(const ptie_h5 *h5, const char *name, hid_t attribute,
                                      hid_t type, char **value) {
    char *text = NULL;
    if (H5Aread(attribute, type, &text) < 0)
        return h5_failure(h5, PTIE_EFORMAT, "read attribute", name);
    *value = ptie_strdup(text ? text : "");
    H5free_memory(text);
    return *value ? PTIE_OK : PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", h5->path);
}

static ptie_status read_fixed_text(const ptie_h5 *h5, const char *name, hid_t attribute, hid_t type,
                                   char **value) {
    char *text;
    size_t bytes = H5Tget_size(type);
    PTIE_TRY(ptie_alloc_status(&text, bytes + 1, 1, name));
    if (H5Aread(attribute, type, text) < 0) {
        ptie_free(text);
        return h5_failure(h5, PTIE_EFORMAT, "read attribute", name);
    }
    if (H5Tget_strpad(type) == H5T_STR_SPACEPAD)
        while (bytes > 0 && text[bytes - 1] == ' ') text[--bytes] = 0;
    *value = text;
    return PTIE_OK;
}

ptie_status ptie_h5_get_text(ptie_h5 *h5, const char *object, const char *name, char **value) {
    *value = NULL;
    LOCK_HDF5;
    SCOPED_ID attribute = H5I_INVALID_HID, type = H5I_INVALID_HID;
    PTIE_TRY(open_single(h5, object, name, &attribute, &type));
    if (H5Tget_class(type) != H5T_STRING)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: attribute '%s' of %s is not text", h5->path, name,
                         object);
    return H5Tis_variable_str(type) > 0 ? read_variable_text(h5, name, attribute, type, value)
                                        : read_fixed_text(h5, name, attribute, type, value);
}
