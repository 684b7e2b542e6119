/* The areas and volumes that bodies bury of each other, by the patches and by the triangles that curves cut:
 * docs/theory/curves.md, lemma 7; and which bodies are two copies of one solid. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- overlaps ------------------------------------------------------------------------------------------ */

/* A share of the overlap of two bodies; key: a in the upper half, b in the lower one. */
typedef struct overlap_share {
    uint64_t key;
    double area_a, area_b;
    double bounding;  /* an area that bounds what both contain, as often as it does; of a patch how often */
    const double *at; /* a point of it, or of its plane and the overlap */
    uint32_t triangle, patch; /* patch: all its whole triangles, else UINT32_MAX */
} overlap_share;

/* Sums over the whole triangles of a patch. */
typedef struct patch_sum {
    double area;
    double normal[3]; /* as long as the area, and of closed components only, as the flux */
    double flux;      /* three times the volume that is behind them as seen from the patch's example */
} patch_sum;

/* The measures of one body in a triangle. */
typedef struct cut_share {
    double buried;    /* its number is 1 or more */
    double inverted;  /* its number is below 0 */
    double bounding;  /* that of the triangle's own body is 0, times how often this one contains it */
    const double *at; /* a point of the triangle, near what is buried */
} cut_share;

struct overlap_finder {
    cscd_context *context;
    overlap_share *shares, *spare_shares;
    size_t share_count, share_capacity;
    patch_sum *patch_sums;
    size_t patch_capacity;
    cut_share *slot_shares;
    size_t slot_capacity;
    triangle_cuts cuts;
    overlap_gaps gaps;
    cscd_overlap *overlaps;
    size_t overlap_capacity;
};

static array_list list_of_shares(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->shares, count)}};
}

static array_list list_of_patches(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->patch_sums, count)}};
}

static array_list list_of_slots(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->slot_shares, count)}};
}

static array_list list_of_overlaps(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->overlaps, count), ARRAY(o->spare_shares, count)}};
}

static overlap_finder empty_finder(cscd_context *context) {
    return (overlap_finder){.context = context, .cuts = {.context = context}, .gaps = {.context = context}};
}

overlap_finder *overlap_finder_create(cscd_context *context) {
    overlap_finder *o = context_allocate(context, 1, sizeof *o);
    if (o != NULL) *o = empty_finder(context);
    return o;
}

void overlap_finder_clear(overlap_finder *o) {
    cscd_context *context = o->context;
    context_free_all(context, list_of_shares(o, 0));
    context_free_all(context, list_of_patches(o, 0));
    context_free_all(context, list_of_slots(o, 0));
    context_free_all(context, list_of_overlaps(o, 0));
    triangle_cuts_free(&o->cuts);
    overlap_gaps_free(&o->gaps);
    *o = empty_finder(context);
}

void overlap_finder_destroy(overlap_finder *o) {
    if (o == NULL) return;
    overlap_finder_clear(o);
    context_free(o->context, o);
}

/* Makes room for this number of items; the old contents are lost. */
static bool reserve_list(overlap_finder *o, array_list (*list)(overlap_finder *, size_t), size_t *capacity,
                         size_t count) {
    return context_renew_all(o->context, list(o, room_with_spare(count)), capacity, count);
}

/* ---- shares -------------------------------------------------------------------------------------------- */

typedef struct overlap_work {
    overlap_finder *finder;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    bool out_of_memory;
} overlap_work;

static void add_share(overlap_work *work, overlap_share share) {
    overlap_finder *o = work->finder;
    const size_t sums =
        2 * (sizeof *o->spare_shares + sizeof *o->overlaps); /* for sorting, and what comes of it */
    if (!memory_budget_take(work->found->budget, 1, MEMORY_WHILE_DOUBLING * sizeof share + sums)) {
        work->out_of_memory = true;
        return;
    }
    if (o->share_count == o->share_capacity) {
        size_t capacity = o->share_capacity == 0 ? 64 : 2 * o->share_capacity;
        overlap_share *grown =
            context_grow(o->context, o->shares, o->share_count, capacity, sizeof *o->shares);
        if (grown == NULL) {
            work->out_of_memory = true;
            return;
        }
        o->shares = grown;
        o->share_capacity = capacity;
    }
    o->shares[o->share_count++] = share;
}

/* The place of a share: a triangle and a point of its plane, or a patch. */
typedef struct share_place {
    uint32_t triangle, patch;
    const double *at;
} share_place;

/* An area of the surface of `body` that `in` contains, and what of it bounds what both contain. */
static void add_buried(overlap_work *work, uint32_t body, uint32_t in, double area, double bounding,
                       share_place place) {
    bool first = body < in;
    uint64_t key = first ? (uint64_t)body << 32 | in : (uint64_t)in << 32 | body;
    if (area == 0.0 && bounding == 0.0) return;
    add_share(work, (overlap_share){key, first ? area : 0.0, first ? 0.0 : area, bounding, place.at,
                                    place.triangle, place.patch});
}

