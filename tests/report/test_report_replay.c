/* The parts of a replay that a report keeps: contacts, orientations, detector points, and every n-th frame
 * of long recordings. */
#include "tests/support/own_folder.h"
#include "tests/support/packed.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/report/report_rig.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 7, FOLD_FRAMES = 13, CONTACTS_MAX = 20000 };

static page write_page(report *r) {
    io_error error = {""};
    temp_path path = temp_file_path(&folder, "report.html");
    if (!report_write(r, path.text, NULL, 0, NULL, &error)) fail_msg("%s", error.text);
    report_destroy(r);
    return page_read(path.text);
}

static report *create_report(const report_options *options) {
    io_error error = {""};
    report *r = NULL;
    if (!report_create(options, &r, &error)) fail_msg("%s", error.text);
    return r;
}

/* The arrays that the page should have, from a separate replay. */
typedef struct expected {
    uint32_t count, interval[CONTACTS_MAX], vertices[CONTACTS_MAX][4];
    uint8_t kind[CONTACTS_MAX];
    double toi[CONTACTS_MAX], point[CONTACTS_MAX][3];
    uint32_t *heat;
    uint8_t *orientation; /* per kept interval and triangle */
    double *points;
    size_t orientation_count, point_count;
} expected;

static expected found; /* large; one test at a time */

static bool has_edge(const uint32_t *corners, uint32_t a, uint32_t b) {
    int have = 0;
    for (int i = 0; i < 3; i++) have += corners[i] == a || corners[i] == b;
    return have == 2;
}

/* Finds the triangles of a contact by looking at every triangle. */
static void heat_triangles(const report_rig *rig, const cscd_contact *contact, const uint32_t *v) {
    for (uint32_t t = 0; t < rig->shape.triangle_count; t++) {
        const uint32_t *c = rig->shape.triangles + (size_t)t * 3;
        bool takes_part = contact->kind == CSCD_CONTACT_VF
                              ? t == contact->b || c[0] == v[0] || c[1] == v[0] || c[2] == v[0]
                              : has_edge(c, v[0], v[1]) || has_edge(c, v[2], v[3]);
        found.heat[t] += takes_part;
    }
}

static void expect_contact(const report_rig *rig, uint32_t interval, const cscd_contact *contact) {
    uint32_t i = found.count++, *v = found.vertices[i];
    assert_true(i < CONTACTS_MAX);
    if (contact->kind == CSCD_CONTACT_VF) {
        v[0] = contact->a;
        cscd_mesh_triangle(rig->mesh, contact->b, v + 1);
    } else {
        cscd_mesh_edge(rig->mesh, contact->a, v);
        cscd_mesh_edge(rig->mesh, contact->b, v + 2);
    }
    found.interval[i] = interval;
    found.kind[i] = contact->kind == CSCD_CONTACT_EE;
    found.toi[i] = contact->toi;
    memcpy(found.point[i], contact->point, sizeof contact->point);
    heat_triangles(rig, contact, v);
}

static void expect_marks(const report_rig *rig) {
    for (uint32_t t = 0; t < rig->shape.triangle_count; t++) {
        int orientation = cscd_detector_orientation(rig->detector, t);
        found.orientation[found.orientation_count++] = (uint8_t)(orientation < 0 ? 2 : orientation);
    }
    for (uint32_t i = 0; i < cscd_detector_region_count(rig->detector); i++, found.point_count += 6)
        cscd_detector_region_point(rig->detector, i, found.points + found.point_count,
                                   found.points + found.point_count + 3);
}

static void expect_replay(const report_rig *rig) {
    size_t triangles = rig->shape.triangle_count, intervals = rig->shape.frame_count - 1;
    memset(&found, 0, sizeof found);
    found.heat = calloc(triangles, sizeof *found.heat);
    found.orientation = malloc(triangles * intervals);
    found.points = malloc(triangles * intervals * sizeof(double[6]));
    for (uint32_t k = 0; k < intervals; k++) {
        cscd_contacts contacts;
        assert_int_equal(step_packed(rig->detector, recorded_position(&rig->shape, k, 0),
                                     recorded_position(&rig->shape, k + 1, 0), &contacts),
                         CSCD_OK);
        for (size_t i = 0; i < contacts.count; i++) expect_contact(rig, k, &contacts.items[i]);
        expect_marks(rig);
    }
}

