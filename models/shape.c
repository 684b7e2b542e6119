/* Writes one of the bodies as a mesh file: shape NAME [--triangles N] OUT.obj */
#include "models/shapes/catalogue.h"
#include "tool/io/mesh_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
    body_kind kind;
    uint32_t triangle_count; /* 0: the default */
    const char *path;
} request;

static void print_help(void) {
    printf("usage: shape NAME [--triangles N] OUT.obj\n\n"
           "Writes a closed surface without self-intersection, of evenly sized triangles, z up.\n\n"
           "  --triangles N   exactly that many\n\n"
           "NAME        default      from\n");
    for (int i = 0; i < BODY_KIND_COUNT; i++) {
        body_kind kind = (body_kind)i;
        printf("%-10s %8u %9u   %s\n", body_kind_name(kind), body_default_count(kind), body_least_count(kind),
               body_kind_description(kind));
    }
    printf(
        "\nup to %u triangles, an even number. A cube has 12 n^2; for it and the slab only some numbers are\n"
        "possible, and an error names the nearest.\n",
        (unsigned)BODY_TRIANGLES_MAX);
}

static int usage_error(const char *what, const char *which) {
    fprintf(stderr, "shape: %s%s; see shape --help\n", what, which);
    return 2;
}

/* Returns 0, or the exit code of a wrong count. */
static int read_count(const char *text, uint32_t *out) {
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (*text == '\0' || *end != '\0' || errno != 0 || value < 1 || value > UINT32_MAX)
        return usage_error("--triangles takes a whole number of 1 or more, not ", text);
    *out = (uint32_t)value;
    return 0;
}

static int read_arguments(int count, char **arguments, request *out) {
    const char *name = NULL;
    for (int i = 1; i < count; i++) {
        const char *argument = arguments[i];
        if (strcmp(argument, "--triangles") == 0) {
            if (++i == count) return usage_error("--triangles takes a number", "");
            int code = read_count(arguments[i], &out->triangle_count);
            if (code != 0) return code;
        } else if (argument[0] == '-')
            return usage_error("unknown option ", argument);
        else if (name == NULL)
            name = argument;
        else if (out->path == NULL)
            out->path = argument;
        else
            return usage_error("one argument too many: ", argument);
    }
    if (name == NULL) return usage_error("which body?", "");
    if (!body_kind_from_name(name, &out->kind)) return usage_error("no body is called ", name);
    if (out->path == NULL) return usage_error("where to? give a file, OUT.obj", "");
    return 0;
}

static int write_shape(int argument_count, char **arguments) {
    request wanted = {0};
    body b = {0};
    io_error error;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        print_help();
        return 0;
    }
    int code = read_arguments(argument_count, arguments, &wanted);
    if (code != 0) return code;
    if (!body_make(wanted.kind, wanted.triangle_count, &b, &error)) {
        fprintf(stderr, "shape: %s\n", error.text);
        return 1;
    }
    const mesh_file mesh = mesh_file_of(b.vertex_count, b.triangle_count, b.positions, b.triangles);
    bool written = mesh_file_write_obj(wanted.path, &mesh, &error);
    if (!written) fprintf(stderr, "shape: %s\n", error.text);
    if (written)
        printf("%s: %u vertices, %u triangles, least angle %.1f degrees\n", body_kind_name(wanted.kind),
               b.vertex_count, b.triangle_count, body_least_angle(&b));
    body_free(&b);
    return written ? 0 : 1;
}

int main(int argument_count, char **arguments) {
    int code = write_shape(argument_count, arguments);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "shape: standard output: %s\n", strerror(errno));
    return 1;
}
