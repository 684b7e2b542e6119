/* Lists of pairs at their limits: two features that come together, each by nearly the skin, and when a list that was of no use
 * is made again. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A motion is so many mean lengths of edges in an interval, and the skin of its list 16 times that. */
static const double speed = 0.1 / 16.0, skin = 0.1;

/* ---- two spheres ------------------------------------------------------------------------------------------- */

/* Vertex `tip` of the second sphere is before the middle of triangle `wall` of the first one, on its normal, which is along x: so
 * boxes are as far apart as what they hold. */
typedef struct facing_spheres {
    body sphere;
    uint32_t count; /* vertices of one */
    uint32_t wall, tip;
    double edge;
    double *x0, *x1;
    cscd_context *context;
    cscd_mesh *mesh;
} facing_spheres;

static const double *vertex_of(const facing_spheres *f, uint32_t vertex) {
    return f->sphere.positions + (size_t)vertex * 3;
}

static const uint32_t *corners_of(const facing_spheres *f, uint32_t triangle) {
    return f->sphere.triangles + (size_t)triangle * 3;
}

static double mean_edge(const facing_spheres *f) {
    double sum = 0.0;
    for (uint32_t t = 0; t < f->sphere.triangle_count; t++) {
        const double *p = vertex_of(f, corners_of(f, t)[0]), *q = vertex_of(f, corners_of(f, t)[1]);
        sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                    (p[2] - q[2]) * (p[2] - q[2]));
    }
    return sum / f->sphere.triangle_count;
}

/* The middle of a triangle, which on a sphere about the origin shows where its normal does. */
static double middle_of(const facing_spheres *f, uint32_t triangle, double out[3]) {
    double squares = 0.0;
    for (size_t k = 0; k < 3; k++) {
        out[k] = 0.0;
        for (int i = 0; i < 3; i++) out[k] += vertex_of(f, corners_of(f, triangle)[i])[k] / 3.0;
        squares += out[k] * out[k];
    }
    return sqrt(squares);
}

/* The vertex and the triangle that are most nearly opposite to each other. */
static void choose_features(facing_spheres *f) {
    double most = 0.0;
    for (uint32_t t = 0; t < f->sphere.triangle_count; t++) {
        double middle[3], length = middle_of(f, t, middle);
        for (uint32_t v = 0; v < f->count; v++) {
            const double *p = vertex_of(f, v);
            double sum = -(p[0] * middle[0] + p[1] * middle[1] + p[2] * middle[2]) / length;
            if (sum <= most * (1.0 + 1e-9)) continue;
            most = sum;
            f->wall = t;
            f->tip = v;
        }
    }
}

/* Turns the sphere so that the middle of the wall is on the positive x axis. */
static void turn_sphere(facing_spheres *f) {
    double axes[3][3], length = middle_of(f, f->wall, axes[0]);
    for (int k = 0; k < 3; k++) axes[0][k] /= length;
    const double aside = sqrt(axes[0][0] * axes[0][0] + axes[0][1] * axes[0][1]);
    assert_true(aside > 0.1);
    axes[1][0] = -axes[0][1] / aside;
    axes[1][1] = axes[0][0] / aside;
    axes[1][2] = 0.0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        axes[2][k] = axes[0][i] * axes[1][j] - axes[0][j] * axes[1][i];
    }
    for (uint32_t v = 0; v < f->count; v++) {
        double *p = f->sphere.positions + (size_t)v * 3;
        const double before[3] = {p[0], p[1], p[2]};
        for (int k = 0; k < 3; k++)
            p[k] = before[0] * axes[k][0] + before[1] * axes[k][1] + before[2] * axes[k][2];
    }
}

