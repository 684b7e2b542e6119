/* Pipes whose other side does not come: the first signal ends the wait of every command, whatever it waits for. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { ENDS_WITHIN_S = 60 };

static temp_folder folder;
static temp_path model, cache, pattern, pipe_in, out;
static int writer; /* of a test's own */

static temp_path make_pipe(const char *name) {
    const temp_path path = temp_file_path(&folder, name);
    assert_int_equal(mkfifo(path.text, 0600), 0);
    return path;
}

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(8);
    model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    pattern = recorded_write_sequence(&folder, "walk_%03d.obj", &scene);
    recorded_free(&scene);
    pipe_in = make_pipe("pipe.obj");
    out = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Is a thread asleep, and no longer one of the copy of this program that the process begins as? An emulator has its own name. */
static bool thread_sleeps(pid_t pid, const char *thread) {
    char path[320], text[256] = "";
    snprintf(path, sizeof path, "/proc/%d/task/%s/stat", (int)pid, thread);
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    const bool got = fgets(text, sizeof text, file) != NULL;
    fclose(file);
    const char *name = strchr(text, '('), *state = strrchr(text, ')');
    const bool is_tool = name != NULL && (strncmp(name, "(cscd)", 6) == 0 || strncmp(name, "(qemu-", 6) == 0);
    return got && is_tool && state != NULL && strncmp(state, ") S ", 4) == 0;
}

/* Are all its threads asleep? One that waits for another sleeps too, but that one does not. */
static bool process_sleeps(pid_t pid) {
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/task", (int)pid);
    DIR *threads = opendir(path);
    bool asleep = threads != NULL;
    for (struct dirent *thread; asleep && (thread = readdir(threads)) != NULL;)
        asleep = thread->d_name[0] == '.' || thread_sleeps(pid, thread->d_name);
    if (threads != NULL) closedir(threads);
    return asleep;
}

/* Has it a handler of its own for a signal? */
static bool process_catches(pid_t pid, int number) {
    char path[64], line[256];
    unsigned long long caught = 0;
    snprintf(path, sizeof path, "/proc/%d/status", (int)pid);
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL)
        if (sscanf(line, "SigCgt: %llx", &caught) == 1) break;
    if (file != NULL) fclose(file);
    return (caught >> (number - 1) & 1) != 0;
}

/* Until it has slept for some moments on end, as it does nowhere but at the pipe: all else here is done in a few milliseconds. */
static void wait_until_it_waits(pid_t pid) {
    for (int asleep = 0, looks = 0; asleep < 12; looks++) {
        asleep = process_sleeps(pid) ? asleep + 1 : 0;
        if (looks > 1000 * ENDS_WITHIN_S) fail_msg("the tool does not wait");
        usleep(1000);
    }
}

/* A process that goes on would let the test wait for ever. */
static tool_run finish_in_time(tool_process *process) {
    for (int ms = 0; ms < 1000 * ENDS_WITHIN_S; ms++) {
        siginfo_t ended = {.si_pid = 0};
        assert_int_equal(waitid(P_PID, (id_t)process->pid, &ended, WEXITED | WNOHANG | WNOWAIT), 0);
        if (ended.si_pid != 0) return run_tool_finish(process);
        usleep(1000);
    }
    kill(process->pid, SIGKILL);
    tool_run run = run_tool_finish(process);
    fail_msg("the signal was not heard\nstdout: %s\nstderr: %s", run.out, run.error);
    return run;
}

/* at_work: it waits with a handler of its own, for work to keep what it has found. */
static tool_run signal_waiting(const char *const *arguments, int number, bool at_work) {
    tool_process process = run_tool_start(arguments);
    for (int looks = 0; at_work && !process_catches(process.pid, number); looks++) {
        if (looks > 1000 * ENDS_WITHIN_S) fail_msg("the tool does not begin to work");
        usleep(1000);
    }
    wait_until_it_waits(process.pid);
    kill(process.pid, number);
    tool_run run = finish_in_time(&process);
    if (run.code != 128 + number)
        fail_msg("%s: code %d for signal %d\n%s", arguments[0], run.code, number, run.error);
    return run;
}

static void expect_nothing_half(void) {
    DIR *entries = opendir(folder.path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries))
        if (strncmp(entry->d_name, ".cscd-output-", 13) == 0) fail_msg("%s is left", entry->d_name);
    closedir(entries);
}

/* By one signal after the other. */
static void expect_ended(const char *const *arguments) {
    static const int signals[] = {SIGHUP, SIGINT, SIGTERM};
    static int next;
    tool_run run = signal_waiting(arguments, signals[next++ % 3], false);
    tool_run_free(&run);
    expect_nothing_half();
}

#define EXPECT_ENDED(...) expect_ended((const char *const[]){__VA_ARGS__, NULL})

static void a_signal_ends_the_wait_for_a_writer(void **state) {
    (void)state;
    temp_path list = temp_file_write(&folder, "list.jsonl", "", 0), lines = make_pipe("lines.jsonl");
    char job[600];
    snprintf(job, sizeof job, "{\"model\": \"%s\"}\n", pipe_in.text);
    list = temp_file_write(&folder, "list.jsonl", job, strlen(job));
    EXPECT_ENDED("check", pipe_in.text);
    EXPECT_ENDED("check", model.text, cache.text, "--parts", pipe_in.text);
    EXPECT_ENDED("check", model.text, cache.text, "--ignore", pipe_in.text);
    EXPECT_ENDED("check", "--list", lines.text);
    EXPECT_ENDED("check", "--list", list.text);
    EXPECT_ENDED("check", "--each", pipe_in.text);
    EXPECT_ENDED("replay", pipe_in.text, cache.text);
    EXPECT_ENDED("sense", pipe_in.text, cache.text);
    EXPECT_ENDED("preprocess", pipe_in.text);
    EXPECT_ENDED("info", pipe_in.text);
    EXPECT_ENDED("render", pipe_in.text, "-o", "picture.png");
    EXPECT_ENDED("merge", lines.text);
    EXPECT_ENDED("report", lines.text, "-o", "page.html");
    remove(lines.text);
}