static void add_own(overlap_work *work, uint32_t body, double area, double inverted, double bounding,
                    share_place place) {
    if (area == 0.0 && inverted == 0.0) return;
    add_share(work, (overlap_share){(uint64_t)body << 32 | body, area, inverted, bounding, place.at,
                                    place.triangle, place.patch});
}

/* Open components have no volume. */
static bool triangle_bounds(const overlap_work *work, uint32_t triangle) {
    return work->mesh->components[work->mesh->triangle_components[triangle]].closed_manifold;
}

/* ---- whole triangles ----------------------------------------------------------------------------------- */

static const double *place_of_patch(const overlap_work *work, uint32_t patch) {
    const cscd_patch *of = &work->found->patches->patches[patch];
    return surface_corner(work->mesh, work->found->surface->positions, of->triangle, of->corner);
}

static void add_whole_triangles(overlap_work *work) {
    const patch_finder *p = work->found->patches;
    patch_sum *sums = work->finder->patch_sums;
    memset(sums, 0, p->patch_count * sizeof *sums);
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        uint32_t patch = p->triangle_patches[t];
        if (patch == UINT32_MAX || p->patches[patch].winding_count == 0) continue;
        double normal[3], from[3];
        surface_normal(work->mesh, work->found->surface->positions, t, normal);
        sums[patch].area += 0.5 * surface_norm(normal);
        if (!triangle_bounds(work, t)) continue;
        vec3_subtract(surface_corner(work->mesh, work->found->surface->positions, t, 0),
                      place_of_patch(work, patch), from);
        double half = 0.5 * surface_sense(work->found->surface, t);
        for (int k = 0; k < 3; k++) sums[patch].normal[k] += half * normal[k];
        sums[patch].flux += half * vec3_dot(from, normal);
    }
}

static void add_patch(overlap_work *work, uint32_t index) {
    const cscd_patch *patch = &work->found->patches->patches[index];
    double area = work->finder->patch_sums[index].area;
    share_place place = {patch->triangle, index, place_of_patch(work, index)};
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        cscd_winding w = work->found->patches->windings[patch->first_winding + i];
        if (w.body == patch->body)
            add_own(work, patch->body, w.number >= 1 ? area : 0.0, w.number < 0 ? area : 0.0,
                    w.number == 1 ? 1.0 : 0.0, place);
        else
            add_buried(work, patch->body, w.body, w.number >= 1 ? area : 0.0,
                       patch->own == 0 ? patch_times_within(work->found->patches, w.body, w.number) : 0.0,
                       place);
    }
}

/* ---- cut triangles ------------------------------------------------------------------------------------- */

static void add_slots(overlap_work *work, const loaded_cut *cut) {
    double bounds = triangle_bounds(work, cut->triangle) ? cut->stretch : 0.0;
    for (uint32_t slot = 0; slot < cut->cut.slot_count; slot++) {
        cut_share share = work->finder->slot_shares[slot];
        share_place place = {cut->triangle, UINT32_MAX, share.at};
        if (slot == 0)
            add_own(work, cut->slot_bodies[0], cut->stretch * share.buried, cut->stretch * share.inverted,
                    bounds * share.bounding, place);
        else
            add_buried(work, cut->slot_bodies[0], cut->slot_bodies[slot], cut->stretch * share.buried,
                       bounds * share.bounding, place);
    }
}

/* A triangle that is measured. */
typedef struct cut_measure {
    const overlap_work *work;
    const loaded_cut *cut;
    cut_share *shares; /* per slot */
} cut_measure;

static void add_part(void *data, const cut_part *part) {
    const cut_measure *m = data;
    double area = cut_part_area(part);
    for (uint32_t i = 0; i < part->listed_count; i++) {
        uint32_t slot = part->listed[i];
        int32_t number = part->numbers[slot];
        cut_share *share = &m->shares[slot];
        if (number >= 1) share->buried += area;
        if (number < 0) share->inverted += area;
        if (slot == 0)
            share->bounding += number == 1 ? area : 0.0;
        else if (part->numbers[0] == 0)
            share->bounding +=
                area * patch_times_within(m->work->found->patches, m->cut->slot_bodies[slot], number);
    }
}

/* A share is near a line of its slot. If it has none, the body contains all of the triangle, or nothing. */
static void place_shares(const overlap_work *work, const loaded_cut *cut, cut_share *shares) {
    const curve_joiner *j = work->found->curves;
    memset(shares, 0, cut->cut.slot_count * sizeof *shares);
    for (uint32_t slot = 0; slot < cut->cut.slot_count; slot++)
        shares[slot].at = surface_corner(work->mesh, work->found->surface->positions, cut->triangle, 0);
    for (size_t i = 0; i < cut->cut.line_count; i++) {
        size_t piece = cut->line_pieces[cut->cut.lines[i].number];
        shares[cut->cut.lines[i].slot].at = j->points[j->end_points[2 * piece]].x;
    }
}

