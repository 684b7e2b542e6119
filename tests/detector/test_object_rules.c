/* Rules for objects: who is looked at with whom, and how far apart they have to stay, against brute force over
 * features that knows neither trees nor rules. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/methods.h"
#include "tests/support/oracle.h"
#include "tests/support/packed.h"
#include "tests/support/random_stream.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 4, MANY = 60, CLASSES = 3, OBJECT_TRIANGLES_MAX = 300, SCENES = 10, STEPS = 5 };

static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_TWO_SPHERES,    SCENE_FOLDED_SHEET,
                                        SCENE_SPIKE,        SCENE_SQUASHED_TORUS, SCENE_BENT_CAPSULE,
                                        SCENE_SOUP};

static scene object, joined, motion; /* large; one test at a time */
static uint32_t vertex_objects[SCENE_VERTICES_MAX], first_vertices[OBJECTS + 1], first_triangles[OBJECTS + 1];
static uint32_t own_triangles[SCENE_TRIANGLES_MAX * 3];

static void add_object(int i, random_stream *random) {
    do {
        uint32_t family = stream_below(random, sizeof families / sizeof *families);
        scene_make(families[family], stream_bits(random), &object);
    } while (object.triangle_count > OBJECT_TRIANGLES_MAX ||
             joined.vertex_count + object.vertex_count > SCENE_VERTICES_MAX ||
             joined.triangle_count + object.triangle_count > SCENE_TRIANGLES_MAX);
    double shift[2][3];
    for (int k = 0; k < 6; k++) shift[k / 3][k % 3] = stream_between(random, -1.2, 1.2);
    for (uint32_t v = 0; v < object.vertex_count * 3; v++) {
        joined.x0[joined.vertex_count * 3 + v] = object.x0[v] + shift[0][v % 3];
        joined.x1[joined.vertex_count * 3 + v] = object.x1[v] + shift[1][v % 3];
    }
    for (uint32_t v = 0; v < object.vertex_count; v++) vertex_objects[joined.vertex_count + v] = (uint32_t)i;
    for (uint32_t k = 0; k < object.triangle_count * 3; k++) {
        own_triangles[joined.triangle_count * 3 + k] = object.triangles[k];
        joined.triangles[joined.triangle_count * 3 + k] = joined.vertex_count + object.triangles[k];
    }
    joined.vertex_count += object.vertex_count;
    joined.triangle_count += object.triangle_count;
    first_vertices[i + 1] = joined.vertex_count;
    first_triangles[i + 1] = joined.triangle_count;
}

static void make_objects(random_stream *random) {
    scene_clear(&joined);
    for (int i = 0; i < OBJECTS; i++) add_object(i, random);
    motion = joined;
}

static void go_to(double begin, double end) {
    for (uint32_t k = 0; k < joined.vertex_count * 3; k++) {
        motion.x0[k] = joined.x0[k] + begin * (joined.x1[k] - joined.x0[k]);
        motion.x1[k] = joined.x0[k] + end * (joined.x1[k] - joined.x0[k]);
    }
}

/* ---- random rules, and what they mean ------------------------------------------------------------------ */

typedef struct rule_set {
    cscd_object_rule objects[OBJECTS];
    double matrix[CLASSES * CLASSES];
    bool uses_matrix, obstacles[OBJECTS];
    double distances[OBJECTS * OBJECTS]; /* as the oracle takes them */
} rule_set;

static double random_length(random_stream *random) {
    return stream_below(random, 3) == 0 ? 0.0 : stream_between(random, 0.002, 0.1);
}

