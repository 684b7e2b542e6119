/* Sums of intersections, curves and depths for each pair of parts. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"
#include "src/core/vec3.h"

/* The keys of one list, sorted; `next` and those behind it wait for their pair of parts. */
typedef struct key_range {
    part_key *next, *end;
} key_range;

typedef struct summing {
    part_summer *sums;
    const cscd_mesh *mesh;
    const part_labels *labels;
    const cscd_intersections *found;
    const same_solids *same;
    memory_budget *budget;
    key_range pairs, pieces, depths;
} summing;

/* ---- memory -------------------------------------------------------------------------------------------- */

void part_sums_free(cscd_context *context, part_summer *s) {
    context_free(context, s->keys);
    context_free(context, s->spare_keys);
    context_free(context, s->items);
    context_free(context, s->marks);
    *s = (part_summer){.keys = NULL};
}

static cscd_status reserve_keys(summing *w, size_t count) {
    part_summer *s = w->sums;
    cscd_context *context = w->mesh->context;
    const size_t larger = room_with_spare(count);
    const array_list list = {{ARRAY(s->keys, larger), ARRAY(s->spare_keys, larger)}};
    if (!memory_budget_take_all(w->budget, list)) return CSCD_OUT_OF_MEMORY;
    if (!context_renew_all(context, list, &s->key_capacity, count)) return CSCD_OUT_OF_MEMORY;
    if (s->marks == NULL) s->marks = context_allocate(context, w->mesh->triangle_count, sizeof *s->marks);
    return s->marks != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

static cscd_status reserve_items(summing *w, size_t count) {
    part_summer *s = w->sums;
    const size_t larger = room_with_spare(count);
    const array_list list = {{ARRAY(s->items, larger)}};
    if (!memory_budget_take_all(w->budget, list)) return CSCD_OUT_OF_MEMORY;
    return context_renew_all(w->mesh->context, list, &s->item_capacity, count) ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */

static uint64_t key_of_triangles(const summing *w, uint32_t a, uint32_t b) {
    return key_of_parts(part_of_triangle(w->labels, w->mesh, a), part_of_triangle(w->labels, w->mesh, b));
}

static void list_pairs(summing *w) {
    const cscd_intersections *found = w->found;
    for (size_t i = 0; i < found->count; i++)
        *w->pairs.end++ = (part_key){key_of_triangles(w, found->items[i].a, found->items[i].b), i};
}

static void list_pieces(summing *w) {
    const cscd_curves *curves = w->found->curves;
    for (size_t c = 0; curves != NULL && c < curves->count; c++) {
        const cscd_curve *curve = &curves->items[c];
        for (size_t i = 0; i < curve->piece_count; i++) {
            const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + i];
            *w->pieces.end++ = (part_key){key_of_triangles(w, piece->a, piece->b), (uint64_t)c << 32 | i};
        }
    }
}

static void list_depths(summing *w) {
    const cscd_depths *depths = w->found->depths;
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        const cscd_depth *depth = &depths->items[i];
        uint32_t part = part_of_triangle(w->labels, w->mesh, depth->face);
        uint32_t burier = part_of_triangle(w->labels, w->mesh, depth->triangle);
        *w->depths.end++ = (part_key){key_of_parts(part, burier), i};
    }
}

static void sort_keys(summing *w, key_range *keys) {
    sort_by_number(keys->next, w->sums->spare_keys, (size_t)(keys->end - keys->next), sizeof *keys->next);
}

static cscd_status list_keys(summing *w) {
    const cscd_intersections *found = w->found;
    size_t pieces = found->curves != NULL ? found->curves->piece_count : 0;
    size_t depths = found->depths != NULL ? found->depths->count : 0;
    cscd_status status = reserve_keys(w, found->count + pieces + depths);
    if (status != CSCD_OK) return status;
    w->pairs.next = w->pairs.end = w->sums->keys;
    list_pairs(w);
    w->pieces.next = w->pieces.end = w->pairs.end;
    list_pieces(w);
    w->depths.next = w->depths.end = w->pieces.end;
    list_depths(w);
    sort_keys(w, &w->pairs);
    sort_keys(w, &w->pieces);
    sort_keys(w, &w->depths);
    return CSCD_OK;
}

/* ---- the sums of one pair of parts --------------------------------------------------------------------- */

/* Cuts the keys of a pair of parts off. */
static key_range take_keys(key_range *keys, uint64_t parts) {
    key_range taken = {keys->next, keys->next};
    while (taken.end < keys->end && taken.end->parts == parts) taken.end++;
    keys->next = taken.end;
    return taken;
}

static void count_kind(const cscd_intersection *pair, cscd_part_pair *out) {
    switch (pair->kind) {
    case CSCD_INTERSECTION_CROSSING:
        out->crossing++;
        break;
    case CSCD_INTERSECTION_COPLANAR:
        out->coplanar++;
        break;
    case CSCD_INTERSECTION_FOLDED:
        out->folded++;
        break;
    case CSCD_INTERSECTION_DUPLICATE:
        out->duplicate++;
        break;
    default:
        out->touching++;
    }
}

static void count_face(const summing *w, uint32_t triangle, cscd_part_pair *out) {
    bool *mark = &w->sums->marks[triangle];
    if (!*mark) out->faces[part_of_triangle(w->labels, w->mesh, triangle) != out->a]++;
    *mark = true;
}

