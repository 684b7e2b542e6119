/* Exit codes, error lines and numbers of the command line, for all commands of the tool. */
#include "tool/common/command.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static io_error *kept_failure; /* NULL: failures are printed */

void failures_keep(io_error *place) {
    kept_failure = place;
}

static void print_failure(const char *format, va_list arguments) __attribute__((format(printf, 1, 0)));
static void print_line(const char *prefix, const char *format, va_list arguments)
    __attribute__((format(printf, 2, 0)));

static void print_line(const char *prefix, const char *format, va_list arguments) {
    if (kept_failure != NULL) return;
    fflush(stdout);
    fputs(prefix, stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

static void print_failure(const char *format, va_list arguments) {
    if (kept_failure != NULL)
        vsnprintf(kept_failure->text, sizeof kept_failure->text, format, arguments);
    else
        print_line("cscd: ", format, arguments);
}

int fail_input(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_failure(format, arguments);
    va_end(arguments);
    return EXIT_BAD_INPUT;
}

int fail_jobs(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_failure(format, arguments);
    va_end(arguments);
    return EXIT_UNDONE;
}

int fail_usage(const char *command, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_failure(format, arguments);
    va_end(arguments);
    if (kept_failure == NULL)
        fprintf(stderr, "Try 'cscd %s%s--help'.\n", command, command[0] != '\0' ? " " : "");
    return EXIT_USAGE;
}

/* optopt is 0 after an unknown long option. A short option may stand in the middle of an argument. */
int fail_option(const char *command, int id, char **arguments) {
    const char *last = arguments[optind - 1];
    if (id == ':') return fail_usage(command, "%s needs a value", last);
    if (optopt > ' ' && optopt < 127 && strncmp(last, "--", 2) != 0)
        return fail_usage(command, "unknown option '-%c'", optopt);
    return fail_usage(command, "unknown option '%s'", last);
}

void warn(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("cscd: warning: ", format, arguments);
    va_end(arguments);
}

void note(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("cscd: ", format, arguments);
    va_end(arguments);
}

bool parse_unsigned(const char *text, uint32_t *out) {
    if (text[0] < '0' || text[0] > '9') return false;
    char *end = NULL;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (errno != 0 || *end != '\0' || value >= UINT32_MAX) return false;
    *out = (uint32_t)value;
    return true;
}

bool parse_integer(const char *text, int32_t *out) {
    const char *digits = text[0] == '-' ? text + 1 : text;
    if (digits[0] < '0' || digits[0] > '9') return false;
    char *end = NULL;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (errno != 0 || *end != '\0' || value < INT32_MIN || value > INT32_MAX) return false;
    *out = (int32_t)value;
    return true;
}

bool parse_decimal(const char *text, double *out, const char **end) {
    const size_t length = strspn(text, "0123456789.eE+-");
    char *stop = NULL;
    double value = strtod(text, &stop);
    if (stop == text || (size_t)(stop - text) > length || !isfinite(value)) return false;
    *out = value;
    *end = stop;
    return true;
}

bool parse_double(const char *text, double *out) {
    const char *end;
    double value;
    if (!parse_decimal(text, &value, &end) || *end != '\0') return false;
    *out = value;
    return true;
}
