/* The options of a command as a table: one row says how an option is read, where its value goes and what
 * --help says of it. */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads an option's value; false when it does not fit. `place` is that of the row; text is NULL for an option
 * without a value, given or not to be given. The readers of values that more than one command has are in option_values.h. */
typedef bool option_reader(const char *text, void *place);

typedef struct option_row {
    const char *name;    /* without its dashes: "weld" is --weld, and "o", of one letter, is -o */
    const char *value;   /* as --help shows it; NULL: the option has none; "[=...]": it may have one */
    option_reader *read; /* NULL: a row for --help only, with other values of the option above */
    size_t place;        /* offset of the value in the command's struct of options */
    const char *help;    /* NULL: --help leaves the row out, as for another spelling of an option */
} option_row;

/* A command line that is worth knowing, from the command's name on, and a sentence that says what it does. */
typedef struct option_example {
    const char *line, *does;
} option_example;

enum { OPTION_EXAMPLES = 3 }; /* of each command: before all else in --help, and in the manual page */

/* Rows that several commands have (option_values.h). --help shows them below a title. */
typedef struct option_list {
    const char *title;
    const option_row *rows; /* their places count from the struct that all these commands have */
    size_t count;
} option_list;

/* Such rows in a table. */
typedef struct shared_options {
    const option_list *list; /* NULL: none */
    size_t place;            /* offset of that struct in the command's struct of options */
} shared_options;

enum { OPTION_LISTS_MAX = 6 };

typedef struct option_table {
    const char *command;
    const char *usage;       /* the inputs, behind the name of the command in the first line of --help */
    const char *description; /* a sentence or two; --help breaks the lines */
    const option_row *rows;
    size_t count;
    shared_options shared[OPTION_LISTS_MAX]; /* behind the rows */
    option_example examples[OPTION_EXAMPLES];
} option_table;

enum { OPTION_ROWS_MAX = 80 }; /* of a table, shared ones among them */

typedef struct given_options {
    bool rows[OPTION_ROWS_MAX];       /* which rows of the table were given, its own first */
    uint64_t values[OPTION_ROWS_MAX]; /* the hash of what a row was given, in its order */
    const char *const *inputs;        /* the arguments that are no options, in their order */
    size_t input_count;
} given_options;

/* Reads the command line, from the command's name on, into the command's struct of options. False: *code is the
 * exit code to end with, after --help or an error that was printed. */
bool option_table_read(const option_table *table, int argument_count, char **arguments, void *options,
                       given_options *given, int *code);

/* Gives an option another value or its first, as if it stood at the end of the command line. False, with the reason: there is no such
 * option, or the value does not fit. */
bool option_table_set(const option_table *table, const char *name, const char *value, void *options,
                      given_options *given, io_error *error);

bool option_table_has(const option_table *table, const char *name);

/* Collects all rows of a table, shared ones behind its own, with their places in the command's struct of options. Returns the
 * number. */
size_t option_table_rows(const option_table *table, option_row rows[OPTION_ROWS_MAX]);

/* Is the option a single letter, which has one dash? */
bool option_is_letter(const option_row *row);

/* Was the option of that name given? The table must have it. */
bool option_given(const option_table *table, const given_options *given, const char *name);

/* The first option that was given and is none of those names; NULL: there is none. */
const char *option_given_beside(const option_table *table, const given_options *given,
                                const char *const *names, size_t name_count);

/* The hash of all options that were given, and of their values, but for those names. */
uint64_t option_hash_beside(const option_table *table, const given_options *given, const char *const *names,
                            size_t name_count);
