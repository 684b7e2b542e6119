/* Small meshes with integer coordinates, so few of them that everything degenerates, how they are moved, and their
 * piercings and winding numbers by brute force: all by polynomials in epsilon. */
#include "tests/support/intersections/grid_scene.h"

#include "cscd/cscd.h"
#include "src/mesh/predicates.h"
#include "tests/support/test.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static void add_term(epsilon_polynomial *p, uint64_t power, int64_t coefficient) {
    int i = 0;
    while (i < p->count && p->terms[i].power < power) i++;
    if (i < p->count && p->terms[i].power == power) {
        p->terms[i].coefficient += coefficient;
        if (p->terms[i].coefficient != 0) return;
        for (p->count--; i < p->count; i++) p->terms[i] = p->terms[i + 1];
        return;
    }
    if (coefficient == 0) return;
    assert(p->count < EPSILON_TERMS);
    for (int j = p->count++; j > i; j--) p->terms[j] = p->terms[j - 1];
    p->terms[i].power = power;
    p->terms[i].coefficient = coefficient;
}

void epsilon_add(epsilon_polynomial *sum, const epsilon_polynomial *p, int factor, uint64_t power) {
    for (int i = 0; i < p->count; i++)
        add_term(sum, p->terms[i].power + power, factor * p->terms[i].coefficient);
}

static void multiply_polynomials(const epsilon_polynomial *a, const epsilon_polynomial *b,
                                 epsilon_polynomial *out) {
    out->count = 0;
    for (int i = 0; i < a->count; i++) {
        for (int j = 0; j < b->count; j++)
            add_term(out, a->terms[i].power + b->terms[j].power,
                     a->terms[i].coefficient * b->terms[j].coefficient);
    }
}

void epsilon_move(grid_point p, epsilon_point *out) {
    assert(p.name < EPSILON_NAMES);
    for (uint32_t k = 0; k < 3; k++) {
        out->x[k].count = 0;
        add_term(&out->x[k], 0, p.x[k]);
        add_term(&out->x[k], UINT64_C(1) << (3 * p.name + k), 1);
    }
}

/* to - from in one coordinate. */
static void subtract_coordinates(const epsilon_point *from, const epsilon_point *to, int k,
                                 epsilon_polynomial *out) {
    out->count = 0;
    epsilon_add(out, &to->x[k], 1, 0);
    epsilon_add(out, &from->x[k], -1, 0);
}

void epsilon_orient_along(const epsilon_point *const p[3], int axis, epsilon_polynomial *out) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    epsilon_polynomial u, v, product;
    subtract_coordinates(p[0], p[1], x, &u);
    subtract_coordinates(p[0], p[2], y, &v);
    multiply_polynomials(&u, &v, out);
    subtract_coordinates(p[0], p[1], y, &u);
    subtract_coordinates(p[0], p[2], x, &v);
    multiply_polynomials(&u, &v, &product);
    epsilon_add(out, &product, -1, 0);
}

void epsilon_orient3d(const epsilon_point *const p[4], epsilon_polynomial *out) {
    epsilon_polynomial turn, along, part;
    out->count = 0;
    for (int axis = 0; axis < 3; axis++) {
        epsilon_orient_along(p, axis, &turn);
        subtract_coordinates(p[0], p[3], axis, &along);
        multiply_polynomials(&turn, &along, &part);
        epsilon_add(out, &part, 1, 0);
    }
}

void grid_orient3d(const grid_point p[4], epsilon_polynomial *out) {
    epsilon_point points[4];
    for (int i = 0; i < 4; i++) epsilon_move(p[i], &points[i]);
    epsilon_orient3d((const epsilon_point *const[4]){&points[0], &points[1], &points[2], &points[3]}, out);
}

void grid_orient_along(const grid_point p[3], int axis, epsilon_polynomial *out) {
    epsilon_point points[3];
    for (int i = 0; i < 3; i++) epsilon_move(p[i], &points[i]);
    epsilon_orient_along((const epsilon_point *const[3]){&points[0], &points[1], &points[2]}, axis, out);
}

