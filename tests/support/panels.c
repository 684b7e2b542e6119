/* Two panels for a host's small program: wavy ones that pass through each other, or equal ones that are sewn together. */
#include "tests/support/panels.h"

#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 64 };

/* The vertices i * side + j of one panel. */
static uint32_t list_triangles(uint32_t side, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i + 1 < side; i++) {
        for (uint32_t j = 0; j + 1 < side; j++) {
            uint32_t k = i * side + j, corners[] = {k, k + side, k + 1, k + 1, k + side, k + side + 1};
            for (int c = 0; c < 6; c++) out[6 * count + (uint32_t)c] = corners[c];
            count++;
        }
    }
    return 2 * count;
}

static void place_vertices(uint32_t side, double shift, double z, double *out) {
    for (uint32_t i = 0; i < side; i++) {
        for (uint32_t j = 0; j < side; j++, out += 3) {
            out[0] = i + shift;
            out[1] = j + 0.6 * shift;
            out[2] = z + 0.3 * sin(i * 1.7 + j);
        }
    }
}

cscd_status panels_create_mesh(const panel_scene *p, cscd_context *context, cscd_mesh **out) {
    static uint32_t triangles[6 * SIDE_MAX * SIDE_MAX];
    uint32_t half = p->vertex_count / 2, side = (uint32_t)lround(sqrt(half));
    cscd_object_desc panel = {
        .vertex_count = half, .triangle_count = list_triangles(side, triangles), .triangles = triangles};
    cscd_object_desc objects[] = {panel, panel};
    return cscd_mesh_create(context, objects, 2, out);
}

cscd_status panels_create_detector(const panel_scene *p, const cscd_detector_options *options,
                                   cscd_detector **out) {
    return cscd_detector_create(p->context, p->mesh, NULL, options, out);
}

panel_scene panels_create(uint32_t side, const cscd_context_options *context_options,
                          const cscd_detector_options *options) {
    assert_true(side <= SIDE_MAX);
    uint32_t half = side * side;
    panel_scene p = {.vertex_count = 2 * half};
    p.x0 = calloc((size_t)p.vertex_count * 3, sizeof *p.x0);
    p.x1 = calloc((size_t)p.vertex_count * 3, sizeof *p.x1);
    assert_true(p.x0 != NULL && p.x1 != NULL);
    place_vertices(side, 0.0, 0.0, p.x0);
    place_vertices(side, 0.0, 0.0, p.x1);
    place_vertices(side, 0.31, 2.0, p.x0 + (size_t)half * 3);
    place_vertices(side, 0.31, -1.0, p.x1 + (size_t)half * 3);
    expect_ok(cscd_context_create(context_options, &p.context));
    expect_ok(panels_create_mesh(&p, p.context, &p.mesh));
    expect_ok(panels_create_detector(&p, options, &p.detector));
    return p;
}

void panels_destroy(panel_scene *p) {
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
    free(p->x0);
    free(p->x1);
    *p = (panel_scene){.context = NULL};
}

cscd_status panels_step(const panel_scene *p, cscd_contacts *out) {
    return cscd_detector_step(p->detector, CSCD_DOUBLES(p->x0, p->vertex_count),
                              CSCD_DOUBLES(p->x1, p->vertex_count), out);
}

cscd_status panels_check(const panel_scene *p, cscd_intersections *out) {
    return cscd_detector_check(p->detector, CSCD_DOUBLES(p->x0, p->vertex_count), out);
}

cscd_status panels_near(const panel_scene *p, cscd_proximities *out) {
    return cscd_detector_find_near(p->detector, CSCD_DOUBLES(p->x0, p->vertex_count), 0.1, CSCD_NEAR_PAIRS,
                                   out);
}

cscd_status panels_max_step(const panel_scene *p, cscd_free_step *out) {
    return cscd_detector_max_step(p->detector, CSCD_DOUBLES(p->x0, p->vertex_count),
                                  CSCD_DOUBLES(p->x1, p->vertex_count), NULL, out);
}

cscd_status panels_plan(const panel_scene *p, cscd_method method, cscd_plan **out) {
    cscd_plan_options options = cscd_plan_defaults();
    options.method = method;
    return cscd_plan_create(p->context, p->mesh, CSCD_DOUBLES(p->x0, p->vertex_count), &options, out);
}

/* ---- sewn panels --------------------------------------------------------------------------------------- */

static uint32_t panel_triangles[EQUAL_TRIANGLES * 3];

/* By another detector, without seams. */
static size_t count_touching(const equal_panels *p) {
    cscd_detector *other;
    cscd_contacts contacts;
    expect_ok(detector_create_here(p->mesh, NULL, NULL, &other));
    expect_ok(step_packed(other, p->x0, p->x0, &contacts));
    size_t count = contacts.count;
    cscd_detector_destroy(other);
    return count;
}

void equal_panels_begin(equal_panels *p, double min_separation, uint32_t threads) {
    uint32_t k = 0;
    for (uint32_t i = 0; i + 1 < EQUAL_SIDE; i++) {
        for (uint32_t j = 0; j + 1 < EQUAL_SIDE; j++) {
            uint32_t v = i * EQUAL_SIDE + j,
                     corners[] = {v, v + EQUAL_SIDE, v + 1, v + 1, v + EQUAL_SIDE, v + EQUAL_SIDE + 1};
            for (int c = 0; c < 6; c++) panel_triangles[k++] = corners[c];
        }
    }
    for (uint32_t v = 0; v < EQUAL_PANEL; v++) {
        const double at[] = {v / EQUAL_SIDE, v % EQUAL_SIDE, 0.1 * sin(v * 1.3)};
        memcpy(p->x0 + (size_t)3 * v, at, sizeof at);
        memcpy(p->x0 + (size_t)3 * (EQUAL_PANEL + v), at, sizeof at);
        p->seams[v][0] = v;
        p->seams[v][1] = EQUAL_PANEL + v;
    }
    p->counter = counting_allocator_start();
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = &p->seams[0][0];
    options.seam_count = EQUAL_PANEL;
    options.min_separation = min_separation;
    const cscd_object_desc panel = cscd_object_of_triangles(EQUAL_PANEL, EQUAL_TRIANGLES, panel_triangles);
    const cscd_object_desc objects[] = {panel, panel};
    p->rig = rig_of_objects(context_of(threads, &p->counter), objects, 2, NULL, &options);
    p->context = p->rig.context;
    p->mesh = p->rig.mesh;
    p->detector = p->rig.detector;
    expect_ok(cscd_line_search_create(p->detector, &p->line));
    p->touching = count_touching(p);
}

void equal_panels_end(equal_panels *p) {
    cscd_line_search_destroy(p->line);
    rig_destroy(&p->rig);
    assert_int_equal(p->counter.live, 0);
}

void equal_panels_open(const equal_panels *p) {
    expect_ok(cscd_detector_set_seams(p->detector, NULL, 0));
}

void equal_panels_part(const equal_panels *p, double gap, double *x) {
    memcpy(x, p->x0, sizeof p->x0);
    for (uint32_t v = 0; v < EQUAL_PANEL; v++) x[3 * v + 2] = x[3 * (EQUAL_PANEL + v) + 2] + gap;
}
