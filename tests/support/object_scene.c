/* Scenes of several objects with random rules, and brute force over what rules, seams and ignored pairs leave out,
 * and what waits after changes. */
#include "tests/support/object_scene.h"

#include "cscd/research.h"
#include "src/mesh/predicates.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_TWO_SPHERES,    SCENE_FOLDED_SHEET,
                                        SCENE_SPIKE,        SCENE_SQUASHED_TORUS, SCENE_BENT_CAPSULE,
                                        SCENE_SOUP};

scene objects_joined, objects_motion;
uint32_t objects_of_vertices[SCENE_VERTICES_MAX], objects_triangles[SCENE_TRIANGLES_MAX * 3];
static scene object; /* large; one test at a time */
static uint32_t first_vertices[SCENE_OBJECTS + 1], first_triangles[SCENE_OBJECTS + 1];

static void add_object(int i, random_stream *random) {
    do {
        uint32_t family = stream_below(random, sizeof families / sizeof *families);
        scene_make(families[family], stream_bits(random), &object);
    } while (object.triangle_count > OBJECT_TRIANGLES_MAX ||
             objects_joined.vertex_count + object.vertex_count > SCENE_VERTICES_MAX ||
             objects_joined.triangle_count + object.triangle_count > SCENE_TRIANGLES_MAX);
    double shift[2][3];
    for (int k = 0; k < 6; k++) shift[k / 3][k % 3] = stream_between(random, -1.2, 1.2);
    for (uint32_t v = 0; v < object.vertex_count * 3; v++) {
        objects_joined.x0[objects_joined.vertex_count * 3 + v] = object.x0[v] + shift[0][v % 3];
        objects_joined.x1[objects_joined.vertex_count * 3 + v] = object.x1[v] + shift[1][v % 3];
    }
    for (uint32_t v = 0; v < object.vertex_count; v++)
        objects_of_vertices[objects_joined.vertex_count + v] = (uint32_t)i;
    for (uint32_t k = 0; k < object.triangle_count * 3; k++) {
        objects_triangles[objects_joined.triangle_count * 3 + k] = object.triangles[k];
        objects_joined.triangles[objects_joined.triangle_count * 3 + k] =
            objects_joined.vertex_count + object.triangles[k];
    }
    objects_joined.vertex_count += object.vertex_count;
    objects_joined.triangle_count += object.triangle_count;
    first_vertices[i + 1] = objects_joined.vertex_count;
    first_triangles[i + 1] = objects_joined.triangle_count;
}

void object_scene_make(random_stream *random) {
    scene_clear(&objects_joined);
    for (int i = 0; i < SCENE_OBJECTS; i++) add_object(i, random);
    objects_motion = objects_joined;
}

void object_scene_go(double begin, double end) {
    for (uint32_t k = 0; k < objects_joined.vertex_count * 3; k++) {
        objects_motion.x0[k] = objects_joined.x0[k] + begin * (objects_joined.x1[k] - objects_joined.x0[k]);
        objects_motion.x1[k] = objects_joined.x0[k] + end * (objects_joined.x1[k] - objects_joined.x0[k]);
    }
}

/* ---- random rules, and what they mean ------------------------------------------------------------------ */

static double random_length(random_stream *random) {
    return stream_below(random, 3) == 0 ? 0.0 : stream_between(random, 0.002, 0.1);
}

