/* A file that takes another's place only when it is complete. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

typedef struct replacing_file {
    FILE *file;
    char *target;    /* where symbolic links lead */
    char *temporary; /* in its folder; NULL: the target is a pipe or a device, and written to itself */
} replacing_file;

/* Opens a file that takes the place of path once it is complete, with the permissions that fopen would
 * give. On false *out holds nothing to close, and errno says why. */
bool replacing_file_open(const char *path, replacing_file *out);

/* complete: puts the file in its place. Else, and on failure, removes it. False: errno says why. */
bool replacing_file_close(replacing_file *file, bool complete);
