/* Parts, rules and answers survive every failed allocation: they say so, and nothing leaks. And contacts without a frame are kept. */
#include "tests/support/files.h"
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"
#include "tool/answers/answers.h"
#include "tool/io/io.h"

#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path model, cache, table;
static recording scene;

/* The two tetrahedra, the first of which is a part, and the other one two. */
static int open_scene(void **state) {
    (void)state;
    static const char table_text[] =
        "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Tip\n5,Tip\n6,Tip\n7,Base\n";
    recorded flight = recorded_tetrahedra(8);
    const char *records[8];
    for (int t = 0; t < 8; t++) records[t] = t < 4 ? "o Wall" : t < 7 ? "o Dart\ng Tip" : "o Dart\ng Base";
    folder = temp_folder_make();
    model = recorded_write_parts(&folder, "parts.obj", &flight, records);
    cache = recorded_write_cache(&folder, "parts.pc2", &flight);
    table = temp_file_write(&folder, "parts.csv", table_text, sizeof table_text - 1);
    recorded_free(&flight);
    static const char *frames[1];
    frames[0] = cache.text;
    const recording_options options = {
        .model_path = model.text, .frame_paths = frames, .frame_path_count = 1, .thread_count = 1};
    io_error error;
    if (!recording_open(&options, &scene, &error)) fail_msg("%s", error.text);
    return 0;
}

static int close_scene(void **state) {
    (void)state;
    recording_close(&scene);
    temp_folder_remove(&folder);
    return 0;
}

typedef bool attempt(io_error *error);

/* Lets each allocation of what is attempted fail once; returns how many there are. */
static long fail_each(attempt *attempted) {
    for (long successes = 0;; successes++) {
        io_error error = {""};
        io_allocations_left = successes;
        io_allocation_failed = false;
        const bool done = attempted(&error);
        io_allocations_left = -1;
        assert_int_equal(done, !io_allocation_failed);
        if (done) return successes;
        if (strstr(error.text, "out of memory") == NULL) fail_msg("'%s'", error.text);
    }
}

static bool find_parts(io_error *error) {
    part_names parts;
    if (!part_names_find(&scene, NULL, &parts, error)) return false;
    assert_int_equal(parts.count, 3);
    part_names_free(&parts);
    return true;
}

static bool read_parts(io_error *error) {
    part_names parts;
    if (!part_names_read(&scene, table.text, &parts, error)) return false;
    assert_int_equal(parts.count, 3);
    part_names_free(&parts);
    return true;
}

static bool prepare_rules(io_error *error) {
    ignore_pairs ignored;
    const ignore_options options = {.parts_path = table.text,
                                    .rest = REST_PARTS,
                                    .ignored = {.items = {"Tip,Base"}, .count = 1},
                                    .only = {.items = {"Wall"}, .count = 1}};
    if (!ignore_pairs_prepare(&options, &scene, &ignored, error)) return false;
    ignore_pairs_free(&ignored);
    return true;
}

static bool add_frames(answers *a, cscd_detector *detector, io_error *error) {
    double positions[24];
    cscd_intersections found;
    for (uint32_t frame = 0; frame < 8; frame++) {
        if (!recording_read(&scene, frame, positions, error) ||
            !answers_find(a, detector, positions, &found, error) ||
            !answers_add_found(a, frame, &found, 0.0, error))
            return false;
    }
    return answers_finish(a, error);
}

static bool find_answers(io_error *error) {
    ignore_pairs ignored;
    answers a = {0};
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    const ignore_options none = {.path = NULL};
    if (!ignore_pairs_prepare(&none, &scene, &ignored, error)) return false;
    assert_int_equal(cscd_detector_create(scene.context, scene.mesh, NULL, &options, &detector), CSCD_OK);
    bool found = answers_open(&scene, &ignored, true, (answer_limits){0}, &a, error);
    if (found) found = answers_prepare(&a, detector, error) && add_frames(&a, detector, error);
    if (found) assert_true(a.event_count > 0 && a.frames.count == 8);
    answers_close(&a);
    cscd_detector_destroy(detector);
    ignore_pairs_free(&ignored);
    return found;
}

TEST(each_allocation_may_fail) {
    assert_true(fail_each(find_parts) >= 7); /* labels, and two for each part */
    assert_true(fail_each(read_parts) >= 7);
    assert_true(fail_each(prepare_rules) >= 10);
    assert_true(fail_each(find_answers) >= 10);
}

/* Contacts on the way to a frame that was never looked at count for it all the same. */
TEST(contacts_of_the_last_interval_have_a_frame) {
    const cscd_contact contact = {
        .kind = CSCD_CONTACT_VF, .a = 0, .b = 4, .vertices = {0, 4, 5, 6}, .toi = 0.5};
    const ignore_options none = {.path = NULL};
    ignore_pairs ignored;
    io_error error;
    assert_true(ignore_pairs_prepare(&none, &scene, &ignored, &error));
    for (size_t count = 0; count < 3; count++) {
        const cscd_contact items[] = {contact, contact};
        const cscd_contacts contacts = {.items = items, .count = count};
        answers a = {0};
        assert_true(answers_open(&scene, &ignored, true, (answer_limits){0}, &a, &error));
        assert_true(answers_add_contacts(&a, &contacts, &error) && answers_finish(&a, &error));
        assert_int_equal(a.frames.count, count > 0);
        if (count > 0) assert_int_equal(answers_frames(&a)[0].contacts, count);
        answers_close(&a);
    }
    ignore_pairs_free(&ignored);
}

/* What cannot be left out for want of memory stays. */
TEST(events_stay_without_memory) {
    cscd_event events[] = {{.a = 0, .b = 1, .pairs = 1}, {.depths = 1}};
    size_t count = 2;
    io_allocations_left = 0;
    assert_false(consequences_leave_out(events, &count));
    io_allocations_left = -1;
    assert_int_equal(count, 2);
    assert_true(consequences_leave_out(events, &count));
    assert_int_equal(count, 1);
}

AROUND_ALL(open_scene, close_scene)
