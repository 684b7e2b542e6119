/* The recordings of several closed objects: what is in them, that they touch and part, and that they repeat.
 */
#include "models/objects/objects.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static cscd_context *context;

static int make_context(void **state) {
    (void)state;
    return cscd_context_create(NULL, &context) == CSCD_OK ? 0 : -1;
}

static int destroy_context(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

static object_stage stage_of(const char *name) {
    object_stage s;
    io_error error;
    const object_scene *scene = object_scene_find(name);
    assert_non_null(scene);
    if (!object_stage_open(scene, &s, &error)) fail_msg("%s", error.text);
    return s;
}

static cscd_mesh *mesh_of(const body *b) {
    const cscd_object_desc desc = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
    cscd_mesh *mesh;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    return mesh;
}

/* Components are the objects in their order. */
static void check_closed(const cscd_mesh *mesh, uint32_t object_count) {
    assert_int_equal(cscd_mesh_component_count(mesh), object_count);
    for (uint32_t i = 0; i < object_count; i++) assert_true(cscd_mesh_component(mesh, i).closed_manifold);
}

static void check_counts(const cscd_mesh *mesh, const object_scene *scene) {
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const moving_object *o = &scene->objects[i];
        uint32_t wanted = o->triangle_count > 0 ? o->triangle_count : body_default_count(o->kind);
        assert_int_equal(cscd_mesh_component(mesh, i).triangle_count, wanted);
    }
}

/* Counts the contacts that the detector finds in every `stride`-th frame. */
static census count_contacts(object_stage *s, const cscd_mesh *mesh, uint32_t stride) {
    census c;
    assert_int_equal(census_begin(mesh, &c), CSCD_OK);
    for (uint32_t frame = 0; frame < s->scene->frame_count; frame += stride) {
        object_stage_go(s, frame);
        assert_int_equal(census_add(&c, s->placed.positions), CSCD_OK);
    }
    return c;
}

TEST(objects_touch_and_part) {
    for (uint32_t i = 0; i < object_scene_count; i++) {
        object_stage s = stage_of(object_scenes[i].name);
        uint32_t stride = s.placed.triangle_count > 10000 ? 4 : 2, intervals, touched;
        cscd_mesh *mesh = mesh_of(&s.placed);
        check_closed(mesh, s.scene->object_count);
        check_counts(mesh, s.scene);
        census c = count_contacts(&s, mesh, stride);
        intervals = c.frame_count - 1;
        touched = c.between_intervals;
        print_message("  %s: %u of %u intervals, %u pairs of objects\n", s.scene->name, touched, intervals,
                      census_pair_count(&c));
        assert_true(touched >= 2 && touched <= intervals * 3 / 4);
        assert_int_equal(c.within_intervals, 0);
        assert_true(census_pair_count(&c) >= 1 && c.contacts > touched);
        assert_true(c.largest_motion < 1.5 * stride);
        assert_true(s.scene->frame_count >= 60 && s.scene->frame_count <= 120);
        census_free(&c);
        cscd_mesh_destroy(mesh);
        object_stage_close(&s);
    }
}

TEST(letters_have_the_counts_of_the_seed) {
    assert_int_equal(body_default_count(BODY_LETTER_T), 1380);
    assert_int_equal(body_default_count(BODY_LETTER_W), 11920);
    for (int i = 0; i < 2; i++) {
        const moving_object *o = object_scene_find(i == 0 ? "t-pair" : "w-pair")->objects;
        body_kind kind = i == 0 ? BODY_LETTER_T : BODY_LETTER_W;
        for (int k = 0; k < 2; k++) assert_true(o[k].kind == kind && o[k].triangle_count == 0);
    }
}

/* Figure 2-20 of the thesis: the ball touches only one arm of the V. */
TEST(the_second_ball_stays_near) {
    object_stage s = stage_of("v-shape");
    cscd_mesh *mesh = mesh_of(&s.placed);
    census c = count_contacts(&s, mesh, 2);
    assert_true(c.pairs[1]);
    assert_false(c.pairs[2]);
    assert_false(c.pairs[3 + 2]);
    census_free(&c);
    cscd_mesh_destroy(mesh);
    object_stage_close(&s);
}

/* Neighbours in a row touch, and no others do. */
TEST(rows_touch_their_neighbours) {
    static const char *const names[] = {"three-spheres", "three-spheres-unequal", "u-three"};
    static const bool first_with_third[] = {false, false, true};
    for (int i = 0; i < 3; i++) {
        object_stage s = stage_of(names[i]);
        cscd_mesh *mesh = mesh_of(&s.placed);
        census c = count_contacts(&s, mesh, 3);
        assert_true(c.pairs[1]);
        assert_int_equal(c.pairs[2], first_with_third[i]);
        assert_int_equal(c.pairs[3 + 2], !first_with_third[i]);
        assert_false(c.pairs[0] || c.pairs[4] || c.pairs[8]);
        census_free(&c);
        cscd_mesh_destroy(mesh);
        object_stage_close(&s);
    }
}

/* A frame is the same, regardless of the frames that were shown before it. */
TEST(frames_repeat) {
    object_stage a = stage_of("three-spheres"), b = stage_of("three-spheres");
    size_t bytes = (size_t)a.placed.vertex_count * 3 * sizeof(double);
    object_stage_go(&a, 89);
    object_stage_go(&a, 17);
    object_stage_go(&b, 17);
    assert_memory_equal(a.placed.positions, b.placed.positions, bytes);
    object_stage_go(&b, 18);
    assert_memory_not_equal(a.placed.positions, b.placed.positions, bytes);
    object_stage_close(&a);
    object_stage_close(&b);
    assert_null(object_scene_find("four-spheres"));
}

static tumble tumble_of(uint32_t frame) {
    tumble t;
    io_error error;
    if (!tumble_open(context, &t, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < frame; i++)
        if (!tumble_advance(&t, &error)) fail_msg("%s", error.text);
    return t;
}

static void check_second(const double *frame) {
    tumble again = tumble_of(2);
    assert_memory_equal(frame, again.frame, (size_t)again.shape.vertex_count * 3 * sizeof *frame);
    tumble_close(&again);
}

/* The bodies fall freely for ten frames, and later touch each other but never themselves. */
TEST(soft_bodies_fall_onto_each_other) {
    io_error error;
    tumble t = tumble_of(0);
    census c;
    check_closed(t.mesh, TUMBLE_BODIES);
    assert_int_equal(t.shape.triangle_count, 8148);
    assert_int_equal(census_begin(t.mesh, &c), CSCD_OK);
    for (uint32_t frame = 0; frame < 30; frame++) {
        if (frame > 0 && !tumble_advance(&t, &error)) fail_msg("%s", error.text);
        assert_int_equal(census_add(&c, t.frame), CSCD_OK);
        assert_true(frame > 10 || c.contacts == 0);
        if (frame == 2) check_second(t.frame);
    }
    assert_true(c.between_intervals > 0 && c.between_intervals < 20);
    assert_int_equal(c.within_intervals, 0);
    for (uint32_t i = 0; i < t.shape.vertex_count * 3; i++)
        assert_true(i % 3 == 2 ? t.frame[i] > -0.1 : t.frame[i] > -1.9 && t.frame[i] < 1.9);
    census_free(&c);
    tumble_close(&t);
}

AROUND_ALL(make_context, destroy_context)
