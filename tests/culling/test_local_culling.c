/* Culling clean triangles of meshes that move into themselves over many intervals: every list equals that
 * of the method that culls nothing, no feature pair is tested twice, and every triangle that is called
 * clean is clean. */
#include "cscd/cscd.h"
#include "runtime/detector/detector.h"
#include "src/mesh/predicates.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef SLOW_MACHINE
enum { SEQUENCES = 12, EXACT_PERCENT = 85 }; /* out of so few sequences */
#else
enum { SEQUENCES = 60, EXACT_PERCENT = 90 };
#endif

enum { FRAMES = 14, SMALL = 120, REGIONS_MAX = 5 };

static sequence q; /* large; one test at a time */

/* ---- one mesh, several detectors --------------------------------------------------------------------- */

typedef struct local_tally {
    uint64_t intervals, with_contact, partly_clean, all_clean, closing_passes, contacts, tests, tests_without;
    uint64_t windings;       /* clean triangles whose winding number was compared */
    uint64_t small, exactly; /* intervals whose tests were counted, and whose bounds were equal */
} local_tally;

enum { ALL_SINGLE, ALL_SCATTERED, ALL_PLANNED, UNKNOWN_SINGLE, EARLIEST_SCATTERED, CULLING_COUNT };

typedef struct ways {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *none;
    cscd_plan *scattered, *planned;
    cscd_detector *culling[CULLING_COUNT];
} ways;

/* Places a point where detector points are bad: on the surface, at a vertex, or far away. */
static void place_point(random_stream *random, double out[3]) {
    uint32_t v = stream_below(random, q.shape.vertex_count), w = stream_below(random, q.shape.vertex_count);
    double share = stream_below(random, 3) * 0.5, spread = stream_below(random, 2) * 4.0;
    for (uint32_t k = 0; k < 3; k++)
        out[k] = (1.0 - share) * q.shape.x0[v * 3 + k] + share * q.shape.x0[w * 3 + k] +
                 stream_between(random, -spread, spread);
}

/* Makes regions of a few triangles here and there, each within one component. */
static cscd_plan *scatter_regions(const cscd_mesh *mesh, random_stream *random) {
    static uint32_t regions[SCENE_TRIANGLES_MAX], numbers[REGIONS_MAX * 8];
    static double points[REGIONS_MAX * 8][3];
    uint32_t per_component = 1 + stream_below(random, REGIONS_MAX), count = 0;
    memset(numbers, 0, sizeof numbers);
    assert_true(cscd_mesh_component_count(mesh) <= 8);
    for (uint32_t t = 0; t < q.shape.triangle_count; t++) {
        uint32_t blocks = stream_below(random, 3) == 0 ? stream_below(random, per_component)
                                                       : t * per_component / q.shape.triangle_count;
        uint32_t *number = &numbers[cscd_mesh_triangle_component(mesh, t) * REGIONS_MAX + blocks];
        if (*number == 0) {
            place_point(random, points[count]);
            *number = ++count;
        }
        regions[t] = *number - 1;
    }
    cscd_plan_parts parts = {CSCD_METHOD_KMEANS, count, regions, points[0], NULL, NULL, NULL};
    cscd_plan *plan = NULL;
    assert_int_equal(plan_from_parts_packed(mesh, q.shape.x0, &parts, &plan), CSCD_OK);
    return plan;
}

static cscd_detector *culling_detector(const ways *w, int way) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    const cscd_plan *plan = NULL;
    options.mode = way == EARLIEST_SCATTERED ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL;
    options.start = way == UNKNOWN_SINGLE ? CSCD_START_UNKNOWN : CSCD_START_PROVE;
    options.coherence = CSCD_COHERENCE_OFF; /* so that tests can be counted */
    if (way == ALL_SCATTERED || way == EARLIEST_SCATTERED) plan = w->scattered;
    if (way == ALL_PLANNED) plan = w->planned;
    if (plan == NULL) options.method = CSCD_METHOD_SINGLE;
    assert_int_equal(detector_create_here(w->mesh, plan, &options, &detector), CSCD_OK);
    if (way != ALL_SINGLE) detector->known.starts.share_worth_it = 0.0; /* however few triangles are clean */
    return detector;
}

