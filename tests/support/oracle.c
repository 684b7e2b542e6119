/* Brute force over features, which every method must equal; which components are collapsed, and when they first
 * touch themselves. */
#include "tests/support/oracle.h"

#include "src/mesh/predicates.h"
#include "tests/support/ccd/elementary_cases.h"
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

/* A vertex, a triangle or an edge, and the box of its whole motion: what is apart along an axis cannot touch. */
typedef struct swept_feature {
    uint32_t vertices[3];
    int count;
    double low[3], high[3];
} swept_feature;

static swept_feature sweep_feature(const scene *s, const uint32_t *vertices, int count) {
    swept_feature f = {.count = count};
    for (int k = 0; k < 3; k++) {
        f.low[k] = INFINITY;
        f.high[k] = -INFINITY;
        for (int i = 0; i < count; i++) {
            double x0 = s->x0[(size_t)vertices[i] * 3 + (size_t)k],
                   x1 = s->x1[(size_t)vertices[i] * 3 + (size_t)k];
            f.vertices[i] = vertices[i];
            f.low[k] = fmin(f.low[k], fmin(x0, x1));
            f.high[k] = fmax(f.high[k], fmax(x0, x1));
        }
    }
    return f;
}

/* Is all of one feature farther along an axis than all of the other, throughout? Exact for distance 0. */
static bool far_apart(const swept_feature *a, const swept_feature *b, double distance) {
    for (int k = 0; k < 3; k++) {
        if (b->low[k] - a->high[k] > distance || a->low[k] - b->high[k] > distance) return true;
    }
    return false;
}

static bool share_vertex(const swept_feature *a, const swept_feature *b) {
    for (int i = 0; i < a->count; i++) {
        for (int j = 0; j < b->count; j++) {
            if (a->vertices[i] == b->vertices[j]) return true;
        }
    }
    return false;
}

typedef struct queued_list {
    uint32_t (*pairs)[2];
    size_t count, capacity;
} queued_list;

/* How all feature pairs are looked at, and those of one kind that wait for their test. */
typedef struct queued_pairs {
    const scene *scene;
    const separation *limit;   /* NULL for contacts */
    const oracle_rules *rules; /* NULL: the limit is that of all pairs */
    double reach;              /* the largest distance of a pair */
    const bool *collapsed;     /* per vertex, at an end */
    cscd_contact_kind kind;
    const swept_feature *first, *second;
    queued_list touching, within; /* what must not touch, and what has a distance to keep */
} queued_pairs;

static double pair_distance(const queued_pairs *w, const swept_feature *a, const swept_feature *b) {
    if (w->rules == NULL) return w->reach;
    const uint32_t *objects = w->rules->vertex_objects;
    return w->rules
        ->distances[(size_t)objects[a->vertices[0]] * w->rules->object_count + objects[b->vertices[0]]];
}

static void add_pair(queued_pairs *w, uint32_t i, uint32_t j) {
    const swept_feature *a = &w->first[i], *b = &w->second[j];
    if (far_apart(a, b, w->reach) || share_vertex(a, b)) return;
    if (w->collapsed[a->vertices[0]] && w->collapsed[b->vertices[0]]) return;
    const double distance = pair_distance(w, a, b);
    if (distance < 0.0 || far_apart(a, b, distance)) return;
    queued_list *list = distance > 0.0 || w->limit != NULL ? &w->within : &w->touching;
    if (list->count == list->capacity) {
        list->capacity = list->capacity * 2 + 1024;
        list->pairs = realloc(list->pairs, list->capacity * sizeof *list->pairs);
        if (list->pairs == NULL) abort();
    }
    list->pairs[list->count][0] = i;
    list->pairs[list->count++][1] = j;
}

static void load_feature(const scene *s, const swept_feature *f, double (*x0)[3], double (*x1)[3]) {
    for (int i = 0; i < f->count; i++) {
        memcpy(x0[i], s->x0 + (size_t)f->vertices[i] * 3, sizeof *x0);
        memcpy(x1[i], s->x1 + (size_t)f->vertices[i] * 3, sizeof *x1);
    }
}

