/* SPDX-License-Identifier: BSD-3-Clause */
/* Sections of the page, in the order they are read: what it is, warnings, maps, numbers, noise, parameters. */
#include "report/run_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "report/html.h"
#include "report/report.h"
#include "report/run_view.h"
#include "report/spectrum.h"

enum { SHEET_COLUMNS = 6, SPECTRUM_MAPS = 16, MOST_POINTS = 4000 };

typedef struct report {
    ptie_run_view view;
    ptie_html html;
    float *maps; /* (2 * SHEET_COLUMNS, H, W) */
} report;

static float *map_at(const report *r, int32_t i) {
    return r->maps + (size_t)i * r->view.pixels;
}

static const char *best_map(const report *r) {
    return r->view.denoised ? "denoised" : "phase";
}

/* --- what it is ---------------------------------------------------------------------------------------- */

static void add_fact(report *r, const char *name, const char *value) {
    if (!value || !*value) return;
    ptie_text_append(&r->html.text, "<tr><th>%s</th><td>", name);
    ptie_html_escaped(&r->html, value);
    ptie_text_append(&r->html.text, "</td></tr>\n");
}

static void add_attribute(report *r, const char *name, const char *attribute) {
    char *value = ptie_run_view_text(&r->view, attribute);
    r->html.text.failed |= !value;
    add_fact(r, name, value);
    ptie_free(value);
}

static void add_facts(report *r) {
    const ptie_run_view *v = &r->view;
    char text[160], pixel[PTIE_QUANTITY_BYTES];
    ptie_text_append(&r->html.text, "<table>\n");
    add_attribute(r, "recording", "recording");
    if (v->finished < v->frames)
        ptie_print(text, sizeof text, "%lld of %lld so far", (long long)v->finished, (long long)v->frames);
    else
        ptie_print(text, sizeof text, "%lld", (long long)v->frames);
    add_fact(r, "frames", text);
    ptie_print(text, sizeof text, "%d × %d px%s%s", v->width_px, v->height_px, v->pixel_m > 0 ? ", each " : "",
               v->pixel_m > 0 ? ptie_print_rounded(pixel, v->pixel_m, PTIE_LENGTH) : "");
    add_fact(r, "phase", text);
    if (v->seconds && v->finished > 1) {
        char whole[PTIE_QUANTITY_BYTES], step[PTIE_QUANTITY_BYTES];
        ptie_print(text, sizeof text, "%s in steps of %s",
                   ptie_print_rounded(whole, v->time[v->finished - 1] - v->time[0], PTIE_TIME),
                   ptie_print_rounded(step, v->time[1] - v->time[0], PTIE_TIME));
        add_fact(r, "duration", text);
    }
    add_attribute(r, "model", "model");
    add_attribute(r, "command", "command");
    add_attribute(r, "ptie", "version");
    ptie_text_append(&r->html.text, "</table>\n");
}

static void add_warnings(report *r) {
    char line[PTIE_H5_LINE_BYTES];
    for (int32_t i = 0; ptie_run_view_warning(&r->view, i, line); i++) {
        if (i == 0) {
            ptie_html_heading(&r->html, "Warnings");
            ptie_text_append(&r->html.text, "<ul class=\"warnings\">\n");
        }
        ptie_text_append(&r->html.text, "<li>");
        ptie_html_escaped(&r->html, line);
        ptie_text_append(&r->html.text, "</li>\n");
    }
    if (ptie_run_view_warning(&r->view, 0, line)) ptie_text_append(&r->html.text, "</ul>\n");
}

/* --- maps ---------------------------------------------------------------------------------------------- */

static ptie_panel panel_of(const report *r, const float *map, const char *title) {
    return (ptie_panel){.data = map,
                        .width_px = r->view.width_px,
                        .height_px = r->view.height_px,
                        .title = title,
                        .unit = "rad",
                        .colormap = PTIE_DIVERGING,
                        .pixel_m = r->view.pixel_m};
}

/* Frames spread over the run, the first and the last among them. */
static int64_t frame_of_column(const report *r, int32_t column, int32_t columns) {
    return columns > 1 ? (r->view.finished - 1) * column / (columns - 1) : 0;
}

/* The panels of a row share their colours: those of the widest. */
static void share_colours(ptie_panel *panels, int32_t count, size_t pixels) {
    double largest = 0;
    for (int32_t i = 0; i < count; i++)
        for (size_t k = 0; k < pixels; k++) largest = fmax(largest, fabs((double)panels[i].data[k]));
    for (int32_t i = 0; i < count; i++) panels[i].low = -largest, panels[i].high = largest;
}

