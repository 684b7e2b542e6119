/* `cscd info`: prints counts, components, holes, parts and bounds of a mesh, for people and as JSON. */
#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/part_names.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct info_options {
    recording_options source;
    const char *json_path;
} info_options;

static const option_row rows[] = {
    {"json", "OUT.json", read_output_path, offsetof(info_options, json_path),
     "write all of it, all components and repairs of the file; - is the standard output, and the text for people then "
     "goes to the standard error"},
    {"weld", "exact|none|EPS", read_weld, offsetof(info_options, source.weld),
     "join vertices that coincide, or lie within EPS"},
    {"parts-by", "object|group|material", read_parts_by, offsetof(info_options, source.parts_by),
     "which parts are listed: objects (lines o of an OBJ, nodes of a glTF), groups (lines g of an OBJ), or materials (of an OBJ and "
     "a glTF; default: what the file names: objects with their groups, or nodes)"},
};

static const option_table table = {
    "info",
    "MODEL [--weld exact|none|EPS] [--parts-by object|group|material] [--json OUT.json]",
    "Prints counts, bounds, the parts that the file names, and of each component whether it is closed (open edges, "
    "non-manifold places), its genus, and whether it is inside out.",
    rows,
    sizeof rows / sizeof *rows,
    .examples = {{"info body.obj", "Is this mesh closed, how many components has it, and how large is it?"},
                 {"info body.obj --weld exact",
                  "The same, with vertices in the same place joined, so that seams are no open edges."},
                 {"info scan.stl --json scan.json", "Write all of it for another program."}}};

enum { COMPONENTS_LISTED = 50, PARTS_LISTED = 20 };

/* The facts of a mesh that its recording does not hold. */
typedef struct mesh_facts {
    uint32_t unused_vertices; /* in no triangle */
    double low[3], high[3];   /* of the file */
    uint32_t zero_area_triangles;
    size_t pairs;             /* of triangles that intersect or touch */
    bool *turned;             /* of each component: it is inside out */
    uint32_t *part_triangles; /* of each part that the file names: its triangles */
    uint32_t rest_triangles;  /* in none of them */
} mesh_facts;

/* ---- finding ------------------------------------------------------------------------------------------- */

static void find_bounds(const mesh_file *file, mesh_facts *facts) {
    for (int k = 0; k < 3; k++) facts->low[k] = facts->high[k] = file->positions[k];
    for (uint32_t v = 1; v < file->vertex_count; v++) {
        for (int k = 0; k < 3; k++) {
            double x = file->positions[(size_t)v * 3 + (size_t)k];
            facts->low[k] = x < facts->low[k] ? x : facts->low[k];
            facts->high[k] = x > facts->high[k] ? x : facts->high[k];
        }
    }
}

static bool count_parts(const mesh_file *file, mesh_facts *facts, io_error *error) {
    facts->part_triangles = calloc((size_t)file->parts.count + 1, sizeof *facts->part_triangles);
    if (facts->part_triangles == NULL) return io_fail(error, "out of memory for %u parts", file->parts.count);
    for (uint32_t t = 0; t < file->triangle_count && file->parts.count > 0; t++) {
        const uint32_t part = file->parts.of_triangle[t];
        ++*(part != NO_MESH_PART ? &facts->part_triangles[part] : &facts->rest_triangles);
    }
    return true;
}

/* The components that are inside out are found as check does, by the parts that the file names. */
static bool ask_detector(recording *r, const part_names *parts, const double *positions, mesh_facts *facts,
                         io_error *error) {
    const uint32_t components = cscd_mesh_component_count(r->mesh);
    cscd_detector *detector = NULL;
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.patches = true;
    options.orientation = CSCD_ORIENTATION_BY_PART;
    const bool asked =
        cscd_detector_create(r->context, r->mesh, NULL, NULL, &detector) == CSCD_OK &&
        part_names_tell(parts, detector) == CSCD_OK &&
        cscd_detector_find_intersections(detector, CSCD_DOUBLES(positions, cscd_mesh_vertex_count(r->mesh)),
                                         &options, &found) == CSCD_OK;
    if (asked) {
        facts->zero_area_triangles = found.zero_area_triangles;
        facts->pairs = found.count - found.duplicate;
        for (uint32_t i = 0; found.patches->turned != NULL && i < components; i++)
            facts->turned[i] = found.patches->turned[i];
    }
    cscd_detector_destroy(detector);
    return asked || io_fail(error, "%s", cscd_context_detail(r->context));
}

