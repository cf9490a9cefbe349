/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames through reading, solving and writing: all of them, each once, in order where order is promised, with
   bounded memory, and with one well-defined end after a failure. */
#include "support/support.h"

#include <stdatomic.h>
#include <unistd.h>

#include "run/stages.h"

enum { FRAMES = 500, MOST_SLOTS = 64, NEVER = -1 };

typedef struct job {
    int64_t slot[MOST_SLOTS]; /* what a frame's data is: its number, then its square */
    int64_t first, read, written, sum;
    atomic_int in_flight; /* frames read and not yet written */
    int most_in_flight;
    int64_t bad_read, bad_solve, worse_solve, bad_write;
    int slow; /* the stage that sleeps: 0 none, 1 read, 2 solve, 3 write */
    int64_t reported, cancel_at;
} job;

static ptie_status fails(int64_t frame, int64_t bad, const char *stage) {
    return frame == bad ? ptie_fail(PTIE_EIO, "%s %lld", stage, (long long)frame) : PTIE_OK;
}

static ptie_status read_frame(void *context, int64_t frame, size_t slot) {
    job *j = context;
    if (frame != j->first + j->read++) return ptie_fail(PTIE_ESTATE, "frame %lld out of order", (long long)frame);
    if (j->slow == 1) usleep(50);
    const int now = atomic_fetch_add(&j->in_flight, 1) + 1;
    j->most_in_flight = now > j->most_in_flight ? now : j->most_in_flight;
    j->slot[slot] = frame;
    return fails(frame, j->bad_read, "read");
}

static ptie_status solve_frame(void *context, int64_t frame, size_t slot, int32_t worker) {
    job *j = context;
    (void)worker;
    if (j->slot[slot] != frame) return ptie_fail(PTIE_ESTATE, "frame %lld was overwritten", (long long)frame);
    if (j->slow == 2 || frame == j->bad_solve) usleep(j->slow == 2 ? 50 : 2000); /* later than worse_solve */
    j->slot[slot] = frame * frame;
    const ptie_status status = fails(frame, j->worse_solve, "solve");
    return status == PTIE_OK ? fails(frame, j->bad_solve, "solve") : status;
}

static ptie_status write_frame(void *context, int64_t frame, size_t slot) {
    job *j = context;
    if (frame != j->first + j->written || j->slot[slot] != frame * frame)
        return ptie_fail(PTIE_ESTATE, "frame %lld is not what comes next", (long long)frame);
    if (j->slow == 3) usleep(50);
    const ptie_status status = fails(frame, j->bad_write, "write");
    if (status != PTIE_OK) return status;
    j->written++;
    j->sum += j->slot[slot];
    atomic_fetch_sub(&j->in_flight, 1);
    return PTIE_OK;
}

static int on_progress(void *user, uint64_t done, uint64_t total, const char *note) {
    job *j = user;
    (void)note;
    assert_int_equal(total, FRAMES);
    assert_true((int64_t)done >= j->reported);
    j->reported = (int64_t)done;
    return j->cancel_at != NEVER && (int64_t)done >= j->cancel_at;
}

static job fresh(void) {
    return (job){.bad_read = NEVER, .bad_solve = NEVER, .worse_solve = NEVER, .bad_write = NEVER, .cancel_at = NEVER};
}

static ptie_status run(job *j, int32_t threads, size_t slots) {
    ptie_pool *pool;
    assert_ok(ptie_pool_create(&pool, threads));
    const ptie_stages stages = {.read = read_frame, .solve = solve_frame, .write = write_frame, .context = j,
                                .first = j->first, .end = FRAMES, .slots = slots, .total = FRAMES,
                                .progress = {on_progress, j}};
    const ptie_status status = ptie_stages_run(&stages, pool);
    ptie_pool_free(pool);
    return status;
}

/* Sum of the squares below n. */
static int64_t squares(int64_t n) {
    return (n - 1) * n * (2 * n - 1) / 6;
}

static void every_frame_is_written_once_in_order(void **state) {
    (void)state;
    for (int32_t threads = 1; threads <= 5; threads += 2)
        for (size_t slots = 1; slots <= MOST_SLOTS; slots *= 4)
            for (int slow = 0; slow <= 3; slow++) {
                job j = fresh();
                j.slow = slow;
                assert_ok(run(&j, threads, slots));
                assert_int_equal(j.written, FRAMES);
                assert_int_equal(j.sum, squares(FRAMES));
                assert_int_equal(j.reported, FRAMES);
                assert_true((size_t)j.most_in_flight <= slots);
            }
}

static void it_goes_on_in_the_middle(void **state) {
    (void)state;
    for (int64_t first = FRAMES; first >= FRAMES - 2; first--) { /* nothing, one frame, two of them */
        job j = fresh();
        j.first = first;
        assert_ok(run(&j, 2, 4));
        assert_int_equal(j.written, FRAMES - first);
        assert_int_equal(j.sum, squares(FRAMES) - squares(first));
    }
}

/* Whatever fails, and however many threads there are: what comes before is written, what comes after is not. */
static void a_failure_ends_the_stream_before_its_frame(void **state) {
    (void)state;
    for (int32_t threads = 1; threads <= 4; threads++)
        for (int stage = 0; stage < 3; stage++) {
            job j = fresh();
            *(int64_t *[]){&j.bad_read, &j.bad_solve, &j.bad_write}[stage] = 123;
            const char *const message[] = {"read 123", "solve 123", "write 123"};
            assert_fails(run(&j, threads, 8), PTIE_EIO, message[stage]);
            assert_int_equal(j.written, 123);
            assert_int_equal(j.sum, squares(123));
        }
}

static void of_two_failures_the_earlier_frame_counts(void **state) {
    (void)state;
    job j = fresh();
    j.bad_solve = 200, j.worse_solve = 202, j.bad_read = 204;
    assert_fails(run(&j, 4, 16), PTIE_EIO, "solve 200");
    assert_int_equal(j.written, 200);
}

static void cancelling_stops_early(void **state) {
    (void)state;
    for (int slow = 0; slow <= 3; slow++) {
        job j = fresh();
        j.cancel_at = 50, j.slow = slow;
        assert_fails(run(&j, 3, 8), PTIE_ECANCELLED, "cancelled after");
        assert_true(j.written >= 50 && j.written < FRAMES);
        assert_int_equal(j.sum, squares(j.written));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_frame_is_written_once_in_order),
        cmocka_unit_test(it_goes_on_in_the_middle),
        cmocka_unit_test(a_failure_ends_the_stream_before_its_frame),
        cmocka_unit_test(of_two_failures_the_earlier_frame_counts),
        cmocka_unit_test(cancelling_stops_early),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
