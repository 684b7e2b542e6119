/* A binary glTF 2.0 file: a chunk of JSON, and one of arrays. Numbers are little-endian, as those of the processor. */
#include "models/mannequin/mannequin.h"

#include "tool/io/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLOATS = 5126, BYTES = 5121, INTEGERS = 5125, FRAMES_PER_SECOND = 24 };

/* The arrays, in the order in which the file has them. */
typedef enum view_kind {
    VIEW_POSITIONS,
    VIEW_BONES,
    VIEW_WEIGHTS,
    VIEW_TRIANGLES,
    VIEW_REST,
    VIEW_TIMES,
    VIEW_TURNS,
    VIEW_COUNT
} view_kind;

typedef struct skinned_arrays {
    float positions[MANNEQUIN_VERTICES_MAX][3];
    uint8_t bones[MANNEQUIN_VERTICES_MAX][4];
    float weights[MANNEQUIN_VERTICES_MAX][4];
    uint32_t triangles[MANNEQUIN_TRIANGLES_MAX][3]; /* numbered from 0 in each part */
    float rest[BONE_COUNT][16];
    float times[MANNEQUIN_FRAMES];
    float turns[BONE_COUNT][MANNEQUIN_FRAMES][4];
    const void *data[VIEW_COUNT];
    size_t sizes[VIEW_COUNT];
} skinned_arrays;

static void fill_surface(const mannequin *m, skinned_arrays *a) {
    memcpy(a->positions, m->positions, sizeof a->positions);
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const bool two = m->weights[v] > 0.0f && m->weights[v] < 1.0f;
        const uint8_t only = m->bones[v][m->weights[v] >= 1.0f];
        a->bones[v][0] = two ? m->bones[v][0] : only;
        a->bones[v][1] = two ? m->bones[v][1] : 0;
        a->weights[v][0] = two ? 1.0f - m->weights[v] : 1.0f;
        a->weights[v][1] = two ? m->weights[v] : 0.0f;
    }
    for (int part = 0; part < MANNEQUIN_PARTS; part++)
        for (uint32_t t = m->first_triangle[part]; t < m->first_triangle[part + 1]; t++)
            for (int k = 0; k < 3; k++) a->triangles[t][k] = m->triangles[t][k] - m->first_vertex[part];
}

static void fill_motion(skinned_arrays *a) {
    for (int b = 0; b < BONE_COUNT; b++) {
        for (int i = 0; i < 4; i++) a->rest[b][5 * i] = 1.0f;
        for (int i = 0; i < 3; i++) a->rest[b][12 + i] = (float)-mannequin_joints[b].place[i];
        for (int frame = 0; frame < MANNEQUIN_FRAMES; frame++) {
            const double angle = mannequin_angle(b, frame);
            a->turns[b][frame][mannequin_joints[b].axis] = (float)sin(0.5 * angle);
            a->turns[b][frame][3] = (float)cos(0.5 * angle);
            a->times[frame] = (float)frame / FRAMES_PER_SECOND;
        }
    }
}

static void list_views(const mannequin *m, skinned_arrays *a) {
    const void *data[VIEW_COUNT] = {a->positions, a->bones, a->weights, a->triangles,
                                    a->rest,      a->times, a->turns};
    const size_t sizes[VIEW_COUNT] = {m->vertex_count * sizeof a->positions[0],
                                      m->vertex_count * sizeof a->bones[0],
                                      m->vertex_count * sizeof a->weights[0],
                                      m->triangle_count * sizeof a->triangles[0],
                                      sizeof a->rest,
                                      sizeof a->times,
                                      sizeof a->turns};
    memcpy(a->data, data, sizeof data);
    memcpy(a->sizes, sizes, sizeof sizes);
}

/* ---- JSON ---------------------------------------------------------------------------------------------- */

static void write_views(json *out, const skinned_arrays *a) {
    size_t offset = 0;
    json_begin_array(out, "bufferViews");
    for (int view = 0; view < VIEW_COUNT; view++) {
        json_begin_object(out, NULL);
        json_integer(out, "buffer", 0);
        json_integer(out, "byteOffset", offset);
        json_integer(out, "byteLength", a->sizes[view]);
        json_end_object(out);
        offset += a->sizes[view];
    }
    json_end_array(out);
    json_begin_array(out, "buffers");
    json_begin_object(out, NULL);
    json_integer(out, "byteLength", offset);
    json_end_object(out);
    json_end_array(out);
}