int epsilon_sign(const epsilon_polynomial *p) {
    if (p->count == 0) return 0;
    return p->terms[0].coefficient > 0 ? 1 : -1;
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

static void add_octahedron(mesh_shape *s) {
    for (uint32_t i = 0; i < 4; i++) {
        shape_add_triangle(s, i, (i + 1) % 4, 4);
        shape_add_triangle(s, (i + 1) % 4, i, 5);
    }
}

/* Four rings of four; the last one is joined to the first one in reverse order. */
static void add_klein_bottle(mesh_shape *s) {
    for (uint32_t i = 0; i < 4; i++) {
        for (uint32_t j = 0; j < 4; j++) {
            uint32_t next = (j + 1) % 4, above = (i + 1) * 4;
            if (i < 3)
                shape_add_quad(s, i * 4 + j, i * 4 + next, above + next, above + j);
            else
                shape_add_quad(s, i * 4 + j, i * 4 + next, 3 - next, 3 - j);
        }
    }
}

static void add_soup(random_stream *random, mesh_shape *s) {
    for (int i = 0; i < 8; i++) {
        uint32_t a = stream_below(random, 9), b = (a + 1 + stream_below(random, 8)) % 9, c;
        do c = stream_below(random, 9);
        while (c == a || c == b);
        shape_add_triangle(s, a, b, c);
    }
}

static void make_shapes(grid_family family, random_stream *random, grid_scene *s) {
    mesh_shape *first = &s->shapes[0], *second = &s->shapes[1];
    switch (family) {
    case GRID_TWO_BOXES:
        shape_add_cube(first);
        shape_add_cube(second);
        break;
    case GRID_BOX_AND_OCTAHEDRON:
        shape_add_cube(first);
        add_octahedron(second);
        break;
    case GRID_PILLOW:
        shape_add_triangle(first, 0, 1, 2);
        shape_add_triangle(first, 0, 2, 1);
        add_octahedron(second);
        break;
    case GRID_SEWN:
        shape_add_grid(first, 2, 2, false, false);
        shape_add_grid(second, 2, 2, false, false);
        break;
    case GRID_OCTAHEDRON:
        add_octahedron(first);
        break;
    case GRID_TORUS:
        shape_add_grid(first, 3, 4, true, true);
        break;
    case GRID_SHEET:
        shape_add_grid(first, 3, 3, false, false);
        break;
    case GRID_MOEBIUS_STRIP:
        shape_add_moebius_strip(first, 7);
        break;
    case GRID_KLEIN_BOTTLE:
        add_klein_bottle(first);
        break;
    case GRID_SOUP:
        add_soup(random, first);
        break;
    default:
        shape_add_tetrahedron(first, 0, 1, 2, 3);
        shape_add_tetrahedron(second, 0, 1, 2, 3);
    }
}

/* Vertex v of a cube is a corner of a random box, any other one lies anywhere. */
static void place_vertices(grid_family family, random_stream *random, grid_scene *s) {
    uint32_t width = 2 + stream_below(random, 4), first = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        bool box = family == GRID_TWO_BOXES || (family == GRID_BOX_AND_OCTAHEDRON && i == 0);
        uint32_t low[3], size[3];
        for (int k = 0; k < 3; k++) {
            low[k] = stream_below(random, width);
            size[k] = 1 + stream_below(random, width);
        }
        for (uint32_t v = 0; v < s->shapes[i].vertex_count; v++) {
            for (uint32_t k = 0; k < 3; k++)
                s->positions[(first + v) * 3 + k] =
                    box ? low[k] + (v >> k & 1) * size[k] : stream_below(random, width + 1);
        }
        first += s->shapes[i].vertex_count;
    }
}

/* The first row of the second sheet is sewn to that of the first. */
static void sew_sheets(grid_scene *s) {
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t other = s->shapes[0].vertex_count + i;
        s->names[other] = i;
        memcpy(s->positions + (size_t)other * 3, s->positions + (size_t)i * 3, sizeof(double[3]));
    }
}

