/* Warnings about a mesh, which a person should know before trusting its results. */
#include "src/tool/common/command.h"
#include "src/tool/common/recording.h"

#include <stdio.h>

enum { COMPONENTS_NAMED = 3 };

static uint32_t file_vertex(const recording *r, uint32_t vertex) {
    return r->welded ? r->weld.file_vertex[vertex] : vertex;
}

static int append_edges(const recording *r, char *text, size_t size, uint32_t count, uint32_t first,
                        const char *what) {
    if (count == 0) return 0;
    uint32_t ends[2];
    cscd_mesh_edge(r->mesh, first, ends);
    return snprintf(text, size, ", %u %s edge%s (the first joins vertices %u and %u)", count, what,
                    count == 1 ? "" : "s", file_vertex(r, ends[0]), file_vertex(r, ends[1]));
}

static void warn_component(const recording *r, uint32_t index, const cscd_component *c) {
    char text[600] = "";
    int n = append_edges(r, text, sizeof text, c->open_edges, c->first_open_edge, "open");
    n += append_edges(r, text + n, sizeof text - (size_t)n, c->non_manifold_edges, c->first_non_manifold_edge,
                      "non-manifold");
    n += append_edges(r, text + n, sizeof text - (size_t)n, c->inconsistent_edges, c->first_inconsistent_edge,
                      "inconsistently oriented");
    if (c->non_manifold_vertices > 0)
        snprintf(text + n, sizeof text - (size_t)n, ", %u non-manifold vertices (the first is %u)",
                 c->non_manifold_vertices, file_vertex(r, c->first_non_manifold_vertex));
    warn("component %u is not a closed surface: %s; all its pairs are tested (mode all)", index, text + 2);
}

static uint32_t count_open_edges(const cscd_mesh *mesh) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++)
        sum += cscd_mesh_component(mesh, i).open_edges;
    return sum;
}

/* Would welding the vertices that are equal in the first frame leave no open edge? */
static bool welding_closes(recording *r) {
    weld welded;
    io_error error;
    const double *positions = r->file.positions;
    if (r->frames != NULL) {
        if (!animation_read(r->frames, 0, r->file_positions, &error)) return false;
        positions = r->file_positions;
    }
    if (!weld_create(positions, r->file.vertex_count, r->file.triangles, r->file.triangle_count, 0.0, &welded,
                     NULL))
        return false;
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc =
        cscd_object_of_triangles(welded.vertex_count, welded.triangle_count, welded.triangles);
    bool closes = cscd_mesh_create(r->context, &desc, 1, &mesh) == CSCD_OK && count_open_edges(mesh) == 0;
    cscd_mesh_destroy(mesh);
    weld_free(&welded);
    return closes;
}

void recording_warn(recording *r) {
    if (r->frames != NULL && animation_note(r->frames) != NULL) warn("%s", animation_note(r->frames));
    if (r->welded && r->weld.collapsed_triangles > 0)
        warn("welding collapsed %u triangle%s, left out from here on", r->weld.collapsed_triangles,
             r->weld.collapsed_triangles == 1 ? "" : "s");
    uint32_t defective = 0;
    for (uint32_t i = 0; i < cscd_mesh_component_count(r->mesh); i++) {
        cscd_component component = cscd_mesh_component(r->mesh, i);
        if (!component.closed_manifold && ++defective <= COMPONENTS_NAMED) warn_component(r, i, &component);
    }
    if (defective > COMPONENTS_NAMED) warn("%u more components are like that", defective - COMPONENTS_NAMED);
    if (!r->welded && count_open_edges(r->mesh) > 0 && welding_closes(r))
        warn("vertices are split along seams; --weld exact would close the mesh");
}
