/* Brute force over features, which every method must equal. */
#include "tests/support/oracle.h"

#include "tests/support/ccd/queue_test.h"
#include "tests/support/collapsed_oracle.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct edge {
    uint32_t ends[2];
} edge;

static int compare_edges(const void *left, const void *right) {
    const edge *l = left, *r = right;
    if (l->ends[0] != r->ends[0]) return l->ends[0] < r->ends[0] ? -1 : 1;
    return l->ends[1] < r->ends[1] ? -1 : l->ends[1] > r->ends[1];
}

static uint32_t find_edges(const scene *s, edge *edges) {
    uint32_t count = s->triangle_count * 3, kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = s->triangles[i], b = s->triangles[i / 3 * 3 + (i + 1) % 3];
        edges[i] = a < b ? (edge){{a, b}} : (edge){{b, a}};
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || compare_edges(&edges[i - 1], &edges[i]) != 0) edges[kept++] = edges[i];
    }
    return kept;
}

static void add_contact(oracle_list *list, cscd_contact_kind kind, uint32_t a, uint32_t b, double toi) {
    if (list->count == list->capacity) {
        list->capacity = list->capacity * 2 + 64;
        list->items = realloc(list->items, list->capacity * sizeof *list->items);
        if (list->items == NULL) abort();
    }
    list->items[list->count++] = (oracle_contact){kind, a, b, toi};
}

static elementary_query load_query(const scene *s, const uint32_t vertices[4]) {
    elementary_query query;
    for (int i = 0; i < 4; i++) {
        memcpy(query.x0[i], s->x0 + (size_t)vertices[i] * 3, sizeof query.x0[i]);
        memcpy(query.x1[i], s->x1 + (size_t)vertices[i] * 3, sizeof query.x1[i]);
    }
    return query;
}

/* Feature pairs of one kind that wait for their test. */
typedef struct queued_pairs {
    const scene *scene;
    const separation *limit;   /* NULL for contacts */
    const oracle_rules *rules; /* NULL: the limit is that of all pairs */
    const bool *collapsed;     /* per vertex, at an end */
    bool apart;                /* with rules: pairs with a distance; else those that must not touch */
    cscd_contact_kind kind;
    edge *edges;
    uint32_t (*pairs)[2];
    size_t count, capacity;
} queued_pairs;

static double pair_distance(const queued_pairs *w, uint32_t a, uint32_t b) {
    const uint32_t *objects = w->rules->vertex_objects;
    bool vf = w->kind == CSCD_CONTACT_VF;
    uint32_t first = objects[vf ? a : w->edges[a].ends[0]];
    uint32_t second = objects[vf ? w->scene->triangles[(size_t)b * 3] : w->edges[b].ends[0]];
    return w->rules->distances[(size_t)first * w->rules->object_count + second];
}

/* Are both features of components that are collapsed at an end? */
static bool is_collapsed(const queued_pairs *w, uint32_t a, uint32_t b) {
    bool vf = w->kind == CSCD_CONTACT_VF;
    return w->collapsed[vf ? a : w->edges[a].ends[0]] &&
           w->collapsed[vf ? w->scene->triangles[(size_t)b * 3] : w->edges[b].ends[0]];
}

static void add_pair(queued_pairs *w, uint32_t a, uint32_t b) {
    if (is_collapsed(w, a, b)) return;
    if (w->rules != NULL) {
        double distance = pair_distance(w, a, b);
        if (distance < 0.0 || w->apart != (distance > 0.0)) return;
    }
    if (w->count == w->capacity) {
        w->capacity = w->capacity * 2 + 1024;
        w->pairs = realloc(w->pairs, w->capacity * sizeof *w->pairs);
        if (w->pairs == NULL) abort();
    }
    w->pairs[w->count][0] = a;
    w->pairs[w->count++][1] = b;
}

/* Finds contacts as a step does, through the feature queue. */
static void find_contacts(const queued_pairs *w, oracle_list *out) {
    size_t count;
    const feature_source source = {w->scene->x0, w->scene->x1, (const uint32_t(*)[3])w->scene->triangles,
                                   (const uint32_t(*)[2])w->edges};
    const cscd_contact *contacts =
        pair_test_source(&source, w->kind, (const uint32_t(*)[2])w->pairs, w->count, &count);
    for (size_t i = 0; i < count; i++)
        add_contact(out, w->kind, contacts[i].a, contacts[i].b, contacts[i].toi);
}

