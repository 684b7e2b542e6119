/* Two moving features in their own frame, their nearest points at one moment, and planes that keep them
 * apart from then on. */
#include "runtime/ccd/feature_moment.h"

#include "src/core/vec3.h"

/* ---- planes -------------------------------------------------------------------------------------------- */

/* If less than this fraction of an edge's length is perpendicular to another edge, that part is taken for
 * rounding. */
static const double nearly_parallel = 0x1p-40;

/* The rounding of the nearest points may make this of the cosine between an edge and the offset, times the
 * offset's length, when it should be 0. */
static const double offset_error = 0x1p-47;

/* Squares of shorter vectors lose digits, and so would the unit normal. */
static const double shortest_normal = 0x1p-400;

/* Removes the part of v that lies along axis, and returns which multiple of axis it was. */
static double remove_along(const double axis[3], double v[3]) {
    double share = vec3_dot(v, axis) / vec3_dot(axis, axis);
    vec3_add_scaled(v, -share, axis, v);
    return share;
}

/* Orthogonal axes that stay perpendicular to the shortest connection, and their rates of change. */
typedef struct axis_list {
    int count;
    double axis[2][3], change[2][3];
} axis_list;

static void add_axis(axis_list *axes, const double axis[3], const double change[3]) {
    double *own = axes->axis[axes->count], *own_change = axes->change[axes->count];
    for (int k = 0; k < 3; k++) {
        own[k] = axis[k];
        own_change[k] = change[k];
    }
    if (axes->count == 1) {
        double share = remove_along(axes->axis[0], own);
        vec3_add_scaled(own_change, -share, axes->change[0], own_change);
        if (vec3_dot(own, own) <= nearly_parallel * nearly_parallel * vec3_dot(axis, axis)) return;
    }
    axes->count++;
}

/* The points of edge i, as shortest_connection counts them. */
static const int edge_ends[2][3][2] = {
    [CSCD_CONTACT_VF] = {{1, 2}, {1, 3}, {2, 3}}, [CSCD_CONTACT_EE] = {{0, 1}, {2, 3}}};

static void edge_of(const moving_features *f, int i, double axis[3], double change[3]) {
    const int *ends = edge_ends[f->kind][i];
    vec3_subtract(f->x[ends[1]], f->x[ends[0]], axis);
    vec3_subtract(f->velocity[ends[1]], f->velocity[ends[0]], change);
}

/* Finds the edges in which the shortest connection ends, and those that are perpendicular to it by chance. */
static axis_list find_axes(const moving_features *f, const shortest_connection *shortest, int axes_max) {
    axis_list axes = {.count = 0};
    for (int i = 0; i < separating_plane_edges(f->kind) && axes.count < axes_max; i++) {
        double axis[3], change[3];
        edge_of(f, i, axis, change);
        double dot = vec3_dot(axis, shortest->offset), squared = vec3_dot(axis, axis);
        bool by_chance = dot * dot <= offset_error * offset_error * squared;
        if (squared > 0.0 && (shortest->inside[i] || by_chance)) add_axis(&axes, axis, change);
    }
    return axes;
}

/* The normal n is the offset made perpendicular to the axes q, which removes rounding of the nearest points
 * that would tilt the plane. It turns by n': n'.q = -n.q' keeps it perpendicular to the axes, n'.n = 0 keeps
 * its length to first order, and the freedom that is left follows the offset. A normal of 0 proves nothing.
 */
