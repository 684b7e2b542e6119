/* Active vertices: how the work falls, what is refused, and what stays known. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/active_twins.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/panels.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static active_twins twins; /* large, as the others; one test at a time */
static scene s;

static void set_vertices(cscd_detector *d, const uint32_t *vertices, size_t count) {
    expect_ok(cscd_detector_set_active(d, vertices, count));
}

static double away_from(uint32_t centre, uint32_t v) {
    const double *a = s.x0 + centre * 3, *b = s.x0 + v * 3;
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Those within the radius of a vertex; all others stay where they start. Returns how many there are. */
static uint32_t choose_ball(uint32_t centre, double radius, uint32_t *vertices) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        if (away_from(centre, v) <= radius)
            vertices[count++] = v;
        else
            memcpy(s.x1 + v * 3, s.x0 + v * 3, sizeof(double[3]));
    }
    return count;
}

/* ---- work ---------------------------------------------------------------------------------------------- */

static cscd_counters count_step(const rig *r, size_t *contacts) {
    *contacts = rig_step(r, &s).count;
    return cscd_detector_counters(r->detector);
}

/* A patch of 1 % of two spheres that almost touch everywhere. */
TEST(work_falls_with_the_active_part) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_BRUTE};
    static uint32_t vertices[SCENE_VERTICES_MAX];
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 20, 24);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 0.99, 20, 24);
    for (uint32_t k = 0; k < s.vertex_count * 3 / 2; k++) s.x1[k] *= 0.97;
    uint32_t count = choose_ball(100, 0.2, vertices);
    assert_in_range(count, 2, s.vertex_count / 20);
    for (int m = 0; m < 3; m++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[m];
        rig r = rig_create(&s, 1, &options);
        size_t all_found, found;
        cscd_counters all = count_step(&r, &all_found), again;
        set_vertices(r.detector, vertices, count);
        cscd_counters part = count_step(&r, &found);
        assert_int_equal(found, all_found); /* the rest rests, and nothing touches at the start */
        assert_true(found > 0);
        if (methods[m] != CSCD_METHOD_BRUTE) {
            assert_true(part.boxes_tested * 5 < all.boxes_tested);
            assert_true((part.pcp - part.adjacent) * 5 < all.pcp - all.adjacent);
        }
        assert_true(part.feature_pairs * 5 < all.feature_pairs);
        assert_int_equal(part.by_signs + part.by_roots + part.by_exact, part.tests);
        set_vertices(r.detector, NULL, 0);
        again = count_step(&r, &found);
        assert_memory_equal(&again, &all, sizeof all);
        rig_destroy(&r);
    }
}

/* ---- what is refused ----------------------------------------------------------------------------------- */

TEST(moved_vertices_are_refused) {
    static double end[SCENE_VERTICES_MAX * 3];
    static uint32_t vertices[SCENE_VERTICES_MAX];
    cscd_contacts contacts;
    cscd_free_step step;
    cscd_truncation cut;
    cscd_line_search *line = NULL;
    scene_make(SCENE_NOISY_SPHERE, 5, &s);
    uint32_t count = choose_ball(0, 0.5, vertices), last = s.vertex_count - 1;
    rig r = rig_create(&s, 2, NULL);
    expect_ok(cscd_line_search_create(r.detector, &line));
    set_vertices(r.detector, vertices, count);
    s.x0[last * 3] = 0.0;
    s.x1[last * 3] = -0.0; /* the same place */
    expect_ok(step_packed(r.detector, s.x0, s.x1, &contacts));
    s.x0[last * 3] = s.x1[last * 3] = 0.5;
    char name[32];
    snprintf(name, sizeof name, "vertex %u is not active", last);
    for (int k = 0; k < 3; k++) {
        double before = s.x1[last * 3 + (uint32_t)k];
        s.x1[last * 3 + (uint32_t)k] = nextafter(s.x0[last * 3 + (uint32_t)k], 9.0);
        expect_invalid(r.context, step_packed(r.detector, s.x0, s.x1, &contacts), name);
        expect_invalid(r.context, max_step_packed(r.detector, s.x0, s.x1, end, &step), name);
        expect_invalid(r.context, truncate_packed(r.detector, s.x0, s.x1, 0.1, end, &cut), name);
        expect_invalid(r.context, line_begin_packed(line, s.x0, s.x1, 0.1), name);
        s.x1[last * 3 + (uint32_t)k] = before;
    }
    expect_ok(step_packed(r.detector, s.x0, s.x1, &contacts));
    expect_ok(max_step_packed(r.detector, s.x0, s.x1, end, &step));
    expect_ok(truncate_packed(r.detector, s.x0, s.x1, 0.1, end, &cut));
    expect_ok(line_begin_packed(line, s.x0, s.x1, 0.1));
    s.x1[last * 3] = 0.1; /* it may move once all may */
    set_vertices(r.detector, NULL, 0);
    expect_ok(step_packed(r.detector, s.x0, s.x1, &contacts));
    cscd_line_search_destroy(line);
    rig_destroy(&r);
}

