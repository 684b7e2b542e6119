/* The charge of conductors: how exact it is, whether its solvers agree, what they cost, and what hard meshes do to them. */
#include "benchmarks/lib/charge_trial.h"
#include "benchmarks/lib/options.h"
#include "models/shapes/catalogue.h"
#include "tool/common/plans.h"

#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: charge [options]\n"
    "\n"
    "Each solution runs in a process of its own. Peak: the greatest memory of that process, with program and mesh.\n"
    "errors  Sphere, ellipsoid, torus and cube against what is known of them: the error of the capacitance, and of the\n"
    "        density of single triangles, the largest and the root of the mean square. Order: the exponent of the\n"
    "        triangles' size with which an error has fallen since the row of the size before; 2 is a quarter of the\n"
    "        error with half the size. Its: iterations of the tree, as\n"
    "        far as they are counted: on one thread.\n"
    "ranks   tree and coarse against dense on pawn and figure: what cuts are made of is the order of the densities.\n"
    "times   Plans of the figure: milliseconds of each stage.\n"
    "hard    Needles, unwelded vertices, other scales, sheets that almost touch, and the like: solved, or what is said.\n"
    "\n"
    "  --tables NAME,...  these alone\n"
    "  --most N           triangles of the largest meshes (default 1000000)\n"
    "  --quick            meshes of 10000 triangles at most, of the dense solution 2500\n"
    "  --json OUT.json    the rows, and where they come from\n";

static const struct {
    const char *name;
    bool (*run)(const charge_limits *limits, json *out, io_error *error);
} tables[] = {{"errors", charge_print_errors},
              {"ranks", charge_print_ranks},
              {"times", charge_print_times},
              {"hard", charge_print_hard}};

enum { TABLE_COUNT = sizeof tables / sizeof *tables };

typedef struct charge_run {
    charge_limits limits;
    bool wanted[TABLE_COUNT];
    const char *json_path;
} charge_run;

static bool choose_tables(charge_run *r, const char *names) {
    char copy[64], *rest = copy;
    if (strlen(names) >= sizeof copy) return false;
    strcpy(copy, names);
    memset(r->wanted, 0, sizeof r->wanted);
    for (char *name; (name = strsep(&rest, ",")) != NULL;) {
        int i = 0;
        while (i < TABLE_COUNT && strcmp(tables[i].name, name) != 0) i++;
        if (i == TABLE_COUNT) return false;
        r->wanted[i] = true;
    }
    return true;
}

static bool read_value(charge_run *r, const char *name, const char *value) {
    if (strcmp(name, "--tables") == 0) return choose_tables(r, value);
    if (strcmp(name, "--json") == 0) {
        r->json_path = value;
        return true;
    }
    if (strcmp(name, "--most") != 0) return false;
    const unsigned long most = strtoul(value, NULL, 10);
    r->limits.most = (uint32_t)most;
    return most >= 1000 && most <= BODY_TRIANGLES_MAX;
}

static bool read_arguments(int count, char **arguments, charge_run *r) {
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "--quick") == 0) {
            r->limits = (charge_limits){10000, 2500};
            continue;
        }
        if (i + 1 == count || !read_value(r, arguments[i], arguments[i + 1])) return false;
        i++;
    }
    return true;
}

static bool run_tables(const charge_run *r, json *out, io_error *error) {
    bool good = true;
    for (int i = 0; good && i < TABLE_COUNT; i++)
        if (r->wanted[i]) good = tables[i].run(&r->limits, out, error);
    return good;
}

static bool run_all(const charge_run *r, int argument_count, char **arguments, io_error *error) {
    json out;
    if (!row_file_open(r->json_path, &out, error)) return false;
    row_file_begin(&out);
    return run_tables(r, &out, error) &&
           row_file_close(r->json_path, argument_count, arguments, 1, &out, error);
}

int main(int argument_count, char **arguments) {
    charge_run r = {.limits = {1000000, 20000}};
    io_error error = {""};
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    for (int i = 0; i < TABLE_COUNT; i++) r.wanted[i] = true;
    if (!read_arguments(argument_count, arguments, &r)) {
        fputs(help, stderr);
        return 2;
    }
    blas_kernels_own_process();
    blas_kernels_prepare(false);
    const bool good = run_all(&r, argument_count, arguments, &error);
    if (!good) fprintf(stderr, "charge: %s\n", error.text);
    return good ? 0 : 1;
}
