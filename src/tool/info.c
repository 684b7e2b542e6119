/* `cscd info`: prints counts, components, holes and bounds of a mesh. */
#include "src/tool/common/command.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/recording.h"

#include <stdio.h>
#include <stdlib.h>

static const option_row rows[] = {
    {"weld", "exact|none|EPS", read_weld, offsetof(recording_options, weld),
     "join vertices that coincide, or lie within EPS"},
};

static const option_table table = {
    "info",
    "MODEL [--weld exact|none|EPS]",
    "Prints counts, components, closedness (open edges, non-manifold places), genus and bounds of a mesh.",
    rows,
    sizeof rows / sizeof *rows,
    .examples = {{"info body.obj", "Is this mesh closed, how many components has it, and how large is it?"},
                 {"info body.obj --weld exact",
                  "The same, with vertices in the same place joined, so that seams are no open edges."},
                 {"info scan.stl --weld 0.001", "Join corners that lie within 0.001 of each other first."}}};

enum { COMPONENTS_LISTED = 50 };

static void print_bounds(const recording *r) {
    const mesh_file *file = &r->objects[0].file;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) low[k] = high[k] = file->positions[k];
    for (uint32_t v = 1; v < file->vertex_count; v++) {
        for (int k = 0; k < 3; k++) {
            double x = file->positions[(size_t)v * 3 + (size_t)k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
    }
    printf("bounds      (%g, %g, %g) to (%g, %g, %g)\n", low[0], low[1], low[2], high[0], high[1], high[2]);
}

static void print_component(const cscd_mesh *mesh, uint32_t index) {
    cscd_component c = cscd_mesh_component(mesh, index);
    printf("  %-4u %u vertices, %u edges, %u triangles, Euler characteristic %lld, ", index, c.vertex_count,
           c.edge_count, c.triangle_count, (long long)c.euler_characteristic);
    if (c.closed_manifold) {
        printf("closed, genus %lld\n", (long long)(2 - c.euler_characteristic) / 2);
        return;
    }
    printf("not a closed surface: %u open edges, %u non-manifold edges, %u non-manifold vertices, "
           "%u inconsistently oriented edges\n",
           c.open_edges, c.non_manifold_edges, c.non_manifold_vertices, c.inconsistent_edges);
}

static void print_mesh(const recording *r) {
    uint32_t components = cscd_mesh_component_count(r->mesh), surface_vertices = 0;
    for (uint32_t i = 0; i < components; i++)
        surface_vertices += cscd_mesh_component(r->mesh, i).vertex_count;
    printf("vertices    %u", cscd_mesh_vertex_count(r->mesh));
    if (surface_vertices < cscd_mesh_vertex_count(r->mesh))
        printf(" (%u of them in no triangle)", cscd_mesh_vertex_count(r->mesh) - surface_vertices);
    printf("\nedges       %u\ntriangles   %u\n", cscd_mesh_edge_count(r->mesh),
           cscd_mesh_triangle_count(r->mesh));
    print_bounds(r);
    printf("components  %u\n", components);
    for (uint32_t i = 0; i < components && i < COMPONENTS_LISTED; i++) print_component(r->mesh, i);
    if (components > COMPONENTS_LISTED) printf("  and %u more\n", components - COMPONENTS_LISTED);
}

static bool print_zero_area(recording *r, io_error *error) {
    cscd_detector *detector = NULL;
    cscd_intersections found;
    double *positions = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    bool checked = positions != NULL || io_fail(error, "out of memory");
    checked = checked && recording_read(r, 0, positions, error);
    if (checked && (cscd_detector_create(r->context, r->mesh, NULL, NULL, &detector) != CSCD_OK ||
                    cscd_detector_check(detector, CSCD_DOUBLES(positions, cscd_mesh_vertex_count(r->mesh)),
                                        &found) != CSCD_OK))
        checked = io_fail(error, "%s", cscd_context_detail(r->context));
    if (checked) {
        printf("zero area   %u triangles\npairs       %zu of triangles intersect or touch (see cscd check)\n",
               found.zero_area_triangles, found.count);
    }
    cscd_detector_destroy(detector);
    free(positions);
    return checked;
}

int command_info(int argument_count, char **arguments) {
    recording_options source = {.thread_count = 1};
    given_options given;
    int code;
    if (!option_table_read(&table, argument_count, arguments, &source, &given, &code)) return code;
    if (given.input_count != 1) return fail_usage("info", "expected one MODEL");
    recording_options_take(&source, &given);
    recording r;
    io_error error = {""};
    if (!recording_open(&source, &r, &error)) return fail_input("%s", error.text);
    print_mesh(&r);
    bool printed = print_zero_area(&r, &error);
    if (printed) recording_warn(&r);
    recording_close(&r);
    return printed ? EXIT_RAN : fail_input("%s", error.text);
}
