/* The deepest points of buried surfaces: one for each patch, body and part. Triangles of which bodies may contain something are
 * listed in groups, and the deepest point of each group is looked for. */
#include "runtime/depths/deepest_points.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

void deepest_finder_free(deepest_finder *d) {
    if (d->context == NULL) return;
    cscd_context *context = d->context;
    void *const blocks[] = {d->triangles, d->spare_triangles, d->cells,        d->groups,
                            d->flush,     d->spare_flush,     d->vertex_depths};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
    *d = (deepest_finder){.context = context};
}

/* Makes room for one more item of a list. False: no memory, or no room in the budget. */
static bool grow_list(deepest_finder *d, void **items, size_t *capacity, size_t count, size_t size) {
    if (!memory_budget_take(d->budget, 1, MEMORY_WHILE_DOUBLING * size)) return false;
    if (count < *capacity) return true;
    size_t larger = *capacity == 0 ? 64 : 2 * *capacity;
    void *grown = context_grow(d->context, *items, count, larger, size);
    if (grown == NULL) return false;
    *items = grown;
    *capacity = larger;
    return true;
}

/* ---- triangles that may be buried ---------------------------------------------------------------------- */

typedef struct listing_work {
    deepest_finder *finder;
    const depth_facts *facts;
    const cscd_mesh *mesh;
    size_t key; /* of the cuts: all before it are of triangles that have been listed */
    bool out_of_memory;
} listing_work;

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
    if (!grow_list(d, &items, &d->triangle_capacity, d->triangle_count, sizeof *d->triangles)) {
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

/* ---- groups -------------------------------------------------------------------------------------------- */

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
        if (!grow_list(d, &items, &d->group_capacity, d->group_count, sizeof *d->groups)) {
            w->out_of_memory = true;
            return;
        }
        d->groups = items;
        d->groups[d->group_count++] = (buried_group){first, end};
    }
}

/* Lists the triangles that bodies may contain something of, by groups. False: no memory. */
static bool list_buried(deepest_finder *d, const depth_facts *facts) {
    listing_work w = {.finder = d, .facts = facts, .mesh = facts->found->surface->mesh};
    if (!index_vertices(&w)) return false;
    list_triangles(&w);
    if (w.out_of_memory || !sort_triangles(d)) return false;
    list_groups(&w);
    return !w.out_of_memory;
}

typedef struct deepest_work {
    deepest_finder *finder;
    const depth_facts *facts;
    const cscd_mesh *mesh;
    cscd_depth *out;
    bool out_of_memory;
} deepest_work;

/* ---- what is contained of cut triangles ---------------------------------------------------------------- */

static depth_search begin_search(const deepest_work *w, uint32_t body) {
    return (depth_search){.outer = w->facts->outer,
                          .found = w->facts->found,
                          .bvh = w->facts->bvh,
                          .body = body,
                          .limit = w->facts->limit,
                          .rounding = w->facts->rounding,
                          .best = {.depth = -1.0, .nearest = {.triangle = UINT32_MAX}},
                          .best_cell = UINT32_MAX,
                          .bound = 0.0,
                          .cells_left = 200000};
}

/* The deepest corner of a group's triangles. */
static void begin_with_corners(const deepest_work *w, const buried_group *group, depth_search *s) {
    const cscd_depth *vertices = w->facts->vertices;
    for (size_t i = group->first; i < group->end; i++) {
        const buried_triangle *t = &w->finder->triangles[i];
        for (int k = 0; k < 3; k++) {
            if (t->corners[k] == UINT32_MAX) continue;
            const cscd_depth *at = &vertices[t->corners[k]];
            if (!(at->depth > s->best.depth)) continue;
            s->best.depth = at->depth;
            s->best.nearest.triangle = at->triangle;
            s->best_cell = t->triangle;
            memcpy(s->best.x, at->x, sizeof s->best.x);
            for (int j = 0; j < 3; j++) s->best.nearest.x[j] = at->x[j] + at->depth * at->direction[j];
        }
    }
}

