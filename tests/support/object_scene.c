/* Scenes of several objects with random rules, and what rules mean, told without the library. */
#include "tests/support/object_scene.h"

#include "cscd/research.h"
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
