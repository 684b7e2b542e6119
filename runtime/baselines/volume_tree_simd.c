/* Refit and search of a tree with volumes of one kind, compiled once per instruction set and for each kind. All k-DOPs
 * have the same code, with one to four vectors a volume.
 *
 * A vector holds eight least coordinates along directions that are the columns of three others. Opposite directions
 * stand in the same lane of two vectors, or four lanes apart in the last vector of the box and the 18-DOP:
 *
 *     box      x y z . | -x -y -z .
 *     14-DOP   x y z, 4 of the cube, .            -(the same)
 *     18-DOP   x y z, 5 of the faces              -(the same)    1 of the faces, . . . | -(the same)
 *     26-DOP   x y z, 4 of the cube, 1 of faces   -(the same)    5 of the faces, . . .   -(the same)
 *
 * So a volume around two is a minimum, and two are apart where a sum of opposite lanes is above 0. */
#include "runtime/baselines/volume_tree.h"
#include "runtime/bvh/bvh.h"
#include "src/core/simd.h"

enum { VECTORS_MAX = VOLUME_FLOATS_MAX / LANES, ORIGIN_SAMPLES = 64 };

#define OPPOSITE(v) __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3)

/* Rounding: docs/theory/trees.md. Bounds along axes and diagonals are widened by this many times 2^-24 of the reach. */
static const float slack_axes = 0x4p-24f, slack_diagonals = 0x10p-24f;

/* The bounds of a sphere: corners are off by sqrt 3 2^-24 of the reach, distances, which are up to 4 reaches, by 4 of their 2^-24;
 * centres of spheres around two by less than 8 of the reach. */
static const float slack_sphere = 0x20p-24f, one_and_more = 1.0f + 0x1p-20f;

/* Axes, diagonals of the cube, diagonals of its faces, and a filler, along which all volumes meet at 0. */
static const float directions[][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 1},  {1, 1, -1},
                                      {1, -1, 1}, {-1, 1, 1}, {1, 1, 0},  {1, -1, 0}, {1, 0, 1},
                                      {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {0, 0, 0}};
enum { FILLER = 13 };

/* Those of each kind in the order in which they are compared, the first eight and the others. */
static const uint8_t directions_of[VOLUME_KINDS][2][LANES] = {
    [VOLUME_BOX] = {{0, 1, 2, FILLER}},
    [VOLUME_KDOP14] = {{0, 1, 2, 3, 4, 5, 6, FILLER}},
    [VOLUME_KDOP18] = {{0, 1, 2, 7, 8, 9, 10, 11}, {12, FILLER, FILLER, FILLER}},
    [VOLUME_KDOP26] = {{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9, 10, 11, 12, FILLER, FILLER, FILLER}},
};

/* ---- records ----------------------------------------------------------------------------------------- */

/* As in the library, volumes are relative to the mean of some vertices, which moves linearly: what all vertices have in
 * common does not make them larger. Returns the reach, the largest coordinate. */
static float store_records(volume_tree *t, const double *x0, const double *x1) {
    const double *ends[2] = {x0, x1};
    double origins[2][3] = {{0}};
    uint32_t samples = t->vertex_count < ORIGIN_SAMPLES ? t->vertex_count : ORIGIN_SAMPLES;
    f32x8 reach = f32x8_all(0.0f);
    for (int e = 0; e < 2; e++) {
        for (uint32_t i = 0; i < samples; i++) {
            size_t at = (size_t)i * t->vertex_count / samples;
            for (int k = 0; k < 3; k++) origins[e][k] += ends[e][at * 3 + (size_t)k] / samples;
        }
    }
    for (uint32_t i = 0; i < t->vertex_count; i++) {
        f32x8 record = f32x8_all(0.0f);
        for (int e = 0; e < 2; e++) {
            for (int k = 0; k < 3; k++)
                record[4 * e + k] = (float)(ends[e][(size_t)i * 3 + (size_t)k] - origins[e][k]);
        }
        reach = f32x8_max(reach, f32x8_abs(record));
        f32x8_store(t->records[i], record);
    }
    float most = 0.0f;
    for (int i = 0; i < LANES; i++) most = reach[i] > most ? reach[i] : most;
    return most;
}

