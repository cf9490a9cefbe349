/* SPDX-License-Identifier: BSD-3-Clause */
/* New rig files, and rig files with some keys changed. */
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "rig/planes.h"
#include "rig/rig.h"
#include "rig/keys.h"

/* The keys that a rig of this set may use: sections of planes it does not have are left out. */
static size_t choose_keys(ptie_ini_key *chosen, ptie_plane_set set) {
    size_t count = 0;
    for (size_t i = 0; i < ptie_rig_key_count; i++) {
        bool unused = false;
        for (int role = 0; role < PTIE_ROLES; role++)
            unused |= !ptie_set_has(set, role) &&
                      (strcmp(ptie_rig_keys[i].section, ptie_role_names[role]) == 0 ||
                       strcmp(ptie_rig_keys[i].name, ptie_role_names[role]) == 0);
        if (!unused) chosen[count++] = ptie_rig_keys[i];
    }
    return count;
}

static ptie_status print_template(ptie_text *text, const char *set) {
    ptie_ini_key *keys;
    ptie_rig_file file;
    ptie_rig_file_defaults(&file);
    while (ptie_set_names[file.set] && strcmp(ptie_set_names[file.set], set) != 0) file.set++;
    if (!ptie_set_names[file.set])
        return PTIE_FAIL(PTIE_ENAME, "rig: set: unknown value '%.60s' (did you mean '%s'?)", set,
                         ptie_nearest_word(set, ptie_set_names));
    PTIE_TRY(ptie_alloc_status(&keys, ptie_rig_key_count, sizeof *keys, "rig"));
    const size_t count = choose_keys(keys, (ptie_plane_set)file.set);
    ptie_text_append(
        text,
        "; How the set-up is built.  'ptie rig check' compares it with a recording, 'ptie rig "
        "calibrate' measures gains and\n; registration.  Keys behind a semicolon are not set.\n\n");
    ptie_ini_print_helped(text, &file, keys, count);
    ptie_free(keys);
    return PTIE_OK;
}

/* What the settings begin with: the text of a file, or a template for their set of planes. */
static ptie_status begin(ptie_text *text, const char *from, const ptie_rig_setting *settings,
                         size_t count) {
    char *file;
    if (!from) {
        const char *set = ptie_set_names[PTIE_SET_PAIR];
        for (size_t i = 0; i < count; i++)
            if (strcmp(settings[i].key, "set") == 0) set = settings[i].value;
        return print_template(text, set);
    }
    PTIE_TRY(ptie_rig_read_text(&file, from));
    ptie_text_append(text, "%s", file);
    ptie_free(file);
    return PTIE_OK;
}

ptie_status ptie_rig_change(const char *to, const char *from, const ptie_rig_setting *settings,
                            size_t count, bool overwrite) {
    ptie_text text = {0};
    ptie_rig rig;
    ptie_status status = begin(&text, from, settings, count);
    for (size_t i = 0; i < count && status == PTIE_OK && !text.failed; i++) {
        ptie_text edited = {0};
        ptie_ini_edit(&edited, text.data, settings[i].section, settings[i].key, settings[i].value);
        ptie_text_free(&text);
        text = edited;
    }
    if (status == PTIE_OK && text.failed) status = PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", to);
    if (status == PTIE_OK) status = ptie_rig_parse(&rig, text.data, to);
    if (status == PTIE_OK) status = ptie_write_file(to, text.data, text.length, overwrite);
    ptie_text_free(&text);
    return status;
}
