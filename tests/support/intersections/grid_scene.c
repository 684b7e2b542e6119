/* Small meshes with integer coordinates, so few of them that everything degenerates. */
#include "tests/support/intersections/grid_scene.h"

#include "cscd/cscd.h"
#include "src/mesh/predicates.h"
#include "tests/support/test.h"

#include <string.h>

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
