/* Which triangles a body may contain something of, in groups whose deepest points are looked for. */
#include "runtime/depths/deepest_points.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

typedef struct listing_work {
    deepest_finder *finder;
    const depth_facts *facts;
    const cscd_mesh *mesh;
    size_t key; /* of the cuts: all before it are of triangles that have been listed */
    bool out_of_memory;
} listing_work;

/* ---- triangles that may be buried ------------------------------------------------------------------------ */

static bool index_vertices(listing_work *w) {
    deepest_finder *d = w->finder;
    const size_t count = (size_t)w->mesh->vertex_count + 1;
    const array_list list = {{ARRAY(d->vertex_depths, room_with_spare(count))}};
    if (!memory_budget_take_all(d->budget, list)) return false;
    if (!context_renew_all(d->context, list, &d->vertex_capacity, count)) return false;
    size_t at = 0;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        d->vertex_depths[v] = at;
        while (at < w->facts->vertex_count && w->facts->vertices[at].vertex == v) at++;
    }
    d->vertex_depths[w->mesh->vertex_count] = at;
    return true;
}

static uint32_t depth_of_corner(const listing_work *w, uint32_t vertex, uint32_t body) {
    const size_t *begins = w->finder->vertex_depths;
    for (size_t i = begins[vertex]; i < begins[vertex + 1]; i++) {
        if (w->facts->vertices[i].body == body) return (uint32_t)i;
    }
    return UINT32_MAX;
}

static const double *corner_at(const listing_work *w, uint32_t triangle, uint32_t i) {
    return surface_corner(w->mesh, w->facts->found->surface->positions, triangle, i);
}

/* The greatest distance of the corners from a point. */
static double corners_reach(const double *const corners[3], const double x[3]) {
    double squared = 0.0;
    for (int i = 0; i < 3; i++) squared = max_of(squared, vec3_squared_distance(corners[i], x));
    return sqrt(squared);
}

/* No point is deeper than the farthest corner is from a point of the outer surface: the one that is nearest to some corner. Nor
 * is it deeper than the way to a corner that the body does not contain, since the outer surface lies on that way. */
static void bound_triangle(const listing_work *w, buried_triangle *t) {
    const double *corners[3];
    for (uint32_t i = 0; i < 3; i++) corners[i] = corner_at(w, t->triangle, i);
    t->low = 0.0;
    t->bound = (double)INFINITY;
    for (uint32_t i = 0; i < 3; i++) {
        double nearest[3] = {corners[i][0], corners[i][1], corners[i][2]};
        t->corners[i] = depth_of_corner(w, w->mesh->triangles[t->triangle][i], t->body);
        if (t->corners[i] != UINT32_MAX) {
            const cscd_depth *at = &w->facts->vertices[t->corners[i]];
            t->low = max_of(t->low, at->depth);
            if (at->depth > 0.0) vec3_add_scaled(at->x, at->depth, at->direction, nearest);
        }
        t->bound = min_of(t->bound, corners_reach(corners, nearest));
    }
    t->bound += w->facts->rounding;
}

static void add_triangle(listing_work *w, uint32_t triangle, uint32_t body, uint32_t patch, bool cut) {
    deepest_finder *d = w->finder;
    void *items = d->triangles;
    if (surface_area(w->mesh, w->facts->found->surface->positions, triangle) == 0.0) return;
    if (!deepest_finder_grow(d, &items, &d->triangle_capacity, d->triangle_count, sizeof *d->triangles)) {
        w->out_of_memory = true;
        return;
    }
    d->triangles = items;
    buried_triangle t = {.patch = patch,
                         .body = body,
                         .part = part_of_triangle(w->facts->labels, w->mesh, triangle),
                         .triangle = triangle,
                         .cut = cut,
                         .area = -1.0};
    bound_triangle(w, &t);
    d->triangles[d->triangle_count++] = t;
}

static bool patch_is_buried(const listing_work *w, uint32_t patch, uint32_t body) {
    const patch_finder *p = w->facts->found->patches;
    const cscd_patch *of = &p->patches[patch];
    for (uint32_t i = 0; i < of->winding_count; i++) {
        const cscd_winding *at = &p->windings[of->first_winding + i];
        if (at->body == body) return at->number >= 1;
    }
    return false;
}

static void add_whole(listing_work *w, uint32_t triangle, uint32_t patch) {
    const patch_finder *p = w->facts->found->patches;
    const cscd_patch *of = &p->patches[patch];
    for (uint32_t i = 0; i < of->winding_count; i++) {
        const cscd_winding *at = &p->windings[of->first_winding + i];
        if (at->number >= 1) add_triangle(w, triangle, at->body, patch, false);
    }
}

