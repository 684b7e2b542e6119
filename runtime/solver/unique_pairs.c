/* Lists of near pairs in which no two items have the same nearest features.
 *
 * Pairs of features whose nearest points lie on the same two vertices, or on the same edge and vertex, become one item that
 * counts them. The distance of such a pair is that of the two parts, so a sum of energies that depend on the distance alone is the
 * same over all pairs and over the items, each times its count. The energy of two edges may have a mollifier besides, a factor that
 * depends on both edges and is below 1 while they are nearly parallel (Li et al. 2020, eq. 24). Such edges are an item of their
 * own, wherever their nearest points lie; all others have the factor 1. Where a pair passes from one to the other its factor is
 * 1, too, so the sum goes on without a jump. */
#include "runtime/solver/unique_pairs.h"

#include "runtime/ccd/ccd.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <string.h>

/* The number of pairs that one thread names or describes at a time. */
enum { PAIRS_PER_SHARE = 4096 };

/* A pair of the list by the parts that its nearest points lie on, which are all the same in a group. `parts` is a, and b in the low
 * bits, as many as the list has for b: VV: a < b; EV: the edge a and the vertex b. */
typedef struct part_name {
    uint64_t parts;
    uint64_t pair; /* its place in the list, and in the highest three bits what kind the parts are */
} part_name;

enum { KIND_SHIFT = 61 };

static uint64_t kind_of(const part_name *name) {
    return name->pair >> KIND_SHIFT;
}

static size_t pair_of(const part_name *name) {
    return (size_t)(name->pair & ((UINT64_C(1) << KIND_SHIFT) - 1));
}

typedef struct merging {
    const proximity_scene *scene;
    progress *progress;
    part_name *names;
    size_t *begins; /* of each group of names, and the end of the last group */
    cscd_proximity *items;
    size_t group_count;
} merging;

static const double *position_of(const proximity_scene *scene, uint32_t vertex) {
    return scene->place.positions + (size_t)vertex * 3;
}

/* ---- names --------------------------------------------------------------------------------------------- */

static void set_name(int bits, cscd_contact_kind kind, uint32_t a, uint32_t b, part_name *name) {
    name->pair = (uint64_t)kind << KIND_SHIFT | pair_of(name);
    name->parts = (uint64_t)a << bits | b;
}

static void name_vertices(int bits, uint32_t v, uint32_t w, part_name *name) {
    set_name(bits, CSCD_CONTACT_VV, v < w ? v : w, v < w ? w : v, name);
}

/* The nearest point lies on the corners that weigh more than 0: on one, on two and so on their edge, or inside. */
static void name_vf(const cscd_mesh *mesh, int bits, const near_eight *p, uint32_t at, part_name *name) {
    const uint32_t vertex = p->a[at], face = p->b[at];
    const double u = p->at.u[at], v = p->at.v[at];
    bool on[3] = {u + v<1.0, u> 0.0, v > 0.0};
    int corners = on[0] + on[1] + on[2];
    for (int i = 0; i < 3; i++) {
        if (corners == 1 && on[i]) name_vertices(bits, vertex, mesh->triangles[face][i], name);
        if (corners == 2 && !on[i])
            set_name(bits, CSCD_CONTACT_EV, mesh->triangle_edges[face][(i + 1) % 3], vertex, name);
    }
}

static void name_ee(const cscd_mesh *mesh, int bits, const near_eight *p, uint32_t at, part_name *name) {
    const double u = p->at.u[at], v = p->at.v[at];
    bool end_a = u == 0.0 || u == 1.0, end_b = v == 0.0 || v == 1.0;
    uint32_t vertex_a = mesh->edges[p->a[at]][u == 1.0], vertex_b = mesh->edges[p->b[at]][v == 1.0];
    if (end_a && end_b) name_vertices(bits, vertex_a, vertex_b, name);
    if (end_a && !end_b) set_name(bits, CSCD_CONTACT_EV, p->b[at], vertex_a, name);
    if (end_b && !end_a) set_name(bits, CSCD_CONTACT_EV, p->a[at], vertex_b, name);
}

/* A point and a wire. Where the point is nearest to an end it may be so to other wires there. */
static void name_ev(const cscd_mesh *mesh, int bits, const near_eight *p, uint32_t at, part_name *name) {
    const double u = p->at.u[at];
    if (u == 0.0 || u == 1.0) name_vertices(bits, mesh->edges[p->a[at]][u == 1.0], p->b[at], name);
}

