/* `check --list` and `replay --list`: each job is what its own command would be. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/result_lines.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static temp_path fold, fold_cache, clean, damaged, results;

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_fold(8, 6, 6);
    fold = recorded_write_mesh(&folder, "fold.obj", &scene, 0);
    fold_cache = recorded_write_cycle(&folder, "fold.pc2", &scene, 12);
    recorded_free(&scene);
    clean = write_text("clean.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    damaged = write_text("damaged.obj", "v 0 0 0\nf 1 2 9\n");
    results = temp_file_path(&folder, "results.jsonl");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- lists and results ----------------------------------------------------------------------------------- */

static temp_path write_list(const char *format, ...) __attribute__((format(printf, 1, 2)));

static temp_path write_list(const char *format, ...) {
    char text[8192];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return write_text("jobs.jsonl", text);
}

static void expect_same_file(const char *a, const char *b) {
    size_t size_a, size_b;
    char *text_a = read_whole_file(a, &size_a), *text_b = read_whole_file(b, &size_b);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(text_a, text_b, size_a);
    free(text_a);
    free(text_b);
}

/* ---- what jobs are --------------------------------------------------------------------------------------- */

static void a_replay_of_a_list_is_a_replay(void **state) {
    char path[400], list_path[400];
    (void)state;
    temp_path list =
        write_list("{\"model\": \"%s\", \"frames\": \"%s\", \"name\": \"all\", \"outputs\": {\"contacts\": "
                   "\"%s/all.csv\", \"events\": \"%s/all-events.csv\"}}\n"
                   "{\"model\": \"%s\", \"frames\": \"%s\", \"options\": {\"frames\": \"0:2\"}}\n",
                   fold.text, fold_cache.text, folder.path, folder.path, fold.text, fold_cache.text);
    tool_run many =
        RUN_TOOL("replay", "--list", list.text, "--results", results.text, "--fail-on", "contact");
    snprintf(path, sizeof path, "%s/one.csv", folder.path);
    snprintf(list_path, sizeof list_path, "%s/one-events.csv", folder.path);
    tool_run one = RUN_TOOL("replay", fold.text, fold_cache.text, "--contacts", path, "--events", list_path,
                            "--fail-on", "contact");
    assert_int_equal(many.code, one.code);
    temp_path listed = temp_file_path(&folder, "all.csv"), events = temp_file_path(&folder, "all-events.csv");
    expect_same_file(path, listed.text);
    expect_same_file(list_path, events.text);
    result_lines lines = result_lines_take(results.text);
    assert_int_equal(lines.count, 2);
    assert_string_equal(json_node_string(lines.of[1], "name"), "all");
    assert_int_equal(json_node_number(lines.of[1], "frames"), 12);
    assert_int_equal(json_node_number(lines.of[2], "frames"), 3);
    assert_true(json_node_number(lines.of[1], "contacts") > 0);
    /* The sentence is the first line that a replay prints. */
    const char *answer = json_node_string(lines.of[1], "answer");
    assert_int_equal(strncmp(one.out, answer, strlen(answer)), 0);
    assert_int_equal(one.out[strlen(answer)], '\n');
    assert_non_null(strstr(many.out, answer));
    result_lines_free(&lines);
    tool_run_free(&many);
    tool_run_free(&one);
}

