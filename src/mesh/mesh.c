/* The mesh of the public API: checks what it is given, copies it, and answers questions about it. */
#include "src/mesh/mesh.h"

#include "src/core/least_sizes.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* Corners are numbered by 32 bits: 3 * triangle_count must fit. */
enum { TRIANGLE_COUNT_MAX = (int)(UINT32_MAX / 3) };

/* Every vertex costs memory and time in many places, whether a triangle has it or not. A host may keep all its
 * vertices in one array, of which a mesh uses a part: this many without a triangle take some ten milliseconds. */
enum { SPARE_VERTICES = 1 << 24, SPARE_VERTICES_OF_TRIANGLE = 256 };

/* The mesh that its creator has, and the number of those who hold it. */
typedef struct shared_mesh {
    reference_count references;
    cscd_mesh mesh;
} shared_mesh;

static void free_mesh(reference_count *references);

/* The name of an object in messages: "" if it is the only one, else for instance "object 2: ". */
typedef struct object_name {
    char text[32];
} object_name;

static object_name name_of(uint32_t object, uint32_t object_count) {
    object_name name = {""};
    if (object_count > 1) snprintf(name.text, sizeof name.text, "object %u: ", object);
    return name;
}

static cscd_status check_triangle(cscd_context *context, const cscd_object_desc *desc, uint32_t triangle,
                                  const char *object) {
    const uint32_t *v = desc->triangles + (size_t)triangle * 3;
    for (int i = 0; i < 3; i++) {
        if (v[i] >= desc->vertex_count)
            return context_fail(context, CSCD_INVALID_MESH,
                                "%striangle %u names vertex %u, but there are %u vertices", object, triangle,
                                v[i], desc->vertex_count);
    }
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        return context_fail(context, CSCD_INVALID_MESH,
                            "%striangle %u (%u %u %u) repeats a vertex; remove it or weld differently",
                            object, triangle, v[0], v[1], v[2]);
    return CSCD_OK;
}

