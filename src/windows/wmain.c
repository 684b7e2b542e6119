/* Where programs begin on Windows: main gets its arguments as UTF-8, and the standard files carry bytes. */
#include "src/windows/posix.h"

#include "src/windows/wide.h"

#include <windows.h>

int main(int argument_count, char **arguments);
int wmain(int argument_count, wchar_t **arguments);

/* Arguments with * and ? are patterns of ours, which the C library must not replace by files. */
int _dowildcard = 0;

/* A wrong descriptor is an error of the call, and no end of the process. */
static void ignore_parameter(const wchar_t *expression, const wchar_t *function, const wchar_t *file,
                             unsigned line, uintptr_t reserved) {
    (void)expression, (void)function, (void)file, (void)line, (void)reserved;
}

static char **narrow_arguments(int count, wchar_t **wide) {
    char **arguments = calloc((size_t)count + 1, sizeof *arguments);
    for (int i = 0; arguments != NULL && i < count; i++) {
        arguments[i] = narrow_text(wide[i]);
        if (arguments[i] == NULL) return NULL;
    }
    return arguments;
}

/* The console understands the sequences that clear a line only when it is told so. */
static void show_sequences(HANDLE console) {
    DWORD mode;
    if (GetConsoleMode(console, &mode)) SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

int wmain(int argument_count, wchar_t **wide) {
    char **arguments = narrow_arguments(argument_count, wide);
    if (arguments == NULL) {
        fputs("cscd: out of memory for the command line\n", stderr);
        return 1;
    }
    _set_invalid_parameter_handler(ignore_parameter);
    for (int file = 0; file <= 2; file++) _setmode(file, O_BINARY);
    show_sequences(GetStdHandle(STD_ERROR_HANDLE));
    const UINT page = GetConsoleOutputCP();
    SetConsoleOutputCP(CP_UTF8);
    const int code = main(argument_count, arguments);
    fflush(NULL);
    SetConsoleOutputCP(page);
    return code;
}
