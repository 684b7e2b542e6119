/* What every call promises (tests/support/proofs/proof.h), of those that make contexts, meshes, plans and detectors. */
#include "cscd/research.h"
#include "tests/support/changing_mesh.h"
#include "tests/support/models/bodies.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* ---- contexts and meshes -------------------------------------------------------------------------------- */

static cscd_status create_context(proof *p) {
    char reason[200] = "";
    cscd_context_options options = p->options;
    options.reason = reason;
    options.reason_size = sizeof reason;
    const cscd_status status = cscd_context_create(&options, &p->answer.context);
    assert_int_equal(strstr(reason, "out of memory") != NULL, status != CSCD_OK);
    return status;
}

static void keep_context(proof *p) {
    proof_take_context(p, p->answer.context);
}

static cscd_status create_mesh(proof *p) {
    cscd_object_desc objects[2];
    uint32_t count;
    open_shape(p);
    describe_objects(p, objects, &count);
    return cscd_mesh_create(p->context, objects, count, &p->answer.mesh);
}

static cscd_status create_loose(proof *p) {
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3}, wires[] = {0, 1, 1, 2, 3, 4};
    static const double up[3] = {0, 0, 1};
    const cscd_object_desc objects[] = {cscd_object_of_triangles(4, 2, triangles),
                                        cscd_object_of_wires(5, 3, wires), cscd_object_of_points(3),
                                        cscd_object_half_space(up)};
    return cscd_mesh_create(p->context, objects, 4, &p->answer.mesh);
}

static void keep_mesh(proof *p) {
    p->mesh = p->answer.mesh;
    const cscd_mesh *mesh = p->mesh;
    const uint64_t hash = cscd_mesh_hash(mesh);
    const uint32_t triangles = cscd_mesh_triangle_count(mesh), edges = cscd_mesh_edge_count(mesh);
    proof_add(p, &hash, sizeof hash);
    proof_add_items(p, cscd_mesh_array(mesh, CSCD_EDGE_VERTICES), edges, sizeof(uint32_t[2]));
    proof_add_items(p, cscd_mesh_array(mesh, CSCD_TRIANGLE_EDGES), triangles, sizeof(uint32_t[3]));
    for (uint32_t v = 0, count; v < cscd_mesh_vertex_count(mesh); v++) {
        const uint32_t *star = cscd_mesh_vertex_triangles(mesh, v, &count);
        proof_add_items(p, star, count, sizeof *star);
    }
}

/* Objects tear, are refined, lose triangles, are renumbered, come and go. */
static changing_scene changing;
static scene_change change;

static void open_changing(proof *p) {
    cscd_object_desc objects[CHANGING_OBJECTS_MAX];
    random_stream random = stream_start(p->row->seed);
    changing_scene_make(&random, true, &changing);
    changing_scene_describe(&changing, objects);
    proof_need(p, cscd_mesh_create(p->context, objects, changing.object_count, &p->mesh));
    changing_scene_change(&random, &changing, &change);
}

static cscd_status create_change(proof *p) {
    return cscd_mesh_change_create(p->context, p->mesh, change.list, change.count, &p->answer.change);
}

static void keep_change(proof *p) {
    p->change = p->answer.change;
    const uint64_t hash = cscd_mesh_hash(cscd_mesh_change_mesh(p->change));
    uint32_t count;
    const uint32_t *edges = cscd_mesh_change_to_new(p->change, CSCD_EDGES, &count);
    proof_add(p, &hash, sizeof hash);
    proof_add_items(p, edges, count, sizeof *edges);
    const uint32_t *origins = cscd_mesh_change_to_old(p->change, CSCD_VERTICES, &count);
    proof_add_items(p, origins, count, sizeof *origins);
}

