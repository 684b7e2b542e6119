/* The validators of meshes, plans and detectors find every kind of planted fault, and none in what the
 * library has made. */
#include "cscd/cscd.h"
#include "runtime/detector/detector.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene shape; /* large; one test at a time */

/* Two objects, of which the second is an obstacle, with a plan, and a detector that has made a step. */
typedef struct whole_set {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
} whole_set;

static cscd_detector *create_detector(whole_set *w) {
    static const uint32_t ignored[] = {1, 5, 2, 9, 0, 7}, seams[] = {0, 1, 1, 2, 4, 7};
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    rules[1].thickness = 0.01;
    options.ignored = ignored;
    options.ignored_count = 3;
    options.seams = seams;
    options.seam_count = 3;
    options.seam_reach = (double)INFINITY;
    options.rules = rules;
    options.rule_count = 2;
    expect_ok(cscd_detector_create(w->context, w->mesh, w->plan, &options, &detector));
    return detector;
}

static whole_set whole_set_create(void) {
    whole_set w = {.context = NULL};
    cscd_contacts found;
    scene_clear(&shape);
    for (int i = 0; i < 2; i++) scene_add_sphere(&shape, (double[3]){2.5 * i, 0, 0}, 1.0, 8, 8);
    uint32_t vertices = shape.vertex_count / 2, triangles = shape.triangle_count / 2;
    cscd_object_desc objects[2] = {cscd_object_of_triangles(vertices, triangles, shape.triangles),
                                   cscd_object_of_triangles(vertices, triangles, shape.triangles)};
    objects[1].obstacle = true;
    expect_ok(cscd_context_create(NULL, &w.context));
    expect_ok(cscd_mesh_create(w.context, objects, 2, &w.mesh));
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_SINGLE;
    const cscd_view x0 = cscd_view_doubles(shape.x0, shape.vertex_count);
    const cscd_view x1 = cscd_view_doubles(shape.x1, shape.vertex_count);
    expect_ok(cscd_plan_create(w.context, w.mesh, &x0, &options, &w.plan));
    w.detector = create_detector(&w);
    expect_ok(cscd_detector_step(w.detector, &x0, &x1, &found));
    assert_null(mesh_validate(w.mesh));
    assert_null(plan_validate(w.plan));
    assert_null(detector_validate(w.detector));
    return w;
}

static void whole_set_destroy(whole_set *w) {
    cscd_detector_destroy(w->detector);
    cscd_plan_destroy(w->plan);
    cscd_mesh_destroy(w->mesh);
    cscd_context_destroy(w->context);
}

static void expect_sentence(const char *fault, const char *expected) {
    if (fault == NULL) fail_msg("not found: %s", expected);
    assert_string_equal(fault, expected);
}

/* Plants a value, expects the validator to find it, and puts the old one back. */
#define PLANT(validate, object, place, value, expected)                                                      \
    do {                                                                                                     \
        __typeof__(place) saved = (place);                                                                   \
        (place) = (value);                                                                                   \
        expect_sentence(validate(object), expected);                                                         \
        (place) = saved;                                                                                     \
        assert_null(validate(object));                                                                       \
    } while (0)

TEST(faults_of_meshes) {
    whole_set w = whole_set_create();
    cscd_mesh *m = w.mesh;
    PLANT(mesh_validate, m, m->triangles[3][1], m->vertex_count,
          "a triangle of a mesh names a vertex that there is not");
    PLANT(mesh_validate, m, m->triangles[3][1], m->triangles[3][0],
          "a triangle of a mesh has a vertex twice");
    PLANT(mesh_validate, m, m->triangle_edges[3][2], m->triangle_edges[3][1],
          "an edge of a triangle does not join its corners");
    PLANT(mesh_validate, m, m->edges[4][1], m->edges[4][0],
          "the vertices of an edge are out of order or range");
    PLANT(mesh_validate, m, m->edges[1][1], m->edges[0][1], "the edges of a mesh are not sorted");
    PLANT(mesh_validate, m, m->vertex_star_offsets[m->vertex_count], 7,
          "the stars of a mesh do not hold every triangle three times");
    PLANT(mesh_validate, m, m->edge_star_offsets[3], m->edge_star_offsets[4] + 1,
          "the stars of a mesh overlap");
    PLANT(mesh_validate, m, m->vertex_stars[0], m->triangle_count - 1,
          "a star holds a triangle that does not contain its feature");
    PLANT(mesh_validate, m, m->vertex_stars[1], m->vertex_stars[0], "a star of a mesh is not sorted");
    PLANT(mesh_validate, m, m->triangle_components[0], 1, "the components of a mesh are not in order");
    PLANT(mesh_validate, m, m->triangle_components[m->triangle_count - 1], 0,
          "two components of a mesh have a vertex in common");
    PLANT(mesh_validate, m, m->components[1].triangle_count, 1,
          "the components of a mesh do not hold every triangle once");
    PLANT(mesh_validate, m, m->objects[1].first_edge, 0, "the objects of a mesh do not follow each other");
    PLANT(mesh_validate, m, m->obstacles[1], false, "a component is no obstacle, but its object is");
    PLANT(mesh_validate, m, m->objects[1].vertex_count, m->objects[1].vertex_count + 1,
          "the objects of a mesh do not hold every feature once");
    whole_set_destroy(&w);
}

