/* The one clear line that a failing file operation leaves behind. */
#include "tool/io/io_error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool io_fail(io_error *error, const char *format, ...) {
    if (error != NULL) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
        for (char *c = error->text; *c != '\0'; c++) {
            if ((unsigned char)*c < ' ' || *c == 0x7f)
                *c = '?'; /* a path may hold line breaks; the error is one line */
        }
    }
    return false;
}

/* A stream that has failed once says so for ever, but errno may be that of something else by then. */
const char *io_write_reason(void) {
    if (errno == EFBIG)
        return "File too large: a limit of the system on the size of files; raise it (ulimit -f), or write to another place";
    return strerror(errno != 0 ? errno : EIO);
}

bool io_fail_write(io_error *error, const char *path) {
    const bool standard = strcmp(path, "-") == 0;
    return io_fail(error, "%s: cannot write: %s", standard ? "standard output" : path, io_write_reason());
}
