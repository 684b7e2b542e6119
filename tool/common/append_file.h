/* A file that only grows, by whole records, and has one writer: what is in it stays, whatever ends the program. */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef struct append_file {
    const char *path;
    int file;     /* locked: nobody else appends to it. -1: none is open */
    bool regular; /* neither a device nor a terminal */
    off_t size;   /* of its whole records; 0 of a device, which holds none */
} append_file;

/* Opens a file, which is made if there is none, and locks it. Its size is all of it. On false *out holds nothing to close: it cannot
 * be written, is a pipe, or another process writes it. */
bool append_file_open(const char *path, append_file *out, io_error *error);

/* Cuts off what lies behind. */
bool append_file_cut(append_file *f, off_t size, io_error *error);

/* Adds a record. After an error the file ends with the record before. It is an error, too, if somebody else has removed, replaced or
 * changed the file. */
bool append_file_add(append_file *f, const void *record, size_t size, io_error *error);

/* In a process that only inherited the file: the lock stays with the one that opened it. */
void append_file_drop(append_file *f);

/* Closes it when it is on the disk, and still the file of that name. */
bool append_file_close(append_file *f, io_error *error);
