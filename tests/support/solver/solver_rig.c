/* What tests of calls for solvers share: brute force about certified steps, lists of proximities with their
 * energies, and truncations. */
#include "tests/support/solver/solver_rig.h"

#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "src/core/vec3.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Times are early by less than this, each by a different amount. */
static const double early = 1e-9;

static const double untouched = -4711.0;

void free_step_prepare(const double *x0, const double *x1, double longest, double step_factor,
                       free_step_call *call) {
    call->x0 = x0;
    call->x1 = x1;
    call->longest = longest;
    call->step_factor = step_factor;
    call->step = (cscd_free_step){.fraction = untouched};
    for (size_t i = 0; i < sizeof call->end / sizeof *call->end; i++) call->end[i] = untouched;
}

rig free_step_reference(const scene *s, const cscd_detector_options *options) {
    cscd_detector_options brute = *options;
    brute.method = CSCD_METHOD_BRUTE;
    brute.ours = 0;
    return rig_create(s, 1, &brute);
}

static size_t coordinates_of(const rig *r) {
    return (size_t)cscd_mesh_vertex_count(r->mesh) * 3;
}

void free_step_positions(const rig *r, const double *x0, const double *x1, double length, double *out) {
    for (size_t i = 0; i < coordinates_of(r); i++) {
        double x = x0[i] + length * (x1[i] - x0[i]);
        out[i] = length == 1.0 ? x1[i] : length == 0.0 ? x0[i] : fabs(x) < 0x1p-300 ? 0.0 : x;
    }
}

static cscd_contacts contacts_between(const rig *reference, const double *x0, const double *x1) {
    cscd_contacts found;
    expect_ok(step_packed(reference->detector, x0, x1, &found));
    return found;
}

bool free_step_embedded(const rig *reference, const double *positions) {
    cscd_intersections found;
    expect_ok(check_packed(reference->detector, positions, &found));
    return found.count == 0 && found.zero_area_triangles == 0;
}

static void set_distance(const rig *reference, double distance) {
    expect_ok(cscd_detector_set_separation(reference->detector, distance, 0.0));
}

static bool same_pair(const cscd_contact *c, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return c->kind == kind && c->a == a && c->b == b;
}

/* Checks that the limit names a pair that touches. */
static void check_refused(const rig *reference, const cscd_context *called, const free_step_call *call) {
    cscd_contacts touching = contacts_between(reference, call->x0, call->x0);
    const cscd_contact *limit = &call->step.limit;
    bool listed = false;
    assert_int_equal(call->status, CSCD_IN_CONTACT);
    assert_true(call->step.fraction == 0.0 && call->step.limited && limit->toi == 0.0);
    for (size_t i = 0; i < touching.count; i++)
        listed |= same_pair(&touching.items[i], limit->kind, limit->a, limit->b);
    assert_true(listed);
    for (size_t i = 0; i < coordinates_of(reference); i++) assert_true(call->end[i] == untouched);
    assert_non_null(strstr(cscd_context_detail(called), "touch at the start"));
}

/* Checks that the limit is a first contact of the requested motion, on the scale of the line. */
static void check_limit(const free_step_call *call, cscd_contacts truth) {
    const cscd_contact *limit = &call->step.limit;
    bool listed = false;
    assert_true(limit->toi <= (truth.items[0].toi + early) * call->longest);
    for (size_t i = 0; i < truth.count; i++) {
        const cscd_contact *t = &truth.items[i];
        bool same = same_pair(t, limit->kind, limit->a, limit->b);
        listed |= same && t->toi * call->longest == limit->toi && t->u == limit->u && t->v == limit->v;
    }
    assert_true(listed);
    if (limit->toi > early) assert_true(call->step.fraction <= call->step_factor * limit->toi);
}

/* Without min_separation: the step ends before the first contact. */
static void check_touching(const rig *reference, const free_step_call *call) {
    static double end[SCENE_VERTICES_MAX * 3];
    free_step_positions(reference, call->x0, call->x1, call->longest, end);
    cscd_contacts truth = contacts_between(reference, call->x0, end);
    assert_int_equal(call->step.limited, truth.count > 0);
    if (truth.count > 0) check_limit(call, truth);
}

/* ---- floors ------------------------------------------------------------------------------------------------ */

