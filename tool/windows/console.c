/* Standard files of bytes, and a console that shows UTF-8. */
#include "tool/windows/console.h"

#include "tool/windows/posix.h"

#include <windows.h>

static void ignore_parameter(const wchar_t *expression, const wchar_t *function, const wchar_t *file,
                             unsigned line, uintptr_t reserved) {
    (void)expression, (void)function, (void)file, (void)line, (void)reserved;
}

static void show_sequences(HANDLE console) {
    DWORD mode;
    if (GetConsoleMode(console, &mode)) SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

unsigned console_begin(void) {
    _set_invalid_parameter_handler(ignore_parameter);
    for (int file = 0; file <= 2; file++) _setmode(file, O_BINARY);
    show_sequences(GetStdHandle(STD_ERROR_HANDLE));
    const unsigned page = GetConsoleOutputCP();
    SetConsoleOutputCP(CP_UTF8);
    return page;
}

void console_end(unsigned page) {
    SetConsoleOutputCP(page);
}