static cscd_status check_desc(cscd_context *context, const cscd_object_desc *desc, const char *object) {
    static const uint8_t zeros[sizeof desc->reserved];
    if (memcmp(desc->reserved, zeros, sizeof zeros) != 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%sreserved is not 0", object);
    cscd_status status = loose_desc_check(context, desc, object);
    if (status != CSCD_OK || desc->kind != CSCD_OBJECT_TRIANGLES) return status;
    if (desc->vertex_count == 0 || desc->triangle_count == 0)
        return context_fail(context, CSCD_INVALID_MESH, "%sthe mesh is empty: %u vertices, %u triangles",
                            object, desc->vertex_count, desc->triangle_count);
    if (desc->triangles == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%striangles is NULL, but there are to be %u",
                            object, desc->triangle_count);
    return CSCD_OK;
}

static cscd_status check_totals(cscd_context *context, uint64_t vertices, uint64_t triangles,
                                const loose_totals *loose) {
    if (triangles > TRIANGLE_COUNT_MAX)
        return context_fail(context, CSCD_INVALID_MESH, "%llu triangles are too many: the ceiling is %d",
                            (unsigned long long)triangles, TRIANGLE_COUNT_MAX);
    if (vertices >= UINT32_MAX)
        return context_fail(context, CSCD_INVALID_MESH, "%llu vertices are too many: the ceiling is 2^32 - 2",
                            (unsigned long long)vertices);
    uint64_t most = SPARE_VERTICES + triangles * SPARE_VERTICES_OF_TRIANGLE + loose_totals_vertices(loose);
    if (vertices > most)
        return context_fail(
            context, CSCD_INVALID_MESH,
            "%llu vertices are too many for %llu triangle%s: each takes memory, so the ceiling "
            "is 2^24 and %d more for each triangle; leave out vertices that no triangle has",
            (unsigned long long)vertices, (unsigned long long)triangles, triangles == 1 ? "" : "s",
            SPARE_VERTICES_OF_TRIANGLE);
    return CSCD_OK;
}

static uint32_t number_of(const described_objects *objects, uint32_t index) {
    return objects->numbers != NULL ? objects->numbers[index] : index;
}

cscd_status mesh_check_objects(cscd_context *context, const described_objects *objects) {
    uint64_t vertices = objects->other_vertices, triangles = objects->other_triangles;
    loose_totals loose = objects->other_loose;
    for (uint32_t i = 0; i < objects->count; i++) {
        object_name name = name_of(number_of(objects, i), objects->total);
        cscd_status status = check_desc(context, &objects->descs[i], name.text);
        if (status != CSCD_OK) return status;
        vertices += objects->descs[i].vertex_count;
        triangles += objects->descs[i].triangle_count;
        loose_totals_add(&loose, &objects->descs[i]);
    }
    cscd_status status = check_totals(context, vertices, triangles, &loose);
    if (status == CSCD_OK) status = loose_totals_check(context, &loose, triangles);
    for (uint32_t i = 0; i < objects->count && status == CSCD_OK; i++) {
        object_name name = name_of(number_of(objects, i), objects->total);
        for (uint32_t t = 0; t < objects->descs[i].triangle_count && status == CSCD_OK; t++)
            status = check_triangle(context, &objects->descs[i], t, name.text);
    }
    return status;
}

/* ---- objects ----------------------------------------------------------------------------------------- */

static cscd_status join_objects(cscd_mesh *mesh, const cscd_object_desc *objects, uint32_t count) {
    mesh->object_count = count;
    mesh->objects = context_allocate(mesh->context, count, sizeof *mesh->objects);
    if (mesh->objects == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const cscd_object_desc *desc = &objects[i];
        mesh->objects[i] = (cscd_object){.first_vertex = mesh->vertex_count,
                                         .vertex_count = desc->vertex_count,
                                         .first_triangle = mesh->triangle_count,
                                         .triangle_count = desc->triangle_count,
                                         .obstacle = desc->obstacle,
                                         .kind = desc->kind};
        mesh->vertex_count += desc->vertex_count;
        mesh->triangle_count += desc->triangle_count;
    }
    mesh->triangles = context_allocate(mesh->context, mesh->triangle_count, sizeof *mesh->triangles);
    if (mesh->triangles == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const cscd_object *object = &mesh->objects[i];
        const uint32_t *from = objects[i].triangles;
        uint32_t *to = mesh->triangles[object->first_triangle];
        for (size_t k = 0; k < (size_t)object->triangle_count * 3; k++)
            to[k] = object->first_vertex + from[k];
    }
    return CSCD_OK;
}

/* Edges are sorted by their smaller vertices, so the edges of an object are consecutive. */
static void find_edges_of_objects(cscd_mesh *mesh) {
    uint32_t edge = 0;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        cscd_object *object = &mesh->objects[i];
        uint32_t end = object->first_vertex + object->vertex_count;
        object->first_edge = edge;
        while (edge < mesh->edge_count && mesh->edges[edge][0] < end) edge++;
        object->edge_count = edge - object->first_edge;
    }
}

/* Marks the components of objects that are obstacles; no component spans two objects. */
static cscd_status mark_obstacles(cscd_mesh *mesh) {
    bool any = false;
    for (uint32_t i = 0; i < mesh->object_count; i++) any |= mesh->objects[i].obstacle;
    if (!any) return CSCD_OK;
    mesh->obstacles = context_allocate(mesh->context, mesh->component_count, sizeof *mesh->obstacles);
    if (mesh->obstacles == NULL) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        const cscd_object *object = &mesh->objects[i];
        for (uint32_t t = 0; t < object->triangle_count; t++)
            mesh->obstacles[mesh->triangle_components[object->first_triangle + t]] = object->obstacle;
    }
    return CSCD_OK;
}

