/* Second volumes of children, which tell triangles apart where boxes cannot: by the directions in which they lie as seen from a
 * hub, and by the hulls of two boxes around slivers. */
#include "runtime/bvh/bvh_parts.h"
#include "src/core/floating.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* A unit vector may be off by this much: by a few times 2^-53, and a normal by 2^20 times as much. */
static const double direction_slack = 0x1p-48, normal_slack = 0x1p-28;

/* Directions that differ by more than an angle with this cosine say nothing of what lies between them. */
static const double least_cosine = 0.5;

/* A sliver is this many times as long as it is high; a large triangle is this share of the mesh long. */
static const double sliver_ratio = 16.0, large_share = 0.125;

static uint32_t lane_count(const bvh_level *level, uint32_t block) {
    return (uint32_t)__builtin_popcount(level->flags[block].used);
}

/* ---- two boxes --------------------------------------------------------------------------------------------- */

static void clear_boxes(double boxes[2][2][2][3]) {
    for (int i = 0; i < 12; i++) {
        boxes[i / 6][i / 3 % 2][0][i % 3] = INFINITY;
        boxes[i / 6][i / 3 % 2][1][i % 3] = -INFINITY;
    }
}

static void widen_box(double box[2][3], const double low[3], const double high[3]) {
    for (int k = 0; k < 3; k++) {
        box[0][k] = fmin(box[0][k], low[k]);
        box[1][k] = fmax(box[1][k], high[k]);
    }
}

static void widen_boxes(double boxes[2][2][2][3], const double by[2][2][2][3]) {
    for (int i = 0; i < 4; i++) widen_box(boxes[i / 2][i % 2], by[i / 2][i % 2][0], by[i / 2][i % 2][1]);
}

static void middle_of(const double box[2][3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = 0.5 * box[0][k] + 0.5 * box[1][k];
}

static double within_line(double at) {
    return fmin(fmax(at, 0.0), 1.0);
}

/* The least squared sine, relative to the lengths, of lines that are not parallel, and the place on the first one that stands for
 * where parallel lines are nearest. */
typedef struct line_rule {
    double parallel, place;
} line_rule;

/* Finds a vector from the line between the middles of two boxes to that of two others at the start, about where the lines are
 * nearest. */
static void way_between(const double a[2][2][2][3], const double b[2][2][2][3], line_rule rule,
                        double way[3]) {
    double ends[2][3], from[3], to[3], between[3];
    middle_of(a[0][0], ends[0]);
    middle_of(a[1][0], from);
    middle_of(b[0][0], ends[1]);
    middle_of(b[1][0], to);
    vec3_subtract(from, ends[0], from);
    vec3_subtract(to, ends[1], to);
    vec3_subtract(ends[1], ends[0], between);
    const double ff = vec3_dot(from, from), tt = vec3_dot(to, to), ft = vec3_dot(from, to);
    const double fb = vec3_dot(from, between), tb = vec3_dot(to, between), area = ff * tt - ft * ft;
    double s = area > rule.parallel * ff * tt ? within_line((fb * tt - tb * ft) / area) : rule.place;
    const double t = tt > 0.0 ? within_line((s * ft - tb) / tt) : 0.0;
    s = ff > 0.0 ? within_line((t * ft + fb) / ff) : 0.0;
    for (int k = 0; k < 3; k++) way[k] = between[k] + t * to[k] - s * from[k];
}

/* Returns the most that the hull of two boxes reaches along a vector at one end; *size: the sum of what was added up, by
 * magnitude. */
static double reach_along(const double boxes[2][2][2][3], int end, const double way[3], double *size) {
    double reaches[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            const double low = boxes[i][end][0][k], high = boxes[i][end][1][k];
            reaches[i] += way[k] > 0.0 ? way[k] * high : way[k] * low;
            *size += fabs(way[k]) * (fabs(low) + fabs(high));
        }
    }
    return fmax(reaches[0], reaches[1]);
}

/* A plane that parts two hulls at both ends parts them throughout, because points move linearly. Sums of three products are off
 * by less than 2^-50 of their terms. A NaN parts nothing. */
static bool plane_parts(const double a[2][2][2][3], const double b[2][2][2][3], line_rule rule,
                        double distance) {
    double way[3], back[3];
    way_between(a, b, rule, way);
    for (int k = 0; k < 3; k++) back[k] = -way[k];
    const double wide = distance * (1.0 + 0x1p-40) * surface_norm(way);
    for (int e = 0; e < 2; e++) {
        double size = 0.0;
        const double reach_a = reach_along(a, e, way, &size), reach_b = -reach_along(b, e, back, &size);
        if (!(reach_b - reach_a > wide + 0x1p-48 * size + 0x1p-1000)) return false;
    }
    return true;
}

/* ---- around a hub ------------------------------------------------------------------------------------------ */

