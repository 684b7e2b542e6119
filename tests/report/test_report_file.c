/* The file of a report is whole or absent; an older one stays intact, and links and pipes work. */
#include "src/io/growable.h"
#include "src/io/output_file.h"
#include "src/tool/report/template.h"
#include "tests/support/io_allocations.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/report/report_rig.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static report_rig rig;

static int set_up(void **state) {
    (void)state;
    folder = temp_folder_make();
    rig = report_rig_create(recorded_tetrahedra(4), CSCD_METHOD_CHARGE);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    report_rig_destroy(&rig);
    temp_folder_remove(&folder);
    return 0;
}

static size_t files_in_folder(void) {
    size_t count = 0;
    DIR *entries = opendir(folder.path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries))
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(entries);
    return count;
}

static void write_report(const char *path) {
    io_error error = {""};
    if (!report_rig_write(&rig, path, &error)) fail_msg("%s", error.text);
}

static void expect_failure(const char *path, const char *cause) {
    io_error error = {""};
    size_t before = files_in_folder();
    if (report_rig_write(&rig, path, &error)) fail_msg("%s was written", path);
    assert_memory_equal(error.text, path, strlen(path));
    if (strstr(error.text, cause) == NULL) fail_msg("no '%s' in '%s'", cause, error.text);
    assert_null(strpbrk(error.text, "\r\n"));
    assert_int_equal(files_in_folder(), before);
}

static void expect_content(const char *path, const char *content) {
    size_t size;
    char *text = read_whole_file(path, &size);
    assert_string_equal(text, content);
    free(text);
}

static mode_t mode_of(const char *path) {
    struct stat status;
    assert_int_equal(lstat(path, &status), 0);
    return status.st_mode;
}

static void expect_page(const char *path) {
    page p = page_read(path);
    page_free(&p);
}

TEST(what_cannot_be_opened_is_told) {
    expect_failure(temp_file_path(&folder, "no/such.html").text, "cannot write: No such file");
    expect_failure(folder.path, "cannot write: Is a directory");
    temp_path loop = temp_file_path(&folder, "loop.html");
    assert_int_equal(symlink(loop.text, loop.text), 0);
    expect_failure(loop.text, "cannot write: Too many levels");
    remove(loop.text);
}

static rlim_t size_of_report(void) {
    temp_path path = temp_file_path(&folder, "size.html");
    struct stat status;
    write_report(path.text);
    assert_int_equal(stat(path.text, &status), 0);
    remove(path.text);
    return (rlim_t)status.st_size;
}

/* A full disk is simulated by a device that is always full and by a limit on the size of files. */
TEST(a_full_disk_leaves_the_older_file) {
    expect_failure("/dev/full", "cannot write: No space left");
    temp_path old = temp_file_write(&folder, "old.html", "older", 5);
    temp_path fresh = temp_file_path(&folder, "new.html");
    rlim_t size = size_of_report();
    const rlim_t limits[] = {0, 1, size / 2, size - 1};
    struct rlimit usual;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    signal(SIGXFSZ, SIG_IGN);
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        const struct rlimit small = {limits[i], usual.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        expect_failure(old.text, "cannot write: File too large");
        expect_failure(fresh.text, "cannot write: File too large");
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    }
    signal(SIGXFSZ, SIG_DFL);
    expect_content(old.text, "older");
    remove(old.text);
}

TEST(permissions_are_as_ever) {
    temp_path path = temp_file_path(&folder, "report.html");
    mode_t mask = umask(027);
    write_report(path.text);
    assert_int_equal(mode_of(path.text) & 07777, 0640);
    assert_int_equal(chmod(path.text, 0604), 0);
    write_report(path.text);
    assert_int_equal(mode_of(path.text) & 07777, 0604);
    umask(mask);
    expect_page(path.text);
    assert_int_equal(files_in_folder(), 1);
    remove(path.text);
}

/* Links are relative and absolute, to a file and to none. The link stays, and its target is the report. */
TEST(links_are_followed) {
    temp_path link = temp_file_path(&folder, "link.html"), target = temp_file_path(&folder, "target.html");
    for (int i = 0; i < 4; i++) {
        assert_int_equal(symlink(i % 2 == 0 ? "target.html" : target.text, link.text), 0);
        if (i >= 2) temp_file_write(&folder, "target.html", "older", 5);
        write_report(link.text);
        assert_true(S_ISLNK(mode_of(link.text)) && S_ISREG(mode_of(target.text)));
        expect_page(target.text);
        assert_int_equal(files_in_folder(), 2);
        remove(link.text);
        remove(target.text);
    }
}

/* A name as long as the system allows leaves no room for a longer name beside it. */
TEST(long_names_are_fine) {
    char name[256];
    memset(name, 'n', 255);
    memcpy(name + 250, ".html", 6);
    temp_path path = temp_file_path(&folder, name);
    write_report(path.text);
    expect_page(path.text);
    assert_int_equal(files_in_folder(), 1);
    remove(path.text);
}

static void *copy_pipe(void *paths) {
    const temp_path *pipe_and_copy = paths;
    FILE *in = fopen(pipe_and_copy[0].text, "rb"), *out = fopen(pipe_and_copy[1].text, "wb");
    for (int c = getc(in); c != EOF; c = getc(in)) putc(c, out);
    fclose(in);
    fclose(out);
    return NULL;
}

TEST(a_pipe_is_written_to) {
    temp_path paths[] = {temp_file_path(&folder, "pipe"), temp_file_path(&folder, "copy.html")};
    pthread_t reader;
    assert_int_equal(mkfifo(paths[0].text, 0600), 0);
    assert_int_equal(pthread_create(&reader, NULL, copy_pipe, paths), 0);
    write_report(paths[0].text);
    pthread_join(reader, NULL);
    assert_true(S_ISFIFO(mode_of(paths[0].text)));
    expect_page(paths[1].text);
    for (int i = 0; i < 2; i++) remove(paths[i].text);
}

TEST(memory_that_runs_out_leaves_nothing) {
    temp_path path = temp_file_path(&folder, "report.html");
    int failures = 0;
    for (bool written; io_allocations_go_on(failures); failures++) {
        io_error error = {""};
        written = report_rig_write(&rig, path.text, &error);
        io_allocations_left = -1;
        if (!written) {
            assert_non_null(strstr(error.text, "out of memory"));
            assert_int_equal(files_in_folder(), 0);
        }
    }
    assert_true(failures > 50);
    expect_page(path.text);
    remove(path.text);
}

static void expect_divided(const char *text, const char *complaint) {
    report_template parts;
    io_error error = {""};
    bool divided = report_template_divide(text, strlen(text), &parts, &error);
    assert_int_equal(divided, complaint == NULL);
    if (!divided) assert_non_null(strstr(error.text, complaint));
}

TEST(a_template_has_one_place_for_data) {
    expect_divided("<html>\n<!--cscd:data-->\n</html>\n", NULL);
    expect_divided("", "lacks the line <!--cscd:data-->");
    expect_divided("<html>\n</html>\n", "lacks the line <!--cscd:data-->; run make template");
    expect_divided("<html>\n <!--cscd:data-->\n</html>\n", "lacks the line");
    expect_divided("<html>\n<!--cscd:data-->\n<!--cscd:data-->\n</html>\n", "twice");
}

AROUND_ALL(set_up, tear_down)
