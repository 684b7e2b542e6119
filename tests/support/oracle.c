/* Brute force over features: what every method must equal. */
#include "tests/support/oracle.h"

#include "runtime/ccd/elementary.h"

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

static void test_pair(const elementary_query *query, const separation *limit, cscd_contact_kind kind,
                      uint32_t a, uint32_t b, oracle_list *out) {
    elementary_hit hit;
    bool vf = kind == CSCD_CONTACT_VF, bounded;
    bool found = limit == NULL ? (vf ? elementary_vf : elementary_ee)(query, &hit).touching
                               : (vf ? separation_vf : separation_ee)(query, limit, &hit, &bounded);
    if (found) add_contact(out, kind, a, b, hit.toi);
}

static void find_vf(const scene *s, const separation *limit, oracle_list *out) {
    bool used[SCENE_VERTICES_MAX] = {false};
    for (uint32_t i = 0; i < s->triangle_count * 3; i++) used[s->triangles[i]] = true;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        for (uint32_t t = 0; used[v] && t < s->triangle_count; t++) {
            const uint32_t *c = s->triangles + (size_t)t * 3;
            if (c[0] == v || c[1] == v || c[2] == v) continue;
            elementary_query query = load_query(s, (uint32_t[4]){v, c[0], c[1], c[2]});
            test_pair(&query, limit, CSCD_CONTACT_VF, v, t, out);
        }
    }
}

static void find_ee(const scene *s, const separation *limit, oracle_list *out) {
    static edge edges[SCENE_TRIANGLES_MAX * 3];
    uint32_t count = find_edges(s, edges);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            const uint32_t *a = edges[i].ends, *b = edges[j].ends;
            if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
            elementary_query query = load_query(s, (uint32_t[4]){a[0], a[1], b[0], b[1]});
            test_pair(&query, limit, CSCD_CONTACT_EE, i, j, out);
        }
    }
}

static int compare_contacts(const void *left, const void *right) {
    const oracle_contact *l = left, *r = right;
    if (l->toi != r->toi) return l->toi < r->toi ? -1 : 1;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

void oracle_find(const scene *s, oracle_list *out) {
    oracle_find_within(s, NULL, out);
}

void oracle_find_within(const scene *s, const separation *limit, oracle_list *out) {
    out->count = 0;
    find_vf(s, limit, out);
    find_ee(s, limit, out);
    if (out->count > 0) qsort(out->items, out->count, sizeof *out->items, compare_contacts);
}

void oracle_free(oracle_list *list) {
    free(list->items);
    *list = (oracle_list){0};
}
