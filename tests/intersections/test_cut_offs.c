/* What curves cut off of open surfaces: areas by hand, and by what closed bodies bury of sheets. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */
static cscd_intersections found;

static cscd_status try_cut_offs(void) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.cut_offs = options.overlaps = true;
    return cscd_detector_find_intersections(rig.detector, CSCD_DOUBLES(rig.all.x0, rig.all.vertex_count),
                                            &options, &found);
}

static void find_cut_offs(void) {
    body_rig_create(&rig, NULL, 1);
    expect_ok(try_cut_offs());
    assert_non_null(found.cut_offs);
}

static const cscd_cut_off *cut_off_of(uint32_t object) {
    const cscd_cut_off *item = NULL;
    for (size_t i = 0; i < found.cut_offs->count; i++) {
        if (found.cut_offs->items[i].object != object) continue;
        assert_null(item);
        item = &found.cut_offs->items[i];
    }
    return item;
}

static void expect_cut_off(uint32_t object, double area, double rest) {
    const cscd_cut_off *c = cut_off_of(object);
    assert_non_null(c);
    assert_true(fabs(c->area - area) <= 1e-12);
    assert_true(fabs(c->rest - rest) <= 1e-12);
}

static const double X4[3] = {4, 0, 0}, Y4[3] = {0, 4, 0}, Z4[3] = {0, 0, 4}, ORIGIN[3] = {0, 0, 0};

/* A post through a sheet: over many triangles, and within one. */
TEST(a_post_through_a_sheet) {
    static const double corners[2][3] = {{0.3, 0.4, -1}, {2.26, 2.05, -1}};
    static const double sizes[2][3] = {{2, 1.5, 2}, {0.02, 0.03, 2}};
    for (int i = 0; i < 2; i++) {
        body_rig_begin(&rig);
        body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 9, false);
        body_rig_end_body(&rig);
        body_rig_box(&rig, corners[i], sizes[i]);
        find_cut_offs();
        double area = sizes[i][0] * sizes[i][1];
        assert_int_equal(found.cut_offs->count, 1);
        expect_cut_off(0, area, 16 - area);
        assert_int_equal(cut_off_of(0)->patch_count > 0, i == 0);
    }
}

/* Most of the sheet is in the box, so what is outside is cut off. */
TEST(the_smaller_part_is_outside) {
    static const double corner[3] = {-1, -1, -1}, size[3] = {4.5, 6, 2};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 9, false);
    body_rig_end_body(&rig);
    body_rig_box(&rig, corner, size);
    find_cut_offs();
    expect_cut_off(0, 0.5 * 4, 3.5 * 4);
}

/* From border to border on both sheets; then one of them ends within the other. */
TEST(sheets_cross) {
    for (int i = 0; i < 2; i++) {
        const double corner[3] = {1.1, i == 0 ? -0.5 : 1.5, -1.3}, along[3] = {0, 5, 0};
        body_rig_begin(&rig);
        body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 9, false);
        body_rig_end_body(&rig);
        body_rig_add_sheet(&rig, corner, along, Z4, 8, 6, false);
        body_rig_end_body(&rig);
        find_cut_offs();
        assert_int_equal(found.curves->count, 1);
        if (i == 0) {
            assert_int_equal(found.cut_offs->count, 1); /* the upright sheet is wider, so it is not divided */
            expect_cut_off(0, 1.1 * 4, 2.9 * 4);
        } else {
            assert_int_equal(found.cut_offs->count, 0); /* each ends within the other */
        }
    }
}

/* A narrow upright sheet ends within the flat one: the flat one is not divided, the upright one is. */
TEST(a_narrow_sheet_is_divided) {
    static const double corner[3] = {1.1, 1.5, -1.3}, along[3] = {0, 1, 0};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 9, false);
    body_rig_end_body(&rig);
    body_rig_add_sheet(&rig, corner, along, Z4, 3, 6, false);
    body_rig_end_body(&rig);
    find_cut_offs();
    assert_int_equal(found.cut_offs->count, 1);
    expect_cut_off(1, 1.3, 2.7);
}

