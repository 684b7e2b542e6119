/* Pairs of triangles that share a vertex. Most stars are seen as a whole not to intersect themselves. */
#include "runtime/intersections/static_check.h"

#include <string.h>

static array_list star_arrays(vertex_stars *s) {
    size_t vertices = s->mesh->vertex_count, triangles = s->mesh->triangle_count;
    return (array_list){{ARRAY(s->closed, vertices), ARRAY(s->clear, vertices), ARRAY(s->normals, triangles),
                         ARRAY(s->rises, triangles)}};
}

static const uint32_t *star_of(const cscd_mesh *mesh, uint32_t vertex, uint32_t *size) {
    uint32_t begin = mesh->vertex_star_offsets[vertex];
    *size = mesh->vertex_star_offsets[vertex + 1] - begin;
    return mesh->vertex_stars + begin;
}

/* ---- closed stars -------------------------------------------------------------------------------------- */

/* A wire is no edge of a triangle. */
static bool parts_two_triangles(const cscd_mesh *mesh, uint32_t edge) {
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])mesh->triangles;
    const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge], *ends = mesh->edges[edge];
    uint32_t size = edge_star_size(mesh, edge);
    return size == 0 || (size == 2 && triangle_runs_along(triangles[star[0]], ends) !=
                                          triangle_runs_along(triangles[star[1]], ends));
}

static void mark_closed(vertex_stars *s) {
    const cscd_mesh *mesh = s->mesh;
    memset(s->closed, true, mesh->vertex_count * sizeof *s->closed);
    for (uint32_t i = 0; i < mesh->edge_count; i++) {
        if (!parts_two_triangles(mesh, i))
            s->closed[mesh->edges[i][0]] = s->closed[mesh->edges[i][1]] = false;
    }
}

cscd_status vertex_stars_create(const cscd_mesh *mesh, vertex_stars *out) {
    vertex_stars s = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, star_arrays(&s))) return CSCD_OUT_OF_MEMORY;
    mark_closed(&s);
    *out = s;
    return CSCD_OK;
}

void vertex_stars_destroy(vertex_stars *s) {
    if (s->mesh == NULL) return;
    context_free_all(s->mesh->context, star_arrays(s));
    *s = (vertex_stars){0};
}

/* ---- clear stars --------------------------------------------------------------------------------------- */

static uint32_t corner_of(const uint32_t triangle[3], uint32_t vertex) {
    return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

/* docs/theory/static-check.md, Lemma 10: the star is seen along the first axis along which all normals have one sign. */
static bool star_is_clear(const vertex_stars *s, uint32_t vertex) {
    uint32_t size, turns = 0, signs = UINT8_MAX;
    const uint32_t *star = star_of(s->mesh, vertex, &size);
    for (uint32_t i = 0; i < size; i++) signs &= s->normals[star[i]];
    if (signs == 0) return false;
    uint32_t rises = (signs & (NORMAL_SIGNS_X | NORMAL_SIGNS_Y)) != 0 ? 0 : RISES_ALONG_Y;
    for (uint32_t i = 0; i < size; i++)
        turns += s->rises[star[i]] >> (rises + corner_of(s->mesh->triangles[star[i]], vertex)) & 1;
    return turns == 1;
}

void vertex_stars_mark_clear(vertex_stars *s, uint32_t begin, uint32_t end) {
    for (uint32_t v = begin; v < end; v++) s->clear[v] = s->closed[v] && star_is_clear(s, v);
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

static bool comes_from(const vertex_stars *s, uint32_t vertex, const uint32_t a[3], const uint32_t b[3]) {
    for (int i = 0; i < 3; i++) {
        bool earlier = a[i] < vertex && !vertex_is_hub(s->mesh, a[i]);
        if ((earlier || s->clear[a[i]]) && triangle_contains(b, a[i])) return false;
    }
    return true;
}

bool vertex_stars_next_pair(const vertex_stars *s, star_cursor *c, uint32_t pair[2]) {
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])s->mesh->triangles;
    for (; c->vertex < c->end; *c = star_cursor_over(c->vertex + 1, c->end)) {
        uint32_t size;
        const uint32_t *star = star_of(s->mesh, c->vertex, &size);
        if (s->clear[c->vertex] || vertex_is_hub(s->mesh, c->vertex)) continue;
        for (; c->first + 1 < size; c->second = ++c->first + 1) {
            while (c->second < size) {
                pair[0] = star[c->first];
                pair[1] = star[c->second++];
                if (comes_from(s, c->vertex, triangles[pair[0]], triangles[pair[1]])) return true;
            }
        }
    }
    return false;
}
