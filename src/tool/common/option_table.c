/* The options of a command as a table: the command line and --help are read from the same rows. */
#include "src/tool/common/option_table.h"

#include "src/tool/common/command.h"

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

static bool is_letter(const option_row *row) {
    return row->name[1] == '\0';
}

/* ---- help -------------------------------------------------------------------------------------------- */

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
    return snprintf(label, LABEL_SIZE, "  %s%s%s%s  ", is_letter(row) ? "-" : "--", row->name,
                    value[0] != '\0' && value[0] != '[' ? " " : "", value);
}

static void print_examples(const option_table *table) {
    for (size_t i = 0; i < OPTION_EXAMPLES; i++)
        printf("  cscd %s\n      %s\n", table->examples[i].line, table->examples[i].does);
    putchar('\n');
}

static void print_help(const option_table *table) {
    char label[LABEL_SIZE];
    int column = 0;
    for (size_t i = 0; i < table->count; i++) {
        int width = write_label(&table->rows[i], label);
        if (table->rows[i].help != NULL && width > column && width <= LABEL_WIDTH) column = width;
    }
    print_examples(table);
    printf("usage: cscd %s %s\n\n", table->command, table->usage);
    print_wrapped(table->description, 0, 0);
    putchar('\n');
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i].help == NULL) continue;
        write_label(&table->rows[i], label);
        int used = printf("%-*s", column, label);
        print_wrapped(table->rows[i].help, column, used);
    }
}

/* ---- command line ------------------------------------------------------------------------------------ */

/* The options in the form that getopt_long takes. */
typedef struct getopt_tables {
    struct option names[OPTION_ROWS_MAX + 2];
    char letters[2 * OPTION_ROWS_MAX + 2];
} getopt_tables;

static void fill_tables(const option_table *table, getopt_tables *out) {
    size_t names = 0, letters = 0;
    out->letters[letters++] = ':'; /* getopt_long tells a missing value from an unknown option */
    for (size_t i = 0; i < table->count; i++) {
        const option_row *row = &table->rows[i];
        int has_value = row->value == NULL     ? no_argument
                        : row->value[0] == '[' ? optional_argument
                                               : required_argument;
        if (row->read == NULL) continue;
        out->names[names++] = (struct option){row->name, has_value, NULL, LONG_OPTION + (int)i};
        if (!is_letter(row)) continue;
        out->letters[letters++] = row->name[0];
        if (row->value != NULL) out->letters[letters++] = ':';
    }
    out->names[names++] = (struct option){"help", no_argument, NULL, LONG_OPTION + (int)table->count};
    out->names[names] = (struct option){NULL, 0, NULL, 0};
    out->letters[letters] = '\0';
}

static size_t row_of(const option_table *table, int id) {
    if (id >= LONG_OPTION) return (size_t)(id - LONG_OPTION);
    size_t i = 0;
    while (!is_letter(&table->rows[i]) || table->rows[i].name[0] != id) i++;
    return i;
}

bool option_table_read(const option_table *table, int argument_count, char **arguments, void *options,
                       given_options *given, int *code) {
    getopt_tables tables;
    assert(table->count <= OPTION_ROWS_MAX);
    fill_tables(table, &tables);
    *given = (given_options){.inputs = NULL};
    opterr = 0;
    optind = 1;
    for (int id; (id = getopt_long(argument_count, arguments, tables.letters, tables.names, NULL)) != -1;) {
        if (id == ':' || id == '?') {
            *code = fail_option(table->command, id, arguments);
            return false;
        }
        size_t i = row_of(table, id);
        if (i == table->count) {
            print_help(table);
            *code = EXIT_RAN;
            return false;
        }
        const option_row *row = &table->rows[i];
        given->rows[i] = true;
        if (!row->read(optarg, (char *)options + row->place)) {
            *code =
                fail_usage(table->command, "--%s cannot be '%s'", row->name, optarg != NULL ? optarg : "");
            return false;
        }
    }
    given->inputs = (const char *const *)(arguments + optind);
    given->input_count = (size_t)(argument_count - optind);
    *code = EXIT_RAN;
    return true;
}

bool option_given(const option_table *table, const given_options *given, const char *name) {
    for (size_t i = 0; i < table->count; i++)
        if (table->rows[i].read != NULL && strcmp(table->rows[i].name, name) == 0) return given->rows[i];
    assert(false);
    return false;
}