static void a_job_that_fails_stops_no_other(void **state) {
    (void)state;
    temp_path list = write_list(
        "{\"model\": \"%s\"}\n{\"model\": \"%s\"}\n{\"model\": \"%s/none.obj\"}\n"
        "{\"model\": \"%s\", \"options\": {\"only\": \"Arm\"}}\n{\"model\": \"%s\", \"frames\": \"%s\"}\n",
        damaged.text, clean.text, folder.path, clean.text, fold.text, fold_cache.text);
    tool_run run = RUN_TOOL("check", "--list", list.text, "--results", results.text, "--fail-on", "crossing");
    assert_int_equal(run.code, 1);
    assert_string_equal(run.error, "cscd: 3 of 5 recordings could not be checked\n");
    result_lines lines = result_lines_take(results.text);
    assert_int_equal(lines.count, 5);
    static const char *const expected[] = {NULL, "failed", "clean", "failed", "failed", "crossing"};
    for (int i = 1; i <= 5; i++) assert_string_equal(json_node_string(lines.of[i], "result"), expected[i]);
    assert_non_null(strstr(json_node_string(lines.of[1], "error"), "face index 9 is out of range"));
    assert_non_null(strstr(json_node_string(lines.of[3], "error"), "none.obj: cannot open"));
    assert_non_null(strstr(json_node_string(lines.of[4], "error"), "there is no part 'Arm'"));
    assert_true(json_node_boolean(lines.of[5], "found"));
    assert_int_equal(json_node_member(lines.of[1], "frames")->kind, JSON_NULL);
    result_lines_free(&lines);
    tool_run_free(&run);
}

/* Numbers of a check are those that its own --json has. */
static void a_check_of_a_list_is_a_check(void **state) {
    (void)state;
    temp_path list =
        write_list("{\"model\": \"%s\", \"frames\": \"%s\", \"outputs\": {\"json\": \"%s/pairs.json\"}}\n",
                   fold.text, fold_cache.text, folder.path);
    temp_path own = temp_file_path(&folder, "own.json"), listed = temp_file_path(&folder, "pairs.json");
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", results.text, "--quiet");
    EXPECT_TOOL(0, "check", fold.text, fold_cache.text, "--json", own.text);
    expect_same_file(own.text, listed.text);
    result_lines lines = result_lines_take(results.text);
    json_node *root = json_node_read_file(own.text);
    const json_node *frames = json_node_member(root, "frames");
    double pairs = 0.0, touching = 0.0, faces = 0.0, depth = 0.0;
    for (const json_node *f = frames->first; f != NULL; f = f->next) {
        pairs += json_node_number(f, "crossing_pairs");
        touching += json_node_number(f, "touching_pairs");
        if (json_node_number(f, "crossing_faces") > faces) faces = json_node_number(f, "crossing_faces");
        if (json_node_number(f, "depth") > depth) depth = json_node_number(f, "depth");
    }
    assert_true(pairs > 0 && frames->count == 12);
    assert_true(json_node_number(lines.of[1], "crossing_pairs") == pairs);
    assert_true(json_node_number(lines.of[1], "touching_pairs") == touching);
    assert_true(json_node_number(lines.of[1], "crossing_faces") == faces);
    assert_true(json_node_number(lines.of[1], "depth") == depth);
    assert_true(json_node_number(lines.of[1], "events") == json_node_member(root, "events")->count);
    json_node_free(root);
    result_lines_free(&lines);
}

