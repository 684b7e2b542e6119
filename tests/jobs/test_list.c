/* `check --list` and `replay --list`: each job is what its own command would be, and results survive whatever ends the program. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
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

enum { LINES_MAX = 64 };

/* Lines by their jobs, from 1; NULL where there is none. */
typedef struct result_lines {
    json_node *of[LINES_MAX + 1];
    size_t count;
} result_lines;

static result_lines read_results(void) {
    result_lines lines = {.count = 0};
    size_t size, at;
    char *text = read_whole_file(results.text, &size);
    for (char *line = text; line < text + size; lines.count++) {
        char *end = strchr(line, '\n');
        assert_non_null(end);
        json_node *node = json_node_parse(line, (size_t)(end - line), &at);
        assert_non_null(node);
        const size_t job = (size_t)json_node_number(node, "job");
        assert_true(job >= 1 && job <= LINES_MAX);
        assert_null(lines.of[job]);
        lines.of[job] = node;
        line = end + 1;
    }
    free(text);
    return lines;
}

static void free_results(result_lines *lines) {
    for (size_t i = 0; i <= LINES_MAX; i++) json_node_free(lines->of[i]);
    remove(results.text);
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
    result_lines lines = read_results();
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
    free_results(&lines);
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
    result_lines lines = read_results();
    assert_int_equal(lines.count, 5);
    static const char *const expected[] = {NULL, "failed", "clean", "failed", "failed", "crossing"};
    for (int i = 1; i <= 5; i++) assert_string_equal(json_node_string(lines.of[i], "result"), expected[i]);
    assert_non_null(strstr(json_node_string(lines.of[1], "error"), "face index 9 is out of range"));
    assert_non_null(strstr(json_node_string(lines.of[3], "error"), "none.obj: cannot open"));
    assert_non_null(strstr(json_node_string(lines.of[4], "error"), "there is no part 'Arm'"));
    assert_true(json_node_boolean(lines.of[5], "found"));
    assert_int_equal(json_node_member(lines.of[1], "frames")->kind, JSON_NULL);
    free_results(&lines);
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
    result_lines lines = read_results();
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
    free_results(&lines);
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

static void a_job_has_a_time_limit(void **state) {
    (void)state;
    recorded scene = recorded_fold(40, 30, 2);
    temp_path model = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    temp_path cache = recorded_write_cycle(&folder, "sheet.pc2", &scene, 5000);
    recorded_free(&scene);
    temp_path list =
        write_list("{\"model\": \"%s\", \"frames\": \"%s\", \"outputs\": {\"json\": \"%s/part.json\"}}\n"
                   "{\"model\": \"%s\", \"frames\": \"%s\"}\n",
                   model.text, cache.text, folder.path, fold.text, fold_cache.text);
    EXPECT_TOOL(1, "replay", "--list", list.text, "--results", results.text, "--method", "brute",
                "--job-timeout", "2", "--threads", "2");
    result_lines lines = read_results();
    assert_string_equal(json_node_string(lines.of[1], "error"),
                        "it took longer than 2 s, which is its time limit");
    assert_int_equal(json_node_member(lines.of[2], "error")->kind, JSON_NULL);
    free_results(&lines);
    /* What it had found until then is in its own file. */
    temp_path part = temp_file_path(&folder, "part.json");
    json_node *root = json_node_read_file(part.text);
    assert_true(json_node_member(root, "intervals")->count > 0);
    assert_false(json_node_boolean(json_node_member(root, "summary"), "complete"));
    json_node_free(root);
}

/* ---- results that go on ---------------------------------------------------------------------------------- */

enum { SMALL = 12 };

/* A list of so many jobs, two of which fail. */
static temp_path write_small_list(void) {
    char text[LINES_MAX * 300];
    size_t used = 0;
    for (int i = 0; i < SMALL; i++)
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "{\"model\": \"%s\", \"name\": \"job %d\"}\n",
                             i == 3 || i == 7 ? damaged.text : clean.text, i + 1);
    return write_text("small.jsonl", text);
}

static void expect_whole_results(void) {
    result_lines lines = read_results();
    assert_int_equal(lines.count, SMALL);
    for (int i = 1; i <= SMALL; i++) {
        char name[16];
        snprintf(name, sizeof name, "job %d", i);
        assert_string_equal(json_node_string(lines.of[i], "name"), name);
        assert_string_equal(json_node_string(lines.of[i], "result"), i == 4 || i == 8 ? "failed" : "clean");
    }
    free_results(&lines);
}

/* The system ends the program in the middle of a line, at any byte; with `trap` it reports a full disk instead. */
static void expect_resumed(const char *list, const char *trap, size_t bytes, int code, const char *text) {
    char *output =
        shell_output(code, "%s prlimit --core=0 --fsize=%zu '%s' check --list '%s' --results '%s' --quiet",
                     trap, bytes, getenv("CSCD_TOOL"), list, results.text);
    if (strstr(output, text) == NULL) fail_msg("%zu bytes: %s", bytes, output);
    free(output);
    struct stat status;
    assert_int_equal(stat(results.text, &status), 0);
    assert_true((size_t)status.st_size <= bytes);
    char *left = read_whole_file(results.text, NULL);
    assert_true(trap[0] == '\0' || left[0] == '\0' || left[strlen(left) - 1] == '\n');
    free(left);
    tool_run again = RUN_TOOL("check", "--list", list, "--results", results.text, "--resume");
    assert_int_equal(again.code, 1);
    assert_non_null(strstr(again.out, "12 recordings: 10 clean, 2 failed\n"));
    tool_run_free(&again);
    expect_whole_results();
}

