/* Programs that replay recordings one by one: their options, which recordings there are, and their JSON. */
#pragma once

#include "benchmarks/lib/scene_files.h"
#include "cscd/cscd.h"
#include "tool/io/json.h"

enum { RECORDINGS_MAX = 64 };

typedef struct replay_choices {
    bool quick;
    const char *json_path, *cache, *data;
    uint32_t thread_count;
    cscd_simd simd;
    const char *scenes[RECORDINGS_MAX];
    uint32_t scene_count;
} replay_choices;

typedef struct recording_program {
    const char *name, *help;
    const char *const *options; /* those of --threads and --simd that it has, then NULL */
    bool takes_cloth;           /* and the cloth of frames/ in CSCD_DATA, two frames each */
    void *state;
    /* Replays one recording, and writes its rows when out is not NULL. */
    bool (*run)(void *state, const replay_choices *o, const char *scene, json *out, io_error *error);
    /* Prints what there is to say of all of them; NULL: nothing. */
    void (*finish)(void *state);
} recording_program;

/* Is it one of our own recordings, which are made when they are missing? */
bool recording_is_own(const char *scene);

/* Opens one of the recordings that the options name. */
bool recording_program_open(const replay_choices *o, const char *scene, recording_data *out, io_error *error);

/* Runs a whole program and returns its exit status. */
int recording_program_main(const recording_program *program, int argument_count, char **arguments);
