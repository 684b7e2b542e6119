/* Boxes of equal squares, flat and folded. */
#include "models/shapes/bodies.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The surface of a block of size[0] x size[1] x size[2] cells. Vertices are numbered layer by layer along
 * the last axis: the first and the last layer are full, the others have only their rim. */
typedef struct block {
    uint32_t size[3], first;
} block;

static uint32_t layer_full(const block *k) {
    return (k->size[0] + 1) * (k->size[1] + 1);
}

static uint32_t rim_index(const block *k, uint32_t x, uint32_t y) {
    if (y == 0) return x;
    if (x == k->size[0]) return x + y;
    if (y == k->size[1]) return k->size[0] + y + (k->size[0] - x);
    return 2 * k->size[0] + k->size[1] + (k->size[1] - y);
}

static uint32_t block_vertex(const block *k, const uint32_t at[3]) {
    uint32_t flat = at[1] * (k->size[0] + 1) + at[0], rim = 2 * (k->size[0] + k->size[1]);
    if (at[2] == 0) return k->first + flat;
    uint32_t before = k->first + layer_full(k) + (at[2] - 1) * rim;
    return before + (at[2] == k->size[2] ? flat : rim_index(k, at[0], at[1]));
}

/* Adds one side of the block, normal to an axis. Its diagonals alternate. */
static void add_side(body *b, const block *k, uint32_t axis, bool upper) {
    uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3, at[3], corner[4];
    for (uint32_t i = 0; i < k->size[u]; i++) {
        for (uint32_t j = 0; j < k->size[v]; j++) {
            for (uint32_t c = 0; c < 4; c++) {
                at[axis] = upper ? k->size[axis] : 0;
                at[u] = i + (c == 1 || c == 2);
                at[v] = j + (c >= 2);
                corner[upper ? c : 3 - c] = block_vertex(k, at);
            }
            uint32_t first = (i + j) % 2;
            body_add_triangle(b, corner[first], corner[first + 1], corner[first + 2]);
            body_add_triangle(b, corner[first], corner[first + 2], corner[(first + 3) % 4]);
        }
    }
}

/* Adds the block with its vertices in the order of block_vertex, at the whole numbers of the cells. */
static void add_block(body *b, const uint32_t size[3]) {
    block k = {{size[0], size[1], size[2]}, b->vertex_count};
    for (uint32_t z = 0; z <= size[2]; z++) {
        bool full = z == 0 || z == size[2];
        for (uint32_t y = 0; full && y <= size[1]; y++)
            for (uint32_t x = 0; x <= size[0]; x++) body_add_vertex(b, x, y, z);
        if (full) continue;
        for (uint32_t x = 0; x <= size[0]; x++) body_add_vertex(b, x, 0, z);
        for (uint32_t y = 1; y <= size[1]; y++) body_add_vertex(b, size[0], y, z);
        for (uint32_t x = size[0]; x-- > 0;) body_add_vertex(b, x, size[1], z);
        for (uint32_t y = size[1]; y-- > 1;) body_add_vertex(b, 0, y, z);
    }
    for (uint32_t axis = 0; axis < 3; axis++) {
        add_side(b, &k, axis, false);
        add_side(b, &k, axis, true);
    }
}

void add_cube(body *b, uint32_t n) {
    uint32_t first = b->vertex_count;
    add_block(b, (uint32_t[3]){n, n, n});
    for (size_t i = (size_t)first * 3; i < (size_t)b->vertex_count * 3; i++)
        b->positions[i] = b->positions[i] * 2.0 / n - 1.0;
}

/* The middle surface of the folded slab: three panels one above the other, joined by half circles. */
static const double panel = 2.0, width = 1.6, thickness = 0.16, fold_radius = 0.20;

static double slab_length(void) {
    return 3.0 * panel + 2.0 * pi * fold_radius;
}

static void slab_size(uint32_t n, uint32_t size[3]) {
    double cell = slab_length() / n;
    size[0] = n;
    size[1] = (uint32_t)(width / cell + 0.5);
    size[2] = (uint32_t)fmax(thickness / cell + 0.5, 1.0);
}

uint32_t slab_triangles(uint32_t n) {
    uint32_t size[3];
    slab_size(n, size);
    return 4 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
}

/* Finds the point of the middle surface after a length s, in x and z, and the direction up from it. */
static void fold_profile(double s, double centre[2], double up[2]) {
    double bend = pi * fold_radius;
    for (int k = 0; k < 3; k++) {
        double way = k % 2 == 0 ? 1.0 : -1.0, level = 2.0 * fold_radius * (k - 1);
        if (k == 2 || s <= panel) {
            memcpy(centre, (double[2]){way * (s - 0.5 * panel), level}, 2 * sizeof *centre);
            memcpy(up, (double[2]){0.0, way}, 2 * sizeof *up);
            return;
        }
        s -= panel;
        if (s <= bend) {
            double c = cos(s / fold_radius), d = sin(s / fold_radius);
            centre[0] = way * (0.5 * panel + fold_radius * d);
            centre[1] = level + fold_radius * (1.0 - c);
            memcpy(up, (double[2]){-d, way * c}, 2 * sizeof *up);
            return;
        }
        s -= bend;
    }
}

void add_slab(body *b, uint32_t n) {
    uint32_t size[3], first = b->vertex_count;
    slab_size(n, size);
    add_block(b, size);
    for (uint32_t v = first; v < b->vertex_count; v++) {
        double *p = b->positions + (size_t)v * 3, centre[2], up[2];
        double s = p[0] / size[0] * slab_length();
        double height = thickness * (p[2] / size[2] - 0.5);
        fold_profile(s, centre, up);
        p[0] = centre[0] + height * up[0];
        p[1] = width * (p[1] / size[1] - 0.5);
        p[2] = centre[1] + height * up[1];
    }
}
