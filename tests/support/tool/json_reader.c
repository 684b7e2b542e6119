/* A strict JSON reader (RFC 8259), so that the tests judge what the tool writes without sharing its code. */
#include "tests/support/tool/json_reader.h"
#include "tests/support/test.h"

#include "tests/support/tool/run_tool.h"

#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 64 };

/* The text has a zero byte after its `size` bytes. */
typedef struct reader {
    const char *at, *end;
    int depth;
} reader;

static json_node *read_value(reader *r);

static void skip_space(reader *r) {
    while (r->at < r->end && strchr(" \t\r\n", *r->at) != NULL) r->at++;
}

static bool take_character(reader *r, char c) {
    skip_space(r);
    if (r->at >= r->end || *r->at != c) return false;
    r->at++;
    return true;
}

static bool take_word(reader *r, const char *word) {
    size_t length = strlen(word);
    if ((size_t)(r->end - r->at) < length || memcmp(r->at, word, length) != 0) return false;
    r->at += length;
    return true;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static bool take_digits(reader *r) {
    const char *start = r->at;
    while (r->at < r->end && is_digit(*r->at)) r->at++;
    return r->at > start;
}

static bool read_number(reader *r, double *out) {
    const char *start = r->at;
    if (r->at < r->end && *r->at == '-') r->at++;
    if (r->at < r->end && *r->at == '0')
        r->at++;
    else if (!take_digits(r))
        return false;
    if (r->at < r->end && *r->at == '.') {
        r->at++;
        if (!take_digits(r)) return false;
    }
    if (r->at < r->end && (*r->at == 'e' || *r->at == 'E')) {
        r->at++;
        if (r->at < r->end && (*r->at == '+' || *r->at == '-')) r->at++;
        if (!take_digits(r)) return false;
    }
    *out = strtod(start, NULL);
    return true;
}

static bool read_hex4(reader *r, unsigned *out) {
    *out = 0;
    for (int i = 0; i < 4; i++) {
        static const char digits[] = "0123456789abcdef";
        if (r->at >= r->end) return false;
        char c = *r->at++;
        if (c >= 'A' && c <= 'F') c = (char)(c - 'A' + 'a');
        const char *digit = c != '\0' ? strchr(digits, c) : NULL;
        if (digit == NULL) return false;
        *out = *out * 16 + (unsigned)(digit - digits);
    }
    return true;
}

/* The tool escapes control characters only, so others need no decoding here. */
static bool read_escape(reader *r, char *out) {
    static const char from[] = "\"\\/bfnrt", to[] = "\"\\/\b\f\n\r\t";
    if (r->at >= r->end) return false;
    char c = *r->at++;
    unsigned code;
    if (c == 'u') {
        if (!read_hex4(r, &code) || code == 0 || code >= 0x80) return false;
        *out = (char)code;
        return true;
    }
    const char *found = c != '\0' ? strchr(from, c) : NULL;
    if (found == NULL) return false;
    *out = to[found - from];
    return true;
}

/* Copies one character of one to four bytes, shortest form, no surrogates. */
static bool copy_utf8(reader *r, char **out) {
    const unsigned char *s = (const unsigned char *)r->at;
    static const unsigned smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    int length = s[0] < 0x80 ? 1 : s[0] >> 5 == 6 ? 2 : s[0] >> 4 == 14 ? 3 : s[0] >> 3 == 30 ? 4 : 0;
    if (length == 0 || length > r->end - r->at || s[0] < 0x20) return false;
    unsigned code = length == 1 ? s[0] : s[0] & (0x7fu >> length);
    for (int i = 1; i < length; i++) {
        if (s[i] >> 6 != 2) return false;
        code = code << 6 | (s[i] & 63u);
    }
    if (code < smallest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
    memcpy(*out, s, (size_t)length);
    *out += length;
    r->at += length;
    return true;
}

static char *read_string(reader *r) {
    if (!take_character(r, '"')) return NULL;
    char *text = malloc((size_t)(r->end - r->at) + 1), *out = text;
    while (text != NULL && r->at < r->end && *r->at != '"') {
        bool escape = *r->at == '\\';
        if (escape) r->at++;
        if (escape ? read_escape(r, out) : copy_utf8(r, &out)) {
            out += escape;
            continue;
        }
        free(text);
        return NULL;
    }
    if (text == NULL || r->at >= r->end) {
        free(text);
        return NULL;
    }
    r->at++;
    *out = '\0';
    char *exact = realloc(text, (size_t)(out - text) + 1);
    return exact != NULL ? exact : text;
}

static bool read_child(reader *r, json_node *parent, json_node **last) {
    char *key = NULL;
    if (parent->kind == JSON_OBJECT) {
        key = read_string(r);
        if (key == NULL || json_node_find(parent, key) != NULL || !take_character(r, ':')) {
            free(key);
            return false;
        }
    }
    json_node *child = read_value(r);
    if (child == NULL) {
        free(key);
        return false;
    }
    child->key = key;
    *(*last == NULL ? &parent->first : &(*last)->next) = child;
    *last = child;
    parent->count++;
    return true;
}

static bool read_children(reader *r, json_node *parent, char closing) {
    json_node *last = NULL;
    if (take_character(r, closing)) return true;
    do {
        if (!read_child(r, parent, &last)) return false;
    } while (take_character(r, ','));
    return take_character(r, closing);
}

static bool fill_value(reader *r, json_node *node) {
    switch (*r->at) {
    case '{':
    case '[':
        node->kind = *r->at == '{' ? JSON_OBJECT : JSON_ARRAY;
        return read_children(r, node, *r->at++ == '{' ? '}' : ']');
    case '"':
        node->kind = JSON_STRING;
        return (node->text = read_string(r)) != NULL;
    case 't':
    case 'f':
        node->kind = JSON_BOOLEAN;
        node->boolean = *r->at == 't';
        return take_word(r, node->boolean ? "true" : "false");
    case 'n':
        node->kind = JSON_NULL;
        return take_word(r, "null");
    default:
        node->kind = JSON_NUMBER;
        return read_number(r, &node->number);
    }
}

static json_node *read_value(reader *r) {
    skip_space(r);
    json_node *node = r->at < r->end && r->depth < DEPTH_MAX ? calloc(1, sizeof *node) : NULL;
    if (node == NULL) return NULL;
    r->depth++;
    bool filled = fill_value(r, node);
    r->depth--;
    if (filled) return node;
    json_node_free(node);
    return NULL;
}

json_node *json_node_parse(const char *text, size_t size, size_t *at) {
    reader r = {text, text + size, 0};
    json_node *node = read_value(&r);
    skip_space(&r);
    if (at != NULL) *at = (size_t)(r.at - text);
    if (node != NULL && r.at == r.end) return node;
    json_node_free(node);
    return NULL;
}

void json_node_free(json_node *node) {
    while (node != NULL) {
        json_node *next = node->next;
        json_node_free(node->first);
        free(node->text);
        free(node->key);
        free(node);
        node = next;
    }
}

json_node *json_node_read_file(const char *path) {
    size_t size, at;
    char *text = read_whole_file(path, &size);
    json_node *node = json_node_parse(text, size, &at);
    if (node == NULL) fail_msg("%s is not JSON from byte %zu on: %.80s", path, at, text + at);
    free(text);
    return node;
}

const json_node *json_node_find(const json_node *object, const char *key) {
    for (const json_node *child = object->first; child != NULL; child = child->next) {
        if (child->key != NULL && strcmp(child->key, key) == 0) return child;
    }
    return NULL;
}

static const json_node *member_of_kind(const json_node *object, const char *key, json_kind kind) {
    const json_node *member = json_node_member(object, key);
    if (member->kind != kind) fail_msg("member %s is of kind %d, expected %d", key, member->kind, kind);
    return member;
}

const json_node *json_node_member(const json_node *object, const char *key) {
    const json_node *member = json_node_find(object, key);
    if (member == NULL) fail_msg("there is no member %s", key);
    return member;
}

const json_node *json_node_item(const json_node *array, size_t index) {
    assert_int_equal(array->kind, JSON_ARRAY);
    assert_true(index < array->count);
    const json_node *item = array->first;
    for (size_t i = 0; i < index; i++) item = item->next;
    return item;
}

double json_node_number(const json_node *object, const char *key) {
    return member_of_kind(object, key, JSON_NUMBER)->number;
}

const char *json_node_string(const json_node *object, const char *key) {
    return member_of_kind(object, key, JSON_STRING)->text;
}

bool json_node_boolean(const json_node *object, const char *key) {
    return member_of_kind(object, key, JSON_BOOLEAN)->boolean;
}