static bool leaf_shares(const bvh *hierarchy, const bvh_leaf *leaf, uint32_t vertex) {
    for (int lane = 1; lane < LANES && leaf->triangles[lane] != UINT32_MAX; lane++) {
        if (!triangle_contains(hierarchy->mesh->triangles[leaf->triangles[lane]], vertex)) return false;
    }
    return true;
}

/* The first one in the first triangle; of two the lesser, so that all pages of a book name them alike. */
static void name_hubs(const bvh *hierarchy, uint32_t index, hub_volume *out) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    const uint32_t *corners = hierarchy->mesh->triangles[leaf->triangles[0]];
    for (int i = 0; i < 3; i++) {
        if (!vertex_is_hub(hierarchy->mesh, corners[i]) || !leaf_shares(hierarchy, leaf, corners[i]))
            continue;
        if (out->hub == NO_HUB) {
            out->hub = corners[i];
        } else {
            out->other = out->hub < corners[i] ? corners[i] : out->hub;
            out->hub = out->hub < corners[i] ? out->hub : corners[i];
            return;
        }
    }
}

static void name_hubs_of_block(const bvh_level *level, uint32_t block, hub_volume *out) {
    const hub_volume *children = level->child_hubs + (size_t)block * LANES;
    for (uint32_t i = 1; i < lane_count(level, block); i++) {
        if (children[i].hub != children[0].hub || children[i].other != children[0].other) return;
    }
    out->hub = children[0].hub;
    out->other = children[0].other;
}

/* A triangle seen from the hub: unit vectors towards its other corners at both ends, and the least
 * distance of one. */
typedef struct corner_view {
    double towards[4][3], nearest;
    int count;
} corner_view;

static bool look_at_corner(const double *hub, const double *corner, corner_view *view) {
    double side[3], *towards = view->towards[view->count++];
    vec3_subtract(corner, hub, side);
    const double length = surface_norm(side);
    if (!(length > 0.0) || !isfinite(length)) return false;
    for (int k = 0; k < 3; k++) towards[k] = side[k] / length;
    view->nearest = fmin(view->nearest, length);
    return true;
}

static bool look_at_triangle(const bvh *hierarchy, uint32_t triangle, uint32_t hub,
                             const double *const ends[2], corner_view *view) {
    *view = (corner_view){.nearest = INFINITY};
    for (int e = 0; e < (hierarchy->still ? 1 : 2); e++) {
        for (int i = 0; i < 3; i++) {
            const uint32_t corner = hierarchy->mesh->triangles[triangle][i];
            if (corner != hub &&
                !look_at_corner(ends[e] + (size_t)hub * 3, ends[e] + (size_t)corner * 3, view))
                return false;
        }
    }
    return true;
}

static void add_product(const double a[3], const double b[3], double sum[3]) {
    double product[3];
    vec3_cross(a, b, product);
    for (int k = 0; k < 3; k++) sum[k] += product[k];
}

/* The normal of a page is a product of two vectors that move linearly, so it is a sum, with weights of 0 or more, of three: those at
 * the ends, and one that is mixed of both ends. A sum that is not small beside its terms has a direction. */
static bool look_at_page(const bvh *hierarchy, uint32_t triangle, const hub_volume *v,
                         const double *const ends[2], corner_view *view) {
    double edges[2][3], sides[2][3];
    uint32_t corner = UINT32_MAX;
    for (int i = 0; i < 3; i++) {
        const uint32_t next = hierarchy->mesh->triangles[triangle][i];
        if (next != v->hub && next != v->other) corner = next;
    }
    for (int e = 0; e < 2; e++) {
        vec3_subtract(ends[e] + (size_t)v->other * 3, ends[e] + (size_t)v->hub * 3, edges[e]);
        vec3_subtract(ends[e] + (size_t)corner * 3, ends[e] + (size_t)v->hub * 3, sides[e]);
    }
    /* corners may be near the edge, so that pages are never apart by a distance */
    *view = (corner_view){.nearest = 0.0, .count = hierarchy->still ? 1 : 3};
    for (int i = 0; i < view->count; i++) {
        const int from = i / 2, to = (i + 1) / 2; /* 0 0, 0 1, 1 1 */
        double normal[3] = {0.0, 0.0, 0.0}, size = surface_norm(edges[from]) * surface_norm(sides[to]);
        add_product(edges[from], sides[to], normal);
        if (from != to) {
            size += surface_norm(edges[to]) * surface_norm(sides[from]);
            add_product(edges[to], sides[from], normal);
        }
        const double length = surface_norm(normal);
        if (!(length > 0x1p-20 * size) || !(length > 0x1p-900) || !isfinite(length)) return false;
        for (int k = 0; k < 3; k++) view->towards[i][k] = normal[k] / length;
    }
    return true;
}

