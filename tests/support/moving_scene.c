/* Detectors whose scenes tear, are refined, come and go, with all that they have been told. */
#include "tests/support/moving_scene.h"
#include "tests/support/culling/exact_numbers.h"

#include "tests/support/packed.h"
#include "tests/support/test.h"
#include "tests/support/torn_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

moving_scene moving;
scene moving_joined;
scene_change moving_change;

const cscd_mesh *moving_mesh_now(void) {
    return cscd_detector_mesh(moving.detector);
}

/* ---- what the detector is told ------------------------------------------------------------------------- */

static void make_rules(void) {
    for (int i = 0; i < CHANGING_OBJECTS_MAX; i++) {
        cscd_object_rule rule = cscd_object_rule_default();
        if (moving.rules) {
            rule.category = 1u << stream_below(&moving.random, 3);
            rule.mask = 1 + stream_below(&moving.random, 7);
            rule.self = stream_below(&moving.random, 3) > 0;
            if (moving.options.min_separation == 0.0 && stream_below(&moving.random, 2) == 0)
                rule.thickness = 0.02;
        }
        moving.object_rules[i] = rule;
    }
}

static uint32_t seam_pairs(uint32_t (*pairs)[2]) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < moving_joined.vertex_count; v++) {
        for (uint32_t w = 0; w < v && moving.labels[v] != UINT32_MAX; w++) {
            if (moving.labels[w] != moving.labels[v]) continue;
            pairs[count][0] = v;
            pairs[count++][1] = w;
            break;
        }
    }
    return count;
}

static void make_pairs(void) {
    memset(moving.labels, 0xff, sizeof moving.labels);
    for (uint32_t i = 0; moving.seams && i < 30; i++)
        moving.labels[stream_below(&moving.random, moving_joined.vertex_count)] = i % 10;
    moving.ignored_count = moving.ignored ? 300 : 0;
    moving.ignored_pairs = malloc(400 * sizeof *moving.ignored_pairs);
    for (size_t i = 0; i < moving.ignored_count; i++) {
        moving.ignored_pairs[i][0] = stream_below(&moving.random, moving_joined.triangle_count);
        moving.ignored_pairs[i][1] = (moving.ignored_pairs[i][0] + 1 +
                                      stream_below(&moving.random, moving_joined.triangle_count - 1)) %
                                     moving_joined.triangle_count;
    }
}

/* A detector that begins with all that was said, in the numbering of now. */
cscd_detector *moving_new_detector(const cscd_mesh *mesh, const cscd_plan *plan) {
    static uint32_t pairs[MOVING_VERTICES][2];
    cscd_detector_options options = moving.options;
    cscd_detector *made = NULL;
    options.seams = pairs[0];
    options.seam_count = seam_pairs(pairs);
    options.seam_reach = INFINITY;
    options.ignored = moving.ignored_count > 0 ? moving.ignored_pairs[0] : NULL;
    options.ignored_count = moving.ignored_count;
    options.rules = moving.rules ? moving.object_rules : NULL;
    options.rule_count = moving.rules ? moving.shape.object_count : 0;
    expect_ok(cscd_detector_create(moving.context, mesh, plan, &options, &made));
    return made;
}

/* ---- what becomes of it -------------------------------------------------------------------------------- */

static void map_rules(const uint32_t *objects, uint32_t count) {
    cscd_object_rule moved[CHANGING_OBJECTS_MAX];
    for (uint32_t i = 0; i < count; i++)
        moved[i] = objects[i] != UINT32_MAX ? moving.object_rules[objects[i]] : cscd_object_rule_default();
    memcpy(moving.object_rules, moved, count * sizeof *moved);
}

static void map_labels(const uint32_t *vertices, uint32_t old_count) {
    uint32_t moved[MOVING_VERTICES];
    memset(moved, 0xff, sizeof moved);
    for (uint32_t v = 0; v < old_count; v++) {
        if (vertices[v] != UINT32_MAX) moved[vertices[v]] = moving.labels[v];
    }
    memcpy(moving.labels, moved, sizeof moved);
}

static void map_ignored(const uint32_t *origins, uint32_t count) {
    size_t capacity = 100, found = 0;
    uint32_t(*moved)[2] = malloc(capacity * sizeof *moved);
    for (size_t i = 0; i < moving.ignored_count; i++) {
        for (uint32_t a = 0; a < count; a++) {
            for (uint32_t b = 0; b < count && origins[a] == moving.ignored_pairs[i][0]; b++) {
                if (origins[b] != moving.ignored_pairs[i][1]) continue;
                if (found == capacity) moved = realloc(moved, (capacity *= 2) * sizeof *moved);
                moved[found][0] = a;
                moved[found++][1] = b;
            }
        }
    }
    free(moving.ignored_pairs);
    moving.ignored_pairs = moved;
    moving.ignored_count = found;
}

/* Copies of a vertex move a little apart, so that nothing touches what it was a neighbour of. */
static void part_copies(const uint32_t *vertices, const uint32_t *origins) {
    uint32_t vertex = 0;
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        for (uint32_t v = 0; v < o->vertex_count; v++, vertex++) {
            if (origins[vertex] == UINT32_MAX || vertices[origins[vertex]] == vertex) continue;
            for (size_t k = 0; k < 3; k++)
                o->positions[3 * v + k] += stream_between(&moving.random, -0.05, 0.05);
        }
    }
}

