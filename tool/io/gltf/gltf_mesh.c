/* The meshes of a glTF file: vertices with their morph targets and joints, and triangles. */
#include "tool/io/gltf/gltf_scene.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef enum primitive_mode { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 } primitive_mode;

/* A primitive while its mesh is read. */
typedef struct gltf_primitive {
    gltf_document *document;
    gltf_element element, attributes;
    gltf_mesh *mesh;
    uint32_t target_count;
} gltf_primitive;

/* ---- vertices ---------------------------------------------------------------------------------------- */

static bool push_index(growable *accessors, const gltf_element *element, const char *key) {
    int64_t number = -1;
    uint32_t *index = growable_push(accessors);
    if (index == NULL) return gltf_fail(element, "out of memory");
    if (!gltf_integer(element, key, 0, INT64_C(1) << 53, &number)) return false;
    *index = (uint32_t)number;
    return true;
}

static bool target_at(const gltf_primitive *primitive, uint32_t target, gltf_element *out) {
    return gltf_element_at(&primitive->element, "targets", "target", target, out);
}

/* The indices of all accessors of the vertices, or GLTF_NONE where there is none. */
static bool list_accessors(const gltf_primitive *primitive, growable *accessors) {
    if (!push_index(accessors, &primitive->attributes, "POSITION")) return false;
    const uint32_t set_count = gltf_joints_sets(&primitive->attributes);
    for (uint32_t set = 0; set < set_count; set++) {
        const gltf_joint_names names = gltf_joints_name(set);
        if (!push_index(accessors, &primitive->attributes, names.joints) ||
            !push_index(accessors, &primitive->attributes, names.weights))
            return false;
    }
    for (uint32_t i = 0; i < primitive->target_count; i++) {
        gltf_element target;
        if (!target_at(primitive, i, &target) || !push_index(accessors, &target, "POSITION")) return false;
    }
    return true;
}

/* The vertices of an earlier primitive with the same accessors; NULL: there are none. */
static gltf_vertices *find_shared(const gltf_mesh *mesh, const growable *accessors) {
    for (uint32_t i = 0; i < mesh->vertices_count; i++) {
        const growable *other = &mesh->vertices[i].accessors;
        if (other->count == accessors->count &&
            memcmp(other->data, accessors->data, accessors->count * sizeof(uint32_t)) == 0)
            return &mesh->vertices[i];
    }
    return NULL;
}

static bool open_targets(const gltf_primitive *primitive, gltf_vertices *vertices) {
    vertices->targets =
        gltf_allocate(primitive->document->reader, primitive->target_count, sizeof *vertices->targets);
    if (vertices->targets == NULL) return false;
    for (uint32_t i = 0; i < primitive->target_count; i++) {
        gltf_element target;
        gltf_accessor *accessor = &vertices->targets[i];
        bool given;
        *accessor =
            (gltf_accessor){.components = 3, .component = GLTF_FLOAT, .count = vertices->positions.count};
        if (!target_at(primitive, i, &target) ||
            !gltf_accessor_open(primitive->document, &target, "POSITION", 3, accessor, &given))
            return false;
        if (accessor->count != vertices->positions.count)
            return gltf_fail(&target,
                             "POSITION is of %" PRIu32 " vertices, that of the primitive of %" PRIu32,
                             accessor->count, vertices->positions.count);
    }
    return true;
}

static bool open_vertices(const gltf_primitive *primitive, gltf_vertices *vertices) {
    gltf_mesh *mesh = primitive->mesh;
    if (!gltf_accessor_require(primitive->document, &primitive->attributes, "POSITION", 3,
                               &vertices->positions) ||
        !open_targets(primitive, vertices) ||
        !gltf_joints_read(primitive->document, &primitive->attributes, vertices))
        return false;
    if (vertices->positions.count > INT32_MAX - mesh->vertex_count)
        return gltf_fail(&primitive->element, "the mesh has more than %" PRId32 " vertices", INT32_MAX);
    vertices->first = mesh->vertex_count;
    mesh->vertex_count += vertices->positions.count;
    return true;
}

