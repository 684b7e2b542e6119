/* Finds the directions in which triangles lie as seen from a vertex that very many of them share. */
#include "runtime/bvh/bvh_parts.h"
#include "src/core/floating.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* A unit vector may be off by this much: by a few times 2^-53, and a normal by 2^20 times as much. */
static const double direction_slack = 0x1p-48, normal_slack = 0x1p-28;

/* Directions that differ by more than an angle with this cosine say nothing of what lies between them. */
static const double least_cosine = 0.5;

/* ---- which children -------------------------------------------------------------------------------------- */

static bool has_hubs(const cscd_mesh *mesh) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (vertex_is_hub(mesh, v)) return true;
    }
    return false;
}

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

static uint32_t lane_count(const bvh_level *level, uint32_t block) {
    return (uint32_t)__builtin_popcount(level->flags[block].used);
}

static void name_hubs_of_block(const bvh_level *level, uint32_t block, hub_volume *out) {
    const hub_volume *children = level->child_hubs + (size_t)block * LANES;
    for (uint32_t i = 1; i < lane_count(level, block); i++) {
        if (children[i].hub != children[0].hub || children[i].other != children[0].other) return;
    }
    out->hub = children[0].hub;
    out->other = children[0].other;
}

bool bvh_allocate_hubs(bvh *hierarchy) {
    if (!has_hubs(hierarchy->mesh)) return true;
    for (int i = 0; i < hierarchy->level_count; i++) {
        bvh_level *level = &hierarchy->levels[i];
        level->child_hubs = context_allocate(hierarchy->mesh->context, (size_t)level->block_count * LANES,
                                             sizeof *level->child_hubs);
        if (level->child_hubs == NULL) return false;
    }
    return true;
}

void bvh_free_hubs(bvh *hierarchy) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].child_hubs);
        hierarchy->levels[i].child_hubs = NULL;
    }
}

/* ---- directions ------------------------------------------------------------------------------------------ */

/* What is known of a triangle seen from the hub: unit vectors towards its other corners at both ends, and the least
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
        for (int e = 0; e < 2; e++) {
            v.sides[e][0][k] = INFINITY;
            v.sides[e][1][k] = -INFINITY;
        }
    }
    return v;
}

static void add_sides(const bvh *hierarchy, uint32_t triangle, const double *const ends[2], hub_volume *out) {
    for (int i = 0; i < 6; i++) {
        const uint32_t corner = hierarchy->mesh->triangles[triangle][i % 3];
        for (int k = 0; corner != out->hub && k < 3; k++) {
            const double x = ends[i / 3][(size_t)corner * 3 + (size_t)k];
            out->sides[i / 3][0][k] = fmin(out->sides[i / 3][0][k], x);
            out->sides[i / 3][1][k] = fmax(out->sides[i / 3][1][k], x);
        }
    }
}

/* One wide triangle leaves nothing known of its leaf. */
static void view_leaf(const bvh *hierarchy, uint32_t index, const double *const ends[2], hub_volume *out) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    *out = nothing_seen();
    name_hubs(hierarchy, index, out);
    if (out->hub == NO_HUB) return;
    for (int e = 0; e < 2; e++) memcpy(out->place[e], ends[e] + (size_t)out->hub * 3, sizeof out->place[e]);
    for (int lane = 0; lane < LANES && leaf->triangles[lane] != UINT32_MAX && out->hub != NO_HUB; lane++) {
        corner_view view;
        add_sides(hierarchy, leaf->triangles[lane], ends, out);
        if (out->other == NO_HUB ? look_at_triangle(hierarchy, leaf->triangles[lane], out->hub, ends, &view)
                                 : look_at_page(hierarchy, leaf->triangles[lane], out, ends, &view))
            add_view(&view, out);
        else
            out->hub = NO_HUB;
    }
}

static void join_child(const hub_volume *child, hub_volume *out) {
    out->reach = fminf(out->reach, child->reach);
    memcpy(out->place, child->place, sizeof out->place);
    for (int k = 0; k < 3; k++) {
        out->low[k] = fmin(out->low[k], child->low[k]);
        out->high[k] = fmax(out->high[k], child->high[k]);
        for (int e = 0; e < 2; e++) {
            out->sides[e][0][k] = fmin(out->sides[e][0][k], child->sides[e][0][k]);
            out->sides[e][1][k] = fmax(out->sides[e][1][k], child->sides[e][1][k]);
        }
    }
}

static void join_children(const bvh_level *level, uint32_t block, hub_volume *out) {
    *out = nothing_seen();
    name_hubs_of_block(level, block, out);
    for (uint32_t i = 0; i < lane_count(level, block) && out->hub != NO_HUB; i++)
        join_child(&level->child_hubs[(size_t)block * LANES + i], out);
}

