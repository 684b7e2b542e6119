/* The tool leaves out what the user names: parts of objects, of tables, and those that meet at rest. */
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static temp_path model, cache, plain, csv, json;

/* The two tetrahedra, of which the first is the part Wall; of the second the tip's three triangles are Dart/Tip, and its
 * base is Dart. */
static int make_files(void **state) {
    (void)state;
    recorded both = recorded_tetrahedra(8);
    const char *records[8];
    for (uint32_t t = 0; t < 8; t++) {
        const uint32_t *c = both.triangles + t * 3;
        const bool tip = c[0] == 4 || c[1] == 4 || c[2] == 4;
        records[t] = t < 4 ? "o Wall" : tip ? "o Dart\ng Tip" : "o Dart";
    }
    folder = temp_folder_make();
    model = recorded_write_parts(&folder, "named.obj", &both, records);
    plain = recorded_write_mesh(&folder, "plain.obj", &both, 0);
    cache = recorded_write_cache(&folder, "both.pc2", &both);
    csv = temp_file_path(&folder, "out.csv");
    json = temp_file_path(&folder, "out.json");
    recorded_free(&both);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static size_t contacts_with(const char *first, const char *second, const char *third, const char *fourth) {
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--contacts", csv.text, "--method", "none",
                first, second, third, fourth);
    contact_rows rows = contact_rows_read_csv(csv.text);
    const size_t count = rows.count;
    contact_rows_free(&rows);
    return count;
}

/* The pairs of all frames. */
static size_t pairs_with(const char *path, const char *option, const char *value) {
    EXPECT_TOOL(0, "check", path, cache.text, "--quiet", "--json", json.text, option, value);
    json_node *root = json_node_read_file(json.text);
    const json_node *frames = json_node_member(root, "frames");
    size_t count = 0;
    for (size_t i = 0; i < frames->count; i++)
        count += json_node_member(json_node_item(frames, i), "pairs")->count;
    json_node_free(root);
    return count;
}

static void parts_are_left_out(void **state) {
    (void)state;
    const size_t all = contacts_with("--threads", "1", NULL, NULL);
    assert_true(all > 0);
    assert_int_equal(contacts_with("--ignore-parts", "Wall,Dart", NULL, NULL), 0);
    assert_int_equal(contacts_with("--ignore-parts", "Dart,Wall", NULL, NULL), 0);
    assert_int_equal(contacts_with("--ignore-parts", "Wall", NULL, NULL), 0);
    assert_int_equal(contacts_with("--ignore-parts", "Wall,Wall", NULL, NULL), all);
    assert_int_equal(contacts_with("--ignore-parts", "Dart/Tip,Dart/Tip", "--ignore-parts", "Dart,Dart"),
                     all);
    assert_int_equal(contacts_with("--only", "Wall,Dart", NULL, NULL), all);
    assert_int_equal(contacts_with("--only", "Dart", NULL, NULL), all);
    assert_int_equal(contacts_with("--only", "Dart,Dart", NULL, NULL), 0);
    assert_int_equal(contacts_with("--only", "Dart,Dart", "--only", "Wall,Dart/Tip"), all);
    assert_int_equal(contacts_with("--only", "Wall", "--ignore-parts", "Dart"), 0);
}

static void checks_know_the_same_parts(void **state) {
    (void)state;
    const size_t all = pairs_with(model.text, "--threads", "1");
    const size_t tip = pairs_with(model.text, "--only", "Wall,Dart/Tip");
    assert_true(all > 0 && tip > 0);
    assert_int_equal(pairs_with(model.text, "--only", "Wall,Dart"), all);
    assert_int_equal(pairs_with(model.text, "--ignore-parts", "Wall,Dart/Tip"), all - tip);
    assert_int_equal(pairs_with(model.text, "--ignore-parts", "Wall"), 0);
    assert_int_equal(pairs_with(plain.text, "--ignore-parts", "component 0,component 1"), 0);
}

