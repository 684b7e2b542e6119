/* How long a plane that turns with two moving features keeps them farther apart than a distance. */
#include "runtime/ccd/separating_plane.h"

#include "src/core/vec3.h"

/* What is left of an edge beside the direction of another, as a fraction of its length, when it is taken for
 * rounding. */
static const double parallel = 0x1p-40;

/* What the rounding of the nearest points may make of an edge's cosine with offset, times its length, where
 * it is 0. */
static const double offset_error = 0x1p-47;

/* Squares of what is shorter lose digits, and so would the unit normal. */
static const double shortest_normal = 0x1p-400;

/* Removes from v what lies along axis; returns what multiple of axis that was. */
static double remove_along(const double axis[3], double v[3]) {
    double share = vec3_dot(v, axis) / vec3_dot(axis, axis);
    vec3_add_scaled(v, -share, axis, v);
    return share;
}

/* Orthogonal axes that stay perpendicular to the shortest connection, and how they change. */
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
        if (vec3_dot(own, own) <= parallel * parallel * vec3_dot(axis, axis)) return;
    }
    axes->count++;
}

/* The edges in which the shortest connection ends, and those that are perpendicular to it by chance. */
static axis_list find_axes(const moving_features *f, const shortest_connection *shortest, int axes_max) {
    static const int ends[2][3][2] = {
        [CSCD_CONTACT_VF] = {{1, 2}, {1, 3}, {2, 3}}, [CSCD_CONTACT_EE] = {{0, 1}, {2, 3}}};
    axis_list axes = {.count = 0};
    for (int i = 0; i < (f->kind == CSCD_CONTACT_VF ? 3 : 2) && axes.count < axes_max; i++) {
        const int *edge = ends[f->kind][i];
        double axis[3], change[3];
        vec3_subtract(f->x[edge[1]], f->x[edge[0]], axis);
        vec3_subtract(f->velocity[edge[1]], f->velocity[edge[0]], change);
        double dot = vec3_dot(axis, shortest->offset), squared = vec3_dot(axis, axis);
        bool by_chance = dot * dot <= offset_error * offset_error * squared;
        if (squared > 0.0 && (shortest->inside[i] || by_chance)) add_axis(&axes, axis, change);
    }
    return axes;
}

/* The normal n is offset made perpendicular to the axes q, which removes the rounding of the nearest points
 * where it would tilt the plane. It turns by n': n'.q = -n.q' keeps it so, n'.n = 0, and what freedom is left
 * follows the offset. A normal of 0 proves nothing. */
separating_plane separating_plane_find(const moving_features *f, const shortest_connection *shortest,
                                       int axes_max) {
    axis_list axes = find_axes(f, shortest, axes_max);
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

/* The least s > 0 at which a + b s + c s^2 is not above 0, or less; 0 when a is not above 0, INFINITY when
 * there is none. The computed discriminant is, but for a factor 1 + 2u, that of a quadratic whose c is off by
 * 2u, the result, but for 1 + 6u, that one's root: what is subtracted covers the latter, the caller the
 * former. */
static double first_loss(double a, double b, double c) {
    if (!(a > 0.0)) return 0.0;
    if (b >= 0.0 && c >= 0.0) return INFINITY;
    double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return INFINITY;
    double root = sqrt(discriminant);
    double s = b < 0.0 ? 2.0 * a / (root - b) : (b + root) / (-2.0 * c);
    return s > 0.0 ? s * (1.0 - 0x1p-49) : 0.0; /* 0 for NaN, which an edge of next to no length can give */
}

/* Along normal and turn: where the points are, and how fast they move. */
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
 * Error, for 0 <= s <= 1, in units of u = 2^-53: each component of x + s velocity is off by 3 + 2, so D + s W
 * by 10 sqrt 3 < 17.4; the coordinates themselves were rounded, by 1 each: 3.5 more. Dot products, with |x|
 * <= sqrt 3 and |velocity| <= 2 sqrt 3, are off by 3 each times that: in pairs 10.4 for x.n, 20.8 for
 * velocity.n; their differences round by 3.5 and 6.9. |n| <= 1 + 5u costs 5 d, and d < 3.5 where a > 0 can
 * be. Sums that make a: 7, that make b: 21. Together below 109; 128 is taken from a. With m, times |m|
 * s: 20.9 for the positions, 10.4 + 3.5 for x.m, 20.8 + 6.9 for velocity.m, 10.5 for d n.m, 10.5 for sums:
 * below 84; 128 |m| is taken from b. What is relative to c, the 2u of first_loss included, is below 16u
 * (|velocity.m| + d m^2). Underflow loses 2^-1070 at most. */
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
