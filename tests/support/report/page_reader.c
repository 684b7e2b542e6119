/* Reads a report back, so that the tests judge the page's data without sharing the writer's code. */
#include "tests/support/report/page_reader.h"
#include "tests/support/test.h"

#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define OCTETS "<script type=\"application/octet-stream\" id=\"cscd-array-"
#define JSON   "<script type=\"application/json\" id=\"cscd-report\">"
#define END    "</script>\n"

static uint32_t value_of(char c) {
    static const char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = strchr(alphabet, c);
    if (c == '\0' || found == NULL) fail_msg("'%c' in base64", c);
    return (uint32_t)(found - alphabet);
}

static page_bytes decode_base64(const char *text, size_t length) {
    assert_true(length % 4 == 0);
    page_bytes bytes = {malloc(length / 4 * 3 + 1), 0};
    for (size_t i = 0; i < length; i += 4) {
        size_t fill = i + 4 < length ? 0 : (size_t)(text[i + 3] == '=') + (text[i + 2] == '=');
        uint32_t bits = 0;
        for (size_t k = 0; k < 4; k++) bits = bits << 6 | (k < 4 - fill ? value_of(text[i + k]) : 0);
        for (size_t k = 0; k < 3 - fill; k++) bytes.data[bytes.size++] = (uint8_t)(bits >> (16 - 8 * k));
    }
    return bytes;
}

page_bytes page_unpack(const char *base64, size_t length) {
    page_bytes packed = decode_base64(base64, length);
    page_bytes out = {NULL, 0};
    size_t capacity = 0;
    z_stream stream = {.next_in = packed.data, .avail_in = (uInt)packed.size};
    assert_int_equal(inflateInit(&stream), Z_OK);
    for (int status = Z_OK; status != Z_STREAM_END;) {
        if (out.size == capacity) out.data = realloc(out.data, capacity = 2 * capacity + 4096);
        stream.next_out = out.data + out.size;
        stream.avail_out = (uInt)(capacity - out.size);
        status = inflate(&stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END) fail_msg("zlib: %d", status);
        out.size = (size_t)(stream.next_out - out.data);
    }
    assert_int_equal(stream.avail_in, 0);
    inflateEnd(&stream);
    free(packed.data);
    return out;
}

static const char *find_array(const page *p, const char *name) {
    char opening[200];
    snprintf(opening, sizeof opening, OCTETS "%s\">", name);
    const char *found = strstr(p->text, opening);
    return found != NULL ? found + strlen(opening) : NULL;
}

bool page_has(const page *p, const char *name) {
    return find_array(p, name) != NULL;
}

page_bytes page_array(const page *p, const char *name) {
    const char *text = find_array(p, name);
    if (text == NULL) fail_msg("no array '%s'", name);
    const char *end = strstr(text, END);
    assert_non_null(end);
    return page_unpack(text, (size_t)(end - text));
}

static size_t size_of(const char *type) {
    static const char *const types[] = {"u8", "u32", "f32", "f64"};
    static const size_t sizes[] = {1, 4, 4, 8};
    for (int i = 0; i < 4; i++)
        if (strcmp(type, types[i]) == 0) return sizes[i];
    fail_msg("type '%s'", type);
    return 0;
}

static void check_arrays(const page *p) {
    size_t blocks = 0;
    for (const char *at = strstr(p->text, OCTETS); at != NULL; at = strstr(at + 1, OCTETS)) blocks++;
    if (p->scene->kind == JSON_NULL) {
        assert_int_equal(blocks, 0);
        return;
    }
    const json_node *arrays = json_node_member(p->scene, "arrays");
    assert_int_equal(blocks, arrays->count);
    for (const json_node *array = arrays->first; array != NULL; array = array->next) {
        page_bytes bytes = page_array(p, json_node_string(array, "name"));
        assert_int_equal(bytes.size,
                         (size_t)json_node_number(array, "count") * size_of(json_node_string(array, "type")));
        free(bytes.data);
    }
}

