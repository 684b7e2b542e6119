/* The folded surface: a closed sphere that meets itself in the middle of its motion, and not before. */
#include "cscd/cscd.h"
#include "models/folds/folds.h"
#include "src/io/animation.h"
#include "src/io/mesh_file.h"
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <string.h>

typedef double frame_positions[FOLDS_VERTICES][3];

static folds surface;
static frame_positions positions;

static int make_surface(void **state) {
    (void)state;
    folds_make(&surface);
    return 0;
}

static size_t crossing_at(cscd_detector *detector, int frame) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.answer = CSCD_ANSWER_COUNT;
    cscd_intersection_pairs found;
    folds_pose(&surface, frame, positions);
    assert_int_equal(cscd_detector_find_intersections(detector, CSCD_DOUBLES(positions[0], FOLDS_VERTICES),
                                                      &options, &found),
                     CSCD_OK);
    assert_int_equal(found.count, found.crossing);
    return found.crossing;
}

static void folds_meet_in_the_middle_alone(void **state) {
    (void)state;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    const cscd_object_desc object =
        cscd_object_of_triangles(FOLDS_VERTICES, FOLDS_TRIANGLES, surface.triangles[0]);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &object, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, NULL, &detector), CSCD_OK);
    const cscd_component sphere = cscd_mesh_component(mesh, 0);
    assert_int_equal(cscd_mesh_component_count(mesh), 1);
    assert_true(sphere.closed_manifold);
    assert_int_equal(sphere.euler_characteristic, 2);
    assert_int_equal(crossing_at(detector, 0), 0);
    assert_int_equal(crossing_at(detector, 15), 0);
    const size_t begun = crossing_at(detector, 24), worst = crossing_at(detector, 49);
    assert_true(begun > 20 && worst > 4 * begun);
    assert_int_equal(crossing_at(detector, FOLDS_FRAMES - 1), 0);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

static void the_program_writes_model_and_cache(void **state) {
    (void)state;
    temp_folder folder = temp_folder_make();
    const temp_path model = temp_file_path(&folder, "folds.obj"),
                    cache = temp_file_path(&folder, "folds.pc2");
    model_program_use("folds");
    EXPECT_TOOL(0, folder.path);
    model_program_use(NULL);
    io_error error;
    mesh_file file;
    animation *frames;
    if (!mesh_file_read(model.text, &file, &error)) fail_msg("%s", error.text);
    assert_int_equal(file.vertex_count, FOLDS_VERTICES);
    assert_memory_equal(file.triangles, surface.triangles, sizeof surface.triangles);
    assert_memory_equal(file.positions, surface.positions, sizeof surface.positions);
    mesh_file_free(&file);
    const char *paths[] = {cache.text};
    if (!animation_open(paths, 1, FOLDS_VERTICES, NULL, &frames, &error)) fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(frames), FOLDS_FRAMES);
    animation_close(frames);
    temp_folder_remove(&folder);
}

static void the_program_refuses_what_it_does_not_know(void **state) {
    (void)state;
    model_program_refuses("folds", 2, "expected a folder", (const char *const[]){NULL});
    model_program_refuses("folds", 1, "No such file", (const char *const[]){"/no/folder", NULL});
    model_program_use(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folds_meet_in_the_middle_alone),
        cmocka_unit_test(the_program_writes_model_and_cache),
        cmocka_unit_test(the_program_refuses_what_it_does_not_know),
    };
    return cmocka_run_group_tests_name("folds_program", tests, make_surface, NULL);
}