static bool looks_at(const rule_set *set, int a, int b) {
    const cscd_object_rule *p = &set->objects[a], *q = &set->objects[b];
    if (a == b) return p->self && !set->obstacles[a];
    if (set->obstacles[a] && set->obstacles[b] && !(p->obstacle_pairs && q->obstacle_pairs)) return false;
    return (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

static void fill_distances(rule_set *set) {
    for (int a = 0; a < OBJECTS; a++) {
        for (int b = 0; b < OBJECTS; b++) {
            const cscd_object_rule *p = &set->objects[a], *q = &set->objects[b];
            double distance = 0.5 * p->thickness + 0.5 * q->thickness;
            if (set->uses_matrix) distance = set->matrix[p->thickness_class * CLASSES + q->thickness_class];
            set->distances[a * OBJECTS + b] = looks_at(set, a, b) ? distance : -1.0;
        }
    }
}

static void make_neutral(rule_set *set) {
    for (int i = 0; i < OBJECTS; i++) set->objects[i] = cscd_object_rule_default();
    set->uses_matrix = false;
    fill_distances(set);
}

/* kind 0: masks alone, 1: thicknesses, 2: a matrix whose diagonal is often 0. */
static void make_rules(random_stream *random, uint32_t kind, rule_set *set) {
    for (int i = 0; i < OBJECTS; i++) {
        cscd_object_rule *rule = &set->objects[i];
        *rule = cscd_object_rule_default();
        rule->category = (uint64_t)1 << stream_below(random, 4) * 21;
        for (int bit = 0; bit < 4; bit++) {
            if (stream_below(random, 4) == 0) rule->mask &= ~((uint64_t)1 << bit * 21);
        }
        rule->self = stream_below(random, 3) > 0;
        rule->obstacle_pairs = stream_below(random, 2) == 0;
        if (kind == 1) rule->thickness = random_length(random);
        if (kind == 2) rule->thickness_class = stream_below(random, CLASSES);
    }
    set->uses_matrix = kind == 2;
    for (int a = 0; a < CLASSES; a++) {
        for (int b = a; b < CLASSES; b++) {
            double distance = a == b && stream_below(random, 3) > 0 ? 0.0 : random_length(random);
            set->matrix[a * CLASSES + b] = set->matrix[b * CLASSES + a] = distance;
        }
    }
    fill_distances(set);
}

/* ---- a detector with rules ----------------------------------------------------------------------------- */

typedef struct object_setting {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
} object_setting;

static object_setting set_up(const rule_set *set, const cscd_detector_options *options, uint32_t threads) {
    object_setting s = {NULL, NULL, NULL, NULL};
    cscd_object_desc descs[OBJECTS];
    for (int i = 0; i < OBJECTS; i++) {
        descs[i] = cscd_object_of_triangles(first_vertices[i + 1] - first_vertices[i],
                                            first_triangles[i + 1] - first_triangles[i],
                                            own_triangles + (size_t)first_triangles[i] * 3);
        descs[i].obstacle = set->obstacles[i];
    }
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = threads;
    assert_int_equal(cscd_context_create(&context_options, &s.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(s.context, descs, OBJECTS, &s.mesh), CSCD_OK);
    if (options->method == CSCD_METHOD_KMEANS) {
        cscd_plan_options plan_options = cscd_plan_defaults();
        plan_options.method = CSCD_METHOD_KMEANS;
        assert_int_equal(plan_create_packed(s.mesh, joined.x0, &plan_options, &s.plan), CSCD_OK);
    }
    assert_int_equal(detector_create_here(s.mesh, s.plan, options, &s.detector), CSCD_OK);
    return s;
}

static void set_rules(const object_setting *s, const rule_set *set) {
    assert_int_equal(cscd_detector_set_rules(s->detector, set->objects, OBJECTS,
                                             set->uses_matrix ? set->matrix : NULL,
                                             set->uses_matrix ? CLASSES : 0),
                     CSCD_OK);
}

static void tear_down(object_setting *s) {
    cscd_detector_destroy(s->detector);
    cscd_plan_destroy(s->plan);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
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

/* How much was compared. */
typedef struct rules_tally {
    size_t contacts, culled, later, masked, thick_and_culled, embedded;
} rules_tally;

static bool same_contact(const oracle_contact *t, const cscd_contact *f) {
    return f->kind == t->kind && f->a == t->a && f->b == t->b && f->toi == t->toi;
}

/* Of a component whose guarantee is EARLIEST, all but one of the first contacts with itself may be missing. */
static void compare_contacts(const object_setting *s, const oracle_list *truth, const cscd_contacts *found,
                             rules_tally *sum) {
    static double first[OBJECTS * OBJECT_TRIANGLES_MAX];
    static bool found_first[OBJECTS * OBJECT_TRIANGLES_MAX];
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

static void check_guarantees(const object_setting *s, const rule_set *set, rules_tally *sum) {
    for (uint32_t t = 0; t < joined.triangle_count; t++) {
        uint32_t i = vertex_objects[joined.triangles[(size_t)t * 3]];
        uint32_t component = cscd_mesh_triangle_component(s->mesh, t);
        cscd_guarantee g = cscd_detector_guarantee(s->detector, component);
        bool own_thickness = set->distances[i * OBJECTS + i] > 0.0, obstacle = set->obstacles[i];
        bool masked = !set->objects[i].self && !obstacle, thick = false;
        assert_true((g.reason == CSCD_REASON_MASK) == masked);
        if (masked) assert_true(!g.complete && !g.start_embedded);
        if (masked || own_thickness || obstacle)
            assert_int_equal(cscd_detector_orientation(s->detector, t), 0);
        for (int k = 0; k < OBJECTS; k++) thick |= set->distances[i * OBJECTS + (size_t)k] > 0.0;
        bool culled = cscd_detector_orientation(s->detector, t) != 0;
        sum->masked += masked;
        sum->culled += culled;
        sum->thick_and_culled += culled && thick;
        sum->embedded += g.start_embedded;
    }
}

static void compare_step(const object_setting *s, const rule_set *set, oracle_list *truth, rules_tally *sum) {
    cscd_contacts found;
    oracle_rules rules = {vertex_objects, OBJECTS, set->distances};
    oracle_find_by_rules(&motion, &rules, truth);
    assert_int_equal(step_packed(s->detector, motion.x0, motion.x1, &found), CSCD_OK);
    compare_contacts(s, truth, &found, sum);
    check_guarantees(s, set, sum);
}

/* Small steps, mostly without contact, and large ones; most go on from the end of the one before. */
static void next_motion(random_stream *random, double *at) {
    uint32_t kind = stream_below(random, 4);
    double end = *at + (kind < 2 ? 0.02 : stream_between(random, 0.1, 0.6));
    if (kind == 3) *at = 0.0;
    if (kind == 3 || end > 1.0) end = *at == 0.0 ? 1.0 : 0.3;
    go_to(*at, end);
    *at = stream_below(random, 6) == 0 ? 0.0 : end;
}

/* What a check has proven holds under other rules. */
static void check_with_other_rules(const object_setting *s, random_stream *random, const rule_set *now) {
    rule_set other = *now;
    cscd_intersections found;
    if (stream_below(random, 2) == 0) make_rules(random, stream_below(random, 3), &other);
    set_rules(s, &other);
    assert_int_equal(check_packed(s->detector, motion.x0, &found), CSCD_OK);
}

static void run_sequence(uint64_t seed, cscd_detector_options options, uint32_t threads, rules_tally *sum) {
    random_stream random = stream_start(seed);
    rule_set set;
    oracle_list truth = {0};
    double at = 0.0;
    make_objects(&random);
    for (int i = 0; i < OBJECTS; i++) set.obstacles[i] = stream_below(&random, 4) == 0;
    make_neutral(&set);
    object_setting s = set_up(&set, &options, threads);
    for (int step = 0; step < STEPS; step++) {
        if (stream_below(&random, 4) == 0)
            make_neutral(&set);
        else if (step == 0 || stream_below(&random, 3) > 0)
            make_rules(&random, stream_below(&random, 3), &set);
        next_motion(&random, &at);
        if (stream_below(&random, 3) == 0) check_with_other_rules(&s, &random, &set);
        set_rules(&s, &set);
        compare_step(&s, &set, &truth, sum);
    }
    oracle_free(&truth);
    tear_down(&s);
}

static rules_tally run_method(cscd_method method, cscd_mode mode, int sequences, uint64_t seed) {
    rules_tally sum = {0};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = mode;
    for (int i = 0; i < sequences; i++) {
        options.volume = i % 2 == 0 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
        run_sequence(seed + (uint64_t)i, options, 1 + (uint32_t)i % 3, &sum);
    }
    print_message("  %s, %s: %zu contacts, %zu culled (%zu beside a distance), %zu masked, %zu left out\n",
                  cscd_method_name(method), cscd_mode_name(mode), sum.contacts, sum.culled,
                  sum.thick_and_culled, sum.masked, sum.later);
    assert_true(sum.contacts > 1000 && sum.masked > 100);
    return sum;
}

static void without_culling_as_brute_force(void **state) {
    (void)state;
    run_method(CSCD_METHOD_NONE, CSCD_MODE_ALL, SCENES, 0);
    run_method(CSCD_METHOD_BRUTE, CSCD_MODE_ALL, SCENES / 4, 100);
    run_method(method_or_none(CSCD_METHOD_ICCD), CSCD_MODE_ALL, SCENES / 2, 200);
}

static void with_culling_as_brute_force(void **state) {
    (void)state;
    rules_tally single = run_method(CSCD_METHOD_SINGLE, CSCD_MODE_ALL, SCENES, 3000);
    rules_tally kmeans = run_method(CSCD_METHOD_KMEANS, CSCD_MODE_ALL, SCENES / 2, 400);
    rules_tally earliest = run_method(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST, SCENES, 3000);
    assert_true(single.culled > 1000 && single.thick_and_culled > 500 && kmeans.culled > 500);
    assert_true(earliest.later > 0);
}

/* ---- many objects, and what is known of masked ones ---------------------------------------------------- */

static double many_distances[MANY * MANY];
static cscd_object_rule many_rules[MANY];

/* Small spheres in one box, so that trees of many objects are joined in blocks. */
static void make_many(random_stream *random, cscd_object_desc *descs) {
    scene_clear(&joined);
    for (uint32_t i = 0; i < MANY; i++) {
        double centre[3], velocity[3];
        uint32_t first = joined.vertex_count, triangle = joined.triangle_count;
        for (int k = 0; k < 3; k++) centre[k] = stream_between(random, -1.0, 1.0);
        for (int k = 0; k < 3; k++) velocity[k] = stream_between(random, -0.3, 0.3);
        scene_add_sphere(&joined, centre, 0.25, 2, 4);
        for (uint32_t v = first; v < joined.vertex_count; v++) {
            vertex_objects[v] = i;
            for (uint32_t k = 0; k < 3; k++) joined.x1[v * 3 + k] += velocity[k];
        }
        for (uint32_t k = triangle * 3; k < joined.triangle_count * 3; k++)
            own_triangles[k] = joined.triangles[k] - first;
        descs[i] = cscd_object_of_triangles(joined.vertex_count - first, joined.triangle_count - triangle,
                                            own_triangles + triangle * 3);
    }
}

/* Every object has a rule of its own. */
static void make_many_rules(random_stream *random) {
    for (uint32_t i = 0; i < MANY; i++) {
        many_rules[i] = cscd_object_rule_default();
        many_rules[i].category = (uint64_t)1 << i;
        many_rules[i].mask = stream_bits(random) & stream_bits(random) & stream_bits(random);
        many_rules[i].thickness = i % 2 == 0 ? 0.0 : stream_between(random, 0.0, 0.05);
    }
    for (uint32_t a = 0; a < MANY; a++) {
        for (uint32_t b = 0; b < MANY; b++) {
            const cscd_object_rule *p = &many_rules[a], *q = &many_rules[b];
            bool looks = a == b || ((p->category & q->mask) != 0 && (q->category & p->mask) != 0);
            many_distances[a * MANY + b] = looks ? 0.5 * p->thickness + 0.5 * q->thickness : -1.0;
        }
    }
}

static void many_objects_with_a_rule_each(void **state) {
    (void)state;
    cscd_object_desc descs[MANY];
    object_setting s;
    random_stream random = stream_start(1);
    oracle_list truth = {0};
    rules_tally sum = {0};
    make_many(&random, descs);
    assert_int_equal(cscd_context_create(NULL, &s.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(s.context, descs, MANY, &s.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(s.mesh, NULL, NULL, &s.detector), CSCD_OK);
    s.plan = NULL;
    for (int step = 0; step < 6; step++) {
        cscd_contacts found;
        oracle_rules rules = {vertex_objects, MANY, many_distances};
        make_many_rules(&random);
        assert_int_equal(cscd_detector_set_rules(s.detector, many_rules, MANY, NULL, 0), CSCD_OK);
        oracle_find_by_rules(&joined, &rules, &truth);
        assert_int_equal(step_packed(s.detector, joined.x0, joined.x1, &found), CSCD_OK);
        compare_contacts(&s, &truth, &found, &sum);
    }
    assert_true(sum.contacts > 100);
    oracle_free(&truth);
    tear_down(&s);
}

/* A check of an object with self = false proves nothing of it, so a later step must not believe that it is embedded. */
static void masked_objects_are_not_proven(void **state) {
    (void)state;
    size_t crossing = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        cscd_detector_options options = cscd_detector_defaults();
        oracle_list truth = {0};
        cscd_contacts found;
        cscd_intersections listed;
        rules_tally sum = {0};
        cscd_object_rule rule = cscd_object_rule_default();
        scene_make(SCENE_SPIKE, seed, &joined);
        for (uint32_t k = 0; k < joined.vertex_count * 3; k++) {
            double step = joined.x1[k] - joined.x0[k];
            joined.x0[k] = joined.x1[k];
            joined.x1[k] += 0.3 * step;
        }
        options.method = CSCD_METHOD_SINGLE;
        object_setting s = {NULL, NULL, NULL, NULL};
        const cscd_object_desc desc =
            cscd_object_of_triangles(joined.vertex_count, joined.triangle_count, joined.triangles);
        assert_int_equal(cscd_context_create(NULL, &s.context), CSCD_OK);
        assert_int_equal(cscd_mesh_create(s.context, &desc, 1, &s.mesh), CSCD_OK);
        assert_int_equal(detector_create_here(s.mesh, NULL, &options, &s.detector), CSCD_OK);
        rule.self = false;
        assert_int_equal(cscd_detector_set_rules(s.detector, &rule, 1, NULL, 0), CSCD_OK);
        assert_int_equal(check_packed(s.detector, joined.x0, &listed), CSCD_OK);
        assert_int_equal(listed.count, 0);
        rule.self = true;
        assert_int_equal(cscd_detector_set_rules(s.detector, &rule, 1, NULL, 0), CSCD_OK);
        oracle_find(&joined, &truth);
        assert_int_equal(step_packed(s.detector, joined.x0, joined.x1, &found), CSCD_OK);
        compare_contacts(&s, &truth, &found, &sum);
        crossing += !cscd_detector_guarantee(s.detector, 0).start_embedded;
        assert_int_equal(cscd_detector_counters(s.detector).static_checks, 1);
        oracle_free(&truth);
        tear_down(&s);
    }
    assert_true(crossing > 0);
}

/* ---- moments, and steps that are certified ------------------------------------------------------------- */

static bool vertices_look(const rule_set *set, uint32_t a, uint32_t b) {
    return set->distances[vertex_objects[a] * OBJECTS + vertex_objects[b]] >= 0.0;
}

/* The lists are those without rules, without the pairs that are not looked at. Thickness has no part in them. */
static void compare_moment(const object_setting *all, const object_setting *s, const rule_set *set,
                           size_t *sum) {
    cscd_proximities truth, found;
    cscd_intersections crossing, listed;
    size_t next = 0;
    assert_int_equal(find_near_packed(all->detector, motion.x1, 0.08, &truth), CSCD_OK);
    assert_int_equal(find_near_packed(s->detector, motion.x1, 0.08, &found), CSCD_OK);
    for (size_t i = 0; i < truth.count; i++) {
        const cscd_proximity *t = &truth.items[i];
        cscd_stencil at = cscd_mesh_stencil(all->mesh, t->kind, t->a, t->b, t->u, t->v);
        if (!vertices_look(set, at.vertices[0], at.vertices[3])) continue;
        assert_true(next < found.count);
        assert_memory_equal(&found.items[next++], t, sizeof *t);
    }
    assert_int_equal(next, found.count);
    sum[0] += found.count;
    sum[1] += truth.count - found.count;
    next = 0;
    assert_int_equal(check_packed(all->detector, motion.x1, &crossing), CSCD_OK);
    assert_int_equal(check_packed(s->detector, motion.x1, &listed), CSCD_OK);
    assert_int_equal(crossing.zero_area_triangles, listed.zero_area_triangles);
    for (size_t i = 0; i < crossing.count; i++) {
        const uint32_t *a = joined.triangles + (size_t)crossing.items[i].a * 3;
        const uint32_t *b = joined.triangles + (size_t)crossing.items[i].b * 3;
        if (!vertices_look(set, a[0], b[0])) continue;
        assert_true(next < listed.count);
        assert_memory_equal(&listed.items[next++], &crossing.items[i], sizeof *listed.items);
    }
    assert_int_equal(next, listed.count);
    sum[2] += listed.count;
    sum[3] += crossing.count - listed.count;
}

static void moments_leave_out_what_is_masked(void **state) {
    (void)state;
    size_t sum[4] = {0};
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_BRUTE, CSCD_METHOD_SINGLE,
                                   method_or_none(CSCD_METHOD_ICCD_PUBLISHED)};
    for (uint64_t seed = 0; seed < 12; seed++) {
        random_stream random = stream_start(500 + seed);
        rule_set set, neutral;
        cscd_detector_options options = cscd_detector_defaults();
        make_objects(&random);
        for (int i = 0; i < OBJECTS; i++) set.obstacles[i] = stream_below(&random, 4) == 0;
        memset(neutral.obstacles, 0, sizeof neutral.obstacles);
        make_neutral(&neutral);
        object_setting all = set_up(&neutral, &options, 1);
        options.method = methods[seed % 4];
        object_setting s = set_up(&set, &options, 2);
        for (uint32_t kind = 0; kind < 3; kind++) {
            make_rules(&random, kind, &set);
            set_rules(&s, &set);
            go_to(0.0, 0.5 * kind);
            compare_moment(&all, &s, &set, sum);
        }
        tear_down(&all);
        tear_down(&s);
    }
    print_message("  %zu near and %zu not, %zu crossing and %zu not\n", sum[0], sum[1], sum[2], sum[3]);
    for (int i = 0; i < 4; i++) assert_true(sum[i] > 500);
}

/* ---- what is refused ----------------------------------------------------------------------------------- */

_Static_assert(sizeof(cscd_object_rule) == 32, "a rule never grows, and does not end in padding");

static void refuse(cscd_detector *d, const cscd_object_rule *rules, uint32_t count, const double *matrix,
                   uint32_t classes, const char *says) {
    assert_int_equal(cscd_detector_set_rules(d, rules, count, matrix, classes), CSCD_INVALID_ARGUMENT);
    const char *detail = cscd_context_detail(cscd_mesh_context(cscd_detector_mesh(d)));
    if (strstr(detail, says) == NULL) print_error("%s\n", detail);
    assert_non_null(strstr(detail, says));
}

static void mistakes_have_a_sentence(void **state) {
    (void)state;
    rule_set set;
    random_stream random = stream_start(9);
    cscd_detector_options options = cscd_detector_defaults();
    make_objects(&random);
    memset(set.obstacles, 0, sizeof set.obstacles);
    make_neutral(&set);
    object_setting s = set_up(&set, &options, 1);
    cscd_object_rule *rule = &set.objects[1];
    static double matrix[257 * 257];
    refuse(s.detector, set.objects, 3, NULL, 0,
           "there are 3 rules, expected none or one for each of the 4 objects");
    refuse(s.detector, NULL, OBJECTS, NULL, 0, "rules is NULL");
    refuse(s.detector, NULL, 0, matrix, 257, "1 to 256 classes");
    refuse(s.detector, NULL, 0, NULL, 2, "thickness_matrix is NULL");
    matrix[1] = 0.5;
    refuse(s.detector, NULL, 0, matrix, 2, "make it symmetric");
    matrix[1] = -1.0;
    refuse(s.detector, NULL, 0, matrix, 2, "thickness_matrix has -1 for classes 0 and 1");
    matrix[1] = matrix[2] = 0.5;
    rule->thickness = 0.1;
    refuse(s.detector, set.objects, OBJECTS, matrix, 2, "object 1 has a thickness of 0.1, but");
    rule->thickness = NAN;
    refuse(s.detector, set.objects, OBJECTS, NULL, 0, "object 1 has a thickness of nan");
    rule->thickness = 0.0;
    rule->thickness_class = 2;
    refuse(s.detector, set.objects, OBJECTS, matrix, 2,
           "object 1 has the thickness_class 2, but there are 2");
    rule->thickness_class = 0;
    rule->reserved = 1;
    refuse(s.detector, set.objects, OBJECTS, NULL, 0, "reserved is 1");
    rule->reserved = 0;
    assert_int_equal(cscd_detector_set_separation(s.detector, 0.1, 0.0), CSCD_OK);
    refuse(s.detector, NULL, 0, matrix, 2, "min_separation is 0.1, but");
    assert_int_equal(cscd_detector_set_separation(s.detector, 0.0, 0.0), CSCD_OK);
    assert_int_equal(cscd_detector_set_rules(s.detector, NULL, 0, matrix, 2), CSCD_OK);
    assert_int_equal(cscd_detector_set_separation(s.detector, 0.1, 0.0), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_set_rules(NULL, NULL, 0, NULL, 0), CSCD_NULL_OBJECT);
    tear_down(&s);
}

/* Candidates were collected under the rules of the begin. What is masked limits nothing. */
static void lines_begin_again_after_new_rules(void **state) {
    (void)state;
    rule_set set;
    random_stream random = stream_start(10);
    cscd_detector_options options = cscd_detector_defaults();
    cscd_line_search *line;
    cscd_free_step step;
    cscd_proximities near;
    make_objects(&random);
    memset(set.obstacles, 0, sizeof set.obstacles);
    make_neutral(&set);
    object_setting s = set_up(&set, &options, 1);
    assert_int_equal(cscd_line_search_create(s.detector, &line), CSCD_OK);
    assert_int_equal(line_begin_packed(line, joined.x0, joined.x1, 0.01), CSCD_OK);
    for (int i = 0; i < OBJECTS; i++) {
        set.objects[i].mask = 0;
        set.objects[i].self = false;
        set.objects[i].thickness = 0.1;
    }
    set_rules(&s, &set);
    assert_int_equal(line_max_step_packed(line, 1.0, NULL, &step), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_line_search_find_near(line, 0.5, 0.01, CSCD_NEAR_PAIRS, &near),
                     CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(s.context), "call cscd_line_search_begin again"));
    assert_int_equal(line_begin_packed(line, joined.x0, joined.x1, 0.01), CSCD_OK);
    assert_int_equal(cscd_line_search_candidate_count(line), 0);
    assert_int_equal(line_max_step_packed(line, 1.0, NULL, &step), CSCD_OK);
    assert_true(step.fraction == 1.0 && !step.limited);
    assert_int_equal(max_step_packed(s.detector, joined.x0, joined.x1, NULL, &step), CSCD_OK);
    assert_true(step.fraction == 1.0 && !step.limited);
    cscd_line_search_destroy(line);
    tear_down(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_culling_as_brute_force),    cmocka_unit_test(with_culling_as_brute_force),
        cmocka_unit_test(many_objects_with_a_rule_each),     cmocka_unit_test(masked_objects_are_not_proven),
        cmocka_unit_test(moments_leave_out_what_is_masked),  cmocka_unit_test(mistakes_have_a_sentence),
        cmocka_unit_test(lines_begin_again_after_new_rules),
    };
    return cmocka_run_group_tests_name("object_rules", tests, NULL, NULL);
}
