/* A program that simulates scenes and writes a recording of each: its arguments, its help, its exit
 * status. */
#pragma once

#include "tool/io/io_error.h"

#include <stdint.h>

typedef struct scene_program {
    const char *name, *help; /* the list of scenes is printed after the help */
    uint32_t scene_count;
    const char *(*scene_name)(uint32_t scene);
    const char *(*scene_text)(uint32_t scene);
    bool (*record)(void *user, uint32_t scene, const char *folder, io_error *error);
    void *user;
} scene_program;

/* Takes the arguments `SCENE... FOLDER` or `--help`; `all` stands for all scenes. Records the named scenes
 * in the order of the list. Returns the exit status: 0, 1 after an error that stderr explains, 2 for wrong
 * arguments. */
int scene_program_run(const scene_program *p, int argument_count, char **arguments);

/* Shows the progress of a scene on one line of a terminal; the line goes when frame is frame_count. */
void scene_program_show(const char *scene_name, uint32_t frame, uint32_t frame_count);
