/* What the console says to the tool: Ctrl-C ends it with the code of SIGINT, once it has written what it has. */
#include "tests/support/test.h"
#include "tests/support/tool/tool_fixture.h"
#include "tests/support/tool/tool_process.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <windows.h>

enum { INTERVALS = 4999, WAIT_S = 60 };

static temp_folder folder;
static temp_path model, cache, csv, summary;

/* Brute force over a thousand features has far more intervals to do than it can finish before the event. */
static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_fold(30, 20, 2);
    model = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    cache = recorded_write_cycle(&folder, "sheet.pc2", &scene, INTERVALS + 1);
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    recorded_free(&scene);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* How many outputs, which lie beside their places until they are whole, have that many bytes? */
static int count_outputs(off_t size) {
    int count = 0;
    DIR *entries = opendir(folder.path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) {
        struct stat status;
        const temp_path path = temp_file_path(&folder, entry->d_name);
        count += strncmp(entry->d_name, ".cscd-output-", 13) == 0 && stat(path.text, &status) == 0 &&
                 status.st_size >= size;
    }
    closedir(entries);
    return count;
}

static void end_tool(const tool_process *process, const char *why) {
    TerminateProcess((HANDLE)(intptr_t)process->pid, 99);
    fail_msg("%s: error %lu", why, GetLastError());
}

/* A console says to all its processes what somebody types; this one does not listen for a moment. */
static void say_to(const tool_process *process, DWORD event) {
    FreeConsole();
    if (!AttachConsole(GetProcessId((HANDLE)(intptr_t)process->pid)))
        end_tool(process, "the console of the tool is not there");
    SetConsoleCtrlHandler(NULL, TRUE);
    if (!GenerateConsoleCtrlEvent(event, 0)) end_tool(process, "the event cannot be made");
    usleep(100 * 1000); /* the event comes on a thread of its own */
    FreeConsole();
    SetConsoleCtrlHandler(NULL, FALSE);
}

/* Counts the contacts of the CSV: whole lines, each of one of the intervals below `end`. */
static size_t count_contacts(size_t end) {
    char line[1000];
    size_t count = 0;
    FILE *file = fopen(csv.text, "rb");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(strncmp(line, "frame,kind,", 11), 0);
    for (; fgets(line, sizeof line, file) != NULL; count++) {
        assert_int_equal(line[strlen(line) - 1], '\n');
        assert_true(strtoul(line, NULL, 10) < end);
    }
    fclose(file);
    return count;
}

/* What follows a key in the text of the summary, of which it is the last. */
static const char *value_of(const char *text, const char *key) {
    const char *found = NULL;
    for (const char *next = text; (next = strstr(next, key)) != NULL; next++) found = next + strlen(key);
    if (found == NULL) fail_msg("no %s in %s", key, text);
    return found;
}

/* The JSON says that it is not complete, and has the contacts of the CSV, which has whole lines of the intervals so far only. */
static void expect_kept(size_t done) {
    char *text = temp_file_read(summary.text, NULL);
    const char *reason = value_of(text, "\"stopped_by\":\""), *word = strstr(reason, "interrupted");
    assert_int_equal(strncmp(value_of(text, "\"complete\":"), "false", 5), 0);
    assert_true(word != NULL && word < strchr(reason, '"'));
    const size_t contacts = count_contacts(done);
    assert_true(contacts > 0);
    assert_int_equal(strtoul(value_of(text, "\"vf\":"), NULL, 10) +
                         strtoul(value_of(text, "\"ee\":"), NULL, 10),
                     contacts);
    free(text);
}

static void wait_for_contacts(const tool_process *process) {
    for (int looks = 0; count_outputs(400) < 2; looks++) {
        if (looks > 100 * WAIT_S) end_tool(process, "no contacts after a minute");
        usleep(10 * 1000);
    }
}

/* How many intervals are done, as the tool says, and that it kept what it found. */
static size_t expect_sentence(const tool_run *run) {
    unsigned done = 0;
    char kept[1200];
    const char *said = strstr(run->error, "cscd: interrupted after ");
    if (said == NULL || sscanf(said, "cscd: interrupted after %u", &done) != 1 || done < 1 ||
        done >= INTERVALS)
        fail_msg("no interrupt in: %s", run->error);
    snprintf(
        kept, sizeof kept,
        "cscd: interrupted after %u of %u intervals (frames 0 to %u); what was found is kept in %s, %s\n",
        done, (unsigned)INTERVALS, done, csv.text, summary.text);
    if (strstr(run->error, kept) == NULL) fail_msg("expected '%s' in: %s", kept, run->error);
    return done;
}

/* The older outputs are replaced by what was found. Wine 8 makes no Ctrl-Break (error 6), and no window to be closed. */
static void control_c_keeps_what_is_written(void **state) {
    (void)state;
    static const char older[] = "what was there";
    temp_file_write(&folder, "out.csv", older, strlen(older));
    temp_file_write(&folder, "out.json", older, strlen(older));
    tool_process process =
        tool_process_start((const char *const[]){"replay", model.text, cache.text, "--method", "brute",
                                                 "--contacts", csv.text, "--json", summary.text, NULL});
    wait_for_contacts(&process);
    say_to(&process, CTRL_C_EVENT);
    if (WaitForSingleObject((HANDLE)(intptr_t)process.pid, 1000 * WAIT_S) != WAIT_OBJECT_0)
        end_tool(&process, "the event was not heard");
    tool_run run = tool_process_finish(&process);
    if (run.code != 130) fail_msg("code %d: %s", run.code, run.error);
    expect_kept(expect_sentence(&run));
    assert_int_equal(count_outputs(0), 0);
    free(run.error);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_c_keeps_what_is_written),
    };
    return cmocka_run_group_tests_name("console_events", tests, make_files, remove_files);
}
