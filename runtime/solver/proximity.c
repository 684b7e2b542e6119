/* Pairs of features that are near each other at one moment: how they are found, described, and listed with or without
 * repetitions. */
#include "runtime/solver/near_pairs.h"
#include "runtime/solver/solver.h"

#include "runtime/ccd/ccd.h"
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <string.h>

/* ---- items --------------------------------------------------------------------------------------------- */

/* The data that items are described by. */
typedef struct proximity_scene {
    const cscd_mesh *mesh;
    const double *positions;
    const rest_shape *rest;
    near_rules rules;
} proximity_scene;

/* Returns how many of the four vertices of a stencil belong to the first feature. */
static int vertices_of_first(cscd_contact_kind kind) {
    return points_of_first(stencil_points(kind));
}

static const double *position_of(const proximity_scene *scene, uint32_t vertex) {
    return scene->positions + (size_t)vertex * 3;
}

/* Writes the vector from b's nearest point to a's. */
static void connect_points(const proximity_scene *scene, const cscd_proximity *p, double apart[3]) {
    const double *x[4];
    for (int i = 0; i < 4; i++) x[i] = position_of(scene, p->vertices[i]);
    connection_between(x, p->weights, vertices_of_first(p->kind), apart);
}

/* Lists are compared bit for bit: the struct has no padding. */
_Static_assert(sizeof(cscd_proximity) == 128, "an item fills two lines of a cache");

static void begin_item(const proximity_scene *scene, cscd_contact_kind kind, uint32_t a, uint32_t b, double u,
                       double v, cscd_proximity *p) {
    cscd_stencil s = mesh_stencil(scene->mesh, kind, a, b, u, v);
    memset(p, 0, sizeof *p);
    p->kind = kind;
    p->a = a;
    p->b = b;
    p->separation = near_separation(&scene->rules, kind, a, b);
    memcpy(p->vertices, s.vertices, sizeof p->vertices);
    memcpy(p->weights, s.weights, sizeof p->weights);
}

/* Describes a pair of features as it was found. */
static void proximity_describe(const proximity_scene *scene, const cscd_contact *found, cscd_proximity *out) {
    double apart[3];
    begin_item(scene, found->kind, found->a, found->b, found->u, found->v, out);
    connect_points(scene, out, apart);
    bool vf = found->kind == CSCD_CONTACT_VF, ee = found->kind == CSCD_CONTACT_EE;
    out->distance =
        found->kind == CSCD_CONTACT_VH ? vec3_dot(apart, found->normal) : connection_length(apart);
    out->count = 1;
    out->vf_count = vf;
    out->ee_count = ee;
    out->threshold = ee ? rest_shape_threshold(scene->rest, found->a, found->b) : 0.0;
    out->weight = rest_shape_weight(scene->rest, found->kind, found->a, found->b);
    memcpy(out->normal, found->normal, sizeof out->normal);
}

/* Returns the parameter of the point of an edge that is nearest to a vertex. Squares of differences of coordinates,
 * which are at most 2^301, do not overflow; nor do they underflow, for doubles of 2^-300 and more differ by 2^-352 at
 * the least. */
static double nearest_on_edge(const proximity_scene *scene, uint32_t edge, uint32_t vertex) {
    const uint32_t *ends = scene->mesh->edges[edge];
    double along[3], offset[3];
    vec3_subtract(position_of(scene, ends[1]), position_of(scene, ends[0]), along);
    vec3_subtract(position_of(scene, vertex), position_of(scene, ends[0]), offset);
    double squared = vec3_dot(along, along);
    return squared > 0.0 ? max_of(0.0, min_of(vec3_dot(offset, along) / squared, 1.0)) : 0.0;
}

/* Describes two vertices, or an edge and a vertex, from their positions alone, so that it does not matter which pairs
 * of features they were found by. The numbers of pairs are left 0. */
static void proximity_describe_parts(const proximity_scene *scene, cscd_contact_kind kind, uint32_t a,
                                     uint32_t b, cscd_proximity *out) {
    double apart[3], u = kind == CSCD_CONTACT_EV ? nearest_on_edge(scene, a, b) : 0.0;
    begin_item(scene, kind, a, b, u, 0.0, out);
    connect_points(scene, out, apart);
    out->distance = connection_length(apart);
    for (int k = 0; k < 3; k++) out->normal[k] = out->distance > 0.0 ? apart[k] / out->distance : 0.0;
}

