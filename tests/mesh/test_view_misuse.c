/* Positions and views that do not fit are refused with a sentence before anything is read beyond or written. */
#include "tests/support/misuse.h"

/* ---- positions ----------------------------------------------------------------------------------------- */

static void expect_coordinate(double x, const char *words) {
    double end[COORDINATES];
    cscd_contacts found = {.count = 77};
    memcpy(end, x1, sizeof end);
    end[7] = x;
    EXPECT_ARGUMENT(cscd_detector_step(detector, AT_START, CSCD_DOUBLES(end, VERTICES), &found), words);
    assert_int_equal(found.count, 77);
}

TEST(positions_that_cannot_be) {
    cscd_contacts found;
    EXPECT_ARGUMENT(cscd_detector_step(detector, NULL, AT_END, &found), "x0 is NULL");
    EXPECT_ARGUMENT(cscd_detector_step(detector, AT_START, NULL, &found), "x1 is NULL");
    EXPECT_ARGUMENT(cscd_detector_step(detector, AT_START, AT_END, NULL), "cscd_detector_step: out is NULL");
    expect_coordinate((double)NAN,
                      "x1: vertex 2 has y = nan, expected 0 or a magnitude from 2^-300 to 2^300");
    expect_coordinate((double)INFINITY, "x1: vertex 2 has y = inf");
    expect_coordinate(1e-310, "x1: vertex 2 has y = 1e-310");
    expect_coordinate(1e300, "x1: vertex 2 has y = 1e+300");
    expect_success(cscd_detector_step(detector, AT_START, AT_START, &found));
    EXPECT_ARGUMENT(cscd_detector_step(detector, CSCD_DOUBLES(x0, 4), AT_END, &found), "x0[0] has 96 bytes");
}

/* ---- views --------------------------------------------------------------------------------------------- */

static void expect_no_view(cscd_view view, const char *words) {
    cscd_contacts found;
    EXPECT_ARGUMENT(cscd_detector_step(detector, &view, AT_END, &found), words);
}

#define EXPECT_NO_VIEW(member, value, words)                                                                 \
    do {                                                                                                     \
        cscd_view changed = cscd_view_doubles(x0, VERTICES);                                                 \
        changed.member = (value);                                                                            \
        expect_no_view(changed, words);                                                                      \
    } while (0)

TEST(views_that_cannot_be_read) {
    EXPECT_NO_VIEW(data, NULL, "x0[0].data is NULL");
    EXPECT_NO_VIEW(scalar, (cscd_scalar)9,
                   "x0[0].scalar is 9, expected CSCD_SCALAR_DOUBLE or CSCD_SCALAR_FLOAT");
    EXPECT_NO_VIEW(object_count, 2, "x0[0] is to hold 2 objects, but only 1 of the mesh is left for it");
    EXPECT_NO_VIEW(size, 24, "x0[0] has 24 bytes, room for 1 of its 8 vertices");
    EXPECT_NO_VIEW(size, 191, "x0[0] has 191 bytes, room for 7 of its 8 vertices");
    EXPECT_NO_VIEW(size, 0, "x0[0] has 0 bytes, room for 0 of its 8 vertices");
    EXPECT_NO_VIEW(stride, 25, "x0[0] has 192 bytes, room for 7 of its 8 vertices");
    EXPECT_NO_VIEW(stride, SIZE_MAX - 7, "x0[0] has 192 bytes, room for 1 of its 8 vertices");
    EXPECT_NO_VIEW(coordinate_stride, SIZE_MAX / 2, "x0[0] has 192 bytes, room for 0 of its 8 vertices");
    EXPECT_NO_VIEW(size, SIZE_MAX,
                   sizeof(size_t) == 4
                       ? "x0[0].size is 4294967295 bytes, more than any memory has"
                       : "x0[0].size is 18446744073709551615 bytes, more than any memory has");
    EXPECT_NO_VIEW(stride, 4, "x0[0]: x of vertex 0 and x of vertex 1 lie on the same bytes");
    EXPECT_NO_VIEW(stride, 8, "lie on the same bytes, with a stride of 8, a coordinate_stride of 8");
    EXPECT_NO_VIEW(coordinate_stride, 4, "x0[0]: x of vertex 0 and y of vertex 0 lie on the same bytes");
}

