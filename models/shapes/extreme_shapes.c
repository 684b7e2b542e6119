/* Makes the shapes. */
#include "models/shapes/extreme_shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double turn = 6.283185307179586;

static const char *const kind_names[EXTREME_KINDS] = {"fan",  "cylinder", "bipyramid", "comb",   "needles",
                                                      "book", "slivers",  "spire",     "sheets", "pile"};

const char *extreme_kind_name(extreme_kind kind) {
    return kind_names[kind];
}

bool extreme_kind_from_name(const char *name, extreme_kind *out) {
    for (int kind = 0; kind < EXTREME_KINDS; kind++) {
        if (strcmp(name, kind_names[kind]) != 0) continue;
        *out = (extreme_kind)kind;
        return true;
    }
    return false;
}

/* ---- parts ----------------------------------------------------------------------------------------------- */

static uint32_t add_vertex(extreme_shape *s, double x, double y, double z) {
    double *p = s->x0 + 3 * (size_t)s->vertex_count;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return s->vertex_count++;
}

static void add_triangle(extreme_shape *s, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *t = s->triangles + 3 * (size_t)s->triangle_count++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

/* Two triangles; a, b, c, d go around. */
static void add_square(extreme_shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_triangle(s, a, b, c);
    add_triangle(s, a, c, d);
}

/* Returns the first vertex of a ring of radius 1. */
static uint32_t add_ring(extreme_shape *s, uint32_t count, double z) {
    const uint32_t first = s->vertex_count;
    for (uint32_t i = 0; i < count; i++) add_vertex(s, cos(turn * i / count), sin(turn * i / count), z);
    return first;
}

/* Triangles between a ring and a new vertex above or below its middle; below: they are turned around. */
static void add_cone(extreme_shape *s, uint32_t ring, uint32_t count, double z, bool below) {
    const uint32_t apex = add_vertex(s, 0.0, 0.0, z);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t here = ring + i, next = ring + (i + 1) % count;
        add_triangle(s, apex, below ? next : here, below ? here : next);
    }
}

/* ---- shapes ---------------------------------------------------------------------------------------------- */

static void make_fan(extreme_shape *s, uint32_t count) {
    add_cone(s, add_ring(s, count, 0.0), count, 0.0, false);
}

static void make_cylinder(extreme_shape *s, uint32_t count) {
    const uint32_t around = count / 4, low = add_ring(s, around, -1.0), high = add_ring(s, around, 1.0);
    add_cone(s, low, around, -1.0, true);
    add_cone(s, high, around, 1.0, false);
    for (uint32_t i = 0; i < around; i++) {
        const uint32_t next = (i + 1) % around;
        add_square(s, low + i, low + next, high + next, high + i);
    }
}

static void make_bipyramid(extreme_shape *s, uint32_t count) {
    const uint32_t ring = add_ring(s, count / 2, 0.0);
    add_cone(s, ring, count / 2, 1.0, false);
    add_cone(s, ring, count / 2, -1.0, true);
}

/* Four corners of the profile a tooth, front and back: below the spine, at its root and at both ends of its tip. 14 triangles a tooth. */
static void make_comb(extreme_shape *s, uint32_t count) {
    const uint32_t teeth = count / 14;
    for (uint32_t i = 0; i <= teeth; i++)
        for (int back = 0; back < 2; back++) {
            const double x = (double)i / teeth, z = 0.1 * back;
            add_vertex(s, x, -0.1, z);
            add_vertex(s, x, 0.0, z);
            add_vertex(s, x + 0.25 / teeth, 1.0, z);
            add_vertex(s, x + 0.5 / teeth, 0.0, z);
        }
    for (uint32_t i = 0; i < teeth; i++) {
        const uint32_t f = 8 * i, b = f + 4, g = f + 8, c = f + 12;
        add_triangle(s, f + 1, f + 3, f + 2); /* the tooth */
        add_triangle(s, b + 1, b + 2, b + 3);
        add_square(s, f + 1, f + 2, b + 2, b + 1);
        add_square(s, f + 2, f + 3, b + 3, b + 2);
        add_triangle(s, f, f + 3, f + 1); /* the spine */
        add_triangle(s, b, b + 1, b + 3);
        add_square(s, f, g, g + 1, f + 3);
        add_square(s, b, b + 3, c + 1, c);
        add_square(s, f + 3, g + 1, c + 1, b + 3);
        add_square(s, f, b, c, g);
    }
    const uint32_t e = 8 * teeth;
    add_square(s, 0, 1, 5, 4);
    add_square(s, e, e + 4, e + 5, e + 1);
}

