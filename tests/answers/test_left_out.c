/* A recording of which a file lists its vertices in another order than the model: millions of pairs on a larger mesh. What does not
 * fit --max-memory is left out and said first, in every output, and the frames beside it are answered as ever. */
#include "tests/support/random_stream.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RINGS = 12, SEGMENTS = 16, VERTICES = RINGS * SEGMENTS };

static temp_folder folder;
static temp_path good, shuffled, json, xml;

/* A torus; its vertices in an order of their own. */
static temp_path write_torus(const char *name, bool in_order) {
    const double turn = 2.0 * acos(-1.0);
    random_stream random = stream_start(4);
    uint32_t order[VERTICES];
    for (uint32_t i = 0; i < VERTICES; i++) {
        const uint32_t k = stream_below(&random, i + 1);
        order[i] = order[k];
        order[k] = i;
    }
    temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    for (uint32_t i = 0; i < VERTICES; i++) {
        const uint32_t v = in_order ? i : order[i];
        const double a = turn * (v / SEGMENTS) / RINGS, b = turn * (v % SEGMENTS) / SEGMENTS,
                     r = 1.0 + 0.4 * cos(b);
        fprintf(file, "v %.9g %.9g %.9g\n", r * cos(a), r * sin(a), 0.4 * sin(b));
    }
    for (uint32_t i = 0; i < VERTICES; i++) {
        const uint32_t ring = i / SEGMENTS, next = (ring + 1) % RINGS * SEGMENTS, j = i % SEGMENTS,
                       k = (j + 1) % SEGMENTS;
        const uint32_t corners[4] = {i + 1, next + j + 1, next + k + 1, ring * SEGMENTS + k + 1};
        for (int t = 1; t < 3; t++) fprintf(file, "f %u %u %u\n", corners[0], corners[t], corners[t + 1]);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    json = temp_file_path(&folder, "out.json");
    xml = temp_file_path(&folder, "out.xml");
    good = write_torus("good.obj", true);
    shuffled = write_torus("shuffled.obj", false);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Between the two words of the first line. */
static size_t number_in(const char *text, const char *before) {
    const char *at = strstr(text, before);
    if (at == NULL) fail_msg("expected '%s' in: %s", before, text);
    return (size_t)strtoull(at + strlen(before), NULL, 10);
}

static void expect_files(bool of_summary) {
    json_node *root = json_node_read_file(json.text);
    const json_node *place = of_summary ? json_node_member(root, "summary") : root;
    assert_false(json_node_boolean(place, "complete"));
    expect_in(json_node_string(place, "stopped_by"), "in another order");
    json_node_free(root);
    char *text = read_whole_file(xml.text, NULL);
    expect_in(text, "tests=\"4\" failures=\"1\" errors=\"1\"");
    expect_in(text, of_summary ? "<error message=\"Not finished: the interval from frame 0 has "
                               : "<error message=\"Not finished: frame 1 has ");
    free(text);
}

/* The pairs of the frame in disorder, those that cross and those that touch, from a run without a limit. */
static size_t count_pairs(void) {
    tool_run run = RUN_TOOL("check", shuffled.text, "--no-depths");
    assert_int_equal(run.code, 0);
    const size_t count = (size_t)strtoull(run.out, NULL, 10) + number_in(run.out, "%); ");
    assert_true(count > 5000);
    assert_null(strstr(run.out, "Not finished"));
    tool_run_free(&run);
    return count;
}

/* Those of the interval between the two. */
static size_t count_contacts(void) {
    tool_run run = RUN_TOOL("replay", good.text, good.text, shuffled.text, "--no-check");
    assert_int_equal(run.code, 0);
    const size_t count = number_in(run.out, "contacts: ") + number_in(run.out, " VF and ");
    assert_true(count > 10000);
    tool_run_free(&run);
    return count;
}

static void one_frame_of_three(void **state) {
    (void)state;
    static const char *const memory[] = {"100K", "2M", "8M"};
    static const char *const left_out[] = {"and a list of them would", "and curves and depths would",
                                           "and depths would"};
    const size_t pairs = count_pairs(), contacts = count_contacts();
    for (int i = 0; i < 6; i++) {
        const bool replays = i % 2 == 1;
        const char *command = replays ? "replay" : "check", *threads = i < 3 ? "1" : "3";
        tool_run run =
            RUN_TOOL(command, good.text, good.text, shuffled.text, good.text, "--max-memory", memory[i / 2],
                     "--threads", threads, "--json", json.text, "--junit", xml.text);
        if (run.code != 1) fail_msg("%s %s: %d\n%s%s", command, memory[i / 2], run.code, run.out, run.error);
        if (replays) { /* the interval to the frame comes before it */
            assert_int_equal(number_in(run.out, "Not finished: the interval from frame 0 has "), contacts);
            expect_in(run.out, "contacts: 0 VF and 0 EE that are listed, and ");
        } else {
            assert_int_equal(number_in(run.out, "Not finished: frame 1 has "), pairs);
            expect_in(run.out, left_out[i / 2]);
        }
        expect_in(run.out,
                  "in another order than the model? 3 of 3 frames checked. Frame 1 crosses (1 of 3).");
        expect_files(replays);
        tool_run_free(&run);
    }
    tool_run run = RUN_TOOL("check", good.text, good.text, shuffled.text, good.text, "--max-memory", "100K",
                            "--fail-on", "crossing");
    assert_int_equal(run.code, 3);
    tool_run_free(&run);
}

/* A frame whose depth is not known passes no rule that asks for it: it is an error of its own, beside that of the run. */
static void a_case_that_is_not_known(void **state) {
    (void)state;
    static const struct {
        const char *memory, *option, *value, *counts, *message;
    } cases[] = {
        {"8M", "--fail-depth", "100", "failures=\"0\" errors=\"2\"", "<error message=\"how deep it is, "},
        {"100K", "--fail-depth", "100", "failures=\"0\" errors=\"2\"", "<error message=\"how deep it is, "},
        {"100K", "--max-faces", "9", "failures=\"0\" errors=\"2\"",
         "<error message=\"how many triangles cross "},
        {"8M", "--max-faces", "9", "failures=\"1\" errors=\"1\"", "triangles cross others"},
        {"8M", "--fail-on", "crossing", "failures=\"1\" errors=\"1\"", " pairs of triangles cross"},
        {"8M", "--max-faces", "384", "failures=\"0\" errors=\"1\"", "name=\"frame 1\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tool_run run = RUN_TOOL("check", good.text, good.text, shuffled.text, good.text, "--max-memory",
                                cases[i].memory, cases[i].option, cases[i].value, "--junit", xml.text);
        tool_run_free(&run);
        char *text = read_whole_file(xml.text, NULL);
        expect_in(text, cases[i].counts);
        expect_in(text, cases[i].message);
        free(text);
    }
}

/* Depths that would take too much work are said first, and a gate of depth does not pass them. */
static void depths_that_take_too_long(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        tool_run run =
            RUN_TOOL(i == 0 ? "check" : "replay", good.text, good.text, shuffled.text, good.text,
                     "--max-work", "1", "--fail-depth", "100", "--junit", xml.text, "--json", json.text);
        assert_int_equal(run.code, 1);
        expect_in(run.out, ", and depths would take more than --max-work allows (");
        tool_run_free(&run);
        char *text = read_whole_file(xml.text, NULL);
        expect_in(text, "failures=\"0\" errors=\"2\"");
        free(text);
        text = read_whole_file(json.text, NULL);
        expect_in(text, "\"depth\":null,\"length\":"); /* of the event */
        free(text);
    }
}

/* Of the first interval. */
static void expect_nothing_of_contacts(void) {
    json_node *root = json_node_read_file(json.text);
    const json_node *interval = json_node_item(json_node_member(root, "intervals"), 0);
    assert_int_equal(json_node_member(interval, "vf")->kind, JSON_NULL);
    assert_int_equal(json_node_member(interval, "earliest_toi")->kind, JSON_NULL);
    assert_int_equal(json_node_member(interval, "guarantee")->count, 0);
    assert_string_equal(json_node_string(interval, "state"), "contact");
    json_node_free(root);
}

/* Contacts alone do not fit, be it in one run or in shards that are merged: there are none in the file, nor numbers in the summary. */
static void contacts_that_do_not_fit(void **state) {
    (void)state;
    const temp_path csv = temp_file_path(&folder, "contacts.csv"),
                    shards[2] = {temp_file_path(&folder, "1.shard"), temp_file_path(&folder, "2.shard")};
    const size_t contacts = count_contacts();
    tool_run run = RUN_TOOL("replay", good.text, good.text, shuffled.text, good.text, "--max-memory", "2M",
                            "--no-check", "--contacts", csv.text, "--json", json.text);
    assert_int_equal(run.code, 1);
    assert_int_equal(number_in(run.out, "Not finished: the interval from frame 0 has "), contacts);
    tool_run_free(&run);
    char *text = read_whole_file(csv.text, NULL);
    assert_ptr_equal(strchr(text, '\n') + 1, text + strlen(text)); /* the names of the columns alone */
    free(text);
    expect_nothing_of_contacts();
    size_t unfinished = 0; /* one of the two has no interval */
    for (int i = 0; i < 2; i++) {
        run = RUN_TOOL("replay", good.text, good.text, shuffled.text, good.text, "--max-memory", "2M",
                       "--no-check", "--shard", i == 0 ? "1/2" : "2/2", "--results", shards[i].text);
        unfinished += run.code == 1;
        tool_run_free(&run);
    }
    assert_int_equal(unfinished, 1);
    EXPECT_TOOL(1, "merge", shards[0].text, shards[1].text, "--json", json.text);
    expect_nothing_of_contacts();
    /* With room for them they are all there. */
    run = RUN_TOOL("replay", good.text, good.text, shuffled.text, good.text, "--max-memory", "200M",
                   "--no-check", "--contacts", csv.text);
    assert_int_equal(run.code, 0);
    tool_run_free(&run);
    size_t lines = 0;
    text = read_whole_file(csv.text, NULL);
    for (const char *at = text; *at != '\0'; at++) lines += *at == '\n';
    free(text);
    assert_true(lines > 2 * contacts - 100);
}

static void exports_of_what_is_left_out(void **state) {
    (void)state;
    temp_path vtk = temp_file_path(&folder, "vtk"), ply = temp_file_path(&folder, "out.ply");
    tool_run run =
        RUN_TOOL("check", shuffled.text, "--max-memory", "2M", "--vtk", vtk.text, "--ply", ply.text);
    assert_int_equal(run.code, 1);
    expect_in(run.out, "Not finished: frame 0 has ");
    tool_run_free(&run);
    EXPECT_TOOL(1, "check", shuffled.text, "--max-memory", "1", "--vtk", vtk.text, "--ply", ply.text);
}

static void sizes_of_memory(void **state) {
    (void)state;
    EXPECT_TOOL(0, "check", good.text, "--max-memory", "1.5G");
    EXPECT_TOOL(0, "check", good.text, "--max-memory", "200000000");
    static const char *const wrong[] = {"0",   "-1",  "much", "5X",    "5GB", "",   "1e40",
                                        "nan", "0.5", "0x10", "0x10G", "1e",  " 1G"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        EXPECT_ERROR(2, TEXTS("--max-memory"), "check", good.text, "--max-memory", wrong[i]);
    EXPECT_ERROR(2, TEXTS("--fail-depth cannot be '0x1p-3mm'"), "check", good.text, "--fail-depth",
                 "0x1p-3mm");
    EXPECT_ERROR(2, TEXTS("--fps cannot be '0x10'"), "check", good.text, "--fps", "0x10");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_frame_of_three),        cmocka_unit_test(a_case_that_is_not_known),
        cmocka_unit_test(contacts_that_do_not_fit),  cmocka_unit_test(exports_of_what_is_left_out),
        cmocka_unit_test(depths_that_take_too_long), cmocka_unit_test(sizes_of_memory)};
    return cmocka_run_group_tests_name("left_out", tests, make_files, remove_files);
}