static ways ways_create(uint64_t seed) {
    ways w = {.context = NULL};
    random_stream random = stream_start(seed ^ 0x5eed);
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 1 + (uint32_t)(seed % 3);
    cscd_object_desc desc =
        cscd_object_of_triangles(q.shape.vertex_count, q.shape.triangle_count, q.shape.triangles);
    cscd_plan_options plan_options = cscd_plan_defaults();
    plan_options.method = seed % 2 == 0 ? CSCD_METHOD_CHARGE : CSCD_METHOD_KMEANS;
    plan_options.k = 3;
    assert_int_equal(cscd_context_create(&options, &w.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(w.context, &desc, 1, &w.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(w.mesh, NULL, NULL, &w.none), CSCD_OK);
    w.scattered = scatter_regions(w.mesh, &random);
    assert_int_equal(plan_create_packed(w.mesh, q.shape.x0, &plan_options, &w.planned), CSCD_OK);
    for (int i = 0; i < CULLING_COUNT; i++) w.culling[i] = culling_detector(&w, i);
    return w;
}

static void ways_destroy(ways *w) {
    for (int i = 0; i < CULLING_COUNT; i++) cscd_detector_destroy(w->culling[i]);
    cscd_plan_destroy(w->planned);
    cscd_plan_destroy(w->scattered);
    cscd_detector_destroy(w->none);
    cscd_mesh_destroy(w->mesh);
    cscd_context_destroy(w->context);
}

/* ---- contacts ---------------------------------------------------------------------------------------- */

static uint32_t component_of(const ways *w, const cscd_contact *c) {
    const cscd_mesh *m = w->mesh;
    bool vf = c->kind == CSCD_CONTACT_VF;
    uint32_t a =
        vf ? m->vertex_stars[m->vertex_star_offsets[c->a]] : m->edge_stars[m->edge_star_offsets[c->a]];
    uint32_t b = vf ? c->b : m->edge_stars[m->edge_star_offsets[c->b]];
    return m->triangle_components[a] == m->triangle_components[b] ? m->triangle_components[a] : UINT32_MAX;
}

/* Checks that the list is a part of the truth in its order, and that every missing contact is of a
 * component that was not to be complete, and not the first of it. */
static void check_contacts(const ways *w, const cscd_detector *detector, const cscd_contacts *found,
                           const cscd_contacts *truth) {
    bool seen[8] = {false};
    double first[8] = {0};
    size_t next = 0;
    for (size_t i = 0; i < truth->count; i++) {
        uint32_t c = component_of(w, &truth->items[i]);
        bool present =
            next < found->count && memcmp(&found->items[next], &truth->items[i], sizeof *found->items) == 0;
        next += present;
        if (!present) assert_true(c != UINT32_MAX && !cscd_detector_guarantee(detector, c).complete);
        if (c == UINT32_MAX) continue;
        assert_true(c < 8);
        if (seen[c]) continue;
        if (first[c] == 0.0) first[c] = truth->items[i].toi + 1.0;
        seen[c] = present;
        assert_true(truth->items[i].toi + 1.0 <= first[c] + 1e-9);
    }
    assert_int_equal(next, found->count);
}

/* ---- tests and clean triangles ------------------------------------------------------------------------- */

static bool any_kept(const culling *c, const uint32_t *a, uint32_t a_count, const uint32_t *b,
                     uint32_t b_count) {
    for (uint32_t i = 0; i < a_count; i++) {
        for (uint32_t j = 0; j < b_count; j++) {
            if (culling_keeps(c, a[i], b[j])) return true;
        }
    }
    return false;
}

/* How many tests there may be. The least number is of feature pairs without a common vertex that some kept
 * triangle pair contains and that no axis separates. The largest number adds those that are separated by
 * no more than rounding, and those that only adjacent triangles contain and that no coordinate axis
 * separates. */
typedef struct test_range {
    uint64_t least, most;
} test_range;

/* The triangles around a feature. */
typedef struct star {
    const uint32_t *triangles;
    uint32_t count;
} star;

static bool all_adjacent(const cscd_mesh *m, star a, star b) {
    for (uint32_t i = 0; i < a.count * b.count; i++) {
        const uint32_t *s = m->triangles[a.triangles[i / b.count]],
                       *t = m->triangles[b.triangles[i % b.count]];
        if (!triangles_share_vertex(s, t)) return false;
    }
    return true;
}

static void count_pair(const cscd_detector *d, gap_motion m, long double rounding, point_set a, star of_a,
                       point_set b, star of_b, test_range *range) {
    if (!any_kept(&d->interval.culling, of_a.triangles, of_a.count, of_b.triangles, of_b.count)) return;
    long double gap = direction_gap(m, a, b, rounding);
    bool near =
        gap <= rounding || (axis_gap(m, a, b, rounding) <= rounding && all_adjacent(d->mesh, of_a, of_b));
    range->least += gap <= 0.0;
    range->most += near;
}

static star star_of_edge(const cscd_mesh *m, uint32_t edge) {
    return (star){m->edge_stars + m->edge_star_offsets[edge], edge_star_size(m, edge)};
}

static test_range expected_tests(const cscd_detector *d, gap_motion moved) {
    const cscd_mesh *m = d->mesh;
    test_range range = {0, 0};
    long double rounding = 0x1p-14L * motion_extent(moved, m->vertex_count);
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            uint32_t begin = m->vertex_star_offsets[v], end = m->vertex_star_offsets[v + 1];
            if (triangle_contains(m->triangles[t], v)) continue;
            count_pair(d, moved, rounding, (point_set){&v, 1}, (star){m->vertex_stars + begin, end - begin},
                       (point_set){m->triangles[t], 3}, (star){&t, 1}, &range);
        }
    }
    for (uint32_t a = 0; a < m->edge_count; a++) {
        for (uint32_t b = a + 1; b < m->edge_count; b++) {
            if (edges_share_vertex(m->edges[a], m->edges[b])) continue;
            count_pair(d, moved, rounding, (point_set){m->edges[a], 2}, star_of_edge(m, a),
                       (point_set){m->edges[b], 2}, star_of_edge(m, b), &range);
        }
    }
    return range;
}