/* ---- k-DOPs ------------------------------------------------------------------------------------------ */

typedef struct kdop_plan {
    f32x8 x, y, z, slack;
} kdop_plan;

/* Lane i of vector v: which direction, and whether it is the opposite one. */
static void plan_directions(volume_kind kind, float reach, kdop_plan out[VECTORS_MAX]) {
    for (int v = 0; v < (int)kind; v++) {
        bool half = v == (int)kind - 1 && (int)kind % 2 == 1;
        for (int i = 0; i < LANES; i++) {
            const float *d = directions[directions_of[kind][v / 2][half ? i % 4 : i]];
            float sign = (half ? i >= 4 : v % 2 == 1) ? -1.0f : 1.0f;
            float length = fabsf(d[0]) + fabsf(d[1]) + fabsf(d[2]);
            out[v].x[i] = sign * d[0];
            out[v].y[i] = sign * d[1];
            out[v].z[i] = sign * d[2];
            out[v].slack[i] = length == 0.0f ? 0.0f : (length == 1.0f ? slack_axes : slack_diagonals) * reach;
        }
    }
}

static __attribute__((always_inline)) inline void enclose_vertices(volume_tree *t, int vectors,
                                                                   const kdop_plan *plan) {
    for (uint32_t i = 0; i < t->vertex_count; i++) {
        const float *r = t->records[i];
        for (int v = 0; v < vectors; v++) {
            const kdop_plan *p = &plan[v];
            f32x8 start = p->x * f32x8_all(r[0]) + p->y * f32x8_all(r[1]) + p->z * f32x8_all(r[2]);
            f32x8 end = p->x * f32x8_all(r[4]) + p->y * f32x8_all(r[5]) + p->z * f32x8_all(r[6]);
            f32x8_store(t->vertex_volumes + ((size_t)i * (size_t)vectors + (size_t)v) * LANES,
                        f32x8_min(start, end) - p->slack);
        }
    }
}

static __attribute__((always_inline)) inline void refit_kdops(volume_tree *t, int vectors,
                                                              const kdop_plan *plan) {
    size_t floats = (size_t)vectors * LANES;
    enclose_vertices(t, vectors, plan);
    for (uint32_t i = t->node_count; i-- > 0;) {
        const volume_node *n = &t->nodes[i];
        const uint32_t *corners = t->triangles[n->triangle];
        bool leaf = n->second == 0;
        const float *a = leaf ? t->vertex_volumes + corners[0] * floats : t->volumes + (i + 1) * floats;
        const float *b = leaf ? t->vertex_volumes + corners[1] * floats : t->volumes + n->second * floats;
        const float *c = leaf ? t->vertex_volumes + corners[2] * floats : b;
        for (int v = 0; v < vectors; v++) {
            f32x8 both = f32x8_min(f32x8_load(a + v * LANES), f32x8_load(b + v * LANES));
            if (leaf) both = f32x8_min(both, f32x8_load(c + v * LANES));
            f32x8_store(t->volumes + i * floats + (size_t)v * LANES, both);
        }
    }
}

static __attribute__((always_inline)) inline bool kdops_apart(const float *a, const float *b, int vectors) {
    f32x8 zero = f32x8_all(0.0f);
    for (int v = 0; v < vectors; v += 2) {
        f32x8 gaps;
        if (v + 1 == vectors) {
            f32x8 other = f32x8_load(b + v * LANES);
            gaps = f32x8_load(a + v * LANES) + OPPOSITE(other);
        } else {
            gaps = f32x8_max(f32x8_load(a + v * LANES) + f32x8_load(b + (v + 1) * LANES),
                             f32x8_load(a + (v + 1) * LANES) + f32x8_load(b + v * LANES));
        }
        if (f32x8_below(zero, gaps) != 0) return true;
    }
    return false;
}

/* ---- spheres ----------------------------------------------------------------------------------------- */

