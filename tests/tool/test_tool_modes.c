/* Methods, modes and starts of a replay: the contacts are the same, or the first ones, and the outputs say
 * which. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 16 };

static temp_folder folder;
static temp_path model, cache, csv, summary;
static size_t touching; /* the first interval with a contact */

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded spindle = recorded_spindle(24, 10, FRAMES);
    model = recorded_write_mesh(&folder, "spindle.obj", &spindle, 0);
    cache = recorded_write_cache(&folder, "spindle.pc2", &spindle);
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    recorded_free(&spindle);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Returns the summary of a replay with more arguments. */
static json_node *replay_recording(const char *const *more) {
    const char *arguments[24] = {"replay",     model.text, cache.text, "--quiet",
                                 "--contacts", csv.text,   "--json",   summary.text};
    for (int i = 0; more[i] != NULL; i++) arguments[8 + i] = more[i];
    run_tool_expect(0, arguments);
    return json_node_read_file(summary.text);
}

#define REPLAY(...) replay_recording((const char *const[]){__VA_ARGS__, NULL})

static const json_node *interval_of(const json_node *root, size_t k) {
    return json_node_item(json_node_member(root, "intervals"), k);
}

/* Checks the guarantee of the only component in interval k. */
static void expect_guarantee(const json_node *root, size_t k, const char *mode, const char *reason) {
    const json_node *list = json_node_member(interval_of(root, k), "guarantee");
    assert_int_equal(list->count, 1);
    assert_string_equal(json_node_string(json_node_item(list, 0), "mode"), mode);
    if (strstr(json_node_string(json_node_item(list, 0), "reason"), reason) == NULL)
        fail_msg("interval %zu: expected '%s' in '%s'", k, reason,
                 json_node_string(json_node_item(list, 0), "reason"));
}

static size_t first_contact(const json_node *root) {
    size_t k = 0;
    while (json_node_member(interval_of(root, k), "earliest_toi")->kind == JSON_NULL) k++;
    return k;
}

static void methods_agree_in_mode_all(void **state) {
    (void)state;
    static const char *const ways[][6] = {
        {"--method", "charge"},
        {"--method", "single", "--threads", "3"},
        {"--method", "kmeans:4"},
        {"--method", "brute"},
        {"--method", "single", "--no-check"},
        {"--method", "kmeans:7", "--start", "unknown"},
        {"--start", "unknown", "--no-check"},
    };
    json_node *root = REPLAY("--method", "none");
    touching = first_contact(root);
    assert_true(touching > 5 && touching < FRAMES - 1);
    json_node_free(root);
    char *expected = read_whole_file(csv.text, NULL);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        json_node_free(replay_recording(ways[i]));
        char *bytes = read_whole_file(csv.text, NULL);
        assert_string_equal(bytes, expected);
        free(bytes);
    }
    free(expected);
}

/* Nothing is lost before the first contact, which is there at its time. */
static void earliest_finds_the_first_contact(void **state) {
    (void)state;
    static const char *const methods[] = {"charge", "single", "kmeans:4"};
    json_node *all = REPLAY("--method", "none");
    double toi = json_node_number(interval_of(all, touching), "earliest_toi");
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        json_node *root = REPLAY("--method", methods[i], "--mode", "earliest");
        const json_node *total = json_node_member(root, "summary");
        assert_string_equal(json_node_string(total, "mode"), "earliest");
        assert_int_equal(first_contact(root), touching);
        assert_true(json_node_number(interval_of(root, touching), "earliest_toi") == toi);
        size_t with_contacts = 0;
        assert_true(json_node_number(total, "contradictions") == 0);
        for (size_t k = 0; k < touching; k++) expect_guarantee(root, k, "all", "no contact");
        for (size_t k = touching; k < FRAMES - 1; k++) {
            bool any = json_node_member(interval_of(root, k), "earliest_toi")->kind == JSON_NUMBER;
            with_contacts += any;
            expect_guarantee(root, k, any ? "earliest" : "all",
                             any ? "later contacts may be missing" : "at the start");
        }
        assert_true(json_node_number(total, "intervals_complete") == FRAMES - 1 - with_contacts);
        json_node_free(root);
    }
    json_node_free(all);
}

static void counters_tell_that_culling_is_on(void **state) {
    (void)state;
    json_node *none = REPLAY("--method", "none"),
              *single = REPLAY("--method", "single", "--mode", "earliest");
    double pairs[2] = {0, 0};
    for (size_t k = 0; k < touching; k++) {
        const json_node *without = interval_of(none, k), *with = interval_of(single, k);
        assert_true(json_node_number(without, "plus") == 0 && json_node_number(without, "minus") == 0);
        assert_true(json_node_number(with, "plus") > 240);
        assert_true(json_node_number(with, "plus") + json_node_number(with, "minus") <= 480);
        assert_true(json_node_number(json_node_member(with, "ms"), "orientation") > 0);
        pairs[0] += json_node_number(without, "pcp");
        pairs[1] += json_node_number(with, "pcp");
        expect_guarantee(none, k, "all", "");
    }
    assert_true(pairs[1] * 4 < pairs[0]);
    assert_true(json_node_number(json_node_member(json_node_member(single, "summary"), "plus"), "mean") > 0);
    json_node_free(none);
    json_node_free(single);
}

/* The tool checks the frames anyway; without that, the detector proves its first start and needs no
 * further proof. */
