/* Which pairs wait after changes of what is left out: lists of everything that touches, gone through one by one. */
#include "tests/support/waiting_oracle.h"

#include "src/mesh/predicates.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene at_rest; /* large; one test at a time */

void waiting_oracle_free(waiting_oracle *o) {
    free(o->former);
    oracle_free(&o->pairs);
    oracle_free(&o->touching);
}

/* ---- what is left out ---------------------------------------------------------------------------------- */

/* A vertex goes on to the smaller end of a seam until nothing changes. */
static named_left_out name_vertices(const left_out *l) {
    named_left_out out = {.what = *l};
    for (uint32_t v = 0; v < SCENE_VERTICES_MAX; v++) out.names[v] = v;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < l->seam_count; i++) {
            uint32_t *a = &out.names[l->seams[i][0]], *b = &out.names[l->seams[i][1]];
            changed |= *a != *b;
            *a = *b = *a < *b ? *a : *b;
        }
    }
    return out;
}

waiting_oracle waiting_oracle_start(const cscd_mesh *mesh, const scene *s, const left_out *now) {
    return (waiting_oracle){.mesh = mesh, .scene = s, .now = name_vertices(now)};
}

/* Writes the vertices of feature a, then those of b, and returns how many a has. */
static int vertices_of(const waiting_oracle *o, cscd_contact_kind kind, uint32_t a, uint32_t b,
                       uint32_t out[6]) {
    const uint32_t *triangles = o->scene->triangles;
    if (kind == CSCD_CONTACT_EE) {
        cscd_mesh_edge(o->mesh, a, out);
        cscd_mesh_edge(o->mesh, b, out + 2);
        return 2;
    }
    int first = kind == CSCD_CONTACT_VF ? 1 : 3;
    if (first == 1)
        out[0] = a;
    else
        memcpy(out, triangles + (size_t)a * 3, sizeof(uint32_t[3]));
    memcpy(out + first, triangles + (size_t)b * 3, sizeof(uint32_t[3]));
    return first;
}

/* A face is part of no triangle but itself, although another one may have its vertices. */
static bool is_part(const waiting_oracle *o, uint32_t face, const uint32_t *vertices, int count,
                    uint32_t triangle) {
    const uint32_t *t = o->scene->triangles + (size_t)triangle * 3;
    if (count == 3) return face == triangle;
    for (int i = 0; i < count; i++) {
        if (vertices[i] != t[0] && vertices[i] != t[1] && vertices[i] != t[2]) return false;
    }
    return true;
}

static bool is_ignored(const waiting_oracle *o, const left_out *l, const uint32_t features[2],
                       const uint32_t *vertices, int first, int second) {
    for (size_t i = 0; i < l->ignored_count; i++) {
        const uint32_t *pair = l->ignored[i];
        for (int k = 0; k < 2 && pair[0] != pair[1]; k++) {
            if (is_part(o, features[0], vertices, first, pair[k]) &&
                is_part(o, features[1], vertices + first, second, pair[1 - k]))
                return true;
        }
    }
    return false;
}

static bool is_sewn(const named_left_out *l, cscd_contact_kind kind, const uint32_t *at, int first,
                    int second, const double *x) {
    const uint32_t *names = l->names;
    if (l->what.seam_count == 0) return false;
    if (kind == CSCD_CONTACT_TT) return !triangles_intersect_by_names(at, at + 3, names, x);
    for (int i = 0; i < first; i++) {
        for (int j = 0; j < second; j++) {
            if (names[at[i]] == names[at[first + j]]) return true;
        }
    }
    return false;
}

static bool leaves_out(const waiting_oracle *o, const named_left_out *l, cscd_contact_kind kind, uint32_t a,
                       uint32_t b, const double *x) {
    const oracle_rules *rules = &l->what.rules;
    uint32_t at[6];
    int first = vertices_of(o, kind, a, b, at), second = kind == CSCD_CONTACT_EE ? 2 : 3;
    uint32_t of_a = rules->vertex_objects[at[0]], of_b = rules->vertex_objects[at[first]];
    if (rules->distances[(size_t)of_a * rules->object_count + of_b] < 0.0) return true;
    return is_ignored(o, &l->what, (uint32_t[2]){a, b}, at, first, second) ||
           is_sewn(l, kind, at, first, second, x);
}

/* ---- what waits ---------------------------------------------------------------------------------------- */

static bool is_listed(const oracle_list *list, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < list->count; i++) {
        const oracle_contact *c = &list->items[i];
        if (c->kind == kind && c->a == a && c->b == b) return true;
    }
    return false;
}

static void add_pair(oracle_list *list, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (list->count == list->capacity) {
        list->capacity = list->capacity * 2 + 64;
        list->items = realloc(list->items, list->capacity * sizeof *list->items);
        assert_non_null(list->items);
    }
    list->items[list->count++] = (oracle_contact){kind, a, b, 0.0};
}

