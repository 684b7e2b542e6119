/* Which program run_tool runs: the tool, or one of models/. */
#pragma once

/* From here on run_tool runs models/NAME, NULL: the tool again. Without the variables that tests/run.sh sets
 * the test fails. */
void model_program_use(const char *name);

/* The program `name` refuses the arguments (up to NULL) with that exit code, in one line "name: ..." that
 * holds the text, and without any other output. */
void model_program_refuses(const char *name, int code, const char *text, const char *const *arguments);