page page_read(const char *path) {
    size_t size, at;
    page p = {.text = read_whole_file(path, &size)};
    assert_int_equal(strlen(p.text), size);
    char *json = strstr(p.text, JSON);
    assert_non_null(json);
    json += strlen(JSON);
    char *end = strstr(json, END);
    assert_non_null(end);
    assert_null(memchr(json, '<', (size_t)(end - json)));
    p.json = json_node_parse(json, (size_t)(end - json), &at);
    if (p.json == NULL) fail_msg("no JSON from byte %zu: %.40s", at, json + at);
    p.scene = json_node_member(p.json, "scene");
    check_arrays(&p);
    return p;
}

void page_free(page *p) {
    json_node_free(p->json);
    free(p->text);
}

/* ---- frames ------------------------------------------------------------------------------------------ */

typedef struct cursor {
    const uint8_t *at, *end;
} cursor;

static uint64_t take_bytes(cursor *c, size_t size) {
    uint64_t bits = 0;
    assert_true((size_t)(c->end - c->at) >= size);
    for (size_t i = 0; i < size; i++) bits |= (uint64_t)*c->at++ << (8 * i);
    return bits;
}

static double take_double(cursor *c) {
    uint64_t bits = take_bytes(c, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void take_body(cursor *c, uint32_t vertex_count, uint32_t *values) {
    size_t count = (size_t)vertex_count * 3, planes = (size_t)take_bytes(c, 1);
    uint32_t difference = 0;
    assert_in_range(planes, 1, 4);
    assert_true((size_t)(c->end - c->at) >= planes * count);
    for (size_t i = 0; i < count; i++) {
        uint32_t bits = 0;
        for (size_t p = 0; p < planes; p++) bits |= (uint32_t)c->at[p * count + i] << (8 * p);
        uint32_t residual = bits >> 1 ^ (0u - (bits & 1));
        difference = i % vertex_count == 0 ? residual : difference + residual;
        values[i] += difference;
    }
    c->at += planes * count;
}

/* Restores positions that the page keeps as float32 relative to the middle. */
static void restore_positions(const uint32_t *values, uint32_t vertex_count, const double *origin,
                              double step, double *out) {
    for (size_t k = 0; k < 3; k++) {
        int32_t low = INT32_MAX, high = INT32_MIN;
        for (size_t v = 0; v < vertex_count; v++) {
            int32_t value = (int32_t)values[k * vertex_count + v];
            if (value < low) low = value;
            if (value > high) high = value;
        }
        double centre = ((origin[k] + step * low) + (origin[k] + step * high)) / 2;
        for (size_t v = 0; v < vertex_count; v++) {
            float local = (float)(origin[k] + step * (int32_t)values[k * vertex_count + v] - centre);
            out[v * 3 + k] = local + centre;
        }
    }
}

double *page_frames(page_bytes records, uint32_t vertex_count, uint32_t frame_count, uint32_t *key_count) {
    cursor c = {records.data, records.data + records.size};
    size_t count = (size_t)vertex_count * 3;
    double *positions = malloc(frame_count * count * sizeof *positions), origin[3] = {0}, step = 0;
    uint32_t *values = calloc(count, sizeof *values), keys = 0;
    for (size_t f = 0; f < frame_count; f++) {
        bool key = take_bytes(&c, 1) == 1;
        keys += key;
        if (key) {
            memset(values, 0, count * sizeof *values);
            for (int k = 0; k < 3; k++) origin[k] = take_double(&c);
            step = take_double(&c);
        } else {
            assert_true(f > 0);
            for (size_t k = 0; k < 3; k++) {
                uint32_t shift = (uint32_t)take_bytes(&c, 4);
                for (size_t v = 0; v < vertex_count; v++) values[k * vertex_count + v] += shift;
            }
        }
        take_body(&c, vertex_count, values);
        restore_positions(values, vertex_count, origin, step, positions + f * count);
    }
    assert_ptr_equal(c.at, c.end);
    free(values);
    if (key_count != NULL) *key_count = keys;
    return positions;
}