void grid_scene_make(grid_family family, uint64_t seed, grid_scene *out) {
    random_stream random = stream_start((uint64_t)family * 1000 + seed);
    cscd_object_desc descs[GRID_OBJECTS];
    memset(out, 0, sizeof *out);
    make_shapes(family, &random, out);
    out->object_count = out->shapes[1].triangle_count > 0 ? 2 : 1;
    for (uint32_t i = 0; i < out->object_count; i++) {
        const mesh_shape *of = &out->shapes[i];
        descs[i] = cscd_object_of_triangles(of->vertex_count, of->triangle_count, of->triangles[0]);
        out->vertex_count += of->vertex_count;
    }
    assert_true(out->vertex_count <= EPSILON_NAMES);
    place_vertices(family, &random, out);
    for (uint32_t v = 0; v < out->vertex_count; v++) out->names[v] = v;
    if (family == GRID_SEWN) sew_sheets(out);
    expect_ok(cscd_context_create(NULL, &out->context));
    expect_ok(cscd_mesh_create(out->context, descs, out->object_count, &out->mesh));
    out->surface = (named_surface){
        .mesh = out->mesh, .positions = out->positions, .names = family == GRID_SEWN ? out->names : NULL};
}

void grid_scene_free(grid_scene *s) {
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

grid_point grid_scene_point(const grid_scene *s, uint32_t vertex) {
    const double *x = s->positions + (size_t)vertex * 3;
    return (grid_point){{(int)x[0], (int)x[1], (int)x[2]}, s->names[vertex]};
}

size_t grid_scene_pairs(const grid_scene *s, cscd_intersection *out) {
    size_t count = 0;
    for (uint32_t a = 0; a < s->mesh->triangle_count; a++) {
        for (uint32_t b = a + 1; b < s->mesh->triangle_count; b++) {
            const uint32_t *p = s->mesh->triangles[a], *q = s->mesh->triangles[b];
            bool intersect = s->surface.names == NULL
                                 ? triangles_intersect(p, q, s->positions)
                                 : triangles_intersect_by_names(p, q, s->names, s->positions);
            if (intersect) out[count++] = (cscd_intersection){.a = a, .b = b};
        }
    }
    return count;
}

/* ---- their curves -------------------------------------------------------------------------------------- */

void traced_scene_make(grid_family family, uint64_t seed, traced_scene *out) {
    grid_scene_make(family, seed, &out->scene);
    out->joiner = (curve_joiner){.context = out->scene.context};
    size_t count = grid_scene_pairs(&out->scene, out->pairs);
    expect_ok(curve_joiner_run(&out->joiner, &out->scene.surface, out->pairs, count, &out->curves));
}

void traced_scene_free(traced_scene *t) {
    curve_joiner_free(&t->joiner);
    grid_scene_free(&t->scene);
}

/* ---- piercings by brute force -------------------------------------------------------------------------- */

/* The edge's points, then the triangle's. */
static void load_points(const grid_scene *s, surface_piercing piercing, grid_point out[5]) {
    const uint32_t *edge = s->mesh->edges[piercing.edge], *triangle = s->mesh->triangles[piercing.triangle];
    for (int i = 0; i < 5; i++) out[i] = grid_scene_point(s, i < 2 ? edge[i] : triangle[i - 2]);
}

static void orient_points(const grid_point p[5], int a, int b, int c, int d, epsilon_polynomial *out) {
    const grid_point corners[4] = {p[a], p[b], p[c], p[d]};
    grid_orient3d(corners, out);
}

static int side_of(const grid_point p[5], int a, int b, int c, int d) {
    epsilon_polynomial value;
    orient_points(p, a, b, c, d, &value);
    return epsilon_sign(&value);
}

bool piercing_oracle_happens(const grid_scene *s, surface_piercing piercing) {
    grid_point p[5];
    load_points(s, piercing, p);
    for (int i = 0; i < 5; i++) {
        for (int j = i + 1; j < 5; j++) {
            if (p[i].name == p[j].name) return false;
        }
    }
    if (side_of(p, 2, 3, 4, 0) == side_of(p, 2, 3, 4, 1)) return false;
    int turn = side_of(p, 0, 1, 2, 3);
    return turn == side_of(p, 0, 1, 3, 4) && turn == side_of(p, 0, 1, 4, 2);
}

/* The coefficients that count in the limit: those with the least power of all. */
static void find_limits(const epsilon_polynomial *values, int count, int64_t *out) {
    uint64_t least = UINT64_MAX;
    for (int i = 0; i < count; i++) {
        if (values[i].terms[0].power < least) least = values[i].terms[0].power;
    }
    for (int i = 0; i < count; i++)
        out[i] = values[i].terms[0].power == least ? llabs(values[i].terms[0].coefficient) : 0;
}

exact_piercing_point piercing_oracle_point(const grid_scene *s, surface_piercing piercing) {
    grid_point p[5];
    epsilon_polynomial values[3];
    int64_t weights[3];
    load_points(s, piercing, p);
    orient_points(p, 2, 3, 4, 1, &values[0]);
    orient_points(p, 2, 3, 4, 0, &values[1]);
    find_limits(values, 2, weights);
    exact_piercing_point at = {.s = weights[1], .s_sum = weights[0] + weights[1]};
    for (int k = 0; k < 3; k++) at.x[k] = weights[0] * p[0].x[k] + weights[1] * p[1].x[k];
    for (int i = 0; i < 3; i++) orient_points(p, 0, 1, 2 + (i + 1) % 3, 2 + (i + 2) % 3, &values[i]);
    find_limits(values, 3, weights);
    at.u = weights[1];
    at.v = weights[2];
    at.uv_sum = weights[0] + weights[1] + weights[2];
    return at;
}

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* A step has epsilon to this power, and the next one this power once more: less than anything that moves vertices. */
static const uint64_t STEP = UINT64_C(1) << (3 * WINDING_NAMES + 1);

static void subtract_points(const epsilon_point *from, const epsilon_point *to, epsilon_point *out) {
    for (int k = 0; k < 3; k++) {
        out->x[k].count = 0;
        epsilon_add(&out->x[k], &to->x[k], 1, 0);
        epsilon_add(&out->x[k], &from->x[k], -1, 0);
    }
}

/* corner + step (first - corner) + step^2 (second - corner) + step^3 normal */
static void find_point(const grid_scene *s, corner_side at, epsilon_point *out) {
    const uint32_t *triangle = s->mesh->triangles[at.triangle];
    epsilon_point corners[3], towards;
    for (uint32_t i = 0; i < 3; i++)
        epsilon_move(grid_scene_point(s, triangle[(at.corner + i) % 3]), &corners[i]);
    *out = corners[0];
    for (int i = 1; i < 3; i++) {
        int index = at.next ? i : 3 - i;
        subtract_points(&corners[0], &corners[index], &towards);
        for (int k = 0; k < 3; k++) epsilon_add(&out->x[k], &towards.x[k], 1, (uint64_t)i * STEP);
    }
    for (int k = 0; k < 3; k++) {
        epsilon_polynomial normal;
        epsilon_orient_along((const epsilon_point *const[3]){&corners[0], &corners[1], &corners[2]}, k,
                             &normal);
        epsilon_add(&out->x[k], &normal, 1, 3 * STEP);
    }
}

static int turn_of(const epsilon_point *a, const epsilon_point *b, const epsilon_point *c) {
    epsilon_polynomial value;
    epsilon_orient_along((const epsilon_point *const[3]){a, b, c}, 0, &value);
    return epsilon_sign(&value);
}

static int pass_of(const grid_scene *s, uint32_t triangle, const epsilon_point *point) {
    epsilon_point p[3];
    epsilon_polynomial side;
    for (int i = 0; i < 3; i++) epsilon_move(grid_scene_point(s, s->mesh->triangles[triangle][i]), &p[i]);
    int facing = turn_of(&p[0], &p[1], &p[2]);
    for (int i = 0; i < 3; i++) {
        if (turn_of(&p[i], &p[(i + 1) % 3], point) != facing) return 0;
    }
    epsilon_orient3d((const epsilon_point *const[4]){&p[0], &p[1], &p[2], point}, &side);
    return epsilon_sign(&side) != facing ? facing : 0;
}

int winding_oracle_number(const grid_scene *s, corner_side at, uint32_t object) {
    epsilon_point point;
    int number = 0;
    assert_true(s->vertex_count <= WINDING_NAMES);
    find_point(s, at, &point);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        if (cscd_mesh_vertex_object(s->mesh, s->mesh->triangles[t][0]) != object) continue;
        if (s->mesh->components[s->mesh->triangle_components[t]].closed_manifold)
            number += pass_of(s, t, &point);
    }
    return number;
}