static void test_within(queued_pairs *w, oracle_list *out) {
    for (size_t i = 0; i < w->within.count; i++) {
        const uint32_t *pair = w->within.pairs[i];
        const swept_feature *a = &w->first[pair[0]], *b = &w->second[pair[1]];
        elementary_query query;
        elementary_contact hit;
        bool bounded;
        load_feature(w->scene, a, query.x0, query.x1);
        load_feature(w->scene, b, query.x0 + a->count, query.x1 + a->count);
        separation limit = {.distance = pair_distance(w, a, b)};
        limit.tolerance = 1e-6 * limit.distance;
        if (w->limit != NULL) limit = *w->limit;
        if ((w->kind == CSCD_CONTACT_VF ? separation_vf : separation_ee)(&query, &limit, &hit, &bounded))
            add_contact(out, w->kind, pair[0], pair[1], hit.toi);
    }
    w->within.count = 0;
}

/* As a step does, through the feature queue. */
static void test_touching(queued_pairs *w, const edge *edges, oracle_list *out) {
    size_t count;
    const feature_source source = {w->scene->x0, w->scene->x1, (const uint32_t(*)[3])w->scene->triangles,
                                   (const uint32_t(*)[2])edges};
    const cscd_contact *contacts = pair_test_source(&source, w->kind, (const uint32_t(*)[2])w->touching.pairs,
                                                    w->touching.count, &count);
    for (size_t i = 0; i < count; i++)
        add_contact(out, w->kind, contacts[i].a, contacts[i].b, contacts[i].toi);
    w->touching.count = 0;
}

static void test_kind(queued_pairs *w, const edge *edges, oracle_list *out) {
    if (w->touching.count > 0) test_touching(w, edges, out);
    test_within(w, out);
}

static int compare_contacts(const void *left, const void *right) {
    const oracle_contact *l = left, *r = right;
    if (l->toi != r->toi) return l->toi < r->toi ? -1 : 1;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void find_all(queued_pairs w, oracle_list *out) {
    static edge edges[SCENE_TRIANGLES_MAX * 3]; /* large; one test at a time */
    static swept_feature vertices[SCENE_VERTICES_MAX], faces[SCENE_TRIANGLES_MAX],
        sides[SCENE_TRIANGLES_MAX * 3];
    static bool collapsed[SCENE_VERTICES_MAX], used[SCENE_VERTICES_MAX];
    const scene *s = w.scene;
    const uint32_t edge_count = find_edges(s, edges);
    memset(used, false, sizeof used);
    for (uint32_t i = 0; i < s->triangle_count * 3; i++) used[s->triangles[i]] = true;
    for (uint32_t v = 0; v < s->vertex_count; v++) vertices[v] = sweep_feature(s, &v, 1);
    for (uint32_t t = 0; t < s->triangle_count; t++)
        faces[t] = sweep_feature(s, s->triangles + (size_t)t * 3, 3);
    for (uint32_t e = 0; e < edge_count; e++) sides[e] = sweep_feature(s, edges[e].ends, 2);
    collapsed_oracle_at_ends(s, NULL, collapsed);
    w.collapsed = collapsed;
    w.kind = CSCD_CONTACT_VF;
    w.first = vertices;
    w.second = faces;
    for (uint32_t v = 0; v < s->vertex_count; v++)
        for (uint32_t t = 0; used[v] && t < s->triangle_count; t++) add_pair(&w, v, t);
    test_kind(&w, edges, out);
    w.kind = CSCD_CONTACT_EE;
    w.first = w.second = sides;
    for (uint32_t i = 0; i < edge_count; i++)
        for (uint32_t j = i + 1; j < edge_count; j++) add_pair(&w, i, j);
    test_kind(&w, edges, out);
    free(w.touching.pairs);
    free(w.within.pairs);
    if (out->count > 0) qsort(out->items, out->count, sizeof *out->items, compare_contacts);
}

void oracle_find(const scene *s, oracle_list *out) {
    oracle_find_within(s, NULL, out);
}

void oracle_find_within(const scene *s, const separation *limit, oracle_list *out) {
    out->count = 0;
    find_all((queued_pairs){.scene = s, .limit = limit, .reach = limit != NULL ? limit->distance : 0.0}, out);
}

void oracle_find_by_rules(const scene *s, const oracle_rules *rules, oracle_list *out) {
    out->count = 0;
    double reach = 0.0;
    for (uint32_t i = 0; i < rules->object_count * rules->object_count; i++)
        reach = fmax(reach, rules->distances[i]);
    find_all((queued_pairs){.scene = s, .rules = rules, .reach = reach}, out);
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

/* ---- collapsed components ------------------------------------------------------------------------------ */

/* Gives all corners of each triangle the least label of one. */
static void label_components(const scene *s, uint32_t *labels) {
    for (uint32_t v = 0; v < s->vertex_count; v++) labels[v] = v;
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            const uint32_t *c = s->triangles + (size_t)t * 3;
            uint32_t least = labels[c[0]];
            for (int i = 1; i < 3; i++) least = labels[c[i]] < least ? labels[c[i]] : least;
            for (int i = 0; i < 3; i++) {
                changed |= labels[c[i]] != least;
                labels[c[i]] = least;
            }
        }
    }
}