static void tables_name_parts(void **state) {
    (void)state;
    static const char *const tables[] = {
        "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Dart\n5,Dart\n6,Dart\n7,Dart\n",
        "face,name\n# a comment\n0,\"Wall\"\n1,Wall\n2,Wall\n3, Wall\n\n4;Dart\n5\tDart\n6,Dart\n7,Dart\n",
        "vertex,name\r\n0,Wall\r\n1,Wall\r\n2,Wall\r\n3,Wall\r\n4,Dart\r\n5,Dart\r\n6,Dart\r\n7,Dart\r\n"};
    const size_t all = pairs_with(plain.text, "--threads", "1");
    for (size_t i = 0; i < 3; i++) {
        const temp_path table = temp_file_write(&folder, "parts.csv", tables[i], strlen(tables[i]));
        EXPECT_TOOL(0, "check", plain.text, cache.text, "--quiet", "--fail-on-contact", "--parts", table.text,
                    "--ignore-parts", "Wall,Dart");
        EXPECT_TOOL(3, "check", plain.text, cache.text, "--quiet", "--fail-on-contact", "--parts", table.text,
                    "--only", "Wall,Dart");
    }
    assert_true(all > 0);
}

static void bad_tables_and_names_are_told(void **state) {
    (void)state;
    static const struct {
        const char *text, *reason;
    } cases[] = {
        {"", "the file is empty"},
        {"polygon,name\n", ":1: expected 'triangle,name'"},
        {"\xef\xbb\xbftriangle,name\n# none\n", ": no part is named below the first line"},
        {"triangle,name\n0,A\n8,A\n", ":3: expected a number of the model file"},
        {"vertex,name\nx,A\n", ":2: expected a number"},
        {"vertex,name\n3\n", ":2: expected a number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const temp_path table = temp_file_write(&folder, "bad.csv", cases[i].text, strlen(cases[i].text));
        EXPECT_ERROR(1, TEXTS("bad.csv", cases[i].reason), "check", plain.text, "--parts", table.text);
    }
    EXPECT_ERROR(1, TEXTS("--ignore-parts: there is no part 'Hat'", "the parts are Wall, Dart, Dart/Tip"),
                 "check", model.text, "--ignore-parts", "Wall,Hat");
    EXPECT_ERROR(1, TEXTS("--only: there is no part 'Dar'"), "check", model.text, "--only", "Dar");
    EXPECT_ERROR(2, TEXTS("--only cannot be ''"), "check", model.text, "--only", "");
    EXPECT_ERROR(2, TEXTS("--ignore-rest cannot be 'pairs'"), "check", model.text, "--ignore-rest=pairs");
}

/* The frames from the sixth on: the dart has stuck in the wall since before, and moves on with other triangles. */
static void parts_that_meet_at_rest_are_left_out(void **state) {
    (void)state;
    recorded both = recorded_tetrahedra(8);
    recorded later = both;
    later.frame_count = 3;
    later.frames = both.frames + 4 * 8 * 3;
    const temp_path frames = recorded_write_cache(&folder, "later.pc2", &later);
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--quiet", "--contacts", csv.text, "--ignore-rest");
    contact_rows some = contact_rows_read_csv(csv.text);
    assert_true(some.count > 0); /* of pairs of triangles that did not meet at rest */
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--quiet", "--contacts", csv.text,
                "--ignore-rest=parts", "--only", "Wall,Dart");
    contact_rows none = contact_rows_read_csv(csv.text);
    assert_true(none.count < some.count);
    contact_rows_free(&some);
    contact_rows_free(&none);
    tool_run run = RUN_TOOL("replay", plain.text, frames.text, "--ignore-rest=parts");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "are left out, with all pairs of parts that they are in"));
    assert_non_null(strstr(run.out, "contacts: 0 VF and 0 EE"));
    tool_run_free(&run);
    recorded_free(&both);
}

/* An eye in a head: with its tip, or with all but its tip. */
static temp_path write_eye(bool tip_only) {
    const char *eye = tip_only ? "v 1 1 0.8\nv 0.7 0.7 -0.5\nv 1.6 0.8 -0.5\nv 0.8 1.6 -0.5\n"
                               : "v 0.9 0.9 -1\nv 0.7 0.8 0.5\nv 0.8 1.6 0.5\nv 1.6 0.7 0.5\n";
    char text[512];
    const int used =
        snprintf(text, sizeof text,
                 "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\no Head\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
                 "%so Eye\nf 6 8 7\nf 6 7 5\nf 7 8 5\nf 8 6 5\n",
                 eye);
    return temp_file_write(&folder, "eye.obj", text, (size_t)used);
}

