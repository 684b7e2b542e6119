/* The areas and volumes that objects bury of each other, by the patches and by the triangles that curves cut:
 * docs/theory/curves.md, lemma 7. */
#include "runtime/intersections/overlaps.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_shares(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->shares, count)}};
}

static array_list list_of_patches(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->patch_areas, count), ARRAY(o->patch_fluxes, count)}};
}

static array_list list_of_slots(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->slot_shares, count)}};
}

static array_list list_of_overlaps(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->overlaps, count), ARRAY(o->spare_shares, count)}};
}

void overlap_finder_free(overlap_finder *o) {
    if (o->context == NULL) return;
    cscd_context *context = o->context;
    context_free_all(context, list_of_shares(o, 0));
    context_free_all(context, list_of_patches(o, 0));
    context_free_all(context, list_of_slots(o, 0));
    context_free_all(context, list_of_overlaps(o, 0));
    triangle_cuts_free(&o->cuts);
    *o = (overlap_finder){.context = context, .cuts = {.context = context}};
}

/* Makes room for so many items; what was there is lost. */
static bool reserve_list(overlap_finder *o, array_list (*list)(overlap_finder *, size_t), size_t *capacity,
                         size_t count) {
    return context_renew_all(o->context, list(o, room_with_spare(count)), capacity, count);
}

/* ---- shares -------------------------------------------------------------------------------------------- */

typedef struct overlap_work {
    overlap_finder *finder;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    const double *origin; /* volumes are measured from here */
    bool out_of_memory;
} overlap_work;

static void add_share(overlap_work *work, overlap_share share) {
    overlap_finder *o = work->finder;
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

/* An area of the surface of `object` that `in` contains; flux: of the part of it that bounds what both contain. */
static void add_buried(overlap_work *work, uint32_t object, uint32_t in, double area, double flux) {
    bool first = object < in;
    uint64_t key = first ? (uint64_t)object << 32 | in : (uint64_t)in << 32 | object;
    if (area == 0.0 && flux == 0.0) return;
    add_share(work, (overlap_share){key, first ? area : 0.0, first ? 0.0 : area, flux});
}

static void add_own(overlap_work *work, uint32_t object, double area, double inverted, double flux) {
    if (area == 0.0 && inverted == 0.0) return;
    add_share(work, (overlap_share){(uint64_t)object << 32 | object, area, inverted, flux});
}

/* The height of a triangle's plane above the origin, or 0 in open components, which have no volume. */
static double height_of(const overlap_work *work, uint32_t triangle, const double normal[3], double norm) {
    const cscd_mesh *mesh = work->mesh;
    double from[3];
    if (norm == 0.0 || !mesh->components[mesh->triangle_components[triangle]].closed_manifold) return 0.0;
    vec3_subtract(surface_corner(mesh, work->found->surface->positions, triangle, 0), work->origin, from);
    return vec3_dot(from, normal) / norm;
}

/* ---- whole triangles ----------------------------------------------------------------------------------- */

static void add_whole_triangles(overlap_work *work) {
    const patch_finder *p = work->found->patches;
    overlap_finder *o = work->finder;
    memset(o->patch_areas, 0, p->patch_count * sizeof *o->patch_areas);
    memset(o->patch_fluxes, 0, p->patch_count * sizeof *o->patch_fluxes);
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        uint32_t patch = p->triangle_patches[t];
        if (patch == UINT32_MAX || p->patches[patch].winding_count == 0) continue;
        double normal[3];
        surface_normal(work->mesh, work->found->surface->positions, t, normal);
        double norm = surface_norm(normal), area = 0.5 * norm;
        o->patch_areas[patch] += area;
        o->patch_fluxes[patch] += area * height_of(work, t, normal, norm);
    }
}

static void add_patch(overlap_work *work, const cscd_patch *patch, double area, double flux) {
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        cscd_winding w = work->found->patches->windings[patch->first_winding + i];
        if (w.object == patch->object)
            add_own(work, patch->object, w.number >= 1 ? area : 0.0, w.number < 0 ? area : 0.0,
                    w.number == 1 ? flux : 0.0);
        else if (w.number >= 1)
            add_buried(work, patch->object, w.object, area, patch->own == 0 ? flux : 0.0);
    }
}

/* ---- cut triangles ------------------------------------------------------------------------------------- */

static void add_slots(overlap_work *work, const loaded_cut *cut, double height) {
    for (uint32_t slot = 0; slot < cut->cut.slot_count; slot++) {
        cut_share share = work->finder->slot_shares[slot];
        if (slot == 0)
            add_own(work, cut->slot_objects[0], cut->stretch * share.buried, cut->stretch * share.inverted,
                    cut->stretch * share.once * height);
        else
            add_buried(work, cut->slot_objects[0], cut->slot_objects[slot], cut->stretch * share.buried,
                       cut->stretch * share.buried_outside * height);
    }
}