static void wrong_lists_and_options_are_refused(void **state) {
    (void)state;
    temp_path list =
        write_list("{\"model\": \"%s\"}\n{\"model\": \"%s\", \"options\": {\"wled\": \"exact\"}}\n",
                   clean.text, clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:2: 'wled' is no option of check"), "check", "--list", list.text);
    list = write_list("{\"model\": \"%s\", \"options\": {\"weld\": \"so\"}}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:1: --weld cannot be 'so'"), "check", "--list", list.text);
    list = write_list("{\"model\": \"%s\", \"options\": {\"threads\": 3}}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:1: --threads is for the whole list"), "check", "--list", list.text);
    list = write_list("{\"model\": \"%s\", \"outputs\": {\"json\": \"-\"}}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:1: --json: a job among many has no standard output"), "check", "--list",
                 list.text);
    list = write_list("{\"model\": \"%s\", \"options\": {\"allow-gaps\": 1}}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:1: --allow-gaps takes no value"), "check", "--list", list.text);
    list = write_list("{\"model\": \"%s\", \"options\": {\"weld\": true}}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:1: --weld needs a value"), "check", "--list", list.text);
    list = write_list("{\"model\": \"%s\", \"outputs\": {\"json\": \"a.json\"}}\n\n{\"model\": \"%s\"}\n"
                      "{\"model\": \"%s\", \"options\": {\"csv\": \"a.json\"}}\n",
                      clean.text, clean.text, clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:4: 'a.json' is written by line 1 as well"), "check", "--list",
                 list.text);
    list =
        write_list("{\"model\": \"%s\", \"outputs\": {\"json\": \"a//b.json\", \"csv\": \"/tmp/x.csv\"}}\n"
                   "{\"model\": \"%s\", \"outputs\": {\"json\": \"./a/./b.json\", \"csv\": \"tmp/x.csv\"}}\n",
                   clean.text, clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:2: 'a/b.json' is written by line 1 as well"), "check", "--list",
                 list.text);
    list = write_list("{\"model\": \"%s\"}\n{\"model\": \"%s\", \"outputs\": {\"events\": \"r.jsonl\"}}\n",
                      clean.text, clean.text);
    EXPECT_ERROR(4, TEXTS("jobs.jsonl:2: 'r.jsonl' is the list itself or its file of results"), "check",
                 "--list", list.text, "--results", "./r.jsonl");
    list = write_list("{\"model\": \"%s\"}\n", clean.text);
    EXPECT_ERROR(2, TEXTS("--json names one file, and each job"), "check", "--list", list.text, "--json",
                 "a.json");
    EXPECT_ERROR(2, TEXTS("is no input; the list has the models"), "check", "--list", list.text, clean.text);
    EXPECT_ERROR(2, TEXTS("--results", "would overwrite"), "check", "--list", list.text, "--results",
                 list.text);
    EXPECT_ERROR(2, TEXTS("--resume needs --results"), "check", "--list", list.text, "--resume");
    EXPECT_ERROR(2, TEXTS("--shard cannot be '4/3'"), "check", "--list", list.text, "--shard", "4/3");
    EXPECT_ERROR(2, TEXTS("--shard is for --list"), "check", clean.text, "--shard", "1/3");
    EXPECT_ERROR(2, TEXTS("--results is for --list"), "check", clean.text, "--results", "a.jsonl");
    EXPECT_ERROR(4, TEXTS("/nowhere/r.jsonl: cannot write"), "check", "--list", list.text, "--results",
                 "/nowhere/r.jsonl");
}

/* Of the sheet: an interval of it takes far less than the limit, and all of them far longer. */
#ifdef SLOW_MACHINE
enum { SIDE = 20 };
#else
enum { SIDE = 40 };
#endif

static void a_job_has_a_time_limit(void **state) {
    (void)state;
    recorded scene = recorded_fold(SIDE, SIDE - 10, 2);
    temp_path model = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    temp_path cache = recorded_write_cycle(&folder, "sheet.pc2", &scene, 5000);
    recorded_free(&scene);
    temp_path list =
        write_list("{\"model\": \"%s\", \"frames\": \"%s\", \"outputs\": {\"json\": \"%s/part.json\"}}\n"
                   "{\"model\": \"%s\", \"frames\": \"%s\"}\n",
                   model.text, cache.text, folder.path, fold.text, fold_cache.text);
    free(shell_output(
        1,
        "timeout 60 \"$CSCD_TOOL\" replay --list '%s' --results '%s' --method brute --job-timeout 2 "
        "--threads 2",
        list.text, results.text));
    result_lines lines = result_lines_take(results.text);
    assert_string_equal(json_node_string(lines.of[1], "error"),
                        "it took longer than 2 s, which is its time limit");
    assert_int_equal(json_node_member(lines.of[2], "error")->kind, JSON_NULL);
    result_lines_free(&lines);
    /* What it had found until then is in its own file. */
    temp_path part = temp_file_path(&folder, "part.json");
    json_node *root = json_node_read_file(part.text);
    assert_true(json_node_member(root, "intervals")->count > 0);
    assert_false(json_node_boolean(json_node_member(root, "summary"), "complete"));
    json_node_free(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_replay_of_a_list_is_a_replay),
        cmocka_unit_test(a_job_that_fails_stops_no_other),
        cmocka_unit_test(a_check_of_a_list_is_a_check),
        cmocka_unit_test(wrong_lists_and_options_are_refused),
        cmocka_unit_test(a_job_has_a_time_limit),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
