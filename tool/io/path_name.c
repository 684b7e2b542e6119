/* Reads the folder and the ending of a path, by which it knows the formats of meshes. */
#include "tool/io/path_name.h"

#include "tool/io/mesh_format.h"

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

#define ROW_OF_FORMAT(constant, name, endings) {MESH_FORMAT_##constant, name, endings},
static const struct {
    mesh_format format;
    const char *name, *endings;
} formats[] = {MESH_FORMATS(ROW_OF_FORMAT, ROW_OF_FORMAT, ROW_OF_FORMAT)};

mesh_format mesh_format_of_path(const char *path, unsigned *length) {
    const size_t path_length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        for (const char *at = formats[i].endings; *at != '\0'; at += strspn(at, ", ")) {
            const size_t own = strcspn(at, ",");
            *length = (unsigned)own;
            if (path_length >= own && strncasecmp(path + path_length - own, at, own) == 0)
                return formats[i].format;
            at += own;
        }
    }
    *length = 0;
    return MESH_FORMAT_NONE;
}

const char *mesh_format_name(mesh_format format) {
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (formats[i].format == format) return formats[i].name;
    return "";
}

size_t path_mesh_ending(const char *path) {
    unsigned length;
    mesh_format_of_path(path, &length);
    return length;
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
