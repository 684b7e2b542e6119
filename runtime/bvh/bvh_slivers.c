/* Finds the hulls of two boxes around slivers, and planes between two of them. */
#include "runtime/bvh/bvh_parts.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* A sliver is so many times as long as it is high; a large triangle is this share of the mesh long. */
static const double sliver_ratio = 16.0, large_share = 0.125;

/* ---- which meshes ---------------------------------------------------------------------------------------- */

static bool is_sliver_or_large(const uint32_t corners[3], const double *positions, double large) {
    double sides[3][3], longest = 0.0, normal[3];
    for (int i = 0; i < 3; i++) {
        vec3_subtract(positions + (size_t)corners[(i + 1) % 3] * 3, positions + (size_t)corners[i] * 3,
                      sides[i]);
        longest = fmax(longest, vec3_dot(sides[i], sides[i]));
    }
    vec3_cross(sides[0], sides[1], normal);
    return longest > large * large || sliver_ratio * surface_norm(normal) < longest;
}

static double extent_of(const cscd_mesh *mesh, const double *positions) {
    double extent = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            for (int i = 0; i < 3; i++) {
                const double x = positions[(size_t)mesh->triangles[t][i] * 3 + (size_t)k];
                low = fmin(low, x);
                high = fmax(high, x);
            }
        }
        extent = fmax(extent, high - low);
    }
    return extent;
}

/* Do most triangles of a mesh of more than a few overlap many others by their boxes? */
static bool has_slivers(const cscd_mesh *mesh, const double *positions) {
    if (mesh->triangle_count < HUB_TRIANGLES) return false;
    const double large = large_share * extent_of(mesh, positions);
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count += is_sliver_or_large(mesh->triangles[t], positions, large);
    return count > mesh->triangle_count / 2;
}

bool bvh_allocate_slivers(bvh *hierarchy, const double *positions) {
    if (!has_slivers(hierarchy->mesh, positions)) return true;
    for (int i = 0; i < hierarchy->level_count; i++) {
        bvh_level *level = &hierarchy->levels[i];
        level->child_slivers = context_allocate(hierarchy->mesh->context, (size_t)level->block_count * LANES,
                                                sizeof *level->child_slivers);
        if (level->child_slivers == NULL) return false;
    }
    return true;
}

void bvh_free_slivers(bvh *hierarchy) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].child_slivers);
        hierarchy->levels[i].child_slivers = NULL;
    }
}

/* ---- volumes --------------------------------------------------------------------------------------------- */

static sliver_volume nothing_held(int axis) {
    sliver_volume v = {.axis = axis};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            v.boxes[i / 2][i % 2][0][k] = INFINITY;
            v.boxes[i / 2][i % 2][1][k] = -INFINITY;
        }
    }
    return v;
}

static void widen_box(double box[2][3], const double low[3], const double high[3]) {
    for (int k = 0; k < 3; k++) {
        box[0][k] = fmin(box[0][k], low[k]);
        box[1][k] = fmax(box[1][k], high[k]);
    }
}

/* The first axis along which the triangle is at least half as long as along any other: slivers side by side have the same one. */
static int long_axis(const uint32_t corners[3], const double *x) {
    double lengths[3];
    for (int k = 0; k < 3; k++) {
        const double a = x[(size_t)corners[0] * 3 + (size_t)k], b = x[(size_t)corners[1] * 3 + (size_t)k],
                     c = x[(size_t)corners[2] * 3 + (size_t)k];
        lengths[k] = fmax(fmax(a, b), c) - fmin(fmin(a, b), c);
    }
    const double longest = fmax(fmax(lengths[0], lengths[1]), lengths[2]);
    return lengths[0] >= 0.5 * longest ? 0 : lengths[1] >= 0.5 * longest ? 1 : 2;
}

/* A corner is a near end if it is nearer to the least of the triangle's three, at the start. */
static void hold_triangle(const uint32_t corners[3], const double *const ends[2], sliver_volume *out) {
    const size_t axis = (size_t)out->axis;
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 3; i++) {
        low = fmin(low, ends[0][(size_t)corners[i] * 3 + axis]);
        high = fmax(high, ends[0][(size_t)corners[i] * 3 + axis]);
    }
    for (int i = 0; i < 3; i++) {
        const bool far = ends[0][(size_t)corners[i] * 3 + axis] > 0.5 * low + 0.5 * high;
        for (int e = 0; e < 2; e++) {
            const double *x = ends[e] + (size_t)corners[i] * 3;
            widen_box(out->boxes[far][e], x, x);
        }
    }
}

static void hold_leaf(const bvh *hierarchy, uint32_t index, const double *const ends[2], sliver_volume *out) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    *out = nothing_held(long_axis(hierarchy->mesh->triangles[leaf->triangles[0]], ends[0]));
    for (int lane = 0; lane < LANES && leaf->triangles[lane] != UINT32_MAX; lane++)
        hold_triangle(hierarchy->mesh->triangles[leaf->triangles[lane]], ends, out);
}

