/* Pairs of features that only triangles with a common vertex contain. */
#include "runtime/narrow_phase/orphan_search.h"

#include "runtime/narrow_phase/orphan_edges.h"

/* Does every triangle at vertex v share a vertex with triangle f? */
bool orphan_search_says_vertex(const cscd_mesh *mesh, uint32_t v, uint32_t f) {
    for (uint32_t i = mesh->vertex_star_offsets[v]; i < mesh->vertex_star_offsets[v + 1]; i++) {
        if (!triangles_share_vertex(mesh->triangles[mesh->vertex_stars[i]], mesh->triangles[f])) return false;
    }
    return true;
}

static bool are_orphan_edges(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (uint32_t i = mesh->edge_star_offsets[a]; i < mesh->edge_star_offsets[a + 1]; i++) {
        for (uint32_t j = mesh->edge_star_offsets[b]; j < mesh->edge_star_offsets[b + 1]; j++) {
            if (!triangles_share_vertex(mesh->triangles[mesh->edge_stars[i]],
                                        mesh->triangles[mesh->edge_stars[j]]))
                return false;
        }
    }
    return true;
}

/* ---- by the corners opposite edges ------------------------------------------------------------------------ */

void orphan_search_opposites(const cscd_mesh *mesh, uint32_t edge, uint32_t out[2]) {
    uint32_t begin = mesh->edge_star_offsets[edge], count = mesh->edge_star_offsets[edge + 1] - begin;
    out[0] = out[1] = NO_CORNER;
    for (uint32_t i = 0; i < count && i < 2; i++) {
        const uint32_t *corners = mesh->triangles[mesh->edge_stars[begin + i]], *ends = mesh->edges[edge];
        for (int k = 0; k < 3; k++) {
            if (corners[k] != ends[0] && corners[k] != ends[1]) out[i] = corners[k];
        }
    }
    if (count > 2) out[1] = MANY_CORNERS;
}

static bool is_end(const uint32_t edge[2], uint32_t vertex) {
    return edge[0] == vertex || edge[1] == vertex;
}

/* Two triangles at edges that share no vertex share one if the corner opposite the one edge is an end of the other, or both
 * corners are the same. As are_orphan_edges, without a look at the triangles. */
static bool opposites_say_orphan(const orphan_search *f, uint32_t a, uint32_t b) {
    const uint32_t *ends_a = f->mesh->edges[a], *ends_b = f->mesh->edges[b], *p = f->opposites[a],
                   *q = f->opposites[b];
    if (p[1] == MANY_CORNERS || q[1] == MANY_CORNERS) return are_orphan_edges(f->mesh, a, b);
    for (int i = 0; i < 2; i++) {
        if (p[i] == NO_CORNER || is_end(ends_b, p[i])) continue;
        for (int j = 0; j < 2; j++) {
            if (q[j] != NO_CORNER && !is_end(ends_a, q[j]) && p[i] != q[j]) return false;
        }
    }
    return true;
}

bool orphan_search_says(const orphan_search *f, uint32_t a, uint32_t b) {
    return f->opposites != NULL ? opposites_say_orphan(f, a, b) : are_orphan_edges(f->mesh, a, b);
}

/* ---- the search --------------------------------------------------------------------------------------------- */

static bool all_have_enough(const orphan_search *f) {
    return f->grown != NULL && atomic_load_explicit(f->grown, memory_order_relaxed) > 2 * f->most;
}

static bool takes_too_long(const orphan_search *f) {
    return f->looks > f->looks_most ||
           (f->all_looks != NULL && atomic_load_explicit(f->all_looks, memory_order_relaxed) > f->looks_most);
}

bool orphan_search_has_enough(const orphan_search *f) {
    return f->out_of_memory || f->vf.count + f->ee.count > f->most || all_have_enough(f) || takes_too_long(f);
}

enum { LOOKS_NOTED = 1 << 14 };

void orphan_search_look(orphan_search *f, size_t triangles) {
    f->looks += triangles;
    if (f->all_looks == NULL || f->looks - f->noted < LOOKS_NOTED) return;
    atomic_fetch_add_explicit(f->all_looks, f->looks - f->noted, memory_order_relaxed);
    f->noted = f->looks;
}

static cscd_status end_search(const orphan_search *f, orphan_pairs *out, bool *too_many) {
    *out = (orphan_pairs){f->vf.items, f->ee.items, f->vf.count, f->ee.count};
    *too_many = orphan_search_has_enough(f) && !f->out_of_memory;
    if (orphan_search_has_enough(f)) orphan_pairs_free(f->mesh->context, out);
    return f->out_of_memory ? CSCD_OUT_OF_MEMORY : CSCD_OK;
}

void orphan_search_add(orphan_search *f, growing_list *list, uint32_t a, uint32_t b) {
    if (list->count == list->capacity) {
        size_t capacity = list->capacity * 2 + 64;
        uint32_t(*grown)[2] =
            context_grow(f->mesh->context, list->items, list->count, capacity, sizeof *list->items);
        f->out_of_memory |= grown == NULL;
        if (grown == NULL) return;
        if (f->grown != NULL) atomic_fetch_add(f->grown, list->count);
        list->items = grown;
        list->capacity = capacity;
    }
    list->items[list->count][0] = a;
    list->items[list->count++][1] = b;
}

