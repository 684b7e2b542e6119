/* Exit codes, error lines and numbers of the command line, for all commands of the tool. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum exit_code {
    EXIT_RAN = 0,
    EXIT_BAD_INPUT = 1,
    EXIT_USAGE = 2,
    EXIT_CONTACT = 3, /* found what --fail-on, --fail-depth or --max-faces asks for; not untangled */
    EXIT_UNDONE = 4   /* not all jobs of a list have run, or their results are not kept */
} exit_code;

/* After an interrupt the exit code is above this: interrupt_exit_code (terminal.h). */
enum { EXIT_INTERRUPTED = 128 };

/* Each command is given the arguments from its name on and returns an exit code. */
int command_preprocess(int argument_count, char **arguments);
int command_replay(int argument_count, char **arguments);
int command_sense(int argument_count, char **arguments);
int command_check(int argument_count, char **arguments);
int command_untangle(int argument_count, char **arguments);
int command_merge(int argument_count, char **arguments);
int command_info(int argument_count, char **arguments);
int command_report(int argument_count, char **arguments);
int command_render(int argument_count, char **arguments);

/* From now on the functions below print nothing: the last failure is kept here, warnings and notes are
 * dropped. NULL: they print again. For a job among many, whose failure is part of its answer. */
void failures_keep(io_error *place);

/* Prints one line on stderr, "cscd: ...", and returns the exit code for it. */
int fail_input(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same for jobs of which not all have a result. */
int fail_jobs(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same with a hint to COMMAND --help. */
int fail_usage(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A usage error about the option that getopt_long has just refused with ':' or '?'. */
int fail_option(const char *command, int id, char **arguments);
/* "cscd: warning: ..." on stderr. */
void warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* "cscd: ..." on stderr: what is good to know, and no fault. */
void note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Both read whole strings only. When they return false, *out is untouched. */
bool parse_unsigned(const char *text, uint32_t *out);
bool parse_integer(const char *text, int32_t *out);
bool parse_double(const char *text, double *out);

/* A number at the beginning, and where it ends. As all numbers of the command line it is decimal and finite:
 * 0x10 is none, nor 0x1p3. */
bool parse_decimal(const char *text, double *out, const char **end);
