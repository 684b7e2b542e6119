/* Runs shell commands, and returns their output or checks their exit codes. */
#pragma once

/* Runs a command, formatted as by printf, in sh. When its exit code is not `code`, the test fails and
 * prints the output. Returns both outputs together, which the caller frees. */
__attribute__((format(printf, 2, 3))) char *shell_output(int code, const char *format, ...);

/* Runs a command that must end with 0 and whose output does not matter. */
__attribute__((format(printf, 1, 2))) void shell(const char *format, ...);
