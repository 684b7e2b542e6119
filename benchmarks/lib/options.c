/* What programs of benchmarks have in common: a JSON file of rows and where they come from, options, and progress. */
#include "benchmarks/lib/options.h"

#include "tool/common/provenance.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

bool row_file_open(const char *path, json *out, io_error *error) {
    *out = (json){.file = NULL};
    if (path == NULL) return true;
    out->file = fopen(path, "w");
    if (out->file == NULL) return io_fail(error, "%s: %s", path, strerror(errno));
    json_begin_object(out, NULL);
    return true;
}

void row_file_begin(json *out) {
    if (out->file != NULL) json_begin_array(out, "rows");
}

bool row_file_close(const char *path, int argument_count, char **arguments, uint32_t thread_count, json *out,
                    io_error *error) {
    if (out->file == NULL) return true;
    json_end_array(out);
    json_begin_object(out, "provenance");
    provenance_write(out, argument_count, arguments, thread_count);
    json_end_object(out);
    json_end_object(out);
    fputc('\n', out->file);
    const bool written = !ferror(out->file);
    return (fclose(out->file) == 0 && written) || io_fail(error, "%s could not be written", path);
}

/* ---- options ------------------------------------------------------------------------------------------- */

static const char options_help[] =
    "  --sizes N,N,...  triangles\n"
    "  --quick          small sizes, fewer intervals\n"
    "  --intervals N    measured intervals of each size (default: from 15, small, to 5, large)\n"
    "  --body NAME      pawn (default), dumbbell, figure, ... as in docs/about/models.md\n"
    "  --shuffled       vertices and triangles in random order; default: the model's\n"
    "  --threads N      default 1\n"
    "  --simd LEVEL     auto (default), scalar, avx2, avx512, neon\n"
    "  --volume NAME    box (default), kdop14\n"
    "  --data FOLDER    with cloth_ball92.ply and so on (default: frames/ in CSCD_DATA, if that is set)\n"
    "  --json OUT.json  the rows, and where they come from\n";

static bool refuse_argument(const char *program, const char *argument, const char *why) {
    fprintf(stderr, "%s: %s %s\n", program, argument, why);
    return false;
}

/* Parses a whole number from 1 to most. */
static bool parse_number(const char *text, uint32_t most, uint32_t *out) {
    size_t digits = strspn(text, "0123456789");
    unsigned long value = digits > 0 && digits < 9 && text[digits] == '\0' ? strtoul(text, NULL, 10) : 0;
    *out = (uint32_t)value;
    return value > 0 && value <= most;
}

static bool parse_sizes(const char *text, bench_options *o) {
    char copy[256], *rest = copy;
    if (strlen(text) >= sizeof copy) return false;
    strcpy(copy, text);
    o->size_count = 0;
    for (char *item; (item = strsep(&rest, ",")) != NULL; o->size_count++) {
        if (o->size_count == SIZES_MAX || !parse_number(item, BODY_TRIANGLES_MAX, &o->sizes[o->size_count]))
            return false;
    }
    return true;
}

static bool parse_value(const char *name, const char *value, bench_options *o, bool *known) {
    *known = true;
    if (strcmp(name, "--sizes") == 0) return parse_sizes(value, o);
    if (strcmp(name, "--intervals") == 0) return parse_number(value, INTERVALS_MAX, &o->interval_count);
    if (strcmp(name, "--threads") == 0) return parse_number(value, 256, &o->thread_count);
    if (strcmp(name, "--simd") == 0) return cscd_from_name(CSCD_SIMDS, value, (uint32_t *)&o->simd);
    if (strcmp(name, "--volume") == 0) return cscd_from_name(CSCD_VOLUMES, value, (uint32_t *)&o->volume);
    if (strcmp(name, "--body") == 0) return body_kind_from_name(value, &o->kind);
    const char **text = strcmp(name, "--data") == 0   ? &o->data
                        : strcmp(name, "--json") == 0 ? &o->json_path
                                                      : NULL;
    *known = text != NULL;
    if (*known) *text = value;
    return true;
}

static bool parse_arguments(const char *program, int count, char **arguments, bench_options *o) {
    for (int i = 1; i < count; i++) {
        const char *name = arguments[i], *value = i + 1 < count ? arguments[i + 1] : "";
        bool known, *flag = strcmp(name, "--quick") == 0      ? &o->quick
                            : strcmp(name, "--shuffled") == 0 ? &o->shuffled
                                                              : NULL;
        if (flag != NULL) {
            *flag = true;
            continue;
        }
        bool good = parse_value(name, value, o, &known);
        if (!known) return refuse_argument(program, name, "is no option");
        if (i + 1 == count) return refuse_argument(program, name, "wants a value");
        if (!good) return refuse_argument(program, value, "is no value for that option");
        i++;
    }
    return true;
}

char *bench_data_folder(const char *name) {
    const char *parent = getenv("CSCD_DATA");
    if (parent == NULL || parent[0] == '\0') return NULL;
    size_t size = strlen(parent) + strlen(name) + 2;
    char *path = body_allocate(size, 1);
    snprintf(path, size, "%s/%s", parent, name);
    return path;
}

bool bench_has_data(const bench_options *o, const char *what) {
    if (o->data == NULL) printf("  %s: left out, neither --data nor CSCD_DATA names a folder\n", what);
    return o->data != NULL;
}

uint32_t bench_intervals(const bench_options *o, uint32_t triangle_count) {
    if (o->interval_count > 0) return o->interval_count;
    if (o->quick) return 5;
    return triangle_count <= 30000 ? 15 : triangle_count <= 150000 ? 9 : 5;
}

/* ---- programs ---------------------------------------------------------------------------------------- */

int bench_main(const bench_program *program, int argument_count, char **arguments) {
    bench_options o = {.thread_count = 1, .kind = BODY_PAWN};
    json out;
    io_error error;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        printf("%s%s", program->help, options_help);
        return 0;
    }
    if (!parse_arguments(program->name, argument_count, arguments, &o)) return 2;
    char *data = bench_data_folder("frames");
    if (o.data == NULL) o.data = data;
    if (o.size_count == 0) {
        o.size_count = o.quick ? program->quick_size_count : program->size_count;
        for (uint32_t i = 0; i < o.size_count; i++) o.sizes[i] = program->sizes[i];
    }
    bool good = row_file_open(o.json_path, &out, &error);
    if (good) {
        row_file_begin(&out);
        good = program->run(&o, &out, &error) &&
               row_file_close(o.json_path, argument_count, arguments, o.thread_count, &out, &error);
    }
    if (!good) fprintf(stderr, "%s: %s\n", program->name, error.text);
    free(data);
    return good ? 0 : 1;
}