cscd_status mesh_build_objects(cscd_mesh *mesh, const cscd_object_desc *objects, uint32_t count) {
    cscd_status status = join_objects(mesh, objects, count);
    if (status == CSCD_OK) status = mesh_build_topology(mesh);
    if (status == CSCD_OK) status = mesh_add_wires(mesh, objects);
    if (status == CSCD_OK) status = mesh_build_components(mesh);
    if (status == CSCD_OK) status = mark_obstacles(mesh);
    if (status != CSCD_OK) return status;
    find_edges_of_objects(mesh);
    status = mesh_list_loose_objects(mesh);
    for (uint32_t i = 0; status == CSCD_OK && mesh->loose.normals != NULL && i < count; i++)
        memcpy(mesh->loose.normals[i], objects[i].normal, sizeof objects[i].normal);
    return status;
}

cscd_mesh *mesh_begin(cscd_context *context) {
    shared_mesh *shared = context_allocate(context, 1, sizeof *shared);
    if (shared == NULL) return NULL;
    shared->mesh.context = context;
    shared->mesh.shared = shared;
    context_add_object(context, &shared->references, free_mesh);
    return &shared->mesh;
}

static const char *validate_shared(const reference_count *object) {
    return mesh_validate(&((const shared_mesh *)object)->mesh);
}

void mesh_list(cscd_mesh *mesh) {
    context_list_object(mesh->context, &mesh->shared->references, validate_shared);
}

static cscd_status create_mesh(cscd_context *context, const cscd_object_desc *objects, uint32_t count,
                               cscd_mesh **out) {
    const described_objects described = {.descs = objects, .count = count, .total = count};
    cscd_status status = mesh_check_objects(context, &described);
    if (status != CSCD_OK) return status;
    cscd_mesh *mesh = mesh_begin(context);
    if (mesh == NULL) return context_out_of_memory(context);
    if (mesh_build_objects(mesh, objects, count) != CSCD_OK) {
        cscd_mesh_destroy(mesh);
        return context_out_of_memory(context);
    }
    mesh_list(mesh);
    *out = mesh;
    return CSCD_OK;
}

cscd_status mesh_take_objects(cscd_context *context, const cscd_object_desc *objects, size_t object_size,
                              uint32_t count, cscd_object_desc *out) {
    const char *bytes = (const char *)objects;
    cscd_status status = CSCD_OK;
    memset(out, 0, count * sizeof *out);
    for (uint32_t i = 0; i < count && status == CSCD_OK; i++)
        status = struct_take(context, &out[i], sizeof *out, LEAST_SIZE(cscd_object_desc),
                             bytes + i * object_size, object_size, "cscd_object_desc");
    return status;
}

static cscd_status create_from_descriptions(cscd_context *context, const cscd_object_desc *objects,
                                            size_t object_size, uint32_t object_count, cscd_mesh **out) {
    if (objects == NULL || out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_mesh_create: %s is NULL",
                            out == NULL ? "out" : "objects");
    if (object_count == 0)
        return context_fail(context, CSCD_INVALID_MESH, "the mesh is empty: object_count is 0");
    cscd_object_desc *taken = context_allocate(context, object_count, sizeof *taken);
    if (taken == NULL) return context_out_of_memory(context);
    cscd_status status = mesh_take_objects(context, objects, object_size, object_count, taken);
    if (status == CSCD_OK) status = create_mesh(context, taken, object_count, out);
    context_free(context, taken);
    return status;
}

cscd_status cscd_mesh_create_sized(cscd_context *context, const cscd_object_desc *objects, size_t object_size,
                                   uint32_t object_count, cscd_mesh **out) {
    if (context == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!context_enter(context, &entry)) return entry.status;
    return context_leave(&entry, create_from_descriptions(context, objects, object_size, object_count, out));
}

/* The arrays are allocated one stage after the other, since the size of one follows from what another
 * holds. */
