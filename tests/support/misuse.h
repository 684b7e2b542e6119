/* Two tetrahedra and a detector, for calls that are mistakes and must be answered as such. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { VERTICES = 8, COORDINATES = 24 };

static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
static const double x0[COORDINATES] = {0, 0, 0,  4, 0, 0,  0, 4, 0,  0, 0, 4,
                                       1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};
static double x1[COORDINATES]; /* the second tetrahedron has run into the first one from below */
static cscd_context *context;
static cscd_mesh *mesh;
static cscd_detector *detector;

#define OBJECT(vertices, count, indices)                                                                     \
    (&(cscd_object_desc){.vertex_count = (vertices), .triangle_count = (count), .triangles = (indices)})
#define AT_START CSCD_DOUBLES(x0, VERTICES)
#define AT_END   CSCD_DOUBLES(x1, VERTICES)

static inline int set_up(void **state) {
    (void)state;
    for (int i = 0; i < COORDINATES; i++) x1[i] = x0[i] + (i >= 12 && i % 3 == 2 ? 1.5 : 0.0);
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, OBJECT(VERTICES, 8, triangles), 1, &mesh));
    expect_ok(cscd_detector_create(context, mesh, NULL, NULL, &detector));
    return 0;
}

static inline int tear_down(void **state) {
    (void)state;
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return 0;
}

/* The call has failed with this status, and its sentence has these words. */
static inline void expect_failure(cscd_status status, cscd_status expected, const char *words) {
    const char *detail = cscd_context_detail(context);
    assert_int_equal(status, expected);
    if (strstr(detail, words) == NULL) fail_msg("\"%s\" has no \"%s\"", detail, words);
}

#define EXPECT_ARGUMENT(call, words) expect_failure(call, CSCD_INVALID_ARGUMENT, words)
#define EXPECT_MESH(call, words)     expect_failure(call, CSCD_INVALID_MESH, words)

/* The call has succeeded, and the sentence of an earlier failure is gone. */
static inline void expect_success(cscd_status status) {
    expect_ok(status);
    assert_string_equal(cscd_context_detail(context), "");
}
