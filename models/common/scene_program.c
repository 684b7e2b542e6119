/* A program that simulates scenes and writes a recording of each: its arguments, its help, its exit
 * status. */
#include "models/common/scene_program.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
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
