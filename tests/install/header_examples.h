/* What the examples in the comments of the public headers find: two sheets, of which the upper one goes down through the
 * lower one, and a tetrahedron. */
#pragma once

#include <cscd/cscd.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 4, SHEET = SIDE * SIDE, VERTICES = 2 * SHEET };

static const uint32_t tetrahedron_faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

static cscd_context *context;
static cscd_mesh *mesh, *tetrahedron;
static cscd_detector *detector;
static const uint32_t n = VERTICES;
static uint32_t triangles[18][3];
static double x0[3 * VERTICES], x1[3 * VERTICES], reached[3 * VERTICES], moved[3 * VERTICES + 3];
static double velocities[3 * VERTICES], impulses[10000];
static const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static cscd_contacts contacts;

/* A host in another language. */
typedef struct binding {
    cscd_context *context;
    bool failed, answer;
} binding;

static inline bool ask_host(binding *host, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    host->answer = kind == CSCD_CONTACT_TT && a == b;
    return true;
}

static void expect_success(cscd_status status) {
    if (status == CSCD_OK) return;
    fprintf(stderr, "%s: %s\n", cscd_status_string(status), cscd_context_detail(context));
    exit(1);
}

/* The lower sheet at z = 0 is at rest; the upper one goes from 0.5 to -0.5. */
static void place_sheets(void) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < n; v++) {
        bool upper = v >= SHEET;
        double *from = &x0[3 * v], *to = &x1[3 * v];
        from[0] = to[0] = v % SHEET / SIDE + (upper ? 0.3 : 0.0);
        from[1] = to[1] = v % SIDE + (upper ? 0.2 : 0.0);
        from[2] = upper ? 0.5 : 0.0;
        to[2] = velocities[3 * v + 2] = upper ? -0.5 : 0.0;
    }
    memcpy(reached, x0, sizeof reached);
    for (uint32_t i = 0; i + 1 < SIDE; i++) {
        for (uint32_t j = 0; j + 1 < SIDE; j++) {
            uint32_t k = i * SIDE + j, both[2][3] = {{k, k + SIDE, k + 1}, {k + 1, k + SIDE, k + SIDE + 1}};
            memcpy(triangles[count], both, sizeof both);
            count += 2;
        }
    }
}

static void set_up(void) {
    place_sheets();
    const cscd_object_desc sheet = cscd_object_of_triangles(SHEET, 18, &triangles[0][0]);
    const cscd_object_desc sheets[2] = {sheet, sheet},
                           body = cscd_object_of_triangles(4, 4, tetrahedron_faces);
    expect_success(cscd_context_create(NULL, &context));
    expect_success(cscd_mesh_create(context, sheets, 2, &mesh));
    expect_success(cscd_mesh_create(context, &body, 1, &tetrahedron));
    expect_success(cscd_detector_create(context, mesh, NULL, NULL, &detector));
    expect_success(cscd_detector_step(detector, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), &contacts));
}

static void tear_down(void) {
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_mesh_destroy(tetrahedron);
    cscd_context_destroy(context);
}