enum { BANKS_MAX = 16 };

/* The parts of a surface that bound the depth of a triangle that a body cuts: the parts of the body's outer
 * surface that cut it, and those that are nearest to its corners. */
typedef struct cell_banks {
    outer_part parts[BANKS_MAX];
    uint32_t triangles[BANKS_MAX], count;
} cell_banks;

static void add_bank(cell_banks *banks, uint32_t triangle, const outer_part *part) {
    if (banks->count == BANKS_MAX) return;
    banks->triangles[banks->count] = triangle;
    banks->parts[banks->count++] = *part;
}

static void add_banks_of(const deepest_work *w, uint32_t triangle, cell_banks *out) {
    const outer_surface *o = w->facts->outer;
    const uint32_t place = o->places[triangle];
    if (place == OUTER_AS_A_WHOLE) {
        outer_part whole;
        outer_surface_whole(o, w->facts->found, triangle, &whole);
        add_bank(out, triangle, &whole);
    } else if (place != OUTER_NOWHERE) {
        for (size_t i = o->part_begins[place]; i < o->part_begins[place + 1]; i++)
            add_bank(out, triangle, &o->parts[i]);
    }
}

static void list_banks(const deepest_work *w, const buried_triangle *t, size_t first, size_t end,
                       cell_banks *out) {
    out->count = 0;
    for (int i = 0; i < 3; i++) {
        const uint32_t near =
            t->corners[i] != UINT32_MAX ? w->facts->vertices[t->corners[i]].triangle : UINT32_MAX;
        if (near != UINT32_MAX) add_banks_of(w, near, out);
    }
    for (; first < end; first++) {
        const uint64_t code = w->facts->cuts->keys[first].end;
        const curve_piece *piece = &w->facts->found->curves->found[code / 2];
        const uint32_t other = code % 2 == 1 ? piece->a : piece->b;
        if (surface_body(w->facts->found->surface, other) == t->body) add_banks_of(w, other, out);
    }
}

/* No point of a cell is deeper than its corners are far from one of these; *near: of which. */
static double bound_by_banks(const deepest_work *w, const cell_banks *banks, const depth_search *s,
                             depth_cell *cell) {
    const outer_surface *o = w->facts->outer;
    const double *const corners[3] = {cell->corners[0], cell->corners[1], cell->corners[2]};
    double least = (double)INFINITY;
    cell->near = UINT32_MAX;
    for (uint32_t i = 0; i < banks->count && depth_search_wants(s, least / o->scale + w->facts->rounding);
         i++) {
        const double greatest = outer_part_reach_of_all(o, corners, &banks->parts[i], least);
        if (!(greatest < least)) continue;
        least = greatest;
        cell->near = banks->triangles[i];
    }
    return least / o->scale + w->facts->rounding;
}

/* A triangle whose parts are taken. */
typedef struct cell_taker {
    deepest_work *work;
    const cut_lift *lift;
    const depth_search *search; /* begun with the corners of the group */
    const cell_banks *banks;
    uint32_t slot;
    double area, left;
} cell_taker;

static void add_cell(deepest_work *w, const depth_cell *cell) {
    deepest_finder *d = w->finder;
    void *items = d->cells;
    if (!grow_list(d, &items, &d->cell_capacity, d->cell_count, sizeof *d->cells)) {
        w->out_of_memory = true;
        return;
    }
    d->cells = items;
    d->cells[d->cell_count++] = *cell;
}

static void take_part(void *data, const cut_part *part) {
    cell_taker *taker = data;
    if (part->numbers[taker->slot] < 1) return;
    taker->area += cut_part_area(part);
    depth_cell halves[2];
    cut_lift_part(taker->lift, part, halves[0].corners, halves[1].corners);
    for (int i = 0; i < 2; i++) {
        const double bound = bound_by_banks(taker->work, taker->banks, taker->search, &halves[i]);
        if (depth_search_wants(taker->search, bound))
            add_cell(taker->work, &halves[i]);
        else
            taker->left = max_of(taker->left, bound);
    }
}