/* Where max_step writes. */
static void expect_not_written(const cscd_mutable_view *reached, const char *words) {
    cscd_free_step step = {.fraction = 77.0};
    EXPECT_ARGUMENT(cscd_detector_max_step(detector, AT_START, AT_END, reached, &step), words);
    assert_true(step.fraction == 77.0);
}

TEST(views_that_cannot_be_written) {
    double out[COORDINATES] = {0};
    cscd_mutable_view view = cscd_mutable_view_doubles(out, VERTICES);
    expect_not_written(CSCD_MUTABLE_DOUBLES(out, 4), "reached[0] has 96 bytes, room for 4 of its 8 vertices");
    expect_not_written(CSCD_MUTABLE_DOUBLES(NULL, VERTICES), "reached[0].data is NULL");
    view.stride = 16;
    expect_not_written(&view, "reached[0]: x of vertex 1 and z of vertex 0 lie on the same bytes");
    for (int i = 0; i < COORDINATES; i++) assert_true(out[i] == 0.0);
}

/* Views of two objects: side by side, interlocked, or on each other. */
TEST(views_on_each_other) {
    cscd_mesh *both = NULL;
    cscd_detector *of_both = NULL;
    cscd_free_step step;
    double out[3 * COORDINATES];
    const cscd_object_desc objects[] = {*OBJECT(4, 4, triangles), *OBJECT(4, 4, triangles)};
    cscd_mutable_view views[2] = {cscd_mutable_view_doubles(out, 4), cscd_mutable_view_doubles(out + 12, 4)};
    views[0].object_count = 1;
    expect_success(cscd_mesh_create(context, objects, 2, &both));
    expect_success(cscd_detector_create(context, both, NULL, NULL, &of_both));
    expect_success(cscd_detector_max_step(of_both, AT_START, AT_END, views, &step));
    views[0].stride = views[1].stride = 2 * sizeof(double[3]);
    views[0].size = views[1].size = sizeof(double[24]);
    views[1].data = out + 3;
    expect_success(cscd_detector_max_step(of_both, AT_START, AT_END, views, &step));
    views[1].data = out + 2;
    EXPECT_ARGUMENT(cscd_detector_max_step(of_both, AT_START, AT_END, views, &step),
                    "z of vertex 0 of reached[0] and x of vertex 0 of reached[1] lie on the same bytes");
    views[1] = cscd_mutable_view_doubles(out + 11, 4);
    views[0] = cscd_mutable_view_doubles(out, 4);
    views[0].object_count = 1;
    EXPECT_ARGUMENT(cscd_detector_max_step(of_both, AT_START, AT_END, views, &step),
                    "z of vertex 3 of reached[0] and x of vertex 0 of reached[1] lie on the same bytes");
    cscd_detector_destroy(of_both);
    cscd_mesh_destroy(both);
}

/* What is written may lie on what was read: on x0, on x1, or across both. */
TEST(reached_positions_may_replace_others) {
    double expected[COORDINATES], both[2 * COORDINATES];
    cscd_free_step step;
    expect_success(
        cscd_detector_max_step(detector, AT_START, AT_END, CSCD_MUTABLE_DOUBLES(expected, VERTICES), &step));
    for (int place = 0; place <= COORDINATES; place++) {
        memcpy(both, x0, sizeof x0);
        memcpy(both + COORDINATES, x1, sizeof x1);
        expect_success(cscd_detector_max_step(detector, CSCD_DOUBLES(both, VERTICES),
                                              CSCD_DOUBLES(both + COORDINATES, VERTICES),
                                              CSCD_MUTABLE_DOUBLES(both + place, VERTICES), &step));
        assert_memory_equal(both + place, expected, sizeof expected);
    }
}

AROUND_ALL(set_up, tear_down)
