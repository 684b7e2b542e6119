/* The benchmark of all methods, on a small recording: its rows, its guarantees, and its error messages. */
#include "tests/support/models/tiny_recording.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;

static int make_folder(void **state) {
    (void)state;
    folder = temp_folder_make();
    body shape = tiny_recording_write(&folder);
    body_free(&shape);
    const char *program = getenv("CSCD_METHODS");
    return program != NULL && setenv("CSCD_TOOL", program, 1) == 0 ? 0 : -1;
}

static int remove_folder(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

TEST(rows_have_all_columns) {
    static const char *const numbers[] = {"threads",  "triangles",     "ttcd_ms",    "bvh_ms", "orient_ms",
                                          "cnc_ms",   "traverse_ms",   "contact_ms", "pcp",    "tests",
                                          "contacts", "earliest_lost", "lost"};
    temp_path path = temp_file_path(&folder, "rows.json");
    EXPECT_TOOL(0, "tiny", "--data", folder.path, "--cache", folder.path, "--json", path.text);
    json_node *json = json_node_read_file(path.text);
    const json_node *rows = json_node_member(json, "rows");
    bool iccd = false, charge = false, earliest = false, box = false, kdop = false;
    double contacts = json_node_number(json_node_item(rows, 0), "contacts");
    assert_string_equal(json_node_string(json_node_item(rows, 0), "method"), "none");
    assert_true(contacts > 0.0);
    for (size_t i = 0; i < rows->count; i++) {
        const json_node *row = json_node_item(rows, i);
        const char *method = json_node_string(row, "method"), *mode = json_node_string(row, "mode");
        assert_string_equal(json_node_string(row, "scene"), "tiny");
        bool is_box = strcmp(json_node_string(row, "volume"), "box") == 0;
        if (!is_box) assert_string_equal(json_node_string(row, "volume"), "kdop14");
        box |= is_box;
        kdop |= !is_box;
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
            assert_true(json_node_number(row, numbers[k]) >= 0.0);
        iccd |= strcmp(method, "iccd") == 0;
        charge |= strcmp(method, "charge") == 0;
        earliest |= strcmp(mode, "earliest") == 0;
        if (strstr(method, "published") != NULL) continue;
        assert_true(json_node_number(row, "earliest_lost") == 0.0);
        if (strcmp(mode, "all") == 0) assert_true(json_node_number(row, "contacts") == contacts);
    }
    assert_true(iccd && charge && earliest && box && kdop);
    static const char *const origins[] = {"commit", "compiler", "flags", "date"};
    for (size_t k = 0; k < sizeof origins / sizeof *origins; k++)
        assert_true(strlen(json_node_string(json_node_member(json, "provenance"), origins[k])) > 0);
    json_node_free(json);
}

TEST(what_is_wrong_is_said) {
    tool_run run = RUN_TOOL("no-such-scene", "--data", folder.path, "--cache", folder.path);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "no-such-scene.obj"));
    tool_run_free(&run);
    temp_path unwritable = temp_file_path(&folder, "no-such-folder/rows.json");
    run = RUN_TOOL("tiny", "--data", folder.path, "--cache", folder.path, "--json", unwritable.text);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, unwritable.text));
    assert_null(strstr(run.out, "tiny")); /* refused before anything is computed */
    tool_run_free(&run);
}

/* A named folder must contain recordings; without a folder, scenes that the repository does not make
 * cannot be found. */
TEST(data_comes_from_the_environment) {
    assert_int_equal(setenv("CSCD_DATA", folder.path, 1), 0);
    tool_run run = RUN_TOOL("--cache", folder.path);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "/sequences has no recordings"));
    tool_run_free(&run);
    assert_int_equal(unsetenv("CSCD_DATA"), 0);
    run = RUN_TOOL("tiny", "--cache", folder.path);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "neither --data nor CSCD_DATA names a folder"));
    tool_run_free(&run);
}

TEST(wrong_arguments_are_named) {
    static const char *const wrong[][3] = {{"--no-such-option", NULL, "--no-such-option is no option"},
                                           {"--json", NULL, "--json wants a value"},
                                           {"--json", "--quick", "--json wants a value"},
                                           {"--threads", NULL, "--threads wants a value"},
                                           {"--threads", "abc", "abc is no number of threads"},
                                           {"--threads", "2x", "2x is no number of threads"},
                                           {"--threads", "0", "0 is no number of threads"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tool_run run = RUN_TOOL(wrong[i][0], wrong[i][1]);
        assert_int_equal(run.code, 2);
        assert_non_null(strstr(run.error, wrong[i][2]));
        assert_non_null(strstr(run.error, "usage: methods"));
        tool_run_free(&run);
    }
}

/* If all runs had one seed, the mean of their pairs would be that of the first run. */
TEST(kmeans_runs_have_seeds_of_their_own) {
    temp_path path = temp_file_path(&folder, "seeds.json");
    EXPECT_TOOL(0, "tiny", "--data", folder.path, "--cache", folder.path, "--json", path.text);
    json_node *json = json_node_read_file(path.text);
    const json_node *rows = json_node_member(json, "rows");
    bool differ = false;
    for (size_t i = 0; i < rows->count; i++) {
        const json_node *row = json_node_item(rows, i);
        double sum = json_node_number(row, "pcp") * (TINY_FRAMES - 1);
        if (strncmp(json_node_string(row, "method"), "kmeans", 6) == 0)
            differ |= fabs(sum - round(sum)) > 1e-6;
    }
    assert_true(differ);
    json_node_free(json);
}

AROUND_ALL(make_folder, remove_folder)
