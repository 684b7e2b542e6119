/* Between the UTF-8 of our programs and the UTF-16 of Windows; for this folder only. */
#pragma once

#include <wchar.h>

/* A path as the wide functions take it, to be freed: absolute and with the prefix that lifts the limit of 260
 * characters where it would be reached. NULL, and errno. */
wchar_t *wide_path(const char *path);

/* Text as UTF-16, to be freed; NULL, and errno: no memory, or no UTF-8. */
wchar_t *wide_text(const char *text);

/* Text as UTF-8, to be freed; NULL: no memory. */
char *narrow_text(const wchar_t *text);

/* Sets errno to what GetLastError says, and returns -1. */
int wide_failure(void);
