/* Names of users in the errors of glTF and GIFTI files: long ones are cut, and never within a character. */
#include "src/io/animation.h"
#include "src/io/text_escape.h"
#include "tests/support/io/gifti_fixture.h"
#include "tests/support/io/gltf_animations.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

/* A name whose two-byte character lies across the byte where messages cut it, and what they show of it. */
typedef struct cut_name {
    char shown[256], whole[256 + 8];
} cut_name;

static cut_name name_cut_at(size_t most) {
    cut_name name = {.whole = "", .shown = ""};
    memset(name.shown, 'x', most - 1);
    snprintf(name.whole, sizeof name.whole, "%s\xc3\xa9%s", name.shown, "tail");
    return name;
}

static void expect_whole_characters(const char *text) {
    for (const unsigned char *s = (const unsigned char *)text; *s != '\0';) {
        const size_t length = text_utf8_length(s);
        if (length == 0) fail_msg("cut within a character: %s", text);
        s += length;
    }
}

/* The message has these words: `before`, what is shown of the name, `after`. */
static void check_words(const io_error *error, const char *before, const cut_name *name, const char *after) {
    char words[2048];
    snprintf(words, sizeof words, "%s%s%s", before, name->shown, after);
    expect_whole_characters(error->text);
    if (strstr(error->text, words) == NULL) fail_msg("no '%s' in '%s'", words, error->text);
}

static void check_file(file_bytes file, const char *before, const cut_name *name, const char *after) {
    mesh_file mesh = {0};
    io_error error;
    assert_false(mesh_check_read(file, &mesh, &error));
    check_words(&error, before, name, after);
}

/* The JSON of a file, with a name at its %s. */
static void check_json(const char *json, size_t most, const char *before, const char *after) {
    const cut_name name = name_cut_at(most);
    const char *place = strstr(json, "%s");
    char text[2048];
    assert_non_null(place);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(place - json), json, name.whole, place + 2);
    check_file((file_bytes){"name.gltf", text, strlen(text)}, before, &name, after);
}

#define ASSET "{\"asset\":{\"version\":\"2.0\"},"
#define MESH  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"

TEST(names_of_gltf_are_cut) {
    check_json("{\"asset\":{\"version\":\"%s\"}}", 20, "is a glTF file of version ", ", expected 2.0");
    check_json("{\"asset\":{\"version\":\"2.1\",\"minVersion\":\"%s\"}}", 20, "needs a reader of glTF ",
               ", this one");
    check_json(ASSET "\"extensionsRequired\":[\"%s\"]}", 80, "requires the extension ",
               ", which is not read");
    check_json(ASSET "\"nodes\":[{\"mesh\":\"%s\"}]," MESH "\"scene\":0}", 40, "node 0: mesh is ",
               ", expected a whole number");
    check_json(ASSET "\"nodes\":[{\"mesh\":0,\"scale\":[1,\"%s\",1]}]," MESH "\"scene\":0}", 40,
               "node 0: scale[1] is ", ", expected a finite number");
    check_json(ASSET "\"nodes\":[{\"mesh\":0}]," MESH "\"accessors\":[{\"componentType\":5126,\"count\":3,"
                     "\"type\":\"%s\"}]}",
               20, "accessor 0: type is ", ", expected VEC3 for POSITION");
}

#define BUFFER                                                                                                 \
    ASSET                                                                                                      \
    "\"nodes\":[{\"mesh\":0}]," MESH                                                                           \
    "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"bufferView\":0}],\"bufferViews\":" \
    "[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\""

TEST(places_of_gltf_are_cut) {
    check_json(BUFFER "/%s\"}]}", 79, "buffer 0: uri /", ", expected a file in the folder");
    check_json(BUFFER "%s%\"}]}", 80, "buffer 0: uri ", " has a percent sign");
}

