/* The names of the files of an export, one for each frame. */
#include "tool/export/export_names.h"

#include "tool/io/path_name.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *export_names_stem(const char *path, const char *ending) {
    const size_t length = strlen(path);
    return strndup(path, path_has_extension(path, ending) ? length - strlen(ending) : length);
}

char *export_names_frame(const char *stem, int32_t number, const char *ending) {
    const size_t size = strlen(stem) + strlen(ending) + 16;
    char *name = malloc(size);
    if (name != NULL) snprintf(name, size, "%s_%04" PRId32 "%s", stem, number, ending);
    return name;
}

char *export_names_join(const char *stem, const char *ending) {
    const size_t size = strlen(stem) + strlen(ending) + 1;
    char *name = malloc(size);
    if (name != NULL) snprintf(name, size, "%s%s", stem, ending);
    return name;
}