/* Vertices whose triangles are not what they were, and those that have a triangle in common with one. */
enum { VERTEX_CHANGED = 1, VERTEX_NEAR = 2 };

static bool vertex_is_same(const orphan_search *f, uint32_t vertex) {
    return (f->marks[vertex] & VERTEX_CHANGED) == 0;
}

/* Its triangles are at both of its ends. */
static bool edge_is_same(const orphan_search *f, uint32_t edge) {
    const uint32_t *ends = f->mesh->edges[edge];
    return vertex_is_same(f, ends[0]) || vertex_is_same(f, ends[1]);
}

static bool vf_is_known(const orphan_search *f, uint32_t v, uint32_t t) {
    return f->change != NULL && vertex_is_same(f, v) && mesh_change_keeps(f->change, t);
}

static bool ee_is_known(const orphan_search *f, uint32_t a, uint32_t b) {
    return f->change != NULL && edge_is_same(f, a) && edge_is_same(f, b);
}

uint32_t orphan_search_features(const cscd_mesh *mesh, uint32_t t) {
    uint32_t features = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = mesh->triangles[t][i], edge = mesh->triangle_edges[t][i];
        features |= (uint32_t)(mesh->vertex_stars[mesh->vertex_star_offsets[vertex]] == t) << i;
        features |= (uint32_t)(mesh->edge_stars[mesh->edge_star_offsets[edge]] == t) << (3 + i);
    }
    return features;
}

/* Where all triangles are looked at, these are known for all of them. */
static uint32_t features_of(const orphan_search *f, uint32_t t) {
    return f->features != NULL ? f->features[t] : orphan_search_features(f->mesh, t);
}

static void find_edges_between(orphan_search *f, uint32_t t, uint32_t edges_t, uint32_t u, uint32_t edges_u) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 9; i++) {
        if ((edges_t >> i / 3 & edges_u >> i % 3 & 1) == 0) continue;
        uint32_t a = mesh->triangle_edges[t][i / 3], b = mesh->triangle_edges[u][i % 3];
        if (f->even != NULL && f->even[a] && f->even[b]) continue;
        if (ee_is_known(f, a, b) || edges_share_vertex(mesh->edges[a], mesh->edges[b])) continue;
        if (orphan_search_says(f, a, b)) orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
    }
}

/* Pairs the features of t, whose stars begin with it, with features of triangle u; for edges u is the first of the
 * other star, too. So each pair is looked at once. */
static void find_between(orphan_search *f, uint32_t t, uint32_t features, uint32_t u) {
    const cscd_mesh *mesh = f->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[t][i];
        if ((features >> i & 1) != 0 && !vf_is_known(f, v, u) && !triangle_contains(mesh->triangles[u], v) &&
            orphan_search_says_vertex(mesh, v, u))
            orphan_search_add(f, &f->vf, v, u);
    }
    if (t < u && features >> 3 != 0) find_edges_between(f, t, features >> 3, u, features_of(f, u) >> 3);
}

static uint8_t marks_of(const orphan_search *f, uint32_t t) {
    const uint32_t *v = f->mesh->triangles[t];
    return f->marks[v[0]] | f->marks[v[1]] | f->marks[v[2]];
}

/* Has neither triangle a vertex that has changed? */
static bool pairs_are_known(const orphan_search *f, uint32_t t, uint32_t u) {
    return f->change != NULL && ((marks_of(f, t) | marks_of(f, u)) & VERTEX_CHANGED) == 0;
}

void orphan_search_around(orphan_search *f, uint32_t t) {
    const cscd_mesh *mesh = f->mesh;
    const uint32_t *corners = mesh->triangles[t];
    uint32_t features = features_of(f, t);
    for (int i = 0; features != 0 && i < 3; i++) {
        uint32_t begin = mesh->vertex_star_offsets[corners[i]];
        uint32_t end = mesh->vertex_star_offsets[corners[i] + 1];
        orphan_search_look(f, end - begin);
        for (uint32_t s = begin; s < end; s++) {
            uint32_t u = mesh->vertex_stars[s];
            const uint32_t *other = mesh->triangles[u];
            bool seen = (i > 0 && triangle_contains(other, corners[0])) ||
                        (i > 1 && triangle_contains(other, corners[1]));
            if (u != t && !seen && !pairs_are_known(f, t, u)) find_between(f, t, features, u);
        }
        if (orphan_search_has_enough(f)) return;
    }
}

/* ---- a mesh that was made from another one --------------------------------------------------------------- */

static uint32_t star_size(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
}

/* An obstacle has no pairs, so nothing is known of an object that was one. */
static bool was_obstacle(const cscd_mesh_change *change, const object_range *range) {
    uint32_t origin = change->objects.to_old[cscd_mesh_vertex_object(change->mesh, range->vertex)];
    return origin != UINT32_MAX && change->old_mesh->objects[origin].obstacle;
}