void moving_take_change(cscd_mesh_change *made) {
    uint32_t old_count, new_count;
    const uint32_t *vertices = cscd_mesh_change_to_new(made, CSCD_VERTICES, &old_count);
    torn_model_change(made, moving.labels);
    map_labels(vertices, old_count);
    map_rules(cscd_mesh_change_to_old(made, CSCD_OBJECTS, NULL), moving.shape.object_count);
    const uint32_t *triangles = cscd_mesh_change_to_old(made, CSCD_TRIANGLES, &new_count);
    map_ignored(triangles, new_count);
    if (stream_below(&moving.random, 2) == 0)
        part_copies(vertices, cscd_mesh_change_to_old(made, CSCD_VERTICES, NULL));
    changing_scene_join(&moving.shape, &moving_joined);
    cscd_mesh_change_destroy(moving.last);
    moving.last = made;
}

void moving_change_scene(void) {
    cscd_mesh_change *made = NULL;
    changing_scene_change(&moving.random, &moving.shape, &moving_change);
    expect_ok(cscd_mesh_change_create(moving.context, moving_mesh_now(), moving_change.list,
                                      moving_change.count, &made));
    expect_ok(cscd_detector_change_mesh(moving.detector, made));
    assert_ptr_equal(moving_mesh_now(), cscd_mesh_change_mesh(made));
    moving_take_change(made);
}

/* A clone goes on in place of the detector, whatever that has come to. */
void moving_replace_by_clone(void) {
    cscd_detector *clone = NULL;
    expect_ok(cscd_detector_clone(moving.context, moving.detector, &clone));
    cscd_detector_destroy(moving.detector);
    moving.detector = clone;
}

/* ---- motions ------------------------------------------------------------------------------------------- */

void moving_move_scene(double speed) {
    uint32_t vertex = 0;
    memcpy(moving.x0, moving_joined.x0, moving_joined.vertex_count * sizeof(double[3]));
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        double by[3];
        bool rests = stream_below(&moving.random, 4) == 0;
        for (int k = 0; k < 3; k++) by[k] = stream_between(&moving.random, -speed, speed);
        for (uint32_t v = 0; v < o->vertex_count; v++, vertex++) {
            for (size_t k = 0; k < 3; k++) {
                double noise = stream_between(&moving.random, -0.05, 0.05) * speed;
                moving.x1[3 * vertex + k] = moving.x0[3 * vertex + k] + (rests ? 0.0 : by[k] + noise);
            }
        }
    }
}

/* The end becomes the start. */
void moving_go_on(void) {
    uint32_t vertex = 0;
    expect_one_number(moving.detector, "a changing scene");
    for (uint32_t i = 0; i < moving.shape.object_count; i++) {
        changing_object *o = &moving.shape.objects[i];
        memcpy(o->positions, moving.x1 + 3 * vertex, o->vertex_count * sizeof(double[3]));
        vertex += o->vertex_count;
    }
    changing_scene_join(&moving.shape, &moving_joined);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

void moving_begin_scene(cscd_context *context, uint64_t seed, bool plain) {
    moving =
        (moving_scene){.random = stream_start(seed), .context = context, .options = cscd_detector_defaults()};
    torn_model_begin();
    changing_scene_make(&moving.random, !plain, &moving.shape);
    changing_scene_join(&moving.shape, &moving_joined);
    moving.first = changing_scene_mesh(context, &moving.shape);
    uint32_t method = stream_below(&moving.random, 3);
    cscd_plan *plan = NULL;
    if (method == 1) moving.options.method = CSCD_METHOD_SINGLE;
    if (method == 2) {
        cscd_plan_options plan_options = cscd_plan_defaults();
        plan_options.method = CSCD_METHOD_KMEANS;
        plan_options.k = 12;
        expect_ok(plan_create_packed(moving.first, moving_joined.x0, &plan_options, &plan));
    }
    if (!plain) {
        moving.rules = stream_below(&moving.random, 3) == 0;
        moving.seams = stream_below(&moving.random, 3) == 0;
        moving.ignored = stream_below(&moving.random, 3) == 0;
        if (!moving.rules && stream_below(&moving.random, 4) == 0) moving.options.min_separation = 0.03;
        if (stream_below(&moving.random, 4) == 0) moving.options.volume = CSCD_VOLUME_KDOP14;
    }
    moving.earliest = seed % 4 == 1;
    if (moving.earliest) moving.options.mode = CSCD_MODE_EARLIEST;
    make_rules();
    make_pairs();
    moving.detector = moving_new_detector(moving.first, plan);
    moving.options.method = CSCD_METHOD_AUTO;
    moving.options.mode = CSCD_MODE_ALL;
    cscd_plan_destroy(plan);
}

void moving_end_scene(void) {
    cscd_detector_destroy(moving.detector);
    cscd_mesh_change_destroy(moving.last);
    cscd_mesh_destroy(moving.first);
    free(moving.ignored_pairs);
}
