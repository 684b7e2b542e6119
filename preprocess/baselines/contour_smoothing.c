/* Closed walks along edges, smoothed: the contours between which a cut is chosen. */
#include "preprocess/baselines/contour_smoothing.h"
#include "src/mesh/surface.h"

/* An edge is listed when it comes in with the contour, and when one of its two triangles is passed over: three times at most. */
static array_list list_arrays(contour *c) {
    const size_t edges = c->mesh->edge_count, triangles = c->mesh->triangle_count;
    return (array_list){{ARRAY(c->edges, 3 * edges), ARRAY(c->on, edges), ARRAY(c->passed, triangles),
                         ARRAY(c->crossed, triangles)}};
}

cscd_status contour_create(const cscd_mesh *mesh, contour *out) {
    contour c = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, list_arrays(&c))) return context_out_of_memory(mesh->context);
    *out = c;
    return CSCD_OK;
}

void contour_destroy(contour *c) {
    if (c->mesh != NULL) context_free_all(c->mesh->context, list_arrays(c));
    *c = (contour){.mesh = NULL};
}

void contour_clear(contour *c) {
    for (uint32_t i = 0; i < c->count; i++) c->on[c->edges[i]] = false;
    c->count = 0;
}

void contour_add(contour *c, uint32_t edge) {
    c->on[edge] = true;
    c->edges[c->count++] = edge;
}

/* Takes the contour over a triangle to its other side. */
static void pass_over(contour *c, uint32_t triangle) {
    for (int k = 0; k < 3; k++) {
        const uint32_t edge = c->mesh->triangle_edges[triangle][k];
        if (c->on[edge])
            c->on[edge] = false;
        else
            contour_add(c, edge);
    }
}

static bool has_two_sides(const contour *c, uint32_t triangle) {
    const uint32_t *edges = c->mesh->triangle_edges[triangle];
    return c->on[edges[0]] + c->on[edges[1]] + c->on[edges[2]] == 2;
}

/* Leaves each edge of the contour in the list once, and no other. */
static void list_once(contour *c) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t edge = c->edges[i];
        if (!c->on[edge]) continue;
        c->on[edge] = false;
        c->edges[kept++] = edge;
    }
    for (uint32_t i = 0; i < kept; i++) c->on[c->edges[i]] = true;
    c->count = kept;
}

void contour_smooth(contour *c) {
    const cscd_mesh *mesh = c->mesh;
    uint32_t crossed = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t edge = c->edges[i];
        for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++) {
            const uint32_t t = mesh->edge_stars[j];
            if (!c->on[edge] || c->passed[t] || !has_two_sides(c, t)) continue;
            c->passed[t] = true;
            c->crossed[crossed++] = t;
            pass_over(c, t);
        }
    }
    for (uint32_t i = 0; i < crossed; i++) c->passed[c->crossed[i]] = false;
    list_once(c);
}

double contour_length(const contour *c, const double *positions) {
    double length = 0.0;
    for (uint32_t i = 0; i < c->count; i++) length += surface_edge_length(c->mesh, positions, c->edges[i]);
    return length;
}