static void a_program_that_is_killed_is_resumed(void **state) {
    (void)state;
    temp_path list = write_small_list();
    for (size_t bytes = 0; bytes < 2500; bytes += bytes < 600 ? 41 : 307)
        expect_resumed(list.text, "", bytes, 128 + SIGXFSZ, "");
}

static void a_full_disk_keeps_whole_lines(void **state) {
    (void)state;
    temp_path list = write_small_list();
    for (size_t bytes = 0; bytes < 2500; bytes += bytes < 600 ? 83 : 511)
        expect_resumed(list.text, "trap '' XFSZ;", bytes, 4, "results.jsonl: cannot write: File too large");
}

/* Each run is killed later than the one before, and each goes on with what is there. */
static void kills_at_any_time_lose_nothing(void **state) {
    (void)state;
    temp_path list = write_small_list();
    for (useconds_t wait = 0; wait < 12000; wait += 400) {
        tool_process process = run_tool_start((const char *const[]){
            "check", "--list", list.text, "--results", results.text, "--resume", "--threads", "2", NULL});
        usleep(wait);
        kill(process.pid, SIGKILL);
        tool_run run = run_tool_finish(&process);
        tool_run_free(&run);
    }
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--resume");
    expect_whole_results();
}

static void results_are_not_overwritten(void **state) {
    (void)state;
    temp_path list = write_small_list(), other;
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text);
    EXPECT_ERROR(4, TEXTS("results.jsonl: holds results already; --resume"), "check", "--list", list.text,
                 "--results", results.text);
    EXPECT_ERROR(4, TEXTS("results.jsonl:1:", "results of another list or of other options"), "check",
                 "--list", list.text, "--results", results.text, "--resume", "--fail-on", "crossing");
    EXPECT_ERROR(4, TEXTS("results.jsonl:1:", "another list"), "replay", "--list", list.text, "--results",
                 results.text, "--resume");
    other = write_list("{\"model\": \"%s\"}\n", clean.text);
    EXPECT_ERROR(4, TEXTS("results.jsonl:1:", "has the list been edited?"), "check", "--list", other.text,
                 "--results", results.text, "--resume");
    expect_whole_results();
    temp_path notes = write_text("notes.jsonl", "my notes\n");
    EXPECT_ERROR(4, TEXTS("notes.jsonl:1: this is no line of results"), "check", "--list", list.text,
                 "--results", notes.text, "--resume");
    char *text = read_whole_file(notes.text, NULL);
    assert_string_equal(text, "my notes\n");
    free(text);
}

/* Only those that failed run again, and their last lines count. */
static void failed_jobs_run_again(void **state) {
    (void)state;
    temp_path list = write_small_list(), merged = temp_file_path(&folder, "merged.jsonl");
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text);
    write_text("damaged.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--resume");
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", results.text, "--resume=failed");
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", results.text, "--resume=failed");
    EXPECT_TOOL(0, "merge", results.text, "-o", merged.text);
    char *text = read_whole_file(merged.text, NULL);
    assert_null(strstr(text, "\"failed\""));
    free(text);
    damaged = write_text("damaged.obj", "v 0 0 0\nf 1 2 9\n");
    remove(results.text);
}

static void two_processes_do_not_share_a_file(void **state) {
    (void)state;
    char fifo[400];
    snprintf(fifo, sizeof fifo, "%s/waits.obj", folder.path);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    temp_path list = write_list("{\"model\": \"%s\"}\n", fifo);
    tool_process first =
        run_tool_start((const char *const[]){"check", "--list", list.text, "--results", results.text, NULL});
    for (int i = 0; i < 10000 && access(results.text, F_OK) != 0; i++) usleep(1000);
    usleep(100000); /* for the lock, which comes next */
    EXPECT_ERROR(4, TEXTS("results.jsonl: another process writes its results here"), "check", "--list",
                 list.text, "--results", results.text, "--resume", "--job-timeout", "5");
    shell("cat '%s' > '%s'", clean.text, fifo);
    tool_run run = run_tool_finish(&first);
    assert_int_equal(run.code, 0);
    tool_run_free(&run);
    remove(fifo);
    remove(results.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_replay_of_a_list_is_a_replay),
        cmocka_unit_test(a_job_that_fails_stops_no_other),
        cmocka_unit_test(a_check_of_a_list_is_a_check),
        cmocka_unit_test(wrong_lists_and_options_are_refused),
        cmocka_unit_test(a_job_has_a_time_limit),
        cmocka_unit_test(a_program_that_is_killed_is_resumed),
        cmocka_unit_test(a_full_disk_keeps_whole_lines),
        cmocka_unit_test(kills_at_any_time_lose_nothing),
        cmocka_unit_test(results_are_not_overwritten),
        cmocka_unit_test(failed_jobs_run_again),
        cmocka_unit_test(two_processes_do_not_share_a_file),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
