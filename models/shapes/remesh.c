/* Meshes of implicit surfaces made even, with an exact number of triangles. */
#include "models/shapes/remesh.h"
#include "models/shapes/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    EVEN_ROUNDS = 8,
    FINAL_ROUNDS = 12,
    PASSES_MAX = 400,
    NETS_LEAST = 6000, /* fewer triangles may lose a limb */
    NETS_MOST = 12000,
    NARROW_NETS_MOST = 64000 /* where parts nearly touch */
};

typedef struct surface_edge {
    double squared_length;
    uint32_t half_edge;
} surface_edge;

static int by_length(const void *a, const void *b) {
    const surface_edge *e = a, *f = b;
    if (e->squared_length != f->squared_length) return e->squared_length < f->squared_length ? -1 : 1;
    return (e->half_edge > f->half_edge) - (e->half_edge < f->half_edge);
}

/* Returns all edges, the shortest first, to be freed. */
static surface_edge *sorted_edges(const surface *s, uint32_t *count) {
    surface_edge *edges = body_allocate((size_t)s->live_triangles * 3 / 2, sizeof *edges);
    *count = 0;
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3) && h < s->twins[h])
            edges[(*count)++] = (surface_edge){surface_squared_length(s, h), h};
    qsort(edges, *count, sizeof *edges, by_length);
    return edges;
}

static void edge_middle(const surface *s, const implicit *shape, uint32_t h, double scale, double at[3]) {
    const double *p = s->mesh.positions + (size_t)half_edge_from(s, h) * 3;
    const double *q = s->mesh.positions + (size_t)half_edge_to(s, h) * 3;
    for (int k = 0; k < 3; k++) at[k] = 0.5 * (p[k] + q[k]);
    implicit_project(shape, scale, at);
}

static void touch_neighbours(const surface *s, uint8_t *touched, uint32_t v) {
    uint32_t h = s->out[v];
    touched[v] = 1;
    do {
        touched[half_edge_to(s, h)] = 1;
        h = half_edge_turn(s, h);
    } while (h != s->out[v]);
}

/* Collapses up to `most` edges shorter than `below`, no two of them near each other; returns their number. */
static uint32_t collapse_shortest(surface *s, const implicit *shape, uint32_t most, double scale,
                                  double below) {
    uint32_t count, done = 0;
    surface_edge *edges = sorted_edges(s, &count);
    uint8_t *touched = body_allocate(s->mesh.vertex_count, sizeof *touched);
    for (uint32_t i = 0; i < count && done < most; i++) {
        uint32_t h = edges[i].half_edge;
        double at[3];
        if (edges[i].squared_length >= below * below) break;
        if (triangle_is_dead(s, h / 3)) continue;
        uint32_t a = half_edge_from(s, h), b = half_edge_to(s, h);
        if (touched[a] || touched[b] || surface_valence(s, a) + surface_valence(s, b) > 13) continue;
        edge_middle(s, shape, h, scale, at);
        if (!surface_collapse(s, h, at)) continue;
        touch_neighbours(s, touched, a);
        done++;
    }
    free(edges);
    free(touched);
    return done;
}

/* Splits up to `most` edges longer than `above`; returns their number. */
static uint32_t split_longest(surface *s, const implicit *shape, uint32_t most, double scale, double above) {
    uint32_t count, done = 0;
    surface_edge *edges = sorted_edges(s, &count);
    uint8_t *touched = body_allocate(s->mesh.vertex_count + count, sizeof *touched);
    for (uint32_t i = count; i-- > 0 && done < most;) {
        uint32_t h = edges[i].half_edge, a = half_edge_from(s, h), b = half_edge_to(s, h);
        double at[3];
        if (edges[i].squared_length <= above * above) break;
        if (touched[a] || touched[b]) continue;
        touch_neighbours(s, touched, a);
        touch_neighbours(s, touched, b);
        edge_middle(s, shape, h, scale, at);
        surface_split(s, h, at);
        touched[s->mesh.vertex_count - 1] = 1;
        done++;
    }
    free(edges);
    free(touched);
    return done;
}

static int excess_valence(uint32_t valence) {
    return (int)valence - 6;
}

/* Whether a flip brings the four valences nearer to 6. */
static bool evens_valences(const surface *s, uint32_t h) {
    uint32_t v[4] = {half_edge_from(s, h), half_edge_to(s, h), s->mesh.triangles[half_edge_previous(h)],
                     s->mesh.triangles[half_edge_previous(s->twins[h])]};
    int gain = 0;
    for (int i = 0; i < 4; i++) {
        int now = excess_valence(surface_valence(s, v[i])), then = now + (i < 2 ? -1 : 1);
        gain += now * now - then * then;
    }
    return gain > 0;
}

static double cotangent_at(const surface *s, uint32_t h) {
    const uint32_t *v = s->mesh.triangles;
    const double *x = s->mesh.positions, *p = x + (size_t)v[half_edge_previous(h)] * 3;
    const double *q = x + (size_t)v[h] * 3, *r = x + (size_t)v[half_edge_next(h)] * 3;
    double dot = 0.0, qq = 0.0, rr = 0.0;
    for (int k = 0; k < 3; k++) {
        dot += (q[k] - p[k]) * (r[k] - p[k]);
        qq += (q[k] - p[k]) * (q[k] - p[k]);
        rr += (r[k] - p[k]) * (r[k] - p[k]);
    }
    return dot / sqrt(fmax(qq * rr - dot * dot, 1e-300));
}