static bool looks_at(const random_rules *set, int a, int b) {
    const cscd_object_rule *p = &set->objects[a], *q = &set->objects[b];
    if (a == b) return p->self && !set->obstacles[a];
    if (set->obstacles[a] && set->obstacles[b] && !(p->obstacle_pairs && q->obstacle_pairs)) return false;
    return (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

static void fill_distances(random_rules *set) {
    for (int a = 0; a < SCENE_OBJECTS; a++) {
        for (int b = 0; b < SCENE_OBJECTS; b++) {
            const cscd_object_rule *p = &set->objects[a], *q = &set->objects[b];
            double distance = 0.5 * p->thickness + 0.5 * q->thickness;
            if (set->uses_matrix)
                distance = set->matrix[p->thickness_class * RULE_CLASSES + q->thickness_class];
            set->distances[a * SCENE_OBJECTS + b] = looks_at(set, a, b) ? distance : -1.0;
        }
    }
}

void random_rules_neutral(random_rules *set) {
    for (int i = 0; i < SCENE_OBJECTS; i++) set->objects[i] = cscd_object_rule_default();
    set->uses_matrix = false;
    fill_distances(set);
}

void random_rules_make(random_stream *random, uint32_t kind, random_rules *set) {
    for (int i = 0; i < SCENE_OBJECTS; i++) {
        cscd_object_rule *rule = &set->objects[i];
        *rule = cscd_object_rule_default();
        rule->category = (uint64_t)1 << stream_below(random, 4) * 21;
        for (int bit = 0; bit < 4; bit++) {
            if (stream_below(random, 4) == 0) rule->mask &= ~((uint64_t)1 << bit * 21);
        }
        rule->self = stream_below(random, 3) > 0;
        rule->obstacle_pairs = stream_below(random, 2) == 0;
        if (kind == 1) rule->thickness = random_length(random);
        if (kind == 2) rule->thickness_class = stream_below(random, RULE_CLASSES);
    }
    set->uses_matrix = kind == 2;
    for (int a = 0; a < RULE_CLASSES; a++) {
        for (int b = a; b < RULE_CLASSES; b++) {
            double distance = a == b && stream_below(random, 3) > 0 ? 0.0 : random_length(random);
            set->matrix[a * RULE_CLASSES + b] = set->matrix[b * RULE_CLASSES + a] = distance;
        }
    }
    fill_distances(set);
}

/* ---- a detector with rules ----------------------------------------------------------------------------- */

rig rules_rig(const random_rules *set, const cscd_detector_options *options, uint32_t threads) {
    cscd_object_desc descs[SCENE_OBJECTS];
    for (int i = 0; i < SCENE_OBJECTS; i++) {
        descs[i] = cscd_object_of_triangles(first_vertices[i + 1] - first_vertices[i],
                                            first_triangles[i + 1] - first_triangles[i],
                                            objects_triangles + (size_t)first_triangles[i] * 3);
        descs[i].obstacle = set->obstacles[i];
    }
    return rig_of_objects(context_of(threads, NULL), descs, SCENE_OBJECTS, objects_joined.x0, options);
}

void rules_set(cscd_detector *detector, const random_rules *set) {
    expect_ok(cscd_detector_set_rules(detector, set->objects, SCENE_OBJECTS,
                                      set->uses_matrix ? set->matrix : NULL,
                                      set->uses_matrix ? RULE_CLASSES : 0));
}

/* The component that both features of a contact lie in, or UINT32_MAX. */
static uint32_t own_component(const cscd_mesh *mesh, const oracle_contact *c) {
    uint32_t count, of[2];
    bool vf = c->kind == CSCD_CONTACT_VF;
    of[0] =
        vf ? *cscd_mesh_vertex_triangles(mesh, c->a, &count) : *cscd_mesh_edge_triangles(mesh, c->a, &count);
    of[1] = vf ? c->b : *cscd_mesh_edge_triangles(mesh, c->b, &count);
    for (int i = 0; i < 2; i++) of[i] = cscd_mesh_triangle_component(mesh, of[i]);
    return of[0] == of[1] ? of[0] : UINT32_MAX;
}

static bool same_contact(const oracle_contact *t, const cscd_contact *f) {
    return f->kind == t->kind && f->a == t->a && f->b == t->b && f->toi == t->toi;
}

void rules_rig_compare(const rig *s, const oracle_list *truth, const cscd_contacts *found, rules_tally *sum) {
    static double first[SCENE_OBJECTS * OBJECT_TRIANGLES_MAX];
    static bool found_first[SCENE_OBJECTS * OBJECT_TRIANGLES_MAX];
    uint32_t components = cscd_mesh_component_count(s->mesh);
    size_t next = 0;
    for (uint32_t c = 0; c < components; c++) {
        first[c] = INFINITY;
        found_first[c] = false;
    }
    for (size_t i = 0; i < truth->count; i++) {
        const oracle_contact *t = &truth->items[i];
        uint32_t c = own_component(s->mesh, t);
        bool same = next < found->count && same_contact(t, &found->items[next]);
        next += same;
        if (c != UINT32_MAX) first[c] = fmin(first[c], t->toi);
        if (c != UINT32_MAX) found_first[c] |= same && t->toi == first[c];
        if (same) continue;
        assert_true(c != UINT32_MAX &&
                    cscd_detector_guarantee(s->detector, c).reason == CSCD_REASON_EARLIEST);
        sum->later++;
    }
    assert_int_equal(next, found->count);
    for (uint32_t c = 0; c < components; c++) assert_true(first[c] == INFINITY || found_first[c]);
    sum->contacts += found->count;
}

/* ---- what waits ---------------------------------------------------------------------------------------- */

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