/* Says why an animation of this name is not played. */
static io_error fail_animation(file_bytes file, const char *name) {
    const temp_folder folder = temp_folder_make();
    const temp_path path = temp_file_write(&folder, file.name, file.bytes, file.size);
    const char *paths[] = {path.text};
    const animation_options options = {.fps = 24, .animation_name = name};
    animation *frames = NULL;
    io_error error;
    assert_false(animation_open(paths, 1, 3, &options, &frames, &error));
    temp_folder_remove(&folder);
    return error;
}

/* Names of animations that do not fit are three dots. */
TEST(names_of_animations_are_cut) {
    const cut_name own = name_cut_at(60), wanted = name_cut_at(100), interpolation = name_cut_at(40);
    static const double times[] = {0, 1}, values[] = {0, 0, 0, 1, 0, 0};
    char rest[2500], list[1200], *end = rest;
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, gltf_animations_triangle);
    end += snprintf(rest, sizeof rest, "\"nodes\":[{\"mesh\":0}]," MESH "\"animations\":[");
    for (int i = 0; i < 6; i++)
        end += snprintf(end, sizeof rest - (size_t)(end - rest), "%s{\"name\":\"%s\"}", i > 0 ? "," : "",
                        own.whole);
    snprintf(end, sizeof rest - (size_t)(end - rest), "]");
    io_error error = fail_animation(gltf_fixture_glb(&fixture, rest), wanted.whole);
    snprintf(list, sizeof list, ", but: %s, %s, %s, %s, ...", own.shown, own.shown, own.shown, own.shown);
    check_words(&error, "holds no animation ", &wanted, list);
    assert_string_equal(strstr(error.text, ", ..."), ", ...");
    error = fail_animation(
        gltf_animations_channel(
            &fixture, (gltf_channel_keys){"translation", interpolation.whole, "VEC3", 2, 6, times, values}),
        NULL);
    check_words(&error, "interpolation is ", &interpolation, ", expected LINEAR");
}

static void check_gifti(const char *text, const char *by, size_t most, const char *before,
                        const char *after) {
    const cut_name name = name_cut_at(most);
    gifti_text file, other;
    gifti_fixture_square(&file, (gifti_style){0});
    const char *at = strstr(file.text, text), *place = strstr(by, "%s");
    assert_true(at != NULL && place != NULL);
    snprintf(other.text, sizeof other.text, "%.*s%.*s%s%s%s", (int)(at - file.text), file.text,
             (int)(place - by), by, name.whole, place + 2, at + strlen(text));
    check_file(gifti_fixture_file(&other), before, &name, after);
}

TEST(words_of_gifti_are_cut) {
    check_gifti("NIFTI_TYPE_FLOAT32", "%s", 40, "DataType is '", "', expected NIFTI_TYPE_FLOAT32");
    check_gifti("Dim0=\"4\" Dim1", "Dim0=\"%s\" Dim1", 40, "Dim0 is '", "', expected 1 to");
    check_gifti("Dim1=\"3\"", "Dim1=\"%s\"", 40, "Dim1 is '", "', expected two dimensions");
    check_gifti("ASCII\" Endian=\"LittleEndian\" ExternalFileName=\"\"",
                "ExternalFileBinary\" Endian=\"LittleEndian\" ExternalFileName=\"%s\"", 200,
                "in another file, '", "'; save the surface");
}

/* The end of a long path is shown, from a whole character on. */
TEST(paths_are_cut) {
    for (size_t shift = 0; shift < 2; shift++) {
        char path[800] = "", *end = path;
        memset(path, 'x', shift);
        end += shift;
        for (int i = 0; i < 350; i++) end += snprintf(end, 3, "\xc3\xa9");
        mesh_file mesh = {0};
        io_error error;
        snprintf(end, sizeof path - (size_t)(end - path), "%s", shift == 0 ? "y.obj" : "yy.obj");
        assert_false(mesh_file_read(path, &mesh, &error));
        expect_whole_characters(error.text);
        assert_memory_equal(error.text, "...\xc3\xa9", 5);
    }
}
