/* Slow motions that end in contact: of two bodies that come together, or of one in itself. */
#include "tests/support/culling/march.h"
#include "tests/support/random.h"

#include <math.h>
#include <string.h>

static double edge_of(const body *b) {
    double sum = 0.0;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const double *p = b->positions + (size_t)b->triangles[3 * t] * 3;
        const double *q = b->positions + (size_t)b->triangles[3 * t + 1] * 3;
        sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                    (p[2] - q[2]) * (p[2] - q[2]));
    }
    return sum / b->triangle_count;
}

static void measure_body(march *m) {
    const body *b = &m->bodies[0];
    m->edge = edge_of(b);
    for (int k = 0; k < 3; k++) {
        m->low[k] = INFINITY;
        m->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < b->vertex_count * 3; i++) {
        m->low[i % 3] = fmin(m->low[i % 3], b->positions[i]);
        m->high[i % 3] = fmax(m->high[i % 3], b->positions[i]);
    }
}

static bool has_corners(const uint32_t *t, uint32_t a, uint32_t b) {
    bool first = false, second = false;
    for (int i = 0; i < 3; i++) {
        first |= t[i] == a;
        second |= t[i] == b;
    }
    return first && second;
}

/* Finds the way of a vertex of the first triangle: below the middle of its opposite edge, then above the triangle behind. */
static void lay_path(march *m) {
    const body *b = &m->bodies[0];
    uint32_t u = b->triangles[1], w = b->triangles[2], behind = 1;
    while (!has_corners(b->triangles + 3 * (size_t)behind, u, w)) behind++;
    const uint32_t *t = b->triangles + 3 * (size_t)behind;
    uint32_t z = t[0] + t[1] + t[2] - u - w;
    m->drawn = b->triangles[0];
    for (size_t k = 0; k < 3; k++) {
        double middle = 0.5 * (b->positions[3 * (size_t)u + k] + b->positions[3 * (size_t)w + k]);
        double after = 0.85 * middle + 0.15 * b->positions[3 * (size_t)z + k];
        m->path[0][k] = b->positions[3 * (size_t)m->drawn + k];
        m->path[1][k] = 0.97 * middle;
        m->path[2][k] = 1.03 * after;
    }
}

march march_make(march_kind kind) {
    march m = {.kind = kind, .object_count = kind < MARCH_JAWS ? 2 : 1};
    for (uint32_t i = 0; i < m.object_count; i++) {
        body *b = &m.bodies[i];
        *b = kind == MARCH_JAWS ? body_of(BODY_LETTER_U, 0) : body_of(i == 0 ? BODY_SPHERE : BODY_TORUS, 320);
        m.objects[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        m.vertex_count += b->vertex_count;
        m.triangle_count += b->triangle_count;
    }
    if (kind == MARCH_LAND) m.objects[1].obstacle = true;
    measure_body(&m);
    if (kind == MARCH_FOLD) lay_path(&m);
    double low = INFINITY;
    for (uint32_t i = 0; m.object_count > 1 && i < m.bodies[1].vertex_count; i++)
        low = fmin(low, m.bodies[1].positions[3 * (size_t)i]);
    m.gap = m.object_count > 1 ? (low - m.high[0]) / m.edge : 0.0;
    return m;
}

void march_free(march *m) {
    for (uint32_t i = 0; i < m->object_count; i++) body_free(&m->bodies[i]);
}

static void place_first(const march *m, uint32_t vertex, double s, double p[3]) {
    double width = m->high[0] - m->low[0], angle = m->kind == MARCH_TURN ? 0.3 * s * m->edge / width : 0.0;
    double x = p[0], y = p[1];
    p[0] = cos(angle) * x - sin(angle) * y;
    p[1] = sin(angle) * x + cos(angle) * y;
    if (m->kind == MARCH_JAWS) {
        double middle = 0.5 * (m->low[0] + m->high[0]), up = (p[1] - m->low[1]) / (m->high[1] - m->low[1]);
        p[0] -= tanh(4.0 * (p[0] - middle) / width) * (m->closed + s) * m->edge * up * up;
    }
    if (m->kind == MARCH_FOLD && vertex == m->drawn) {
        int from = s < 0.5 ? 0 : 1;
        for (int k = 0; k < 3; k++)
            p[k] = m->path[from][k] + (2.0 * s - from) * (m->path[from + 1][k] - m->path[from][k]);
    }
}

void march_place(const march *m, double s, double *out) {
    for (uint32_t o = 0, at = 0; o < m->object_count; o++) {
        const body *b = &m->bodies[o];
        for (uint32_t v = 0; v < b->vertex_count; v++, at++) {
            double *p = out + 3 * (size_t)at;
            memcpy(p, b->positions + 3 * (size_t)v, sizeof(double[3]));
            if (o == 0)
                place_first(m, v, s, p);
            else
                p[0] -= (m->gap - 0.5 + s) * m->edge;
            for (int k = 0; k < 3; k++) p[k] += 0.5 * m->shake * m->edge * random_unit();
        }
    }
}
