/* Chooses the program that run_tool runs: the tool, or one of models/. */
#pragma once

/* Makes run_tool run models/NAME, or the tool again when name is NULL. Fails the test without the
 * variables that tests/run.sh sets. */
void model_program_use(const char *name);

/* Expects that the program `name` refuses the arguments, a list up to NULL, with that exit code and one
 * line "name: ..." that contains the text, and prints nothing else. */
void model_program_refuses(const char *name, int code, const char *text, const char *const *arguments);
