/* SPDX-License-Identifier: BSD-3-Clause */
/* <path>.last: a model file that also holds the optimiser's moments and where the run stands. */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "nn/model.h"
#include "train/history.h"
#include "train/trainer.h"

#define NOTE_PREFIX "ptie.train."
#define NOTE_SETTINGS NOTE_PREFIX "settings"
#define NOTE_POSITION NOTE_PREFIX "position"
#define NOTE_HISTORY NOTE_PREFIX "history"
#define NOTE_KERNELS "ptie.kernels"
#define NAME_BYTES 128

/* What the model was trained with, where the settings do not say it. */
static ptie_status note_run(ptie_trainer *t) {
    char generator[24];
    snprintf(generator, sizeof generator, "%lld", (long long)t->dataset->generator);
    PTIE_TRY(ptie_nn_set_note(t->model, "ptie.generator", generator));
    return ptie_nn_set_note(t->model, NOTE_KERNELS, ptie_cpu_name(t->engine->level));
}

ptie_status ptie_checkpoint_describe(ptie_trainer *t) {
    const ptie_train_params *p = t->params;
    ptie_text *text = &t->settings;
    for (size_t i = 0; i < PTIE_MODEL_FACTS; i++)
        ptie_text_append(text, "%s = %s\n", t->model->facts[i].key, t->model->facts[i].value);
    ptie_text_append(text,
                     "epochs = %d\nbatch = %d\nlearning_rate = %.17g\nwarmup_epochs = %.17g\n",
                     p->epochs, p->batch, p->learning_rate, p->warmup_epochs);
    ptie_text_append(text, "weight_decay = %.17g\nbeta1 = %.17g\nbeta2 = %.17g\nepsilon = %.17g\n",
                     p->weight_decay, p->beta1, p->beta2, p->epsilon);
    ptie_text_append(text, "w_l1 = %.17g\nw_ssim = %.17g\nw_mse = %.17g\nseed = %llu\n", p->w_l1,
                     p->w_ssim, p->w_mse, (unsigned long long)p->seed);
    ptie_text_append(text, "samples = %llu\nsamples_seed = %llu\ngenerator = %lld\n%s",
                     (unsigned long long)t->dataset->count, (unsigned long long)t->dataset->seed,
                     (long long)t->dataset->generator, t->dataset->preset_text);
    ptie_text_append(&t->last_path, "%s.last", t->path);
    if (text->failed || t->last_path.failed)
        return PTIE_FAIL(PTIE_ENOMEM, "training: out of memory");
    return note_run(t);
}

/* Tensors and notes of a checkpoint on its way to the file. */
typedef struct contents {
    ptie_tensor_view *model_tensors, *tensors;
    ptie_note *model_notes, *notes;
    size_t model_tensor_count, tensor_count, model_note_count, note_count;
    char (*names)[NAME_BYTES]; /* of the moments */
    ptie_text position, history;
} contents;

static void free_contents(contents *c) {
    ptie_free(c->model_tensors);
    ptie_free(c->tensors);
    ptie_free(c->model_notes);
    ptie_free(c->notes);
    ptie_free(c->names);
    ptie_text_free(&c->position);
    ptie_text_free(&c->history);
}

static const char *moment_name(char name[NAME_BYTES], int which, const char *tensor) {
    const int length = snprintf(name, NAME_BYTES, "opt.%c.%s", which == 1 ? 'm' : 'v', tensor);
    assert(length < NAME_BYTES);
    (void)length;
    return name;
}

static void add_moments(contents *c, const ptie_trainer *t, const ptie_tensor_view *tensor) {
    for (int which = 1; which <= 2; which++) {
        size_t count;
        const float *moment = ptie_stepper_state(t->stepper, which, tensor->name, &count);
        if (!moment) return; /* running statistics have no moments */
        const size_t slot = c->tensor_count++;
        c->tensors[slot] = *tensor;
        c->tensors[slot].name = moment_name(c->names[slot], which, tensor->name);
        c->tensors[slot].data = moment;
    }
}

static void add_note(contents *c, const char *key, const char *value) {
    c->notes[c->note_count++] = (ptie_note){key, value};
}

