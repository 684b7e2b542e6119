/* glTF files when memory fails, and when they are damaged; the frames of an animation take no memory of their own. */
#include "tests/support/files.h"
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"
#include "tool/io/animation.h"
#include "tool/io/io.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- small files --------------------------------------------------------------------------------------- */

/* glTF files are written piece by piece: accessors with their numbers, and the rest as text. */

/* One buffer, its views and its accessors. A zeroed struct is an empty one. */
typedef struct gltf_fixture {
    unsigned char bytes[4096];
    size_t size;
    int view_count, accessor_count;
    char views[4096], accessors[4096];
    char file[16384];
    size_t file_size;
} gltf_fixture;

static size_t size_of(int component) {
    return component <= 5121 ? 1 : component <= 5123 ? 2 : 4;
}

static void put_number(gltf_fixture *fixture, int component, double number) {
    const float single_value = (float)number;
    uint32_t bits = (uint32_t)(int64_t)number;
    if (component == 5126) memcpy(&bits, &single_value, sizeof bits);
    assert_true(fixture->size + 4 <= sizeof fixture->bytes);
    for (size_t i = 0; i < size_of(component); i++)
        fixture->bytes[fixture->size++] = (unsigned char)(bits >> 8 * i & 0xff);
}

static void append_text(char *list, size_t room, int count, const char *text) {
    const size_t used = strlen(list);
    assert_true(used + strlen(text) + 2 < room);
    snprintf(list + used, room - used, "%s%s", count > 0 ? "," : "", text);
}

/* Appends numbers to the buffer in this component type (5120 to 5126) and a view of them; gives the number of the view. */
static int gltf_fixture_view(gltf_fixture *fixture, int component, size_t count, const double *numbers) {
    char text[128];
    snprintf(text, sizeof text, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", fixture->size,
             count * size_of(component));
    append_text(fixture->views, sizeof fixture->views, fixture->view_count, text);
    for (size_t i = 0; i < count; i++) put_number(fixture, component, numbers[i]);
    while (fixture->size % 4 != 0) fixture->bytes[fixture->size++] = 0;
    return fixture->view_count++;
}

/* Appends an accessor with this JSON; gives its number. */
__attribute__((format(printf, 2, 3))) static int gltf_fixture_accessor(gltf_fixture *fixture,
                                                                       const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    const int size = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_true(size > 0 && (size_t)size < sizeof text);
    append_text(fixture->accessors, sizeof fixture->accessors, fixture->accessor_count, text);
    return fixture->accessor_count++;
}

/* Both at once: elements of a type such as "VEC3" and so many numbers in all. */
static int gltf_fixture_array(gltf_fixture *fixture, int component, const char *type, size_t count,
                              const double *numbers) {
    const size_t width = strcmp(type, "SCALAR") == 0 ? 1
                         : strcmp(type, "MAT4") == 0 ? 16
                                                     : (size_t)(type[3] - '0');
    const int view = gltf_fixture_view(fixture, component, count, numbers);
    return gltf_fixture_accessor(fixture,
                                 "{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"}",
                                 view, component, count / width, type);
}

static size_t write_json(gltf_fixture *fixture, char *out, size_t room, const char *rest) {
    const int size = snprintf(out, room,
                              "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu}],"
                              "\"bufferViews\":[%s],\"accessors\":[%s],%s}",
                              fixture->size, fixture->views, fixture->accessors, rest);
    assert_true(size > 0 && (size_t)size < room);
    return (size_t)size;
}

static void put_word(char *at, size_t value) {
    for (size_t i = 0; i < 4; i++) at[i] = (char)(value >> 8 * i & 0xff);
}

/* A whole file in the fixture's memory; the rest is the JSON behind "asset": nodes, meshes, scenes. */
static file_bytes gltf_fixture_glb(gltf_fixture *fixture, const char *rest) {
    char *file = fixture->file;
    size_t size = write_json(fixture, file + 20, sizeof fixture->file - 20, rest);
    while (size % 4 != 0) file[20 + size++] = ' ';
    const size_t whole = 20 + size + 8 + fixture->size;
    assert_true(whole <= sizeof fixture->file);
    memcpy(file, "glTF", 4);
    put_word(file + 4, 2);
    put_word(file + 8, whole);
    put_word(file + 12, size);
    memcpy(file + 16, "JSON", 4);
    put_word(file + 20 + size, fixture->size);
    memcpy(file + 24 + size, "BIN", 4);
    memcpy(file + 28 + size, fixture->bytes, fixture->size);
    return (file_bytes){"mesh.glb", file, whole};
}

/* ---- a rich one ---------------------------------------------------------------------------------------- */