static void begin_accessor(json *out, view_kind view, size_t offset, int component, const char *type,
                           uint32_t count) {
    json_begin_object(out, NULL);
    json_integer(out, "bufferView", (uint64_t)view);
    json_integer(out, "byteOffset", offset);
    json_integer(out, "componentType", (uint64_t)component);
    json_string(out, "type", type);
    json_integer(out, "count", count);
}

static void write_bounds(json *out, const char *key, const float *values, uint32_t count, int width,
                         double sign) {
    json_begin_array(out, key);
    for (int k = 0; k < width; k++) {
        double most = -INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            double value = sign * values[i * (uint32_t)width + (uint32_t)k];
            if (value > most) most = value;
        }
        json_number(out, NULL, sign * most);
    }
    json_end_array(out);
}

/* Four for each part, then the bones at rest, the times, and how each bone turns. */
static void write_accessors(json *out, const mannequin *m, const skinned_arrays *a) {
    json_begin_array(out, "accessors");
    for (int part = 0; part < MANNEQUIN_PARTS; part++) {
        const uint32_t v = m->first_vertex[part], vertices = m->first_vertex[part + 1] - v,
                       t = m->first_triangle[part], triangles = m->first_triangle[part + 1] - t;
        begin_accessor(out, VIEW_POSITIONS, v * sizeof a->positions[0], FLOATS, "VEC3", vertices);
        write_bounds(out, "min", a->positions[v], vertices, 3, -1.0);
        write_bounds(out, "max", a->positions[v], vertices, 3, 1.0);
        json_end_object(out);
        begin_accessor(out, VIEW_BONES, v * sizeof a->bones[0], BYTES, "VEC4", vertices);
        json_end_object(out);
        begin_accessor(out, VIEW_WEIGHTS, v * sizeof a->weights[0], FLOATS, "VEC4", vertices);
        json_end_object(out);
        begin_accessor(out, VIEW_TRIANGLES, t * sizeof a->triangles[0], INTEGERS, "SCALAR", 3 * triangles);
        json_end_object(out);
    }
    begin_accessor(out, VIEW_REST, 0, FLOATS, "MAT4", BONE_COUNT);
    json_end_object(out);
    begin_accessor(out, VIEW_TIMES, 0, FLOATS, "SCALAR", MANNEQUIN_FRAMES);
    write_bounds(out, "min", a->times, MANNEQUIN_FRAMES, 1, -1.0);
    write_bounds(out, "max", a->times, MANNEQUIN_FRAMES, 1, 1.0);
    json_end_object(out);
    for (size_t b = 0; b < BONE_COUNT; b++) {
        begin_accessor(out, VIEW_TURNS, b * sizeof a->turns[0], FLOATS, "VEC4", MANNEQUIN_FRAMES);
        json_end_object(out);
    }
    json_end_array(out);
}

static void write_meshes(json *out) {
    json_begin_array(out, "meshes");
    for (uint64_t part = 0; part < MANNEQUIN_PARTS; part++) {
        json_begin_object(out, NULL);
        json_begin_array(out, "primitives");
        json_begin_object(out, NULL);
        json_begin_object(out, "attributes");
        json_integer(out, "POSITION", 4 * part);
        json_integer(out, "JOINTS_0", 4 * part + 1);
        json_integer(out, "WEIGHTS_0", 4 * part + 2);
        json_end_object(out);
        json_integer(out, "indices", 4 * part + 3);
        json_end_object(out);
        json_end_array(out);
        json_end_object(out);
    }
    json_end_array(out);
}

static void write_joint(json *out, int bone) {
    const mannequin_joint *joint = &mannequin_joints[bone];
    bool has_children = false;
    json_begin_object(out, NULL);
    json_string(out, "name", joint->name);
    json_begin_array(out, "translation");
    for (int i = 0; i < 3; i++)
        json_number(out, NULL,
                    joint->place[i] - (joint->parent < 0 ? 0.0 : mannequin_joints[joint->parent].place[i]));
    json_end_array(out);
    for (int child = bone + 1; child < BONE_COUNT; child++) {
        if (mannequin_joints[child].parent != bone) continue;
        if (!has_children) json_begin_array(out, "children");
        has_children = true;
        json_integer(out, NULL, (uint64_t)child);
    }
    if (has_children) json_end_array(out);
    json_end_object(out);
}

