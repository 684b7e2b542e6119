/* The mesh of a glTF file in its rest state, and its parts. */
#include "tool/io/gltf/gltf_scene.h"

#include "tool/io/format_reader.h"
#include "tool/io/io.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- parts --------------------------------------------------------------------------------------------- */

/* The names that are taken, by their hash; scenes of cities have 100,000 nodes. */
typedef struct name_table {
    mesh_parts *parts;
    uint32_t *slots;    /* slot_count, a power of two: a part, or NO_MESH_PART */
    uint32_t *suffixes; /* of each part: the last number that was tried behind its name */
    size_t slot_count;
} name_table;

static uint64_t hash_name(const char *name) {
    uint64_t hash = 0xcbf29ce484222325u; /* FNV-1a */
    for (; *name != '\0'; name++) hash = (hash ^ (unsigned char)*name) * 0x100000001b3u;
    return hash;
}

/* The slot of the part of that name, or the free one where it belongs: fewer than half of all are taken. */
static uint32_t *find_slot(const name_table *table, const char *name) {
    size_t at = hash_name(name) & (table->slot_count - 1);
    while (table->slots[at] != NO_MESH_PART && strcmp(table->parts->names[table->slots[at]], name) != 0)
        at = (at + 1) & (table->slot_count - 1);
    return &table->slots[at];
}

static bool open_table(file_reader *reader, uint32_t name_count, mesh_parts *parts, name_table *out) {
    name_table table = {.parts = parts, .slot_count = 4};
    while (table.slot_count < 2 * (size_t)name_count + 2) table.slot_count *= 2;
    table.slots = gltf_allocate(reader, table.slot_count, sizeof *table.slots);
    table.suffixes = gltf_allocate(reader, name_count, sizeof *table.suffixes);
    *out = table;
    if (table.slots == NULL || table.suffixes == NULL) return false;
    for (size_t i = 0; i < table.slot_count; i++) table.slots[i] = NO_MESH_PART;
    return true;
}

static void close_table(name_table *table) {
    free(table->slots);
    free(table->suffixes);
}

static const char *base_name(const gltf_scene *scene, const gltf_instance *instance, char number[32]) {
    const char *own = scene->nodes.nodes[instance->node].name, *shared = scene->meshes[instance->mesh].name;
    if (own != NULL && own[0] != '\0') return own;
    if (shared != NULL && shared[0] != '\0') return shared;
    snprintf(number, 32, "node %" PRIu32, instance->node);
    return number;
}

/* The next part, called by this name or, if that is taken, with a number behind it. */
static bool add_name(name_table *table, file_reader *reader, const char *base) {
    const size_t size = strlen(base) + 16;
    char *name = gltf_allocate(reader, size, 1);
    if (name == NULL) return false;
    snprintf(name, size, "%s", base);
    uint32_t *slot = find_slot(table, name);
    const uint32_t owner = *slot;
    while (*slot != NO_MESH_PART) {
        snprintf(name, size, "%s.%03" PRIu32, base, ++table->suffixes[owner]);
        slot = find_slot(table, name);
    }
    *slot = table->parts->count;
    table->parts->names[table->parts->count++] = name;
    return true;
}

static bool name_instances(const gltf_scene *scene, uint32_t count, name_table *table) {
    uint32_t *of_triangle = table->parts->of_triangle;
    for (uint32_t i = 0; i < count; i++) {
        const gltf_instance *instance = &scene->instances[i];
        const size_t triangle_count = scene->meshes[instance->mesh].triangles.count;
        char number[32];
        if (triangle_count == 0) continue;
        for (size_t t = 0; t < triangle_count; t++) *of_triangle++ = table->parts->count;
        if (!add_name(table, scene->document.reader, base_name(scene, instance, number))) return false;
    }
    return true;
}

/* ---- materials ----------------------------------------------------------------------------------------- */

