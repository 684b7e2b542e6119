/* Reads the folder and the ending of a path. */
#include "tool/io/path_name.h"

#include <string.h>
#include <strings.h>

const char *path_last_separator(const char *path) {
    const char *last = NULL;
    for (const char *c = path; *c != '\0'; c++)
        if (path_is_separator(*c)) last = c;
    return last;
}

size_t path_drive_length(const char *path) {
#ifdef _WIN32
    const char letter = (char)(path[0] | 0x20);
    return letter >= 'a' && letter <= 'z' && path[1] == ':' ? 2 : 0;
#else
    (void)path;
    return 0;
#endif
}

const char *path_file_name(const char *path) {
    const char *slash = path_last_separator(path);
    return slash != NULL ? slash + 1 : path;
}

bool path_has_extension(const char *path, const char *extension) {
    const char *name = path_file_name(path);
    size_t length = strlen(name), extension_length = strlen(extension);
    return length > extension_length && strcasecmp(name + length - extension_length, extension) == 0;
}

size_t path_mesh_ending(const char *path) {
    static const char *const endings[] = {".obj", ".ply", ".off", ".stl", ".glb", ".gltf", ".gii"};
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const size_t own = strlen(endings[i]);
        if (length >= own && strcasecmp(path + length - own, endings[i]) == 0) return own;
    }
    return 0;
}

/* Of frames, which may be many, as `frame-*.obj` names them, and of anything else. */
const char *path_missing_advice(const char *path) {
    const char *name = path_file_name(path);
    if (strpbrk(name, "*?[") != NULL)
        return "; no file matches it as a pattern, either; frames can also be given as their folder, or as frame_%04d.obj";
    if (strchr(name, '#') != NULL || strstr(name, "$F") != NULL || strchr(name, '<') != NULL)
        return "; the number of a frame is written %04d, as in frame_%04d.obj";
    return "";
}
