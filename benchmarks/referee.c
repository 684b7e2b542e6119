/* Our part of the comparison with other programs: writes meshes that all of them read, and lists our pairs of triangles.
 * benchmarks/referee/compare.py runs it and the others. */
#include "benchmarks/lib/made_scenes.h"
#include "cscd/cscd.h"
#include "tool/io/json.h"
#include "tool/io/mesh_file.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char help[] =
    "usage: referee scene figure|knot|spheres|scan|clean TRIANGLES OUT.off\n"
    "       referee convert MESH OUT.off\n"
    "       referee pairs MESH PAIRS.txt\n"
    "\n"
    "scene: writes a scene of benchmarks/intersections as one mesh, its coordinates rounded to single precision.\n"
    "convert: writes a mesh in the same format; coordinates have 17 digits, which are exact.\n"
    "pairs: writes a line 'a b kind shared' per pair that cscd_detector_find_intersections lists, on one thread,\n"
    "and on the standard output, as JSON, the seconds of processor time for reading the mesh and for finding the\n"
    "pairs; these include making the detector and its trees.\n";

/* ---- meshes -------------------------------------------------------------------------------------------- */

static bool write_off(const char *path, const mesh_file *mesh, io_error *error) {
    FILE *out = fopen(path, "w");
    if (out == NULL) return io_fail(error, "%s: cannot be written", path);
    fprintf(out, "OFF\n%u %u 0\n", mesh->vertex_count, mesh->triangle_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *x = mesh->positions + (size_t)v * 3;
        fprintf(out, "%.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles + (size_t)t * 3;
        fprintf(out, "3 %u %u %u\n", corners[0], corners[1], corners[2]);
    }
    bool good = ferror(out) == 0;
    good = fclose(out) == 0 && good;
    return good || io_fail(error, "%s: cannot be written", path);
}

static bool find_scene(const char *name, crossing_kind *out) {
    for (int kind = CROSSING_FIGURE; kind <= CROSSING_CLEAN; kind++) {
        *out = (crossing_kind)kind;
        if (strcmp(crossing_kind_name(*out), name) == 0) return true;
    }
    return false;
}

static bool write_scene(const char *name, const char *count, const char *path, io_error *error) {
    static const double nowhere[3];
    crossing_kind kind;
    crossing_scene s;
    body all = {0};
    unsigned long triangle_count = strtoul(count, NULL, 10);
    if (!find_scene(name, &kind)) return io_fail(error, "%s is no scene; see --help", name);
    if (triangle_count < 100 || triangle_count > 10000000)
        return io_fail(error, "'%s' triangles: expected is a number from 100 to 10000000", count);
    if (!crossing_scene_make(kind, (uint32_t)triangle_count, &s, error)) return false;
    for (uint32_t i = 0; i < s.object_count; i++) body_append(&all, &s.objects[i], nowhere);
    body_round(&all);
    mesh_file mesh = mesh_file_of(all.vertex_count, all.triangle_count, all.positions, all.triangles);
    bool good = write_off(path, &mesh, error);
    body_free(&all);
    crossing_scene_free(&s);
    return good;
}

static bool convert_mesh(const char *from, const char *to, io_error *error) {
    mesh_file mesh;
    if (!mesh_file_read(from, &mesh, error)) return false;
    bool good = write_off(to, &mesh, error);
    mesh_file_free(&mesh);
    return good;
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

static bool write_pairs(const char *path, const cscd_intersections *found, io_error *error) {
    FILE *out = fopen(path, "w");
    if (out == NULL) return io_fail(error, "%s: cannot be written", path);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        fprintf(out, "%u %u %s %u\n", pair->a, pair->b, cscd_intersection_kind_name(pair->kind),
                pair->shared);
    }
    bool good = ferror(out) == 0;
    good = fclose(out) == 0 && good;
    return good || io_fail(error, "%s: cannot be written", path);
}

typedef struct search {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_intersections found;
} search;

static cscd_status run_search(const mesh_file *file, search *out) {
    cscd_object_desc desc =
        cscd_object_of_triangles(file->vertex_count, file->triangle_count, file->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    cscd_status status = cscd_context_create(NULL, &out->context);
    if (status == CSCD_OK) status = cscd_mesh_create(out->context, &desc, 1, &out->mesh);
    if (status == CSCD_OK)
        status = cscd_detector_create(out->context, out->mesh, NULL, &options, &out->detector);
    if (status == CSCD_OK)
        status = cscd_detector_find_intersections(
            out->detector, CSCD_DOUBLES(file->positions, file->vertex_count), NULL, &out->found);
    return status;
}

static void end_search(search *s) {
    cscd_detector_destroy(s->detector);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

static double processor_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

static bool list_pairs(const char *mesh_path, const char *pairs_path, io_error *error) {
    mesh_file file;
    search s = {0};
    double since = processor_seconds();
    if (!mesh_file_read(mesh_path, &file, error)) return false;
    double read = processor_seconds() - since;
    cscd_status status = run_search(&file, &s);
    double find = processor_seconds() - since - read;
    bool good = status == CSCD_OK || io_fail(error, "%s: %s", mesh_path, cscd_status_string(status));
    good = good && write_pairs(pairs_path, &s.found, error);
    json out = {.file = stdout};
    json_begin_object(&out, NULL);
    json_integer(&out, "pairs", s.found.count);
    json_number(&out, "read_s", read);
    json_number(&out, "find_s", find);
    json_end_object(&out);
    puts("");
    end_search(&s);
    mesh_file_free(&file);
    return good;
}

int main(int argument_count, char **arguments) {
    io_error error = {""};
    bool good;
    if (argument_count == 5 && strcmp(arguments[1], "scene") == 0) {
        good = write_scene(arguments[2], arguments[3], arguments[4], &error);
    } else if (argument_count == 4 && strcmp(arguments[1], "convert") == 0) {
        good = convert_mesh(arguments[2], arguments[3], &error);
    } else if (argument_count == 4 && strcmp(arguments[1], "pairs") == 0) {
        good = list_pairs(arguments[2], arguments[3], &error);
    } else {
        fputs(help, argument_count == 2 && strcmp(arguments[1], "--help") == 0 ? stdout : stderr);
        return argument_count == 2 && strcmp(arguments[1], "--help") == 0 ? 0 : 2;
    }
    if (!good) fprintf(stderr, "referee: %s\n", error.text);
    return good ? 0 : 1;
}