static void join_children(const bvh_level *level, uint32_t block, sliver_volume *out) {
    const sliver_volume *children = level->child_slivers + (size_t)block * LANES;
    const uint32_t count = (uint32_t)__builtin_popcount(level->flags[block].used);
    *out = nothing_held(children[0].axis);
    for (uint32_t i = 0; i < count && out->axis >= 0; i++) {
        if (children[i].axis != out->axis) {
            out->axis = -1;
            return;
        }
        for (int b = 0; b < 4; b++)
            widen_box(out->boxes[b / 2][b % 2], children[i].boxes[b / 2][b % 2][0],
                      children[i].boxes[b / 2][b % 2][1]);
    }
}

/* ---- comparing ------------------------------------------------------------------------------------------- */

static void middle_of(const double box[2][3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = 0.5 * box[0][k] + 0.5 * box[1][k];
}

static double within_line(double at) {
    return fmin(fmax(at, 0.0), 1.0);
}

/* Finds a vector from the line between the middles of the boxes of a to that of b at the start, about where they are nearest. */
static void way_between(const sliver_volume *a, const sliver_volume *b, double way[3]) {
    double ends[2][3], from[3], to[3], between[3];
    middle_of(a->boxes[0][0], ends[0]);
    middle_of(a->boxes[1][0], from);
    middle_of(b->boxes[0][0], ends[1]);
    middle_of(b->boxes[1][0], to);
    vec3_subtract(from, ends[0], from);
    vec3_subtract(to, ends[1], to);
    vec3_subtract(ends[1], ends[0], between);
    const double ff = vec3_dot(from, from), tt = vec3_dot(to, to), ft = vec3_dot(from, to);
    const double fb = vec3_dot(from, between), tb = vec3_dot(to, between), area = ff * tt - ft * ft;
    double s = area > 0x1p-20 * ff * tt ? within_line((fb * tt - tb * ft) / area) : 0.5;
    const double t = tt > 0.0 ? within_line((s * ft - tb) / tt) : 0.0;
    s = ff > 0.0 ? within_line((t * ft + fb) / ff) : 0.0;
    for (int k = 0; k < 3; k++) way[k] = between[k] + t * to[k] - s * from[k];
}

/* Returns the most that a volume reaches along a vector at one end; *size: the sum of what was added up, by magnitude. */
static double reach_along(const sliver_volume *v, int end, const double way[3], double *size) {
    double reaches[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            const double low = v->boxes[i][end][0][k], high = v->boxes[i][end][1][k];
            reaches[i] += way[k] > 0.0 ? way[k] * high : way[k] * low;
            *size += fabs(way[k]) * (fabs(low) + fabs(high));
        }
    }
    return fmax(reaches[0], reaches[1]);
}

/* A plane that parts the volumes at both ends parts them throughout, because points move linearly. Sums of three products are off by
 * less than 2^-50 of their terms. A NaN parts nothing. */
static bool plane_parts(const sliver_volume *a, const sliver_volume *b, const double way[3],
                        double distance) {
    const double back[3] = {-way[0], -way[1], -way[2]};
    const double wide = distance * (1.0 + 0x1p-40) * surface_norm(way);
    for (int e = 0; e < 2; e++) {
        double size = 0.0;
        const double reach_a = reach_along(a, e, way, &size), reach_b = -reach_along(b, e, back, &size);
        if (!(reach_b - reach_a > wide + 0x1p-48 * size + 0x1p-1000)) return false;
    }
    return true;
}

bool sliver_volumes_apart(const sliver_volume *a, const sliver_volume *b, double distance) {
    if (a->axis < 0 || b->axis < 0) return false;
    double way[3];
    way_between(a, b, way);
    return plane_parts(a, b, way, distance);
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

enum { BLOCKS_PER_TASK = 16 };

typedef struct sliver_work {
    bvh *bvh;
    const double *ends[2];
    int level;
} sliver_work;

static void hold_some_blocks(void *data, uint32_t index) {
    const sliver_work *work = data;
    bvh_level *level = &work->bvh->levels[work->level];
    const uint32_t begin = index * BLOCKS_PER_TASK, rest = level->block_count - begin;
    const uint32_t end = begin + (rest < BLOCKS_PER_TASK ? rest : BLOCKS_PER_TASK);
    for (uint32_t block = begin; block < end; block++) {
        const uint32_t count = (uint32_t)__builtin_popcount(level->flags[block].used);
        for (uint32_t i = 0; i < count; i++) {
            sliver_volume *out = &level->child_slivers[(size_t)block * LANES + i];
            if (work->level == 0)
                hold_leaf(work->bvh, level->first_children[block] + i, work->ends, out);
            else
                join_children(level - 1, level->first_children[block] + i, out);
        }
    }
}

void bvh_refit_slivers(bvh *hierarchy, const double *x0, const double *x1) {
    sliver_work work = {hierarchy, {x0, x1}, 0};
    if (hierarchy->levels[0].child_slivers == NULL) return;
    for (; work.level < hierarchy->level_count; work.level++)
        parallel_run(hierarchy->mesh->context->threads,
                     (hierarchy->levels[work.level].block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK,
                     hold_some_blocks, &work);
}