/* Of distances: what the tolerance, rounding and a rung of the ladder make of them. */
static const double a_little = 1e-5, rung = 0.9;

/* Pairs this much nearer than coordinates are long may have floors of 0. */
static const double finest = 1e-9;

/* A copy, sorted by (kind, a, b), of the pairs within a distance. */
typedef struct near_pairs {
    cscd_proximity *items;
    size_t count;
} near_pairs;

static near_pairs pairs_near(const rig *reference, const double *x, double distance) {
    cscd_proximities found;
    expect_ok(find_near_packed(reference->detector, x, distance, &found));
    near_pairs copy = {malloc((found.count + 1) * sizeof *copy.items), found.count};
    assert_non_null(copy.items);
    if (found.count > 0) memcpy(copy.items, found.items, found.count * sizeof *copy.items);
    return copy;
}

static int compare_pairs(const void *left, const void *right) {
    const cscd_proximity *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static const cscd_proximity *find_pair(const near_pairs *pairs, cscd_contact_kind kind, uint32_t a,
                                       uint32_t b) {
    const cscd_proximity wanted = {.kind = kind, .a = a, .b = b};
    return bsearch(&wanted, pairs->items, pairs->count, sizeof wanted, compare_pairs);
}

/* Whatever starts above the distance stays there, and whatever starts below it loses no more than a rung. */
static void check_pairs_at_end(const rig *reference, const free_step_call *call, const near_pairs *before,
                               double distance) {
    near_pairs after = pairs_near(reference, call->end, distance);
    for (size_t i = 0; i < after.count; i++) {
        const cscd_proximity *p = &after.items[i], *was = find_pair(before, p->kind, p->a, p->b);
        if (p->distance > distance * (1.0 - a_little)) continue;
        assert_non_null(was);
        double floor = rung * fmin(distance, was->distance) * (1.0 - a_little);
        double point[3];
        cscd_proximity_point(p, call->end, point);
        if (floor > finest * vec3_largest(point)) assert_true(p->distance > floor);
    }
    free(after.items);
}

static void check_limit_above_floors(const rig *reference, const free_step_call *call,
                                     const near_pairs *before, double distance) {
    static double end[SCENE_VERTICES_MAX * 3];
    const cscd_contact *limit = &call->step.limit;
    free_step_positions(reference, call->x0, call->x1, call->longest, end);
    set_distance(reference, distance * (1.0 + a_little));
    cscd_contacts truth = contacts_between(reference, call->x0, end);
    bool listed = find_pair(before, limit->kind, limit->a, limit->b) != NULL;
    for (size_t i = 0; i < truth.count; i++)
        listed |= same_pair(&truth.items[i], limit->kind, limit->a, limit->b);
    if (call->step.limited) assert_true(listed);
    if (call->step.limited && limit->toi > early)
        assert_true(call->step.fraction <= call->step_factor * limit->toi);
}

static void check_floors(const rig *reference, const free_step_call *call, double distance) {
    near_pairs before = pairs_near(reference, call->x0, distance * (1.0 + a_little));
    set_distance(reference, distance * (1.0 - a_little));
    cscd_contacts truth = contacts_between(reference, call->x0, call->end);
    for (size_t i = 0; i < truth.count; i++)
        assert_non_null(find_pair(&before, truth.items[i].kind, truth.items[i].a, truth.items[i].b));
    check_pairs_at_end(reference, call, &before, distance);
    check_limit_above_floors(reference, call, &before, distance);
    free(before.items);
}

static void check_free(const rig *reference, const free_step_call *call, double distance) {
    static double end[SCENE_VERTICES_MAX * 3];
    expect_ok(call->status);
    assert_true(call->step.fraction > 0.0 && call->step.fraction <= call->longest);
    assert_int_equal(call->step.limited, call->step.fraction < call->longest);
    free_step_positions(reference, call->x0, call->x1, call->step.fraction, end);
    assert_memory_equal(end, call->end, coordinates_of(reference) * sizeof(double));
    assert_int_equal(contacts_between(reference, call->x0, call->end).count, 0);
    if (distance == 0.0)
        check_touching(reference, call);
    else
        check_floors(reference, call, distance);
}

bool free_step_check(const rig *reference, const cscd_context *called, const free_step_call *call) {
    double distance = reference->detector->config.options.min_separation;
    double tolerance = reference->detector->config.options.tolerance;
    set_distance(reference, 0.0);
    bool refused = contacts_between(reference, call->x0, call->x0).count > 0;
    if (refused)
        check_refused(reference, called, call);
    else
        check_free(reference, call, distance);
    expect_ok(cscd_detector_set_separation(reference->detector, distance, tolerance));
    return !refused;
}

/* ---- proximities and truncations ----------------------------------------------------------------------- */

rig near_rig(const scene *s, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    return rig_create(s, threads, &options);
}

void set_rest(const rig *r, const double *rest) {
    expect_ok(set_rest_packed(r->detector, rest));
}

item_list find_items(const rig *r, const double *x, double distance, cscd_near_form form) {
    cscd_proximities found = {.count = 4711};
    expect_ok(
        (form == CSCD_NEAR_UNIQUE ? find_unique_packed : find_near_packed)(r->detector, x, distance, &found));
    item_list list = {calloc(found.count + 1, sizeof *list.items), found.count};
    assert_non_null(list.items);
    if (found.count > 0) memcpy(list.items, found.items, found.count * sizeof *list.items);
    return list;
}

double mollifier_of(const cscd_proximity *p, const double *x) {
    double a[3], b[3], c[3], square = 0.0;
    if (p->threshold == 0.0) return 1.0;
    for (uint32_t k = 0; k < 3; k++) {
        a[k] = x[p->vertices[1] * 3 + k] - x[p->vertices[0] * 3 + k];
        b[k] = x[p->vertices[3] * 3 + k] - x[p->vertices[2] * 3 + k];
    }
    for (int k = 0; k < 3; k++) {
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        square += c[k] * c[k];
    }
    double share = square / p->threshold;
    return share < 1.0 ? share * (2.0 - share) : 1.0;
}

/* A barrier without its pole, so that scenes with contacts have an energy, too. */
static double energy_of(double distance, double reach) {
    double beyond = 1.0 - distance / reach;
    return beyond > 0.0 ? beyond * beyond * (2.0 + distance / reach) : 0.0;
}

double sum_energies(const item_list *list, const double *x, double reach, bool counted) {
    double sum = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        const cscd_proximity *p = &list->items[i];
        sum += (counted ? p->count : 1) * mollifier_of(p, x) * energy_of(p->distance, reach);
    }
    return sum;
}