static const proof_call change_made = {"mesh_change_create", PROOF_CREATES, create_change, keep_change};
static const proof_call context_made = {"context_create", PROOF_CREATES, create_context, keep_context};
static const proof_call mesh_made = {"mesh_create", PROOF_CREATES, create_mesh, keep_mesh};
static const proof_call loose_made = {"mesh_create", PROOF_CREATES, create_loose, keep_mesh};

/* ---- surfaces of tetrahedra ----------------------------------------------------------------------------- */

/* Pairs of tetrahedra with a face in common, each of which has an edge with the next pair. */
static uint32_t tetrahedra[SCENE_TRIANGLES_MAX * 2][4];

static cscd_status create_tet_surface(proof *p) {
    const uint32_t count = p->large ? SCENE_TRIANGLES_MAX : 20;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t first = 3 * t, all[5] = {first, first + 1, first + 2, first + 3, first + 4};
        const uint32_t pair[2][4] = {{all[0], all[1], all[2], all[3]}, {all[0], all[2], all[1], all[4]}};
        memcpy(tetrahedra[(size_t)t * 2], pair, sizeof pair);
    }
    return cscd_tet_surface_create(p->context, tetrahedra[0], (size_t)count * 2, 3 * count + 2,
                                   &p->answer.tet_surface);
}

static void keep_tet_surface(proof *p) {
    const cscd_tet_surface_arrays s = cscd_tet_surface_get(p->answer.tet_surface);
    p->own = p->answer.tet_surface;
    proof_add_items(p, s.triangles, (size_t)s.triangle_count * 3, sizeof *s.triangles);
    proof_add_items(p, s.tetrahedra, s.triangle_count, sizeof *s.tetrahedra);
    proof_add_items(p, s.vertices, s.vertex_count, sizeof *s.vertices);
}

static void close_tet_surface(proof *p) {
    cscd_tet_surface_destroy(p->own);
    p->own = NULL;
}

static const proof_call tet_surface_made = {"tet_surface_create", PROOF_CREATES, create_tet_surface,
                                            keep_tet_surface};

/* ---- plans ---------------------------------------------------------------------------------------------- */

/* A dumbbell, which with the seed 1 is soft at its rod. */
static double stiffness[SCENE_TRIANGLES_MAX];

static void open_dumbbell(proof *p) {
    body shape = body_of(BODY_DUMBBELL, p->large ? 1000 : 150);
    const size_t corners = (size_t)shape.triangle_count * 3;
    p->shape.vertex_count = shape.vertex_count;
    p->shape.triangle_count = shape.triangle_count;
    memcpy(p->shape.triangles, shape.triangles, corners * sizeof *shape.triangles);
    memcpy(p->x[0], shape.positions, shape.vertex_count * sizeof(double[3]));
    for (uint32_t t = 0; t < shape.triangle_count; t++)
        stiffness[t] = fmin(1.0, 0.1 + fabs(shape.positions[shape.triangles[t * 3] * 3 + 2]));
    const cscd_object_desc object =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, p->shape.triangles);
    body_free(&shape);
    proof_need(p, cscd_mesh_create(p->context, &object, 1, &p->mesh));
}

static cscd_status create_plan(proof *p) {
    cscd_plan_options options = cscd_plan_defaults();
    options.stiffness = p->row->seed == 1 ? stiffness : NULL;
    cscd_view x;
    options.method = p->row->method;
    options.ours = options.method == CSCD_METHOD_PUBLISHED ? CSCD_OURS_CHARGE : 0;
    return cscd_plan_create(p->context, p->mesh, at_moment(p, 0, &x), &options, &p->answer.plan);
}

static void keep_plan(proof *p) {
    p->plan = p->answer.plan;
    for (uint32_t r = 0; r < cscd_plan_region_count(p->plan); r++) {
        const cscd_region region = cscd_plan_region(p->plan, r);
        proof_add_items(p, region.detector_point, 3, sizeof(double));
        proof_add(p, &region.visible_share, sizeof region.visible_share);
    }
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(p->mesh); t++) {
        const double charge = cscd_plan_triangle_charge(p->plan, t);
        const uint32_t region = cscd_plan_triangle_region(p->plan, t);
        proof_add(p, &charge, sizeof charge);
        proof_add(p, &region, sizeof region);
    }
}

