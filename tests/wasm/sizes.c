/* Counts whose size in bytes wraps around at 2^32, where a size has 32 bits: each must be answered with OUT_OF_MEMORY, and the
 * context must serve the next call. Prints a line for each, `ok` or `failed` first. Only for 32-bit builds: elsewhere there may be
 * as much memory. */
#include "src/core/context.h"

#include <stdio.h>
#include <stdlib.h>

_Static_assert(sizeof(size_t) == 4, "these counts wrap around where a size has 32 bits");

/* Many objects have the same triangles, so that a caller has room for them. */
enum { SHARED = 1 << 20, OBJECTS_MAX = 400 };

static void tell_answer(bool good, const char *what, unsigned long long count) {
    printf("%s %s %llu\n", good ? "ok" : "failed", what, count);
}

/* A tetrahedron flies into another one. */
static bool still_serves(cscd_context *context) {
    const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
    const double start[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4, 1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};
    double end[24];
    for (int i = 0; i < 24; i++) end[i] = start[i] + (i >= 12 && i % 3 == 2 ? 1.5 : 0.0);
    const cscd_object_desc object = cscd_object_of_triangles(8, 8, triangles);
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts contacts = {.count = 0};
    bool good =
        cscd_mesh_create(context, &object, 1, &mesh) == CSCD_OK &&
        cscd_detector_create(context, mesh, NULL, NULL, &detector) == CSCD_OK &&
        cscd_detector_step(detector, CSCD_DOUBLES(start, 8), CSCD_DOUBLES(end, 8), &contacts) == CSCD_OK;
    good = good && contacts.count > 0;
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    return good;
}

static bool is_refused(cscd_context *context, const cscd_object_desc *objects, uint32_t count) {
    cscd_mesh *mesh = NULL;
    cscd_status status = cscd_mesh_create(context, objects, count, &mesh);
    if (status != CSCD_OUT_OF_MEMORY) printf("status %d: %s\n", (int)status, cscd_context_detail(context));
    cscd_mesh_destroy(mesh);
    return status == CSCD_OUT_OF_MEMORY && mesh == NULL && still_serves(context);
}

/* So many triangles in all, in objects that have those of corners, or the first of them. */
static void share_triangles(cscd_context *context, uint32_t count, const uint32_t *corners) {
    static cscd_object_desc objects[OBJECTS_MAX];
    uint32_t object_count = 0;
    for (uint32_t left = count; left > 0; object_count++) {
        uint32_t part = left < SHARED ? left : SHARED;
        objects[object_count] = cscd_object_of_triangles(3, part, corners);
        left -= part;
    }
    tell_answer(is_refused(context, objects, object_count), "triangles", count);
}

/* Objects of SHARED triangles that have so many vertices in all. */
static void share_vertices(cscd_context *context, uint32_t count, const uint32_t *corners) {
    cscd_object_desc objects[16];
    for (uint32_t i = 0; i < 16; i++)
        objects[i] = cscd_object_of_triangles(count / 16 + (i < count % 16 ? 1 : 0), SHARED, corners);
    tell_answer(is_refused(context, objects, 16), "vertices", count);
}

static void check_meshes(cscd_context *context) {
    static const uint32_t vertex_counts[] = {
        536870912,  /* 8 bytes each are 2^32 */
        1073741825, /* 4 bytes each are 2^32 + 4 */
        1431655766, /* three of each are 2^32 + 2 */
        2147483649, /* two of each are 2^32 + 2 */
        4294967294, /* two more are 2^32 */
    };
    uint32_t *corners = malloc((size_t)SHARED * 3 * sizeof *corners);
    if (corners == NULL) exit(1);
    for (size_t i = 0; i < (size_t)SHARED * 3; i++) corners[i] = (uint32_t)(i % 3);
    for (size_t i = 0; i < sizeof vertex_counts / sizeof *vertex_counts; i++)
        share_vertices(context, vertex_counts[i], corners);
    share_triangles(context, 357913942, corners); /* 12 bytes each are 2^32 + 8 */
    share_triangles(context, 178956971, corners); /* 24 bytes each are 2^32 + 8 */
    free(corners);
}

static void check_blocks(host_memory *memory) {
    static const size_t sizes[][2] = {{65536, 65536},  {357913942, 12}, {536870913, 8},
                                      {1431655766, 3}, {178956971, 24}, {SIZE_MAX / 2, 2},
                                      {SIZE_MAX, 1},   {1, SIZE_MAX},   {SIZE_MAX - 63, 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        void *zeroed = memory_allocate(memory, sizes[i][0], sizes[i][1]);
        void *reserved = memory_reserve(memory, sizes[i][0], sizes[i][1]);
        void *grown = memory_grow(memory, NULL, 0, sizes[i][0], sizes[i][1]);
        tell_answer(zeroed == NULL && reserved == NULL && grown == NULL, "blocks of elements", sizes[i][0]);
        memory_free(memory, zeroed);
        memory_free(memory, reserved);
        memory_free(memory, grown);
    }
}

int main(void) {
    cscd_context *context = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK) return 1;
    tell_answer(still_serves(context), "contacts before", 1);
    check_blocks(&context->memory);
    check_meshes(context);
    tell_answer(still_serves(context), "contacts afterwards", 1);
    cscd_context_destroy(context);
    return 0;
}