static void spheres_begin(facing_spheres *f, double gap) {
    double middle[3];
    *f = (facing_spheres){.sphere = body_of(BODY_SPHERE, 320)};
    f->count = f->sphere.vertex_count;
    f->x0 = malloc(2 * f->count * sizeof(double[3]));
    f->x1 = malloc(2 * f->count * sizeof(double[3]));
    assert_true(f->x0 != NULL && f->x1 != NULL);
    f->edge = mean_edge(f);
    choose_features(f);
    turn_sphere(f);
    middle_of(f, f->wall, middle);
    memcpy(f->x1, f->sphere.positions, f->count * sizeof(double[3]));
    for (uint32_t v = 0; v < f->count; v++) {
        double *p = f->x1 + (f->count + (size_t)v) * 3;
        for (size_t k = 0; k < 3; k++) p[k] = vertex_of(f, v)[k] - vertex_of(f, f->tip)[k] + middle[k];
        p[0] += gap * f->edge;
    }
    const cscd_object_desc sphere =
        cscd_object_of_triangles(f->count, f->sphere.triangle_count, f->sphere.triangles);
    const cscd_object_desc both[2] = {sphere, sphere};
    assert_int_equal(cscd_context_create(NULL, &f->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(f->context, both, 2, &f->mesh), CSCD_OK);
}

static void spheres_end(facing_spheres *f) {
    cscd_mesh_destroy(f->mesh);
    cscd_context_destroy(f->context);
    free(f->x0);
    free(f->x1);
    body_free(&f->sphere);
}

static cscd_detector *make_detector(const facing_spheres *f, cscd_coherence coherence) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *d = NULL;
    options.method = CSCD_METHOD_SINGLE;
    options.coherence = coherence;
    assert_int_equal(detector_create_here(f->mesh, NULL, &options, &d), CSCD_OK);
    return d;
}

static void begin_interval(facing_spheres *f) {
    memcpy(f->x0, f->x1, 2 * f->count * sizeof(double[3]));
}

/* Moves a vertex by so many edges along the normal in the interval. */
static void move_vertex(facing_spheres *f, uint32_t vertex, double by) {
    f->x1[(size_t)vertex * 3] += by * f->edge;
}

static bool step_is_answered(const facing_spheres *f, cscd_detector *d, size_t *contacts) {
    cscd_contacts found;
    assert_int_equal(step_packed(d, f->x0, f->x1, &found), CSCD_OK);
    *contacts = found.count;
    return cscd_detector_counters(d).coherent != 0;
}

/* ---- both features move ------------------------------------------------------------------------------------ */

/* At the list's reference the tip is farther from the wall than one skin, and nearer than two. Either goes less than a skin. */
TEST(features_meet_within_two_skins) {
    facing_spheres f;
    uint32_t answered = 0;
    size_t contacts = 0, expected = 0;
    spheres_begin(&f, 1.7 * skin);
    cscd_detector *with = make_detector(&f, CSCD_COHERENCE_AUTO),
                  *without = make_detector(&f, CSCD_COHERENCE_OFF);
    for (int i = 0; i < 24 && expected == 0; i++) {
        begin_interval(&f);
        for (int k = 0; k < 3; k++) move_vertex(&f, corners_of(&f, f.wall)[k], i > 0 ? speed : 0.0);
        move_vertex(&f, f.count + f.tip, i > 0 ? -speed : 0.0);
        answered += step_is_answered(&f, with, &contacts);
        step_is_answered(&f, without, &expected);
        assert_int_equal(contacts, expected);
    }
    assert_true(answered >= 10 && expected > 0);
    cscd_detector_destroy(with);
    cscd_detector_destroy(without);
    spheres_end(&f);
}

/* ---- lists of no use --------------------------------------------------------------------------------------- */

/* A vertex jumps beyond every skin as soon as there is a list, which so serves once. The next one waits, twice as long each time,
 * up to 64 intervals. */
TEST(lists_of_no_use_wait_longer_and_longer) {
    static const uint32_t expected[] = {4, 8, 16, 32, 64, 64};
    facing_spheres f;
    double out = 1.0;
    size_t contacts;
    spheres_begin(&f, 20.0);
    cscd_detector *d = make_detector(&f, CSCD_COHERENCE_AUTO);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        uint32_t waited = 0;
        begin_interval(&f);
        while (!step_is_answered(&f, d, &contacts)) assert_true(waited++ < 100);
        if (i > 0) assert_int_equal(waited, expected[i - 1] - 1);
        move_vertex(&f, corners_of(&f, f.wall)[0], 0.5 * out);
        assert_false(step_is_answered(&f, d, &contacts));
        assert_int_equal(contacts, 0);
        out = -out;
    }
    cscd_detector_destroy(d);
    spheres_end(&f);
}
