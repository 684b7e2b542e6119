/* Closed surfaces at any refinement, some with a known capacitance; their charges, and the treecode of their equations. */
#include "tests/support/preprocess/charge_rig.h"

#include "cscd/cscd.h"
#include "src/core/system.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static conductor new_conductor(uint32_t vertex_count, uint32_t triangle_count) {
    conductor s = {vertex_count, triangle_count, malloc(vertex_count * 3 * sizeof(double)),
                   malloc(triangle_count * 3 * sizeof(uint32_t))};
    assert_non_null(s.positions);
    assert_non_null(s.triangles);
    return s;
}

static conductor copy_of(uint32_t vertex_count, const double *positions, uint32_t triangle_count,
                         const uint32_t *triangles) {
    conductor s = new_conductor(vertex_count, triangle_count);
    memcpy(s.positions, positions, vertex_count * 3 * sizeof *positions);
    memcpy(s.triangles, triangles, triangle_count * 3 * sizeof *triangles);
    return s;
}

void conductor_free(conductor *s) {
    free(s->positions);
    free(s->triangles);
    *s = (conductor){0, 0, NULL, NULL};
}

/* Returns the vertex that the finer conductor has in the middle of the edge from a to b: edges are sorted. */
static uint32_t middle_of(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    uint32_t low = 0, high = cscd_mesh_edge_count(mesh);
    uint32_t wanted[2] = {a < b ? a : b, a < b ? b : a};
    while (low < high) {
        uint32_t edge = low + (high - low) / 2, found[2];
        cscd_mesh_edge(mesh, edge, found);
        if (found[0] < wanted[0] || (found[0] == wanted[0] && found[1] < wanted[1]))
            low = edge + 1;
        else
            high = edge;
    }
    return cscd_mesh_vertex_count(mesh) + low;
}

/* Splits every triangle in four at the middles of its edges. */
static void split_triangles(conductor *s) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    conductor finer = new_conductor(s->vertex_count + cscd_mesh_edge_count(mesh), s->triangle_count * 4);
    memcpy(finer.positions, s->positions, s->vertex_count * 3 * sizeof *s->positions);
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t v[2];
        cscd_mesh_edge(mesh, e, v);
        for (uint32_t k = 0; k < 3; k++)
            finer.positions[(s->vertex_count + e) * 3 + k] =
                0.5 * (s->positions[v[0] * 3 + k] + s->positions[v[1] * 3 + k]);
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *v = s->triangles + t * 3;
        uint32_t m[3];
        for (int i = 0; i < 3; i++) m[i] = middle_of(mesh, v[i], v[(i + 1) % 3]);
        const uint32_t four[12] = {v[0], m[0], m[2], m[0], v[1], m[1], m[2], m[1], v[2], m[0], m[1], m[2]};
        memcpy(finer.triangles + t * 12, four, sizeof four);
    }
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    conductor_free(s);
    *s = finer;
}

static void project_to_sphere(conductor *s) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        double *p = s->positions + v * 3;
        double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int k = 0; k < 3; k++) p[k] /= length;
    }
}

conductor conductor_sphere(int level) {
    const double g = 0.5 * (1.0 + sqrt(5.0));
    const double corners[36] = {-1, g,  0,  1, g, 0,  -1, -g, 0,  1, -g, 0, 0,  -1, g,  0,  1, g,
                                0,  -1, -g, 0, 1, -g, g,  0,  -1, g, 0,  1, -g, 0,  -1, -g, 0, 1};
    const uint32_t triangles[60] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                    4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                    6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    conductor s = copy_of(12, corners, 20, triangles);
    project_to_sphere(&s);
    for (int i = 0; i < level; i++) {
        split_triangles(&s);
        project_to_sphere(&s);
    }
    return s;
}

conductor conductor_cube(int level) {
    const double corners[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
    const uint32_t triangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    conductor s = copy_of(8, corners, 12, triangles);
    for (int i = 0; i < level; i++) split_triangles(&s);
    return s;
}

conductor conductor_tetrahedron(void) {
    const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return copy_of(4, corners, 4, triangles);
}

conductor conductor_extreme(extreme_kind kind, uint32_t triangle_count) {
    const extreme_shape shape = extreme_shape_make(kind, triangle_count);
    free(shape.x1);
    return (conductor){shape.vertex_count, shape.triangle_count, shape.x0, shape.triangles};
}

void conductor_transform(conductor *s, const double scale[3], const double offset[3]) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++)
        s->positions[i] = scale[i % 3] * s->positions[i] + offset[i % 3];
}

void conductor_crowd_edges(conductor *s) {
    const double pi = 0x1.921fb54442d18p+1;
    for (uint32_t i = 0; i < s->vertex_count * 3; i++)
        s->positions[i] = s->positions[i] == 1.0 ? 1.0 : 0.5 * (1.0 - cos(pi * s->positions[i]));
}

void conductor_append(conductor *a, const conductor *b) {
    conductor both = new_conductor(a->vertex_count + b->vertex_count, a->triangle_count + b->triangle_count);
    memcpy(both.positions, a->positions, a->vertex_count * 3 * sizeof *a->positions);
    memcpy(both.positions + a->vertex_count * 3, b->positions, b->vertex_count * 3 * sizeof *b->positions);
    memcpy(both.triangles, a->triangles, a->triangle_count * 3 * sizeof *a->triangles);
    for (uint32_t i = 0; i < b->triangle_count * 3; i++)
        both.triangles[a->triangle_count * 3 + i] = b->triangles[i] + a->vertex_count;
    conductor_free(a);
    *a = both;
}

