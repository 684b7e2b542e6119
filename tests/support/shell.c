/* Runs shell commands, and returns their output or checks their exit codes. */
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

enum { COMMAND_MAX = 8192 };

/* Reads all of the pipe; the caller frees the text. */
static char *read_all(FILE *pipe) {
    size_t size = 0, capacity = 4096;
    char *text = malloc(capacity);
    assert_non_null(text);
    for (size_t count; (count = fread(text + size, 1, capacity - size - 1, pipe)) > 0;) {
        size += count;
        if (capacity - size > 1) continue;
        text = realloc(text, capacity *= 2);
        assert_non_null(text);
    }
    text[size] = '\0';
    return text;
}

static char *run_command(int code, const char *format, va_list arguments) {
    static const char both_outputs[] = "exec 2>&1; ";
    char command[COMMAND_MAX];
    int used = snprintf(command, sizeof command, "%s", both_outputs);
    int length = vsnprintf(command + used, sizeof command - (size_t)used, format, arguments);
    assert_true(length > 0 && length < (int)sizeof command - used);
    fflush(NULL);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    char *text = read_all(pipe);
    int status = pclose(pipe);
    int ended = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    if (ended != code) fail_msg("exit code %d, not %d: %s\n%s", ended, code, command + used, text);
    return text;
}

char *shell_output(int code, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *text = run_command(code, format, arguments);
    va_end(arguments);
    return text;
}

void shell(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    free(run_command(0, format, arguments));
    va_end(arguments);
}
