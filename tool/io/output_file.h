/* Files that are written: one that takes another's place only when it is complete, where "-" is the standard
 * output; and one that only grows. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

typedef struct output_file {
    FILE *file;       /* of regular files what was written can be read, too */
    char *target;     /* where symbolic links lead */
    char *temporary;  /* in its folder; NULL: the target is a pipe or a device, and written to itself */
    off_t whole_size; /* bytes up to the last flush */
    int cause;        /* errno of the first failure that was seen; 0: none was */
} output_file;

/* The ways in which a file ends. Whatever a path held before stays until a file takes its place. */
typedef enum output_ending {
    OUTPUT_WHOLE,       /* it takes its place, or is removed if the rest could not be written */
    OUTPUT_WHOLE_LINES, /* the same, but what the last flush had written takes its place in any case */
    OUTPUT_ABANDONED    /* it is removed */
} output_ending;

/* Opens a file that takes the place of path once it is complete, with the permissions that fopen would
 * give. "-": the standard output; what the program prints from then on goes to the standard error. On false
 * *out holds nothing to close, and errno says why. */
bool output_file_open(const char *path, output_file *out);

/* True if everything so far could be written, as far as is known yet. If not, errno says why, the same at
 * each look and at the end. */
bool output_file_writes(output_file *file);

/* Passes everything written so far to the system. The same answer. */
bool output_file_flush(output_file *file);

/* Closes, and puts the file in its place. False: not all of it is there, and errno says why. */
bool output_file_close(output_file *file, output_ending ending);

/* True if the standard output can be written to. If not, errno says why. */
bool output_file_standard_opens(void);

/* True if the path is "-". It may be NULL. */
bool output_file_is_standard(const char *path);

/* ---- files that only grow ------------------------------------------------------------------------------ */

/* A file that only grows, by whole records, and has one writer: what is in it stays, whatever ends the
 * program. */
typedef struct append_file {
    const char *path;
    int file;     /* locked: nobody else appends to it. -1: none is open */
    bool regular; /* neither a device nor a terminal */
    off_t size;   /* of its whole records; 0 of a device, which holds none */
} append_file;

/* Opens a file, which is made if there is none, and locks it. Its size is all of it. On false *out holds
 * nothing to close: it cannot be written, is a pipe, or another process writes it. */
bool append_file_open(const char *path, append_file *out, io_error *error);

/* Cuts off what lies behind. */
bool append_file_cut(append_file *f, off_t size, io_error *error);

/* Adds a record. After an error the file ends with the record before. It is an error, too, if somebody else
 * has removed, replaced or changed the file. */
bool append_file_add(append_file *f, const void *record, size_t size, io_error *error);

/* In a process that only inherited the file: the lock stays with the one that opened it. */
void append_file_drop(append_file *f);

/* Closes it when it is on the disk, and still the file of that name. */
bool append_file_close(append_file *f, io_error *error);
