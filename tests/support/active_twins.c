/* Two detectors of one mesh: one that has active vertices, and one that looks at everything and leaves out, by its function
 * `ignore`, what has none of them. All that they say is the same, bit for bit. */
#include "tests/support/active_twins.h"

#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* ---- which pairs count --------------------------------------------------------------------------------- */

static bool vertex_counts(const active_twins *t, uint32_t vertex) {
    return !t->set || t->active[vertex];
}

static bool edge_counts(const active_twins *t, uint32_t edge) {
    uint32_t ends[2];
    cscd_mesh_edge(t->mesh, edge, ends);
    return vertex_counts(t, ends[0]) || vertex_counts(t, ends[1]);
}

static bool face_counts(const active_twins *t, uint32_t face) {
    uint32_t corners[3];
    cscd_mesh_triangle(t->mesh, face, corners);
    return vertex_counts(t, corners[0]) || vertex_counts(t, corners[1]) || vertex_counts(t, corners[2]);
}

bool active_twins_look_at(const active_twins *t, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    switch (kind) {
    case CSCD_CONTACT_VF:
        return vertex_counts(t, a) || face_counts(t, b);
    case CSCD_CONTACT_EE:
        return edge_counts(t, a) || edge_counts(t, b);
    case CSCD_CONTACT_TT:
        return face_counts(t, a) || face_counts(t, b);
    case CSCD_CONTACT_EV:
        return edge_counts(t, a) || vertex_counts(t, b);
    case CSCD_CONTACT_VH:
        return vertex_counts(t, a) || vertex_counts(t, cscd_mesh_object(t->mesh, b).first_vertex);
    default:
        return vertex_counts(t, a) || vertex_counts(t, b);
    }
}

bool active_twins_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    active_twins *t = user;
    bool left_out = !active_twins_look_at(t, kind, a, b);
    t->left_out += left_out;
    return left_out;
}

/* ---- the two ------------------------------------------------------------------------------------------- */

void active_twins_join(active_twins *t, cscd_detector *ours, cscd_detector *theirs) {
    t->ours = ours;
    t->theirs = theirs;
    t->mesh = cscd_detector_mesh(ours);
    t->vertex_count = cscd_mesh_vertex_count(t->mesh);
    assert_true(t->vertex_count <= TWIN_VERTICES_MAX);
}

void active_twins_begin(active_twins *t, cscd_detector *ours, const cscd_detector_options *options,
                        bool brute_force) {
    cscd_detector_options chosen = *options;
    cscd_detector *theirs = NULL;
    chosen.method = brute_force ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE;
    chosen.mode = CSCD_MODE_ALL;
    chosen.ignore = active_twins_ignore;
    chosen.ignore_user = t;
    expect_ok(detector_create_here(cscd_detector_mesh(ours), NULL, &chosen, &theirs));
    t->set = false;
    active_twins_join(t, ours, theirs);
}

void active_twins_end(active_twins *t) {
    cscd_detector_destroy(t->theirs);
}

static double distance_between(const double *a, const double *b) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

void active_twins_choose(active_twins *t, const double *x, random_stream *random) {
    uint32_t kind = stream_below(random, 10), centre = stream_below(random, t->vertex_count);
    uint32_t far = stream_below(random, t->vertex_count);
    double radius = stream_between(random, 0.0, 0.8) * distance_between(x + centre * 3, x + far * 3);
    uint32_t share = 1 + stream_below(random, 20), object = cscd_mesh_vertex_object(t->mesh, centre);
    t->set = kind > 0;
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        bool near = distance_between(x + v * 3, x + centre * 3) <= radius;
        t->active[v] = kind < 6 ? near : kind < 8 ? stream_below(random, share) == 0 : kind == 8;
        if (kind == 7 && stream_below(random, 2) == 0)
            t->active[v] = cscd_mesh_vertex_object(t->mesh, v) == object;
    }
    active_twins_tell(t);
}

void active_twins_tell(active_twins *t) {
    static uint32_t list[TWIN_VERTICES_MAX + 1];
    size_t count = 0;
    for (uint32_t v = t->vertex_count; v-- > 0;) {
        list[count] = v;
        count += t->active[v];
    }
    if (count > 0) list[count++] = list[0];
    expect_ok(cscd_detector_set_active(t->ours, t->set ? list : NULL, t->set ? count : 0));
}

void active_twins_hold(const active_twins *t, const double *x0, double *x1) {
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        if (!vertex_counts(t, v)) memcpy(x1 + v * 3, x0 + v * 3, sizeof(double[3]));
    }
}

/* ---- what they say ------------------------------------------------------------------------------------- */

static void expect_same(const void *a, const void *b, size_t a_count, size_t b_count, size_t size) {
    assert_int_equal(a_count, b_count);
    if (a_count > 0) assert_memory_equal(a, b, a_count * size);
}

static cscd_waiting expect_same_waiting(const active_twins *t) {
    const cscd_waiting ours = cscd_detector_waiting(t->ours), theirs = cscd_detector_waiting(t->theirs);
    assert_int_equal(ours.features, theirs.features);
    assert_int_equal(ours.triangles, theirs.triangles);
    return ours;
}

void active_twins_step(active_twins *t, const double *x0, const double *x1) {
    cscd_contacts a, b;
    expect_ok(step_packed(t->ours, x0, x1, &a));
    expect_ok(step_packed(t->theirs, x0, x1, &b));
    expect_same(a.items, b.items, a.count, b.count, sizeof *a.items);
    t->contacts += a.count;
    t->waiting += expect_same_waiting(t).features;
}

