/* What the console says to the tool: Ctrl-C ends it with the code of SIGINT, once it has written what it has. */
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"

#include <dirent.h>
#include <fcntl.h>
#include <io.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>
#include <windows.h>

/* ---- the tool on Windows ------------------------------------------------------------------------------- */

/* CreateProcess with a command line, which the tool takes apart again. */
typedef struct tool_run {
    int code;
    char *error; /* the caller frees it */
} tool_run;

/* The tool while it runs. */
typedef struct tool_process {
    pid_t pid;      /* the handle of the process, which fits */
    int out, error; /* open files */
} tool_process;

enum { LINE_MAX_SIZE = 65536 };

static const char *tool_path(void) {
    const char *path = getenv("CSCD_TOOL");
    if (path == NULL || access(path, F_OK) != 0)
        fail_msg("CSCD_TOOL must name the built tool, but is %s", path != NULL ? path : "not set");
    return path;
}

/* Opens a file without a name, which the tool inherits. */
static int open_capture(void) {
    char place[MAX_PATH + 1], name[MAX_PATH + 1];
    SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, TRUE};
    assert_true(GetTempPathA(MAX_PATH + 1, place) > 0 && GetTempFileNameA(place, "cst", 0, name) > 0);
    const HANDLE handle = CreateFileA(
        name, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
        &inherited, CREATE_ALWAYS, FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    assert_ptr_not_equal(handle, INVALID_HANDLE_VALUE);
    return _open_osfhandle((intptr_t)handle, _O_RDWR | _O_BINARY);
}

/* Adds an argument in quotes: a backslash means itself but before a quote. */
static size_t add_argument(char *line, size_t length, const char *argument) {
    size_t slashes = 0;
    line[length++] = '"';
    for (const char *c = argument;; c++) {
        assert_true(length + 2 * slashes + 8 < LINE_MAX_SIZE);
        if (*c == '\\') {
            slashes++;
            continue;
        }
        const bool doubled = *c == '"' || *c == '\0';
        for (size_t i = 0; i < (doubled ? 2 * slashes : slashes); i++) line[length++] = '\\';
        slashes = 0;
        if (*c == '\0') break;
        if (*c == '"') line[length++] = '\\';
        line[length++] = *c;
    }
    line[length++] = '"';
    line[length++] = ' ';
    return length;
}

static wchar_t *widen_text(const char *text) {
    const int size = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
    wchar_t *wide = malloc((size_t)size * sizeof *wide);
    assert_non_null(wide);
    MultiByteToWideChar(CP_UTF8, 0, text, -1, wide, size);
    return wide;
}

/* Starts the tool, the file that the environment variable CSCD_TOOL names; arguments end with NULL and leave out its own name. Its
 * console has no window; its events come to the tool alone. The test fails when the tool cannot be started. */
static tool_process tool_process_start(const char *const *arguments) {
    static char line[LINE_MAX_SIZE];
    size_t length = add_argument(line, 0, tool_path());
    for (; *arguments != NULL; arguments++) length = add_argument(line, length, *arguments);
    line[length - 1] = '\0';
    tool_process process = {.out = open_capture(), .error = open_capture()};
    STARTUPINFOW start = {.cb = sizeof start, .dwFlags = STARTF_USESTDHANDLES};
    start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
    start.hStdOutput = (HANDLE)_get_osfhandle(process.out);
    start.hStdError = (HANDLE)_get_osfhandle(process.error);
    PROCESS_INFORMATION made;
    wchar_t *wide = widen_text(line);
    fflush(NULL);
    if (!CreateProcessW(NULL, wide, NULL, NULL, TRUE, CREATE_NO_WINDOW, NULL, NULL, &start, &made))
        fail_msg("the tool %s cannot be started", tool_path());
    free(wide);
    CloseHandle(made.hThread);
    process.pid = (pid_t)(intptr_t)made.hProcess;
    return process;
}

static char *read_capture(int descriptor) {
    const off_t size = lseek(descriptor, 0, SEEK_END);
    char *text = malloc((size_t)size + 1);
    assert_true(size >= 0 && text != NULL && lseek(descriptor, 0, SEEK_SET) == 0);
    assert_int_equal(read(descriptor, text, (unsigned)size), size);
    text[size] = '\0';
    return text;
}

static tool_run tool_process_finish(tool_process *process) {
    const HANDLE handle = (HANDLE)(intptr_t)process->pid;
    DWORD code = 0;
    assert_int_equal(WaitForSingleObject(handle, INFINITE), WAIT_OBJECT_0);
    assert_true(GetExitCodeProcess(handle, &code));
    CloseHandle(handle);
    const tool_run run = {(int)code, read_capture(process->error)};
    close(process->out);
    close(process->error);
    return run;
}

/* ---- events -------------------------------------------------------------------------------------------- */

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