static void free_expected(void) {
    free(found.heat);
    free(found.orientation);
    free(found.points);
}

static void expect_bytes(const page *p, const char *name, const void *bytes, size_t size) {
    page_bytes read = page_array(p, name);
    if (read.size != size || memcmp(read.data, bytes, size) != 0) fail_msg("%s differs", name);
    free(read.data);
}

static void expect_orientations(const page *p, uint32_t triangles) {
    page_bytes bytes = page_array(p, "orientation");
    size_t row = ((size_t)triangles + 3) / 4;
    assert_int_equal(bytes.size, found.orientation_count / triangles * row);
    for (size_t i = 0; i < bytes.size; i++) {
        if (i >= row) bytes.data[i] ^= bytes.data[i - row];
        for (size_t bits = 0; bits < 4; bits++) {
            size_t t = i % row * 4 + bits;
            unsigned expect = t < triangles ? found.orientation[i / row * triangles + t] : 0;
            assert_int_equal(bytes.data[i] >> (2 * bits) & 3, expect);
        }
    }
    free(bytes.data);
}

static void expect_contacts(const page *p) {
    const json_node *contacts = json_node_member(p->scene, "contacts");
    assert_true(json_node_number(contacts, "found") == found.count);
    assert_true(json_node_number(contacts, "kept") == found.count);
    expect_bytes(p, "contact_interval", found.interval, found.count * sizeof *found.interval);
    expect_bytes(p, "contact_kind", found.kind, found.count);
    expect_bytes(p, "contact_vertices", found.vertices, found.count * sizeof *found.vertices);
    expect_bytes(p, "contact_toi", found.toi, found.count * sizeof *found.toi);
    expect_bytes(p, "contact_point", found.point, found.count * sizeof *found.point);
}

/* Replays with a second detector and expects the same: the first one's state must not matter. */
static void check_replay(recorded shape, recorded again, cscd_method method) {
    report_rig rig = report_rig_create(shape, method), own = report_rig_create(again, method);
    report_options options = report_rig_options(&rig);
    report *r = create_report(&options);
    assert_true(report_rig_replay(&rig, r, NULL));
    page p = write_page(r);
    expect_replay(&own);
    assert_true(found.count > 0);
    expect_contacts(&p);
    expect_bytes(&p, "heat", found.heat, shape.triangle_count * sizeof *found.heat);
    expect_orientations(&p, shape.triangle_count);
    expect_bytes(&p, "detector_points", found.points, found.point_count * sizeof *found.points);
    free_expected();
    page_free(&p);
    report_rig_destroy(&rig);
    report_rig_destroy(&own);
}

TEST(contacts_and_orientations_come_back) {
    check_replay(recorded_tetrahedra(FRAMES), recorded_tetrahedra(FRAMES), CSCD_METHOD_CHARGE);
    check_replay(recorded_cube(false), recorded_cube(false), CSCD_METHOD_SINGLE);
    check_replay(recorded_fold(9, 3, FOLD_FRAMES), recorded_fold(9, 3, FOLD_FRAMES), CSCD_METHOD_KMEANS);
    check_replay(recorded_spindle(24, 8, 9), recorded_spindle(24, 8, 9), CSCD_METHOD_CHARGE);
}

/* ---- long and large recordings ----------------------------------------------------------------------- */

/* Expects a list of the JSON to have these numbers. */
static void expect_list(const json_node *list, const uint32_t *numbers, size_t count) {
    assert_int_equal(list->count, count);
    for (size_t i = 0; i < count; i++) assert_true(json_node_item(list, i)->number == numbers[i]);
}