/* ---- charges ------------------------------------------------------------------------------------------- */

const charge_options by_dense_system = {CSCD_CHARGE_DENSE, 0}, by_tree = {CSCD_CHARGE_TREE, 0},
                     by_coarse_tree = {CSCD_CHARGE_COARSE, 0};

charge_rig charge_rig_create(const conductor *s, uint32_t thread_count, const cscd_allocator *allocator) {
    charge_rig r = {NULL, NULL, NULL, NULL};
    cscd_context_options options = cscd_context_defaults();
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    options.thread_count = thread_count;
    if (allocator != NULL) options.allocator = *allocator;
    expect_ok(cscd_context_create(&options, &r.context));
    expect_ok(cscd_mesh_create(r.context, &desc, 1, &r.mesh));
    uint32_t components = cscd_mesh_component_count(r.mesh);
    r.density = malloc(s->triangle_count * sizeof *r.density);
    r.capacitance = malloc(components * sizeof *r.capacitance);
    assert_non_null(r.density);
    assert_non_null(r.capacitance);
    for (uint32_t t = 0; t < s->triangle_count; t++) r.density[t] = -1.0;
    for (uint32_t c = 0; c < components; c++) r.capacitance[c] = -1.0;
    return r;
}

charge_rig charge_rig_solve(const conductor *s, uint32_t thread_count) {
    return charge_rig_solve_by(&by_dense_system, s, thread_count);
}

charge_rig charge_rig_solve_by(const charge_options *options, const conductor *s, uint32_t thread_count) {
    charge_rig r = charge_rig_create(s, thread_count, NULL);
    if (charge_solve(r.mesh, s->positions, options, r.density, r.capacitance, NULL) != CSCD_OK)
        fail_msg("%s", cscd_context_detail(r.context));
    return r;
}

bool charge_rig_untouched(const charge_rig *r) {
    bool untouched = true;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(r->mesh); t++)
        untouched = untouched && r->density[t] == -1.0;
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++)
        untouched = untouched && r->capacitance[c] == -1.0;
    return untouched;
}

void charge_rig_destroy(charge_rig *r) {
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    free(r->density);
    free(r->capacitance);
    *r = (charge_rig){NULL, NULL, NULL, NULL};
}

/* ---- treecodes ----------------------------------------------------------------------------------------- */

static cscd_context *make_context(uint32_t threads, cscd_simd simd) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context;
    options.thread_count = threads;
    options.simd = simd;
    expect_ok(cscd_context_create(&options, &context));
    return context;
}

treecode_rig treecode_rig_create(const conductor *s, uint32_t thread_count, cscd_simd simd) {
    treecode_rig r = {.context = make_context(thread_count, simd)};
    const charge_surface surface = {r.context, (const uint32_t(*)[3])(const void *)s->triangles,
                                    s->positions};
    uint32_t *list = malloc(s->triangle_count * sizeof *list);
    r.memory = system_memory(charge_system_lay_out(&r.system, s->triangle_count, NULL), CHARGE_ALIGNMENT);
    assert_true(list != NULL && r.memory != NULL);
    for (uint32_t t = 0; t < s->triangle_count; t++) list[t] = t;
    charge_system_lay_out(&r.system, s->triangle_count, r.memory);
    expect_ok(charge_system_collect(&r.system, &surface, 0, list, s->triangle_count));
    free(list);
    expect_ok(treecode_create(r.context, &r.system, &r.t));
    expect_ok(treecode_fill(&r.t));
    return r;
}

void treecode_rig_destroy(treecode_rig *r) {
    treecode_destroy(&r->t);
    cscd_context_destroy(r->context);
    system_memory_free(r->memory);
}

double treecode_rig_residual(treecode_rig *r, const double *density) {
    const charge_system *system = &r->system;
    double *charges = malloc(3 * (size_t)system->count * sizeof *charges), squares = 0.0;
    assert_non_null(charges);
    double *in_order = charges + system->count, *potentials = in_order + system->count;
    for (uint32_t i = 0; i < system->point_count; i++) {
        const charge_point *p = &system->points[i];
        charges[p->unknown] = density[p->triangle] / system->scale * system->sources[p->unknown].area;
    }
    for (uint32_t i = 0; i < system->count; i++) in_order[i] = charges[r->t.tree.sources[i].unknown];
    expect_ok(treecode_evaluate(&r->t, in_order, potentials));
    for (uint32_t i = 0; i < system->count; i++) squares += (potentials[i] - 1.0) * (potentials[i] - 1.0);
    free(charges);
    return sqrt(squares / system->count);
}

double treecode_rig_exact_at(const treecode_rig *r, const double *charges, uint32_t target) {
    const double *p = r->t.tree.sources[target].centroid;
    double sum = 0.0, potential;
    for (uint32_t i = 0; i < r->system.count; i++) {
        const potential_source *triangle = triangle_of(&r->t.tree, i);
        potential_at(triangle, &p[0], &p[1], &p[2], 1, &potential);
        sum += charges[i] / triangle->area * potential;
    }
    return sum;
}
