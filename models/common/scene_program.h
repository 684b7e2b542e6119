/* A program that simulates scenes and writes a recording of each: its arguments, its help, its exit status.
 */
#pragma once

#include "src/io/io_error.h"

#include <stdint.h>

typedef struct scene_program {
    const char *name, *help; /* the scenes are told behind the help */
    uint32_t scene_count;
    const char *(*scene_name)(uint32_t scene);
    const char *(*scene_text)(uint32_t scene);
    bool (*record)(void *user, uint32_t scene, const char *folder, io_error *error);
    void *user;
} scene_program;

/* SCENE... FOLDER, or --help; `all` stands for all scenes. Records those that are named, in their own order,
 * and returns the exit status: 0; 1 with what went wrong on stderr; 2 for arguments that cannot be. */
int scene_program_run(const scene_program *p, int argument_count, char **arguments);

/* Where a scene is: on a terminal only, on one line, which goes when frame is frame_count. */
void scene_program_show(const char *scene_name, uint32_t frame, uint32_t frame_count);