static double cosine_between(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Points of the moving triangle, relative to the hub, are sums of the vectors towards its corners with weights of 0 or more,
 * because corners and hub move linearly. Let c be such a sum of the unit vectors whose weights add up to 1: it lies in
 * their box, and c . c is the least cosine m at least. So the direction c / |c| is at most 1 - sqrt m away from the box,
 * and a point on the side opposite the hub is sqrt m times the nearest corner's distance away at least. */
static void add_view(const corner_view *view, hub_volume *out) {
    double least = 1.0;
    for (int i = 0; i < view->count; i++)
        for (int j = 0; j < i; j++) least = fmin(least, cosine_between(view->towards[i], view->towards[j]));
    if (!(least >= least_cosine)) {
        out->hub = NO_HUB;
        return;
    }
    const double around = 1.0 - sqrt(least) + (out->other == NO_HUB ? direction_slack : normal_slack);
    out->reach = fminf(out->reach, float_below(view->nearest * sqrt(least) * (1.0 - direction_slack)));
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < view->count; i++) {
            out->low[k] = fmin(out->low[k], view->towards[i][k] - around);
            out->high[k] = fmax(out->high[k], view->towards[i][k] + around);
        }
    }
}

static hub_volume nothing_seen(void) {
    hub_volume v = {.hub = NO_HUB, .other = NO_HUB, .reach = INFINITY};
    for (int k = 0; k < 3; k++) {
        v.low[k] = INFINITY;
        v.high[k] = -INFINITY;
    }
    clear_boxes(v.boxes);
    return v;
}

static void add_boxes(const bvh *hierarchy, uint32_t triangle, const double *const ends[2], hub_volume *out) {
    for (int i = 0; i < 6; i++) {
        const uint32_t corner = hierarchy->mesh->triangles[triangle][i % 3];
        const double *x = ends[i / 3] + (size_t)corner * 3;
        widen_box(out->boxes[corner != out->hub][i / 3], x, x);
    }
}

/* One wide triangle leaves nothing known of its leaf. */
static void find_hub_of_leaf(const bvh *hierarchy, uint32_t index, const double *const ends[2],
                             hub_volume *out) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    *out = nothing_seen();
    name_hubs(hierarchy, index, out);
    if (out->hub == NO_HUB) return;
    for (int lane = 0; lane < LANES && leaf->triangles[lane] != UINT32_MAX && out->hub != NO_HUB; lane++) {
        corner_view view;
        add_boxes(hierarchy, leaf->triangles[lane], ends, out);
        if (out->other == NO_HUB ? look_at_triangle(hierarchy, leaf->triangles[lane], out->hub, ends, &view)
                                 : look_at_page(hierarchy, leaf->triangles[lane], out, ends, &view))
            add_view(&view, out);
        else
            out->hub = NO_HUB;
    }
}

static void join_hub_volume(const hub_volume *child, hub_volume *out) {
    out->reach = fminf(out->reach, child->reach);
    for (int k = 0; k < 3; k++) {
        out->low[k] = fmin(out->low[k], child->low[k]);
        out->high[k] = fmax(out->high[k], child->high[k]);
    }
    widen_boxes(out->boxes, child->boxes);
}

static void join_hub_volumes(const bvh_level *level, uint32_t block, hub_volume *out) {
    *out = nothing_seen();
    name_hubs_of_block(level, block, out);
    for (uint32_t i = 0; i < lane_count(level, block) && out->hub != NO_HUB; i++)
        join_hub_volume(&level->child_hubs[(size_t)block * LANES + i], out);
}

/* Two volumes with one hub. A feature of a pair of features without a common vertex is a side opposite the hub, or an end
 * of one: it is at least reach away from there, and the other triangle lies in directions that differ by a chord of c at
 * least. So they are apart by reach times the sine of the angle, which is above 0.7 c for the part of c up to a right
 * angle. */
static bool directions_apart(const hub_volume *a, const hub_volume *b, double distance) {
    double chord = 0.0; /* squared */
    for (int k = 0; k < 3; k++) {
        const double gap = fmax(a->low[k] - b->high[k], b->low[k] - a->high[k]);
        if (gap > 0.0) chord += gap * gap;
    }
    if (distance == 0.0) return chord > 0.0;
    return 0.7 * sqrt(fmin(chord, 2.0)) * (double)fminf(a->reach, b->reach) > distance;
}

bool hub_volumes_apart(const hub_volume *a, const hub_volume *b, double distance) {
    if (a->hub == NO_HUB || b->hub == NO_HUB) return false;
    if (a->hub != b->hub) return plane_parts(a->boxes, b->boxes, (line_rule){0.0, 0.0}, distance);
    return a->other == b->other && directions_apart(a, b, distance);
}

/* ---- of slivers -------------------------------------------------------------------------------------------- */

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