/* Are all points of one feature farther along an axis than all points of the other, throughout? */
static bool far_apart(const elementary_query *query, cscd_contact_kind kind, double distance) {
    int first = kind == CSCD_CONTACT_VF ? 1 : 2;
    for (int k = 0; k < 3; k++) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < 4; i++) {
            double *l = &low[i >= first], *h = &high[i >= first];
            *l = fmin(*l, fmin(query->x0[i][k], query->x1[i][k]));
            *h = fmax(*h, fmax(query->x0[i][k], query->x1[i][k]));
        }
        if (low[1] - high[0] > distance || low[0] - high[1] > distance) return true;
    }
    return false;
}

static void find_within(const queued_pairs *w, oracle_list *out) {
    for (size_t i = 0; i < w->count; i++) {
        uint32_t a = w->pairs[i][0], b = w->pairs[i][1];
        const uint32_t *corners = w->scene->triangles + (size_t)b * 3;
        bool vf = w->kind == CSCD_CONTACT_VF, bounded;
        elementary_contact hit;
        elementary_query query =
            vf ? load_query(w->scene, (uint32_t[4]){a, corners[0], corners[1], corners[2]})
               : load_query(w->scene, (uint32_t[4]){w->edges[a].ends[0], w->edges[a].ends[1],
                                                    w->edges[b].ends[0], w->edges[b].ends[1]});
        separation limit = w->limit != NULL ? *w->limit : (separation){.distance = pair_distance(w, a, b)};
        if (w->limit == NULL) limit.tolerance = 1e-6 * limit.distance;
        if (far_apart(&query, w->kind, limit.distance)) continue;
        bool found = vf ? separation_vf(&query, &limit, &hit, &bounded)
                        : separation_ee(&query, &limit, &hit, &bounded);
        if (found) add_contact(out, w->kind, a, b, hit.toi);
    }
}

static void test_pairs(queued_pairs *w, oracle_list *out) {
    if (w->limit == NULL && !w->apart)
        find_contacts(w, out);
    else
        find_within(w, out);
    free(w->pairs);
}

static void find_vf(queued_pairs pairs, oracle_list *out) {
    const scene *s = pairs.scene;
    bool used[SCENE_VERTICES_MAX] = {false};
    pairs.kind = CSCD_CONTACT_VF;
    for (uint32_t i = 0; i < s->triangle_count * 3; i++) used[s->triangles[i]] = true;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        for (uint32_t t = 0; used[v] && t < s->triangle_count; t++) {
            const uint32_t *c = s->triangles + (size_t)t * 3;
            if (c[0] != v && c[1] != v && c[2] != v) add_pair(&pairs, v, t);
        }
    }
    test_pairs(&pairs, out);
}

static void find_ee(queued_pairs pairs, oracle_list *out) {
    static edge edges[SCENE_TRIANGLES_MAX * 3];
    uint32_t count = find_edges(pairs.scene, edges);
    pairs.kind = CSCD_CONTACT_EE;
    pairs.edges = edges;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            const uint32_t *a = edges[i].ends, *b = edges[j].ends;
            if (a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1]) add_pair(&pairs, i, j);
        }
    }
    test_pairs(&pairs, out);
}

static int compare_contacts(const void *left, const void *right) {
    const oracle_contact *l = left, *r = right;
    if (l->toi != r->toi) return l->toi < r->toi ? -1 : 1;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void find_both(queued_pairs pairs, oracle_list *out) {
    static bool collapsed[SCENE_VERTICES_MAX];
    collapsed_oracle_at_ends(pairs.scene, NULL, collapsed);
    pairs.collapsed = collapsed;
    find_vf(pairs, out);
    find_ee(pairs, out);
    if (out->count > 0) qsort(out->items, out->count, sizeof *out->items, compare_contacts);
}

void oracle_find(const scene *s, oracle_list *out) {
    oracle_find_within(s, NULL, out);
}

void oracle_find_within(const scene *s, const separation *limit, oracle_list *out) {
    out->count = 0;
    find_both((queued_pairs){.scene = s, .limit = limit}, out);
}

void oracle_find_by_rules(const scene *s, const oracle_rules *rules, oracle_list *out) {
    out->count = 0;
    find_both((queued_pairs){.scene = s, .rules = rules}, out);
    find_both((queued_pairs){.scene = s, .rules = rules, .apart = true}, out);
}

void oracle_expect(const oracle_list *truth, const cscd_contacts *found) {
    assert_int_equal(found->count, truth->count);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        const oracle_contact *t = &truth->items[i];
        assert_true(c->kind == t->kind && c->a == t->a && c->b == t->b && c->toi == t->toi);
    }
}

void oracle_free(oracle_list *list) {
    free(list->items);
    *list = (oracle_list){0};
}