void collapsed_oracle(const scene *s, const double *positions, const uint32_t *names, bool *vertices) {
    static uint32_t labels[SCENE_VERTICES_MAX];
    static bool has_area[SCENE_VERTICES_MAX], has_surface[SCENE_VERTICES_MAX];
    memset(has_area, false, sizeof has_area);
    memset(has_surface, false, sizeof has_surface);
    label_components(s, labels);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *c = s->triangles + (size_t)t * 3;
        uint32_t label = labels[c[0]];
        has_area[label] |= !collinear(positions + (size_t)c[0] * 3, positions + (size_t)c[1] * 3,
                                      positions + (size_t)c[2] * 3);
        has_surface[label] |= names == NULL || (names[c[0]] != names[c[1]] && names[c[1]] != names[c[2]] &&
                                                names[c[2]] != names[c[0]]);
    }
    for (uint32_t v = 0; v < s->vertex_count; v++)
        vertices[v] = has_surface[labels[v]] && !has_area[labels[v]];
}

void collapsed_oracle_at_ends(const scene *s, const uint32_t *names, bool *vertices) {
    static bool at_end[SCENE_VERTICES_MAX];
    collapsed_oracle(s, s->x0, names, vertices);
    collapsed_oracle(s, s->x1, names, at_end);
    for (uint32_t v = 0; v < s->vertex_count; v++) vertices[v] |= at_end[v];
}

/* ---- first contacts ------------------------------------------------------------------------------------ */

/* A feature belongs to the component of any triangle that holds it. */
static uint32_t component_of(const cscd_mesh *mesh, const scene *s, cscd_contact_kind kind, uint32_t feature,
                             bool second) {
    uint32_t vertices[2] = {feature, 0};
    if (kind == CSCD_CONTACT_VF && second) return cscd_mesh_triangle_component(mesh, feature);
    if (kind == CSCD_CONTACT_EE) cscd_mesh_edge(mesh, feature, vertices);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            if (s->triangles[t * 3 + (uint32_t)i] == vertices[0])
                return cscd_mesh_triangle_component(mesh, t);
        }
    }
    return UINT32_MAX;
}

uint32_t self_component(const cscd_mesh *mesh, const scene *s, const cscd_contact *c) {
    uint32_t a = component_of(mesh, s, c->kind, c->a, false), b = component_of(mesh, s, c->kind, c->b, true);
    return a == b ? a : UINT32_MAX;
}

void find_first_times(const cscd_mesh *mesh, const scene *s, const cscd_contacts *list,
                      double times[COMPONENTS_MAX]) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) times[c] = INFINITY;
    for (size_t i = 0; i < list->count; i++) {
        uint32_t c = self_component(mesh, s, &list->items[i]);
        if (c != UINT32_MAX) times[c] = fmin(times[c], list->items[i].toi);
    }
}
