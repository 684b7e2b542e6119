/* The tool `cscd` as a function, for its program and for Python. */
#pragma once

/* Runs the command that the arguments name, of which the first is the program itself. It prints to stdout and stderr,
 * catches signals while it runs, and returns the exit code of the tool. */
int tool_run(int argument_count, char **arguments);
