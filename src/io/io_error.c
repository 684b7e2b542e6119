/* The one clear line that a failing file operation leaves behind. */
#include "src/io/io_error.h"

#include <stdarg.h>
#include <stdio.h>

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
