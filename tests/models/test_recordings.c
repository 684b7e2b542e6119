/* The recordings begin embedded, are repeatable bit for bit, gain no energy, and fit into their files. */
#include "models/softbody/softbody.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The number of frames of each scene that are run, and how many of these a second time. A body first
 * touches itself in frame 31 of pawn-drop, 30 of dumbbell-stairs, and 71 of figure-balls. */
static const struct extent {
    const char *name;
    uint32_t frames, repeated;
    bool runs_into_itself;
} extents[] = {
#ifdef SLOW_MACHINE
    {"pawn-drop", 6, 4, false},        {"pawn-drop-free", 6, 2, false},
    {"dumbbell-stairs", 34, 33, true}, {"dumbbell-stairs-free", 8, 2, false},
    {"figure-balls", 6, 4, false},     {"figure-balls-free", 6, 2, false},
#else
    {"pawn-drop", 36, 36, true},       {"pawn-drop-free", 20, 8, false},
    {"dumbbell-stairs", 36, 36, true}, {"dumbbell-stairs-free", 20, 8, false},
    {"figure-balls", 20, 8, false},    {"figure-balls-free", 20, 8, false},
#endif
};

enum { SCENE_COUNT = sizeof extents / sizeof *extents };

/* Computes 64-bit FNV-1a over the bytes of the positions. */
static uint64_t add_to_hash(uint64_t hash, const double *values, size_t count) {
    const unsigned char *bytes = (const unsigned char *)values;
    for (size_t i = 0; i < count * sizeof *values; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static recorder open_scene(const char *name) {
    recorder r;
    io_error error;
    const soft_scene *s = soft_scene_find(name);
    if (s == NULL) fail_msg("no scene is called %s", name);
    if (!recorder_open(s, NULL, &r, &error)) fail_msg("%s", error.text);
    return r;
}

static void advance_recorder(recorder *r) {
    io_error error;
    if (!recorder_advance(r, &error)) fail_msg("%s", error.text);
}

static void check_frame(const recorder *r, double start_energy) {
    for (uint32_t i = 0; i < r->shape.vertex_count * 3; i++) {
        volatile float rounded = (float)r->frame[i];
        assert_true(isfinite(r->frame[i]) && (double)rounded == r->frame[i]);
    }
    if (!(recorder_energy(r) <= start_energy * (1.0 + 1e-9)))
        fail_msg("%s: energy %.12g from %.12g", r->scene->name, recorder_energy(r), start_energy);
}

/* Frame 0 is the model, has no intersection, and is above its obstacles. */
TEST(scenes_begin_embedded) {
    assert_int_equal(soft_scene_count, SCENE_COUNT);
    for (int i = 0; i < SCENE_COUNT; i++) {
        recorder r = open_scene(extents[i].name);
        cscd_intersections intersections;
        assert_true(r.scene->frame_count >= 120);
        assert_int_equal(cscd_mesh_component(r.mesh, 0).closed_manifold, true);
        assert_memory_equal(r.frame, r.shape.positions, (size_t)r.shape.vertex_count * 3 * sizeof *r.frame);
        assert_int_equal(check_packed(r.detector, r.frame, &intersections), CSCD_OK);
        assert_int_equal(intersections.count, 0);
        assert_int_equal(intersections.zero_area_triangles, 0);
        for (uint32_t v = 0; v < r.shape.vertex_count; v++) {
            const double *p = r.frame + v * 3;
            obstacle_hit hit;
            assert_false(obstacles_hit_terrain(&r.around, p, &hit));
            for (uint32_t b = 0; b < r.around.ball_count; b++)
                assert_false(obstacles_hit_ball(&r.around, b, p, &hit));
        }
        recorder_close(&r);
    }
}

/* Runs and checks the first frames of a scene; returns the hash of the frames before `hashed`. */
static uint64_t run_scene(const char *name, uint32_t frames, uint32_t hashed, bool *met_itself) {
    recorder r = open_scene(name);
    double energy = recorder_energy(&r);
    uint64_t hash = add_to_hash(0xcbf29ce484222325u, r.frame, r.shape.vertex_count * (size_t)3);
    check_frame(&r, energy);
    for (uint32_t k = 1; k < frames; k++) {
        advance_recorder(&r);
        check_frame(&r, energy);
        *met_itself = *met_itself || (k < hashed && r.contacts.count > 0);
        if (k < hashed) hash = add_to_hash(hash, r.frame, r.shape.vertex_count * (size_t)3);
    }
    recorder_close(&r);
    return hash;
}

TEST(first_frames_are_repeatable) {
    for (int i = 0; i < SCENE_COUNT; i++) {
        const struct extent *e = &extents[i];
        bool met = false, met_again = false;
        uint64_t hash = run_scene(e->name, e->frames, e->repeated, &met);
        uint64_t again = run_scene(e->name, e->repeated, e->repeated, &met_again);
        if (hash != again)
            fail_msg("%s: %016llx, then %016llx", e->name, (unsigned long long)hash,
                     (unsigned long long)again);
        assert_int_equal(met, e->runs_into_itself);
        assert_int_equal(met, met_again);
    }
}

/* Scenes are found by their names, and no others are found. */
TEST(scenes_have_their_names) {
    for (uint32_t i = 0; i < soft_scene_count; i++) {
        assert_ptr_equal(soft_scene_find(soft_scenes[i].name), &soft_scenes[i]);
        assert_true(soft_scenes[i].text[0] != '\0');
    }
    assert_null(soft_scene_find("pawn"));
    assert_null(soft_scene_find(""));
    assert_null(soft_scene_find("pawn-drop-free-"));
}
