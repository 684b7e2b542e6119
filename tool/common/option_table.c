/* The options of a command as a table: the command line and --help are read from the same rows. */
#include "tool/common/options.h"

#include "tool/common/command.h"
#include "tool/common/provenance.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

enum {
    HELP_WIDTH = 110,  /* of the lines of --help */
    LABEL_WIDTH = 32,  /* longer names and values do not move the column of the texts */
    LONG_OPTION = 256, /* getopt_long returns this and the row; letters, ':' and '?' are smaller */
    LABEL_SIZE = 100
};

bool option_is_letter(const option_row *row) {
    return row->name[1] == '\0';
}

/* All rows of a table, with the places that they have in the command's struct. */
typedef struct all_rows {
    option_row rows[OPTION_ROWS_MAX];
    size_t count;
} all_rows;

static size_t append_rows(const option_row *rows, size_t count, size_t place, option_row *all, size_t used) {
    assert(used + count <= OPTION_ROWS_MAX);
    for (size_t i = 0; i < count; i++) {
        all[used] = rows[i];
        all[used++].place += place;
    }
    return used;
}

size_t option_table_rows(const option_table *table, option_row rows[OPTION_ROWS_MAX]) {
    size_t used = append_rows(table->rows, table->count, 0, rows, 0);
    for (size_t i = 0; i < OPTION_LISTS_MAX && table->shared[i].list != NULL; i++)
        used = append_rows(table->shared[i].list->rows, table->shared[i].list->count, table->shared[i].place,
                           rows, used);
    return used;
}

static void collect_rows(const option_table *table, all_rows *all) {
    all->count = option_table_rows(table, all->rows);
}

/* ---- help ---------------------------------------------------------------------------------------------- */

/* Prints the words of a text, in lines that begin at `column`; the cursor stands at `used`. */
static void print_wrapped(const char *text, int column, int used) {
    for (size_t length; *text != '\0'; text += length) {
        size_t blanks = strspn(text, " ");
        length = blanks + strcspn(text + blanks, " \n");
        bool line_ends = *text == '\n';
        if (line_ends || used + (int)length > HELP_WIDTH) {
            printf("\n%*s", column, "");
            used = column;
            text += line_ends ? 1 : blanks;
            length -= line_ends ? 0 : blanks;
        }
        printf("%.*s", (int)length, text);
        used += (int)length;
    }
    putchar('\n');
}

/* "  --name VALUE  ", and its length. */
static int write_label(const option_row *row, char label[LABEL_SIZE]) {
    const char *value = row->value != NULL ? row->value : "";
    return snprintf(label, LABEL_SIZE, "  %s%s%s%s  ", option_is_letter(row) ? "-" : "--", row->name,
                    value[0] != '\0' && value[0] != '[' ? " " : "", value);
}

static void print_examples(const option_table *table) {
    for (size_t i = 0; i < OPTION_EXAMPLES; i++)
        printf("  cscd %s\n      %s\n", table->examples[i].line, table->examples[i].does);
    putchar('\n');
}

static int label_column(const option_table *table) {
    char label[LABEL_SIZE];
    int column = 0;
    all_rows all;
    collect_rows(table, &all);
    for (size_t i = 0; i < all.count; i++) {
        int width = write_label(&all.rows[i], label);
        if (all.rows[i].help != NULL && width > column && width <= LABEL_WIDTH) column = width;
    }
    return column;
}

static void print_rows(const option_row *rows, size_t count, int column) {
    char label[LABEL_SIZE];
    for (size_t i = 0; i < count; i++) {
        if (rows[i].help == NULL) continue;
        write_label(&rows[i], label);
        int used = printf("%-*s", column, label);
        print_wrapped(rows[i].help, column, used);
    }
}

static void print_help(const option_table *table) {
    int column = label_column(table);
    print_examples(table);
    printf("usage: cscd %s %s\n\n", table->command, table->usage);
    print_wrapped(table->description, 0, 0);
    putchar('\n');
    print_rows(table->rows, table->count, column);
    for (size_t i = 0; i < OPTION_LISTS_MAX && table->shared[i].list != NULL; i++) {
        printf("\n%s\n", table->shared[i].list->title);
        print_rows(table->shared[i].list->rows, table->shared[i].list->count, column);
    }
}

/* ---- command line -------------------------------------------------------------------------------------- */

/* The options in the form that getopt_long takes. */
typedef struct getopt_tables {
    struct option names[OPTION_ROWS_MAX + 2];
    char letters[2 * OPTION_ROWS_MAX + 2];
} getopt_tables;

