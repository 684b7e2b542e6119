/* Reads a report back, so that the tests judge the page's data without sharing the writer's code. */
#pragma once

#include "tests/support/tool/json_reader.h"

#include <stdint.h>

/* The caller frees `data`. */
typedef struct page_bytes {
    uint8_t *data;
    size_t size;
} page_bytes;

/* Unpacks base64 of a zlib stream. This and the functions below fail the test when anything is wrong. */
page_bytes page_unpack(const char *base64, size_t length);

typedef struct page {
    char *text; /* the whole file */
    json_node *json;
    const json_node *scene; /* a part of the JSON, which may be null */
} page;

page page_read(const char *path);
void page_free(page *p);

/* Returns whether the page has the array's block. page_read checks that every array in scene.arrays has a
 * block with as many values of its type, and that there is no other block. */
bool page_has(const page *p, const char *name);
page_bytes page_array(const page *p, const char *name);

/* Returns the positions as the page shows them: frame_count * vertex_count * 3, which the caller frees.
 * key_count: how many of the records begin a grid; it may be NULL. */
double *page_frames(page_bytes records, uint32_t vertex_count, uint32_t frame_count, uint32_t *key_count);