/* Returns half the solid angle of a triangle from p, by van Oosterom and Strackee. */
static double half_angle(const uint32_t *t, const double *x, const double p[3]) {
    double r[3][3], length[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) r[i][k] = x[(size_t)t[i] * 3 + (size_t)k] - p[k];
        length[i] = sqrt(r[i][0] * r[i][0] + r[i][1] * r[i][1] + r[i][2] * r[i][2]);
    }
    double det = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                 r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                 r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    double dots[3];
    for (int i = 0; i < 3; i++) {
        const double *a = r[i], *b = r[(i + 1) % 3];
        dots[i] = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * length[(i + 2) % 3];
    }
    return atan2(det, length[0] * length[1] * length[2] + dots[0] + dots[1] + dots[2]);
}

/* Returns the component's winding number just outside the middle of its triangle t. */
static double winding_number(const cscd_mesh *m, const double *x, uint32_t t) {
    const double *a = x + (size_t)m->triangles[t][0] * 3, *b = x + (size_t)m->triangles[t][1] * 3,
                 *c = x + (size_t)m->triangles[t][2] * 3;
    double u[3], v[3], p[3], sum = 0.0;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) p[k] = (a[k] + b[k] + c[k]) / 3.0 + 1e-7 * n[k] / size;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        if (m->triangle_components[i] == m->triangle_components[t]) sum += half_angle(m->triangles[i], x, p);
    }
    return sum / (2.0 * 3.14159265358979323846);
}

/* Checks that no triangle intersects a clean one at x, and that clean triangles have one winding number
 * per component. */
static void check_clean(const cscd_detector *d, const double *x, uint64_t *windings) {
    const cscd_mesh *m = d->mesh;
    double common[8];
    assert_true(m->component_count <= 8);
    for (int c = 0; c < 8; c++) common[c] = NAN;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        uint32_t component = m->triangle_components[t];
        if (d->known.starts.triangles[t] < TRIANGLE_FREE) continue;
        const uint32_t *corners = m->triangles[t];
        assert_false(
            collinear(x + (size_t)corners[0] * 3, x + (size_t)corners[1] * 3, x + (size_t)corners[2] * 3));
        for (uint32_t o = 0; o < m->triangle_count; o++) {
            if (o != t && m->triangle_components[o] == component)
                assert_false(triangles_intersect(corners, m->triangles[o], x));
        }
        if (d->known.starts.triangles[t] < TRIANGLE_CLEAN) continue;
        double number = winding_number(m, x, t);
        if (fabs(number - round(number)) > 0.1) continue; /* another sheet is too near */
        if (isnan(common[component])) common[component] = round(number);
        assert_true(round(number) == common[component]);
        ++*windings;
    }
}

