/* Polygons that move in a plane across any axis, and a reference in long double that looks whether they stay simple. */
#include "tests/support/baselines/moving_polygon.h"

#include <math.h>
#include <string.h>

enum { MOMENTS = 128 };

void polygon_choose_axis(polygon *p, random_stream *random) {
    double length = 0.0, a[3];
    for (int k = 0; k < 3; k++) {
        a[k] = stream_between(random, -1.0, 1.0);
        length += a[k] * a[k];
    }
    for (int k = 0; k < 3; k++) p->frame[2][k] = p->axis[k] = (float)(a[k] / sqrt(length));
    double *r = p->frame[0], *u = p->frame[1], *n = p->frame[2];
    r[0] = fabs(n[0]) > 0.5 ? -n[1] : 0.0;
    r[1] = fabs(n[0]) > 0.5 ? n[0] : -n[2];
    r[2] = fabs(n[0]) > 0.5 ? 0.0 : n[1];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int k = 0; k < 3; k++) r[k] /= length;
    for (int k = 0; k < 3; k++) u[k] = n[(k + 1) % 3] * r[(k + 2) % 3] - n[(k + 2) % 3] * r[(k + 1) % 3];
}

void polygon_place(const polygon *p, double *x, uint32_t corner, double right, double up, double height) {
    for (int k = 0; k < 3; k++)
        x[corner * 3 + (uint32_t)k] = right * p->frame[0][k] + up * p->frame[1][k] + height * p->frame[2][k];
}

polygon polygon_at_rest(const double (*corners)[2], uint32_t count) {
    polygon p = {.count = count,
                 .frame = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                 .axis = {0.0f, 0.0f, 1.0f}};
    for (uint32_t i = 0; i < count; i++) polygon_place(&p, p.x0, i, corners[i][0], corners[i][1], 0.0);
    memcpy(p.x1, p.x0, sizeof p.x1);
    return p;
}

/* ---- the reference ---- */

typedef struct point {
    long double right, up;
} point;

static void points_at(const polygon *p, long double t, point out[CORNERS_MAX]) {
    for (uint32_t i = 0; i < p->count; i++) {
        out[i] = (point){0.0L, 0.0L};
        for (uint32_t k = 0; k < 3; k++) {
            long double x = (1.0L - t) * (long double)p->x0[i * 3 + k] + t * (long double)p->x1[i * 3 + k];
            out[i].right += (x - (long double)p->x0[k]) * (long double)p->frame[0][k];
            out[i].up += (x - (long double)p->x0[k]) * (long double)p->frame[1][k];
        }
    }
}

static long double side_of_line(point a, point b, point c) {
    return (b.right - a.right) * (c.up - a.up) - (b.up - a.up) * (c.right - a.right);
}

static long double position_along(point a, point b, point c) {
    return (b.right - a.right) * (c.right - a.right) + (b.up - a.up) * (c.up - a.up);
}

static bool lies_on(point c, point a, point b) {
    return side_of_line(a, b, c) == 0.0L && position_along(c, a, b) <= 0.0L;
}

static bool segments_meet(point a, point b, point c, point d) {
    if (lies_on(a, c, d) || lies_on(b, c, d) || lies_on(c, a, b) || lies_on(d, a, b)) return true;
    return side_of_line(a, b, c) * side_of_line(a, b, d) < 0.0L &&
           side_of_line(c, d, a) * side_of_line(c, d, b) < 0.0L;
}

static bool is_simple(const point *p, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        point a = p[i], b = p[(i + 1) % n], c = p[(i + 2) % n];
        if (side_of_line(b, a, c) == 0.0L && position_along(b, a, c) >= 0.0L) return false;
        for (uint32_t j = i + 2; j < n; j++) {
            if ((j + 1) % n != i && segments_meet(a, b, p[j], p[(j + 1) % n])) return false;
        }
    }
    return true;
}

bool polygon_stays_simple(const polygon *p) {
    point points[CORNERS_MAX];
    for (int i = 0; i <= MOMENTS; i++) {
        points_at(p, (long double)i / MOMENTS, points);
        if (!is_simple(points, p->count)) return false;
    }
    return true;
}
