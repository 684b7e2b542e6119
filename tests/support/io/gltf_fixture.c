/* Small glTF files, written piece by piece: accessors with their numbers, and the rest as text. */
#include "tests/support/io/gltf_fixture.h"
#include "tests/support/test.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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

int gltf_fixture_view(gltf_fixture *fixture, int component, size_t count, const double *numbers) {
    char text[128];
    snprintf(text, sizeof text, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", fixture->size,
             count * size_of(component));
    append_text(fixture->views, sizeof fixture->views, fixture->view_count, text);
    for (size_t i = 0; i < count; i++) put_number(fixture, component, numbers[i]);
    while (fixture->size % 4 != 0) fixture->bytes[fixture->size++] = 0;
    return fixture->view_count++;
}

int gltf_fixture_accessor(gltf_fixture *fixture, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    const int size = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_true(size > 0 && (size_t)size < sizeof text);
    append_text(fixture->accessors, sizeof fixture->accessors, fixture->accessor_count, text);
    return fixture->accessor_count++;
}

int gltf_fixture_array(gltf_fixture *fixture, int component, const char *type, size_t count,
                       const double *numbers) {
    const size_t width = strcmp(type, "SCALAR") == 0 ? 1
                         : strcmp(type, "MAT4") == 0 ? 16
                                                     : (size_t)(type[3] - '0');
    const int view = gltf_fixture_view(fixture, component, count, numbers);
    return gltf_fixture_accessor(fixture,
                                 "{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"}",
                                 view, component, count / width, type);
}

static size_t write_json(gltf_fixture *fixture, char *out, size_t room, const char *rest, const char *uri) {
    const int size = snprintf(out, room,
                              "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu%s%s%s}],"
                              "\"bufferViews\":[%s],\"accessors\":[%s],%s}",
                              fixture->size, uri != NULL ? ",\"uri\":\"" : "", uri != NULL ? uri : "",
                              uri != NULL ? "\"" : "", fixture->views, fixture->accessors, rest);
    assert_true(size > 0 && (size_t)size < room);
    return (size_t)size;
}

static void put_word(char *at, size_t value) {
    for (size_t i = 0; i < 4; i++) at[i] = (char)(value >> 8 * i & 0xff);
}

file_bytes gltf_fixture_glb(gltf_fixture *fixture, const char *rest) {
    char *file = fixture->file;
    size_t size = write_json(fixture, file + 20, sizeof fixture->file - 20, rest, NULL);
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

file_bytes gltf_fixture_separate(gltf_fixture *fixture, const char *rest, const char *uri) {
    return (file_bytes){"mesh.gltf", fixture->file,
                        write_json(fixture, fixture->file, sizeof fixture->file, rest, uri)};
}

file_bytes gltf_fixture_embedded(gltf_fixture *fixture, const char *rest) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static char uri[8192];
    int used = snprintf(uri, sizeof uri, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < fixture->size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < fixture->size ? fixture->bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            uri[used++] = i + k > fixture->size ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    uri[used] = '\0';
    return gltf_fixture_separate(fixture, rest, uri);
}