/* The squared length of the cross product of the edges' vectors. */
static double crossing_of(const proximity_scene *scene, uint32_t a, uint32_t b) {
    const uint32_t *ends_a = scene->place.mesh->edges[a], *ends_b = scene->place.mesh->edges[b];
    double along_a[3], along_b[3], across[3];
    vec3_subtract(position_of(scene, ends_a[1]), position_of(scene, ends_a[0]), along_a);
    vec3_subtract(position_of(scene, ends_b[1]), position_of(scene, ends_b[0]), along_b);
    vec3_cross(along_a, along_b, across);
    return vec3_dot(across, across);
}

/* True if two edges are so nearly parallel that the mollifier of their energy is below 1. A crossing that overflows is above
 * every threshold; one that underflows is below every threshold that is not 0. */
static bool edges_mollified(const proximity_scene *scene, uint32_t a, uint32_t b) {
    double threshold = rest_shape_threshold(scene->rest, a, b);
    return threshold > 0.0 && crossing_of(scene, a, b) < threshold;
}

static void name_pair(const proximity_scene *scene, const near_eight *p, uint32_t i, part_name *name) {
    const cscd_mesh *mesh = scene->place.mesh;
    const int bits = scene->place.list->bits;
    set_name(bits, p->kind, p->a[i], p->b[i], name);
    if (p->kind == CSCD_CONTACT_VF) name_vf(mesh, bits, p, i, name);
    if (p->kind == CSCD_CONTACT_EE && !edges_mollified(scene, p->a[i], p->b[i]))
        name_ee(mesh, bits, p, i, name);
    if (p->kind == CSCD_CONTACT_EV) name_ev(mesh, bits, p, i, name);
}

static void name_share(void *data, uint32_t index) {
    const merging *m = data;
    const near_scene *place = &m->scene->place;
    if (!progress_go_on(m->progress, 1.0)) return;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    near_eight found;
    if (end > place->list->count) end = place->list->count;
    for (; begin < end; begin += found.count) {
        near_list_describe_from(place, begin, end, &found);
        for (uint32_t i = 0; i < found.count; i++) {
            m->names[begin + i].pair = begin + i;
            name_pair(m->scene, &found, i, &m->names[begin + i]);
        }
    }
}

/* ---- groups -------------------------------------------------------------------------------------------- */

/* Sorts by kind and name; names of one group stay in the order of their pairs. Those of other kinds than VV and EV are in order
 * already, as their pairs are. */
static void sort_names(part_name *names, part_name *spare, size_t count) {
    size_t places[CSCD_CONTACT_VH + 2] = {0};
    memcpy(spare, names, count * sizeof *names);
    for (size_t i = 0; i < count; i++) places[kind_of(&spare[i]) + 1]++;
    for (int kind = 0; kind < CSCD_CONTACT_VH; kind++) places[kind + 1] += places[kind];
    for (size_t i = 0; i < count; i++) names[places[kind_of(&spare[i])]++] = spare[i];
    for (int kind = CSCD_CONTACT_VV; kind <= CSCD_CONTACT_EV; kind++) {
        const size_t begin = places[kind - 1], end = places[kind];
        if (end > begin) sort_by_number(names + begin, spare, end - begin, sizeof *names);
    }
}

static void find_groups(merging *m) {
    m->group_count = 0;
    for (size_t i = 0; i < m->scene->place.list->count; i++) {
        const part_name *name = &m->names[i];
        if (i == 0 || name->parts != name[-1].parts || kind_of(name) != kind_of(&name[-1]))
            m->begins[m->group_count++] = i;
    }
    m->begins[m->group_count] = m->scene->place.list->count;
}

/* ---- items --------------------------------------------------------------------------------------------- */

/* Returns the parameter of the point of an edge that is nearest to a vertex. Squares of differences of coordinates,
 * which are at most 2^301, do not overflow; nor do they underflow, for doubles of 2^-300 and more differ by 2^-352 at
 * the least. */
static double nearest_on_edge(const proximity_scene *scene, uint32_t edge, uint32_t vertex) {
    const uint32_t *ends = scene->place.mesh->edges[edge];
    double along[3], offset[3];
    vec3_subtract(position_of(scene, ends[1]), position_of(scene, ends[0]), along);
    vec3_subtract(position_of(scene, vertex), position_of(scene, ends[0]), offset);
    double squared = vec3_dot(along, along);
    return squared > 0.0 ? max_of(0.0, min_of(vec3_dot(offset, along) / squared, 1.0)) : 0.0;
}

/* Describes two vertices, or an edge and a vertex, from their positions alone, so that it does not matter which pairs
 * of features they were found by. */
