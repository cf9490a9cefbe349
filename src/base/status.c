/* SPDX-License-Identifier: BSD-3-Clause */
/* Statuses, their names, and this thread's message. */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <ptie/version.h>

#include "base/text.h"

static _Thread_local char message_buffer[PTIE_MESSAGE_BYTES];

const char *ptie_last_error(void) {
    return message_buffer;
}

void ptie_set_message(const char *message) {
    snprintf(message_buffer, sizeof message_buffer, "%s", message);
}

/* Words from files may hold anything: a message stays one line, and does not steer a terminal. */
static void make_printable(char *line) {
    for (; *line; line++)
        if ((unsigned char)*line < ' ' || *line == 127) *line = '?';
}

ptie_status ptie_fail(ptie_status status, const char *format, ...) {
    /* Arguments may point into the old message, so the new one is built aside. */
    char line[PTIE_MESSAGE_BYTES];
    va_list arguments;
    va_start(arguments, format);
    ptie_vprint(line, sizeof line, format, arguments);
    va_end(arguments);
    make_printable(line);
    memcpy(message_buffer, line, sizeof line);
    return status;
}

const char *ptie_status_name(ptie_status status) {
    switch (status) {
    case PTIE_OK: return "ok";
    case PTIE_EINVAL: return "invalid argument";
    case PTIE_ESIZE: return "sizes do not agree";
    case PTIE_ENAME: return "unknown name";
    case PTIE_ENOMEM: return "out of memory";
    case PTIE_EIO: return "input/output error";
    case PTIE_EEXIST: return "output exists";
    case PTIE_EFORMAT: return "bad file";
    case PTIE_EUNSUPPORTED: return "unsupported file feature";
    case PTIE_ENUMERIC: return "not a finite number";
    case PTIE_ESTATE: return "call out of order";
    case PTIE_ECANCELLED: return "cancelled";
    }
    return "unknown status";
}

ptie_status ptie_progress_report(ptie_progress progress, uint64_t done, uint64_t total,
                                 const char *note) {
    if (progress.report && progress.report(progress.user, done, total, note))
        return PTIE_FAIL(PTIE_ECANCELLED, "cancelled after %llu of %llu", (unsigned long long)done,
                         (unsigned long long)total);
    return PTIE_OK;
}

const char *ptie_version(void) {
    return PTIE_VERSION_STRING;
}
