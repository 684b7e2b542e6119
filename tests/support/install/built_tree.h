/* The build whose files are installed, and make for it, as a user runs it. */
#pragma once

#include <stdbool.h>

/* ROOT/CONFIG[-without-gsl] is the folder of the build. */
typedef struct built_tree {
    char root[4096], config[64];
    bool gsl;
} built_tree;

/* Reads the build from the path of the tool, which tests/run.sh gives; returns false, and says so, where it is no release. */
bool built_tree_find(built_tree *out);

/* Runs make TARGET DESTDIR=PLACE, independently of the make that may run this test. `variables` are words of the shell. */
void built_tree_make(const built_tree *build, const char *target, const char *place, const char *variables);