static void add_part(void *data, const cut_part *part) {
    cut_share *shares = data;
    double area = cut_part_area(part);
    for (uint32_t i = 0; i < part->listed_count; i++) {
        uint32_t slot = part->listed[i];
        cut_share *share = &shares[slot];
        if (part->numbers[slot] >= 1) share->buried += area;
        if (part->numbers[slot] >= 1 && part->numbers[0] == 0) share->buried_outside += area;
        if (part->numbers[slot] == 1) share->once += area;
        if (part->numbers[slot] < 0) share->inverted += area;
    }
}

static bool measure_cut(overlap_work *work, loaded_cut *cut) {
    overlap_finder *o = work->finder;
    double normal[3];
    if (!reserve_list(o, list_of_slots, &o->slot_capacity, cut->cut.slot_count)) return false;
    memset(o->slot_shares, 0, cut->cut.slot_count * sizeof *o->slot_shares);
    if (!cut_triangle_divide(o->context, &cut->cut, &o->cuts.memory, add_part, o->slot_shares)) return false;
    surface_normal(work->mesh, work->found->surface->positions, cut->triangle, normal);
    add_slots(work, cut, height_of(work, cut->triangle, normal, surface_norm(normal)));
    return true;
}

static bool add_cut_triangles(overlap_work *work) {
    triangle_cuts *c = &work->finder->cuts;
    if (!triangle_cuts_sort(c, work->found->curves)) return false;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!triangle_cuts_load(c, work->found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !measure_cut(work, &cut)) return false;
    }
    return true;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */

static int compare_shares(const void *a, const void *b) {
    uint64_t x = ((const overlap_share *)a)->key, y = ((const overlap_share *)b)->key;
    return (x > y) - (x < y);
}

static size_t join_shares(overlap_finder *o) {
    size_t count = 0;
    for (size_t i = 0; i < o->share_count; i++) {
        const overlap_share *share = &o->shares[i];
        if (i == 0 || o->shares[i - 1].key != share->key)
            o->overlaps[count++] =
                (cscd_overlap){(uint32_t)(share->key >> 32), (uint32_t)share->key, 0.0, 0.0, 0.0};
        cscd_overlap *sum = &o->overlaps[count - 1];
        sum->area_a += share->area_a;
        sum->area_b += share->area_b;
        sum->volume += share->flux / 3.0;
    }
    return count;
}

/* No volume where a curve of closed components goes on in a pair that is left out. */
static void void_volumes(const overlap_work *work, size_t count) {
    const curve_joiner *j = work->found->curves;
    for (size_t i = 0; i < j->curve_count; i++) {
        const cscd_curve *c = &j->curves[i];
        if (c->start != CSCD_CURVE_END_LEFT_OUT && c->end != CSCD_CURVE_END_LEFT_OUT) continue;
        for (size_t k = 0; k < count; k++) {
            cscd_overlap *o = &work->finder->overlaps[k];
            bool of_both = (o->a == c->objects[0] && o->b == c->objects[1]) ||
                           (o->a == c->objects[1] && o->b == c->objects[0]);
            bool of_one = c->objects[0] == c->objects[1] && (o->a == c->objects[0] || o->b == c->objects[0]);
            if (of_both || of_one) o->volume = (double)NAN;
        }
    }
}

cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, cscd_overlaps *out) {
    const patch_finder *p = found->patches;
    const cscd_mesh *mesh = found->surface->mesh;
    overlap_work work = {.finder = o, .found = found, .mesh = mesh};
    *out = (cscd_overlaps){NULL, 0};
    if (mesh->triangle_count == 0) return CSCD_OK;
    work.origin = surface_corner(mesh, found->surface->positions, 0, 0);
    o->share_count = 0;
    if (!reserve_list(o, list_of_patches, &o->patch_capacity, p->patch_count)) return CSCD_OUT_OF_MEMORY;
    add_whole_triangles(&work);
    for (size_t i = 0; i < p->patch_count; i++)
        add_patch(&work, &p->patches[i], o->patch_areas[i], o->patch_fluxes[i]);
    if (!add_cut_triangles(&work) || work.out_of_memory) return CSCD_OUT_OF_MEMORY;
    if (!reserve_list(o, list_of_overlaps, &o->overlap_capacity, o->share_count)) return CSCD_OUT_OF_MEMORY;
    sort_items(o->shares, o->spare_shares, o->share_count, sizeof *o->shares, compare_shares);
    size_t count = join_shares(o);
    void_volumes(&work, count);
    *out = (cscd_overlaps){o->overlaps, count};
    return CSCD_OK;
}