static bool add_material(name_table *table, const gltf_scene *scene, uint32_t material) {
    char number[32];
    gltf_element element;
    if (!gltf_element_at(&scene->document.root, "materials", "material", material, &element)) return false;
    const char *own = gltf_string(&element, "name");
    snprintf(number, sizeof number, "material %" PRIu32, material);
    return add_name(table, scene->document.reader, own != NULL && own[0] != '\0' ? own : number);
}

/* parts_of: of each material of the file, NO_MESH_PART where it is none yet. */
static bool label_mesh(const gltf_scene *scene, const gltf_mesh *mesh, name_table *table, uint32_t *parts_of,
                       uint32_t *of_triangle) {
    const gltf_material_run *runs = mesh->materials.data;
    size_t t = 0;
    for (size_t i = 0; i < mesh->materials.count; i++) {
        uint32_t part = NO_MESH_PART;
        if (runs[i].material != GLTF_NONE && t < runs[i].triangle_end) {
            uint32_t *known = &parts_of[runs[i].material];
            if (*known == NO_MESH_PART) {
                *known = table->parts->count;
                if (!add_material(table, scene, runs[i].material)) return false;
            }
            part = *known;
        }
        while (t < runs[i].triangle_end) of_triangle[t++] = part;
    }
    return true;
}

static bool name_materials(const gltf_scene *scene, uint32_t count, name_table *table) {
    uint32_t *of_triangle = table->parts->of_triangle;
    uint32_t *parts_of = gltf_allocate(scene->document.reader, count, sizeof *parts_of);
    bool done = parts_of != NULL;
    for (uint32_t i = 0; done && i < count; i++) parts_of[i] = NO_MESH_PART;
    for (uint32_t i = 0; done && i < scene->instance_count; i++) {
        const gltf_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        done = label_mesh(scene, mesh, table, parts_of, of_triangle);
        of_triangle += mesh->triangles.count;
    }
    free(parts_of);
    return done;
}

/* ---- the interface ------------------------------------------------------------------------------------- */

typedef bool part_namer(const gltf_scene *scene, uint32_t most, name_table *table);

/* most: of parts. */
static bool make_parts(const gltf_scene *scene, uint32_t most, part_namer *name, mesh_parts *out) {
    file_reader *reader = scene->document.reader;
    mesh_parts parts = {0};
    name_table table = {0};
    parts.names = gltf_allocate(reader, most, sizeof *parts.names);
    parts.of_triangle = gltf_allocate(reader, scene->triangle_count, sizeof *parts.of_triangle);
    const bool done = parts.names != NULL && parts.of_triangle != NULL &&
                      open_table(reader, most, &parts, &table) && name(scene, most, &table);
    close_table(&table);
    if (done && parts.count > 0)
        *out = parts;
    else
        mesh_parts_free(&parts);
    return done;
}

/* Nodes are called by their own name, else by that of their mesh, else "node 3"; a name that is taken gets
 * .001, .002, ... behind it. On false *out owns nothing, and the error of the scene's reader is set. */
static bool gltf_parts_of(const gltf_scene *scene, mesh_parts *out) {
    return make_parts(scene, scene->instance_count, name_instances, out);
}

/* The materials of triangles, in the order of these, by their names, else "material 3"; taken names as above.
 * The reader must have been asked for parts by material. Where no triangle has one, there are no parts. */
static bool gltf_parts_of_materials(const gltf_scene *scene, mesh_parts *out) {
    size_t count;
    if (!gltf_array_length(&scene->document.root, "materials", &count)) return false;
    if (count > INT32_MAX)
        return file_reader_fail(scene->document.reader, "more than %d materials", INT32_MAX);
    return make_parts(scene, (uint32_t)count, name_materials, out);
}

/* ---- the mesh ------------------------------------------------------------------------------------------ */

