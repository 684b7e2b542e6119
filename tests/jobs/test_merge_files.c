/* The files of `cscd merge`: pipes, more than the system opens at once, and a process that is killed at any moment. */
#include "src/tool/jobs/job_merge.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SHARDS = 60, JOBS = 1200 };

static temp_folder folder;
static temp_path merged;

/* Shards as `check` writes them: job j is in shard j modulo their number. */
static int make_files(void **state) {
    FILE *files[SHARDS];
    (void)state;
    folder = temp_folder_make();
    merged = temp_file_path(&folder, "merged.jsonl");
    for (int i = 0; i < SHARDS; i++) {
        char name[40];
        snprintf(name, sizeof name, "shard-%02d.jsonl", i);
        files[i] = fopen(temp_file_path(&folder, name).text, "w");
        assert_non_null(files[i]);
    }
    for (int j = 0; j < JOBS; j++)
        fprintf(files[j % SHARDS],
                "{\"list\":\"0123456789abcdef\",\"jobs\":%d,\"job\":%d,\"result\":\"clean\",\"found\":false,"
                "\"name\":\"job %d\",\"error\":null}\n",
                JOBS, j + 1, j + 1);
    for (int i = 0; i < SHARDS; i++) fclose(files[i]);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static char *merge_all(int code, const char *limit, const char *output) {
    return shell_output(code, "cd '%s' && %s '%s' merge shard-*.jsonl -o '%s'", folder.path, limit,
                        getenv("CSCD_TOOL"), output);
}

static char *expected_lines(void) {
    free(merge_all(0, "", "whole.jsonl"));
    return read_whole_file(temp_file_path(&folder, "whole.jsonl").text, NULL);
}

/* ---- what is read ------------------------------------------------------------------------------------------ */

/* Some files are closed and opened again when all of them are too many. */
static void more_files_than_may_be_open(void **state) {
    (void)state;
    char *expected = expected_lines();
    free(merge_all(0, "prlimit --nofile=20:20", "merged.jsonl"));
    char *found = read_whole_file(merged.text, NULL);
    assert_string_equal(found, expected);
    free(found);
    free(expected);
}

/* The lines of a pipe are gone when they are to be written. */
static void pipes_are_proven_and_not_written(void **state) {
    (void)state;
    char *output = shell_output(0, "cd '%s' && cat shard-*.jsonl | '%s' merge /dev/stdin", folder.path,
                                getenv("CSCD_TOOL"));
    assert_string_equal(output, "1200 jobs: 1200 clean\n");
    free(output);
    remove(merged.text);
    output = shell_output(1, "cd '%s' && cat shard-*.jsonl | '%s' merge /dev/stdin -o merged.jsonl",
                          folder.path, getenv("CSCD_TOOL"));
    assert_string_equal(output, "cscd: /dev/stdin: is read twice, so it must be a file, and no pipe\n");
    free(output);
    assert_int_not_equal(access(merged.text, F_OK), 0);
}

/* A list has ten million jobs at most; a damaged number asks for no memory. */
static void a_damaged_count_is_no_line(void **state) {
    (void)state;
    shell("cd '%s' && head -1 shard-00.jsonl | sed 's/:1200,/:4294967295,/' > odd.jsonl", folder.path);
    temp_path odd = temp_file_path(&folder, "odd.jsonl");
    EXPECT_ERROR(1, TEXTS("odd.jsonl:1: this is no line of results"), "merge", odd.text);
}

/* The sentence names a file that has results. */
static void foreign_results_are_compared_with_some(void **state) {
    (void)state;
    shell("cd '%s' && : > empty.jsonl && sed 's/:1200,/:1201,/' shard-01.jsonl > odd.jsonl", folder.path);
    temp_path empty = temp_file_path(&folder, "empty.jsonl"), odd = temp_file_path(&folder, "odd.jsonl"),
              first = temp_file_path(&folder, "shard-00.jsonl");
    EXPECT_ERROR(1,
                 TEXTS("odd.jsonl:1: these are results of another list", "than those of", "shard-00.jsonl"),
                 "merge", empty.text, first.text, odd.text);
}

/* ---- what changes between the two reads --------------------------------------------------------------------- */

#define LINE(list, jobs, job, result, found)                                                                 \
    "{\"list\":\"0123456789abcde" list "\",\"jobs\":" jobs ",\"job\":" job ",\"result\":\"" result           \
    "\",\"found\":" found ",\"name\":\"body\"}\n"

static bool count_line(void *user, const char *line, size_t length, const job_record *record,
                       io_error *error) {
    (void)error;
    assert_int_equal(line[length - 1], '}');
    assert_int_equal(record->job, *(uint32_t *)user);
    ++*(uint32_t *)user;
    return true;
}

/* Whatever of the second line is another one then, it is not written as if it had been proven. */
static void a_file_that_changes_while_it_is_read_is_noticed(void **state) {
    (void)state;
    static const char first[] = LINE("f", "2", "1", "touching", "false"),
                      second[] = LINE("f", "2", "2", "touching", "false");
    static const char *const others[] = {second,
                                         LINE("f", "2", "1", "touching", "false"),
                                         LINE("e", "2", "2", "touching", "false"),
                                         LINE("f", "3", "2", "touching", "false"),
                                         LINE("f", "2", "2", "crossing", "false"),
                                         LINE("f", "2", "2", "touching", "true "),
                                         "{\"list\":\"0123456789abcdef\"",
                                         ""};
    enum {
        CUT = 4
    }; /* within the name, which is as long in both lines: "dy" of the first would make it whole */
    for (size_t i = 0; i <= sizeof others / sizeof *others; i++) {
        char text[400];
        job_merge merge;
        io_error error = {""};
        uint32_t lines = 0;
        snprintf(text, sizeof text, "%s%s", first, second);
        const temp_path path = temp_file_write(&folder, "changed.jsonl", text, strlen(text));
        const char *paths[] = {path.text};
        assert_true(job_merge_read(paths, 1, MERGE_WHOLE, &merge, &error));
        const bool cut = i == sizeof others / sizeof *others;
        snprintf(text, sizeof text, "%s%s", first, cut ? second : others[i]);
        temp_file_write(&folder, "changed.jsonl", text, strlen(text) - (cut ? CUT : 0));
        assert_int_equal(job_merge_visit(&merge, count_line, &lines, &error), i == 0);
        assert_int_equal(lines, i == 0 ? 2 : 1);
        assert_true(i == 0 || strstr(error.text, "changed.jsonl: has changed while it was read") != NULL);
        job_merge_free(&merge);
    }
}

/* ---- what is written --------------------------------------------------------------------------------------- */

static void expect_old_or_whole(const char *whole, int *wholes) {
    char *found = read_whole_file(merged.text, NULL);
    const bool is_whole = strcmp(found, whole) == 0;
    if (!is_whole) assert_string_equal(found, "old\n");
    *wholes += is_whole;
    free(found);
}

static bool says_nothing_was_written(const tool_run *run) {
    return strstr(run->error, "interrupted; nothing was written") != NULL;
}

/* Whenever the signal comes, the output is whole or what it was before, and so says the sentence. */
static void expect_stopped(int signal, const char *whole) {
    const char *arguments[SHARDS + 4] = {"merge", "-o", merged.text};
    temp_path shards[SHARDS];
    int wholes = 0, stopped = 0;
    for (int i = 0; i < SHARDS; i++) {
        char name[40];
        snprintf(name, sizeof name, "shard-%02d.jsonl", i);
        shards[i] = temp_file_path(&folder, name);
        arguments[3 + i] = shards[i].text;
    }
    for (useconds_t wait = 0; wait < 30000; wait += 1500) {
        temp_file_write(&folder, "merged.jsonl", "old\n", 4);
        tool_process process = run_tool_start(arguments);
        usleep(wait);
        kill(process.pid, signal);
        tool_run run = run_tool_finish(&process);
        if (run.code != 0) assert_int_equal(run.code, 128 + signal);
        stopped += run.code != 0;
        const int before = wholes;
        expect_old_or_whole(whole, &wholes);
        if (wholes > before) assert_false(says_nothing_was_written(&run));
        tool_run_free(&run);
    }
    assert_true(stopped > 0);
    shell("rm -f '%s'/.cscd-output-*", folder.path);
}

static void a_merge_that_is_stopped_leaves_no_half(void **state) {
    (void)state;
    char *whole = expected_lines();
    expect_stopped(SIGKILL, whole);
    expect_stopped(SIGTERM, whole);
    expect_stopped(SIGINT, whole);
    free(whole);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_files_than_may_be_open),
        cmocka_unit_test(pipes_are_proven_and_not_written),
        cmocka_unit_test(a_damaged_count_is_no_line),
        cmocka_unit_test(foreign_results_are_compared_with_some),
        cmocka_unit_test(a_file_that_changes_while_it_is_read_is_noticed),
        cmocka_unit_test(a_merge_that_is_stopped_leaves_no_half),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