/* A third has no float. */
TEST(rounding_moves_vertices) {
    static float floats[SCENE_VERTICES_MAX * 3];
    cscd_free_step step;
    const uint32_t vertex = 0;
    scene_make(SCENE_NOISY_SPHERE, 5, &s);
    for (uint32_t k = 0; k < s.vertex_count * 3; k++) s.x0[k] = s.x1[k] = (double)(float)s.x0[k];
    s.x1[0] += 0.01;
    rig r = rig_create(&s, 1, NULL);
    set_vertices(r.detector, &vertex, 1);
    const cscd_view *x0 = CSCD_DOUBLES(s.x0, s.vertex_count), *x1 = CSCD_DOUBLES(s.x1, s.vertex_count);
    const cscd_mutable_view *reached = CSCD_MUTABLE_FLOATS(floats, s.vertex_count);
    expect_ok(cscd_detector_max_step(r.detector, x0, x1, reached, &step));
    s.x0[22] = s.x1[22] = 1.0 / 3.0;
    expect_invalid(r.context, cscd_detector_max_step(r.detector, x0, x1, reached, &step),
                   "vertex 7 is not active, but would move where x0 is rounded to floats");
    expect_ok(cscd_detector_max_step(r.detector, x0, x1, NULL, &step));
    s.x0[22] = s.x1[22] = 0.25;
    s.x0[0] = s.x1[1] = 1.0 / 3.0; /* of an active one, that does no harm */
    expect_ok(cscd_detector_max_step(r.detector, x0, x1, reached, &step));
    rig_destroy(&r);
}

TEST(mistakes_are_refused) {
    cscd_contacts found;
    scene_make(SCENE_TWO_SPHERES, 3, &s);
    rig r = rig_create(&s, 1, NULL);
    const uint32_t wrong[3] = {0, 1, s.vertex_count}, none[1] = {0};
    size_t all = rig_step(&r, &s).count;
    assert_true(all > 0);
    assert_int_equal(cscd_detector_set_active(NULL, wrong, 1), CSCD_NULL_OBJECT);
    expect_invalid(r.context, cscd_detector_set_active(r.detector, NULL, 2),
                   "vertices is NULL, but there are to be 2");
    expect_invalid(r.context, cscd_detector_set_active(r.detector, wrong, 3), "vertices[2] is");
    assert_int_equal(rig_step(&r, &s).count, all); /* all are still active */
    set_vertices(r.detector, none, 0);             /* none is */
    expect_invalid(r.context, cscd_detector_set_active(r.detector, wrong, 3), "vertices[2] is");
    expect_invalid(r.context, step_packed(r.detector, s.x0, s.x1, &found), "vertex 0 is not active");
    expect_ok(step_packed(r.detector, s.x1, s.x1, &found));
    assert_int_equal(found.count, 0);
    assert_int_equal(cscd_detector_counters(r.detector).boxes_tested, 0);
    set_vertices(r.detector, NULL, 0);
    assert_int_equal(rig_step(&r, &s).count, all);
    rig_destroy(&r);
}

TEST(lines_begin_again) {
    static double end[SCENE_VERTICES_MAX * 3];
    cscd_line_search *line = NULL;
    cscd_proximities near;
    cscd_free_step step;
    const uint32_t vertices[2] = {0, 1};
    scene_make(SCENE_TWO_SPHERES, 3, &s);
    rig r = rig_create(&s, 1, NULL);
    expect_ok(cscd_line_search_create(r.detector, &line));
    for (int i = 0; i < 3; i++) {
        memcpy(s.x1 + 6, s.x0 + 6, sizeof s.x0 - 6 * sizeof *s.x0);
        expect_ok(line_begin_packed(line, s.x0, s.x1, 0.1));
        expect_ok(line_max_step_packed(line, 1.0, end, &step));
        set_vertices(r.detector, i == 1 ? NULL : vertices, i == 1 ? 0 : 2);
        expect_invalid(r.context, line_max_step_packed(line, 1.0, end, &step),
                       "the active vertices have been set since the line was begun");
        expect_invalid(r.context, cscd_line_search_find_near(line, 0.5, 0.1, CSCD_NEAR_PAIRS, &near),
                       "the active vertices have been set since the line was begun");
        expect_ok(line_positions_packed(line, 0.5, end));
    }
    cscd_line_search_destroy(line);
    rig_destroy(&r);
}