static void describe_parts(const proximity_scene *scene, const part_name *name, near_eight *out) {
    const double *x[4];
    double apart[3];
    const int bits = scene->place.list->bits;
    *out = (near_eight){.kind = (cscd_contact_kind)kind_of(name),
                        .count = 1,
                        .a = {(uint32_t)(name->parts >> bits)},
                        .b = {(uint32_t)(name->parts & ((UINT64_C(1) << bits) - 1))}};
    if (out->kind == CSCD_CONTACT_EV) out->at.u[0] = nearest_on_edge(scene, out->a[0], out->b[0]);
    const cscd_stencil s =
        mesh_stencil(scene->place.mesh, out->kind, out->a[0], out->b[0], out->at.u[0], 0.0);
    for (int i = 0; i < 4; i++) x[i] = position_of(scene, s.vertices[i]);
    connection_between(x, s.weights, points_of_first(stencil_points(out->kind)), apart);
    const double distance = connection_length(apart);
    out->at.distance[0] = distance;
    for (int k = 0; k < 3; k++) out->at.normal[k][0] = distance > 0.0 ? apart[k] / distance : 0.0;
}

/* Counts the pairs of an item, and sums up their weights in order. */
static void count_pairs(const merging *m, size_t group, cscd_proximity *item) {
    const near_list *list = m->scene->place.list;
    item->count = item->vf_count = item->ee_count = 0;
    item->weight = 0.0;
    for (size_t i = m->begins[group]; i < m->begins[group + 1]; i++) {
        const cscd_contact_kind kind = near_list_kind(list, pair_of(&m->names[i]));
        item->vf_count += kind == CSCD_CONTACT_VF;
        item->ee_count += kind == CSCD_CONTACT_EE;
        item->count++;
        if (m->scene->rest->squared_lengths == NULL) {
            item->weight += 1.0;
        } else {
            uint32_t a, b;
            near_list_name(list, pair_of(&m->names[i]), &a, &b);
            item->weight += rest_shape_weight(m->scene->rest, kind, a, b);
        }
    }
}

static bool is_of_parts(const merging *m, size_t group) {
    const uint64_t kind = kind_of(&m->names[m->begins[group]]);
    return kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_EV;
}

/* Describes the groups from one on that are single pairs of one kind, up to eight, and returns their number. */
static uint32_t describe_single(const merging *m, size_t group, size_t end) {
    near_eight found;
    size_t pairs[LANES];
    uint32_t count = 0;
    const uint64_t kind = kind_of(&m->names[m->begins[group]]);
    for (; count < LANES && group + count < end; count++) {
        const part_name *name = &m->names[m->begins[group + count]];
        if (kind_of(name) != kind) break;
        pairs[count] = pair_of(name);
    }
    near_list_describe(&m->scene->place, pairs, count, &found);
    for (uint32_t i = 0; i < count; i++) proximity_write(m->scene, &found, i, &m->items[group + i]);
    return count;
}

static void describe_share(void *data, uint32_t index) {
    const merging *m = data;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    if (end > m->group_count) end = m->group_count;
    for (size_t i = begin; i < end;) {
        if (!is_of_parts(m, i)) {
            i += describe_single(m, i, end);
            continue;
        }
        near_eight parts;
        describe_parts(m->scene, &m->names[m->begins[i]], &parts);
        proximity_write(m->scene, &parts, 0, &m->items[i]);
        count_pairs(m, i, &m->items[i]);
        i++;
    }
}

static void run_shares(cscd_context *context, size_t count, parallel_task *task, merging *m) {
    parallel_run(context->threads, (uint32_t)((count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE), task, m);
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

/* The sorted names leave their spare ones free for the begins of groups. */
_Static_assert(sizeof(size_t) < sizeof(part_name), "the spare names have room for one more begin than pairs");

cscd_status unique_pairs_list(cscd_context *context, const proximity_scene *scene, near_list *list,
                              result_buffer *scratch, result_buffer *items, size_t *count) {
    cscd_status status = result_buffer_reserve(context, scratch, list->count, 0, sizeof(part_name));
    *count = 0;
    if (status != CSCD_OK) return status;
    merging m = {.scene = scene,
                 .progress = &context->progress,
                 .names = scratch->keys,
                 .begins = scratch->spare_keys};
    near_list_sort(list, scratch->spare_keys);
    run_shares(context, list->count, name_share, &m);
    status = context_progress_status(context);
    if (status != CSCD_OK) return status;
    sort_names(m.names, scratch->spare_keys, list->count);
    find_groups(&m);
    status = result_buffer_reserve_items(context, items, m.group_count, sizeof(cscd_proximity));
    if (status != CSCD_OK) return status;
    m.items = items->items;
    run_shares(context, m.group_count, describe_share, &m);
    *count = m.group_count;
    return CSCD_OK;
}
