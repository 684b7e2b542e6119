/* All answers about surfaces at once, from detectors that live long: meshes change under them, obstacles come and go, wires,
 * points and half-spaces stand about, and only some vertices are active. A detector that leaves the same pairs out by its
 * function says the same, and so does one that was made this moment. */
#include "tests/support/active_twins.h"
#include "tests/support/calls.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { SHAPES = 7, BODIES = 3, OBJECTS_MAX = 9, ROUNDS = 10, PARTS = 4 };

enum { LIVES = PACED(10, 6) };

typedef struct live_object {
    uint32_t shape;
    bool obstacle;
} live_object;

/* Three bodies and a sheet; wires, points and a half-space, whose positions are drawn. */
static scene bodies[BODIES + 1]; /* large, as the others; one test at a time */
static cscd_object_desc shapes[SHAPES];
static live_object objects[OBJECTS_MAX];
static uint32_t object_count;
static active_twins twins;
static random_stream chance;
static cscd_context *context;
static cscd_mesh *first_mesh;
static cscd_mesh_change *last_change;
static double places[2][SCENE_VERTICES_MAX * 3];
static size_t curves_seen, depths_seen, cut_offs_seen, parts_seen, partly_seen, changes_seen;

/* ---- objects ------------------------------------------------------------------------------------------- */

static void make_shapes(void) {
    static const double origin[3] = {0, 0, 0}, up[3] = {0.1, 0.2, 1};
    static const uint32_t wires[3][2] = {{0, 1}, {1, 2}, {2, 3}};
    for (int i = 0; i <= BODIES; i++) scene_clear(&bodies[i]);
    scene_add_sphere(&bodies[0], origin, 0.7, 5, 7);
    scene_add_torus(&bodies[1], origin, 0.8, 0.3, 9, 6, true);
    scene_add_capsule(&bodies[2], 1.6, 0.4, 6, 6);
    scene_add_sheet(&bodies[BODIES], 2.5, 2.5, 6, 6);
    for (int i = 0; i <= BODIES; i++)
        shapes[i] =
            cscd_object_of_triangles(bodies[i].vertex_count, bodies[i].triangle_count, bodies[i].triangles);
    shapes[4] = cscd_object_of_wires(4, 3, wires[0]);
    shapes[5] = cscd_object_of_points(5);
    shapes[6] = cscd_object_half_space(up);
}

static live_object draw_object(void) {
    return (live_object){stream_below(&chance, SHAPES), stream_below(&chance, 5) == 0};
}

static cscd_object_desc describe_object(live_object o) {
    cscd_object_desc desc = shapes[o.shape];
    desc.obstacle = o.obstacle;
    return desc;
}

/* Objects lie about at random, and move on a little until the end; some rest. At times all are on a coarse grid, where
 * vertices lie on other surfaces. */
static void draw_places(void) {
    uint32_t vertex = 0;
    bool on_grid = stream_below(&chance, 2) == 0;
    for (uint32_t i = 0; i < object_count; i++) {
        const cscd_object_desc desc = shapes[objects[i].shape];
        double centre[3], by[3];
        bool rests = stream_below(&chance, 3) == 0;
        for (int k = 0; k < 3; k++) {
            centre[k] = stream_between(&chance, -0.8, 0.8);
            by[k] = rests ? 0.0 : stream_between(&chance, -0.4, 0.4);
        }
        for (uint32_t v = 0; v < desc.vertex_count; v++, vertex++) {
            for (uint32_t k = 0; k < 3; k++) {
                double own = objects[i].shape <= BODIES ? bodies[objects[i].shape].x0[v * 3 + k]
                                                        : stream_between(&chance, -1.0, 1.0);
                places[0][vertex * 3 + k] = centre[k] + own + stream_between(&chance, -0.05, 0.05);
                places[1][vertex * 3 + k] = places[0][vertex * 3 + k] + by[k];
                for (int end = 0; end < 2 && on_grid; end++)
                    places[end][vertex * 3 + k] = rint(places[end][vertex * 3 + k] * 4) / 4;
            }
        }
    }
    assert_int_equal(vertex, twins.vertex_count);
}

/* ---- changes ------------------------------------------------------------------------------------------- */

/* One object goes, one comes, or one becomes an obstacle or ceases to be one. */
static cscd_mesh_change *change_objects(void) {
    uint32_t kind = stream_below(&chance, 3), object = stream_below(&chance, object_count);
    bool comes = object_count < 4 || (kind == 0 && object_count < OBJECTS_MAX), goes = !comes && kind == 1;
    cscd_object_desc desc;
    cscd_mesh_change *change = NULL;
    cscd_object_change what = {.object = comes ? UINT32_MAX : object, .desc = goes ? NULL : &desc};
    if (comes) {
        objects[object_count] = draw_object();
        object = object_count++;
    } else if (goes) {
        memmove(&objects[object], &objects[object + 1], (object_count - object - 1) * sizeof *objects);
        object_count--;
    } else {
        objects[object].obstacle = !objects[object].obstacle;
    }
    if (!goes) desc = describe_object(objects[object]);
    expect_ok(cscd_mesh_change_create(context, twins.mesh, &what, 1, &change));
    return change;
}

static void change_meshes(void) {
    cscd_mesh_change *change = change_objects();
    cscd_detector *ours = twins.ours, *theirs = twins.theirs;
    expect_ok(cscd_detector_change_mesh(ours, change));
    expect_ok(cscd_detector_change_mesh(theirs, change));
    active_twins_join(&twins, ours, theirs);
    cscd_mesh_change_destroy(last_change);
    last_change = change;
}

