/* SPDX-License-Identifier: BSD-3-Clause */
#include "progress.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "json.h"

#define BAR_CELLS 24
#define NOTED_CELLS 10

const char *const progress_styles[] = {"auto", "bar", "plain", "json", "none", NULL};

static volatile sig_atomic_t caught;

static void on_signal(int number) {
    caught = number;
}

/* A signal that the parent told us to ignore (nohup, background jobs of scripts) stays ignored. */
static void catch_signal(int number) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND | SA_RESTART},
                     before;
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(number, &action, NULL);
}

void catch_interrupts(void) {
    catch_signal(SIGINT);
    catch_signal(SIGTERM);
    catch_signal(SIGHUP);          /* the terminal was closed */
    signal(SIGXFSZ, SIG_IGN);      /* a write beyond the file-size limit fails instead */
}

int interrupted(void) {
    return caught;
}

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_start(progress_bar *p, int style, const char *task, const char *unit) {
    if (style == PROGRESS_AUTO) style = isatty(STDERR_FILENO) ? PROGRESS_BAR : PROGRESS_NONE;
    *p = (progress_bar){
        .style = (progress_style)style, .task = task, .unit = unit, .start_s = now_s()};
}

/* "1:02:03", "2:03". */
static void clock_text(char text[24], double seconds) {
    long s = lround(fmin(seconds, 1e7));
    if (s >= 3600)
        snprintf(text, 24, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(text, 24, "%ld:%02ld", s / 60, s % 60);
}

static int terminal_columns(void) {
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

/* With a note, the counts give way to it. */
static void show_bar(progress_bar *p, uint64_t done, uint64_t total, double rate, const char *eta,
                     const char *note) {
    char line[512], bar[BAR_CELLS + 1], counts[96];
    int cells = note ? NOTED_CELLS : BAR_CELLS;
    double share = total ? (double)done / (double)total : 0;
    for (int i = 0; i < cells; i++) bar[i] = i < share * cells ? '#' : '.';
    bar[cells] = 0;
    snprintf(counts, sizeof counts, "  %llu/%llu %s", (unsigned long long)done,
             (unsigned long long)total, p->unit);
    snprintf(line, sizeof line, "%s [%s] %3.0f %%%s  %.3g/s  ETA %s%s%s", p->task, bar,
             floor(100 * share), note ? "" : counts, rate, eta, note ? "  " : "", note ? note : "");
    fprintf(stderr, "\r%.*s\033[K", terminal_columns() - 1, line);
    p->on_line = true;
}

static void show_plain(const progress_bar *p, uint64_t done, uint64_t total, double rate,
                       const char *eta, const char *note) {
    fprintf(stderr, "%s: %llu/%llu %s, %.4g/s, ETA %s%s%s\n", p->task, (unsigned long long)done,
            (unsigned long long)total, p->unit, rate, eta, note ? ", " : "", note ? note : "");
}

static void show_json(const progress_bar *p, uint64_t done, uint64_t total, double rate,
                      double eta_s, const char *note) {
    fprintf(stderr,
            "{\"task\": \"%s\", \"done\": %llu, \"total\": %llu, \"unit\": \"%s\", \"rate\": ",
            p->task, (unsigned long long)done, (unsigned long long)total, p->unit);
    json_number(stderr, rate);
    fprintf(stderr, ", \"eta_s\": ");
    json_number(stderr, eta_s);
    fprintf(stderr, ", \"note\": ");
    json_text(stderr, note);
    fprintf(stderr, "}\n");
}

/* Seconds between two shows. */
static double interval(progress_style style) {
    return style == PROGRESS_PLAIN ? 5 : style == PROGRESS_JSON ? 0.5 : 0.1;
}

/* Since the first report: a task that goes on where another stopped begins with what that one had done. */
static double rate_of(const progress_bar *p, uint64_t done, double now) {
    if (done > p->first_done) return (double)(done - p->first_done) / (now - p->first_s);
    return now > p->start_s ? (double)done / (now - p->start_s) : 0;
}

int progress_report(void *user, uint64_t done, uint64_t total, const char *note) {
    progress_bar *p = user;
    const double now = now_s();
    if (!p->begun) p->begun = true, p->first_done = done, p->first_s = now;
    bool due = now - p->shown_s >= interval(p->style) || (done == total && p->shown_done != total);
    if (p->style != PROGRESS_NONE && due) {
        const double rate = rate_of(p, done, now);
        double eta_s = done > 0 ? (double)(total - done) / rate : (double)NAN;
        char eta[24] = "-:--";
        if (isfinite(eta_s)) clock_text(eta, eta_s);
        if (p->style == PROGRESS_BAR)
            show_bar(p, done, total, rate, eta, note);
        else if (p->style == PROGRESS_PLAIN)
            show_plain(p, done, total, rate, eta, note);
        else
            show_json(p, done, total, rate, eta_s, note);
        p->shown_s = now;
        p->shown_done = done;
    }
    return interrupted();
}

ptie_progress progress_callback(progress_bar *p) {
    return (ptie_progress){progress_report, p};
}

void progress_line(progress_bar *p, const char *line) {
    progress_end(p);
    if (p->style != PROGRESS_JSON) fprintf(stderr, "%s\n", line);
}

void progress_end(progress_bar *p) {
    if (p->on_line) fprintf(stderr, "\r\033[K");
    p->on_line = false;
}
