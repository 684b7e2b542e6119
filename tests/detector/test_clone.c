/* A second detector on one mesh: it begins with what the first one knows, and goes its own way. */
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static sequence recording;

/* A detector by k-means, with rest lengths, an ignored pair and a rule. */
static cscd_detector *detector_of(cscd_context *context, const cscd_mesh *mesh) {
    const uint32_t ignored[2] = {0, 3};
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    plan_options.method = CSCD_METHOD_KMEANS;
    options.ignored = ignored;
    options.ignored_count = 1;
    cscd_object_rule rule = cscd_object_rule_default();
    rule.category = 2;
    options.rules = &rule;
    options.rule_count = 1;
    expect_ok(plan_create_packed(mesh, recording.shape.x0, &plan_options, &plan));
    expect_ok(cscd_detector_create(context, mesh, plan, &options, &detector));
    expect_ok(set_rest_packed(detector, recording.shape.x0));
    cscd_plan_destroy(plan);
    return detector;
}

typedef struct step_list {
    cscd_contact *items;
    size_t count;
    cscd_counters counters;
} step_list;

static step_list step_frame(cscd_detector *d, uint32_t frame) {
    cscd_contacts found;
    expect_ok(step_packed(d, recording.frames[frame], recording.frames[frame + 1], &found));
    step_list list = {malloc(found.count * sizeof *found.items + 1), found.count, cscd_detector_counters(d)};
    if (found.count > 0) memcpy(list.items, found.items, found.count * sizeof *found.items);
    return list;
}

static void check_same_steps(step_list a, step_list b) {
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.items, b.items, a.count * sizeof *a.items);
    assert_memory_equal(&a.counters, &b.counters, sizeof a.counters);
    free(a.items);
    free(b.items);
}

/* Counters too: the trees are the same, and nothing is proven twice. */
TEST(goes_on_as_the_first) {
    size_t clean = 0, contacts = 0;
    for (uint64_t seed = 0; seed < 40; seed++) {
        counting_allocator counters[2] = {counting_allocator_start(), counting_allocator_start()};
        cscd_context *contexts[2] = {context_of(1, &counters[0]),
                                     context_of(1 + (uint32_t)(seed % 3), &counters[1])};
        sequence_make((sequence_kind)(seed % SEQUENCE_KIND_COUNT), seed, 20, &recording);
        cscd_mesh *mesh = mesh_of_scene(contexts[0], &recording.shape);
        cscd_detector *first = detector_of(contexts[0], mesh), *clone = NULL;
        uint32_t begin = (uint32_t)(seed % 5);
        for (uint32_t f = 0; f < begin; f++) free(step_frame(first, f).items);
        expect_ok(cscd_detector_clone(contexts[seed % 2], first, &clone));
        assert_ptr_equal(cscd_detector_mesh(clone), mesh);
        for (uint32_t t = 0; t < recording.shape.triangle_count; t++)
            assert_int_equal(start_state_of(clone, t), start_state_of(first, t));
        for (uint32_t f = begin; f < 19; f++) {
            step_list a = step_frame(first, f), b = step_frame(clone, f);
            clean += a.counters.clean > 0;
            contacts += a.count;
            check_same_steps(a, b);
        }
        cscd_mesh_destroy(mesh);
        cscd_detector_destroy(seed % 3 == 0 ? clone : first);
        cscd_context_destroy(contexts[0]);
        cscd_detector_destroy(seed % 3 == 0 ? first : clone);
        cscd_context_destroy(contexts[1]);
        assert_int_equal(counters[0].live + counters[1].live, 0);
    }
    assert_true(clean > 100 && contacts > 100);
}

/* What is changed in one is not changed in the other. */
TEST(goes_its_own_way) {
    sequence_make(SEQUENCE_SCENE, 3, 20, &recording);
    cscd_context *context = context_of(1, NULL);
    cscd_mesh *mesh = mesh_of_scene(context, &recording.shape);
    cscd_detector *first = detector_of(context, mesh), *clone = NULL, *other = NULL;
    free(step_frame(first, 0).items);
    expect_ok(cscd_detector_clone(context, first, &clone));
    expect_ok(cscd_detector_clone(context, first, &other));
    cscd_object_rule rule = cscd_object_rule_default();
    rule.self = false;
    expect_ok(cscd_detector_set_rules(clone, &rule, 1, NULL, 0));
    expect_ok(cscd_detector_set_separation(other, 0.1, 0.0));
    for (uint32_t f = 1; f < 10; f++) {
        step_list a = step_frame(first, f), b = step_frame(clone, f), c = step_frame(other, f);
        assert_int_equal(b.count, 0);
        assert_true(c.count >= a.count);
        free(a.items);
        free(b.items);
        free(c.items);
    }
    cscd_detector *again = detector_of(context, mesh);
    cscd_detector_destroy(clone);
    cscd_detector_destroy(other);
    for (uint32_t f = 10; f < 19; f++) {
        step_list a = step_frame(first, f), b = step_frame(again, f);
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.items, b.items, a.count * sizeof *a.items);
        free(a.items);
        free(b.items);
    }
    cscd_detector_destroy(again);
    cscd_detector_destroy(first);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- threads, memory, callbacks ------------------------------------------------------------------------- */

