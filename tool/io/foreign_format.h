/* Files of other programs that are not read, and the way out of them. */
#pragma once

#include <stddef.h>

/* What an error says of such a file: "an Alembic archive, which is not read: export ...". NULL: it is none. The first
 * bytes decide, else the ending of the name; bytes may be NULL when only the name is known. */
const char *foreign_format_advice(const char *path, const char *bytes, size_t size);