/* ---- what is known ------------------------------------------------------------------------------------- */

static bool triangle_is_active(const uint32_t *vertices, uint32_t count, uint32_t t) {
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            if (s.triangles[t * 3 + (uint32_t)k] == vertices[i]) return true;
    }
    return false;
}

static bool in_a_pair(const cscd_intersections *list, uint32_t t) {
    for (size_t i = 0; i < list->count; i++)
        if (list->items[i].a == t || list->items[i].b == t) return true;
    return false;
}

/* Its top is pushed through its bottom. */
static void make_crossing_sphere(void) {
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 12, 14);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        if (s.x0[v * 3 + 2] > 0.8) s.x0[v * 3 + 2] -= 1.93;
    }
    memcpy(s.x1, s.x0, sizeof s.x0);
}

/* What was not compared is not known, however much it crosses; a step tells that what was compared does. */
TEST(checks_leave_open_what_they_do_not_compare) {
    static uint32_t vertices[SCENE_VERTICES_MAX];
    size_t open = 0, crossing = 0, known = 0, missed = 0;
    for (int start = CSCD_START_PROVE; start <= CSCD_START_UNKNOWN; start++) {
        make_crossing_sphere();
        cscd_detector_options options = cscd_detector_defaults();
        options.method = CSCD_METHOD_SINGLE;
        options.start = (cscd_start)start;
        rig r = rig_create(&s, 1, &options);
        cscd_intersections all, found;
        cscd_contacts contacts;
        rig whole = rig_create(&s, 1, &options);
        expect_ok(check_packed(whole.detector, s.x0, &all));
        assert_true(all.count > 0);
        uint32_t count = choose_ball(s.triangles[all.items[0].a * 3], 0.45, vertices);
        if (start == CSCD_START_VOUCHED) expect_ok(step_packed(r.detector, s.x0, s.x0, &contacts));
        set_vertices(r.detector, vertices, count);
        expect_ok(check_packed(r.detector, s.x0, &found));
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            triangle_state is = start_state_of(r.detector, t);
            bool active = triangle_is_active(vertices, count, t), crosses = in_a_pair(&found, t);
            if (crosses) assert_int_equal(is, TRIANGLE_CROSSING);
            if (!active && !crosses) assert_int_equal(is, TRIANGLE_UNKNOWN);
            if (active && !crosses) assert_true(is >= TRIANGLE_FREE);
            open += is == TRIANGLE_UNKNOWN;
            crossing += is == TRIANGLE_CROSSING;
            known += is >= TRIANGLE_FREE;
            missed += is == TRIANGLE_UNKNOWN && in_a_pair(&all, t);
        }
        assert_int_equal(step_packed(r.detector, s.x0, s.x0, &contacts), CSCD_OK);
        assert_int_equal(cscd_detector_guarantee(r.detector, 0).reason, CSCD_REASON_CROSSING);
        rig_destroy(&whole);
        rig_destroy(&r);
    }
    print_message("%zu open, %zu crossing, %zu known, %zu that cross unseen\n", open, crossing, known,
                  missed);
    assert_true(open > 100 && crossing > 0 && known > 10 && missed > 0);
}