/* Bones first, then the parts. */
static void write_nodes(json *out) {
    json_begin_array(out, "nodes");
    for (int b = 0; b < BONE_COUNT; b++) write_joint(out, b);
    for (uint64_t part = 0; part < MANNEQUIN_PARTS; part++) {
        json_begin_object(out, NULL);
        json_string(out, "name", mannequin_part_names[part]);
        json_integer(out, "mesh", part);
        json_integer(out, "skin", 0);
        json_end_object(out);
    }
    json_end_array(out);
    json_begin_array(out, "scenes");
    json_begin_object(out, NULL);
    json_begin_array(out, "nodes");
    json_integer(out, NULL, BONE_TRUNK);
    for (uint64_t part = 0; part < MANNEQUIN_PARTS; part++) json_integer(out, NULL, BONE_COUNT + part);
    json_end_array(out);
    json_end_object(out);
    json_end_array(out);
    json_integer(out, "scene", 0);
}

static void write_skin(json *out) {
    json_begin_array(out, "skins");
    json_begin_object(out, NULL);
    json_integer(out, "inverseBindMatrices", 4 * MANNEQUIN_PARTS);
    json_begin_array(out, "joints");
    for (uint64_t b = 0; b < BONE_COUNT; b++) json_integer(out, NULL, b);
    json_end_array(out);
    json_end_object(out);
    json_end_array(out);
}

static void write_animation(json *out) {
    json_begin_array(out, "animations");
    json_begin_object(out, NULL);
    json_string(out, "name", "Swing");
    json_begin_array(out, "channels");
    for (uint64_t b = 0; b < BONE_COUNT; b++) {
        json_begin_object(out, NULL);
        json_integer(out, "sampler", b);
        json_begin_object(out, "target");
        json_integer(out, "node", b);
        json_string(out, "path", "rotation");
        json_end_object(out);
        json_end_object(out);
    }
    json_end_array(out);
    json_begin_array(out, "samplers");
    for (uint64_t b = 0; b < BONE_COUNT; b++) {
        json_begin_object(out, NULL);
        json_integer(out, "input", 4 * MANNEQUIN_PARTS + 1);
        json_integer(out, "output", 4 * MANNEQUIN_PARTS + 2 + b);
        json_end_object(out);
    }
    json_end_array(out);
    json_end_object(out);
    json_end_array(out);
}

static void write_document(FILE *file, const mannequin *m, const skinned_arrays *a) {
    json out = {.file = file};
    json_begin_object(&out, NULL);
    json_begin_object(&out, "asset");
    json_string(&out, "version", "2.0");
    json_end_object(&out);
    write_nodes(&out);
    write_meshes(&out);
    write_skin(&out);
    write_animation(&out);
    write_accessors(&out, m, a);
    write_views(&out, a);
    json_end_object(&out);
}

/* ---- the file ------------------------------------------------------------------------------------------ */

static bool write_chunks(FILE *file, const char *text, size_t text_size, const skinned_arrays *a) {
    size_t bytes = 0;
    for (int view = 0; view < VIEW_COUNT; view++) bytes += a->sizes[view];
    const uint32_t padded = (uint32_t)(text_size + 3) / 4 * 4;
    const uint32_t header[5] = {0x46546c67, 2, 12 + 8 + padded + 8 + (uint32_t)bytes, padded, 0x4e4f534a};
    const uint32_t binary[2] = {(uint32_t)bytes, 0x004e4942};
    bool good = fwrite(header, sizeof header, 1, file) == 1 && fwrite(text, text_size, 1, file) == 1;
    for (size_t i = text_size; i < padded; i++) good = good && fputc(' ', file) != EOF;
    good = good && fwrite(binary, sizeof binary, 1, file) == 1;
    for (int view = 0; view < VIEW_COUNT; view++)
        good = good && fwrite(a->data[view], a->sizes[view], 1, file) == 1;
    return good;
}

static bool write_arrays(const char *path, const mannequin *m, const skinned_arrays *a) {
    char *text = NULL;
    size_t text_size = 0;
    FILE *memory = open_memstream(&text, &text_size);
    if (memory == NULL) return false;
    write_document(memory, m, a);
    bool good = fclose(memory) == 0;
    FILE *file = good ? fopen(path, "wb") : NULL;
    good = file != NULL && write_chunks(file, text, text_size, a);
    if (file != NULL) good = fclose(file) == 0 && good;
    free(text);
    return good;
}

bool skinned_file_write(const char *path, const mannequin *m, io_error *error) {
    skinned_arrays *a = calloc(1, sizeof *a);
    if (a != NULL) {
        fill_surface(m, a);
        fill_motion(a);
        list_views(m, a);
    }
    const bool good = a != NULL && write_arrays(path, m, a);
    if (!good) io_fail(error, "%s: cannot be written", path);
    free(a);
    return good;
}