static bool find_pairs(recording *r, mesh_facts *facts, io_error *error) {
    part_names parts;
    if (!part_names_find(r, NULL, &parts, error)) return false;
    double *positions = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    facts->turned = calloc((size_t)cscd_mesh_component_count(r->mesh) + 1, sizeof *facts->turned);
    bool checked = (positions != NULL && facts->turned != NULL) || io_fail(error, "out of memory");
    checked =
        checked && recording_read(r, 0, positions, error) && ask_detector(r, &parts, positions, facts, error);
    free(positions);
    part_names_free(&parts);
    return checked;
}

/* facts: to be freed by its part_triangles and its turned in any case. */
static bool find_facts(recording *r, mesh_facts *facts, io_error *error) {
    uint32_t surface_vertices = 0;
    for (uint32_t i = 0; i < cscd_mesh_component_count(r->mesh); i++)
        surface_vertices += cscd_mesh_component(r->mesh, i).vertex_count;
    facts->unused_vertices = cscd_mesh_vertex_count(r->mesh) - surface_vertices;
    find_bounds(&r->objects[0].file, facts);
    return count_parts(&r->objects[0].file, facts, error) && find_pairs(r, facts, error);
}

static long long genus_of(const cscd_component *c) {
    return (long long)(2 - c->euler_characteristic) / 2;
}

/* ---- for people ---------------------------------------------------------------------------------------- */

static void print_component(const cscd_mesh *mesh, uint32_t index, bool turned) {
    cscd_component c = cscd_mesh_component(mesh, index);
    printf("  %-4u %u vertices, %u edges, %u triangles, Euler characteristic %lld, ", index, c.vertex_count,
           c.edge_count, c.triangle_count, (long long)c.euler_characteristic);
    if (c.closed_manifold) {
        printf("closed, genus %lld%s\n", genus_of(&c), turned ? ", inside out" : "");
        return;
    }
    printf("not a closed surface: %u open edges, %u non-manifold edges, %u non-manifold vertices, "
           "%u inconsistently oriented edges\n",
           c.open_edges, c.non_manifold_edges, c.non_manifold_vertices, c.inconsistent_edges);
}

static void print_parts(const mesh_file *file, const mesh_facts *facts) {
    const uint32_t count = file->parts.count;
    printf("parts       ");
    if (count == 0) {
        printf("the file names none\n");
        return;
    }
    printf("%u: ", count);
    for (uint32_t i = 0; i < count && i < PARTS_LISTED; i++)
        printf("%s%s (%u triangle%s)", i > 0 ? ", " : "", file->parts.names[i], facts->part_triangles[i],
               facts->part_triangles[i] == 1 ? "" : "s");
    if (count > PARTS_LISTED) printf(", and %u more", count - PARTS_LISTED);
    if (facts->rest_triangles > 0) printf("; %u in none", facts->rest_triangles);
    putchar('\n');
}

static void print_facts(const recording *r, const mesh_facts *facts) {
    const uint32_t components = cscd_mesh_component_count(r->mesh);
    printf("vertices    %u", cscd_mesh_vertex_count(r->mesh));
    if (facts->unused_vertices > 0) printf(" (%u of them in no triangle)", facts->unused_vertices);
    printf("\nedges       %u\ntriangles   %u\n", cscd_mesh_edge_count(r->mesh),
           cscd_mesh_triangle_count(r->mesh));
    printf("bounds      (%g, %g, %g) to (%g, %g, %g)\n", facts->low[0], facts->low[1], facts->low[2],
           facts->high[0], facts->high[1], facts->high[2]);
    print_parts(&r->objects[0].file, facts);
    printf("components  %u\n", components);
    for (uint32_t i = 0; i < components && i < COMPONENTS_LISTED; i++)
        print_component(r->mesh, i, facts->turned[i]);
    if (components > COMPONENTS_LISTED) printf("  and %u more\n", components - COMPONENTS_LISTED);
    printf("zero area   %u triangles\npairs       %zu of triangles intersect or touch (see cscd check)\n",
           facts->zero_area_triangles, facts->pairs);
}

/* ---- JSON ---------------------------------------------------------------------------------------------- */

static void write_point(json *out, const char *key, const double x[3]) {
    json_begin_array(out, key);
    for (int k = 0; k < 3; k++) json_number(out, NULL, x[k]);
    json_end_array(out);
}