/* ---- truncation ---------------------------------------------------------------------------------------- */

rig rig_apart(const scene *s, double apart, cscd_method method, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = apart;
    options.method = method_or_none(method);
    options.ours = ours_of_method(options.method);
    return rig_create(s, threads, &options);
}

void scene_two_triangles(scene *s, double apart) {
    static const double corners[3][2] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    s->vertex_count = 6;
    s->triangle_count = 2;
    for (uint32_t i = 0; i < 6; i++) {
        s->triangles[i] = i;
        s->x0[3 * i] = corners[i % 3][0];
        s->x0[3 * i + 1] = corners[i % 3][1];
        s->x0[3 * i + 2] = i < 3 ? 0.0 : apart;
    }
    memcpy(s->x1, s->x0, sizeof s->x1);
}

static void narrow_positions(const scene *s, const double *from, float *to) {
    for (size_t i = 0; i < (size_t)s->vertex_count * 3; i++) to[i] = (float)from[i];
}

cscd_truncation truncate_scene(const rig *r, const scene *s, double radius, cscd_scalar scalar, double *end) {
    static float x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    cscd_truncation out;
    uint32_t count = s->vertex_count;
    if (scalar == CSCD_SCALAR_DOUBLE) {
        expect_ok(truncate_packed(r->detector, s->x0, s->x1, radius, end, &out));
        return out;
    }
    narrow_positions(s, s->x0, x0);
    narrow_positions(s, s->x1, x1);
    expect_ok(cscd_detector_truncate(r->detector, CSCD_FLOATS(x0, count), CSCD_FLOATS(x1, count), radius,
                                     CSCD_MUTABLE_FLOATS(x1, count), &out));
    for (size_t i = 0; i < (size_t)count * 3; i++) end[i] = (double)x1[i];
    return out;
}