/* The recording has eight vertices in more than half a million frames. Every fifth is kept, and the replay
 * is interrupted after frame 112. */
TEST(of_long_recordings_few_frames_are_kept) {
    static const uint32_t kept[] = {100, 105, 110, 112};
    report_rig rig = report_rig_create(recorded_tetrahedra(13), CSCD_METHOD_SINGLE);
    report_options options = report_rig_options(&rig);
    options.first = 100;
    options.last = 100 + 2100000;
    report *r = create_report(&options);
    assert_true(report_rig_replay(&rig, r, NULL));
    assert_int_equal(report_frame_count(r), 4);
    for (uint32_t i = 0; i < 4; i++) assert_int_equal(report_frame(r, i), kept[i]);
    page p = write_page(r);
    assert_true(json_node_number(p.scene, "last") == 112.0);
    expect_list(json_node_member(p.scene, "frames"), kept, 4);
    page_bytes frames = page_array(&p, "frames"), orientation = page_array(&p, "orientation");
    double *shown = page_frames(frames, rig.shape.vertex_count, 4, NULL);
    for (uint32_t i = 0; i < rig.shape.vertex_count * 3; i++) {
        double difference = shown[rig.shape.vertex_count * 9 + i] - recorded_position(&rig.shape, 12, 0)[i];
        assert_true(difference < 1e-3 && difference > -1e-3);
    }
    assert_int_equal(orientation.size, 3 * 2);     /* of the intervals 100, 105, 110 */
    assert_false(page_has(&p, "detector_points")); /* they would be two million times two */
    free(shown);
    free(frames.data);
    free(orientation.data);
    page_free(&p);
    report_rig_destroy(&rig);
}

/* The surroundings count, too: with this many vertices there is room only for the first and last frame. */
TEST(moving_scenery_takes_room) {
    static const uint32_t triangle[] = {0, 1, 2};
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_SINGLE);
    report_options options = report_rig_options(&rig);
    options.scenery = (report_scenery){REPORT_POSITIONS_MAX - 5, 1, triangle, true};
    report *r = create_report(&options);
    assert_true(report_rig_replay(&rig, r, NULL));
    assert_int_equal(report_frame_count(r), 2);
    assert_int_equal(report_frame(r, 1), FRAMES - 1);
    report_destroy(r);
    options.scenery.moves = false;
    r = create_report(&options);
    assert_true(report_rig_replay(&rig, r, NULL));
    assert_int_equal(report_frame_count(r), FRAMES);
    report_destroy(r);
    report_rig_destroy(&rig);
}

TEST(scenery_comes_back) {
    static const uint32_t triangle[] = {0, 1, 2};
    static const double positions[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 1, 0, 1, 0, 1, 1}};
    for (int moves = 0; moves < 2; moves++) {
        report_rig rig = report_rig_create(recorded_tetrahedra(2), CSCD_METHOD_SINGLE);
        report_options options = report_rig_options(&rig);
        options.scenery = (report_scenery){3, 1, triangle, moves};
        report *r = create_report(&options);
        assert_true(report_rig_replay(&rig, r, NULL));
        uint32_t count = moves ? report_frame_count(r) : 1;
        for (uint32_t i = 0; i < count; i++) assert_true(report_add_scenery(r, positions[i], NULL));
        page p = write_page(r);
        const json_node *scenery = json_node_member(p.scene, "scenery");
        assert_true(json_node_number(scenery, "vertices") == 3.0);
        assert_true(json_node_number(scenery, "triangles") == 1.0);
        expect_list(json_node_member(scenery, "frames"), (const uint32_t[]){0, 1}, count);
        expect_bytes(&p, "scenery_triangles", triangle, sizeof triangle);
        page_bytes frames = page_array(&p, "scenery_frames");
        double *shown = page_frames(frames, 3, count, NULL);
        assert_memory_equal(shown, positions, count * sizeof *positions); /* exact: powers of two */
        free(shown);
        free(frames.data);
        page_free(&p);
        report_rig_destroy(&rig);
    }
}