/* ---- sequences --------------------------------------------------------------------------------------- */

static void check_interval(ways *w, const double *start, const double *end, local_tally *sum) {
    cscd_contacts truth, found;
    assert_int_equal(step_packed(w->none, start, end, &truth), CSCD_OK);
    for (int i = 0; i < CULLING_COUNT; i++) {
        cscd_detector *d = w->culling[i];
        assert_int_equal(step_packed(d, start, end, &found), CSCD_OK);
        expect_one_number(d, "a walk");
        check_contacts(w, d, &found, &truth);
        if (i != EARLIEST_SCATTERED) assert_int_equal(found.count, truth.count);
        cscd_counters n = cscd_detector_counters(d);
        if (q.shape.triangle_count <= SMALL) {
            sum->small++;
            test_range range = expected_tests(d, (gap_motion){start, end});
            assert_in_range(n.tests, range.least, range.most);
            sum->exactly += range.least == range.most;
            check_clean(d, end, &sum->windings);
        }
        sum->intervals++;
        sum->with_contact += truth.count > 0;
        sum->all_clean += n.clean == q.shape.triangle_count;
        sum->partly_clean += n.clean > 0 && n.clean < q.shape.triangle_count;
        sum->closing_passes += n.passes;
        sum->contacts += truth.count;
        sum->tests += n.tests;
        sum->tests_without += cscd_detector_counters(w->none).tests;
    }
}

static void check_sequence(uint64_t seed, local_tally *sum) {
    random_stream random = stream_start(seed);
    ways w = ways_create(seed);
    for (uint32_t f = 0; f + 1 < q.frame_count; f++) {
        cscd_intersections crossing;
        if (stream_below(&random, 4) == 0)
            assert_int_equal(check_packed(w.culling[UNKNOWN_SINGLE], q.frames[f], &crossing), CSCD_OK);
        /* a solver takes a step back now and then */
        uint32_t from = f > 0 && stream_below(&random, 10) == 0 ? f - 1 : f;
        check_interval(&w, q.frames[from], q.frames[f + 1], sum);
    }
    ways_destroy(&w);
}

static void print_tally(const char *name, const local_tally *t) {
    print_message(
        "  %-6s %6llu intervals, %5.1f %% with contact, clean at the start: all in %4.1f %%, some in %4.1f "
        "%%; %llu closing passes, %llu contacts; tests %5.1f %%\n",
        name, (unsigned long long)t->intervals, 100.0 * (double)t->with_contact / (double)t->intervals,
        100.0 * (double)t->all_clean / (double)t->intervals,
        100.0 * (double)t->partly_clean / (double)t->intervals, (unsigned long long)t->closing_passes,
        (unsigned long long)t->contacts, 100.0 * (double)t->tests / (double)t->tests_without);
}

/* Longer runs by hand choose other sequences by the variables LOCAL_SEQUENCES and LOCAL_FIRST. */
static void run_kind(sequence_kind kind, const char *name, local_tally *sum) {
    const char *count = getenv("LOCAL_SEQUENCES"), *first = getenv("LOCAL_FIRST");
    uint64_t sequences = count != NULL ? strtoull(count, NULL, 10) : SEQUENCES;
    uint64_t begin = first != NULL ? strtoull(first, NULL, 10) : 0;
    for (uint64_t seed = begin; seed < begin + sequences; seed++) {
        sequence_make(kind, seed, FRAMES, &q);
        check_sequence(seed, sum);
    }
    print_tally(name, sum);
    print_message("  tests counted in %llu intervals, to one in %llu; %llu winding numbers\n",
                  (unsigned long long)sum->small, (unsigned long long)sum->exactly,
                  (unsigned long long)sum->windings);
    assert_true(sum->exactly * 100 > sum->small * EXACT_PERCENT && sum->windings > sum->small);
}

TEST(scenes_equal_no_culling) {
    local_tally sum = {0};
    run_kind(SEQUENCE_SCENE, "scenes", &sum);
    assert_true(sum.partly_clean * 5 > sum.intervals && sum.closing_passes > 0 && sum.all_clean > 0);
}

TEST(grids_equal_no_culling) {
    local_tally sum = {0};
    run_kind(SEQUENCE_GRID, "grids", &sum);
    assert_true(sum.partly_clean * 5 > sum.intervals && sum.closing_passes > 0 && sum.all_clean > 0);
}
