/* Keeps a command from writing over what it reads. */
#include "src/cli/output_path.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool same_file(const char *a, const char *b) {
    struct stat first, second;
    if (strcmp(a, b) == 0) return true;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

static bool named_like_input(const char *path) {
    static const char *const endings[] = {".obj", ".ply", ".off", ".pc2", ".mdd"};
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        if (length >= 4 && strcasecmp(path + length - 4, endings[i]) == 0) return true;
    }
    return false;
}

bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error) {
    if (path == NULL) return true;
    for (size_t i = 0; i < other_count; i++) {
        if (others[i] != NULL && same_file(path, others[i]))
            return io_fail(error, "'%s' would overwrite '%s'", path, others[i]);
    }
    char *target = realpath(path, NULL);
    bool like_input = named_like_input(path) || (target != NULL && named_like_input(target));
    free(target);
    return !like_input ||
           io_fail(error, "'%s' is named like a mesh or a point cache; choose another name", path);
}