/* The squared length of the cross product of the edges' vectors. */
static double crossing_of(const proximity_scene *scene, uint32_t a, uint32_t b) {
    const uint32_t *ends_a = scene->mesh->edges[a], *ends_b = scene->mesh->edges[b];
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

/* ---- without repetitions ------------------------------------------------------------------------------- */

/* Pairs of features whose nearest points lie on the same two vertices, or on the same edge and vertex, become one item that
 * counts them.
 *
 * The distance of such a pair is that of the two parts, so a sum of energies that depend on the distance alone is the same
 * over all pairs and over the items, each times its count. The energy of two edges may have a mollifier besides, a factor that
 * depends on both edges and is below 1 while they are nearly parallel (Li et al. 2020, eq. 24). Such edges are an item of their
 * own, wherever their nearest points lie; all others have the factor 1. Where a pair passes from one to the other its factor is
 * 1, too, so the sum goes on without a jump. */

/* The number of pairs that one thread names or describes at a time. */
enum { PAIRS_PER_SHARE = 4096 };

/* A pair by the parts that its nearest points lie on. VV: a < b; EV: the edge a and the vertex b. */
typedef struct pair_name {
    cscd_contact_kind kind;
    uint32_t a, b;
    const cscd_contact *contact;
} pair_name;

typedef struct name_key {
    uint64_t key;
    const pair_name *name;
} name_key;

typedef struct merging {
    const proximity_scene *scene;
    const contact_key *pairs;
    pair_name *names;
    name_key *keys;
    size_t *begins; /* of each group of keys with one name, and the end of the last group */
    cscd_proximity *items;
    size_t pair_count, group_count;
} merging;

/* ---- names --------------------------------------------------------------------------------------------- */

static void name_vertices(uint32_t v, uint32_t w, pair_name *name) {
    name->kind = CSCD_CONTACT_VV;
    name->a = v < w ? v : w;
    name->b = v < w ? w : v;
}

static void name_edge_vertex(uint32_t edge, uint32_t vertex, pair_name *name) {
    name->kind = CSCD_CONTACT_EV;
    name->a = edge;
    name->b = vertex;
}

/* The nearest point lies on the corners that weigh more than 0: on one, on two and so on their edge, or inside. */
static void name_vf(const cscd_mesh *mesh, const cscd_contact *c, pair_name *name) {
    bool on[3] = {c->u + c->v<1.0, c->u> 0.0, c->v > 0.0};
    int corners = on[0] + on[1] + on[2];
    for (int i = 0; i < 3; i++) {
        if (corners == 1 && on[i]) name_vertices(c->a, mesh->triangles[c->b][i], name);
        if (corners == 2 && !on[i]) name_edge_vertex(mesh->triangle_edges[c->b][(i + 1) % 3], c->a, name);
    }
}

static void name_ee(const cscd_mesh *mesh, const cscd_contact *c, pair_name *name) {
    bool end_a = c->u == 0.0 || c->u == 1.0, end_b = c->v == 0.0 || c->v == 1.0;
    uint32_t vertex_a = mesh->edges[c->a][c->u == 1.0], vertex_b = mesh->edges[c->b][c->v == 1.0];
    if (end_a && end_b) name_vertices(vertex_a, vertex_b, name);
    if (end_a && !end_b) name_edge_vertex(c->b, vertex_a, name);
    if (end_b && !end_a) name_edge_vertex(c->a, vertex_b, name);
}

/* A point and a wire. Where the point is nearest to an end it may be so to other wires there. */
static void name_ev(const cscd_mesh *mesh, const cscd_contact *c, pair_name *name) {
    if (c->u == 0.0 || c->u == 1.0) name_vertices(mesh->edges[c->a][c->u == 1.0], c->b, name);
}

static void name_pair(const proximity_scene *scene, const cscd_contact *c, pair_name *name) {
    *name = (pair_name){c->kind, c->a, c->b, c};
    if (c->kind == CSCD_CONTACT_VF) name_vf(scene->mesh, c, name);
    if (c->kind == CSCD_CONTACT_EE && !edges_mollified(scene, c->a, c->b)) name_ee(scene->mesh, c, name);
    if (c->kind == CSCD_CONTACT_EV) name_ev(scene->mesh, c, name);
}

static void name_share(void *data, uint32_t index) {
    const merging *m = data;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < m->pair_count; i++) {
        name_pair(m->scene, m->pairs[i].contact, &m->names[i]);
        m->keys[i] = (name_key){m->names[i].b, &m->names[i]};
    }
}

