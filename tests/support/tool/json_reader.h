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
    char *text;                     /* a string's text */
    char *key;                      /* in an object; NULL elsewhere */
    struct json_node *first, *next; /* the first child; the next sibling */
    size_t count;                   /* number of children */
} json_node;

/* Reads one JSON value without comments, trailing commas or repeated keys, in valid UTF-8. For any other
 * text returns NULL, and *at is where the text stops being JSON. */
json_node *json_node_parse(const char *text, size_t size, size_t *at);
void json_node_free(json_node *node);

/* These functions fail the test when there is no such value. */
json_node *json_node_read_file(const char *path);
const json_node *json_node_member(const json_node *object, const char *key);
const json_node *json_node_item(const json_node *array, size_t index);
double json_node_number(const json_node *object, const char *key);
const char *json_node_string(const json_node *object, const char *key);
bool json_node_boolean(const json_node *object, const char *key);

/* Returns NULL when the object has no such member. */
const json_node *json_node_find(const json_node *object, const char *key);
