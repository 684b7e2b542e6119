/* Two panels at equal positions that are sewn together all over, and a detector for them. */
#include "tests/support/equal_panels.h"

#include "tests/support/packed.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static uint32_t panel_triangles[TRIANGLES * 3];

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

void panels_begin(equal_panels *p, double min_separation, uint32_t threads) {
    uint32_t k = 0;
    for (uint32_t i = 0; i + 1 < SIDE; i++) {
        for (uint32_t j = 0; j + 1 < SIDE; j++) {
            uint32_t v = i * SIDE + j, corners[] = {v, v + SIDE, v + 1, v + 1, v + SIDE, v + SIDE + 1};
            for (int c = 0; c < 6; c++) panel_triangles[k++] = corners[c];
        }
    }
    for (uint32_t v = 0; v < PANEL; v++) {
        const double at[] = {v / SIDE, v % SIDE, 0.1 * sin(v * 1.3)};
        memcpy(p->x0 + (size_t)3 * v, at, sizeof at);
        memcpy(p->x0 + (size_t)3 * (PANEL + v), at, sizeof at);
        p->seams[v][0] = v;
        p->seams[v][1] = PANEL + v;
    }
    p->counter = counting_allocator_start();
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = &p->seams[0][0];
    options.seam_count = PANEL;
    options.min_separation = min_separation;
    const cscd_object_desc panel = cscd_object_of_triangles(PANEL, TRIANGLES, panel_triangles);
    const cscd_object_desc objects[] = {panel, panel};
    p->rig = rig_of_objects(context_of(threads, &p->counter), objects, 2, NULL, &options);
    p->context = p->rig.context;
    p->mesh = p->rig.mesh;
    p->detector = p->rig.detector;
    expect_ok(cscd_line_search_create(p->detector, &p->line));
    p->touching = count_touching(p);
}

void panels_end(equal_panels *p) {
    cscd_line_search_destroy(p->line);
    rig_destroy(&p->rig);
    assert_int_equal(p->counter.live, 0);
}

void panels_open(const equal_panels *p) {
    expect_ok(cscd_detector_set_seams(p->detector, NULL, 0));
}

void panels_part(const equal_panels *p, double gap, double *x) {
    memcpy(x, p->x0, sizeof p->x0);
    for (uint32_t v = 0; v < PANEL; v++) x[3 * v + 2] = x[3 * (PANEL + v) + 2] + gap;
}
