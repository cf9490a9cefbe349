/* SPDX-License-Identifier: BSD-3-Clause */
/* Whole jobs with the n-th allocation, the n-th call to the system, or the n-th and all after it, failing, for all n:
 * a status with one line, nothing left open, outputs whole or not there, and never a success that computed
 * something else.  A job that keeps what is finished ends as if nothing had failed when it is run again.
 *
 * usage: test_faults [STEP]            every STEP-th n, default 1
 *        test_faults PIPELINE KIND N   one case, for a debugger; KIND = 0.. as in `faults` below */
#include "support/files.h"

#include <dirent.h>
#include <stdlib.h>
#include <unistd.h>

#include "inject.h"
#include "pipelines.h"

typedef struct fault {
    const char *name;
    inject_kind kind;
    bool all;
} fault;

static const fault faults[] = {
    {"allocation fails", INJECT_MEMORY, false},      {"memory runs out", INJECT_MEMORY, true},
    {"call to the system fails", INJECT_FILES, false}, {"system stops working", INJECT_FILES, true},
    {"read or write is short", INJECT_SHORT, false},
};
enum { FAULTS = sizeof faults / sizeof *faults };

static int64_t step = 1;

/* What a job writes when nothing fails. */
typedef struct reference {
    unsigned char *data[PIPELINE_OUTPUTS];
    size_t bytes[PIPELINE_OUTPUTS];
} reference;

static int open_descriptors(void) {
    int count = 0;
    DIR *folder = opendir("/proc/self/fd");
    assert_non_null(folder);
    while (readdir(folder)) count++;
    closedir(folder);
    return count;
}

static void remove_outputs(const pipeline *p) {
    for (int i = 0; i < PIPELINE_OUTPUTS && p->outputs[i]; i++) remove(pipeline_path(p->outputs[i]));
}

static void take_reference(reference *r, const pipeline *p) {
    *r = (reference){0};
    assert_ok(p->run());
    for (int i = 0; i < PIPELINE_OUTPUTS && p->outputs[i]; i++)
        r->data[i] = support_read(pipeline_path(p->outputs[i]), &r->bytes[i]);
}

static void forget(reference *r) {
    for (int i = 0; i < PIPELINE_OUTPUTS; i++) free(r->data[i]);
}

/* `gone`: the system stopped working, so that what was begun may stay, as after a crash. */
static void check_output(const char *name, const unsigned char *expected, size_t bytes, bool success, bool gone) {
    const char *path = pipeline_path(name);
    char part[300];
    size_t found;
    snprintf(part, sizeof part, "%s.part", path);
    if (support_exists(part) && !gone) fail_msg("%s is left", part);
    remove(part);
    if (!support_exists(path)) {
        if (success) fail_msg("%s is missing after a success", path);
        return;
    }
    unsigned char *data = support_read(path, &found);
    const bool same = found == bytes && memcmp(data, expected, bytes) == 0;
    free(data);
    if (!same) fail_msg("%s is not what it should be (%zu bytes, found %zu)", path, bytes, found);
}

static void check_status(ptie_status status, const fault *f) {
    const char *message = ptie_last_error();
    if (status == PTIE_OK) return;
    if (f->kind == INJECT_SHORT) fail_msg("refused: %s", message);
    if (!*message || strchr(message, '\n')) fail_msg("not one line: '%s'", message);
    if (f->kind == INJECT_MEMORY && status != PTIE_ENOMEM)
        fail_msg("expected out of memory, found %s: %s", ptie_status_name(status), message);
}

/* One job with call number n failing; returns how many calls there were. */
static int64_t run_once(const pipeline *p, const fault *f, int64_t n, const reference *r) {
    const int before = open_descriptors();
    remove_outputs(p);
    inject_start(f->kind, n, f->all);
    const ptie_status status = p->run();
    const int64_t calls = inject_stop();
    if (getenv("PTIE_FAULTS_VERBOSE"))
        print_message("# %s, %lld: %s %s\n", f->name, (long long)n, ptie_status_name(status),
                      status ? ptie_last_error() : "");
    check_status(status, f);
    if (status != PTIE_OK && p->keeps) assert_ok(p->run());
    for (int i = 0; i < PIPELINE_OUTPUTS && p->outputs[i]; i++)
        check_output(p->outputs[i], r->data[i], r->bytes[i], status == PTIE_OK || p->keeps,
                     f->all && f->kind == INJECT_FILES);
    if (open_descriptors() != before) fail_msg("a file is left open");
    return calls;
}

static void survives(void **state) {
    const pipeline *p = *state;
    reference r;
    take_reference(&r, p);
    for (int i = 0; i < FAULTS; i++) {
        int64_t n = 1;
        while (run_once(p, &faults[i], n, &r) >= n) n += step; /* else there is no call n: nothing failed */
        print_message("# %s: %s, n up to %lld\n", p->name, faults[i].name, (long long)n);
    }
    forget(&r);
}

static int run_one(char **argv) {
    reference r;
    pipelines_prepare();
    for (int i = 0; i < pipeline_count; i++) {
        if (strcmp(argv[1], pipelines[i].name) != 0) continue;
        take_reference(&r, &pipelines[i]);
        run_once(&pipelines[i], &faults[atoi(argv[2])], atoll(argv[3]), &r);
        forget(&r);
    }
    return 0;
}

static int prepare(void **state) {
    (void)state;
    pipelines_prepare();
    return 0;
}

int main(int argc, char **argv) {
    struct CMUnitTest tests[16] = {0};
    if (argc == 4) return run_one(argv);
    if (argc == 2) step = atoll(argv[1]);
    for (int i = 0; i < pipeline_count; i++)
        tests[i] = (struct CMUnitTest){
            .name = pipelines[i].name, .test_func = survives, .initial_state = (void *)(uintptr_t)&pipelines[i]};
    return _cmocka_run_group_tests("faults", tests, (size_t)pipeline_count, prepare, NULL);
}
