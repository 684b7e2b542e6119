/* Bounding volume hierarchies of scenes, and gaps between moving features along the directions of 14-DOPs, in long double. */
#include "tests/support/bvh/bvh_rig.h"

#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

const int directions[DIRECTION_COUNT][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                            {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

long double along_direction(const long double p[3], int direction) {
    const int *d = directions[direction];
    return d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
}

typedef struct gap_extent {
    long double low, high;
} gap_extent;

static long double lesser_of(long double a, long double b) {
    return a < b ? a : b;
}

static long double greater_of(long double a, long double b) {
    return a > b ? a : b;
}

static gap_extent extent_of(const double *x, point_set points, int direction) {
    gap_extent out = {INFINITY, -INFINITY};
    for (int i = 0; i < points.count; i++) {
        const double *p = x + (size_t)points.vertices[i] * 3;
        long double value =
            direction < 3 ? p[direction] : along_direction((long double[3]){p[0], p[1], p[2]}, direction);
        out.low = lesser_of(out.low, value);
        out.high = greater_of(out.high, value);
    }
    return out;
}

static long double gap_along_some(gap_motion m, point_set a, point_set b, int count, long double enough) {
    long double largest = -INFINITY;
    for (int k = 0; k < count && largest <= enough; k++) {
        gap_extent a0 = extent_of(m.x0, a, k), a1 = extent_of(m.x1, a, k);
        gap_extent b0 = extent_of(m.x0, b, k), b1 = extent_of(m.x1, b, k);
        long double above = lesser_of(a0.low - b0.high, a1.low - b1.high);
        long double below = lesser_of(b0.low - a0.high, b1.low - a1.high);
        long double gap = greater_of(above, below);
        largest = greater_of(largest, k < 3 ? gap : gap / sqrtl(3.0L));
    }
    return largest;
}

long double direction_gap(gap_motion m, point_set a, point_set b, long double enough) {
    return gap_along_some(m, a, b, DIRECTION_COUNT, enough);
}

long double axis_gap(gap_motion m, point_set a, point_set b, long double enough) {
    return gap_along_some(m, a, b, 3, enough);
}

double motion_extent(gap_motion m, uint32_t vertex_count) {
    double largest = 0.0;
    for (uint32_t i = 0; i < vertex_count * 3; i++) {
        largest = fmax(largest, fabs(m.x0[i] - m.x0[i % 3]));
        largest = fmax(largest, fabs(m.x1[i] - m.x0[i % 3]));
    }
    return largest;
}

/* ---- a scene with its hierarchy ------------------------------------------------------------------------ */

static void choose_regions(bvh_rig *r, uint32_t region_count) {
    const cscd_mesh *mesh = r->mesh;
    uint32_t most = mesh->triangle_count;
    r->region_count = region_count == 0 ? mesh->component_count : region_count < most ? region_count : most;
    r->regions = malloc(mesh->triangle_count * sizeof *r->regions);
    assert_non_null(r->regions);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        r->regions[t] = region_count == 0 ? mesh->triangle_components[t]
                                          : (uint32_t)((uint64_t)t * r->region_count / mesh->triangle_count);
}

static void build_trees(bvh_rig *r, const double *positions, int axis_count) {
    uint32_t count = r->mesh->triangle_count;
    double *weights = malloc(count * sizeof *weights), *sizes = calloc(r->region_count, sizeof *sizes);
    assert_true(weights != NULL && sizes != NULL);
    for (uint32_t t = 0; t < count; t++) sizes[r->regions[t]] += 1.0;
    for (uint32_t t = 0; t < count; t++) weights[t] = 1.0 / sizes[r->regions[t]];
    bvh_regions regions = {r->regions, weights, r->region_count};
    assert_int_equal(bvh_build(r->mesh, regions, positions, axis_count, &r->bvh), CSCD_OK);
    free(weights);
    free(sizes);
}

bool bvh_rig_create(const scene *s, bvh_setup setup, bvh_rig *out) {
    bvh_rig r = {.context = NULL};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = setup.thread_count;
    options.simd = setup.simd;
    cscd_status status = cscd_context_create(&options, &r.context);
    if (setup.simd != CSCD_SIMD_AUTO && !processor_has_simd(setup.simd)) {
        assert_int_equal(status, CSCD_INVALID_ARGUMENT);
        return false;
    }
    assert_int_equal(status, CSCD_OK);
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    choose_regions(&r, setup.region_count);
    build_trees(&r, s->x0, setup.axis_count);
    *out = r;
    return true;
}

void bvh_rig_destroy(bvh_rig *r) {
    bvh_free(&r->bvh);
    free(r->regions);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

void translate(double *x, uint32_t vertex_count, const double by[3]) {
    for (size_t i = 0; i < (size_t)vertex_count * 3; i++) x[i] += by[i % 3];
}

void in_frame(const bvh *hierarchy, const bvh_tree *p, gap_motion m, uint32_t vertex, int moment,
              long double out[3]) {
    long double t = 0.5L * moment;
    for (size_t k = 0; k < 3; k++) {
        size_t at = (size_t)vertex * 3 + k;
        const bvh_tree *frame = p != NULL ? p : &hierarchy->trees[0];
        long double start = (long double)m.x0[at] - frame->origin[0][k];
        long double end = (long double)m.x1[at] - frame->origin[1][k];
        out[k] = ((1.0L - t) * start + t * end) * hierarchy->scale;
    }
}

/* ---- trees at one moment ------------------------------------------------------------------------------- */

void mesh_trees_build(const cscd_mesh *mesh, const double *positions, int axis_count, bvh *out) {
    double *weights = malloc(mesh->triangle_count * sizeof *weights);
    assert_non_null(weights);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    bvh_regions regions = {mesh->triangle_components, weights, mesh->component_count};
    assert_int_equal(bvh_build(mesh, regions, positions, axis_count, out), CSCD_OK);
    bvh_refit(out, positions, positions, uniform_growth(0.0));
    free(weights);
}

/* ---- triangles that touch ------------------------------------------------------------------------------ */

static long double gap_along(const double *below, const double *above, int direction) {
    long double highest = -INFINITY, lowest = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double *p = below + 3 * i, *q = above + 3 * i;
        highest = fmaxl(highest, along_direction((long double[3]){p[0], p[1], p[2]}, direction));
        lowest = fminl(lowest, along_direction((long double[3]){q[0], q[1], q[2]}, direction));
    }
    return lowest - highest;
}

/* Moves the upper triangle along one axis until it touches the lower one. */
static void let_touch(const double *below, double *above, int direction) {
    int axis = direction < 3 ? direction : 0;
    double sign = directions[direction][axis], more = 0x1p-53;
    double shift = (double)gap_along(below, above, direction);
    do {
        for (int i = 0; i < 3; i++) above[3 * i + axis] -= sign * shift;
        shift = more;
        more *= 2.0;
    } while (gap_along(below, above, direction) > 0.0L);
}

void make_touching_pairs(random_stream *random, uint32_t pair_count, double spread, scene *out) {
    scene_clear(out);
    out->vertex_count = pair_count * 6;
    out->triangle_count = pair_count * 2;
    for (uint32_t i = 0; i < pair_count * 6; i++) out->triangles[i] = i;
    for (size_t p = 0; p < pair_count; p++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = stream_between(random, -spread, spread);
        for (size_t i = 18 * p; i < 18 * p + 18; i++) {
            out->x0[i] = centre[i % 3] + stream_between(random, -1.0, 1.0);
            out->x1[i] = out->x0[i] + stream_between(random, -0.5, 0.5);
        }
        int direction = (int)stream_below(random, DIRECTION_COUNT);
        size_t above = 18 * p + 9 * stream_below(random, 2), below = 36 * p + 9 - above;
        let_touch(out->x0 + below, out->x0 + above, direction);
        let_touch(out->x1 + below, out->x1 + above, direction);
    }
}
