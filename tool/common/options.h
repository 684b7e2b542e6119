/* The options of a command: a table, one row of which says how an option is read, where its value goes and
 * what --help says of it; the readers and rows that several commands have; and outputs, which are kept apart
 * from inputs. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads an option's value; false when it does not fit. `place` is that of the row; text is NULL for an option
 * without a value, given or not to be given. */
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

/* Rows that several commands have (below). --help shows them below a title. */
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

/* Reads the command line, from the command's name on, into the command's struct of options. False: *code is
 * the exit code to end with, after --help or an error that was printed. */
bool option_table_read(const option_table *table, int argument_count, char **arguments, void *options,
                       given_options *given, int *code);

/* Gives an option another value or its first, as if it stood at the end of the command line. False, with the
 * reason: there is no such option, or the value does not fit. */
bool option_table_set(const option_table *table, const char *name, const char *value, void *options,
                      given_options *given, io_error *error);

/* Collects all rows of a table, shared ones behind its own, with their places in the command's struct of
 * options. Returns the number. */
size_t option_table_rows(const option_table *table, option_row rows[OPTION_ROWS_MAX]);

/* True if the option is a single letter, which has one dash. */
bool option_is_letter(const option_row *row);

/* True if the option of that name was given. The table must have it. */
bool option_given(const option_table *table, const given_options *given, const char *name);

/* The first option that was given and is none of those names; NULL: there is none. */
const char *option_given_beside(const option_table *table, const given_options *given,
                                const char *const *names, size_t name_count);

/* The hash of all options that were given and of their values, those names aside. */
uint64_t option_hash_beside(const option_table *table, const given_options *given, const char *const *names,
                            size_t name_count);

/* ---- readers and rows that several commands have ------------------------------------------------------- */

/* The comment of each says what `place` points to. */
bool read_flag(const char *text, void *place);         /* bool, which becomes true; the option has no value */
bool read_text(const char *text, void *place);         /* const char * */
bool read_unsigned(const char *text, void *place);     /* uint32_t */
bool read_positive(const char *text, void *place);     /* uint32_t, 1 or more */
bool read_length(const char *text, void *place);       /* double: 0, or from 2^-300 to 2^300 */
bool read_frame_number(const char *text, void *place); /* frame_number */
bool read_frames(const char *text, void *place);       /* frame_range: A:B[:STEP] */
bool read_weld(const char *text, void *place);         /* weld_choice: exact|none|EPS */
bool read_parts_by(const char *text, void *place);     /* mesh_parts_by: object|group|material */
bool read_size(const char *text, void *place); /* size_t: bytes above 0, or with K, M, G or T behind them */
bool read_seconds(const char *text, void *place);      /* double above 0 */
bool read_picture_size(const char *text, void *place); /* picture_options: WxH */
bool read_picture_view(const char *text, void *place); /* picture_options: AZ,EL */

/* NAME|kmeans:K of --method. Without a K, *k stays as it is. */
bool parse_method(const char *text, cscd_method *method, uint32_t *k);

/* The place of a text in a list of names; false, and *out untouched, when it is not there. */
bool parse_choice(const char *text, const char *const *names, int count, int *out);

/* Their places count from the command's recording_options. */
extern const option_list object_rows; /* further objects and how they move */
extern const option_list frame_rows;  /* frames, welding, threads */

/* Its places count from the command's ignore_options. */
extern const option_list pair_rows; /* parts, and pairs that are left out */

/* As --up has it. */
typedef enum up_axis { UP_BY_FORMAT, UP_Y, UP_Z } up_axis;

/* Reads the value y or z of an option; place points to an up_axis. */
bool read_up(const char *text, void *place);

/* The axis that was given, else that of the format of the model's file, or of the programs that write it: y
 * of glTF, which defines it, and of OBJ, as exporters write it; z of STL and PLY, which come from printers
 * and scanners, and of all others. */
up_axis up_axis_choose(up_axis given, const char *model_path);

/* ---- paths --------------------------------------------------------------------------------------------- */

/* Readers of paths (const char *), by which the functions below know what a row of a table of options is: a
 * file or folder that the command reads, or one that it looks after by itself; a file that it writes, with an
 * ending of those that the row's value has; the beginning of the names of several files that it writes. */
bool read_input_path(const char *text, void *place);
bool read_output_path(const char *text, void *place);
bool read_output_stem(const char *text, void *place);

bool option_is_output(const option_row *row);

/* Outputs are not inputs, and not each other, are not named like meshes, and have the ending of their format.
 * False, with the reason and the option. */
bool output_paths_are_safe(const option_table *table, const void *options, const given_options *given,
                           io_error *error);

/* True if all files of a command can be opened for writing. See output_path_opens. */
bool output_paths_open(const option_table *table, const void *options, io_error *error);

/* Collects the paths of all outputs, NULLs among them, in the order of the table. Returns the number. */
size_t output_paths_of(const option_table *table, const void *options, const char *paths[OPTION_ROWS_MAX]);

/* False, with the reason, when `path` is one of the files in others. Links are followed, and NULLs among
 * the others are skipped. path may be NULL. */
bool output_path_differs(const char *path, const char *const *others, size_t other_count, io_error *error);

/* The same, but false also when the path is named like a mesh or a point cache, because it may then be a
 * frame of a pattern or of a folder. */
bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error);

/* False, with the reason, when the path has the ending of another format than the one that is written, which
 * `ending` names (".png"). Endings that no program knows are fine. path may be NULL. */
bool output_path_fits(const char *path, const char *ending, io_error *error);

/* True if path can be opened for writing. Its content stays as it is. A command asks this of all outputs
 * before it truncates any. path may be NULL. */
bool output_path_opens(const char *path, io_error *error);