/* If rounding could feign the best depth, the area decides whether there is any, and must be known. */
static bool banks_rule_out(const deepest_work *w, const cell_banks *banks, const depth_search *s,
                           buried_triangle *t) {
    depth_cell whole;
    if (s->best.depth <= w->facts->rounding) return false;
    for (uint32_t i = 0; i < 3; i++)
        memcpy(whole.corners[i], surface_corner(w->mesh, w->facts->found->surface->positions, t->triangle, i),
               sizeof whole.corners[i]);
    t->left = bound_by_banks(w, banks, s, &whole);
    return !depth_search_wants(s, t->left);
}

/* A line that divides a triangle costs this number of comparisons. */
enum { A_LINE = 4 };

static bool cut_open(deepest_work *w, const depth_search *s, buried_triangle *t) {
    size_t first, end = triangle_cuts_of(w->facts->cuts, t->triangle, &first);
    cell_banks banks;
    loaded_cut cut;
    t->first_cell = w->finder->cell_count;
    t->cell_count = 0;
    list_banks(w, t, first, end, &banks);
    if (banks_rule_out(w, &banks, s, t)) return true;
    t->left = 0.0;
    t->area = 0.0;
    if (!memory_budget_work(w->finder->budget, end - first, A_LINE)) return false;
    if (!triangle_cuts_load(w->facts->cuts, w->facts->found, first, end, &cut)) return false;
    if (cut.stretch == 0.0) return true;
    cut_lift lift = cut_lift_of(w->facts->found->surface, &cut);
    cell_taker taker = {.work = w, .lift = &lift, .search = s, .banks = &banks};
    while (taker.slot < cut.cut.slot_count && cut.slot_bodies[taker.slot] != t->body) taker.slot++;
    if (taker.slot == cut.cut.slot_count) return true;
    if (!cut_triangle_divide(w->finder->context, &cut.cut, &w->facts->cuts->memory, take_part, &taker))
        return false;
    t->area = taker.area * cut.stretch;
    t->left = taker.left;
    t->cell_count = (uint32_t)(w->finder->cell_count - t->first_cell);
    return !w->out_of_memory && outer_surface_take_work(w->facts->outer, t->cell_count);
}

/* If the work does not fit, all of it is estimated from the triangles so far. */
static bool stop_opening(const deepest_work *w, size_t opened) {
    memory_budget *b = w->finder->budget;
    if (b != NULL && b->wanted_work > 0) {
        const double all = (double)b->wanted_work * (double)w->finder->triangle_count / (double)opened;
        b->wanted_work = all < 0x1p63 ? (uint64_t)all : UINT64_MAX;
    }
    return false;
}

/* Those that may have something deeper than the corners. */
static bool cut_triangles_open(deepest_work *w) {
    deepest_finder *d = w->finder;
    d->cell_count = 0;
    for (size_t g = 0; g < d->group_count; g++) {
        const buried_group *group = &d->groups[g];
        depth_search s = begin_search(w, d->triangles[group->first].body);
        if (!progress_go_on(&d->context->progress, 0.0)) return false;
        begin_with_corners(w, group, &s);
        for (size_t i = group->first; i < group->end && depth_search_wants(&s, d->triangles[i].bound); i++) {
            if (d->triangles[i].cut && !cut_open(w, &s, &d->triangles[i])) return stop_opening(w, i + 1);
        }
    }
    return true;
}

/* ---- where surfaces lie on each other ------------------------------------------------------------------ */

static bool shares_area(const cscd_intersection *pair) {
    return pair->kind == CSCD_INTERSECTION_COPLANAR || pair->kind == CSCD_INTERSECTION_FOLDED ||
           pair->kind == CSCD_INTERSECTION_DUPLICATE;
}