/* ---- comparing ------------------------------------------------------------------------------------------- */

/* Of two volumes with one hub. A feature of a pair of features without a common vertex is a side opposite the hub, or an end
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

/* The middle line of a volume, from the hub to the middle of the sides opposite it. */
static void middle_line(const hub_volume *v, double way[3]) {
    for (int k = 0; k < 3; k++) way[k] = 0.5 * (v->sides[0][0][k] + v->sides[0][1][k]) - v->place[0][k];
}

static double within_line(double at) {
    return fmin(fmax(at, 0.0), 1.0);
}

/* Finds a vector from the middle line of a to that of b at the start, about where they are nearest. */
static void way_between(const hub_volume *a, const hub_volume *b, double way[3]) {
    double from[3], to[3], between[3];
    middle_line(a, from);
    middle_line(b, to);
    vec3_subtract(b->place[0], a->place[0], between);
    const double ff = vec3_dot(from, from), tt = vec3_dot(to, to), ft = vec3_dot(from, to);
    const double fb = vec3_dot(from, between), tb = vec3_dot(to, between), area = ff * tt - ft * ft;
    double s = area > 0.0 ? within_line((fb * tt - tb * ft) / area) : 0.0;
    const double t = tt > 0.0 ? within_line((s * ft - tb) / tt) : 0.0;
    s = ff > 0.0 ? within_line((t * ft + fb) / ff) : 0.0;
    for (int k = 0; k < 3; k++) way[k] = between[k] + t * to[k] - s * from[k];
}

/* Returns the most that a volume reaches along a vector at one end; *size: the sum of what was added up, by magnitude. */
static double reach_along(const hub_volume *v, int end, const double way[3], double *size) {
    double of_hub = 0.0, of_sides = 0.0;
    for (int k = 0; k < 3; k++) {
        const double low = v->sides[end][0][k], high = v->sides[end][1][k];
        of_hub += way[k] * v->place[end][k];
        of_sides += way[k] > 0.0 ? way[k] * high : way[k] * low;
        *size += fabs(way[k]) * (fabs(v->place[end][k]) + fabs(low) + fabs(high));
    }
    return fmax(of_hub, of_sides);
}

/* Of two hubs: a plane that parts the volumes at both ends parts them throughout, because points move linearly. Sums of three
 * products are off by less than 2^-50 of their terms. A NaN parts nothing. */
static bool plane_between(const hub_volume *a, const hub_volume *b, double distance) {
    double way[3], back[3];
    way_between(a, b, way);
    for (int k = 0; k < 3; k++) back[k] = -way[k];
    const double wide = distance * (1.0 + 0x1p-40) * surface_norm(way);
    for (int e = 0; e < 2; e++) {
        double size = 0.0;
        const double reach_a = reach_along(a, e, way, &size), reach_b = -reach_along(b, e, back, &size);
        if (!(reach_b - reach_a > wide + 0x1p-48 * size + 0x1p-1000)) return false;
    }
    return true;
}

bool hub_volumes_apart(const hub_volume *a, const hub_volume *b, double distance) {
    if (a->hub == NO_HUB || b->hub == NO_HUB) return false;
    if (a->hub != b->hub) return plane_between(a, b, distance);
    return a->other == b->other && directions_apart(a, b, distance);
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

enum { BLOCKS_PER_TASK = 16 };

typedef struct hub_work {
    bvh *bvh;
    const double *ends[2];
    int level;
} hub_work;

static void view_some_blocks(void *data, uint32_t index) {
    const hub_work *work = data;
    bvh_level *level = &work->bvh->levels[work->level];
    const uint32_t begin = index * BLOCKS_PER_TASK, rest = level->block_count - begin;
    const uint32_t end = begin + (rest < BLOCKS_PER_TASK ? rest : BLOCKS_PER_TASK);
    for (uint32_t block = begin; block < end; block++) {
        for (uint32_t i = 0; i < lane_count(level, block); i++) {
            hub_volume *out = &level->child_hubs[(size_t)block * LANES + i];
            if (work->level == 0)
                view_leaf(work->bvh, level->first_children[block] + i, work->ends, out);
            else
                join_children(level - 1, level->first_children[block] + i, out);
        }
    }
}

void bvh_refit_hubs(bvh *hierarchy, const double *x0, const double *x1) {
    hub_work work = {hierarchy, {x0, x1}, 0};
    if (hierarchy->levels[0].child_hubs == NULL) return;
    for (; work.level < hierarchy->level_count; work.level++)
        parallel_run(hierarchy->mesh->context->threads,
                     (hierarchy->levels[work.level].block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK,
                     view_some_blocks, &work);
}
