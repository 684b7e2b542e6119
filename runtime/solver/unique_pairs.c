/* Proximities without repetitions: pairs of features whose nearest points lie on the same two vertices, or on the same
 * edge and vertex, become one item that counts them.
 *
 * The distance of such a pair is that of the two parts, so a sum of energies that depend on the distance alone is the
 * same over all pairs and over the items, each times its count. The energy of two edges may have a mollifier besides,
 * a factor that depends on both edges and is below 1 while they are nearly parallel (Li et al. 2020, eq. 24). Such
 * edges are an item of their own, wherever their nearest points lie; all others have the factor 1. Where a pair passes
 * from one to the other its factor is 1, too, so the sum goes on without a jump. */
#include "runtime/solver/unique_pairs.h"

#include "src/core/sort.h"

/* One thread names, or describes, so many at a time. */
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
        cscd_contact_kind kind = m->keys[i].name->contact->kind;
        item->vf_count += kind == CSCD_CONTACT_VF;
        item->ee_count += kind == CSCD_CONTACT_EE;
        item->count++;
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

cscd_status unique_pairs_list(cscd_context *context, const proximity_scene *scene, const contact_key *keys,
                              size_t count, result_buffer *scratch, cscd_proximity *items, size_t *unique) {
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