/* ---- groups -------------------------------------------------------------------------------------------- */

/* Sorts by (kind, a, b): first by b, then by kind and a, which keeps the order by b where these are equal. */
static void sort_names(name_key *keys, name_key *spare, size_t count) {
    sort_by_number(keys, spare, count, sizeof *keys);
    for (size_t i = 0; i < count; i++) keys[i].key = (uint64_t)keys[i].name->kind << 32 | keys[i].name->a;
    sort_by_number(keys, spare, count, sizeof *keys);
}

static void find_groups(merging *m) {
    m->group_count = 0;
    for (size_t i = 0; i < m->pair_count; i++) {
        const name_key *key = &m->keys[i];
        if (i == 0 || key->key != key[-1].key || key->name->b != key[-1].name->b)
            m->begins[m->group_count++] = i;
    }
    m->begins[m->group_count] = m->pair_count;
}

static void describe_group(const merging *m, size_t group) {
    const pair_name *name = m->keys[m->begins[group]].name;
    cscd_proximity *item = &m->items[group];
    if (name->kind != CSCD_CONTACT_VV && name->kind != CSCD_CONTACT_EV) {
        proximity_describe(m->scene, name->contact, item);
        return;
    }
    proximity_describe_parts(m->scene, name->kind, name->a, name->b, item);
    for (size_t i = m->begins[group]; i < m->begins[group + 1]; i++) {
        const cscd_contact *pair = m->keys[i].name->contact;
        item->vf_count += pair->kind == CSCD_CONTACT_VF;
        item->ee_count += pair->kind == CSCD_CONTACT_EE;
        item->count++;
        item->weight += rest_shape_weight(m->scene->rest, pair->kind, pair->a, pair->b);
    }
}

static void describe_share(void *data, uint32_t index) {
    const merging *m = data;
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < m->group_count; i++) describe_group(m, i);
}

static void run_shares(cscd_context *context, size_t count, parallel_task *task, merging *m) {
    parallel_run(context->threads, (uint32_t)((count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE), task, m);
}

/* The sorted keys leave their spare ones free for the begins of groups. */
_Static_assert(sizeof(size_t) < sizeof(name_key), "the spare keys have room for one more begin than pairs");

/* Merges `count` pairs, given by keys, into items. *unique says how many there are. They are sorted by (kind, a, b), and the
 * same for any order of the keys, up to the rounding of weights. scratch is grown and kept. */
static cscd_status unique_pairs_list(cscd_context *context, const proximity_scene *scene,
                                     const contact_key *keys, size_t count, result_buffer *scratch,
                                     cscd_proximity *items, size_t *unique) {
    cscd_status status = result_buffer_reserve(context, scratch, count, sizeof(pair_name), sizeof(name_key));
    *unique = 0;
    if (status != CSCD_OK || count == 0) return status;
    merging m = {.scene = scene,
                 .pairs = keys,
                 .names = scratch->items,
                 .keys = scratch->keys,
                 .begins = scratch->spare_keys,
                 .items = items,
                 .pair_count = count};
    run_shares(context, count, name_share, &m);
    sort_names(m.keys, scratch->spare_keys, count);
    find_groups(&m);
    run_shares(context, m.group_count, describe_share, &m);
    *unique = m.group_count;
    return CSCD_OK;
}

/* ---- lists --------------------------------------------------------------------------------------------- */

cscd_status proximity_check_distance(const cscd_detector *d, double distance, cscd_near_form form) {
    const bool beyond = (form & CSCD_NEAR_BEYOND) != 0;
    const double farthest = beyond ? distance + config_greatest_separation(&d->config) : distance;
    if (is_positive_length(distance) && is_positive_length(farthest)) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "distance is %g, expected a length from 2^-300 to 2^300%s", distance,
                        beyond ? ", also with what pairs have to keep added to it" : "");
}

/* The bits that numbers of features of a mesh have. */
static int bits_of_features(const cscd_mesh *mesh) {
    const uint64_t edges = (uint64_t)mesh->edge_count + mesh->loose.point_count;
    uint64_t largest = mesh->vertex_count | edges | mesh->triangle_count | mesh->object_count;
    int bits = 0;
    for (; largest > 0; largest >>= 1) bits++;
    return bits;
}

/* Sorts by (kind, a, b): by one number, as short as it may be, or by b first and then by kind and a, which keeps the order by
 * b where these are equal. */
