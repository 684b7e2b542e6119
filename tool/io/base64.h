/* Base64, as data URIs and GIFTI files hold it. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The most bytes that length characters stand for. */
size_t base64_room(size_t length);

/* Decodes length characters to out, which has that room. Blanks and line ends may stand anywhere, and the padding at the
 * end may be missing. On false *wrong is the place of the first character that does not belong there. */
bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size, size_t *wrong);