static ptie_status collect(contents *c, const ptie_trainer *t) {
    PTIE_TRY(ptie_nn_tensors(t->model, &c->model_tensors, &c->model_tensor_count, &c->model_notes,
                             &c->model_note_count));
    const size_t most_tensors = 3 * c->model_tensor_count, most_notes = c->model_note_count + 3;
    PTIE_TRY(ptie_alloc_status(&c->tensors, most_tensors, sizeof *c->tensors, "checkpoint"));
    PTIE_TRY(ptie_alloc_status(&c->names, most_tensors, sizeof *c->names, "checkpoint"));
    PTIE_TRY(ptie_alloc_status(&c->notes, most_notes, sizeof *c->notes, "checkpoint"));

    for (size_t i = 0; i < c->model_tensor_count; i++)
        c->tensors[c->tensor_count++] = c->model_tensors[i];
    for (size_t i = 0; i < c->model_tensor_count; i++) add_moments(c, t, &c->model_tensors[i]);

    const ptie_scores *sums = &t->sums;
    ptie_text_append(&c->position, "%llu %llu %.17g %.17g %.17g %.17g %.17g",
                     (unsigned long long)t->step, (unsigned long long)sums->samples, sums->loss,
                     sums->psnr_db, sums->mae, sums->ssim, t->seconds);
    ptie_history_print(&c->history, t->epochs, t->epoch_count);
    if (c->position.failed || c->history.failed)
        return PTIE_FAIL(PTIE_ENOMEM, "checkpoint: out of memory");
    for (size_t i = 0; i < c->model_note_count;
         i++) /* a model loaded from a checkpoint brings old ones */
        if (strncmp(c->model_notes[i].key, NOTE_PREFIX, sizeof NOTE_PREFIX - 1) != 0)
            c->notes[c->note_count++] = c->model_notes[i];
    add_note(c, NOTE_SETTINGS, t->settings.data);
    add_note(c, NOTE_POSITION, c->position.data);
    add_note(c, NOTE_HISTORY, c->history.data);
    return PTIE_OK;
}

ptie_status ptie_checkpoint_save(const ptie_trainer *t) {
    contents c = {0};
    ptie_status status = collect(&c, t);
    if (status == PTIE_OK)
        status = ptie_safetensors_write(t->last_path.data, c.tensors, c.tensor_count, c.notes,
                                        c.note_count, true);
    free_contents(&c);
    return status;
}

/* The first line in which the settings of two runs differ. */
static ptie_status compare_settings(const char *own, const char *saved, const char *where) {
    if (strcmp(own, saved) == 0) return PTIE_OK;
    size_t line = 0;
    for (size_t i = 0; own[i] == saved[i]; i++)
        if (own[i] == '\n') line = i + 1;
    return PTIE_FAIL(
        PTIE_EINVAL, "%s: cannot resume with other settings (expected '%.*s', found '%.*s')", where,
        (int)strcspn(saved + line, "\n"), saved + line, (int)strcspn(own + line, "\n"), own + line);
}

static ptie_status find_note(const char **value, const ptie_safetensors *file, const char *key,
                             const char *where) {
    *value = ptie_safetensors_note(file, key);
    if (*value) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT,
                     "%s: not a training checkpoint (expected the note %s, found none)", where,
                     key);
}

static ptie_status restore_model(ptie_trainer *t, const ptie_safetensors *file) {
    ptie_model *saved;
    PTIE_TRY(ptie_nn_from_safetensors(&saved, file, t->last_path.data));
    ptie_nn_copy(t->model, saved); /* the settings agreed, so the shapes do */
    ptie_nn_free(saved);
    return PTIE_OK;
}

static ptie_status restore_moment(ptie_trainer *t, const ptie_safetensors *file, int which,
                                  const ptie_tensor_view *tensor) {
    char name[NAME_BYTES];
    size_t count, found = 1;
    float *moment = ptie_stepper_state(t->stepper, which, tensor->name, &count);
    if (!moment) return PTIE_OK;
    const ptie_tensor_view *saved =
        ptie_safetensors_find(file, moment_name(name, which, tensor->name));
    for (int32_t i = 0; saved && i < saved->rank; i++) found *= (size_t)saved->shape[i];
    if (!saved || found != count)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: missing or of another size (expected %zu numbers)",
                         t->last_path.data, name, count);
    memcpy(moment, saved->data, count * sizeof *moment);
    return PTIE_OK;
}