static array_list mesh_arrays(cscd_mesh *mesh) {
    return (array_list){
        {ARRAY(mesh->triangles, 0), ARRAY(mesh->edges, 0), ARRAY(mesh->triangle_edges, 0),
         ARRAY(mesh->vertex_star_offsets, 0), ARRAY(mesh->vertex_stars, 0), ARRAY(mesh->edge_star_offsets, 0),
         ARRAY(mesh->edge_stars, 0), ARRAY(mesh->triangle_components, 0), ARRAY(mesh->components, 0),
         ARRAY(mesh->objects, 0), ARRAY(mesh->obstacles, 0), ARRAY(mesh->loose.wire_star_offsets, 0),
         ARRAY(mesh->loose.wire_stars, 0), ARRAY(mesh->loose.normals, 0)}};
}

static void free_mesh(reference_count *references) {
    shared_mesh *shared = (shared_mesh *)references;
    cscd_context *context = shared->mesh.context;
    context_free_all(context, mesh_arrays(&shared->mesh));
    context_free(context, shared);
    context_release(context);
}

const cscd_mesh *mesh_of_creator(const cscd_mesh *mesh) {
    return mesh->shared != NULL ? &mesh->shared->mesh : mesh;
}

void mesh_hold(const cscd_mesh *mesh) {
    reference_add(&mesh->shared->references);
}

void mesh_release(const cscd_mesh *mesh) {
    shared_mesh *shared = mesh->shared;
    context_drop_object(shared->mesh.context, &shared->references);
}

void cscd_mesh_destroy(cscd_mesh *mesh) {
    if (mesh != NULL) context_destroy_object(mesh->context, &mesh->shared->references);
}

cscd_mesh mesh_seen_from(cscd_context *context, const cscd_mesh *mesh) {
    cscd_mesh view = *mesh;
    view.context = context;
    return view;
}

cscd_context *cscd_mesh_context(const cscd_mesh *mesh) {
    return mesh->context;
}

uint32_t cscd_mesh_count(const cscd_mesh *mesh, cscd_element what) {
    return what == CSCD_VERTICES     ? mesh->vertex_count
           : what == CSCD_EDGES      ? mesh->edge_count
           : what == CSCD_TRIANGLES  ? mesh->triangle_count
           : what == CSCD_COMPONENTS ? mesh->component_count
                                     : mesh->object_count;
}

const uint32_t *cscd_mesh_array(const cscd_mesh *mesh, cscd_mesh_array_kind kind) {
    return kind == CSCD_TRIANGLE_VERTICES     ? mesh->triangles[0]
           : kind == CSCD_TRIANGLE_EDGES      ? mesh->triangle_edges[0]
           : kind == CSCD_TRIANGLE_COMPONENTS ? mesh->triangle_components
                                              : mesh->edges[0];
}

const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count) {
    assert(vertex < mesh->vertex_count);
    *count = mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
    return mesh->vertex_stars + mesh->vertex_star_offsets[vertex];
}

const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count) {
    assert(edge < mesh->edge_count);
    *count = edge_star_size(mesh, edge);
    return mesh->edge_stars + mesh->edge_star_offsets[edge];
}

cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component) {
    assert(component < mesh->component_count);
    return mesh->components[component];
}

cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object) {
    assert(object < mesh->object_count);
    return mesh->objects[object];
}

uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex) {
    assert(vertex < mesh->vertex_count);
    uint32_t low = 0, high = mesh->object_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (mesh->objects[middle].first_vertex <= vertex)
            low = middle;
        else
            high = middle;
    }
    return low;
}

cscd_stencil mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b, double u,
                          double v) {
    cscd_stencil s = {.weights = {0.0}};
    mesh_vertices_of_pair(mesh, kind, a, b, s.vertices);
    cscd_stencil_weights(kind, u, v, s.weights);
    return s;
}

cscd_stencil cscd_mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                               double u, double v) {
    float_environment host = float_environment_begin();
    cscd_stencil stencil = mesh_stencil(mesh, kind, a, b, u, v);
    float_environment_set(host);
    return stencil;
}
