/* Questions of solvers that cannot be answered are refused with a sentence. */
#include "tests/support/misuse.h"

/* ---- questions of solvers ------------------------------------------------------------------------------ */

TEST(distances_that_cannot_be) {
    cscd_proximities near;
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, AT_START, 0.0, CSCD_NEAR_PAIRS, &near),
                    "distance is 0, expected a length");
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, AT_START, -1.0, CSCD_NEAR_PAIRS, &near),
                    "distance is -1, expected a length");
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, AT_START, (double)NAN, CSCD_NEAR_PAIRS, &near),
                    "distance is nan");
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, AT_START, 1e308, CSCD_NEAR_PAIRS, &near),
                    "distance is 1e+308");
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, NULL, 1.0, CSCD_NEAR_PAIRS, &near),
                    "positions is NULL");
    EXPECT_ARGUMENT(cscd_detector_find_near(detector, AT_START, 1.0, CSCD_NEAR_PAIRS, NULL),
                    "cscd_detector_find_near: out is NULL");
    EXPECT_ARGUMENT(cscd_detector_set_separation(detector, -1.0, 0.0),
                    "min_separation is -1, expected 0 or a length");
    EXPECT_ARGUMENT(cscd_detector_check(detector, NULL, &(cscd_intersections){0}), "positions is NULL");
    EXPECT_ARGUMENT(cscd_detector_check(detector, AT_START, NULL),
                    "cscd_detector_find_intersections: out is NULL");
    EXPECT_ARGUMENT(cscd_detector_max_step(detector, AT_START, AT_END, NULL, NULL),
                    "cscd_detector_max_step: out is NULL");
}

TEST(line_searches_in_disorder) {
    cscd_line_search *search;
    cscd_proximities near;
    cscd_free_step step;
    double x[COORDINATES];
    const cscd_mutable_view *out = CSCD_MUTABLE_DOUBLES(x, VERTICES);
    expect_success(cscd_line_search_create(detector, &search));
    EXPECT_ARGUMENT(cscd_line_search_create(detector, NULL), "cscd_line_search_create: out is NULL");
    EXPECT_ARGUMENT(cscd_line_search_max_step(search, 1.0, out, &step), "call cscd_line_search_begin first");
    EXPECT_ARGUMENT(cscd_line_search_find_near(search, 0.5, 1.0, CSCD_NEAR_PAIRS, &near),
                    "call cscd_line_search_begin first");
    EXPECT_ARGUMENT(cscd_line_search_positions(search, 0.5, out), "call cscd_line_search_begin first");
    EXPECT_ARGUMENT(cscd_line_search_begin(search, AT_START, AT_END, -1.0),
                    "reach is -1, expected 0 or a length");
    expect_success(cscd_line_search_begin(search, AT_START, AT_END, 0.0));
    EXPECT_ARGUMENT(cscd_line_search_find_near(search, 0.5, 1.0, CSCD_NEAR_PAIRS, &near),
                    "begun with a reach of 0");
    EXPECT_ARGUMENT(cscd_line_search_max_step(search, 0.0, out, &step),
                    "longest is 0, expected a number in (0,1]");
    EXPECT_ARGUMENT(cscd_line_search_max_step(search, 2.0, out, &step),
                    "longest is 2, expected a number in (0,1]");
    EXPECT_ARGUMENT(cscd_line_search_positions(search, 1.5, out),
                    "fraction is 1.5, expected a number in [0,1]");
    expect_success(cscd_line_search_max_step(search, 1.0, out, &step));
    expect_success(cscd_detector_set_separation(detector, 0.3, 0.0));
    EXPECT_ARGUMENT(cscd_line_search_max_step(search, 1.0, out, &step), "call cscd_line_search_begin again");
    expect_success(cscd_detector_set_separation(detector, 0.0, 0.0));
    cscd_line_search_destroy(search);
}

/* What a line had before is gone, as its positions may be of other scalars. */
TEST(a_begin_that_fails_leaves_no_motion) {
    cscd_line_search *search;
    float now[COORDINATES], wanted[COORDINATES], x[COORDINATES];
    for (int i = 0; i < COORDINATES; i++) now[i] = wanted[i] = (float)x0[i];
    wanted[7] = NAN;
    expect_success(cscd_line_search_create(detector, &search));
    expect_success(cscd_line_search_begin(search, AT_START, AT_END, 0.0));
    EXPECT_ARGUMENT(
        cscd_line_search_begin(search, CSCD_FLOATS(now, VERTICES), CSCD_FLOATS(wanted, VERTICES), 0.0), "x1");
    EXPECT_ARGUMENT(cscd_line_search_positions(search, 0.5, CSCD_MUTABLE_FLOATS(x, VERTICES)),
                    "call cscd_line_search_begin first");
    cscd_line_search_destroy(search);
}

AROUND_ALL(set_up, tear_down)
