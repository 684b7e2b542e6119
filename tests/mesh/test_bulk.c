/* Whole arrays say what the calls for single features and single stencils say. */
#include "cscd/cscd.h"
#include "tests/support/packed.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <stdlib.h>

static scene interval; /* large; one test at a time */

TEST(arrays_are_those_of_single_calls) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 2, &interval);
        rig r = rig_create(&interval, 1, NULL);
        const uint32_t *triangles = cscd_mesh_all_triangles(r.mesh), *edges = cscd_mesh_all_edges(r.mesh),
                       *triangle_edges = cscd_mesh_all_triangle_edges(r.mesh);
        for (uint32_t t = 0; t < cscd_mesh_triangle_count(r.mesh); t++) {
            uint32_t vertices[3], sides[3];
            cscd_mesh_triangle(r.mesh, t, vertices);
            cscd_mesh_triangle_edges(r.mesh, t, sides);
            assert_memory_equal(triangles + 3 * t, vertices, sizeof vertices);
            assert_memory_equal(triangle_edges + 3 * t, sides, sizeof sides);
        }
        for (uint32_t e = 0; e < cscd_mesh_edge_count(r.mesh); e++) {
            uint32_t ends[2];
            cscd_mesh_edge(r.mesh, e, ends);
            assert_memory_equal(edges + 2 * e, ends, sizeof ends);
        }
        rig_destroy(&r);
    }
}

typedef struct stencil_arrays {
    uint32_t *vertices;
    double *weights;
} stencil_arrays;

static stencil_arrays allocate_stencils(size_t count) {
    stencil_arrays s = {calloc(4 * count + 1, sizeof *s.vertices), calloc(4 * count + 1, sizeof *s.weights)};
    assert_true(s.vertices != NULL && s.weights != NULL);
    return s;
}

static void free_stencils(stencil_arrays *s) {
    free(s->vertices);
    free(s->weights);
}

static void compare_stencil(const stencil_arrays *arrays, size_t i, const cscd_stencil *s) {
    assert_memory_equal(arrays->vertices + 4 * i, s->vertices, sizeof s->vertices);
    assert_memory_equal(arrays->weights + 4 * i, s->weights, sizeof s->weights);
}

static size_t compare_contacts(const rig *r, const cscd_contacts *found) {
    stencil_arrays both = allocate_stencils(found->count), single = allocate_stencils(found->count);
    cscd_contact_stencils(found->items, found->count, both.vertices, both.weights);
    cscd_contact_stencils(found->items, found->count, single.vertices, NULL);
    cscd_contact_stencils(found->items, found->count, NULL, single.weights);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        cscd_stencil s = cscd_mesh_stencil(r->mesh, c->kind, c->a, c->b, c->u, c->v);
        assert_memory_equal(c->vertices, s.vertices, sizeof s.vertices);
        compare_stencil(&both, i, &s);
        compare_stencil(&single, i, &s);
    }
    free_stencils(&both);
    free_stencils(&single);
    return found->count;
}

static size_t compare_proximities(const rig *r, const cscd_proximities *found) {
    stencil_arrays arrays = allocate_stencils(found->count);
    cscd_proximity_stencils(found->items, found->count, arrays.vertices, arrays.weights);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_proximity *p = &found->items[i];
        cscd_stencil s = cscd_mesh_stencil(r->mesh, p->kind, p->a, p->b, p->u, p->v);
        compare_stencil(&arrays, i, &s);
    }
    free_stencils(&arrays);
    return found->count;
}

TEST(stencils_are_those_of_single_calls) {
    size_t contacts = 0, proximities = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        cscd_proximities near;
        scene_make((scene_family)family, 3, &interval);
        rig r = rig_create(&interval, 1, NULL);
        cscd_contacts found = rig_step(&r, &interval);
        contacts += compare_contacts(&r, &found);
        assert_int_equal(find_near_packed(r.detector, interval.x1, 0.1, &near), CSCD_OK);
        proximities += compare_proximities(&r, &near);
        assert_int_equal(find_unique_packed(r.detector, interval.x1, 0.1, &near), CSCD_OK);
        proximities += compare_proximities(&r, &near);
        rig_destroy(&r);
    }
    assert_true(contacts > 100 && proximities > 1000);
}
