/* Signals to processes of a list: to one of them, to all at once, and where nobody learns how a process ended. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS = 6 };

static temp_folder folder;
static temp_path clean, results;

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    clean = write_text("clean.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    results = temp_file_path(&folder, "results.jsonl");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- long jobs --------------------------------------------------------------------------------------------- */

/* A list of replays that take far longer than a signal, each with a file of its own. */
static temp_path write_long_list(void) {
    char text[JOBS * 1600];
    size_t used = 0;
    recorded scene = recorded_fold(40, 30, 2);
    temp_path model = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    temp_path cache = recorded_write_cycle(&folder, "sheet.pc2", &scene, 5000);
    recorded_free(&scene);
    for (int i = 0; i < JOBS; i++)
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "{\"model\": \"%s\", \"frames\": \"%s\", \"outputs\": {\"json\": \"%s/part-%d.json\"}}\n",
            model.text, cache.text, folder.path, i + 1);
    return write_text("long.jsonl", text);
}

/* Waits until so many jobs have begun their files. */
static void wait_for_parts(int count) {
    shell(
        "cd '%s'; for i in $(seq 600); do "
        "n=$(find . -name '.cscd-output-*' -size +0 | wc -l); test $n -ge %d && exit 0; sleep 0.05; done; exit 1",
        folder.path, count);
}

/* The tool with its workers, in a group of its own. */
static pid_t start_group(const char *list) {
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        setpgid(0, 0);
        signal(SIGHUP, SIG_DFL); /* under nohup it is ignored, and what ignores it goes on */
        const char *tool = getenv("CSCD_TOOL");
        execl(tool, tool, "replay", "--list", list, "--results", results.text, "--threads", "2", "--quiet",
              "--method", "brute", (char *)NULL);
        _exit(127);
    }
    setpgid(pid, pid);
    return pid;
}

static int wait_for_end(pid_t pid) {
    int status = 0;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* As `timeout`, Slurm and Ctrl-C do it: every process gets the signal, and a worker is told to stop as well. It closes its files
 * all the same, with what was found until then. */
static void a_signal_to_all_processes_closes_all_files(void **state) {
    static const int signals[] = {SIGTERM, SIGHUP, SIGTERM};
    (void)state;
    temp_path list = write_long_list();
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        remove(results.text);
        shell("rm -f '%s'/part-*.json", folder.path);
        const pid_t pid = start_group(list.text);
        wait_for_parts(2);
        kill(-pid, signals[i]);
        usleep(i == 2 ? 1000 : 0);
        assert_int_equal(wait_for_end(pid), 128 + signals[i]);
        assert_int_not_equal(kill(-pid, 0), 0);
        char *output = shell_output(
            0, "cd '%s'; ls -A | grep -c cscd-output; grep -l '\"complete\":false' part-*.json | wc -l",
            folder.path);
        assert_string_equal(output, "0\n2\n");
        free(output);
        char *lines = read_whole_file(results.text, NULL);
        assert_string_equal(lines, "");
        free(lines);
    }
}

/* A worker that is told to stop from outside, however often, gives its job up, though a pipe lets it wait; another goes on with
 * it: if none did, nobody would read the pipe. */
static void a_worker_that_is_told_to_stop_fails_no_job(void **state) {
    (void)state;
    char text[2000], pipe[400];
    snprintf(pipe, sizeof pipe, "%s/waits.obj", folder.path);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    snprintf(text, sizeof text, "{\"model\": \"%s\"}\n{\"model\": \"%s\"}\n{\"model\": \"%s\"}\n", clean.text,
             pipe, clean.text);
    temp_path list = write_text("waiting.jsonl", text);
    remove(results.text);
    tool_process process = run_tool_start((const char *const[]){"check", "--list", list.text, "--results",
                                                                results.text, "--threads", "1", NULL});
    shell("for i in $(seq 600); do test -s '%s' && exit 0; sleep 0.05; done; exit 1", results.text);
    shell("w=$(cat /proc/%d/task/%d/children); for i in 1 2 3; do kill -TERM $w; sleep 0.05; done; "
          "for i in $(seq 600); do kill -0 $w || break; sleep 0.05; test $i != 600; done || exit 1; "
          "timeout 30 sh -c 'cat \"$1\" > \"$2\"' sh '%s' '%s'",
          (int)process.pid, (int)process.pid, clean.text, pipe);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "3 recordings: 3 clean\n"));
    tool_run_free(&run);
    remove(pipe);
}

/* ---- what is said ------------------------------------------------------------------------------------------ */

/* Some programs ignore SIGCHLD, and what they start inherits that. */
static void a_process_that_dies_is_named_everywhere(void **state) {
    (void)state;
    char text[1000];
    snprintf(text, sizeof text, "{\"model\": \"%s\"}\n{\"model\": \"%s/pipe.obj\"}\n", clean.text,
             folder.path);
    temp_path list = write_text("waiting.jsonl", text);
    remove(results.text);
    shell("cd '%s'; mkfifo pipe.obj", folder.path);
    char *output = shell_output(
        1,
        "trap '' CHLD; cd '%s'; '%s' check --list '%s' --results results.jsonl --threads 1 --quiet & p=$!; "
        "until test -s results.jsonl; do sleep 0.05; done; kill -KILL $(cat /proc/$p/task/$p/children); wait $p",
        folder.path, getenv("CSCD_TOOL"), list.text);
    if (strstr(output, "its process was killed by signal 9") == NULL) fail_msg("%s", output);
    free(output);
    shell("rm '%s/pipe.obj'", folder.path);
}

/* One line for people each, whatever a name is; results have it as it is. */
static void odd_names_take_one_line(void **state) {
    (void)state;
    char text[800], expected[400];
    snprintf(text, sizeof text, "{\"model\": \"%s\", \"name\": \"a\\nb\\u001b[2J\\u007f\"}\n", clean.text);
    temp_path list = write_text("odd.jsonl", text);
    remove(results.text);
    tool_run run = RUN_TOOL("check", "--list", list.text, "--results", results.text);
    assert_int_equal(run.code, 0);
    snprintf(expected, sizeof expected, "a?b?[2J?: Clean");
    if (strncmp(run.out, expected, strlen(expected)) != 0) fail_msg("%s", run.out);
    tool_run_free(&run);
    char *lines = read_whole_file(results.text, NULL);
    size_t at;
    json_node *line = json_node_parse(lines, strlen(lines) - 1, &at);
    assert_string_equal(json_node_string(line, "name"), "a\nb\x1b[2J\x7f");
    json_node_free(line);
    free(lines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_to_all_processes_closes_all_files),
        cmocka_unit_test(a_worker_that_is_told_to_stop_fails_no_job),
        cmocka_unit_test(a_process_that_dies_is_named_everywhere),
        cmocka_unit_test(odd_names_take_one_line),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
