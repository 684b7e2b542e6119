/* Programs begin here on Windows: main gets its arguments as UTF-8. */
#include "tool/windows/posix.h"

#include "tool/windows/console.h"
#include "tool/windows/wide.h"

int main(int argument_count, char **arguments);
int wmain(int argument_count, wchar_t **arguments);

/* Arguments with * and ? are patterns of ours, which the C library must not replace by files. */
int _dowildcard = 0;

static char **narrow_arguments(int count, wchar_t **wide) {
    char **arguments = calloc((size_t)count + 1, sizeof *arguments);
    for (int i = 0; arguments != NULL && i < count; i++) {
        arguments[i] = narrow_text(wide[i]);
        if (arguments[i] == NULL) return NULL;
    }
    return arguments;
}

int wmain(int argument_count, wchar_t **wide) {
    char **arguments = narrow_arguments(argument_count, wide);
    if (arguments == NULL) {
        fputs("cscd: out of memory for the command line\n", stderr);
        return 1;
    }
    const unsigned page = console_begin();
    const int code = main(argument_count, arguments);
    fflush(NULL);
    console_end(page);
    return code;
}
