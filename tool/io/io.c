/* The ground of readers and writers of files: the line that a failure leaves behind, arrays that grow, and
 * the names of paths. */
#include "tool/io/io.h"

#include "tool/io/mesh_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- errors -------------------------------------------------------------------------------------------- */

bool io_fail(io_error *error, const char *format, ...) {
    if (error != NULL) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
        for (char *c = error->text; *c != '\0'; c++) {
            if ((unsigned char)*c < ' ' || *c == 0x7f)
                *c = '?'; /* a path may hold line breaks; the error is one line */
        }
    }
    return false;
}

/* A stream that has failed once says so for ever, but errno may be that of something else by then. */
const char *io_write_reason(void) {
    if (errno == EFBIG)
        return "File too large: a limit of the system on the size of files; raise it (ulimit -f), or write to another place";
    return strerror(errno != 0 ? errno : EIO);
}

bool io_fail_write(io_error *error, const char *path) {
    const bool standard = strcmp(path, "-") == 0;
    return io_fail(error, "%s: cannot write: %s", standard ? "standard output" : path, io_write_reason());
}

/* ---- arrays that grow ---------------------------------------------------------------------------------- */

enum { FIRST_CAPACITY = 64 };

growable growable_of(size_t element_size) {
    return (growable){.element_size = element_size};
}

void growable_free(growable *array) {
    free(array->data);
    *array = growable_of(array->element_size);
}

static bool resize_array(growable *array, size_t capacity) {
    void *data = io_realloc(array->data, capacity * array->element_size);
    if (data == NULL) return false;
    array->data = data;
    array->capacity = capacity;
    return true;
}

bool growable_reserve(growable *array, size_t capacity) {
    if (capacity <= array->capacity) return true;
    if (capacity > SIZE_MAX / array->element_size) return false;
    return resize_array(array, capacity);
}

void *io_zeroed(size_t size) {
    void *memory = io_realloc(NULL, size);
    if (memory != NULL) memset(memory, 0, size);
    return memory;
}

void *growable_push(growable *array) {
    if (array->count == array->capacity) {
        size_t most = SIZE_MAX / array->element_size;
        size_t wanted = array->capacity > most / 2 ? most : 2 * array->capacity;
        if (wanted < FIRST_CAPACITY) wanted = FIRST_CAPACITY;
        if (array->count >= most || !growable_reserve(array, wanted)) return NULL;
    }
    return (char *)array->data + array->element_size * array->count++;
}

void *growable_take(growable *array) {
    /* Failing to trim costs only memory. */
    if (array->count > 0 && array->count < array->capacity) (void)resize_array(array, array->count);
    void *data = array->data;
    *array = growable_of(array->element_size);
    return data;
}

/* ---- paths --------------------------------------------------------------------------------------------- */

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

/* Advises on frames, which may be many, as `frame-*.obj` names them, and on anything else. */
const char *path_missing_advice(const char *path) {
    const char *name = path_file_name(path);
    if (strpbrk(name, "*?[") != NULL)
        return "; no file matches it as a pattern, either; frames can also be given as their folder, or as frame_%04d.obj";
    if (strchr(name, '#') != NULL || strstr(name, "$F") != NULL || strchr(name, '<') != NULL)
        return "; the number of a frame is written %04d, as in frame_%04d.obj";
    return "";
}
