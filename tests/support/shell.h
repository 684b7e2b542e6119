/* Shell commands in tests: what they print, and how they end. */
#pragma once

/* Runs the command, made as by printf, in sh. The test fails, and prints
 * what the command printed, when its exit code is not `code`. Returns both outputs, to be freed. */
__attribute__((format(printf, 2, 3))) char *shell_output(int code, const char *format, ...);

/* The same for commands that end with 0 and whose output does not matter. */
__attribute__((format(printf, 1, 2))) void shell(const char *format, ...);