void active_twins_check(active_twins *t, const double *x) {
    cscd_intersections a, b;
    expect_ok(check_packed(t->ours, x, &a));
    expect_ok(check_packed(t->theirs, x, &b));
    expect_same(a.items, b.items, a.count, b.count, sizeof *a.items);
    assert_int_equal(a.zero_area_triangles, b.zero_area_triangles);
    assert_int_equal(a.first_zero_area, b.first_zero_area);
    expect_same_waiting(t);
    t->intersections += a.count;
}

void active_twins_near(active_twins *t, const double *x, double distance) {
    cscd_proximities a, b;
    expect_ok(find_near_packed(t->ours, x, distance, &a));
    expect_ok(find_near_packed(t->theirs, x, distance, &b));
    expect_same(a.items, b.items, a.count, b.count, sizeof *a.items);
    expect_same_waiting(t);
    t->near += a.count;
    expect_ok(find_unique_packed(t->ours, x, distance, &a));
    expect_ok(find_unique_packed(t->theirs, x, distance, &b));
    expect_same(a.items, b.items, a.count, b.count, sizeof *a.items);
}

/* Of several first contacts modes may find other ones. */
static void expect_same_step(const cscd_free_step *a, const cscd_free_step *b) {
    assert_true(a->fraction == b->fraction);
    assert_int_equal(a->limited, b->limited);
    assert_int_equal(a->moved, b->moved);
    if (a->limited) assert_true(a->limit.toi == b->limit.toi);
}

void active_twins_max_step(active_twins *t, const double *x0, double *x1) {
    static double ends[2][TWIN_VERTICES_MAX * 3];
    cscd_free_step a = {.fraction = -1.0}, b = {.fraction = -1.0};
    cscd_status status = max_step_packed(t->ours, x0, x1, ends[0], &a);
    assert_int_equal(max_step_packed(t->theirs, x0, x1, ends[1], &b), status);
    assert_true(status == CSCD_OK || status == CSCD_IN_CONTACT);
    expect_same_step(&a, &b);
    expect_same_waiting(t);
    if (status == CSCD_OK) assert_memory_equal(ends[0], ends[1], t->vertex_count * sizeof(double[3]));
    memcpy(x1, status == CSCD_OK ? ends[0] : x0, t->vertex_count * sizeof(double[3]));
    t->limited += a.limited;
}

void active_twins_bounds(active_twins *t, const double *x0, double radius) {
    static double bounds[2][TWIN_VERTICES_MAX];
    cscd_displacement_bounds a, b;
    expect_ok(displacement_bounds_packed(t->ours, x0, radius, bounds[0], &a));
    expect_ok(displacement_bounds_packed(t->theirs, x0, radius, bounds[1], &b));
    assert_memory_equal(bounds[0], bounds[1], t->vertex_count * sizeof(double));
    expect_same(a.blocked, b.blocked, a.blocked_count, b.blocked_count, sizeof *a.blocked);
    assert_int_equal(a.near_count, b.near_count);
    assert_true(a.least == b.least);
    assert_int_equal(a.vertex, b.vertex);
    t->blocked += a.near_count;
}

void active_twins_truncate(active_twins *t, const double *x0, double *x1, double radius) {
    static double ends[2][TWIN_VERTICES_MAX * 3];
    cscd_truncation a, b;
    expect_ok(truncate_packed(t->ours, x0, x1, radius, ends[0], &a));
    expect_ok(truncate_packed(t->theirs, x0, x1, radius, ends[1], &b));
    assert_memory_equal(ends[0], ends[1], t->vertex_count * sizeof(double[3]));
    expect_same(a.held, b.held, a.held_count, b.held_count, sizeof *a.held);
    assert_int_equal(a.near_count, b.near_count);
    assert_true(a.fraction == b.fraction && a.obstacle_fraction == b.obstacle_fraction);
    memcpy(x1, ends[0], t->vertex_count * sizeof(double[3]));
    t->held += a.near_count;
}

static void compare_on_lines(active_twins *t, cscd_line_search *lines[2], double reach, const double *x0,
                             double *reached) {
    static double ends[2][TWIN_VERTICES_MAX * 3];
    cscd_free_step steps[2];
    cscd_status status[2];
    assert_true(cscd_line_search_candidate_count(lines[0]) <= cscd_line_search_candidate_count(lines[1]));
    for (int i = 0; i < 2; i++) status[i] = line_max_step_packed(lines[i], 0.75, ends[i], &steps[i]);
    assert_int_equal(status[0], status[1]);
    assert_true(status[0] == CSCD_OK || status[0] == CSCD_IN_CONTACT);
    expect_same_step(&steps[0], &steps[1]);
    expect_same_waiting(t);
    if (status[0] == CSCD_OK) assert_memory_equal(ends[0], ends[1], t->vertex_count * sizeof(double[3]));
    memcpy(reached, status[0] == CSCD_OK ? ends[0] : x0, t->vertex_count * sizeof(double[3]));
    for (int f = 0; f < 4; f++) {
        cscd_near_form form = f % 2 == 0 ? CSCD_NEAR_PAIRS : CSCD_NEAR_UNIQUE;
        cscd_proximities near[2];
        for (int i = 0; i < 2; i++)
            expect_ok(cscd_line_search_find_near(lines[i], 0.3 * f, reach, form, &near[i]));
        expect_same(near[0].items, near[1].items, near[0].count, near[1].count, sizeof *near[0].items);
        t->near += near[0].count;
    }
}

void active_twins_line(active_twins *t, const double *x0, double *x1, double reach) {
    cscd_line_search *lines[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        cscd_detector *d = i == 0 ? t->ours : t->theirs;
        expect_ok(cscd_line_search_create(d, &lines[i]));
        expect_ok(line_begin_packed(lines[i], x0, x1, reach));
    }
    compare_on_lines(t, lines, reach, x0, x1);
    for (int i = 0; i < 2; i++) cscd_line_search_destroy(lines[i]);
}