static ptie_status add_contact_sheet(report *r) {
    static const char *const maps[] = {"phase", "denoised"}, *const names[] = {"TIE phase", "denoised"};
    const int32_t columns = r->view.finished < SHEET_COLUMNS ? (int32_t)r->view.finished : SHEET_COLUMNS;
    const int32_t rows = r->view.denoised ? 2 : 1;
    ptie_panel panels[2 * SHEET_COLUMNS];
    char titles[SHEET_COLUMNS][40];
    for (int32_t i = 0; i < rows * columns; i++) {
        const int32_t row = i / columns, column = i % columns;
        const int64_t frame = frame_of_column(r, column, columns);
        PTIE_TRY(ptie_run_view_map(&r->view, maps[row], frame, map_at(r, i)));
        ptie_print(titles[column], sizeof titles[0], r->view.seconds ? "t = %.4g ms" : "frame %.0f",
                   r->view.time[frame] * (r->view.seconds ? 1e3 : 1));
        panels[i] = panel_of(r, map_at(r, i), row == 0 ? titles[column] : NULL);
    }
    for (int32_t row = 0; row < rows; row++) share_colours(panels + row * columns, columns, r->view.pixels);
    PTIE_TRY(ptie_draw_panels(r->html.figure,
                              &(ptie_panels){.panels = panels, .rows = rows, .columns = columns, .row_titles = names},
                              true));
    ptie_html_heading(&r->html, "Phase");
    return ptie_html_figure(&r->html, "Frames spread evenly over the recording; a row shares its colours.");
}

static ptie_status add_averages(report *r) {
    char name[32];
    if (r->view.finished < r->view.frames || r->view.frames < 2) return PTIE_OK; /* written at the end */
    snprintf(name, sizeof name, "%s_mean", best_map(r));
    PTIE_TRY(ptie_run_view_statistic(&r->view, name, map_at(r, 0)));
    snprintf(name, sizeof name, "%s_rms", best_map(r));
    PTIE_TRY(ptie_run_view_statistic(&r->view, name, map_at(r, 1)));
    ptie_panel panels[2] = {panel_of(r, map_at(r, 0), "average over time"),
                            panel_of(r, map_at(r, 1), "rms about the average")};
    panels[1].colormap = PTIE_VIRIDIS;
    PTIE_TRY(ptie_draw_panels(r->html.figure,
                              &(ptie_panels){.panels = panels, .rows = 1, .columns = 2, .width_mm = 120}, true));
    return ptie_html_figure(&r->html, r->view.denoised ? "Denoised phase." : "TIE phase.");
}

/* --- numbers ------------------------------------------------------------------------------------------- */

typedef struct metric {
    const char *name, *label;
} metric;

static const metric metrics[] = {
    {"mgm", "MGM (rad/px)"}, {"sbr", "SBR"}, {"bns", "BNS (rad)"}, {"cnr", "CNR"}, {"residual", "residual"},
    {"rmse_rad", "RMSE (rad)"}, {"correlation", "correlation"}, {"signal_kept", "signal kept"},
};

/* "0.0341 ± 0.0031" over the frames that have a value, or "". */
static void print_stat(char text[64], const double *values, int64_t count) {
    double mean = 0, squares = 0;
    int64_t finite = 0;
    for (int64_t t = 0; t < count; t++) {
        if (!isfinite(values[t])) continue;
        const double off = values[t] - mean;
        mean += off / (double)++finite;
        squares += off * (values[t] - mean);
    }
    text[0] = 0;
    if (finite > 1)
        ptie_print(text, 64, "%.3g ± %.2g", mean, sqrt(squares / (double)(finite - 1)));
    else if (finite == 1)
        ptie_print(text, 64, "%.3g", mean);
}