static void starts_are_proven_once(void **state) {
    (void)state;
    char before[16];
    snprintf(before, sizeof before, "0:%zu", touching);
    static const struct {
        const char *start, *check;
        double static_checks;
        const char *reason;
    } cases[] = {{"prove", "--quiet", 0, "no contact"},
                 {"prove", "--no-check", 1, "no contact"},
                 {"vouched", "--no-check", 0, "no contact"},
                 {"unknown", "--quiet", 0, "no contact"},
                 {"unknown", "--no-check", 0, "not known"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        json_node *root = REPLAY("--method", "single", "--mode", "earliest", "--frames", before, "--start",
                                 cases[i].start, cases[i].check);
        const json_node *total = json_node_member(root, "summary");
        if (json_node_number(total, "static_checks") != cases[i].static_checks)
            fail_msg("case %zu: %g static checks", i, json_node_number(total, "static_checks"));
        for (size_t k = 0; k < touching; k++) expect_guarantee(root, k, "all", cases[i].reason);
        json_node_free(root);
    }
}

static int count_of(const char *text, const char *word) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at++) count++;
    return count;
}

static void tables_have_a_column_for_orientation(void **state) {
    (void)state;
    tool_run run =
        RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "single", "--mode", "earliest");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "of 15 intervals later contacts"));
    assert_non_null(strstr(run.out, "\nsingle "));
    assert_int_equal(count_of(run.out, " X "), 2); /* for the contour, in both rows */
    tool_run_free(&run);
    run = RUN_TOOL("replay", model.text, cache.text, "--timings", "--method", "none");
    assert_int_equal(count_of(run.out, " X "), 6);
    assert_null(strstr(run.out, "may be missing"));
    tool_run_free(&run);
}

static double threads_of(json_node *root) {
    const double threads = json_node_number(json_node_member(root, "provenance"), "threads");
    json_node_free(root);
    return threads;
}

/* Starting them takes longer than the command on a small mesh, unless the user wants them. */
static void small_meshes_get_one_thread(void **state) {
    (void)state;
    cpu_set_t processors;
    assert_int_equal(sched_getaffinity(0, sizeof processors, &processors), 0);
    assert_int_equal(threads_of(REPLAY("--method", "none")), 1);
    assert_int_equal(threads_of(REPLAY("--method", "none", "--threads", "0")), 1);
    assert_int_equal(threads_of(REPLAY("--method", "none", "--threads", "3")), 3);
    recorded fold = recorded_fold(25, 20, 2);
    temp_path larger = recorded_write_mesh(&folder, "larger.obj", &fold, 0);
    temp_path frames = recorded_write_cache(&folder, "larger.pc2", &fold);
    EXPECT_TOOL(0, "replay", larger.text, frames.text, "--quiet", "--method", "none", "--json", summary.text);
    assert_int_equal(threads_of(json_node_read_file(summary.text)), CPU_COUNT(&processors));
    recorded_free(&fold);
}

/* ---- many components ------------------------------------------------------------------------------------- */

enum { COMPONENTS = 300 };

static const uint32_t open_components[] = {0, 7, 299};

static bool is_open(uint32_t component) {
    for (size_t i = 0; i < sizeof open_components / sizeof *open_components; i++)
        if (open_components[i] == component) return true;
    return false;
}

/* Tetrahedra apart from each other, some of which lack a face. */
static temp_path write_many_components(const char *name) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    for (uint32_t i = 0; i < COMPONENTS; i++)
        fprintf(file, "v %u 0 0\nv %u.5 0 0\nv %u 0.5 0\nv %u 0 0.5\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\n%s",
                i, i, i, i, is_open(i) ? "" : "f -4 -1 -2\n");
    assert_int_equal(fclose(file), 0);
    const temp_path path = temp_file_write(&folder, name, text, size);
    free(text);
    return path;
}

/* What holds for most components is said once, so that a file does not grow with their number. */
static void guarantees_are_written_by_exception(void **state) {
    (void)state;
    const temp_path many = write_many_components("many.obj"), first = write_many_components("frame_1.obj"),
                    second = write_many_components("frame_2.obj");
    EXPECT_TOOL(0, "replay", many.text, first.text, second.text, "--method", "single", "--quiet", "--json",
                summary.text);
    json_node *root = json_node_read_file(summary.text);
    const json_node *groups = json_node_member(interval_of(root, 0), "guarantee");
    assert_int_equal(groups->count, 2);
    const json_node *most = json_node_item(groups, 0), *others = json_node_item(groups, 1);
    const size_t others_count = sizeof open_components / sizeof *open_components;
    assert_non_null(strstr(json_node_string(most, "reason"), "embedded at the start"));
    assert_true(json_node_number(most, "count") == (double)(COMPONENTS - others_count));
    assert_null(json_node_find(most, "components"));
    assert_non_null(strstr(json_node_string(others, "reason"), "open"));
    assert_true(json_node_number(others, "count") == (double)others_count);
    const json_node *named = json_node_member(others, "components");
    assert_int_equal(named->count, others_count);
    for (size_t i = 0; i < others_count; i++)
        assert_true(json_node_item(named, i)->number == (double)open_components[i]);
    json_node_free(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(methods_agree_in_mode_all),
        cmocka_unit_test(earliest_finds_the_first_contact),
        cmocka_unit_test(counters_tell_that_culling_is_on),
        cmocka_unit_test(starts_are_proven_once),
        cmocka_unit_test(tables_have_a_column_for_orientation),
        cmocka_unit_test(guarantees_are_written_by_exception),
        cmocka_unit_test(small_meshes_get_one_thread),
    };
    return cmocka_run_group_tests_name("tool_modes", tests, make_files, remove_files);
}