static separating_plane plane_beside(const shortest_connection *shortest, axis_list axes) {
    separating_plane plane = {.axis_count = axes.count};
    for (int k = 0; k < 3; k++) {
        plane.normal[k] = shortest->offset[k];
        plane.turn[k] = axes.count < 2 ? shortest->change[k] : 0.0;
    }
    for (int i = 0; i < axes.count; i++) {
        remove_along(axes.axis[i], plane.normal);
        remove_along(axes.axis[i], plane.turn);
    }
    double length = sqrt(vec3_dot(plane.normal, plane.normal));
    if (!(length > shortest_normal)) return (separating_plane){.axis_count = axes.count};
    remove_along(plane.normal, plane.turn);
    for (int k = 0; k < 3; k++) {
        plane.normal[k] /= length;
        plane.turn[k] /= length;
    }
    for (int i = 0; i < axes.count; i++) {
        double rate = vec3_dot(plane.normal, axes.change[i]) / vec3_dot(axes.axis[i], axes.axis[i]);
        vec3_add_scaled(plane.turn, -rate, axes.axis[i], plane.turn);
    }
    return plane;
}

separating_plane separating_plane_find(const moving_features *f, const shortest_connection *shortest,
                                       int axes_max) {
    return plane_beside(shortest, find_axes(f, shortest, axes_max));
}

separating_plane separating_plane_along(const moving_features *f, const shortest_connection *shortest,
                                        unsigned edges) {
    axis_list axes = {.count = 0};
    for (int i = 0; i < separating_plane_edges(f->kind) && axes.count < 2; i++) {
        double axis[3], change[3];
        if ((edges >> i & 1) == 0) continue;
        edge_of(f, i, axis, change);
        if (vec3_dot(axis, axis) > 0.0) add_axis(&axes, axis, change);
    }
    return plane_beside(shortest, axes);
}

/* Returns the least s > 0 at which a + b s + c s^2 is not above 0, or a smaller number. It returns 0 when a
 * is not above 0, and INFINITY when there is no such s. Up to a factor 1 + 2u, the computed discriminant is
 * that of a quadratic whose c is off by 2u. Up to a factor 1 + 6u, the result is the root of that quadratic.
 * The subtraction in the last line covers this factor, and the caller covers the error of c. */
static double first_loss(double a, double b, double c) {
    if (!(a > 0.0)) return 0.0;
    if (b >= 0.0 && c >= 0.0) return INFINITY;
    double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return INFINITY;
    double root = sqrt(discriminant);
    double s = b < 0.0 ? 2.0 * a / (root - b) : (b + root) / (-2.0 * c);
    return s > 0.0 ? s * (1.0 - 0x1p-49) : 0.0; /* 0 for NaN, which a tiny edge can give */
}

/* Positions and velocities of the points along normal and turn. */
typedef struct projection {
    double x_normal[4], v_normal[4], x_turn[4], v_turn[4];
} projection;

static projection project_points(const moving_features *f, const separating_plane *plane) {
    projection p;
    for (int i = 0; i < 4; i++) {
        p.x_normal[i] = vec3_dot(f->x[i], plane->normal);
        p.v_normal[i] = vec3_dot(f->velocity[i], plane->normal);
        p.x_turn[i] = vec3_dot(f->x[i], plane->turn);
        p.v_turn[i] = vec3_dot(f->velocity[i], plane->turn);
    }
    return p;
}

/* Let n, m be normal and turn, D and W the differences of position and velocity of a point of a and one of b.
 * They are farther apart than d at time s when
 *     (D + s W).(n + s m) > d (1 + s |n.m| + s^2 m^2 / 2) >= d |n + s m|,
 * a quadratic in s. When every pair of points passes, every pair of points in their hulls does.
 *
 * Errors for 0 <= s <= 1, in units of u = 2^-53. At most 128 are taken from a, for
 *     17.4 > 10 sqrt 3: D + s W, because each component of x + s velocity is off by 3 + 2,
 *     3.5: the coordinates themselves were rounded, by 1 each,
 *     10.4 and 20.8: pairs of x.n and velocity.n, off by 3 |x| and 3 |velocity|, at most sqrt 3 and 2 sqrt 3,
 *     3.5 and 6.9: the differences of these pairs,
 *     17.5: |n| <= 1 + 5u costs 5 d, and d < 3.5 if a > 0 is possible,
 *     7 and 21: the sums that make a, and those that make b,
 * together below 109. With m, times |m| s, 128 |m| are taken from b, for
 *     20.9: the positions,
 *     10.4 + 3.5: x.m,
 *     20.8 + 6.9: velocity.m,
 *     10.5: d n.m,
 *     10.5: the sums,
 * together below 84. Errors relative to c, with the 2u of first_loss, are below 16u (|velocity.m| + d m^2).
 * Underflow loses 2^-1070 at most. */