/* Compressed primitives have accessors without data, which would be read as zeros; some files have both. */
static bool refuse_compressed(const gltf_primitive *primitive, const gltf_accessor *positions) {
    static const char draco[] = "KHR_draco_mesh_compression";
    gltf_element extensions;
    if (!gltf_object(&primitive->element, "extensions", &extensions)) return false;
    if (positions->data != NULL || extensions.value == NULL || !gltf_has(&extensions, draco)) return true;
    return gltf_fail(&primitive->element,
                     "uses the extension %s, which is not read; export it without compression", draco);
}

static bool read_vertices(gltf_primitive *primitive, gltf_vertices **out) {
    gltf_mesh *mesh = primitive->mesh;
    growable accessors = growable_of(sizeof(uint32_t));
    if (!list_accessors(primitive, &accessors)) {
        growable_free(&accessors);
        return false;
    }
    *out = find_shared(mesh, &accessors);
    if (*out != NULL) {
        growable_free(&accessors);
        return true;
    }
    *out = &mesh->vertices[mesh->vertices_count++]; /* what fails is freed with the mesh */
    (*out)->accessors = accessors;
    return open_vertices(primitive, *out) && refuse_compressed(primitive, &(*out)->positions);
}

/* ---- triangles --------------------------------------------------------------------------------------- */

/* The corners of a primitive: of its indices, or of its vertices in their order. */
typedef struct primitive_corners {
    gltf_accessor indices;
    bool indexed;
    uint32_t count;
} primitive_corners;

static bool open_corners(const gltf_primitive *primitive, const gltf_vertices *vertices,
                         primitive_corners *out) {
    primitive_corners corners = {.count = vertices->positions.count};
    if (!gltf_accessor_open(primitive->document, &primitive->element, "indices", 1, &corners.indices,
                            &corners.indexed))
        return false;
    if (corners.indexed) {
        corners.count = corners.indices.count;
        if (!gltf_accessor_is_index(&corners.indices))
            return gltf_fail(&primitive->element, "indices are no unsigned integers");
    }
    *out = corners;
    return true;
}

static bool corner_vertex(const gltf_primitive *primitive, const gltf_vertices *vertices,
                          const primitive_corners *corners, uint32_t at, uint32_t *vertex) {
    double index = at;
    if (corners->indexed) gltf_accessor_get(&corners->indices, at, &index);
    if (index >= vertices->positions.count)
        return gltf_fail(&primitive->element,
                         "index %" PRIu32 " is vertex %.0f, but there are %" PRIu32 ", from 0", at, index,
                         vertices->positions.count);
    *vertex = vertices->first + (uint32_t)index;
    return true;
}

/* Strips are sewn together by triangles without area, so that these are nothing to tell. */
static bool add_triangle(const gltf_primitive *primitive, const uint32_t corners[3], bool of_strip) {
    gltf_mesh *mesh = primitive->mesh;
    const uint32_t face = mesh->face_count++;
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
        if (of_strip) return true;
        if (mesh->dropped_count++ == 0) mesh->first_dropped = face;
        return true;
    }
    uint32_t *triangle = growable_push(&mesh->triangles);
    uint32_t *of_face = triangle == NULL ? NULL : growable_push(&mesh->faces);
    if (of_face == NULL)
        return gltf_fail(&primitive->element, "out of memory after %zu triangles", mesh->triangles.count);
    memcpy(triangle, corners, 3 * sizeof *triangle);
    *of_face = face;
    return true;
}

static bool read_triangles(const gltf_primitive *primitive, const gltf_vertices *vertices,
                           primitive_mode mode) {
    primitive_corners corners;
    if (!open_corners(primitive, vertices, &corners)) return false;
    if (mode == MODE_TRIANGLES && corners.count % 3 != 0)
        return gltf_fail(&primitive->element, "has %" PRIu32 " corners, expected a multiple of 3",
                         corners.count);
    const uint32_t step = mode == MODE_TRIANGLES ? 3 : 1;
    for (uint32_t i = 0, number = 0; i + 2 < corners.count; i += step, number++) {
        const uint32_t odd = mode == MODE_STRIP ? number % 2 : 0;
        const uint32_t places[3] = {mode == MODE_FAN ? 0 : i, i + 1 + odd, i + 2 - odd};
        uint32_t triangle[3];
        for (int k = 0; k < 3; k++)
            if (!corner_vertex(primitive, vertices, &corners, places[k], &triangle[k])) return false;
        if (!add_triangle(primitive, triangle, mode != MODE_TRIANGLES)) return false;
    }
    if (primitive->mesh->face_count > INT32_MAX)
        return gltf_fail(&primitive->element, "the mesh has more than %" PRId32 " triangles", INT32_MAX);
    return true;
}