static cscd_status create_from_parts(proof *p) {
    static const uint32_t regions[SCENE_TRIANGLES_MAX];
    static const double point[3] = {0.1, 0.2, 0.3};
    const cscd_plan_parts parts = {CSCD_METHOD_SINGLE, 1, regions, point, NULL, NULL, NULL};
    cscd_view x;
    return cscd_plan_create_from_parts(p->context, p->mesh, at_moment(p, 0, &x), &parts, &p->answer.plan);
}

static const proof_call plan_made = {"plan_create", PROOF_CREATES, create_plan, keep_plan};
static const proof_call plan_joined = {"plan_create_from_parts", PROOF_CREATES, create_from_parts, keep_plan};

/* ---- detectors ------------------------------------------------------------------------------------------ */

/* Everything that a detector may be told at its creation. */
static cscd_status create_detector(proof *p) {
    static const double matrix[1] = {0.01};
    const uint32_t vertices = p->shape.vertex_count, triangles = p->shape.triangle_count;
    const uint32_t seams[2] = {0, vertices - 1}, ignored[2] = {0, triangles - 1};
    const cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = seams;
    options.ignored = ignored;
    options.seam_count = options.ignored_count = 1;
    options.seam_reach = 10.0;
    options.rules = rules;
    options.rule_count = p->row->family == SCENE_TWO_SPHERES ? 2 : 1;
    options.thickness_matrix = matrix;
    options.thickness_class_count = 1;
    options.longest_list = 100000;
    return cscd_detector_create(p->context, p->mesh, p->plan, &options, &p->answer.detector);
}

static void keep_detector(proof *p) {
    p->detector = p->answer.detector;
}

static const proof_call detector_made = {"detector_create", PROOF_CREATES, create_detector, keep_detector};

/* ---- the table ------------------------------------------------------------------------------------------ */

static const char makes[] = "a mesh is made by one thread, and soon";
static const char soon[] = "it is made soon";
static const char clusters[] = "clusters are found by one thread";

#define MESH .no_report = makes, .one_thread = makes

static const proof_row rows[] = {
    {"context",
     {&context_made, &mesh_made, &detector_made, &step_first},
     .without_context = true,
     .family = SCENE_TWO_SPHERES},
    {"mesh", {&mesh_made}, .family = SCENE_SOUP, .seed = 3, MESH},
    {"mesh_loose", {&loose_made}, MESH},
    {"tet_surface", {&tet_surface_made}, NULL, close_tet_surface, MESH},
    {"mesh_change", {&change_made}, open_changing, .seed = 3, MESH},
    {"mesh_change_4", {&change_made}, open_changing, .seed = 4, MESH},
    {"mesh_change_5", {&change_made}, open_changing, .seed = 5, MESH},
    {"mesh_change_6", {&change_made}, open_changing, .seed = 6, MESH},
    {"plan_single",
     {&plan_made},
     open_dumbbell,
     .method = CSCD_METHOD_SINGLE,
     .no_report = soon,
     .one_thread = soon},
    {"plan_kmeans", {&plan_made}, open_dumbbell, .method = CSCD_METHOD_KMEANS, .one_thread = clusters},
    {"plan_charge", {&plan_made}, open_dumbbell, .method = CSCD_METHOD_CHARGE},
    {"plan_soft", {&plan_made}, open_dumbbell, .seed = 1, .method = CSCD_METHOD_CHARGE},
    {"plan_published", {&plan_made}, open_dumbbell, .method = CSCD_METHOD_PUBLISHED},
    {"plan_parts", {&plan_joined}, open_dumbbell, .no_report = soon, .one_thread = soon},
};

PROOFS(rows)
