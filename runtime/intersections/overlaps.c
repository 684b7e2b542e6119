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

static array_list list_of_keys(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->keys, count), ARRAY(o->spare_keys, count)}};
}

static array_list list_of_cuts(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->lines, count), ARRAY(o->borders, count),
                         ARRAY(o->corner_numbers, 3 * count), ARRAY(o->slot_shares, count),
                         ARRAY(o->slot_objects, count)}};
}

static array_list list_of_overlaps(overlap_finder *o, size_t count) {
    return (array_list){{ARRAY(o->overlaps, count), ARRAY(o->spare_shares, count)}};
}

void overlap_finder_free(overlap_finder *o) {
    if (o->context == NULL) return;
    cscd_context *context = o->context;
    context_free_all(context, list_of_shares(o, 0));
    context_free_all(context, list_of_patches(o, 0));
    context_free_all(context, list_of_keys(o, 0));
    context_free_all(context, list_of_cuts(o, 0));
    context_free_all(context, list_of_overlaps(o, 0));
    cut_memory_free(context, &o->cuts);
    *o = (overlap_finder){.context = context};
}

/* Makes room for so many items; what was there is lost. */
static bool reserve(overlap_finder *o, array_list (*list)(overlap_finder *, size_t), size_t *capacity,
                    size_t count) {
    return context_renew_all(o->context, list(o, 2 * count), capacity, count, 2 * count);
}

/* ---- shares -------------------------------------------------------------------------------------------- */

typedef struct overlap_work {
    overlap_finder *finder;
    const overlap_input *input;
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
    vec3_subtract(surface_corner(mesh, work->input->surface->positions, triangle, 0), work->origin, from);
    return vec3_dot(from, normal) / norm;
}

/* ---- whole triangles ----------------------------------------------------------------------------------- */

static void add_whole_triangles(overlap_work *work) {
    const patch_finder *p = work->input->patches;
    overlap_finder *o = work->finder;
    memset(o->patch_areas, 0, p->patch_count * sizeof *o->patch_areas);
    memset(o->patch_fluxes, 0, p->patch_count * sizeof *o->patch_fluxes);
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        uint32_t patch = p->triangle_patches[t];
        if (patch == UINT32_MAX || p->patches[patch].winding_count == 0) continue;
        double normal[3];
        surface_normal(work->mesh, work->input->surface->positions, t, normal);
        double norm = surface_norm(normal), area = 0.5 * norm;
        o->patch_areas[patch] += area;
        o->patch_fluxes[patch] += area * height_of(work, t, normal, norm);
    }
}

static void add_patch(overlap_work *work, const cscd_patch *patch, double area, double flux) {
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        cscd_winding w = work->input->patches->windings[patch->first_winding + i];
        if (w.object == patch->object)
            add_own(work, patch->object, w.number >= 1 ? area : 0.0, w.number < 0 ? area : 0.0,
                    w.number == 1 ? flux : 0.0);
        else if (w.number >= 1)
            add_buried(work, patch->object, w.object, area, patch->own == 0 ? flux : 0.0);
    }
}

/* ---- cut triangles ------------------------------------------------------------------------------------- */

/* The pieces in one triangle, and the objects that have to do with it. */
typedef struct cut_work {
    overlap_work *all;
    const curve_key *keys; /* end: 2 piece, plus 1 if the triangle is its b */
    size_t piece_count;
    uint32_t triangle, object;
    int x, y; /* the axes of the projection, in which the triangle turns counter-clockwise */
    cut_triangle cut;
} cut_work;

static uint32_t object_of(const cscd_mesh *mesh, uint32_t triangle) {
    return cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
}

/* The slot of an object, which gets one if it has none. They are few. */
static uint32_t slot_of(cut_work *work, uint32_t object) {
    uint32_t *objects = work->all->finder->slot_objects, slot = 0;
    while (slot < work->cut.slot_count && objects[slot] != object) slot++;
    if (slot == work->cut.slot_count) objects[work->cut.slot_count++] = object;
    return slot;
}

static void project(const cut_work *work, const double x[3], double out[2]) {
    out[0] = x[work->x];
    out[1] = x[work->y];
}