void waiting_oracle_change(waiting_oracle *o, const left_out *next) {
    o->former = realloc(o->former, (o->former_count + 1) * sizeof *o->former);
    assert_non_null(o->former);
    o->former[o->former_count++] = o->now;
    o->now = name_vertices(next);
}

bool waiting_oracle_covers(const waiting_oracle *o, cscd_contact_kind kind, uint32_t a, uint32_t b,
                           const double *x) {
    return is_listed(&o->pairs, kind, a, b) || leaves_out(o, &o->now, kind, a, b, x);
}

/* Per triangle the ends of its box, which spare most exact tests. */
typedef struct triangle_box {
    double low[3], high[3];
} triangle_box;

static void make_boxes(const scene *s, const double *x, triangle_box *boxes) {
    for (uint32_t i = 0; i < s->triangle_count * 3; i++) {
        for (size_t k = 0; k < 3; k++) {
            const double at = x[s->triangles[i] * 3 + k];
            double *low = &boxes[i / 3].low[k], *high = &boxes[i / 3].high[k];
            *low = i % 3 == 0 || at < *low ? at : *low;
            *high = i % 3 == 0 || at > *high ? at : *high;
        }
    }
}

static bool boxes_meet(const triangle_box *a, const triangle_box *b) {
    for (int k = 0; k < 3; k++) {
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
    }
    return true;
}

static void add_intersections(const waiting_oracle *o, const double *x, oracle_list *out) {
    static triangle_box boxes[SCENE_TRIANGLES_MAX];
    const uint32_t *triangles = o->scene->triangles, count = o->scene->triangle_count;
    make_boxes(o->scene, x, boxes);
    for (uint32_t a = 0; a < count; a++) {
        for (uint32_t b = a + 1; b < count; b++) {
            if (boxes_meet(&boxes[a], &boxes[b]) &&
                triangles_intersect(triangles + (size_t)a * 3, triangles + (size_t)b * 3, x))
                add_pair(out, CSCD_CONTACT_TT, a, b);
        }
    }
}

/* What touches now waits if it has waited, or if it was left out before a change. */
static void keep_waiting(waiting_oracle *o, const double *x, bool motion_starts) {
    oracle_list waiting = {0};
    for (size_t i = 0; !motion_starts && i < o->pairs.count; i++)
        add_pair(&waiting, o->pairs.items[i].kind, o->pairs.items[i].a, o->pairs.items[i].b);
    for (size_t i = 0; i < o->touching.count; i++) {
        const oracle_contact *c = &o->touching.items[i];
        if (leaves_out(o, &o->now, c->kind, c->a, c->b, x)) continue;
        bool waits = is_listed(&o->pairs, c->kind, c->a, c->b);
        for (size_t k = 0; k < o->former_count && !waits; k++)
            waits = leaves_out(o, &o->former[k], c->kind, c->a, c->b, x);
        if (waits && !is_listed(&waiting, c->kind, c->a, c->b)) add_pair(&waiting, c->kind, c->a, c->b);
    }
    oracle_free(&o->pairs);
    o->pairs = waiting;
}

void waiting_oracle_see(waiting_oracle *o, const double *x, bool motion_starts) {
    if (o->former_count == 0 && (o->pairs.count == 0 || !motion_starts)) return;
    memcpy(&at_rest, o->scene, sizeof at_rest);
    memcpy(at_rest.x0, x, o->scene->vertex_count * sizeof(double[3]));
    memcpy(at_rest.x1, x, o->scene->vertex_count * sizeof(double[3]));
    oracle_find_by_rules(&at_rest, &o->now.what.rules, &o->touching);
    add_intersections(o, x, &o->touching);
    keep_waiting(o, x, motion_starts);
    o->former_count = 0;
}

/* ---- lists --------------------------------------------------------------------------------------------- */

void waiting_oracle_filter(const waiting_oracle *o, oracle_list *list) {
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        const oracle_contact *c = &list->items[i];
        if (!waiting_oracle_covers(o, c->kind, c->a, c->b, NULL)) list->items[kept++] = *c;
    }
    list->count = kept;
}

void waiting_oracle_intersections(const waiting_oracle *o, const double *x, oracle_list *out) {
    size_t kept = 0;
    out->count = 0;
    add_intersections(o, x, out);
    for (size_t i = 0; i < out->count; i++) {
        const oracle_contact *c = &out->items[i];
        if (!waiting_oracle_covers(o, c->kind, c->a, c->b, x)) out->items[kept++] = *c;
    }
    out->count = kept;
}

size_t waiting_oracle_triangles(const waiting_oracle *o) {
    size_t count = 0;
    for (size_t i = 0; i < o->pairs.count; i++) count += o->pairs.items[i].kind == CSCD_CONTACT_TT;
    return count;
}

size_t waiting_oracle_features(const waiting_oracle *o) {
    return o->pairs.count - waiting_oracle_triangles(o);
}
