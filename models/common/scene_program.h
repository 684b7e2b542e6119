/* The common part of programs that record scenes: arguments, help and exit status; the files of a recording; a clock; an
 * allocator that counts. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"
#include "tool/io/io.h"
#include "tool/io/point_cache.h"

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

/* ---- the files of a recording, side by side in one folder ---------------------------------------------- */

/* A recording has a model and its frames, and the same of its scenery. Each is a file FOLDER/NAMEending; an empty folder is
 * the current one. */
bool recording_write_model(const char *folder, const char *name, const char *ending, const body *b,
                           io_error *error);
bool recording_open_frames(const char *folder, const char *name, const char *ending, uint32_t vertex_count,
                           uint32_t frame_count, point_cache_writer **out, io_error *error);

/* ---- measurements -------------------------------------------------------------------------------------- */

/* Milliseconds since some fixed moment. */
double clock_now_ms(void);

/* Returns an allocator that counts on from *count, which outlives the context. */
cscd_allocator allocation_count_interface(uint64_t *count);