static ptie_status add_table(report *r) {
    double *values;
    char phase[64], denoised[64];
    PTIE_TRY(ptie_alloc_status(&values, (size_t)r->view.finished, sizeof *values, r->view.path));
    ptie_html_heading(&r->html, "Metrics");
    ptie_text_append(&r->html.text, "<table>\n<tr><th></th><th class=\"n\">TIE phase</th>%s</tr>\n",
                     r->view.denoised ? "<th class=\"n\">denoised</th>" : "");
    for (size_t i = 0; i < sizeof metrics / sizeof *metrics; i++) {
        if (!ptie_run_view_column(&r->view, "phase", metrics[i].name, values)) continue;
        print_stat(phase, values, r->view.finished);
        denoised[0] = 0;
        if (ptie_run_view_column(&r->view, "denoised", metrics[i].name, values))
            print_stat(denoised, values, r->view.finished);
        if (phase[0])
            ptie_text_append(&r->html.text, "<tr><th>%s</th><td class=\"n\">%s</td><td class=\"n\">%s</td></tr>\n",
                             metrics[i].label, phase, denoised);
    }
    ptie_text_append(&r->html.text,
                     "</table>\n<p>Mean ± standard deviation over frames. MGM: mean gradient in the jet. SBR: mean of the "
                     "jet over that of the background; close to 0 / 0 where the background is flat. BNS: standard "
                     "deviation of the background. CNR: contrast over noise. Residual: the map sent back through the "
                     "forward model against the planes; 0 keeps all noise, 1 is an empty map, more contradicts "
                     "them.</p>\n");
    ptie_free(values);
    return PTIE_OK;
}

enum { AXES = 2, CURVES = 2 };

/* Two metrics side by side; every n-th frame where there are more than can be seen. */
static ptie_status add_metrics_figure(report *r, const metric *two, const char *caption) {
    static const char *const maps[CURVES] = {"phase", "denoised"}, *const names[CURVES] = {"TIE phase", "denoised"};
    const size_t frames = (size_t)r->view.finished, every = frames / MOST_POINTS + 1;
    const int32_t count = r->view.denoised ? 2 : 1;
    ptie_curve curves[AXES][CURVES];
    ptie_axes axes[AXES];
    double *values;
    if (frames < 2) return PTIE_OK;
    PTIE_TRY(ptie_alloc_status(&values, (AXES * CURVES + 1) * frames, sizeof *values, r->view.path));
    size_t points = 0;
    double *x = values + AXES * CURVES * frames;
    for (size_t t = 0; t < frames; t += every) x[points++] = r->view.time[t] * (r->view.seconds ? 1e3 : 1);
    for (int32_t a = 0; a < AXES; a++) {
        for (int32_t c = 0; c < count; c++) {
            double *y = values + (size_t)(a * CURVES + c) * frames;
            if (!ptie_run_view_column(&r->view, maps[c], two[a].name, y)) points = 0;
            for (size_t i = 0; i < points; i++) y[i] = y[i * every];
            curves[a][c] = (ptie_curve){.x = x, .y = y, .count = points, .label = names[c], .colour = c};
        }
        axes[a] = (ptie_axes){.curves = curves[a], .count = count, .x_label = r->view.seconds ? "time (ms)" : "frame",
                              .y_label = two[a].label};
    }
    ptie_status status = ptie_draw_curves(r->html.figure, axes, AXES, NULL, 0, true);
    ptie_free(values);
    return status == PTIE_OK ? ptie_html_figure(&r->html, caption) : status;
}

/* --- noise --------------------------------------------------------------------------------------------- */

static ptie_status measure_spectrum(report *r, const char *map, ptie_spectrum *spectrum) {
    const int32_t maps = r->view.finished < SPECTRUM_MAPS ? (int32_t)r->view.finished : SPECTRUM_MAPS;
    PTIE_TRY(ptie_spectrum_create(spectrum, r->view.width_px, r->view.height_px, r->view.pixel_m));
    for (int32_t i = 0; i < maps; i++) {
        PTIE_TRY(ptie_run_view_map(&r->view, map, frame_of_column(r, i, maps), map_at(r, 0)));
        ptie_spectrum_add(spectrum, map_at(r, 0));
    }
    return PTIE_OK;
}

/* Density of the noise at 1 rad/m: sigma^2 (k p)^2 times the gain of dI/dz; it falls with q^-4. */
static double noise_density(const report *r, double *noise_rad) {
    double *values, sigma = 0;
    int64_t finite = 0;
    if (ptie_alloc_status(&values, (size_t)r->view.finished, sizeof *values, r->view.path) != PTIE_OK) return (double)NAN;
    *noise_rad = 0;
    if (ptie_run_view_column(&r->view, "frame", "noise_rad", values))
        for (int64_t t = 0; t < r->view.finished; t++)
            if (isfinite(values[t])) *noise_rad += values[t], finite++;
    ptie_free(values);
    *noise_rad /= (double)finite;
    sigma = *noise_rad / ptie_run_view_number(&r->view, "noise_rad_per_sigma");
    return sigma * sigma * ptie_run_view_number(&r->view, "noise_density_per_sigma2");
}

