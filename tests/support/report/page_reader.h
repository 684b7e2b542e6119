/* Reads a report back, so that the tests judge the page's data without sharing the writer's code. */
#pragma once

#include "tests/support/tool/json_reader.h"

#include <stdint.h>

/* To be freed: free(data). */
typedef struct page_bytes {
    uint8_t *data;
    size_t size;
} page_bytes;

/* Base64 of a zlib stream; anything wrong with either fails the test, as all of these do. */
page_bytes page_unpack(const char *base64, size_t length);

typedef struct page {
    char *text; /* the whole file */
    json_node *json;
    const json_node *scene; /* of the JSON, which may be null */
} page;

page page_read(const char *path);
void page_free(page *p);

/* The array's block. Every array that scene.arrays lists has one with as many values of its type, and no
 * other block is there: page_read checks it. */
bool page_has(const page *p, const char *name);
page_bytes page_array(const page *p, const char *name);

/* Positions as the page shows them: frame_count * vertex_count * 3, to be freed. key_count: how many of the
 * records begin a grid; NULL: not asked for. */
double *page_frames(page_bytes records, uint32_t vertex_count, uint32_t frame_count, uint32_t *key_count);