/* Where the curve between two objects is left out, the library may find all of one inside of the other. */
static void nothing_is_inside_of_what_is_left_out(void **state) {
    (void)state;
    const char *list = "components 0 1\n", *clean = "Clean: no two triangles cross or touch. As asked, ";
    const temp_path ignored = temp_file_write(&folder, "list.txt", list, strlen(list));
    const char *options[][2] = {{"--ignore-rest=parts", NULL}, {"--ignore-rest", NULL},
                                {"--ignore-parts", "Eye"},     {"--ignore-parts", "Head,Eye"},
                                {"--only", "Eye,Eye"},         {"--ignore", ignored.text}};
    for (int tip_only = 0; tip_only < 2; tip_only++) {
        const temp_path eye = write_eye(tip_only);
        tool_run run = RUN_TOOL("check", eye.text, "--json", json.text);
        assert_non_null(strstr(run.out, "Head x Eye  cross"));
        tool_run_free(&run);
        for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
            run = RUN_TOOL("check", eye.text, "--fail-depth", "0.01", options[i][0], options[i][1]);
            if (run.code != 0 || strncmp(run.out, clean, strlen(clean)) != 0)
                fail_msg("%s: ended with %d and %s", options[i][0], run.code, run.out);
            tool_run_free(&run);
        }
    }
}

/* So many triangles in a row, each a part of its own. The first two cross, and all others are apart. */
static temp_path write_row(int count) {
    temp_path path = temp_file_path(&folder, "row.obj");
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    fputs("v 1 1 -1\nv 2 1 -1\nv 1 1 1\no P0\nf 1 2 3\n", file);
    for (int i = 1; i < count; i++) {
        const int x = 9 * (i - 1), v = 3 * i;
        fprintf(file, "v %d 0 0\nv %d 0 0\nv %d 4 0\no P%d\nf %d %d %d\n", x, x + 4, x, i, v + 1, v + 2,
                v + 3);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

/* Tables of pairs of parts have a limit, of which every option that needs one speaks. */
static void too_many_parts_are_told(void **state) {
    (void)state;
    const char *limit = "at most 8192 parts, and there are 8193";
    temp_path row = write_row(8193);
    EXPECT_ERROR(1, TEXTS("--ignore-rest=parts takes", limit), "check", row.text, "--ignore-rest=parts");
    EXPECT_ERROR(1, TEXTS("--ignore-parts and --only take", limit), "check", row.text, "--only", "P0");
    row = write_row(8192);
    EXPECT_TOOL(0, "check", row.text, "--ignore-rest=parts", "--fail-on", "crossing");
}

static void objects_are_not_named_twice(void **state) {
    (void)state;
    const char *one = "v 0 0 0\nv 4 0 0\nv 0 4 0\no Head\nf 1 2 3\n",
               *two = "v 1 1 -1\nv 1 1 1\nv 2 1 0\no Nose\nf 1 2 3\n";
    const temp_path head = temp_file_write(&folder, "Head.obj", one, strlen(one)),
                    nose = temp_file_write(&folder, "nose.obj", two, strlen(two));
    char object[sizeof nose.text + 8];
    snprintf(object, sizeof object, "Face=%s", nose.text);
    tool_run run = RUN_TOOL("check", head.text, "--object", object);
    if (strstr(run.out, "\nHead x Face/Nose  cross") == NULL) fail_msg("named otherwise: %s", run.out);
    tool_run_free(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_left_out),
        cmocka_unit_test(checks_know_the_same_parts),
        cmocka_unit_test(tables_name_parts),
        cmocka_unit_test(bad_tables_and_names_are_told),
        cmocka_unit_test(parts_that_meet_at_rest_are_left_out),
        cmocka_unit_test(nothing_is_inside_of_what_is_left_out),
        cmocka_unit_test(too_many_parts_are_told),
        cmocka_unit_test(objects_are_not_named_twice),
    };
    return cmocka_run_group_tests_name("tool_parts", tests, make_files, remove_files);
}