static void find_slivers_of_leaf(const bvh *hierarchy, uint32_t index, const double *const ends[2],
                                 sliver_volume *out) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    out->axis = long_axis(hierarchy->mesh->triangles[leaf->triangles[0]], ends[0]);
    clear_boxes(out->boxes);
    for (int lane = 0; lane < LANES && leaf->triangles[lane] != UINT32_MAX; lane++)
        hold_triangle(hierarchy->mesh->triangles[leaf->triangles[lane]], ends, out);
}

static void join_sliver_volumes(const bvh_level *level, uint32_t block, sliver_volume *out) {
    const sliver_volume *children = level->child_slivers + (size_t)block * LANES;
    out->axis = children[0].axis;
    clear_boxes(out->boxes);
    for (uint32_t i = 0; i < lane_count(level, block) && out->axis >= 0; i++) {
        if (children[i].axis != out->axis) {
            out->axis = -1;
            return;
        }
        widen_boxes(out->boxes, children[i].boxes);
    }
}

bool sliver_volumes_apart(const sliver_volume *a, const sliver_volume *b, double distance) {
    if (a->axis < 0 || b->axis < 0) return false;
    return plane_parts(a->boxes, b->boxes, (line_rule){0x1p-20, 0.5}, distance);
}

/* ---- meshes that need them --------------------------------------------------------------------------------- */

static bool has_hubs(const cscd_mesh *mesh) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (vertex_is_hub(mesh, v)) return true;
    }
    return false;
}

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

static bool allocate_volumes(const bvh *hierarchy, bvh_level *level, bool hubs, bool slivers) {
    cscd_context *context = hierarchy->mesh->context;
    const size_t count = (size_t)level->block_count * LANES;
    if (hubs) level->child_hubs = context_allocate(context, count, sizeof *level->child_hubs);
    if (slivers) level->child_slivers = context_allocate(context, count, sizeof *level->child_slivers);
    return (!hubs || level->child_hubs != NULL) && (!slivers || level->child_slivers != NULL);
}

bool bvh_allocate_second_volumes(bvh *hierarchy, const double *positions) {
    const bool hubs = has_hubs(hierarchy->mesh), slivers = has_slivers(hierarchy->mesh, positions);
    for (int i = 0; i < hierarchy->level_count; i++) {
        if (!allocate_volumes(hierarchy, &hierarchy->levels[i], hubs, slivers)) return false;
    }
    return true;
}

void bvh_free_second_volumes(bvh *hierarchy) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        bvh_level *level = &hierarchy->levels[i];
        context_free(hierarchy->mesh->context, level->child_hubs);
        context_free(hierarchy->mesh->context, level->child_slivers);
        level->child_hubs = NULL;
        level->child_slivers = NULL;
    }
}

/* ---- all of them ------------------------------------------------------------------------------------------- */

enum { BLOCKS_PER_TASK = 16 };

typedef struct volume_work {
    bvh *bvh;
    const double *ends[2];
    int level;
} volume_work;

static void find_volumes(const volume_work *work, uint32_t block, uint32_t lane) {
    const bvh_level *level = &work->bvh->levels[work->level];
    const uint32_t child = level->first_children[block] + lane;
    const size_t at = (size_t)block * LANES + lane;
    if (level->child_hubs != NULL && work->level == 0)
        find_hub_of_leaf(work->bvh, child, work->ends, &level->child_hubs[at]);
    else if (level->child_hubs != NULL)
        join_hub_volumes(level - 1, child, &level->child_hubs[at]);
    if (level->child_slivers != NULL && work->level == 0)
        find_slivers_of_leaf(work->bvh, child, work->ends, &level->child_slivers[at]);
    else if (level->child_slivers != NULL)
        join_sliver_volumes(level - 1, child, &level->child_slivers[at]);
}

static void find_some_volumes(void *data, uint32_t index) {
    const volume_work *work = data;
    const bvh_level *level = &work->bvh->levels[work->level];
    const uint32_t begin = index * BLOCKS_PER_TASK, rest = level->block_count - begin;
    const uint32_t end = begin + (rest < BLOCKS_PER_TASK ? rest : BLOCKS_PER_TASK);
    for (uint32_t block = begin; block < end; block++) {
        for (uint32_t i = 0; i < lane_count(level, block); i++) find_volumes(work, block, i);
    }
}

void bvh_refit_second_volumes(bvh *hierarchy, const double *x0, const double *x1) {
    volume_work work = {hierarchy, {x0, x1}, 0};
    if (hierarchy->levels[0].child_hubs == NULL && hierarchy->levels[0].child_slivers == NULL) return;
    for (; work.level < hierarchy->level_count; work.level++)
        parallel_run(hierarchy->mesh->context->threads,
                     (hierarchy->levels[work.level].block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK,
                     find_some_volumes, &work);
}