/* What the caller has vouched for ends with a check, also in another mesh, where the same body lies beside another. */
TEST(vouching_ends_in_another_mesh) {
    const uint32_t corners[3] = {0, 1, 2};
    const cscd_object_desc triangle = cscd_object_of_triangles(3, 1, corners);
    const cscd_object_change more = {.object = UINT32_MAX, .desc = &triangle};
    static uint32_t vertices[SCENE_VERTICES_MAX];
    cscd_detector_options options = cscd_detector_defaults();
    cscd_mesh_change *change = NULL;
    cscd_contacts contacts;
    cscd_intersections found;
    make_crossing_sphere();
    options.method = CSCD_METHOD_SINGLE;
    options.start = CSCD_START_VOUCHED;
    rig r = rig_create(&s, 1, &options);
    assert_int_equal(step_packed(r.detector, s.x0, s.x0, &contacts), CSCD_OK);
    assert_int_equal(cscd_mesh_change_create(r.context, r.mesh, &more, 1, &change), CSCD_OK);
    assert_int_equal(cscd_detector_change_mesh(r.detector, change), CSCD_OK);
    double *corner = s.x0 + (size_t)s.vertex_count * 3;
    for (int i = 0; i < 9; i++) corner[i] = i % 4 == 0 ? 11.0 : 10.0;
    const uint32_t count = choose_ball(0, 0.45, vertices);
    set_vertices(r.detector, vertices, count);
    for (uint32_t t = 0; t < s.triangle_count; t++)
        assert_int_equal(start_state_of(r.detector, t), TRIANGLE_CLEAN);
    assert_int_equal(check_packed(r.detector, s.x0, &found), CSCD_OK);
    for (uint32_t t = 0; t < s.triangle_count; t++)
        assert_true(triangle_is_active(vertices, count, t) || start_state_of(r.detector, t) < TRIANGLE_CLEAN);
    cscd_mesh_change_destroy(change);
    rig_destroy(&r);
}

/* The steps of a detector without a set prove no more. */
TEST(proofs_look_at_everything) {
    static uint32_t vertices[SCENE_VERTICES_MAX];
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    for (int i = 0; i < 2; i++) {
        make_crossing_sphere();
        rig whole = rig_create(&s, 1, &options), part = rig_create(&s, 1, &options);
        const double *equator = s.x0 + (size_t)s.vertex_count / 2 * 3;
        uint32_t count = choose_ball(s.vertex_count / 2, i == 0 ? 0.1 : 0.5, vertices);
        set_vertices(part.detector, vertices, count);
        s.x1[vertices[0] * 3] += 0.001 * equator[0];
        assert_int_equal(rig_step(&part, &s).count, rig_step(&whole, &s).count);
        cscd_guarantee a = cscd_detector_guarantee(part.detector, 0),
                       b = cscd_detector_guarantee(whole.detector, 0);
        assert_int_equal(a.reason, CSCD_REASON_CROSSING);
        assert_true(a.reason == b.reason && a.complete == b.complete && a.start_embedded == b.start_embedded);
        assert_int_equal(cscd_detector_counters(part.detector).clean,
                         cscd_detector_counters(whole.detector).clean);
        for (uint32_t t = 0; t < s.triangle_count; t++)
            assert_int_equal(start_state_of(part.detector, t), start_state_of(whole.detector, t));
        rig_destroy(&part);
        rig_destroy(&whole);
    }
}

/* What a seam uncovers waits, wherever the active vertices are. */
TEST(pairs_wait_without_active_vertices) {
    static const double separations[] = {0.0, 0.05};
    for (int i = 0; i < 2; i++) {
        equal_panels p;
        const uint32_t vertices[2] = {0, 1};
        equal_panels_begin(&p, separations[i], 2);
        cscd_detector_options options = cscd_detector_defaults();
        options.min_separation = separations[i];
        options.seams = p.seams[0];
        options.seam_count = EQUAL_PANEL;
        memset(&twins, 0, sizeof twins);
        active_twins_begin(&twins, p.detector, &options, false);
        twins.set = true;
        for (int k = 0; k < 2; k++) twins.active[vertices[k]] = true;
        active_twins_tell(&twins);
        expect_ok(cscd_detector_set_seams(p.detector, NULL, 0));
        expect_ok(cscd_detector_set_seams(twins.theirs, NULL, 0));
        active_twins_step(&twins, p.x0, p.x0);
        active_twins_check(&twins, p.x0);
        active_twins_near(&twins, p.x0, 0.2);
        size_t waiting = twins.waiting;
        assert_true(waiting > EQUAL_PANEL);
        twins.set = false;
        active_twins_tell(&twins);
        active_twins_step(&twins, p.x0, p.x0);
        active_twins_check(&twins, p.x0);
        assert_int_equal(twins.waiting, 2 * waiting);
        assert_int_equal(twins.contacts + twins.intersections, 0);
        active_twins_end(&twins);
        equal_panels_end(&p);
    }
}