static void sort_pairs(const cscd_mesh *mesh, contact_key *keys, contact_key *spare, size_t count) {
    enum { KIND_BITS = 3 };
    const int bits = bits_of_features(mesh);
    if (2 * bits + KIND_BITS <= 64) {
        for (size_t i = 0; i < count; i++) {
            const cscd_contact *pair = keys[i].contact;
            keys[i].key = ((uint64_t)pair->kind << bits | pair->a) << bits | pair->b;
        }
        sort_by_number(keys, spare, count, sizeof *keys);
        return;
    }
    for (size_t i = 0; i < count; i++) keys[i].key = keys[i].contact->b;
    sort_by_number(keys, spare, count, sizeof *keys);
    for (size_t i = 0; i < count; i++)
        keys[i].key = (uint64_t)keys[i].contact->kind << 32 | keys[i].contact->a;
    sort_by_number(keys, spare, count, sizeof *keys);
}

/* Names a pair, its nearest points, and what it has to keep; the numbers of pairs, distance and weight are left 0. */
static void name_item(const proximity_scene *scene, const cscd_contact *found, cscd_proximity *out) {
    memset(out, 0, sizeof *out);
    out->kind = found->kind;
    out->a = found->a;
    out->b = found->b;
    out->separation = near_separation(&scene->rules, found->kind, found->a, found->b);
    const cscd_stencil s = mesh_stencil(scene->mesh, found->kind, found->a, found->b, found->u, found->v);
    memcpy(out->vertices, s.vertices, sizeof out->vertices);
    memcpy(out->weights, s.weights, sizeof out->weights);
    memcpy(out->normal, found->normal, sizeof out->normal);
}

/* The items that tasks describe, and the context that they ask whether the call goes on. */
typedef struct description {
    bool bare; /* items get what division needs, and nothing else */
    progress *progress;
    proximity_scene scene;
    const contact_key *keys;
    cscd_proximity *items;
    size_t count;
} description;

/* Sorted pairs lie anywhere in the workers' memory, so they are fetched ahead. */
enum { PAIRS_AHEAD = 12 };

static void describe_found(void *data, uint32_t index) {
    const description *d = data;
    if (!progress_go_on(d->progress, 1.0)) return; /* the call ends, and nobody must read the list */
    size_t begin = (size_t)index * PAIRS_PER_SHARE, end = begin + PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < d->count; i++) {
        if (i + PAIRS_AHEAD < d->count) {
            const char *next = (const char *)d->keys[i + PAIRS_AHEAD].contact;
            __builtin_prefetch(next);
            __builtin_prefetch(next + CACHE_LINE_SIZE);
        }
        (d->bare ? name_item : proximity_describe)(&d->scene, d->keys[i].contact, &d->items[i]);
    }
}

/* A call that has been cancelled fails here: callers look at what the items name. */
static cscd_status describe_pairs(cscd_detector *d, const proximity_scene *scene, size_t count, bool bare) {
    result_buffer *buffer = &d->results.proximities;
    sort_pairs(d->mesh, buffer->keys, buffer->spare_keys, count);
    description all = {bare, &d->context->progress, *scene, buffer->keys, buffer->items, count};
    uint32_t shares = (uint32_t)((count + PAIRS_PER_SHARE - 1) / PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, describe_found, &all);
    return context_progress_status(d->context);
}

static cscd_status collect_items(cscd_detector *d, const double *positions, cscd_near_form form, bool bare,
                                 cscd_proximities *out) {
    result_buffer *buffer = &d->results.proximities;
    proximity_scene scene = {d->mesh, positions, &d->config.rest, {d->mesh, &d->config}};
    size_t found, count;
    cscd_status status =
        contact_list_gather(&d->space, &d->config.exclusions, sizeof(cscd_proximity), buffer, &found);
    if (status == CSCD_LIST_TOO_LONG) {
        *out = (cscd_proximities){.count = found};
        return list_cap_fail(d->context, &d->interval.cap, found);
    }
    if (status != CSCD_OK) return status;
    count = found;
    if ((form & CSCD_NEAR_UNIQUE) != 0) {
        /* so that weights are summed up in one order by any number of threads */
        if (scene.rest->squared_lengths != NULL) sort_pairs(d->mesh, buffer->keys, buffer->spare_keys, found);
        status = unique_pairs_list(d->context, &scene, buffer->keys, found, &d->results.names, buffer->items,
                                   &count);
    } else {
        status = describe_pairs(d, &scene, count, bare);
    }
    if (status == CSCD_OK) *out = (cscd_proximities){buffer->items, count};
    return status;
}

cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_near_form form,
                              cscd_proximities *out) {
    return collect_items(d, positions, form, false, out);
}

void proximity_complete(cscd_detector *d, const double *positions, size_t item) {
    result_buffer *buffer = &d->results.proximities;
    const contact_key *keys = buffer->keys;
    cscd_proximity *items = buffer->items;
    proximity_scene scene = {d->mesh, positions, &d->config.rest, {d->mesh, &d->config}};
    proximity_describe(&scene, keys[item].contact, &items[item]);
}

cscd_status proximity_check_form(cscd_context *context, cscd_near_form form) {
    if ((unsigned)form <= (CSCD_NEAR_UNIQUE | CSCD_NEAR_BEYOND)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "unknown form %d, expected CSCD_NEAR_PAIRS or CSCD_NEAR_UNIQUE, and CSCD_NEAR_BEYOND "
                        "or not",
                        (int)form);
}

/* The distance that volumes are widened by, and the objects' own ones besides. */
static volume_growth near_growth(const cscd_detector *d, double distance, cscd_near_form form) {
    if ((form & CSCD_NEAR_BEYOND) == 0) return uniform_growth(distance);
    volume_growth growth = config_growth(&d->config);
    growth.beyond = distance;
    return growth;
}

interval_search proximity_search(cscd_detector *d, const double *positions, double distance,
                                 cscd_near_form form) {
    const volume_growth growth = near_growth(d, distance, form);
    const double same = growth.distance + growth.beyond;
    interval_search search = interval_search_begin(&d->space, positions, positions, proximity_limit(same));
    if (growth.of_objects != NULL) {
        search.interval.limit = d->config.limit;
        search.interval.thick = true;
        search.interval.activation = distance;
    }
    list_cap_begin(&d->interval, &search, CAP_TAINTS_LEFT_OUT);
    return search;
}

/* Searches the moment; the trees are widened by the growth. */
static cscd_status search_moment(cscd_detector *d, interval_search *search, volume_growth growth) {
    cscd_status status = CSCD_OK;
    if (d->config.stages->brute_force) {
        status = interval_search_by_brute_force(search);
    } else {
        status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, search->interval.x0, growth,
                                     config_growth(&d->config));
        if (status == CSCD_OK) status = interval_search_everything(search);
        if (status == CSCD_OK) status = interval_search_loose(search);
    }
    return status;
}

cscd_status proximity_find(cscd_detector *d, const double *positions, double distance, cscd_near_form form,
                           cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, distance, form);
    cscd_status status = search_moment(d, &search, near_growth(d, distance, form));
    return status == CSCD_OK ? collect_items(d, positions, form, false, out) : status;
}

/* Pairs that nearly touch are found also where nothing moves, for the caller is told of them. */
static const double nearly_touching = 0x1p-10;

cscd_status proximity_find_on_ways(cscd_detector *d, const double *positions, const near_ways *ways,
                                   cscd_proximities *out) {
    interval_search search = proximity_search(d, positions, ways->farthest, CSCD_NEAR_PAIRS);
    search.interval.ways = ways->ways;
    search.interval.ways_kept = config_greatest_separation(&d->config);
    search.interval.ways_least = nearly_touching * (ways->farthest - search.interval.ways_kept);
    cscd_status status = search_moment(d, &search, uniform_growth(ways->farthest));
    return status == CSCD_OK ? collect_items(d, positions, CSCD_NEAR_PAIRS, true, out) : status;
}

static cscd_status find_near_at(cscd_detector *d, const double *positions, double distance,
                                cscd_near_form form, cscd_proximities *out) {
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, positions);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_look(&waiting, positions);
    if (status == CSCD_OK) status = proximity_find(d, positions, distance, form, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    return status == CSCD_OK ? CSCD_OK : detector_fail_call(d, status);
}

static cscd_status find_near_views(cscd_detector *detector, const cscd_view *positions, double distance,
                                   cscd_near_form form, cscd_proximities *out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_near: out is NULL");
    const double *x = NULL;
    cscd_proximities found;
    cscd_status status = proximity_check_form(context, form);
    if (status == CSCD_OK) status = proximity_check_distance(detector, distance, form);
    if (status == CSCD_OK)
        status = views_read(context, detector->mesh, positions, "positions", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = find_near_at(detector, x, distance, form, &found);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_find_near(cscd_detector *detector, const cscd_view *positions, double distance,
                                    cscd_near_form form, cscd_proximities *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, find_near_views(detector, positions, distance, form, out));
}
