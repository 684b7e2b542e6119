/* The process of the tool on Windows: CreateProcess with a command line, which it takes apart again. */
#include "tests/support/tool/tool_process.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <io.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <windows.h>

enum { LINE_MAX_SIZE = 65536 };

static const char *tool_path(void) {
    const char *path = getenv("CSCD_TOOL");
    if (path == NULL || access(path, F_OK) != 0)
        fail_msg("CSCD_TOOL must name the built tool, but is %s", path != NULL ? path : "not set");
    return path;
}

/* Opens a file without a name, which the tool inherits. */
static int open_capture(void) {
    char folder[MAX_PATH + 1], name[MAX_PATH + 1];
    SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, TRUE};
    assert_true(GetTempPathA(MAX_PATH + 1, folder) > 0 && GetTempFileNameA(folder, "cst", 0, name) > 0);
    const HANDLE handle = CreateFileA(
        name, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
        &inherited, CREATE_ALWAYS, FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    assert_ptr_not_equal(handle, INVALID_HANDLE_VALUE);
    return _open_osfhandle((intptr_t)handle, _O_RDWR | _O_BINARY);
}

/* Adds an argument in quotes: a backslash means itself but before a quote. */
static size_t add_argument(char *line, size_t length, const char *argument) {
    size_t slashes = 0;
    line[length++] = '"';
    for (const char *c = argument;; c++) {
        assert_true(length + 2 * slashes + 8 < LINE_MAX_SIZE);
        if (*c == '\\') {
            slashes++;
            continue;
        }
        const bool doubled = *c == '"' || *c == '\0';
        for (size_t i = 0; i < (doubled ? 2 * slashes : slashes); i++) line[length++] = '\\';
        slashes = 0;
        if (*c == '\0') break;
        if (*c == '"') line[length++] = '\\';
        line[length++] = *c;
    }
    line[length++] = '"';
    line[length++] = ' ';
    return length;
}

static wchar_t *widen_text(const char *text) {
    const int size = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
    wchar_t *wide = malloc((size_t)size * sizeof *wide);
    assert_non_null(wide);
    MultiByteToWideChar(CP_UTF8, 0, text, -1, wide, size);
    return wide;
}

tool_process tool_process_start(const char *const *arguments) {
    static char line[LINE_MAX_SIZE];
    size_t length = add_argument(line, 0, tool_path());
    for (; *arguments != NULL; arguments++) length = add_argument(line, length, *arguments);
    line[length - 1] = '\0';
    tool_process process = {.out = open_capture(), .error = open_capture()};
    STARTUPINFOW start = {.cb = sizeof start, .dwFlags = STARTF_USESTDHANDLES};
    start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
    start.hStdOutput = (HANDLE)_get_osfhandle(process.out);
    start.hStdError = (HANDLE)_get_osfhandle(process.error);
    PROCESS_INFORMATION made;
    wchar_t *wide = widen_text(line);
    fflush(NULL);
    if (!CreateProcessW(NULL, wide, NULL, NULL, TRUE, CREATE_NO_WINDOW, NULL, NULL, &start, &made))
        fail_msg("the tool %s cannot be started", tool_path());
    free(wide);
    CloseHandle(made.hThread);
    process.pid = (pid_t)(intptr_t)made.hProcess;
    return process;
}

static char *read_capture(int descriptor) {
    const off_t size = lseek(descriptor, 0, SEEK_END);
    char *text = malloc((size_t)size + 1);
    assert_true(size >= 0 && text != NULL && lseek(descriptor, 0, SEEK_SET) == 0);
    assert_int_equal(read(descriptor, text, (unsigned)size), size);
    text[size] = '\0';
    return text;
}

tool_run tool_process_finish(tool_process *process) {
    const HANDLE handle = (HANDLE)(intptr_t)process->pid;
    DWORD code = 0;
    assert_int_equal(WaitForSingleObject(handle, INFINITE), WAIT_OBJECT_0);
    assert_true(GetExitCodeProcess(handle, &code));
    CloseHandle(handle);
    const tool_run run = {(int)code, read_capture(process->error)};
    close(process->out);
    close(process->error);
    return run;
}