static ptie_status draw_spectra(report *r, ptie_spectrum spectra[2], double *values) {
    const int32_t count = r->view.denoised ? 2 : 1, bins = spectra[0].bins;
    double noise_rad = 0;
    const double closed_form = noise_density(r, &noise_rad);
    double *x = values, *y[3] = {x + bins, x + 2 * bins, x + 3 * bins};
    for (int32_t i = 0; i < bins; i++) {
        const double q = ptie_spectrum_q(&spectra[0], i);
        x[i] = log10(q / (2 * M_PI) * 1e-3); /* periods per mm */
        for (int32_t c = 0; c < count; c++) y[c][i] = 1e12 * ptie_spectrum_density(&spectra[c], i);
        y[2][i] = 1e12 * closed_form / pow(q, 4);
    }
    const ptie_curve curves[3] = {
        {.x = x, .y = y[0], .count = (size_t)bins, .label = "TIE phase"},
        {.x = x, .y = y[2], .count = (size_t)bins, .label = "noise of the planes", .dashed = true, .colour = 2},
        {.x = x, .y = y[1], .count = (size_t)bins, .label = "denoised", .colour = 1}};
    const ptie_axes axes = {.curves = curves,
                            .count = count + 1,
                            .x_label = "log₁₀ of spatial frequency (1/mm)",
                            .y_label = "PSD (rad² µm²)",
                            .log_y = true};
    char caption[256];
    PTIE_TRY(ptie_draw_curves(r->html.figure, &axes, 1, NULL, 120, true));
    ptie_print(caption, sizeof caption,
               "Power spectral density of the phase, averaged over directions and frames. Dashed: what the planes' white "
               "noise, as measured, makes of it: 1/q⁴, %.3g rad rms in the frame.", noise_rad);
    ptie_html_heading(&r->html, "Noise");
    return ptie_html_figure(&r->html, caption);
}

static ptie_status add_spectrum(report *r) {
    ptie_spectrum spectra[2] = {{0}, {0}};
    double *values = NULL;
    if (r->view.pixel_m <= 0) return PTIE_OK;
    ptie_status status = measure_spectrum(r, "phase", &spectra[0]);
    if (status == PTIE_OK && r->view.denoised) status = measure_spectrum(r, "denoised", &spectra[1]);
    if (status == PTIE_OK) status = ptie_alloc_status(&values, 4 * (size_t)spectra[0].bins, sizeof *values, r->view.path);
    if (status == PTIE_OK) status = draw_spectra(r, spectra, values);
    ptie_spectrum_free(&spectra[0]);
    ptie_spectrum_free(&spectra[1]);
    ptie_free(values);
    return status;
}

static void add_rig(report *r) {
    char *rig = ptie_run_view_text(&r->view, "rig");
    r->html.text.failed |= !rig;
    ptie_html_heading(&r->html, "Rig");
    ptie_text_append(&r->html.text, "<pre>");
    ptie_html_escaped(&r->html, rig ? rig : "");
    ptie_text_append(&r->html.text, "</pre>\n");
    ptie_free(rig);
}

static ptie_status add_sections(report *r) {
    add_facts(r);
    add_warnings(r);
    PTIE_TRY(add_contact_sheet(r));
    PTIE_TRY(add_averages(r));
    PTIE_TRY(add_table(r));
    PTIE_TRY(add_metrics_figure(r, &metrics[0], "a) Mean gradient in the jet; b) mean of the jet over that of the "
                                                "background."));
    PTIE_TRY(add_metrics_figure(r, &metrics[2], "a) Standard deviation of the background; b) contrast over noise."));
    PTIE_TRY(add_spectrum(r));
    add_rig(r);
    return PTIE_OK;
}

static ptie_status compose(report *r, const char *path, const char *result, bool overwrite) {
    char title[300];
    const char *slash = strrchr(result, '/');
    PTIE_TRY(ptie_run_view_open(&r->view, result));
    PTIE_TRY(ptie_alloc_status(&r->maps, 2 * SHEET_COLUMNS, r->view.pixels * sizeof *r->maps, result));
    snprintf(title, sizeof title, "%s", slash ? slash + 1 : result);
    PTIE_TRY(ptie_html_open(&r->html, path, overwrite, title));
    return add_sections(r);
}

ptie_status ptie_draw_report(const char *path, const char *result, bool overwrite) {
    report r = {0};
    ptie_status status = compose(&r, path, result, overwrite);
    if (status == PTIE_OK)
        status = ptie_html_close(&r.html);
    else
        ptie_html_discard(&r.html);
    ptie_run_view_close(&r.view);
    ptie_free(r.maps);
    return status;
}