/* As the combs of large_inputs.py, but 1 wide. */
static void make_needles(extreme_shape *s, uint32_t count) {
    const uint32_t needles = count / 4;
    const double wide = 1.0 / needles;
    for (uint32_t i = 0; i < needles; i++) {
        const uint32_t n = add_vertex(s, -wide, i * wide, 0.0);
        add_vertex(s, 1.0, (i + 0.25) * wide, 0.0);
        add_vertex(s, 1.0, (i - 0.25) * wide, 0.0);
        add_vertex(s, 1.0 + wide, i * wide, 0.0);
        add_triangle(s, n, n + 2, n + 1);
        add_triangle(s, n + 1, n + 2, n + 3);
        if (i + 1 < needles) {
            add_triangle(s, n + 1, n + 3, n + 7);
            add_triangle(s, n + 1, n + 7, n + 6);
        }
    }
}

static void make_book(extreme_shape *s, uint32_t count) {
    const uint32_t low = add_vertex(s, 0.0, 0.0, -1.0), high = add_vertex(s, 0.0, 0.0, 1.0);
    const uint32_t ring = add_ring(s, count, 0.0);
    for (uint32_t i = 0; i < count; i++) add_triangle(s, low, high, ring + i);
}

static void make_slivers(extreme_shape *s, uint32_t count) {
    const double apart = 1.0 / count, wide = 0.25 * apart;
    for (uint32_t i = 0; i < count; i++) {
        const double at = i * apart;
        const uint32_t n = add_vertex(s, at, -at, 0.0);
        add_vertex(s, at + wide, -at - wide, 0.0);
        add_vertex(s, at + 1.0, -at + 1.0, 1.0);
        add_triangle(s, n, n + 1, n + 2);
    }
}

static void make_spire(extreme_shape *s, uint32_t count) {
    const uint32_t ring = add_ring(s, count / 2, 0.0);
    add_cone(s, ring, count / 2, 1000.0, false);
    add_cone(s, ring, count / 2, 0.0, true);
}

static void make_sheets(extreme_shape *s, uint32_t count) {
    const uint32_t side = (uint32_t)sqrt(count / 4.0);
    for (int sheet = 0; sheet < 2; sheet++) {
        const uint32_t first = s->vertex_count;
        for (uint32_t i = 0; i <= side; i++)
            for (uint32_t j = 0; j <= side; j++)
                add_vertex(s, (double)i / side, (double)j / side, 1e-9 * sheet);
        for (uint32_t i = 0; i < side; i++)
            for (uint32_t j = 0; j < side; j++) {
                const uint32_t a = first + i * (side + 1) + j, b = a + side + 1;
                add_square(s, a, b, b + 1, a + 1);
            }
    }
}

static void make_pile(extreme_shape *s, uint32_t count) {
    for (uint32_t i = 0; i < count / 2; i++) {
        const double z = 1e-9 * i;
        const uint32_t n = add_vertex(s, 0.0, 0.0, z);
        add_vertex(s, 1.0, 0.0, z);
        add_vertex(s, 1.0, 1.0, z);
        add_vertex(s, 0.0, 1.0, z);
        add_square(s, n, n + 1, n + 2, n + 3);
    }
}

/* ---- one of them ----------------------------------------------------------------------------------------- */

static void (*const makers[EXTREME_KINDS])(extreme_shape *, uint32_t) = {
    make_fan,  make_cylinder, make_bipyramid, make_comb,   make_needles,
    make_book, make_slivers,  make_spire,     make_sheets, make_pile};

/* They bend, as a whole, by a part of what lies between neighbours; sheets stay in their order. */
static void move_shape(extreme_shape *s, extreme_kind kind) {
    const bool flat = kind == EXTREME_SHEETS || kind == EXTREME_PILE;
    const double way = flat ? 1e-3 : 0.1 / s->triangle_count;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double *p = s->x0 + 3 * (size_t)v;
        double *q = s->x1 + 3 * (size_t)v;
        q[0] = p[0] + way * p[1];
        q[1] = p[1] - way * p[0];
        q[2] = p[2] + (flat ? way : way * sin(p[0] + 2.0 * p[1]));
    }
}

static void *allocate_room(size_t count, size_t size) {
    void *room = calloc(count, size);
    if (room != NULL) return room;
    fputs("extremes: out of memory\n", stderr);
    exit(1);
}

extreme_shape extreme_shape_make(extreme_kind kind, uint32_t triangle_count) {
    extreme_shape s = {0};
    const size_t room = 3 * (size_t)triangle_count + 1000;
    s.triangles = allocate_room(room, sizeof(uint32_t[3]));
    s.x0 = allocate_room(room, sizeof(double[3]));
    s.x1 = allocate_room(room, sizeof(double[3]));
    makers[kind](&s, triangle_count);
    move_shape(&s, kind);
    return s;
}

void extreme_shape_free(extreme_shape *shape) {
    free(shape->triangles);
    free(shape->x0);
    free(shape->x1);
    *shape = (extreme_shape){0};
}
