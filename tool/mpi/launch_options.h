/* The command line of cscd-mpi. */
#pragma once

#include <stdbool.h>

enum { SHARDS_MAX = 10000 }; /* their results fit on a command line */

typedef struct launch_options {
    const char *command, *results, *program; /* NULL: not given */
    int shards;                              /* 0: not given */
    bool threads, quiet, help;
    const char *resume;
    char **passed; /* for cscd */
    int passed_count;
} launch_options;

/* NULL: they are right; else what is wrong. o->passed is to be freed in both cases. */
const char *launch_options_read(int word_count, char **words, launch_options *o);

extern const char launch_help[];
