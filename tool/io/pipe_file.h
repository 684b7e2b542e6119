/* Files that may be named pipes, whose other side comes when it likes: a program that is told to stop does not wait for it. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

/* While a pipe has nobody on its other side, or nothing to read, stopped is asked again and again, by any thread. When it says so,
 * the opening or reading fails with EINTR. NULL, as at the start: nobody is asked, and pipes wait as the system has it. */
void pipe_file_ask(bool (*stopped)(void));

/* As fopen with "rb", of any file. NULL: errno says why. A stream of a pipe may have no descriptor (fileno). */
FILE *pipe_file_read(const char *path);

/* As fopen with "wb", of a pipe. */
FILE *pipe_file_write(const char *path);