static double share_of(size_t count, uint32_t all) {
    return all > 0 ? (double)count / all : 0.0;
}

static void sum_pairs(const summing *w, key_range keys, cscd_part_pair *out) {
    const cscd_intersection *pairs = w->found->items;
    for (const part_key *k = keys.next; k < keys.end; k++) {
        const cscd_intersection *pair = &pairs[k->item];
        count_kind(pair, out);
        if (pair->kind == CSCD_INTERSECTION_COPLANAR && w->same != NULL && w->same->count > 0)
            out->same_solid |= same_solids_have(w->same, body_of_triangle(w->same->bodies, w->mesh, pair->a),
                                                body_of_triangle(w->same->bodies, w->mesh, pair->b));
        count_face(w, pair->a, out);
        count_face(w, pair->b, out);
    }
    for (const part_key *k = keys.next; k < keys.end; k++)
        w->sums->marks[pairs[k->item].a] = w->sums->marks[pairs[k->item].b] = false;
    if (out->a == out->b) out->faces[1] = out->faces[0];
    out->shares[0] = share_of(out->faces[0], part_size(w->labels, w->mesh, out->a));
    out->shares[1] = share_of(out->faces[1], part_size(w->labels, w->mesh, out->b));
}

/* The pieces of one curve follow each other. */
static void sum_pieces(const summing *w, key_range keys, cscd_part_pair *out) {
    const cscd_curves *curves = w->found->curves;
    uint64_t last = UINT64_MAX;
    for (const part_key *k = keys.next; k < keys.end; k++) {
        const cscd_curve *curve = &curves->items[k->item >> 32];
        const cscd_curve_point *points = &curves->points[curve->first_point];
        size_t i = (uint32_t)k->item;
        out->length += sqrt(vec3_squared_distance(points[i].x, points[(i + 1) % curve->point_count].x));
        if (k->item >> 32 == last) continue;
        last = k->item >> 32;
        out->curves++;
        out->touching_curves += curve->touching;
    }
}

static void find_deepest(const summing *w, key_range keys, cscd_part_pair *out) {
    out->deepest = SIZE_MAX;
    for (const part_key *k = keys.next; k < keys.end; k++) {
        const cscd_depth *point = &w->found->depths->items[k->item];
        const double depth = point->depth;
        out->bound = fmax(out->bound, point->bound);
        out->in_other_body |= out->a == out->b && depth_is_in_other_body(w->found, point);
        if (out->deepest != SIZE_MAX && depth <= out->depth) continue;
        out->deepest = (size_t)k->item;
        out->depth = depth;
    }
}

/* ---- all pairs of parts -------------------------------------------------------------------------------- */

static bool least_parts(const summing *w, uint64_t *parts) {
    const key_range *ranges[3] = {&w->pairs, &w->pieces, &w->depths};
    bool any = false;
    for (int i = 0; i < 3; i++) {
        if (ranges[i]->next == ranges[i]->end || (any && ranges[i]->next->parts >= *parts)) continue;
        *parts = ranges[i]->next->parts;
        any = true;
    }
    return any;
}

static size_t count_part_pairs(summing w) {
    size_t count = 0;
    for (uint64_t parts; least_parts(&w, &parts); count++) {
        take_keys(&w.pairs, parts);
        take_keys(&w.pieces, parts);
        take_keys(&w.depths, parts);
    }
    return count;
}

static size_t count_faces(const summing *w) {
    const cscd_intersections *found = w->found;
    bool *marks = w->sums->marks;
    size_t count = 0;
    for (size_t i = 0; i < found->count; i++) {
        const uint32_t both[2] = {found->items[i].a, found->items[i].b};
        for (int k = 0; k < 2; k++) {
            count += !marks[both[k]];
            marks[both[k]] = true;
        }
    }
    for (size_t i = 0; i < found->count; i++) marks[found->items[i].a] = marks[found->items[i].b] = false;
    return count;
}

cscd_status part_sums_run(part_summer *s, const cscd_mesh *mesh, const part_labels *labels,
                          const cscd_intersections *found, const same_solids *same, memory_budget *budget,
                          cscd_part_pairs *out) {
    summing w = {.sums = s, .mesh = mesh, .labels = labels, .found = found, .same = same, .budget = budget};
    cscd_status status = list_keys(&w);
    if (status != CSCD_OK) return status;
    size_t count = 0;
    status = reserve_items(&w, count_part_pairs(w));
    if (status != CSCD_OK) return status;
    for (uint64_t parts; least_parts(&w, &parts); count++) {
        cscd_part_pair *item = &s->items[count];
        *item = (cscd_part_pair){.a = (uint32_t)(parts >> 32), .b = (uint32_t)parts};
        sum_pairs(&w, take_keys(&w.pairs, parts), item);
        sum_pieces(&w, take_keys(&w.pieces, parts), item);
        find_deepest(&w, take_keys(&w.depths, parts), item);
    }
    *out = (cscd_part_pairs){.items = s->items, .count = count, .faces = count_faces(&w)};
    out->share = share_of(out->faces, mesh->triangle_count);
    return CSCD_OK;
}