static double time_plane_holds(const moving_features *f, const projection *p, double distance, double lean,
                               double size) {
    double least = INFINITY, bend = distance * (size * size);
    int first = points_of_first(f->kind);
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) {
            double a = (p->x_normal[i] - p->x_normal[j]) - distance - SEPARATING_PLANE_ERROR;
            double b = (p->v_normal[i] - p->v_normal[j]) + (p->x_turn[i] - p->x_turn[j]) - distance * lean -
                       SEPARATING_PLANE_ERROR * size;
            double c = p->v_turn[i] - p->v_turn[j];
            c -= 0.5 * bend + 0x1p-49 * (fabs(c) + bend);
            double loss = first_loss(a, b, c);
            least = loss < least ? loss : least;
        }
    }
    return least;
}

double separating_plane_holds(const moving_features *f, const separating_plane *plane, double distance) {
    projection p = project_points(f, plane), fixed = {0};
    for (int i = 0; i < 4; i++) {
        fixed.x_normal[i] = p.x_normal[i];
        fixed.v_normal[i] = p.v_normal[i];
    }
    double without_turn = time_plane_holds(f, &fixed, distance, 0.0, 0.0);
    if (without_turn >= 1.0) return without_turn;
    double lean = fabs(vec3_dot(plane->normal, plane->turn));
    double size = sqrt(vec3_dot(plane->turn, plane->turn));
    return fmax(without_turn, time_plane_holds(f, &p, distance, lean, size));
}

/* With a distance of the gap itself, the bound of time_plane_holds on a is not above 0. */
double separating_plane_gap(const moving_features *f, const separating_plane *plane) {
    double least = INFINITY, along[4];
    int first = points_of_first(f->kind);
    for (int i = 0; i < 4; i++) along[i] = vec3_dot(f->x[i], plane->normal);
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) least = min_of(least, along[i] - along[j]);
    }
    return least - SEPARATING_PLANE_ERROR;
}

/* ---- moments ------------------------------------------------------------------------------------------- */

/* ---- the query ------------------------------------------------------------------------------------- */

/* The origin of the frame at either end. */
static const double *origin_at_end(const elementary_query *query, query_frame frame) {
    return frame == FRAME_MOVING ? query->x1[0] : query->x0[0];
}

static double query_extent(const elementary_query *query, const double origin1[3]) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = max_of(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = max_of(largest, fabs(query->x1[i][k] - origin1[k]));
        }
    }
    return largest;
}

local_query local_query_of(const elementary_query *query, cscd_contact_kind kind, query_frame frame) {
    local_query local = {.kind = kind, .frame = frame};
    const double *origin1 = origin_at_end(query, frame);
    int exponent = 0;
    frexp(query_extent(query, origin1), &exponent);
    local.scale = ldexp(1.0, -exponent);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            local.at.x0[i][k] = (query->x0[i][k] - query->x0[0][k]) * local.scale;
            local.at.x1[i][k] = (query->x1[i][k] - origin1[k]) * local.scale;
        }
    }
    const elementary_query *at = frame == FRAME_MOVING ? &local.at : query;
    local.still = memcmp(at->x0, at->x1, sizeof at->x0) == 0;
    return local;
}

double local_query_extent_at_start(const local_query *local) {
    double largest = 0.0;
    for (int i = 1; i < 4; i++) largest = max_of(largest, vec3_largest(local->at.x0[i]));
    return largest;
}

/* ---- the features at a moment ---------------------------------------------------------------------- */