/* ---- the mesh ---------------------------------------------------------------------------------------- */

/* Unless somebody asks for materials, one that is not there is no error. */
static bool read_material(const gltf_primitive *primitive) {
    gltf_document *document = primitive->document;
    gltf_mesh *mesh = primitive->mesh;
    size_t count;
    uint32_t material = GLTF_NONE;
    if (document->reader->parts_by != MESH_PARTS_BY_MATERIAL) return true;
    if (!gltf_array_length(&document->root, "materials", &count) ||
        !gltf_index(&primitive->element, "material", "materials", count, &material))
        return false;
    gltf_material_run *run = growable_push(&mesh->materials);
    if (run == NULL) return gltf_fail(&primitive->element, "out of memory");
    *run = (gltf_material_run){mesh->triangles.count, material};
    return true;
}

static bool read_primitive(gltf_primitive *primitive) {
    int64_t mode = MODE_TRIANGLES;
    gltf_vertices *vertices = NULL;
    if (!gltf_integer(&primitive->element, "mode", 0, 6, &mode)) return false;
    if (mode < MODE_TRIANGLES) {
        primitive->mesh->skipped_primitives++;
        return true;
    }
    return read_vertices(primitive, &vertices) && read_triangles(primitive, vertices, (primitive_mode)mode) &&
           read_material(primitive);
}

/* All primitives of a mesh have the same targets. */
static bool check_targets(const gltf_primitive *primitive, size_t index) {
    size_t count;
    if (!gltf_array_length(&primitive->element, "targets", &count)) return false;
    if (index == 0) primitive->mesh->target_count = (uint32_t)count;
    if (count == primitive->mesh->target_count) return true;
    return gltf_fail(&primitive->element, "has %zu targets, the first primitive has %" PRIu32, count,
                     primitive->mesh->target_count);
}

static bool read_primitives(gltf_document *document, const gltf_element *element, size_t count,
                            gltf_mesh *mesh) {
    for (size_t i = 0; i < count; i++) {
        gltf_primitive primitive = {.document = document, .mesh = mesh};
        if (!gltf_element_at(element, "primitives", "primitive", i, &primitive.element) ||
            !gltf_object(&primitive.element, "attributes", &primitive.attributes))
            return false;
        if (primitive.attributes.value == NULL)
            return gltf_fail(&primitive.element, "attributes are missing");
        if (!check_targets(&primitive, i)) return false;
        primitive.target_count = mesh->target_count;
        if (!read_primitive(&primitive)) return false;
    }
    return true;
}

bool gltf_mesh_open(gltf_document *document, uint32_t index, gltf_mesh *out) {
    gltf_element element;
    size_t count;
    gltf_mesh mesh = {.triangles = growable_of(3 * sizeof(uint32_t)),
                      .materials = growable_of(sizeof(gltf_material_run)),
                      .faces = growable_of(sizeof(uint32_t))};
    if (!gltf_element_at(&document->root, "meshes", "mesh", index, &element) ||
        !gltf_array_length(&element, "primitives", &count))
        return false;
    mesh.name = gltf_string(&element, "name");
    mesh.vertices = gltf_allocate(document->reader, count, sizeof *mesh.vertices);
    bool done = mesh.vertices != NULL && read_primitives(document, &element, count, &mesh);
    if (done) {
        bool given;
        mesh.default_weights = gltf_allocate(document->reader, mesh.target_count, sizeof(double));
        done = mesh.default_weights != NULL &&
               gltf_numbers(&element, "weights", mesh.target_count, mesh.default_weights, &given);
    }
    if (done)
        *out = mesh;
    else
        gltf_mesh_close(&mesh);
    return done;
}

void gltf_mesh_close(gltf_mesh *mesh) {
    for (uint32_t i = 0; i < mesh->vertices_count; i++) {
        gltf_vertices *vertices = &mesh->vertices[i];
        free(vertices->targets);
        free(vertices->joints);
        free(vertices->weights);
        growable_free(&vertices->accessors);
    }
    free(mesh->vertices);
    free(mesh->default_weights);
    growable_free(&mesh->triangles);
    growable_free(&mesh->materials);
    growable_free(&mesh->faces);
    *mesh = (gltf_mesh){0};
}