/* From the border of a sheet to its hole: one may still walk around the hole. */
TEST(a_cut_to_a_hole_divides_nothing) {
    static const double corner[3] = {2.0, -0.5, -1.3};
    for (int i = 0; i < 2; i++) {
        const double along[3] = {0, i == 0 ? 2.5 : 5, 0};
        body_rig_begin(&rig);
        body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 7, 7, true);
        body_rig_end_body(&rig);
        body_rig_add_sheet(&rig, corner, along, Z4, 8, 6, false);
        body_rig_end_body(&rig);
        find_cut_offs();
        assert_int_equal(found.curves->count, 1 + i); /* all the way, the second one from the hole on */
        assert_int_equal(found.cut_offs->count, 0);
    }
}

/* A sheet of 6 x 6 cells with a slit along its middle from a border to (3, 3), whose sides are sewn together. */
enum { SLIT_ROW = 3, SLIT_LENGTH = 3, SLIT_CELLS = 6 };

static void add_sewn_slit(uint32_t seams[SLIT_LENGTH][2]) {
    static const double along[3] = {6, 0, 0}, up[3] = {0, 6, 0};
    scene *s = &rig.all;
    body_rig_add_sheet(&rig, ORIGIN, along, up, SLIT_CELLS, SLIT_CELLS, false);
    uint32_t row = SLIT_ROW * (SLIT_CELLS + 1), upper = SLIT_ROW * SLIT_CELLS * 2;
    for (uint32_t v = 0; v < SLIT_LENGTH; v++) {
        memcpy(&s->x0[s->vertex_count * 3], &s->x0[(row + v) * 3], sizeof(double[3]));
        for (uint32_t i = upper * 3; i < s->triangle_count * 3; i++)
            if (s->triangles[i] == row + v) s->triangles[i] = s->vertex_count;
        seams[v][0] = row + v;
        seams[v][1] = s->vertex_count++;
    }
}

/* A post beside the seam cuts its cross-section off; one on the seam has a closed curve, and cuts nothing off. */
TEST(traces_over_seams_divide_nothing) {
    static const double size[3] = {0.8, 1.6, 2};
    for (int i = 0; i < 4; i++) {
        const double corner[3] = {0.63, 0.35 + i, -1};
        uint32_t seams[SLIT_LENGTH][2];
        cscd_detector_options options = cscd_detector_defaults();
        body_rig_begin(&rig);
        add_sewn_slit(seams);
        options.seams = seams[0];
        options.seam_count = SLIT_LENGTH;
        body_rig_end_body(&rig);
        body_rig_box(&rig, corner, size);
        body_rig_create(&rig, &options, 1);
        expect_ok(try_cut_offs());
        assert_int_equal(found.curves->count, 1);
        assert_true(found.curves->items[0].closed);
        bool over_seam = corner[1] < SLIT_ROW && corner[1] + size[1] > SLIT_ROW;
        assert_int_equal(found.cut_offs->count, !over_seam);
        if (!over_seam) expect_cut_off(0, size[0] * size[1], 36 - size[0] * size[1]);
    }
}

/* Balls in a sheet that is bent: what they bury of it is what their curves cut off, or the rest. */
TEST(balls_in_bent_sheets) {
    uint32_t divided = 0;
    for (int i = 0; i < 40; i++) {
        const double centre[3] = {1.0 + 0.05 * i, 2.0 - 0.03 * i, 0.02 * (i % 11)};
        body_rig_begin(&rig);
        body_rig_add_sheet(&rig, ORIGIN, X4, Y4, 9, 8, false);
        for (uint32_t v = 0; v < rig.all.vertex_count; v++) {
            double *x = &rig.all.x0[v * 3];
            x[2] = 0.3 * sin(1.3 * x[0] + 0.7 * x[1] + i);
        }
        body_rig_end_body(&rig);
        scene_add_sphere(&rig.all, centre, 0.5 + 0.01 * i, 9, 14);
        body_rig_end_body(&rig);
        find_cut_offs();
        const cscd_cut_off *c = found.curves->count == 1 ? cut_off_of(0) : NULL;
        if (c != NULL) {
            double buried = found.overlaps->items[0].area_a;
            assert_true(fabs(c->area - buried) <= 1e-12 || fabs(c->rest - buried) <= 1e-12);
            assert_true(c->area <= c->rest);
            divided++;
        }
    }
    assert_true(divided > 20);
}

AROUND_EACH(NULL, body_rigs_free)