static void fill_tables(const all_rows *table, getopt_tables *out) {
    size_t names = 0, letters = 0;
    out->letters[letters++] = ':'; /* getopt_long tells a missing value from an unknown option */
    for (size_t i = 0; i < table->count; i++) {
        const option_row *row = &table->rows[i];
        int has_value = row->value == NULL     ? no_argument
                        : row->value[0] == '[' ? optional_argument
                                               : required_argument;
        if (row->read == NULL) continue;
        out->names[names++] = (struct option){row->name, has_value, NULL, LONG_OPTION + (int)i};
        if (!option_is_letter(row)) continue;
        out->letters[letters++] = row->name[0];
        if (row->value != NULL) out->letters[letters++] = ':';
    }
    out->names[names++] = (struct option){"help", no_argument, NULL, LONG_OPTION + (int)table->count};
    out->names[names] = (struct option){NULL, 0, NULL, 0};
    out->letters[letters] = '\0';
}

static size_t row_of(const all_rows *table, int id) {
    if (id >= LONG_OPTION) return (size_t)(id - LONG_OPTION);
    size_t i = 0;
    while (!option_is_letter(&table->rows[i]) || table->rows[i].name[0] != id) i++;
    return i;
}

/* value: NULL for an option without one. */
static bool give_value(const all_rows *all, size_t i, const char *value, void *options, given_options *given,
                       io_error *error) {
    const option_row *row = &all->rows[i];
    const char *text = value != NULL ? value : "";
    given->rows[i] = true;
    given->values[i] = provenance_hash(given->values[i], text, strlen(text) + 1);
    return row->read(value, (char *)options + row->place) ||
           io_fail(error, "--%s cannot be '%s'; see --help", row->name, text);
}

bool option_table_read(const option_table *table, int argument_count, char **arguments, void *options,
                       given_options *given, int *code) {
    getopt_tables tables;
    all_rows all;
    collect_rows(table, &all);
    fill_tables(&all, &tables);
    *given = (given_options){.inputs = NULL};
    opterr = 0;
    optind = 1;
    for (int id; (id = getopt_long(argument_count, arguments, tables.letters, tables.names, NULL)) != -1;) {
        if (id == ':' || id == '?') {
            *code = fail_option(table->command, id, arguments);
            return false;
        }
        size_t i = row_of(&all, id);
        if (i == all.count) {
            print_help(table);
            *code = EXIT_RAN;
            return false;
        }
        io_error error;
        if (!give_value(&all, i, optarg, options, given, &error)) {
            *code = fail_usage(table->command, "%s", error.text);
            return false;
        }
    }
    given->inputs = (const char *const *)(arguments + optind);
    given->input_count = (size_t)(argument_count - optind);
    *code = EXIT_RAN;
    return true;
}

/* The count of the rows: there is none of that name. */
static size_t find_row(const all_rows *all, const char *name) {
    size_t i = 0;
    while (i < all->count && (all->rows[i].read == NULL || strcmp(all->rows[i].name, name) != 0)) i++;
    return i;
}

bool option_table_set(const option_table *table, const char *name, const char *value, void *options,
                      given_options *given, io_error *error) {
    all_rows all;
    collect_rows(table, &all);
    const size_t i = find_row(&all, name);
    if (i == all.count) return io_fail(error, "'%s' is no option of %s", name, table->command);
    const char *shown = all.rows[i].value;
    if (shown == NULL && value != NULL) return io_fail(error, "--%s takes no value; write true", name);
    if (shown != NULL && shown[0] != '[' && value == NULL) return io_fail(error, "--%s needs a value", name);
    return give_value(&all, i, value, options, given, error);
}

bool option_given(const option_table *table, const given_options *given, const char *name) {
    all_rows all;
    collect_rows(table, &all);
    const size_t i = find_row(&all, name);
    assert(i < all.count);
    return given->rows[i];
}

const char *option_given_beside(const option_table *table, const given_options *given,
                                const char *const *names, size_t name_count) {
    all_rows all;
    collect_rows(table, &all);
    for (size_t i = 0; i < all.count; i++) {
        bool named = !given->rows[i];
        for (size_t k = 0; k < name_count && !named; k++) named = strcmp(all.rows[i].name, names[k]) == 0;
        if (!named) return all.rows[i].name;
    }
    return NULL;
}

uint64_t option_hash_beside(const option_table *table, const given_options *given, const char *const *names,
                            size_t name_count) {
    uint64_t hash = PROVENANCE_HASH_START;
    all_rows all;
    collect_rows(table, &all);
    for (size_t i = 0; i < all.count; i++) {
        bool counts = given->rows[i];
        for (size_t k = 0; k < name_count && counts; k++) counts = strcmp(all.rows[i].name, names[k]) != 0;
        if (!counts) continue;
        hash = provenance_hash(hash, all.rows[i].name, strlen(all.rows[i].name) + 1);
        hash = provenance_hash(hash, &given->values[i], sizeof given->values[i]);
    }
    return hash;
}