/* Gives vertices their numbers in the file, which are made up here. */
static void number_vertices(void *user, const cscd_contact *contact, uint32_t vertices[4]) {
    for (uint32_t i = 0; i < 4; i++) vertices[i] = *(const uint32_t *)user + contact->a + i;
}

/* Made-up contacts, because their number alone decides how many are kept. */
enum { INTERVALS = 30, MANY = 5000, SHARE = REPORT_CONTACTS_MAX / INTERVALS };

/* The first three intervals have no contacts. The next may use what these leave, and the last still has
 * its share. */
static uint32_t found_in(uint32_t interval) {
    return interval < 3 ? 0 : MANY;
}

static page crowded_page(const report_rig *rig, uint32_t *file_offset) {
    static cscd_contact items[MANY];
    report_options options = report_rig_options(rig);
    options.last = INTERVALS;
    options.oriented = false;
    options.file_vertices = number_vertices;
    options.file_vertices_user = file_offset;
    for (int i = 0; i < MANY; i++) items[i] = (cscd_contact){.kind = CSCD_CONTACT_VF, .a = 4, .toi = i};
    report *r = create_report(&options);
    assert_true(report_begin(r, rig->shape.frames, NULL));
    for (uint32_t k = 0; k < INTERVALS; k++) {
        cscd_contacts contacts = {.items = items, .count = found_in(k)};
        assert_true(report_add_interval(r, NULL, &contacts, rig->shape.frames, NULL));
    }
    return write_page(r);
}

TEST(of_many_contacts_each_interval_keeps_its_share) {
    uint32_t offset = 1000, i = 0;
    report_rig rig = report_rig_create(recorded_tetrahedra(FRAMES), CSCD_METHOD_SINGLE);
    page p = crowded_page(&rig, &offset);
    page_bytes intervals = page_array(&p, "contact_interval"), times = page_array(&p, "contact_toi"),
               numbers = page_array(&p, "contact_file_vertices"), heats = page_array(&p, "heat");
    const uint32_t *interval = (const void *)intervals.data, *file_vertex = (const void *)numbers.data;
    const double *toi = (const void *)times.data;
    size_t count = intervals.size / sizeof *interval;
    for (uint32_t k = 0; k < INTERVALS; k++) {
        uint32_t kept = 0;
        for (; i < count && interval[i] == k; i++, kept++) {
            assert_true(toi[i] == kept);
            assert_int_equal(file_vertex[i * 4 + 3], 1007);
        }
        if (k < 3) assert_int_equal(kept, 0);
        if (k == 3 || k == 4) assert_int_equal(kept, REPORT_INTERVAL_CONTACTS_MAX);
        if (k > 3) assert_in_range(kept, SHARE, REPORT_INTERVAL_CONTACTS_MAX);
    }
    assert_int_equal(i, count);
    const json_node *contacts = json_node_member(p.scene, "contacts");
    assert_true(json_node_number(contacts, "found") == (INTERVALS - 3) * MANY);
    assert_true(json_node_number(contacts, "kept") == REPORT_CONTACTS_MAX && count == REPORT_CONTACTS_MAX);
    assert_true(json_node_number(contacts, "interval_limit") == REPORT_INTERVAL_CONTACTS_MAX);
    assert_true(json_node_number(contacts, "limit") == REPORT_CONTACTS_MAX);
    assert_int_equal(*(const uint32_t *)(const void *)heats.data, (INTERVALS - 3) * MANY); /* for face 0 */
    page_bytes all[] = {intervals, times, numbers, heats};
    for (size_t a = 0; a < sizeof all / sizeof *all; a++) free(all[a].data);
    assert_false(page_has(&p, "orientation") || page_has(&p, "detector_points"));
    page_free(&p);
    report_rig_destroy(&rig);
}

AROUND_ALL(own_folder_make, own_folder_remove)