/* A skinned mesh with a target and a material, a mesh of three copies, and a node that moves and grows. */
#define RICH                                                                                                              \
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,3]}],\"nodes\":[{\"name\":\"a\",\"mesh\":0,\"skin\":0},{\"children\":[2],"   \
    "\"rotation\":[0,0,0,1],\"mesh\":1,\"name\":\"a\"},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{\"mesh\":1,"       \
    "\"extensions\":{\"ACME_fur\":{},\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":7}}}}],\"skins\":[{"    \
    "\"joints\":[1,2],\"inverseBindMatrices\":4}],\"materials\":[{\"name\":\"Steel\"}],\"meshes\":[{\"weights\":[0.5],"   \
    "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},\"indices\":1,\"material\":0,"       \
    "\"targets\":[{\"POSITION\":5}]}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],"                 \
    "\"animations\":[{\"name\":\"A\",\"samplers\":[{\"input\":6,\"output\":7},{\"input\":6,\"output\":7}],\"channels\":[" \
    "{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}},{\"sampler\":1,\"target\":{\"node\":1,\"path\":"    \
    "\"scale\"}}]},{\"name\":\"B\",\"samplers\":[],\"channels\":[]}]"

enum { VERTICES = 20 };

/* Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 matrices, 5 sparse, 6 the times 0, 1 and 2, 7 places in these. */
static file_bytes rich_file(gltf_fixture *fixture) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, indices[] = {0, 1, 2, 0, 2, 3};
    static const double joints[16] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, places[] = {0, 2, 3},
                        times[] = {0, 1, 2};
    static const double weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0};
    static const double identity[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const double moves[] = {1, 1, 1, 2, 2, 2, 4, 4, 4};
    *fixture = (gltf_fixture){0};
    gltf_fixture_array(fixture, 5126, "VEC3", 12, positions);
    gltf_fixture_array(fixture, 5123, "SCALAR", 6, indices);
    gltf_fixture_array(fixture, 5121, "VEC4", 16, joints);
    gltf_fixture_array(fixture, 5126, "VEC4", 16, weights);
    gltf_fixture_array(fixture, 5126, "MAT4", 32, identity);
    const int view = gltf_fixture_view(fixture, 5121, 3, places);
    gltf_fixture_accessor(
        fixture,
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\":{"
        "\"bufferView\":%d,\"componentType\":5121},\"values\":{\"bufferView\":0}}}",
        view);
    gltf_fixture_array(fixture, 5126, "SCALAR", 3, times);
    gltf_fixture_array(fixture, 5126, "VEC3", 9, moves);
    return gltf_fixture_glb(fixture, RICH);
}

TEST(meshes_survive_failed_allocations) {
    gltf_fixture fixture;
    mesh_check_memory(rich_file(&fixture), MESH_PARTS_BY_FILE);
    mesh_check_memory(rich_file(&fixture), MESH_PARTS_BY_MATERIAL);
}

TEST(animations_survive_failed_allocations) {
    gltf_fixture fixture;
    const file_bytes file = rich_file(&fixture);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    long places = 0;
    for (; io_allocations_go_on(places); places++) {
        animation *frames = NULL;
        io_error error = {""};
        const bool done = animation_open(&path, 1, VERTICES, NULL, &frames, &error);
        io_allocations_left = -1;
        if (!done && (strstr(error.text, "out of memory") == NULL || strstr(error.text, path) == NULL))
            fail_msg("%s", error.text);
        assert_int_equal(frames != NULL, done);
        animation_close(frames);
    }
    print_message("refused in %ld places\n", places - 1);
    assert_true(places > 25);
    temp_folder_remove(&folder);
}

TEST(reads_frames_without_more_memory) {
    gltf_fixture fixture;
    const file_bytes file = rich_file(&fixture);
    const temp_folder folder = temp_folder_make();
    const temp_path place = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *path = place.text;
    const animation_options options = {.fps = 1e6};
    animation *frames;
    io_error error;
    double positions[3 * VERTICES];
    if (!animation_open(&path, 1, VERTICES, &options, &frames, &error)) fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(frames), 2000001);
    io_allocations_left = 0;
    assert_true(animation_read(frames, 1000000, positions, &error));
    assert_true(positions[12] == 2 && positions[15] == 4); /* mesh 1: 2 + 2 * 0, 2 + 2 * 1 */
    io_allocations_left = -1;
    animation_close(frames);
    temp_folder_remove(&folder);
}

TEST(survives_damage) {
    gltf_fixture fixture;
    const file_damage_counts counts = file_damage_rounds(rich_file(&fixture), 8000, 1);
    print_message("read %u, animated %u, unanimated %u, refused %u\n", (unsigned)counts.read,
                  (unsigned)counts.animated, (unsigned)counts.unanimated, (unsigned)counts.refused);
    assert_true(counts.read > 400 && counts.animated > 400 && counts.unanimated > 100 &&
                counts.refused > 400);
}