static ptie_status restore_moments(ptie_trainer *t, const ptie_safetensors *file) {
    ptie_tensor_view *tensors;
    ptie_note *notes;
    size_t tensor_count, note_count;
    PTIE_TRY(ptie_nn_tensors(t->model, &tensors, &tensor_count, &notes, &note_count));
    ptie_status status = PTIE_OK;
    for (size_t i = 0; i < tensor_count && status == PTIE_OK; i++)
        for (int which = 1; which <= 2 && status == PTIE_OK; which++)
            status = restore_moment(t, file, which, &tensors[i]);
    ptie_free(tensors);
    ptie_free(notes);
    return status;
}

/* Steps, rows and samples of the epoch under way must tell the same story. */
static bool position_is_possible(const ptie_trainer *t) {
    if (t->epoch_count > (size_t)t->params->epochs) return false;
    const uint64_t before = t->epoch_count * t->steps_per_epoch;
    if (t->step < before || t->step - before > t->steps_per_epoch) return false;
    const uint64_t samples = (t->step - before) * (uint64_t)t->params->batch;
    return t->sums.samples == (samples < t->train_count ? samples : t->train_count);
}

/* "step samples loss psnr mae ssim seconds", as collect wrote them. */
static bool scan_position(ptie_trainer *t, const char *text) {
    ptie_scores *sums = &t->sums;
    uint64_t *const counts[] = {&t->step, &sums->samples};
    double *const numbers[] = {&sums->loss, &sums->psnr_db, &sums->mae, &sums->ssim, &t->seconds};
    char *end;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++, text = end) {
        *counts[i] = strtoull(text, &end, 10);
        if (end == text) return false;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++, text = end) {
        *numbers[i] = ptie_scan_number(text, &end);
        if (end == text) return false;
    }
    return true;
}

static ptie_status restore_position(ptie_trainer *t, const ptie_safetensors *file) {
    const char *position, *history, *where = t->last_path.data;
    PTIE_TRY(find_note(&position, file, NOTE_POSITION, where));
    PTIE_TRY(find_note(&history, file, NOTE_HISTORY, where));

    if (!scan_position(t, position))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: damaged (expected 7 numbers)", where,
                         NOTE_POSITION);

    ptie_epoch *epochs;
    PTIE_TRY(ptie_history_parse(&epochs, &t->epoch_count, history, where));
    const bool possible = position_is_possible(t);
    if (possible) memcpy(t->epochs, epochs, t->epoch_count * sizeof *epochs);
    ptie_history_free(epochs);
    if (possible) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: step %llu does not fit the history", where,
                     NOTE_POSITION, (unsigned long long)t->step);
}

/* "avx512", or "avx512, avx2" where a run went on with other kernels: what they compute differs by
 * rounding, which is no reason to stop it on another machine. */
static ptie_status restore_kernels(ptie_trainer *t, const ptie_safetensors *file) {
    char all[64];
    const char *before = ptie_safetensors_note(file, NOTE_KERNELS);
    const char *now = ptie_cpu_name(t->engine->level);
    if (!before) return PTIE_OK;
    snprintf(all, sizeof all, strstr(before, now) ? "%s" : "%s, %s", before, now);
    return ptie_nn_set_note(t->model, NOTE_KERNELS, all);
}

static ptie_status restore_from(ptie_trainer *t, const ptie_safetensors *file) {
    const char *settings;
    PTIE_TRY(find_note(&settings, file, NOTE_SETTINGS, t->last_path.data));
    PTIE_TRY(compare_settings(t->settings.data, settings, t->last_path.data));
    PTIE_TRY(restore_position(t, file));
    PTIE_TRY(restore_model(t, file));
    PTIE_TRY(restore_kernels(t, file));
    return restore_moments(t, file);
}

ptie_status ptie_checkpoint_restore(ptie_trainer *t) {
    ptie_safetensors *file;
    PTIE_TRY(ptie_safetensors_read(&file, t->last_path.data));
    ptie_status status = restore_from(t, file);
    ptie_safetensors_free(file);
    return status;
}