typedef struct stepping {
    cscd_detector *detector;
    step_list lists[19];
} stepping;

static void *step_all(void *data) {
    stepping *s = data;
    for (uint32_t f = 1; f < 19; f++) s->lists[f] = step_frame(s->detector, f);
    return NULL;
}

TEST(two_threads) {
    sequence_make(SEQUENCE_SCENE, 8, 20, &recording);
    cscd_context *contexts[2] = {context_of(1, NULL), context_of(2, NULL)};
    cscd_mesh *mesh = mesh_of_scene(contexts[0], &recording.shape);
    stepping both[2] = {{.detector = detector_of(contexts[0], mesh)}};
    free(step_frame(both[0].detector, 0).items);
    expect_ok(cscd_detector_clone(contexts[1], both[0].detector, &both[1].detector));
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&threads[i], NULL, step_all, &both[i]), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    for (uint32_t f = 1; f < 19; f++) check_same_steps(both[0].lists[f], both[1].lists[f]);
    for (int i = 0; i < 2; i++) cscd_detector_destroy(both[i].detector);
    cscd_mesh_destroy(mesh);
    for (int i = 0; i < 2; i++) cscd_context_destroy(contexts[i]);
}

typedef struct cloner {
    cscd_context *other;
    cscd_detector *detector, *clone;
    cscd_status status, status_there;
} cloner;

static bool clone_inside(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    cloner *c = user;
    (void)kind, (void)a, (void)b;
    c->status =
        cscd_detector_clone(cscd_mesh_context(cscd_detector_mesh(c->detector)), c->detector, &c->clone);
    c->status_there = cscd_detector_clone(c->other, c->detector, &c->clone);
    return false;
}

TEST(refused_calls) {
    sequence_make(SEQUENCE_GRID, 5, 20, &recording);
    cscd_context *context = context_of(1, NULL);
    cloner c = {.other = context_of(1, NULL)};
    cscd_mesh *mesh = mesh_of_scene(context, &recording.shape);
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = clone_inside;
    options.ignore_user = &c;
    expect_ok(cscd_detector_create(context, mesh, NULL, &options, &c.detector));
    size_t contacts = 0;
    for (uint32_t f = 0; f < 19; f++) {
        step_list list = step_frame(c.detector, f);
        contacts += list.count;
        free(list.items);
    }
    assert_true(contacts > 0);
    assert_int_equal(c.status, CSCD_BUSY);
    assert_int_equal(c.status_there, CSCD_BUSY);
    assert_null(c.clone);
    assert_int_equal(cscd_detector_clone(context, c.detector, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_clone(NULL, c.detector, &c.clone), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_detector_clone(context, NULL, &c.clone), CSCD_NULL_OBJECT);
    cscd_detector_destroy(c.detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    cscd_context_destroy(c.other);
}

/* ---- what is known --------------------------------------------------------------------------------------- */

/* Before the first call nothing is known; after a check of intersecting triangles these are crossing, and far from
 * them there are clean ones; after a step that touches, some are unknown. */
TEST(knowledge_of_starts) {
    uint32_t seen[4] = {0};
    for (uint64_t seed = 0; seed < 30; seed++) {
        sequence_make(SEQUENCE_SCENE, seed, 20, &recording);
        cscd_context *context = context_of(1, NULL);
        cscd_mesh *mesh = mesh_of_scene(context, &recording.shape);
        cscd_detector *d = detector_of(context, mesh);
        for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) {
            assert_int_equal(start_states_in(d, c, TRIANGLE_UNKNOWN),
                             cscd_mesh_component(mesh, c).triangle_count);
        }
        for (uint32_t f = 0; f < 19; f++) {
            cscd_intersections crossing;
            expect_ok(check_packed(d, recording.frames[f], &crossing));
            for (size_t i = 0; i < crossing.count; i++) {
                uint32_t a = crossing.items[i].a, b = crossing.items[i].b;
                if (cscd_mesh_triangle_component(mesh, a) != cscd_mesh_triangle_component(mesh, b)) continue;
                assert_int_equal(start_state_of(d, a), TRIANGLE_CROSSING);
                assert_int_equal(start_state_of(d, b), TRIANGLE_CROSSING);
            }
            free(step_frame(d, f).items);
            for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) seen[start_state_of(d, t)]++;
        }
        cscd_detector_destroy(d);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
    assert_true(seen[TRIANGLE_CLEAN] > 1000 && seen[TRIANGLE_UNKNOWN] > 100 && seen[TRIANGLE_FREE] > 0);
}