static bool list_flush(deepest_work *w) {
    deepest_finder *d = w->finder;
    const depth_facts *f = w->facts;
    size_t count = 0;
    for (size_t i = 0; i < f->pair_count; i++) count += shares_area(&f->pairs[i]) ? 2 : 0;
    const size_t room = room_with_spare(count);
    const array_list list = {{ARRAY(d->flush, room), ARRAY(d->spare_flush, room)}};
    if (!memory_budget_take_all(d->budget, list)) return false;
    if (!context_renew_all(d->context, list, &d->flush_capacity, count)) return false;
    d->flush_count = 0;
    for (size_t i = 0; i < f->pair_count; i++) {
        if (!shares_area(&f->pairs[i])) continue;
        const uint32_t a = f->pairs[i].a, b = f->pairs[i].b;
        d->flush[d->flush_count++] = (uint64_t)a << 32 | surface_body(f->found->surface, b);
        d->flush[d->flush_count++] = (uint64_t)b << 32 | surface_body(f->found->surface, a);
    }
    sort_by_number(d->flush, d->spare_flush, d->flush_count, sizeof *d->flush);
    return true;
}

static bool is_flush(const deepest_finder *d, uint32_t triangle, uint32_t body) {
    const uint64_t key = (uint64_t)triangle << 32 | body;
    size_t low = 0, high = d->flush_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (d->flush[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < d->flush_count && d->flush[low] == key;
}

/* Is a corner within the body? Or does the body contain an area of the triangle, as large as rounding cannot feign? If the
 * triangle shares none with the body's surface, then nearly all points of that area are within the body. */
static bool lies_within(const deepest_work *w, const buried_triangle *t) {
    if (t->low > 0.0) return true;
    const double *positions = w->facts->found->surface->positions;
    const double whole = surface_area(w->mesh, positions, t->triangle);
    return !is_flush(w->finder, t->triangle, t->body) && (t->cut ? t->area : whole) > 0x1p-30 * whole;
}

static bool group_lies_within(const deepest_work *w, const buried_group *group) {
    for (size_t i = group->first; i < group->end; i++) {
        if (lies_within(w, &w->finder->triangles[i])) return true;
    }
    return false;
}

/* ---- the deepest points -------------------------------------------------------------------------------- */

static void search_whole(const deepest_work *w, const buried_triangle *t, depth_search *s,
                         depth_queue *queue) {
    const cscd_depth *known[3];
    depth_cell cell = {.near = UINT32_MAX};
    for (uint32_t i = 0; i < 3; i++) {
        memcpy(cell.corners[i], surface_corner(w->mesh, w->facts->found->surface->positions, t->triangle, i),
               sizeof cell.corners[i]);
        known[i] = t->corners[i] != UINT32_MAX ? &w->facts->vertices[t->corners[i]] : NULL;
        if (known[i] != NULL) cell.near = known[i]->triangle;
    }
    depth_search_cell(s, queue, &cell, t->triangle, t->bound, known);
}

static void search_triangle(const deepest_work *w, const buried_triangle *t, depth_search *s,
                            depth_queue *queue) {
    if (!t->cut) search_whole(w, t, s, queue);
    s->bound = max_of(s->bound, t->left);
    for (uint32_t k = 0; k < t->cell_count; k++)
        depth_search_cell(s, queue, &w->finder->cells[t->first_cell + k], t->triangle, t->bound, NULL);
}

/* The triangles at the deepest corner come first, since most often one of them has the deepest point, and the deeper the point
 * that is known, the fewer others are wanted. */
static void search_group(const deepest_work *w, const buried_group *group, depth_search *s) {
    const buried_triangle *triangles = w->finder->triangles;
    depth_queue queue;
    queue.count = 0;
    begin_with_corners(w, group, s);
    const double deepest = s->best.depth;
    for (size_t i = group->first; i < group->end && depth_search_wants(s, triangles[i].bound); i++)
        if (triangles[i].low == deepest) search_triangle(w, &triangles[i], s, &queue);
    depth_search_finish(s, &queue);
    for (size_t i = group->first; i < group->end; i++) {
        if (!depth_search_wants(s, triangles[i].bound)) {
            s->bound = max_of(s->bound, triangles[i].bound); /* nor is any after it wanted */
            break;
        }
        if (triangles[i].low != deepest) search_triangle(w, &triangles[i], s, &queue);
    }
    depth_search_finish(s, &queue);
}

static void set_direction(const deepest_work *w, const depth_search *s, cscd_depth *out) {
    for (int k = 0; k < 3; k++) out->direction[k] = s->best.nearest.x[k] - s->best.x[k];
    if (out->depth == 0.0 && out->triangle != UINT32_MAX)
        surface_normal(w->mesh, w->facts->found->surface->positions, out->triangle, out->direction);
    const double norm = surface_norm(out->direction);
    const int sense = out->depth == 0.0 ? surface_sense(w->facts->found->surface, out->triangle) : 1;
    for (int k = 0; k < 3; k++) out->direction[k] = norm > 0.0 ? sense * out->direction[k] / norm : 0.0;
}

/* face: UINT32_MAX if the group has no point. */
static void find_deepest(const deepest_work *w, const buried_group *group, cscd_depth *out) {
    const buried_triangle *first = &w->finder->triangles[group->first];
    const double rounding = w->facts->rounding;
    depth_search s = begin_search(w, first->body);
    search_group(w, group, &s);
    *out = (cscd_depth){.vertex = UINT32_MAX,
                        .edge = UINT32_MAX,
                        .face = s.best_cell,
                        .patch = first->patch,
                        .body = first->body,
                        .triangle = s.best.nearest.triangle};
    if (s.best.nearest.triangle == UINT32_MAX) out->face = UINT32_MAX; /* no outer surface: see set_answer */
    if (out->face == UINT32_MAX) return;
    out->depth = s.best.depth;
    out->bound = s.bound > s.best.depth + rounding ? s.bound : s.best.depth;
    memcpy(out->x, s.best.x, sizeof out->x);
    if (out->depth <= rounding && !group_lies_within(w, group)) out->depth = 0.0;
    if (out->depth <= rounding && out->bound <= 2.0 * rounding) out->bound = out->depth;
    set_direction(w, &s, out);
}

enum { GROUPS_A_TASK = 4 };

static void find_some(void *data, uint32_t task) {
    const deepest_work *w = data;
    const deepest_finder *d = w->finder;
    size_t first = (size_t)task * GROUPS_A_TASK, end = first + GROUPS_A_TASK;
    if (!progress_go_on(&d->context->progress, (double)first / (double)d->group_count)) return;
    for (size_t i = first; i < end && i < d->group_count; i++) find_deepest(w, &d->groups[i], &w->out[i]);
}

bool deepest_finder_begin(deepest_finder *d, const depth_facts *facts) {
    deepest_work w = {.finder = d, .facts = facts, .mesh = facts->found->surface->mesh};
    d->budget = facts->found->budget;
    if (!list_buried(d, facts)) return false;
    return cut_triangles_open(&w) && list_flush(&w);
}

size_t deepest_finder_run(deepest_finder *d, const depth_facts *facts, cscd_depth *out) {
    deepest_work w = {.finder = d, .facts = facts, .mesh = facts->found->surface->mesh, .out = out};
    size_t count = 0;
    parallel_run(d->context->threads, (uint32_t)((d->group_count + GROUPS_A_TASK - 1) / GROUPS_A_TASK),
                 find_some, &w);
    if (progress_cancelled(&d->context->progress)) return 0;
    for (size_t i = 0; i < d->group_count; i++)
        if (out[i].face != UINT32_MAX) out[count++] = out[i];
    return count;
}