/* Around the middle of the box of the six corners. */
static void enclose_corners(const volume_tree *t, const uint32_t corners[3], float slack, float *out) {
    f32x8 records[3], low, high, farthest = f32x8_all(0.0f);
    for (int i = 0; i < 3; i++) records[i] = f32x8_load(t->records[corners[i]]);
    low = f32x8_min(f32x8_min(records[0], records[1]), records[2]);
    high = f32x8_max(f32x8_max(records[0], records[1]), records[2]);
    low = f32x8_min(low, OPPOSITE(low));
    high = f32x8_max(high, OPPOSITE(high));
    f32x8 centre = (low + high) * f32x8_all(0.5f);
    for (int i = 0; i < 3; i++) {
        f32x8 d = records[i] - centre, squares = d * d;
        squares += __builtin_shufflevector(squares, squares, 1, 0, 3, 2, 5, 4, 7, 6);
        squares += __builtin_shufflevector(squares, squares, 2, 3, 0, 1, 6, 7, 4, 5);
        farthest = f32x8_max(farthest, squares);
    }
    float square = farthest[0] > farthest[4] ? farthest[0] : farthest[4];
    for (int k = 0; k < 3; k++) out[k] = centre[k];
    out[3] = sqrtf(square) + slack;
}

static inline float distance_squared(const float *a, const float *b) {
    float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return x * x + y * y + z * z;
}

/* The smallest sphere around two: it is one of them, or touches both from outside. */
static void enclose_spheres(const float *a, const float *b, float slack, float *out) {
    float distance = sqrtf(distance_squared(a, b));
    const float *larger = a[3] < b[3] ? b : a, *smaller = a[3] < b[3] ? a : b;
    if ((distance + smaller[3]) * one_and_more <= larger[3]) {
        memcpy(out, larger, sizeof(float[SPHERE_FLOATS]));
        return;
    }
    float radius = 0.5f * (distance + a[3] + b[3]);
    float share = distance > 0.0f ? (radius - larger[3]) / distance : 0.0f;
    for (int k = 0; k < 3; k++) out[k] = larger[k] + share * (smaller[k] - larger[k]);
    out[3] = radius * one_and_more + slack;
}

static void refit_spheres(volume_tree *t, float reach) {
    float slack = slack_sphere * reach;
    for (uint32_t i = t->node_count; i-- > 0;) {
        const volume_node *n = &t->nodes[i];
        float *out = t->volumes + (size_t)i * SPHERE_FLOATS;
        if (n->second == 0)
            enclose_corners(t, t->triangles[n->triangle], slack, out);
        else
            enclose_spheres(out + SPHERE_FLOATS, t->volumes + (size_t)n->second * SPHERE_FLOATS, slack, out);
    }
}

static inline bool spheres_apart(const float *a, const float *b) {
    float reach = a[3] + b[3];
    return distance_squared(a, b) > reach * reach * one_and_more;
}

void SIMD_NAME(refit_volumes)(volume_tree *t, volume_kind kind, const double *x0, const double *x1);
void SIMD_NAME(refit_volumes)(volume_tree *t, volume_kind kind, const double *x0, const double *x1) {
    kdop_plan plan[VECTORS_MAX];
    float reach = store_records(t, x0, x1);
    if (kind != VOLUME_SPHERE) plan_directions(kind, reach, plan);
    switch (kind) {
    case VOLUME_BOX:
        refit_kdops(t, VOLUME_BOX, plan);
        break;
    case VOLUME_KDOP14:
        refit_kdops(t, VOLUME_KDOP14, plan);
        break;
    case VOLUME_KDOP18:
        refit_kdops(t, VOLUME_KDOP18, plan);
        break;
    case VOLUME_KDOP26:
        refit_kdops(t, VOLUME_KDOP26, plan);
        break;
    default:
        refit_spheres(t, reach);
    }
}

/* ---- search ------------------------------------------------------------------------------------------ */

static inline bool share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    bool shared = false;
    for (int i = 0; i < 3; i++) shared |= (a[i] == b[0]) | (a[i] == b[1]) | (a[i] == b[2]);
    return shared;
}

static inline void add_pair(const volume_tree *t, volume_search *s, const volume_node *a,
                            const volume_node *b) {
    if (share_vertex(t->triangles[a->triangle], t->triangles[b->triangle])) {
        s->adjacent++;
        if (s->keeps_adjacent == NULL || !s->keeps_adjacent[a->region]) return;
    }
    if (s->count == s->capacity) volume_search_grow(s);
    s->pairs[s->count][0] = a->triangle < b->triangle ? a->triangle : b->triangle;
    s->pairs[s->count++][1] = a->triangle < b->triangle ? b->triangle : a->triangle;
}