/* Adds an end of a piece that is on the triangle's own border. An edge of a that passes towards the side of b's normal, and
 * so out of b, begins the piece, one that passes into b ends it; for edges of b it is the other way round. */
static void add_border(cut_work *work, const curve_piece *piece, size_t number, bool is_b, int end,
                       uint32_t slot) {
    const cscd_mesh *mesh = work->all->mesh;
    const curve_joiner *j = work->all->input->curves;
    const uint32_t *edges = mesh->triangle_edges[work->triangle];
    for (uint32_t i = 0; i < 3; i++) {
        if (piece->ends[end].edge != edges[i]) continue;
        double s = j->points[j->end_points[2 * number + (size_t)end]].s;
        bool along = mesh->edges[edges[i]][0] == mesh->triangles[work->triangle][i];
        work->cut.borders[work->cut.border_count++] =
            (cut_border){i, along ? s : 1.0 - s, slot, (end == 1) != is_b ? 1 : -1};
    }
}

/* Seen from outside, the inside of b is to the left of a piece on a, and the inside of a to the right of it on b. */
static void add_piece(cut_work *work, const curve_key *key) {
    const overlap_input *input = work->all->input;
    const cscd_mesh *mesh = work->all->mesh;
    const curve_joiner *j = input->curves;
    size_t number = key->end / 2;
    bool is_b = key->end % 2 == 1;
    const curve_piece *piece = &j->found[number];
    uint32_t other = is_b ? piece->a : piece->b;
    if (!mesh->components[mesh->triangle_components[other]].closed_manifold) return;
    cut_line line = {.slot = slot_of(work, object_of(mesh, other)), .rise = is_b ? -1 : 1};
    project(work, j->points[j->end_points[2 * number]].x, line.from);
    project(work, j->points[j->end_points[2 * number + 1]].x, line.to);
    work->cut.lines[work->cut.line_count++] = line;
    for (int end = 0; end < 2; end++) add_border(work, piece, number, is_b, end, line.slot);
}

/* All objects that wind around a corner get slots first, then each corner its numbers. */
static void number_corners(cut_work *work) {
    const patch_finder *p = work->all->input->patches;
    const cscd_patch *patches[3];
    for (int i = 0; i < 3; i++) {
        patches[i] = &p->patches[p->corner_patches[(size_t)work->triangle * 3 + (size_t)i]];
        for (uint32_t k = 0; k < patches[i]->winding_count; k++)
            slot_of(work, p->windings[patches[i]->first_winding + k].object);
    }
    memset(work->cut.corner_numbers, 0, 3 * work->cut.slot_count * sizeof *work->cut.corner_numbers);
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t k = 0; k < patches[i]->winding_count; k++) {
            cscd_winding w = p->windings[patches[i]->first_winding + k];
            work->cut.corner_numbers[i * work->cut.slot_count + slot_of(work, w.object)] = w.number;
        }
    }
}

/* No more slots than this can be asked for. */
static size_t count_slots(const cut_work *work) {
    const patch_finder *p = work->all->input->patches;
    size_t count = 1 + work->piece_count;
    for (int i = 0; i < 3; i++)
        count += p->patches[p->corner_patches[(size_t)work->triangle * 3 + (size_t)i]].winding_count;
    return count;
}

static bool reserve_cut(cut_work *work) {
    overlap_finder *o = work->all->finder;
    size_t slots = count_slots(work), most = 2 * work->piece_count > slots ? 2 * work->piece_count : slots;
    if (!reserve(o, list_of_cuts, &o->cut_capacity, most)) return false;
    if (!cut_memory_reserve(o->context, &o->cuts, work->piece_count, slots)) return false;
    work->cut.lines = o->lines;
    work->cut.borders = o->borders;
    work->cut.corner_numbers = o->corner_numbers;
    return true;
}

static void choose_projection(cut_work *work, const double normal[3]) {
    int axis = 0;
    for (int k = 1; k < 3; k++) axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    work->x = normal[axis] > 0.0 ? (axis + 1) % 3 : (axis + 2) % 3;
    work->y = normal[axis] > 0.0 ? (axis + 2) % 3 : (axis + 1) % 3;
    for (int i = 0; i < 3; i++)
        project(work,
                surface_corner(work->all->mesh, work->all->input->surface->positions, work->triangle,
                               (uint32_t)i),
                work->cut.corners[i]);
}

