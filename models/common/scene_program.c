/* The common part of programs that record scenes: arguments, help and exit status; the files of a recording; a clock; an
 * allocator that counts. */
#include "models/common/scene_program.h"

#include "tool/io/mesh_file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static int print_help(const scene_program *p, FILE *stream) {
    fputs(p->help, stream);
    for (uint32_t i = 0; i < p->scene_count; i++)
        fprintf(stream, "  %-22s %s\n", p->scene_name(i), p->scene_text(i));
    return stream == stdout ? 0 : 2;
}

static bool is_wanted(const scene_program *p, uint32_t scene, int name_count, char **names) {
    for (int i = 0; i < name_count; i++) {
        if (strcmp(names[i], "all") == 0 || strcmp(names[i], p->scene_name(scene)) == 0) return true;
    }
    return false;
}

static bool is_known(const scene_program *p, char *name) {
    for (uint32_t i = 0; i < p->scene_count; i++) {
        if (is_wanted(p, i, 1, &name)) return true;
    }
    return false;
}

static int run_program(const scene_program *p, int argument_count, char **arguments) {
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) return print_help(p, stdout);
    if (argument_count < 3) return print_help(p, stderr);
    char **names = arguments + 1;
    int name_count = argument_count - 2;
    for (int i = 0; i < name_count; i++) {
        if (is_known(p, names[i])) continue;
        fprintf(stderr, "%s: no scene is called '%s'; %s --help lists them\n", p->name, names[i], p->name);
        return 2;
    }
    for (uint32_t i = 0; i < p->scene_count; i++) {
        io_error error;
        if (!is_wanted(p, i, name_count, names)) continue;
        if (p->record(p->user, i, arguments[argument_count - 1], &error)) continue;
        fprintf(stderr, "%s: %s\n", p->name, error.text);
        return 1;
    }
    return 0;
}

int scene_program_run(const scene_program *p, int argument_count, char **arguments) {
    int code = run_program(p, argument_count, arguments);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "%s: standard output: %s\n", p->name, strerror(errno));
    return 1;
}

void scene_program_show(const char *scene_name, uint32_t frame, uint32_t frame_count) {
    if (!isatty(STDERR_FILENO)) return;
    if (frame < frame_count)
        fprintf(stderr, "\r%s: frame %u of %u ", scene_name, frame + 1, frame_count);
    else
        fprintf(stderr, "\r\033[K");
    fflush(stderr);
}

/* ---- the files of a recording -------------------------------------------------------------------------- */

enum { PATH_MAX_LENGTH = 4096 };

static bool name_file(const char *folder, const char *name, const char *ending, char path[PATH_MAX_LENGTH],
                      io_error *error) {
    int length = snprintf(path, PATH_MAX_LENGTH, "%s/%s%s", folder[0] != '\0' ? folder : ".", name, ending);
    return (length > 0 && length < PATH_MAX_LENGTH) ||
           io_fail(error, "%s%s: the folder's name is too long", name, ending);
}

bool recording_write_model(const char *folder, const char *name, const char *ending, const body *b,
                           io_error *error) {
    char path[PATH_MAX_LENGTH];
    const mesh_file mesh = mesh_file_of(b->vertex_count, b->triangle_count, b->positions, b->triangles);
    return name_file(folder, name, ending, path, error) && mesh_file_write_obj(path, &mesh, error);
}

bool recording_open_frames(const char *folder, const char *name, const char *ending, uint32_t vertex_count,
                           uint32_t frame_count, point_cache_writer **out, io_error *error) {
    char path[PATH_MAX_LENGTH];
    return name_file(folder, name, ending, path, error) &&
           point_cache_writer_open(path, vertex_count, frame_count, out, error);
}

/* ---- measurements -------------------------------------------------------------------------------------- */

double clock_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* The address that malloc gave lies before the block: not every system can align memory that free takes back. */
static void *count_and_allocate(void *user, size_t size, size_t alignment) {
    ++*(uint64_t *)user;
    char *whole = size < SIZE_MAX - 2 * alignment ? malloc(size + 2 * alignment) : NULL;
    if (whole == NULL) return NULL;
    char *block = whole + 2 * alignment - (uintptr_t)whole % alignment;
    memcpy(block - sizeof whole, &whole, sizeof whole);
    return block;
}

static void free_block(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    void *whole;
    memcpy(&whole, (char *)block - sizeof whole, sizeof whole);
    free(whole);
}

cscd_allocator allocation_count_interface(uint64_t *count) {
    return (cscd_allocator){count_and_allocate, free_block, count};
}