/* Whether the two angles opposite the edge add up to more than 180 degrees. */
static bool is_not_delaunay(const surface *s, uint32_t h) {
    return cotangent_at(s, h) + cotangent_at(s, s->twins[h]) < -1e-9;
}

static void flip_where(surface *s, bool (*wanted)(const surface *, uint32_t)) {
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3) && h < s->twins[h] && wanted(s, h)) surface_flip(s, h);
}

/* Moves vertices along the surface towards the mean of their neighbours. */
static void relax_vertices(surface *s, const implicit *shape, double length) {
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++) {
        if (s->out[v] == UINT32_MAX) continue;
        double sum[3] = {0.0, 0.0, 0.0}, count = 0.0;
        uint32_t h = s->out[v];
        do {
            const double *to = s->mesh.positions + (size_t)half_edge_to(s, h) * 3;
            for (int k = 0; k < 3; k++) sum[k] += to[k];
            count += 1.0;
            h = half_edge_turn(s, h);
        } while (h != s->out[v]);
        const double *p = s->mesh.positions + (size_t)v * 3;
        double normal[3], at[3], off = 0.0;
        surface_normal(s, v, normal);
        for (int k = 0; k < 3; k++) off += (sum[k] / count - p[k]) * normal[k];
        for (int k = 0; k < 3; k++) at[k] = sum[k] / count - off * normal[k];
        implicit_project(shape, length, at);
        surface_move(s, v, at);
    }
}

/* Returns the length of an edge when `count` equilateral triangles cover the same area. */
static double ideal_length(const surface *s, uint32_t count) {
    double sum = 0.0;
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3)) sum += surface_squared_length(s, h);
    return sqrt(sum / 3.0 / count);
}

/* Collapses or splits edges until the target is reached; false when not enough edges can be collapsed. */
static bool reach_count(surface *s, const implicit *shape, uint32_t target, double length) {
    for (int pass = 0; pass < PASSES_MAX && s->live_triangles != target; pass++) {
        uint32_t most = s->live_triangles / 50 + 1;
        if (s->live_triangles > target) {
            uint32_t surplus = (s->live_triangles - target) / 2;
            collapse_shortest(s, shape, most < surplus ? most : surplus, length, INFINITY);
        } else {
            uint32_t missing = (target - s->live_triangles) / 2;
            split_longest(s, shape, most < missing ? most : missing, length, 0.0);
        }
        flip_where(s, evens_valences);
    }
    return s->live_triangles == target;
}

static bool even_out(surface *s, const implicit *shape, uint32_t target, int rounds) {
    for (int round = 0; round < rounds; round++) {
        double length = ideal_length(s, target);
        uint32_t most = s->live_triangles / 8;
        split_longest(s, shape, most, length, 4.0 / 3.0 * length);
        collapse_shortest(s, shape, most, length, 0.75 * length);
        if (!reach_count(s, shape, target, length)) return false;
        flip_where(s, evens_valences);
        relax_vertices(s, shape, length);
    }
    return true;
}

bool body_remesh(body *b, const implicit *shape, uint32_t triangle_count) {
    surface s;
    surface_open(&s, b);
    bool good = triangle_count % 2 == 0;
    while (good && s.live_triangles < triangle_count / 2) {
        good = even_out(&s, shape, s.live_triangles, 2);
        surface_quarter(&s);
    }
    good = good && even_out(&s, shape, triangle_count, EVEN_ROUNDS);
    double length = ideal_length(&s, triangle_count);
    for (int round = 0; good && round < FINAL_ROUNDS; round++) {
        flip_where(&s, is_not_delaunay);
        relax_vertices(&s, shape, length);
    }
    flip_where(&s, is_not_delaunay);
    surface_close(&s, b);
    return good;
}

bool body_add_even_implicit(body *b, const implicit *shape, uint32_t triangle_count) {
    body nets = {0};
    double spacing = 0.1;
    uint32_t wanted = triangle_count < NETS_LEAST ? NETS_LEAST : triangle_count;
    uint32_t most = shape->narrow ? NARROW_NETS_MOST : NETS_MOST;
    while (wanted > most) wanted = (wanted + 3) / 4;
    for (int i = 0; i < 3; i++) {
        body_free(&nets);
        double taken = body_add_implicit(&nets, shape, spacing);
        /* The spacing asked for was refused, because sheets met, and this one is fine enough. */
        if (taken < spacing && nets.triangle_count >= wanted) break;
        spacing *= sqrt((double)nets.triangle_count / wanted); /* remeshing makes the count exact */
    }
    bool good = body_remesh(&nets, shape, triangle_count);
    if (good) body_append(b, &nets, (double[3]){0.0, 0.0, 0.0});
    body_free(&nets);
    return good;
}