/* Labels of triangles, or none. */
static void label_parts(cscd_detector *fresh, bool wanted) {
    static uint32_t labels[SCENE_TRIANGLES_MAX];
    uint32_t count = cscd_mesh_triangle_count(twins.mesh);
    cscd_detector *const all[3] = {twins.ours, twins.theirs, fresh};
    for (uint32_t t = 0; t < count; t++)
        labels[t] = stream_below(&chance, 9) == 0 ? UINT32_MAX : stream_below(&chance, PARTS);
    for (int i = 0; i < 3; i++)
        expect_ok(cscd_detector_set_parts(all[i], wanted ? labels : NULL, wanted ? PARTS : 0));
}

/* ---- answers ------------------------------------------------------------------------------------------- */

static cscd_detector *new_detector(bool leaves_out) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *made = NULL;
    if (leaves_out) {
        options.ignore = active_twins_ignore;
        options.ignore_user = &twins;
    }
    expect_ok(detector_create_here(twins.mesh, NULL, &options, &made));
    return made;
}

static void find_everything(cscd_detector *d, const double *x, cscd_intersections *out) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.overlaps = options.depths = options.cut_offs = options.parts = true;
    expect_ok(find_intersections_packed(d, x, &options, out));
}

/* Of pairs that only one of the two leaves out, only that one knows that a volume is not known. */
static void expect_same_overlaps(const cscd_overlaps *ours, const cscd_overlaps *theirs) {
    size_t next = 0;
    for (size_t i = 0; i < theirs->count; i++) {
        const cscd_overlap *q = &theirs->items[i];
        const cscd_overlap *p = next < ours->count ? &ours->items[next] : NULL;
        bool found = p != NULL && p->a == q->a && p->b == q->b;
        next += found;
        assert_true(found || isnan(q->volume));
        if (found) assert_true(p->area_a == q->area_a && p->area_b == q->area_b);
        if (found && !isnan(q->volume)) assert_true(p->volume == q->volume);
    }
    assert_int_equal(next, ours->count);
}

static void compare_at(cscd_detector *fresh, const double *x) {
    cscd_intersections ours, theirs, anew;
    find_everything(twins.ours, x, &ours);
    find_everything(twins.theirs, x, &theirs);
    find_everything(fresh, x, &anew);
    compare_surfaces(twins.mesh, &ours, &theirs);
    expect_same_overlaps(ours.overlaps, theirs.overlaps);
    if (cscd_detector_waiting(twins.theirs).triangles == 0) compare_answers(twins.mesh, &theirs, &anew);
    for (size_t i = 0; i < ours.curves->count; i++) partly_seen += twins.set && !ours.curves->items[i].closed;
    curves_seen += ours.curves->count;
    depths_seen += ours.depths->count;
    cut_offs_seen += ours.cut_offs->count;
    parts_seen += ours.parts->count;
}

/* ---- lives --------------------------------------------------------------------------------------------- */

static void begin_life(uint64_t seed) {
    cscd_object_desc descs[OBJECTS_MAX];
    cscd_context_options options = cscd_context_defaults();
    chance = stream_start(seed);
    options.thread_count = 1 + (uint32_t)(seed % 2);
    object_count = 5;
    for (uint32_t i = 0; i < object_count; i++) {
        objects[i] = i < 2 ? (live_object){i == 0 ? 3 : 0, false} : draw_object();
        descs[i] = describe_object(objects[i]);
    }
    expect_ok(cscd_context_create(&options, &context));
    expect_ok(cscd_mesh_create(context, descs, object_count, &first_mesh));
    twins.mesh = first_mesh;
    last_change = NULL;
    twins.set = false;
    cscd_detector *ours = new_detector(false), *theirs = new_detector(true);
    active_twins_join(&twins, ours, theirs);
}

static void end_life(void) {
    active_twins_end(&twins);
    cscd_detector_destroy(twins.ours);
    cscd_mesh_change_destroy(last_change);
    cscd_mesh_destroy(first_mesh);
    cscd_context_destroy(context);
}

TEST(everything_changes) {
    memset(&twins, 0, sizeof twins);
    make_shapes();
    for (uint64_t seed = 0; seed < LIVES; seed++) {
        begin_life(seed);
        for (int round = 0; round < ROUNDS; round++) {
            bool changes = round > 0 && stream_below(&chance, 3) > 0;
            if (changes) change_meshes();
            changes_seen += changes;
            draw_places();
            active_twins_choose(&twins, places[0], &chance);
            cscd_detector *fresh = new_detector(true);
            label_parts(fresh, stream_below(&chance, 2) == 0);
            compare_at(fresh, places[0]);
            compare_at(fresh, places[1]);
            cscd_detector_destroy(fresh);
        }
        end_life();
    }
    print_message(
        "%zu curves, %zu of them open with an active set; %zu depths, %zu cut off, %zu pairs of parts, "
        "%zu changes, %zu waiting\n",
        curves_seen, partly_seen, depths_seen, cut_offs_seen, parts_seen, changes_seen, twins.waiting);
    assert_true(curves_seen > 50 * LIVES && depths_seen > 100 * LIVES && partly_seen > 10 * LIVES);
    assert_true(cut_offs_seen > LIVES && parts_seen > 50 * LIVES);
    assert_true(changes_seen > 4 * LIVES);
}