static void add_slots(const cut_work *work, double stretch, double height) {
    const overlap_finder *o = work->all->finder;
    for (uint32_t slot = 0; slot < work->cut.slot_count; slot++) {
        cut_share share = o->slot_shares[slot];
        if (slot == 0)
            add_own(work->all, work->object, stretch * share.buried, stretch * share.inverted,
                    stretch * share.once * height);
        else
            add_buried(work->all, work->object, o->slot_objects[slot], stretch * share.buried,
                       stretch * share.buried_outside * height);
    }
}

static void add_cut_triangle(cut_work *work) {
    overlap_finder *o = work->all->finder;
    double normal[3];
    surface_normal(work->all->mesh, work->all->input->surface->positions, work->triangle, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return;
    if (!reserve_cut(work)) {
        work->all->out_of_memory = true;
        return;
    }
    choose_projection(work, normal);
    slot_of(work, work->object);
    for (size_t i = 0; i < work->piece_count; i++) add_piece(work, &work->keys[i]);
    number_corners(work);
    memset(o->slot_shares, 0, work->cut.slot_count * sizeof *o->slot_shares);
    if (!cut_triangle_measure(o->context, &work->cut, &o->cuts, o->slot_shares))
        work->all->out_of_memory = true;
    else
        add_slots(work, norm / vec3_largest(normal), height_of(work->all, work->triangle, normal, norm));
}

static void add_cut_triangles(overlap_work *work) {
    const curve_joiner *j = work->input->curves;
    overlap_finder *o = work->finder;
    size_t count = 2 * j->piece_count;
    for (size_t i = 0; i < count; i++)
        o->keys[i] = (curve_key){i % 2 == 0 ? j->found[i / 2].a : j->found[i / 2].b, i};
    sort_by_number(o->keys, o->spare_keys, count, sizeof *o->keys);
    for (size_t begin = 0, end = 0; begin < count && !work->out_of_memory; begin = end) {
        while (end < count && o->keys[end].number == o->keys[begin].number) end++;
        uint32_t triangle = (uint32_t)o->keys[begin].number;
        cut_work cut = {.all = work,
                        .keys = o->keys + begin,
                        .piece_count = end - begin,
                        .triangle = triangle,
                        .object = object_of(work->mesh, triangle)};
        add_cut_triangle(&cut);
    }
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
    const curve_joiner *j = work->input->curves;
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

cscd_status overlap_finder_run(overlap_finder *o, const overlap_input *input, cscd_overlaps *out) {
    const patch_finder *p = input->patches;
    const cscd_mesh *mesh = input->surface->mesh;
    overlap_work work = {.finder = o, .input = input, .mesh = mesh};
    *out = (cscd_overlaps){NULL, 0};
    if (mesh->triangle_count == 0) return CSCD_OK;
    work.origin = surface_corner(mesh, input->surface->positions, 0, 0);
    o->share_count = 0;
    if (!reserve(o, list_of_patches, &o->patch_capacity, p->patch_count) ||
        !reserve(o, list_of_keys, &o->key_capacity, 2 * input->curves->piece_count))
        return CSCD_OUT_OF_MEMORY;
    add_whole_triangles(&work);
    for (size_t i = 0; i < p->patch_count; i++)
        add_patch(&work, &p->patches[i], o->patch_areas[i], o->patch_fluxes[i]);
    add_cut_triangles(&work);
    if (work.out_of_memory) return CSCD_OUT_OF_MEMORY;
    if (!reserve(o, list_of_overlaps, &o->overlap_capacity, o->share_count)) return CSCD_OUT_OF_MEMORY;
    sort_items(o->shares, o->spare_shares, o->share_count, sizeof *o->shares, compare_shares);
    size_t count = join_shares(o);
    void_volumes(&work, count);
    *out = (cscd_overlaps){o->overlaps, count};
    return CSCD_OK;
}
