/* SPDX-License-Identifier: BSD-3-Clause */
/* INI files described by a table: one row per key says its place in a struct, its kind and its range.
   The same table reads a file, checks it, and prints it back.

     ; a comment, also with # at the start of a line
     [section]
     key = value    ; or key: value; lines may be indented and of any length */
#ifndef PTIE_BASE_INI_H
#define PTIE_BASE_INI_H

#include "base/text.h"

typedef enum ptie_ini_kind {
    PTIE_INI_QUANTITY, /* double */
    PTIE_INI_RANGE,    /* ptie_range: "2 .. 5 mm", or one value for both ends */
    PTIE_INI_INTEGER,  /* int32_t */
    PTIE_INI_BOOLEAN,  /* bool: yes no true false on off */
    PTIE_INI_CHOICE,   /* an enum (int): index into choices */
    PTIE_INI_TEXT,     /* char[text_bytes] */
    PTIE_INI_OWN       /* as `type` says */
} ptie_ini_kind;

/* A kind of value that only one table has. */
typedef struct ptie_ini_type {
    const char *(*parse)(void *field, const char *text); /* NULL, or what was expected */
    void (*print)(ptie_text *out, const void *field);
} ptie_ini_type;

typedef struct ptie_range {
    double low, high;
} ptie_range;

typedef struct ptie_ini_key {
    const char *section, *name;
    ptie_ini_kind kind;
    size_t offset;           /* of the field in the target struct */
    ptie_quantity quantity;  /* QUANTITY, RANGE */
    double low, high;        /* allowed values, both included; QUANTITY, RANGE, INTEGER */
    const char *const *choices; /* CHOICE: NULL-terminated */
    size_t text_bytes;       /* TEXT: size of the field */
    const ptie_ini_type *type; /* OWN */
    bool required;
    const char *help;        /* half a line for people, or NULL */
    const char *example;     /* value to show where none is set, or NULL */
} ptie_ini_key;

/* Sets the fields of `target` that `text` names; the others keep their value.  `where` names the file in
   messages ("lab.ini:12: wavelength: ...").  Errors: PTIE_ENAME (unknown section or key, with the
   nearest valid one), PTIE_EFORMAT (syntax, kind, unit or range), PTIE_EINVAL (a required key is
   missing). */
ptie_status ptie_ini_read(void *target, const ptie_ini_key *keys, size_t count, const char *text,
                          const char *where);

/* Appends the target as INI text that ptie_ini_read reads back to the same values.  What is not set, a quantity
   that is NaN or an empty text, is left out, and so is a section without keys. */
void ptie_ini_print(ptie_text *out, const void *target, const ptie_ini_key *keys, size_t count);

/* The same for people: each key with its help behind it; a key that is not set as a comment with its example. */
void ptie_ini_print_helped(ptie_text *out, const void *target, const ptie_ini_key *keys, size_t count);

/* Appends `text` with one key set: in the line that sets it, or in place of a comment that shows it ("; key = ..."),
   or as a new last line of its section.  Everything else stays as it was. */
void ptie_ini_edit(ptie_text *out, const char *text, const char *section, const char *key, const char *value);

#endif