TEST(faults_of_plans) {
    whole_set w = whole_set_create();
    PLANT(plan_validate, w.plan, w.plan->triangle_regions[2], 99, "a plan names a region that there is not");
    PLANT(plan_validate, w.plan, w.plan->triangle_weights[2], (double)NAN,
          "a plan gives a triangle no weight in its region");
    PLANT(plan_validate, w.plan, w.plan->regions[0].triangle_count, 1,
          "the regions of a plan do not hold every triangle once");
    PLANT(plan_validate, w.plan, w.plan->regions[0].component, 9,
          "a region of a plan is of a component that there is not");
    whole_set_destroy(&w);
}

TEST(faults_of_detectors) {
    whole_set w = whole_set_create();
    cscd_detector *d = w.detector;
    PLANT(detector_validate, d, d->rebuild.mesh, w.mesh, "the parts of a detector are of different meshes");
    PLANT(detector_validate, d, d->seen->triangle_count, 5, "the mesh of a detector has changed");
    PLANT(detector_validate, d, d->config.limit.distance, 1.0,
          "the distance of a detector is not that of its options");
    PLANT(detector_validate, d, d->interval.culling.triangle_regions[4], d->interval.culling.region_count,
          "a triangle is in a region that there is not");
    PLANT(detector_validate, d, d->interval.culling.triangle_weights[4], -1.0,
          "a triangle has no weight in its region");
    PLANT(detector_validate, d, d->interval.culling.facing[4], 9, "a triangle has an unknown orientation");
    PLANT(detector_validate, d, d->interval.culling.detector_offsets[0][1], (double)INFINITY,
          "a detector point is nowhere");
    PLANT(detector_validate, d, d->interval.culled[1], true, "the pairs of an obstacle are culled");
    PLANT(detector_validate, d, d->known.starts.triangles[3], 9,
          "a triangle has an unknown state at its start");
    PLANT(detector_validate, d, d->known.starts.of[0].clean, (d->known.starts.counted = true, UINT32_MAX),
          "a component has more states than triangles at its start");
    PLANT(detector_validate, d, d->config.exclusions.ignored[1], d->config.exclusions.ignored[0] - 1,
          "the pairs to leave out are not sorted");
    PLANT(detector_validate, d, d->config.exclusions.ignored[1], (uint64_t)7 << 32 | 3,
          "a pair to leave out names no two triangles");
    PLANT(detector_validate, d, d->config.exclusions.names[2], 1, "the seams do not name their vertices");
    PLANT(detector_validate, d, d->space.rules, NULL, "the parts of a detector have different rules");
    PLANT(detector_validate, d, d->config.pair_rules.object_count, 1,
          "the rules are of another number of objects");
    PLANT(detector_validate, d, d->config.pair_rules.reaches[0], 1.0,
          "an object's distance is not within the greatest");
    PLANT(detector_validate, d, d->config.pair_rules.component_objects[0], 2,
          "a component is of an object that there is not");
    PLANT(detector_validate, d, d->space.bvh.leaf_flags[0].used, 0xfd, "the lanes of a leaf are no prefix");
    whole_set_destroy(&w);
}

TEST(faults_of_active_sets) {
    whole_set w = whole_set_create();
    cscd_detector *d = w.detector;
    const uint32_t vertices[2] = {3, 40};
    expect_ok(cscd_detector_set_active(d, vertices, 2));
    assert_null(detector_validate(d));
    bvh *hierarchy = &d->space.bvh;
    active_set *set = &d->space.active;
    PLANT(detector_validate, d, set->vertices[50], true, "a triangle is not as active as its vertices");
    PLANT(detector_validate, d, set->triangles[0], !set->triangles[0],
          "a triangle is not as active as its vertices");
    PLANT(detector_validate, d, d->rebuild.active, NULL,
          "the trees and their detector have different active sets");
    PLANT(detector_validate, d, hierarchy->has_inactive, false,
          "the trees and their detector have different active sets");
    PLANT(detector_validate, d, hierarchy->leaf_inactive, NULL,
          "the trees and their detector have different active sets");
    PLANT(detector_validate, d, hierarchy->leaf_inactive[1], (uint8_t)~hierarchy->leaf_inactive[1],
          "a leaf has the wrong active triangles");
    PLANT(detector_validate, d, hierarchy->levels[0].inactive_lanes, NULL,
          "a level does not know its active blocks");
    PLANT(detector_validate, d, hierarchy->levels[1].inactive_lanes[0], 0xff,
          "a block has the wrong active children");
    expect_ok(cscd_detector_set_active(d, NULL, 0));
    assert_null(detector_validate(d));
    whole_set_destroy(&w);
}
