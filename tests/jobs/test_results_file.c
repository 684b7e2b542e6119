/* The file of `--results`: whatever it is, and whatever happens to it, nothing that was computed is lost without a word. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static temp_path clean, damaged, list, results;

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static int make_files(void **state) {
    char text[8000];
    (void)state;
    folder = temp_folder_make();
    clean = write_text("clean.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    damaged = write_text("damaged.obj", "v 0 0 0\nf 1 2 9\n");
    /* Names fill the buffer of the standard output, so that some of it is printed before the end. */
    snprintf(text, sizeof text,
             "{\"model\": \"%s\", \"name\": \"%03000d\"}\n{\"model\": \"%s\"}\n"
             "{\"model\": \"%s\", \"name\": \"%03000d\"}\n",
             clean.text, 1, damaged.text, clean.text, 3);
    list = write_text("jobs.jsonl", text);
    results = temp_file_path(&folder, "results.jsonl");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void run_list(void) {
    remove(results.text);
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--quiet", "--threads", "1");
}

static void expect_file(const char *path, const char *expected) {
    char *text = read_whole_file(path, NULL);
    assert_string_equal(text, expected);
    free(text);
}

/* ---- what is there before --------------------------------------------------------------------------------- */

/* The number of a closed standard file is that of the next file that is opened. */
static void nothing_is_printed_into_the_results(void **state) {
    static const char *const closed[] = {">&-", "2>&-", "<&-", "<&- >&- 2>&-"};
    (void)state;
    run_list();
    char *expected = read_whole_file(results.text, NULL);
    for (size_t i = 0; i < sizeof closed / sizeof *closed; i++) {
        remove(results.text);
        free(shell_output(1, "'%s' check --list '%s' --results '%s' --threads 1 %s", getenv("CSCD_TOOL"),
                          list.text, results.text, closed[i]));
        expect_file(results.text, expected);
    }
    free(expected);
    char *output = shell_output(4, "'%s' check --each '%s' --json - >&-", getenv("CSCD_TOOL"), clean.text);
    assert_string_equal(output, "cscd: standard output: cannot write: Bad file descriptor\n");
    free(output);
    remove(results.text);
}

static void results_are_kept_in_a_file(void **state) {
    char pipe[400];
    (void)state;
    snprintf(pipe, sizeof pipe, "%s/pipe.jsonl", folder.path);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    EXPECT_ERROR(4, TEXTS("pipe.jsonl: is a pipe"), "check", "--list", list.text, "--results", pipe);
    EXPECT_ERROR(4, TEXTS("pipe.jsonl: is a pipe"), "check", "--list", list.text, "--results", pipe,
                 "--resume");
    EXPECT_ERROR(4, TEXTS("Is a directory"), "check", "--list", list.text, "--results", folder.path);
    EXPECT_ERROR(2, TEXTS("--results -: results are kept in a file"), "check", "--list", list.text,
                 "--results", "-");
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", "/dev/null", "--resume", "--quiet");
    remove(pipe);
}

/* Only what these results may have been torn from is cut off. */
static void a_torn_line_of_something_else_stays(void **state) {
    static const char *const others[] = {"{\"model\": \"precious.obj\"}", "notes", "{\"list\":\"0000"};
    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        write_text("results.jsonl", others[i]);
        EXPECT_ERROR(4, TEXTS("results.jsonl:1: this line has no end, and is none of these results"), "check",
                     "--list", list.text, "--results", results.text, "--resume");
        expect_file(results.text, others[i]);
    }
    run_list();
    shell("printf notes >> '%s'", results.text);
    EXPECT_ERROR(4, TEXTS("results.jsonl:4: this line has no end"), "check", "--list", list.text, "--results",
                 results.text, "--resume");
    remove(results.text);
}

/* A power cut may leave characters 0 where the last blocks of a file should be. */
static void zeros_at_the_end_are_cut_off(void **state) {
    (void)state;
    run_list();
    char *expected = read_whole_file(results.text, NULL);
    const size_t size = strlen(expected);
    for (size_t kept = size - 2; kept > size - 200; kept -= 39) {
        shell("truncate -s %zu '%s' && truncate -s %zu '%s'", kept, results.text, kept + 5000, results.text);
        EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--resume", "--quiet");
        expect_file(results.text, expected);
    }
    free(expected);
    remove(results.text);
}

static void a_damaged_line_is_named(void **state) {
    (void)state;
    run_list();
    shell("sed -i '2s/jobs/jibs/' '%s'", results.text);
    EXPECT_ERROR(4, TEXTS("results.jsonl:2: this is no line of results", "delete the line if it is damaged"),
                 "check", "--list", list.text, "--results", results.text, "--resume");
    shell("sed -i 2d '%s'", results.text);
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", results.text, "--resume");
    EXPECT_TOOL(1, "merge", results.text);
    remove(results.text);
}