static void connect_vf(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_point_triangle(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[1][k]) - u * (x[2][k] - x[1][k]) - v * (x[3][k] - x[1][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[1][k]) - u * (velocity[2][k] - velocity[1][k]) -
                                v * (velocity[3][k] - velocity[1][k]);
        m->middle[k] = x[0][k] - 0.5 * m->shortest.offset[k];
    }
    bool on_last = u + v >= 1.0;
    m->shortest.inside[0] = u > 0.0 && u < 1.0 && !(on_last && v > 0.0);
    m->shortest.inside[1] = v > 0.0 && v < 1.0 && !(on_last && u > 0.0);
    m->shortest.inside[2] = u > 0.0 && v > 0.0 && on_last;
}

static void connect_ee(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_segments(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[2][k]) + u * (x[1][k] - x[0][k]) - v * (x[3][k] - x[2][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[2][k]) + u * (velocity[1][k] - velocity[0][k]) -
                                v * (velocity[3][k] - velocity[2][k]);
        m->middle[k] = x[0][k] + u * (x[1][k] - x[0][k]) - 0.5 * m->shortest.offset[k];
    }
    m->shortest.inside[0] = u > 0.0 && u < 1.0;
    m->shortest.inside[1] = v > 0.0 && v < 1.0;
}

/* ---- the offset with twice the digits ---------------------------------------------------------------- */

/* A sum of two doubles (Dekker 1971). */
typedef struct long_sum {
    double high, low;
} long_sum;

static long_sum sum_of(double a, double b) {
    double sum = a + b, part = sum - a;
    return (long_sum){sum, (a - (sum - part)) + (b - part)};
}

static void split_digits(double x, double *high, double *low) {
    double scaled = 134217729.0 * x; /* 2^27 + 1 */
    *high = scaled - (scaled - x);
    *low = x - *high;
}

static long_sum product_of(double a, double b) {
    double a_high, a_low, b_high, b_low, product = a * b;
    split_digits(a, &a_high, &a_low);
    split_digits(b, &b_high, &b_low);
    double rest = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return (long_sum){product, rest};
}

static long_sum add_long(long_sum a, long_sum b) {
    long_sum sum = sum_of(a.high, b.high);
    return sum_of(sum.high, sum.low + (a.low + b.low));
}

/* share * (to - from) */
static long_sum share_of_side(double share, double from, double to) {
    long_sum side = sum_of(to, -from), product = product_of(share, side.high);
    product.low += share * side.low;
    return product;
}

/* The same offset as of connect_vf or connect_ee. It is off by 2^-53 of its length and 2^-100 of the extent,
 * so that the planes across it are as good as their own rounding. */
static void refine_offset(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    bool vf = m->features.kind == CSCD_CONTACT_VF;
    for (int k = 0; k < 3; k++) {
        long_sum offset = sum_of(x[0][k], -x[vf ? 1 : 2][k]);
        offset = add_long(offset, vf ? share_of_side(-m->u, x[1][k], x[2][k])
                                     : share_of_side(m->u, x[0][k], x[1][k]));
        offset = add_long(offset, share_of_side(-m->v, x[vf ? 1 : 2][k], x[3][k]));
        m->shortest.offset[k] = offset.high;
    }
}

void feature_moment_move(const local_query *local, double t, feature_moment *m) {
    m->t = t;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            m->features.x[i][k] = (1.0 - t) * local->at.x0[i][k] + t * local->at.x1[i][k];
    }
    if (local->kind == CSCD_CONTACT_VF)
        connect_vf(m);
    else
        connect_ee(m);
    if (local->frame == FRAME_MOVING) refine_offset(m);
    m->distance = sqrt(vec3_dot(m->shortest.offset, m->shortest.offset));
}

feature_moment feature_moment_start(const local_query *local) {
    feature_moment m = {.features.kind = local->kind};
    for (int i = 0; i < 4; i++) vec3_subtract(local->at.x1[i], local->at.x0[i], m.features.velocity[i]);
    feature_moment_move(local, 0.0, &m);
    return m;
}
