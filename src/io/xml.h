/* SPDX-License-Identifier: BSD-3-Clause */
/* XML as a list of values: each with the full path of its element, because a name alone (`width`)
 * stands in several places of a camera's header and means something else in each. */
#ifndef PTIE_IO_XML_H
#define PTIE_IO_XML_H

#include "base/status.h"

/* An element without children ("cih/fileInfo/date", its text) or an attribute ("OME/Image@Name").
   Prefixes of name spaces are gone; text is one line without spaces at the ends, and cut after 255
   bytes. */
typedef void (*ptie_xml_fn)(void *user, const char *path, const char *value);

/* Calls `take` for every value in order.  PTIE_EFORMAT, naming `where` and the line; PTIE_ENOMEM.
 */
ptie_status ptie_xml_read(const char *text, size_t bytes, const char *where, ptie_xml_fn take,
                          void *user);

#endif