/* A vertex is what it was if all its triangles are, and if it has as many. */
static void mark_changed(orphan_search *f, const object_range *range) {
    const cscd_mesh_change *change = f->change;
    bool all = was_obstacle(change, range);
    for (uint32_t v = range->vertex; v < range->vertex + range->vertex_count; v++) {
        uint32_t origin = change->vertices.to_old[v];
        bool same = !all && origin != UINT32_MAX && change->vertices.to_new[origin] == v &&
                    star_size(change->old_mesh, origin) == star_size(f->mesh, v);
        if (!same) f->marks[v] |= VERTEX_CHANGED;
    }
    for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
        if (mesh_change_keeps(change, t)) continue;
        for (int i = 0; i < 3; i++) f->marks[f->mesh->triangles[t][i]] |= VERTEX_CHANGED;
    }
}

/* A pair that is not known has a feature at changed vertices only, or a triangle whose vertices have changed. So one
 * of its two adjacent triangles has a changed vertex, and both have a vertex that is near. */
static void find_in_object(orphan_search *f, const object_range *range) {
    uint32_t end = range->triangle + range->triangle_count;
    mark_changed(f, range);
    for (uint32_t t = range->triangle; t < end; t++) {
        for (int i = 0; (marks_of(f, t) & VERTEX_CHANGED) != 0 && i < 3; i++)
            f->marks[f->mesh->triangles[t][i]] |= VERTEX_NEAR;
    }
    for (uint32_t t = range->triangle; t < end && !orphan_search_has_enough(f); t++) {
        if ((marks_of(f, t) & VERTEX_NEAR) != 0 && !triangle_of_obstacle(f->mesh, t))
            orphan_search_around(f, t);
    }
}

static void keep_vf(orphan_search *f, uint32_t v, uint32_t t) {
    if (v != UINT32_MAX && t != UINT32_MAX && vf_is_known(f, v, t) && !triangle_of_obstacle(f->mesh, t))
        orphan_search_add(f, &f->vf, v, t);
}

static void keep_ee(orphan_search *f, uint32_t a, uint32_t b) {
    if (a == UINT32_MAX || b == UINT32_MAX || !ee_is_known(f, a, b)) return;
    if (!triangle_of_obstacle(f->mesh, f->mesh->edge_stars[f->mesh->edge_star_offsets[a]]))
        orphan_search_add(f, &f->ee, a < b ? a : b, a < b ? b : a);
}

/* Objects that have not changed keep all of their pairs. */
static void keep_known(orphan_search *f, const orphan_pairs *pairs) {
    const number_map *vertices = &f->change->vertices, *edges = &f->change->edges,
                     *triangles = &f->change->triangles;
    for (size_t i = 0; i < pairs->vf_count && !orphan_search_has_enough(f); i++) {
        uint32_t v = pairs->vf[i][0], t = pairs->vf[i][1];
        if (number_map_run(triangles, t) != NULL)
            orphan_search_add(f, &f->vf, number_map_to_new(vertices, v), number_map_to_new(triangles, t));
        else
            keep_vf(f, vertices->to_new[v], triangles->to_new[t]);
    }
    for (size_t i = 0; i < pairs->ee_count && !orphan_search_has_enough(f); i++) {
        uint32_t a = pairs->ee[i][0], b = pairs->ee[i][1];
        if (number_map_run(edges, a) != NULL)
            orphan_search_add(f, &f->ee, number_map_to_new(edges, a), number_map_to_new(edges, b));
        else
            keep_ee(f, edges->to_new[a], edges->to_new[b]);
    }
}

cscd_status orphan_pairs_move(const orphan_pairs *pairs, const cscd_mesh *mesh,
                              const cscd_mesh_change *change, orphan_pairs *out, bool *too_many) {
    orphan_search f = {.mesh = mesh,
                       .most = (size_t)mesh->triangle_count * ORPHANS_PER_TRIANGLE,
                       .looks_most = (size_t)mesh->triangle_count * LOOKS_PER_TRIANGLE,
                       .change = change,
                       .marks = context_allocate(mesh->context, mesh->vertex_count, sizeof *f.marks)};
    if (f.marks == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < change->described_count; i++) {
        if (change->described[i].triangle_count > 0) find_in_object(&f, &change->described[i]);
    }
    keep_known(&f, pairs);
    context_free(mesh->context, f.marks);
    return end_search(&f, out, too_many);
}

cscd_status orphan_pairs_copy(const orphan_pairs *pairs, cscd_context *context, orphan_pairs *out) {
    orphan_pairs copy = *pairs;
    array_list list = {{ARRAY(copy.vf, copy.vf_count), ARRAY(copy.ee, copy.ee_count)}};
    if (!context_copy_all(context, list)) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

void orphan_pairs_free(cscd_context *context, orphan_pairs *pairs) {
    context_free(context, pairs->vf);
    context_free(context, pairs->ee);
    *pairs = (orphan_pairs){.vf_count = 0};
}
