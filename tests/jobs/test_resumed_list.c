/* Results of a list survive whatever ends the program, and the next run goes on with them. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/result_lines.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static temp_path clean, damaged, results;

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
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

enum { SMALL = 12 };

/* A list of one job. */
static temp_path write_one_job(const char *model) {
    char text[600];
    snprintf(text, sizeof text, "{\"model\": \"%s\"}\n", model);
    return write_text("jobs.jsonl", text);
}

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
    result_lines lines = result_lines_take(results.text);
    assert_int_equal(lines.count, SMALL);
    for (int i = 1; i <= SMALL; i++) {
        char name[16];
        snprintf(name, sizeof name, "job %d", i);
        assert_string_equal(json_node_string(lines.of[i], "name"), name);
        assert_string_equal(json_node_string(lines.of[i], "result"), i == 4 || i == 8 ? "failed" : "clean");
    }
    result_lines_free(&lines);
}

static void expect_resumed(const char *list) {
    tool_run again = RUN_TOOL("check", "--list", list, "--results", results.text, "--resume");
    assert_int_equal(again.code, 1);
    assert_non_null(strstr(again.out, "12 recordings: 10 clean, 2 failed\n"));
    tool_run_free(&again);
    expect_whole_results();
}

/* A program that is killed leaves what it has written, which may end in the middle of a line, at any byte. */
static void a_program_that_is_killed_is_resumed(void **state) {
    (void)state;
    temp_path list = write_small_list();
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--quiet");
    size_t size;
    char *whole = read_whole_file(results.text, &size);
    assert_true(size > 2500);
    for (size_t bytes = 0; bytes < 2500; bytes += bytes < 600 ? 41 : 307) {
        temp_file_write(&folder, "results.jsonl", whole, bytes);
        expect_resumed(list.text);
    }
    free(whole);
}

static void expect_whole_lines(const char *list, size_t bytes, int code, const char *text) {
    char *output =
        shell_output(code, "prlimit --core=0 --fsize=%zu '%s' check --list '%s' --results '%s' --quiet",
                     bytes, getenv("CSCD_TOOL"), list, results.text);
    if (strstr(output, text) == NULL) fail_msg("%zu bytes: %s", bytes, output);
    free(output);
    size_t size;
    char *left = read_whole_file(results.text, &size);
    assert_true(size <= bytes && (size == 0 || left[size - 1] == '\n'));
    free(left);
}

static void a_limit_of_sizes_keeps_whole_lines(void **state) {
    (void)state;
    temp_path list = write_small_list();
    for (size_t bytes = 0; bytes < 2500; bytes += bytes < 600 ? 83 : 511) {
        expect_whole_lines(list.text, bytes, 4, "results.jsonl: cannot write: File too large: a limit");
        expect_resumed(list.text);
    }
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
    other = write_one_job(clean.text);
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
/* A rule that a job has failed before fails the run that goes on, too. */
static void what_was_found_is_remembered(void **state) {
    (void)state;
    temp_path model = write_text("crossing.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\n"
                                                 "f 1 2 3\nf 4 5 6\n"),
              list = write_one_job(model.text);
    EXPECT_TOOL(3, "check", "--list", list.text, "--results", results.text, "--fail-on", "crossing");
    EXPECT_TOOL(3, "check", "--list", list.text, "--results", results.text, "--fail-on", "crossing",
                "--resume");
    remove(results.text);
}

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
    temp_path list = write_one_job(fifo);
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
        cmocka_unit_test(a_program_that_is_killed_is_resumed),
        cmocka_unit_test(a_limit_of_sizes_keeps_whole_lines),
        cmocka_unit_test(kills_at_any_time_lose_nothing),
        cmocka_unit_test(results_are_not_overwritten),
        cmocka_unit_test(what_was_found_is_remembered),
        cmocka_unit_test(failed_jobs_run_again),
        cmocka_unit_test(two_processes_do_not_share_a_file),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