/* A cut triangle counts for the patch of its first corner that the body contains. */
static void add_cut(listing_work *w, uint32_t triangle, uint32_t body, size_t first_of_triangle) {
    const deepest_finder *d = w->finder;
    uint32_t patch = UINT32_MAX;
    for (size_t i = first_of_triangle; i < d->triangle_count; i++)
        if (d->triangles[i].body == body) return;
    for (uint32_t i = 3; i-- > 0;) {
        uint32_t at = w->facts->found->patches->corner_patches[(size_t)triangle * 3 + i];
        if (patch_is_buried(w, at, body)) patch = at;
    }
    add_triangle(w, triangle, body, patch, true);
}

/* Bodies that contain a corner, and those whose closed components cut the triangle. */
static void add_bodies(listing_work *w, uint32_t triangle) {
    const surface_cuts *found = w->facts->found;
    const size_t first_of_triangle = w->finder->triangle_count;
    for (uint32_t i = 0; i < 3; i++) {
        const cscd_patch *of =
            &found->patches->patches[found->patches->corner_patches[(size_t)triangle * 3 + i]];
        for (uint32_t k = 0; k < of->winding_count; k++) {
            const cscd_winding *at = &found->patches->windings[of->first_winding + k];
            if (at->number >= 1) add_cut(w, triangle, at->body, first_of_triangle);
        }
    }
    const triangle_cuts *cuts = w->facts->cuts;
    while (w->key < cuts->key_count && cuts->keys[w->key].number < triangle) w->key++;
    for (size_t i = w->key; i < cuts->key_count && cuts->keys[i].number == triangle; i++) {
        const uint64_t code = cuts->keys[i].end;
        const curve_piece *piece = &found->curves->found[code / 2];
        uint32_t other = code % 2 == 1 ? piece->a : piece->b;
        if (w->mesh->components[w->mesh->triangle_components[other]].closed_manifold)
            add_cut(w, triangle, surface_body(found->surface, other), first_of_triangle);
    }
}

static void list_triangles(listing_work *w) {
    const patch_finder *p = w->facts->found->patches;
    w->finder->triangle_count = 0;
    for (uint32_t t = 0; t < w->mesh->triangle_count && !w->out_of_memory; t++) {
        uint32_t patch = p->triangle_patches[t];
        if (patch == UINT32_MAX)
            add_bodies(w, t);
        else if (p->patches[patch].winding_count > 0)
            add_whole(w, t, patch);
    }
}

/* ---- groups ---------------------------------------------------------------------------------------------- */

static int compare_numbers(uint32_t a, uint32_t b) {
    return (a > b) - (a < b);
}

/* Below 0, 0 or above 0: the group of one comes first, both are of one group, or the reverse. */
static int compare_groups(const buried_triangle *p, const buried_triangle *q) {
    if (p->patch != q->patch) return compare_numbers(p->patch, q->patch);
    if (p->patch == UINT32_MAX && p->triangle != q->triangle)
        return compare_numbers(p->triangle, q->triangle);
    if (p->body != q->body) return compare_numbers(p->body, q->body);
    return compare_numbers(p->part, q->part);
}

static int compare_triangles(const void *a, const void *b) {
    const buried_triangle *p = a, *q = b;
    const int groups = compare_groups(p, q);
    if (groups != 0) return groups;
    if (p->bound != q->bound) return p->bound > q->bound ? -1 : 1;
    return compare_numbers(p->triangle, q->triangle);
}

static bool sort_triangles(deepest_finder *d) {
    const array_list list = {{ARRAY(d->spare_triangles, room_with_spare(d->triangle_count))}};
    if (!memory_budget_take_all(d->budget, list)) return false;
    if (!context_renew_all(d->context, list, &d->spare_capacity, d->triangle_count)) return false;
    sort_items(d->triangles, d->spare_triangles, d->triangle_count, sizeof *d->triangles, compare_triangles);
    return true;
}

static void list_groups(listing_work *w) {
    deepest_finder *d = w->finder;
    d->group_count = 0;
    for (size_t first = 0, end = 0; first < d->triangle_count; first = end) {
        void *items = d->groups;
        while (end < d->triangle_count && compare_groups(&d->triangles[first], &d->triangles[end]) == 0)
            end++;
        if (!deepest_finder_grow(d, &items, &d->group_capacity, d->group_count, sizeof *d->groups)) {
            w->out_of_memory = true;
            return;
        }
        d->groups = items;
        d->groups[d->group_count++] = (buried_group){first, end};
    }
}

bool deepest_finder_list(deepest_finder *d, const depth_facts *facts) {
    listing_work w = {.finder = d, .facts = facts, .mesh = facts->found->surface->mesh};
    if (!index_vertices(&w)) return false;
    list_triangles(&w);
    if (w.out_of_memory || !sort_triangles(d)) return false;
    list_groups(&w);
    return !w.out_of_memory;
}
