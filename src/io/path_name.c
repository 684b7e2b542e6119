/* What the name of a file says. */
#include "src/io/path_name.h"

#include <string.h>
#include <strings.h>

bool path_has_extension(const char *path, const char *extension) {
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    size_t length = strlen(name), extension_length = strlen(extension);
    return length > extension_length && strcasecmp(name + length - extension_length, extension) == 0;
}