static bool measure_cut(overlap_work *work, loaded_cut *cut) {
    overlap_finder *o = work->finder;
    if (!reserve_list(o, list_of_slots, &o->slot_capacity, cut->cut.slot_count)) return false;
    cut_measure measure = {work, cut, o->slot_shares};
    place_shares(work, cut, o->slot_shares);
    if (!cut_triangle_divide(o->context, &cut->cut, &o->cuts.memory, add_part, &measure)) return false;
    add_slots(work, cut);
    return true;
}

static bool add_cut_triangles(overlap_work *work) {
    triangle_cuts *c = &work->finder->cuts;
    if (!triangle_cuts_sort(c, work->found)) return false;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!triangle_cuts_load(c, work->found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !measure_cut(work, &cut)) return false;
        if (work->out_of_memory) return false;
    }
    return true;
}

/* An overlap of which nobody knows how large it is has no share but this one. */
static void add_gaps(overlap_work *work) {
    const overlap_gaps *g = &work->finder->gaps;
    const double *at = work->found->surface->positions;
    for (size_t i = 0; i < g->count; i++) {
        if (i == 0 || g->bodies[i] != g->bodies[i - 1])
            add_share(work, (overlap_share){g->bodies[i], 0.0, 0.0, 0.0, at, 0, UINT32_MAX});
    }
}

/* ---- sums ---------------------------------------------------------------------------------------------- */

static int compare_shares(const void *a, const void *b) {
    uint64_t x = ((const overlap_share *)a)->key, y = ((const overlap_share *)b)->key;
    return (x > y) - (x < y);
}

/* Three times the volume that is behind a share as seen from the origin. */
static double flux_from(const overlap_work *work, const overlap_share *share, const double *origin) {
    double from[3], normal[3];
    if (share->bounding == 0.0) return 0.0;
    vec3_subtract(share->at, origin, from);
    if (share->patch != UINT32_MAX) {
        const patch_sum *sum = &work->finder->patch_sums[share->patch];
        return share->bounding * (sum->flux + vec3_dot(from, sum->normal));
    }
    surface_normal(work->mesh, work->found->surface->positions, share->triangle, normal);
    double distance = vec3_dot(from, normal) / surface_norm(normal);
    return share->bounding * distance * surface_sense(work->found->surface, share->triangle);
}

/* Volumes are measured from a point of the overlap itself, since digits are lost with the distance: where a curve cuts a
 * triangle, else on a patch. */
static const double *choose_origin(const overlap_share *shares, size_t count) {
    const double *origin = shares[0].at;
    for (size_t i = count; i-- > 0;) {
        if (shares[i].bounding != 0.0) origin = shares[i].at;
        if (shares[i].bounding != 0.0 && shares[i].patch == UINT32_MAX) break;
    }
    return origin;
}

static cscd_overlap sum_shares(const overlap_work *work, const overlap_share *shares, size_t count) {
    cscd_overlap sum = {.a = (uint32_t)(shares[0].key >> 32), .b = (uint32_t)shares[0].key};
    const double *origin = choose_origin(shares, count);
    for (size_t i = 0; i < count; i++) {
        sum.area_a += shares[i].area_a;
        sum.area_b += shares[i].area_b;
        sum.volume += flux_from(work, &shares[i], origin) / 3.0;
    }
    if (overlap_gaps_have(&work->finder->gaps, sum.a, sum.b)) sum.volume = (double)NAN;
    return sum;
}

static size_t join_shares(const overlap_work *work) {
    overlap_finder *o = work->finder;
    size_t count = 0;
    for (size_t begin = 0, end = 0; begin < o->share_count; begin = end) {
        while (end < o->share_count && o->shares[end].key == o->shares[begin].key) end++;
        o->overlaps[count++] = sum_shares(work, o->shares + begin, end - begin);
    }
    return count;
}

cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, const left_out_pairs *left_out,
                               cscd_overlaps *out) {
    const patch_finder *p = found->patches;
    const cscd_mesh *mesh = found->surface->mesh;
    overlap_work work = {.finder = o, .found = found, .mesh = mesh};
    *out = (cscd_overlaps){NULL, 0};
    if (mesh->triangle_count == 0) return CSCD_OK;
    o->share_count = 0;
    if (!memory_budget_take_all(found->budget, list_of_patches(o, room_with_spare(p->patch_count))))
        return CSCD_OUT_OF_MEMORY;
    if (!reserve_list(o, list_of_patches, &o->patch_capacity, p->patch_count)) return CSCD_OUT_OF_MEMORY;
    if (!overlap_gaps_find(&o->gaps, found, left_out)) return CSCD_OUT_OF_MEMORY;
    add_whole_triangles(&work);
    for (size_t i = 0; i < p->patch_count && !work.out_of_memory; i++) add_patch(&work, (uint32_t)i);
    add_gaps(&work);
    if (!add_cut_triangles(&work) || work.out_of_memory) return CSCD_OUT_OF_MEMORY;
    if (!reserve_list(o, list_of_overlaps, &o->overlap_capacity, o->share_count)) return CSCD_OUT_OF_MEMORY;
    sort_items(o->shares, o->spare_shares, o->share_count, sizeof *o->shares, compare_shares);
    *out = (cscd_overlaps){o->overlaps, join_shares(&work)};
    return CSCD_OK;
}

/* ---- two copies of one solid --------------------------------------------------------------------------- */

void same_solids_free(same_solids *s) {
    if (s->context == NULL) return;
    context_free(s->context, s->pairs);
    context_free(s->context, s->spare);
    *s = (same_solids){.context = s->context};
}

static size_t find_solids(const same_solids *s, uint64_t key) {
    size_t low = 0, high = s->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (s->pairs[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool same_solids_have(const same_solids *s, uint32_t a, uint32_t b) {
    const size_t at = find_solids(s, key_of_bodies(a, b));
    return at < s->count && s->pairs[at] == key_of_bodies(a, b);
}

/* Bodies that share area. */
static bool list_candidates(same_solids *s, const named_surface *surface, memory_budget *budget,
                            const cscd_intersection *pairs, size_t count) {
    size_t coplanar = 0, kept = 0;
    s->count = 0;
    for (size_t i = 0; i < count; i++) coplanar += pairs[i].kind == CSCD_INTERSECTION_COPLANAR;
    if (coplanar == 0) return true;
    const size_t room = room_with_spare(coplanar);
    const array_list list = {{ARRAY(s->pairs, room), ARRAY(s->spare, room)}};
    if (!memory_budget_take_all(budget, list)) return false;
    if (!context_renew_all(s->context, list, &s->capacity, coplanar)) return false;
    for (size_t i = 0; i < count; i++) {
        if (pairs[i].kind != CSCD_INTERSECTION_COPLANAR) continue;
        const uint32_t a = surface_body(surface, pairs[i].a), b = surface_body(surface, pairs[i].b);
        if (a != b) s->pairs[s->count++] = key_of_bodies(a, b);
    }
    sort_by_number(s->pairs, s->spare, s->count, sizeof *s->pairs);
    for (size_t i = 0; i < s->count; i++)
        if (i == 0 || s->pairs[i] != s->pairs[i - 1]) s->pairs[kept++] = s->pairs[i];
    s->count = kept;
    return true;
}

/* Marks those of which something is within the other, and leaves them out. */
static void leave_out_deep(same_solids *s, const named_surface *surface, const cscd_depths *depths) {
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++) s->spare[i] = 0;
    for (size_t i = 0; i < depths->count; i++) {
        const cscd_depth *at = &depths->items[i];
        const uint64_t key = key_of_bodies(surface_body(surface, at->face), at->body);
        const size_t place = at->depth > 0.0 ? find_solids(s, key) : s->count;
        if (place < s->count && s->pairs[place] == key) s->spare[place] = 1;
    }
    for (size_t i = 0; i < s->count; i++)
        if (s->spare[i] == 0) s->pairs[kept++] = s->pairs[i];
    s->count = kept;
}

/* Bodies that only lie next to each other share a volume that comes from rounding. */
static bool shares_volume(const cscd_overlap *o) {
    return o->volume > 0x1p-40 * pow(o->area_a + o->area_b, 1.5);
}

cscd_status same_solids_find(same_solids *s, const surface_cuts *found, const cscd_intersection *pairs,
                             size_t pair_count, const cscd_depths *depths, overlap_finder *overlaps,
                             const left_out_pairs *left_out) {
    cscd_overlaps shared;
    size_t kept = 0;
    s->bodies = found->surface->bodies;
    if (!list_candidates(s, found->surface, found->budget, pairs, pair_count)) return CSCD_OUT_OF_MEMORY;
    leave_out_deep(s, found->surface, depths);
    if (s->count == 0) return CSCD_OK;
    cscd_status status = overlap_finder_run(overlaps, found, left_out, &shared);
    if (status != CSCD_OK) return status;
    for (size_t i = 0; i < shared.count; i++) {
        const cscd_overlap *o = &shared.items[i];
        if (o->a != o->b && same_solids_have(s, o->a, o->b) && shares_volume(o))
            s->spare[kept++] = key_of_bodies(o->a, o->b);
    }
    for (size_t i = 0; i < kept; i++) s->pairs[i] = s->spare[i];
    s->count = kept;
    return CSCD_OK;
}