static bool allocate_mesh(const gltf_scene *scene, mesh_file *mesh) {
    file_reader *reader = scene->document.reader;
    mesh->vertex_count = scene->vertex_count;
    mesh->triangle_count = scene->triangle_count;
    mesh->positions = gltf_allocate(reader, mesh->vertex_count, 3 * sizeof *mesh->positions);
    if (mesh->positions == NULL) return false;
    mesh->triangles = gltf_allocate(reader, mesh->triangle_count, 3 * sizeof *mesh->triangles);
    if (mesh->triangles == NULL) return false;
    mesh->polygons = gltf_allocate(reader, mesh->triangle_count, sizeof *mesh->polygons);
    return mesh->polygons != NULL;
}

/* A node that mirrors its mesh turns the triangles around, as the format demands; joints leave them. */
static void write_triangles(const gltf_scene *scene, const gltf_pose *pose, mesh_file *out) {
    uint32_t *corner = out->triangles;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const gltf_instance *instance = &scene->instances[i];
        const gltf_mesh *mesh = &scene->meshes[instance->mesh];
        const gltf_transform place = gltf_pose_place(pose, instance);
        const bool mirrored = instance->skin == GLTF_NONE && gltf_transform_mirrors(&place);
        const uint32_t(*triangles)[3] = mesh->triangles.data;
        for (size_t t = 0; t < mesh->triangles.count; t++, corner += 3) {
            corner[0] = instance->first_vertex + triangles[t][0];
            corner[1] = instance->first_vertex + triangles[t][mirrored ? 2 : 1];
            corner[2] = instance->first_vertex + triangles[t][mirrored ? 1 : 2];
        }
    }
}

/* Writes which face of the file each triangle is: one that names a vertex twice is dropped, and keeps its
 * number. */
static void write_polygons(const gltf_scene *scene, mesh_file *out) {
    uint32_t *polygon = out->polygons;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const gltf_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        const uint32_t *faces = mesh->faces.data;
        for (size_t t = 0; t < mesh->faces.count; t++) *polygon++ = out->polygon_count + faces[t];
        if (mesh->dropped_count > 0 && out->repairs.dropped == 0)
            out->repairs.first_dropped = out->polygon_count + mesh->first_dropped;
        out->repairs.dropped += mesh->dropped_count;
        out->repairs.skipped_primitives += mesh->skipped_primitives;
        out->polygon_count += mesh->face_count;
    }
    out->faces_hash = MESH_HASH_START;
    for (size_t t = 0; t < out->triangle_count; t++)
        out->faces_hash = mesh_file_hash(out->faces_hash, out->triangles + 3 * t, 3);
}

/* A glTF has no groups. */
static bool find_parts(const gltf_scene *scene, mesh_file *mesh) {
    const mesh_parts_by by = scene->document.reader->parts_by;
    if (by == MESH_PARTS_BY_FILE) return gltf_parts_of(scene, &mesh->parts);
    return gltf_parts_of(scene, &mesh->own_parts) &&
           (by != MESH_PARTS_BY_MATERIAL || gltf_parts_of_materials(scene, &mesh->parts));
}

static bool read_gltf(file_reader *reader, mesh_file *out) {
    gltf_scene scene;
    gltf_pose pose = {0};
    mesh_file mesh = {0};
    if (!gltf_scene_open(reader, &scene)) return false;
    size_t animations = 0;
    const bool done = gltf_array_length(&scene.document.root, "animations", &animations) &&
                      gltf_pose_open(&scene, &pose) && allocate_mesh(&scene, &mesh) &&
                      gltf_pose_write(&pose, mesh.positions) && find_parts(&scene, &mesh) &&
                      gltf_extensions_note(&scene, &mesh.unread);
    if (done) {
        write_triangles(&scene, &pose, &mesh);
        write_polygons(&scene, &mesh);
        mesh.animation_count = animations < UINT32_MAX ? (uint32_t)animations : UINT32_MAX;
        *out = mesh;
    } else {
        mesh_file_free(&mesh);
    }
    gltf_pose_close(&pose);
    gltf_scene_close(&scene);
    return done;
}

const format_reader gltf_reader = {MESH_FORMAT_GLTF, .names_parts = true, .recognise = gltf_recognise,
                                   .read = read_gltf};