static void a_signal_ends_the_wait_for_a_reader(void **state) {
    (void)state;
    temp_path csv = make_pipe("out.csv"), json = make_pipe("pipe.json"), page = make_pipe("page.html"),
              kept = temp_file_path(&folder, "kept.csv");
    EXPECT_ENDED("check", model.text, cache.text, "--events", kept.text, "--json", json.text);
    EXPECT_ENDED("replay", model.text, cache.text, "--contacts", kept.text, "--json", json.text);
    EXPECT_ENDED("replay", model.text, cache.text, "--report", page.text, "--json", out.text);
    EXPECT_ENDED("sense", model.text, cache.text, "--csv", csv.text, "--json", out.text);
    EXPECT_ENDED("preprocess", model.text, "-o", temp_file_path(&folder, "plan.ply").text, "--report",
                 page.text);
    EXPECT_ENDED("info", model.text, "--json", json.text);
    EXPECT_ENDED("check", "--each", model.text, "--json", make_pipe("each.jsonl").text);
}

/* The writer is there, and has not written all: the mesh that the pipe holds so far must not be taken for the whole. */
static void a_signal_ends_a_read(void **state) {
    (void)state;
    static const char begin[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    writer = open(pipe_in.text, O_RDWR | O_CLOEXEC); /* so that opening waits for nobody */
    assert_true(writer >= 0);
    assert_int_equal(write(writer, begin, sizeof begin - 1), sizeof begin - 1);
    tool_run run = signal_waiting((const char *const[]){"preprocess", pipe_in.text, NULL}, SIGTERM, false);
    if (strstr(run.error, "pipe.obj: cannot read: Interrupted") == NULL) fail_msg("%s", run.error);
    tool_run_free(&run);
}

/* Else whoever reads the pipe next, after a failure, would wait for its end. */
static int close_writer(void **state) {
    (void)state;
    close(writer);
    return 0;
}

/* Whoever waits long for a writer, and for its bytes, reads all of them. */
static void late_bytes_are_read(void **state) {
    (void)state;
    char *output = shell_output(
        0,
        "cd '%s'; (sleep 0.2; head -c 40 model.obj; sleep 0.2; tail -c +41 model.obj) >pipe.obj & "
        "timeout 60 \"$CSCD_TOOL\" preprocess pipe.obj -o late.ply --method single",
        folder.path);
    if (strstr(output, "8 vertices, 8 triangles") == NULL) fail_msg("%s", output);
    free(output);
}

/* What was found before the frame that did not come is kept. (An emulator catches every signal, so that nobody sees whether the tool
 * is at work.) */
static void frames_before_a_pipe_are_kept(void **state) {
    (void)state;
    if (getenv("CSCD_EMULATED") != NULL) skip();
    temp_path fifth = temp_file_path(&folder, "walk_005.obj");
    static const char *const commands[] = {"check", "replay"};
    remove(fifth.text);
    assert_int_equal(mkfifo(fifth.text, 0600), 0);
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        tool_run run = signal_waiting(
            (const char *const[]){commands[i], model.text, pattern.text, "--json", out.text, NULL}, SIGHUP,
            true);
        if (strstr(run.error,
                   i == 0 ? "interrupted after 5 of 8 frames" : "interrupted after 4 of 7 intervals") == NULL)
            fail_msg("%s", run.error);
        tool_run_free(&run);
        json_node *root = json_node_read_file(out.text);
        assert_int_equal(json_node_member(root, "frames")->count, 5);
        json_node_free(root);
        expect_nothing_half();
    }
    remove(fifth.text);
}

/* A signal may come just before a call that waits. Whenever it comes, it is heard. */
static void no_moment_is_too_early(void **state) {
    (void)state;
    for (useconds_t wait = 0; wait < 12000; wait += 1000) {
        tool_process process = run_tool_start((const char *const[]){"preprocess", pipe_in.text, NULL});
        usleep(wait);
        kill(process.pid, SIGTERM);
        tool_run run = finish_in_time(&process);
        assert_int_equal(run.code, 128 + SIGTERM);
        tool_run_free(&run);
    }
}

/* As nohup has it with SIGHUP, and a shell with SIGINT of what runs in its background. */
static void what_is_ignored_stays_ignored(void **state) {
    static const char *const ignored[] = {"HUP", "INT", "TERM"};
    (void)state;
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++) {
        char *output = shell_output(
            0,
            "cd '%s'; trap '' %s; \"$CSCD_TOOL\" preprocess pipe.obj -o kept.ply --method single & "
            "p=$!; for i in 1 2 3 4 5; do kill -%s $p; sleep 0.02; done; timeout 30 sh -c 'cat model.obj >pipe.obj'; wait $p",
            folder.path, ignored[i], ignored[i]);
        if (strstr(output, "8 vertices, 8 triangles") == NULL) fail_msg("%s", output);
        free(output);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_ends_the_wait_for_a_writer),
        cmocka_unit_test(a_signal_ends_the_wait_for_a_reader),
        cmocka_unit_test_teardown(a_signal_ends_a_read, close_writer),
        cmocka_unit_test(late_bytes_are_read),
        cmocka_unit_test(frames_before_a_pipe_are_kept),
        cmocka_unit_test(no_moment_is_too_early),
        cmocka_unit_test(what_is_ignored_stays_ignored),
    };
    return cmocka_run_group_tests_name("waiting_pipes", tests, make_files, remove_files);
}