/* Can no triangle of a be the first to touch one of b? Only where they are of one region, and neither have both signs nor zero. */
static inline bool are_culled(const volume_node *a, const volume_node *b) {
    return a->region == b->region && (a->flags | b->flags) != ORIENTATION_ZERO;
}

/* Compares two nodes; puts them on the stack where something is to be compared below. */
static __attribute__((always_inline)) inline void compare_nodes(const volume_tree *t, volume_search *s,
                                                                uint32_t a, uint32_t b, size_t *stacked,
                                                                volume_kind kind) {
    const volume_node *first = &t->nodes[a], *second = &t->nodes[b];
    const float *volume_a = t->volumes + a * volume_floats(kind),
                *volume_b = t->volumes + b * volume_floats(kind);
    if (are_culled(first, second)) return;
    s->tests++;
    if (kind == VOLUME_SPHERE ? spheres_apart(volume_a, volume_b)
                              : kdops_apart(volume_a, volume_b, (int)kind))
        return;
    if (first->second == 0 && second->second == 0) {
        add_pair(t, s, first, second);
        return;
    }
    s->stack[*stacked][0] = a;
    s->stack[(*stacked)++][1] = b;
}

static __attribute__((always_inline)) inline void search_below(const volume_tree *t, volume_search *s,
                                                               size_t stacked, volume_kind kind) {
    while (stacked > 0) {
        uint32_t a = s->stack[--stacked][0], b = s->stack[stacked][1];
        const volume_node *first = &t->nodes[a], *second = &t->nodes[b];
        if (a == b) {
            if (first->second == 0 || first->sealed || are_culled(first, first)) continue;
            s->stack[stacked][0] = s->stack[stacked][1] = first->second;
            stacked++;
            s->stack[stacked][0] = s->stack[stacked][1] = a + 1;
            stacked++;
            compare_nodes(t, s, a + 1, first->second, &stacked, kind);
            continue;
        }
        uint32_t below_a[2] = {first->second == 0 ? a : a + 1, first->second},
                 below_b[2] = {second->second == 0 ? b : b + 1, second->second};
        for (int i = 0; i < (first->second == 0 ? 1 : 2); i++) {
            for (int j = 0; j < (second->second == 0 ? 1 : 2); j++)
                compare_nodes(t, s, below_a[i], below_b[j], &stacked, kind);
        }
    }
}

/* Each tree with itself, then with those behind it. */
static __attribute__((always_inline)) inline void search_trees(const volume_tree *t, volume_search *s,
                                                               volume_kind kind) {
    s->count = s->tests = s->adjacent = 0;
    s->out_of_memory = false;
    for (uint32_t r = 0; r < t->root_count; r++) {
        s->stack[0][0] = s->stack[0][1] = t->roots[r];
        search_below(t, s, 1, kind);
        for (uint32_t other = r + 1; other < t->root_count; other++) {
            size_t stacked = 0;
            compare_nodes(t, s, t->roots[r], t->roots[other], &stacked, kind);
            search_below(t, s, stacked, kind);
        }
    }
}

void SIMD_NAME(search_volumes)(const volume_tree *t, volume_kind kind, volume_search *s);
void SIMD_NAME(search_volumes)(const volume_tree *t, volume_kind kind, volume_search *s) {
    switch (kind) {
    case VOLUME_BOX:
        search_trees(t, s, VOLUME_BOX);
        break;
    case VOLUME_KDOP14:
        search_trees(t, s, VOLUME_KDOP14);
        break;
    case VOLUME_KDOP18:
        search_trees(t, s, VOLUME_KDOP18);
        break;
    case VOLUME_KDOP26:
        search_trees(t, s, VOLUME_KDOP26);
        break;
    default:
        search_trees(t, s, VOLUME_SPHERE);
    }
}

const volume_kernels SIMD_NAME(volume_kernels) = {SIMD_NAME(refit_volumes), SIMD_NAME(search_volumes)};
