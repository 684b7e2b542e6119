/* Meshes that are made from others: bit for bit what would be made anew, with maps that say what became of what. */
#include "tests/support/changing_mesh.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static changing_scene changing;
static scene_change change;

/* ---- the maps, by brute force ------------------------------------------------------------------------------ */

/* What has become of each is the first whose origin it is. */
static void check_inverse(const uint32_t *to_new, uint32_t old_count, const uint32_t *to_old,
                          uint32_t new_count) {
    uint32_t found = 0, origins = 0;
    for (uint32_t i = 0; i < new_count; i++) {
        if (to_old[i] == UINT32_MAX) continue;
        assert_true(to_old[i] < old_count);
        assert_true(to_new[to_old[i]] <= i);
        origins += to_new[to_old[i]] == i;
    }
    for (uint32_t i = 0; i < old_count; i++) {
        if (to_new[i] == UINT32_MAX) continue;
        assert_int_equal(to_old[to_new[i]], i);
        found++;
    }
    assert_int_equal(found, origins);
}

#define MAPS(name, what)                                                                                     \
    uint32_t old_##name##_count, new_##name##_count;                                                         \
    const uint32_t *new_##name = cscd_mesh_change_to_new(made, what, &old_##name##_count);                   \
    const uint32_t *old_##name = cscd_mesh_change_to_old(made, what, &new_##name##_count);                   \
    check_inverse(new_##name, old_##name##_count, old_##name, new_##name##_count)

/* The origin that the caller has said, in the numbering of the mesh. */
static uint32_t origin_said(const uint32_t *origins, uint32_t own, uint32_t old_count, uint32_t old_first) {
    uint32_t origin = origins != NULL ? origins[own] : own < old_count ? own : UINT32_MAX;
    return origin == UINT32_MAX ? UINT32_MAX : old_first + origin;
}

static const cscd_object_change *change_of(uint32_t old_object) {
    for (uint32_t i = 0; i < change.count; i++) {
        if (change.list[i].object == old_object) return &change.list[i];
    }
    return NULL;
}

static void check_features(const cscd_mesh_change *made, const cscd_mesh *old) {
    const cscd_mesh *mesh = cscd_mesh_change_mesh(made);
    MAPS(vertices, CSCD_VERTICES);
    MAPS(triangles, CSCD_TRIANGLES);
    MAPS(edges, CSCD_EDGES);
    MAPS(objects, CSCD_OBJECTS);
    for (uint32_t o = 0; o < mesh->object_count; o++) {
        cscd_object now = cscd_mesh_object(mesh, o), was = {0};
        const cscd_object_change *said = NULL;
        if (old_objects[o] != UINT32_MAX) {
            was = cscd_mesh_object(old, old_objects[o]);
            said = change_of(old_objects[o]);
        }
        for (uint32_t i = 0; i < now.vertex_count; i++)
            assert_int_equal(old_vertices[now.first_vertex + i],
                             origin_said(said != NULL ? said->vertex_origins : NULL, i, was.vertex_count,
                                         was.first_vertex));
        for (uint32_t i = 0; i < now.triangle_count; i++)
            assert_int_equal(old_triangles[now.first_triangle + i],
                             origin_said(said != NULL ? said->triangle_origins : NULL, i, was.triangle_count,
                                         was.first_triangle));
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        uint32_t a = old_vertices[mesh->edges[e][0]], b = old_vertices[mesh->edges[e][1]],
                 origin = UINT32_MAX;
        for (uint32_t i = 0; i < old->edge_count; i++) {
            if ((old->edges[i][0] == a && old->edges[i][1] == b) ||
                (old->edges[i][0] == b && old->edges[i][1] == a))
                origin = i;
        }
        assert_int_equal(old_edges[e], origin);
    }
    assert_int_equal(old_vertices_count, old->vertex_count);
    assert_int_equal(new_edges_count, mesh->edge_count);
    assert_int_equal(old_triangles_count, old->triangle_count);
}

/* Is every triangle of the old component one of the new component, with what became of its corners, and is no other? */
static bool is_untouched(const cscd_mesh_change *made, const cscd_mesh *old, uint32_t was, uint32_t now) {
    const cscd_mesh *mesh = cscd_mesh_change_mesh(made);
    const uint32_t *triangles = cscd_mesh_change_to_new(made, CSCD_TRIANGLES, NULL),
                   *vertices = cscd_mesh_change_to_new(made, CSCD_VERTICES, NULL);
    if (old->components[was].triangle_count != mesh->components[now].triangle_count) return false;
    if (component_is_obstacle(old, was) != component_is_obstacle(mesh, now)) return false;
    for (uint32_t t = 0; t < old->triangle_count; t++) {
        if (old->triangle_components[t] != was) continue;
        uint32_t to = triangles[t];
        if (to == UINT32_MAX || mesh->triangle_components[to] != now) return false;
        for (int i = 0; i < 3; i++) {
            if (mesh->triangles[to][i] != vertices[old->triangles[t][i]]) return false;
        }
    }
    return true;
}

static uint32_t check_components(const cscd_mesh_change *made, const cscd_mesh *old) {
    const cscd_mesh *mesh = cscd_mesh_change_mesh(made);
    uint32_t untouched = 0;
    MAPS(components, CSCD_COMPONENTS);
    assert_int_equal(new_components_count, mesh->component_count);
    for (uint32_t c = 0; c < old->component_count; c++) {
        uint32_t expected = UINT32_MAX;
        for (uint32_t now = 0; now < mesh->component_count; now++) {
            if (is_untouched(made, old, c, now)) expected = now;
        }
        assert_int_equal(new_components[c], expected);
        untouched += expected != UINT32_MAX;
    }
    return untouched;
}

/* Many changes in a row, each from the mesh that the last one made. */
TEST(equal_new_meshes) {
    random_stream random = stream_start(1);
    uint32_t untouched = 0, components = 0;
    for (int round = 0; round < 60; round++) {
        counting_allocator counter = counting_allocator_start();
        cscd_context *context = context_of(0, &counter);
        changing_scene_make(&random, true, &changing);
        cscd_mesh *first = changing_scene_mesh(context, &changing);
        const cscd_mesh *old = first;
        cscd_mesh_change *last = NULL;
        for (int i = 0; i < 6; i++) {
            changing_scene_change(&random, &changing, &change);
            cscd_mesh_change *made = NULL;
            assert_int_equal(cscd_mesh_change_create(context, old, change.list, change.count, &made),
                             CSCD_OK);
            cscd_mesh *expected = changing_scene_mesh(context, &changing);
            check_same_mesh(cscd_mesh_change_mesh(made), expected);
            check_features(made, old);
            untouched += check_components(made, old);
            components += old->component_count;
            cscd_mesh_destroy(expected);
            cscd_mesh_change_destroy(last);
            if (i == 0) cscd_mesh_destroy(first);
            last = made;
            old = cscd_mesh_change_mesh(made);
        }
        cscd_mesh_change_destroy(last);
        cscd_context_destroy(context);
        assert_int_equal(counter.live, 0);
    }
    assert_true(untouched > components / 3 && untouched < components);
}

/* ---- what is refused ---------------------------------------------------------------------------------------- */

static void check_refused(cscd_context *context, const cscd_mesh *old, const cscd_object_change *changes,
                          uint32_t count, cscd_status expected, const char *detail) {
    size_t bytes = cscd_context_describe(context).bytes;
    cscd_mesh_change *const untouched = (cscd_mesh_change *)&bytes;
    cscd_mesh_change *made = untouched;
    assert_int_equal(cscd_mesh_change_create(context, old, changes, count, &made), expected);
    assert_ptr_equal(made, untouched);
    assert_int_equal(cscd_context_describe(context).bytes, bytes);
    if (strstr(cscd_context_detail(context), detail) == NULL)
        fail_msg("no '%s' in '%s'", detail, cscd_context_detail(context));
}

TEST(refused_changes) {
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3}, bad[] = {0, 1, 2, 0, 2, 4};
    static const uint32_t far_origins[] = {0, 1, 4, 3};
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_object_desc desc = cscd_object_of_triangles(4, 2, triangles), wrong = desc, empty = desc;
    cscd_object_desc both[2] = {desc, desc};
    wrong.triangles = bad;
    empty.triangle_count = 0;
    cscd_mesh *old = NULL;
    assert_int_equal(cscd_mesh_create(context, both, 2, &old), CSCD_OK);
#define REFUSED(status, detail, ...)                                                                         \
    do {                                                                                                     \
        const cscd_object_change list[] = {__VA_ARGS__};                                                     \
        check_refused(context, old, list, sizeof list / sizeof *list, status, detail);                       \
    } while (0)
    REFUSED(CSCD_INVALID_ARGUMENT, "change 0 names object 2, but there are 2", {.object = 2, .desc = &desc});
    REFUSED(CSCD_INVALID_ARGUMENT, "change 1 names object 1, as change 0 does", {.object = 1, .desc = &desc},
            {.object = 1});
    REFUSED(CSCD_INVALID_ARGUMENT, "change 0 is a new object without a desc", {.object = UINT32_MAX});
    REFUSED(CSCD_INVALID_ARGUMENT, "its object is new",
            {.object = UINT32_MAX, .desc = &desc, .vertex_origins = far_origins});
    REFUSED(CSCD_INVALID_ARGUMENT, "its object is removed", {.object = 0, .triangle_origins = far_origins});
    REFUSED(CSCD_INVALID_ARGUMENT, "vertex 2 was vertex 4, but the old object has 4 vertices",
            {.object = 0, .desc = &desc, .vertex_origins = far_origins});
    REFUSED(CSCD_INVALID_ARGUMENT, "triangle 1 was triangle 4, but the old object has 2 triangles",
            {.object = 0, .desc = &desc, .triangle_origins = far_origins + 1});
    REFUSED(CSCD_INVALID_ARGUMENT, "reserved", {.object = 0, .reserved = 7, .desc = &desc});
    REFUSED(CSCD_INVALID_MESH, "object 1: triangle 1 names vertex 4", {.object = 1, .desc = &wrong});
    REFUSED(CSCD_INVALID_MESH, "object 2: triangle 1 names vertex 4", {.object = UINT32_MAX, .desc = &wrong});
    REFUSED(CSCD_INVALID_MESH, "triangle 1 names vertex 4", {.object = 0}, {.object = 1, .desc = &wrong});
    REFUSED(CSCD_INVALID_MESH, "object 0: the mesh is empty", {.object = 0, .desc = &empty});
    REFUSED(CSCD_INVALID_MESH, "every object is removed", {.object = 0}, {.object = 1});
    check_refused(context, old, NULL, 1, CSCD_INVALID_ARGUMENT, "changes is NULL");
    const cscd_object_change good = {.object = 0, .desc = &desc};
    cscd_mesh_change *made = NULL;
    assert_int_equal(cscd_mesh_change_create(context, old, &good, 1, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_mesh_change_create(NULL, old, &good, 1, &made), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_mesh_change_create(context, NULL, &good, 1, &made), CSCD_NULL_OBJECT);
    cscd_mesh_change_destroy(NULL);
    cscd_mesh_destroy(old);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

/* No change at all: a mesh of its own that equals the old one. */
TEST(no_change) {
    random_stream random = stream_start(2);
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    changing_scene_make(&random, true, &changing);
    cscd_mesh *old = changing_scene_mesh(context, &changing);
    cscd_mesh_change *made = NULL;
    change.count = 0;
    assert_int_equal(cscd_mesh_change_create(context, old, NULL, 0, &made), CSCD_OK);
    assert_ptr_not_equal(cscd_mesh_change_mesh(made), old);
    check_same_mesh(cscd_mesh_change_mesh(made), old);
    assert_int_equal(check_components(made, old), old->component_count);
    cscd_mesh_change_destroy(made);
    cscd_mesh_destroy(old);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}