static void write_components(json *out, const cscd_mesh *mesh, const mesh_facts *facts) {
    json_begin_array(out, "components");
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++) {
        const cscd_component c = cscd_mesh_component(mesh, i);
        json_break_line(out);
        json_begin_object(out, NULL);
        json_integer(out, "vertices", c.vertex_count);
        json_integer(out, "edges", c.edge_count);
        json_integer(out, "triangles", c.triangle_count);
        json_signed(out, "euler_characteristic", c.euler_characteristic);
        json_boolean(out, "closed", c.closed_manifold);
        if (c.closed_manifold)
            json_signed(out, "genus", genus_of(&c));
        else
            json_null(out, "genus");
        json_boolean(out, "inside_out", facts->turned[i]);
        json_integer(out, "open_edges", c.open_edges);
        json_integer(out, "non_manifold_edges", c.non_manifold_edges);
        json_integer(out, "non_manifold_vertices", c.non_manifold_vertices);
        json_integer(out, "inconsistent_edges", c.inconsistent_edges);
        json_end_object(out);
    }
    json_end_array(out);
}

static void write_parts(json *out, const mesh_parts *parts, const mesh_facts *facts) {
    json_begin_array(out, "parts");
    for (uint32_t i = 0; i < parts->count; i++) {
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "name", parts->names[i]);
        json_integer(out, "triangles", facts->part_triangles[i]);
        json_end_object(out);
    }
    json_end_array(out);
}

static void write_repair(json *out, const char *key, uint32_t count, uint32_t first) {
    json_begin_object(out, key);
    json_integer(out, "faces", count);
    if (count > 0)
        json_integer(out, "first", first);
    else
        json_null(out, "first");
    json_end_object(out);
}

static void write_repairs(json *out, const mesh_repairs *repairs) {
    json_begin_object(out, "repairs");
    write_repair(out, "shortened", repairs->shortened, repairs->first_shortened);
    write_repair(out, "dropped", repairs->dropped, repairs->first_dropped);
    write_repair(out, "fanned", repairs->fanned, repairs->first_fanned);
    json_integer(out, "skipped_primitives", repairs->skipped_primitives);
    json_end_object(out);
}

static void write_facts(json *out, const recording *r, const mesh_facts *facts) {
    const mesh_file *file = &r->objects[0].file;
    json_begin_object(out, NULL);
    json_string(out, "file", r->objects[0].source.model_path);
    json_integer(out, "file_vertices", file->vertex_count);
    json_integer(out, "file_faces", file->polygon_count);
    json_integer(out, "vertices", cscd_mesh_vertex_count(r->mesh));
    json_integer(out, "unused_vertices", facts->unused_vertices);
    json_integer(out, "edges", cscd_mesh_edge_count(r->mesh));
    json_integer(out, "triangles", cscd_mesh_triangle_count(r->mesh));
    write_point(out, "low", facts->low);
    write_point(out, "high", facts->high);
    json_integer(out, "zero_area_triangles", facts->zero_area_triangles);
    json_integer(out, "pairs", facts->pairs);
    json_break_line(out);
    write_repairs(out, &file->repairs);
    if (file->unread != NULL)
        json_string(out, "unread", file->unread);
    else
        json_null(out, "unread");
    json_break_line(out);
    write_parts(out, &file->parts, facts);
    json_break_line(out);
    write_components(out, r->mesh, facts);
    json_end_object(out);
    fputc('\n', out->file);
}

/* ---- the command --------------------------------------------------------------------------------------- */

/* Both texts: the standard output is that of the JSON from when its file is opened. */
static bool say_facts(const info_options *options, recording *r, const mesh_facts *facts, io_error *error) {
    output_file file = {.file = NULL};
    if (options->json_path != NULL && !output_file_open(options->json_path, &file))
        return io_fail_write(error, options->json_path);
    print_facts(r, facts);
    recording_warn(r);
    if (file.file == NULL) return true;
    json out = {.file = file.file};
    write_facts(&out, r, facts);
    return output_file_close(&file, OUTPUT_WHOLE) || io_fail_write(error, options->json_path);
}

int command_info(int argument_count, char **arguments) {
    info_options options = {.json_path = NULL};
    given_options given;
    io_error error = {""};
    int code;
    if (!option_table_read(&table, argument_count, arguments, &options, &given, &code)) return code;
    if (given.input_count != 1) return fail_usage("info", "expected one MODEL");
    if (!output_paths_are_safe(&table, &options, &given, &error)) return fail_usage("info", "%s", error.text);
    recording_options_take(&options.source, &given);
    recording r;
    mesh_facts facts = {.pairs = 0};
    if (!recording_open(&options.source, &r, &error)) return fail_input("%s", error.text);
    bool said = find_facts(&r, &facts, &error) && say_facts(&options, &r, &facts, &error);
    free(facts.part_triangles);
    free(facts.turned);
    recording_close(&r);
    return said ? EXIT_RAN : fail_input("%s", error.text);
}