/* Lines of --json would be those of the other meshes only. */
static void json_of_a_part_is_refused(void **state) {
    temp_path all = temp_file_path(&folder, "all.jsonl");
    (void)state;
    EXPECT_ERROR(2,
                 TEXTS("--json would lack the meshes that --resume passes over", "cscd merge", "all.jsonl"),
                 "check", "--each", clean.text, "--results", results.text, "--resume", "--json", all.text);
}

/* ---- what happens to it while the jobs run ----------------------------------------------------------------- */

static void wait_for_size(const char *path, off_t least) {
    struct stat status;
    for (int i = 0; i < 30000; i++, usleep(1000))
        if (stat(path, &status) == 0 && status.st_size >= least) return;
    fail_msg("%s: too short after 30 seconds", path);
}

/* The second job waits for a pipe while the command changes the file. */
static void expect_noticed(const char *command, const char *sentence) {
    char pipe[400], text[1500];
    (void)remove(results.text);
    snprintf(pipe, sizeof pipe, "%s/waits.obj", folder.path);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    snprintf(text, sizeof text, "{\"model\": \"%s\"}\n{\"model\": \"%s\"}\n{\"model\": \"%s\"}\n", clean.text,
             pipe, clean.text);
    temp_path waiting = write_text("waiting.jsonl", text);
    tool_process process = run_tool_start((const char *const[]){
        "check", "--list", waiting.text, "--results", results.text, "--threads", "1", "--quiet", NULL});
    wait_for_size(results.text, 100);
    shell("cd '%s' && %s", folder.path, command);
    shell("cat '%s' > '%s'", clean.text, pipe);
    tool_run run = run_tool_finish(&process);
    if (run.code != 4 || strstr(run.error, sentence) == NULL)
        fail_msg("%s: %d: %s", command, run.code, run.error);
    tool_run_free(&run);
    remove(pipe);
    remove(waiting.text);
}

static void a_file_that_is_changed_is_noticed(void **state) {
    (void)state;
    expect_noticed("rm results.jsonl", "results.jsonl: was removed or replaced while it was written");
    assert_int_not_equal(access(results.text, F_OK), 0);
    expect_noticed("mv results.jsonl old.jsonl",
                   "results.jsonl: was removed or replaced while it was written");
    expect_noticed("cp results.jsonl new && mv new results.jsonl", "results.jsonl: was removed or replaced");
    expect_noticed(": > results.jsonl", "results.jsonl: was changed by another process while it was written");
    expect_noticed("echo >> results.jsonl",
                   "results.jsonl: was changed by another process while it was written");
    remove(results.text);
}

/* ---- times ------------------------------------------------------------------------------------------------- */

/* No decision depends on a time of a file: lines and answers are the same, whichever is older. */
static void times_of_files_decide_nothing(void **state) {
    static const char *const times[][2] = {{"1970-01-01T00:00:01Z", "2100-01-01T00:00:00Z"},
                                           {"2100-01-01T00:00:00Z", "1970-01-01T00:00:01Z"}};
    (void)state;
    temp_path merged = temp_file_path(&folder, "merged.jsonl");
    run_list();
    char *expected = read_whole_file(results.text, NULL);
    const char *last = strchr(strchr(expected, '\n') + 1, '\n') + 1;
    for (int i = 0; i < 2; i++) {
        const char *inputs = times[i][0], *outputs = times[i][1];
        shell("truncate -s %zu '%s'", (size_t)(last - expected), results.text);
        write_text("merged.jsonl", "old\n");
        shell("cd '%s' && touch -d %s *.obj jobs.jsonl && touch -d %s results.jsonl merged.jsonl",
              folder.path, inputs, outputs);
        tool_run run = RUN_TOOL("check", "--list", list.text, "--results", results.text, "--resume");
        assert_int_equal(run.code, 1);
        assert_non_null(strstr(run.error, "cscd: 2 of them were done before\n"));
        tool_run_free(&run);
        expect_file(results.text, expected);
        shell("touch -d %s '%s'", outputs, results.text);
        EXPECT_TOOL(1, "merge", results.text, "-o", merged.text);
        expect_file(merged.text, expected);
    }
    free(expected);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_printed_into_the_results),
        cmocka_unit_test(results_are_kept_in_a_file),
        cmocka_unit_test(a_torn_line_of_something_else_stays),
        cmocka_unit_test(zeros_at_the_end_are_cut_off),
        cmocka_unit_test(a_damaged_line_is_named),
        cmocka_unit_test(json_of_a_part_is_refused),
        cmocka_unit_test(a_file_that_is_changed_is_noticed),
        cmocka_unit_test(times_of_files_decide_nothing),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
