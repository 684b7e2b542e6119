/* A strict JSON reader (RFC 8259), so that the tests judge what the tool writes without sharing its code. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef enum json_kind {
    JSON_NULL,
    JSON_BOOLEAN,
    JSON_NUMBER,
    JSON_STRING,
    JSON_ARRAY,
    JSON_OBJECT
} json_kind;

typedef struct json_node {
    json_kind kind;
    bool boolean;
    double number;
    char *text;                     /* of a string */
    char *key;                      /* in an object; NULL elsewhere */
    struct json_node *first, *next; /* the first child; the next sibling */
    size_t count;                   /* of children */
} json_node;

/* NULL, and where it stops being JSON in *at, unless the text is one JSON value: no comments, no trailing
 * commas, no repeated keys, valid UTF-8. */
json_node *json_node_parse(const char *text, size_t size, size_t *at);
void json_node_free(json_node *node);

/* These fail the test where there is no such thing. */
json_node *json_node_read_file(const char *path);
const json_node *json_node_member(const json_node *object, const char *key);
const json_node *json_node_item(const json_node *array, size_t index);
double json_node_number(const json_node *object, const char *key);
const char *json_node_string(const json_node *object, const char *key);
bool json_node_boolean(const json_node *object, const char *key);

/* NULL where the object has no such member. */
const json_node *json_node_find(const json_node *object, const char *key);
