/* Output files: an older file stays until the new one is whole, links stay links, devices and pipes are written to. */
#include "tool/io/output_file.h"

#include "tests/support/files.h"
#include "tests/support/test.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NOBODY = 65534, LINE = 100, DISK = 250 };

static temp_folder folder;

static int make_folder(void **state) {
    (void)state;
    folder = temp_folder_make();
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    chmod(folder.path, 0700);
    temp_folder_remove(&folder);
    return 0;
}

static void expect_text(const char *path, const char *text) {
    char bytes[1000] = "";
    FILE *file = fopen(path, "rb");
    if (file == NULL) fail_msg("%s is not there", path);
    bytes[fread(bytes, 1, sizeof bytes - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(bytes, text);
}

/* Nothing but these lies in the folder. */
static void expect_files(size_t count) {
    DIR *entries = opendir(folder.path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries))
        count -= strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(entries);
    assert_int_equal(count, 0);
}

static output_file open_output(const char *path) {
    output_file out;
    if (!output_file_open(path, &out)) fail_msg("%s: %s", path, strerror(errno));
    return out;
}

static void write_output(const char *path, const char *text) {
    output_file out = open_output(path);
    fputs(text, out.file);
    assert_true(output_file_close(&out, OUTPUT_WHOLE));
}

static void expect_refused(const char *path, int cause) {
    output_file out;
    errno = 0;
    assert_false(output_file_open(path, &out));
    assert_int_equal(errno, cause);
}

/* ---- files ------------------------------------------------------------------------------------------- */

TEST(the_older_file_stays_until_the_new_one_is_whole) {
    temp_path path = temp_file_write(&folder, "out", "older", 5);
    struct stat status;
    assert_int_equal(chmod(path.text, 0640), 0);
    output_file out = open_output(path.text);
    fputs("newer", out.file);
    assert_true(output_file_flush(&out));
    expect_text(path.text, "older");
    expect_files(2);
    assert_true(output_file_close(&out, OUTPUT_WHOLE));
    expect_text(path.text, "newer");
    expect_files(1);
    assert_int_equal(stat(path.text, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0640);
}

TEST(a_new_file_has_the_usual_permissions) {
    struct stat status;
    temp_path path = temp_file_path(&folder, "out");
    const mode_t before = umask(027);
    write_output(path.text, "new");
    umask(before);
    expect_text(path.text, "new");
    assert_int_equal(stat(path.text, &status), 0);
    assert_int_equal(status.st_mode & 07777, 0640);
}

TEST(an_abandoned_file_leaves_nothing) {
    temp_path path = temp_file_write(&folder, "out", "older", 5);
    output_file out = open_output(path.text);
    fputs("newer", out.file);
    assert_false(output_file_close(&out, OUTPUT_ABANDONED));
    expect_text(path.text, "older");
    expect_files(1);
}

/* The names that this process would take first are taken already, and a name may be as long as names can be. */
TEST(names_beside_do_not_collide) {
    char taken[64], longest[256];
    memset(longest, 'x', 255);
    longest[255] = '\0';
    for (int i = 0; i < 3; i++) {
        snprintf(taken, sizeof taken, ".cscd-output-%ld-%d", (long)getpid(), i);
        temp_file_write(&folder, taken, "mine", 4);
    }
    temp_path path = temp_file_path(&folder, longest);
    write_output(path.text, "new");
    expect_text(path.text, "new");
    expect_text(temp_file_path(&folder, taken).text, "mine");
    expect_files(4);
}

TEST(a_folder_must_be_there) {
    expect_refused(temp_file_path(&folder, "none/out").text, ENOENT);
    expect_refused(folder.path, EISDIR);
    temp_path file = temp_file_write(&folder, "file", "mine", 4);
    char below[600];
    snprintf(below, sizeof below, "%s/out", file.text);
    expect_refused(below, ENOTDIR);
    expect_files(1);
}

/* ---- a full disk ------------------------------------------------------------------------------------- */

/* Writes three lines where a file has no room for all of them; flush: after each. Returns what closing says. */
static bool fill_disk(const char *path, bool flush, output_ending ending) {
    struct rlimit usual;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    const struct rlimit small = {DISK, usual.rlim_max};
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    output_file out = open_output(path);
    bool flushed = true;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < LINE - 1; k++) fputc('a' + i, out.file);
        fputc('\n', out.file);
        if (flush) flushed = output_file_flush(&out);
    }
    errno = 0;
    const bool closed = output_file_close(&out, ending);
    const int cause = errno;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    signal(SIGXFSZ, handler);
    assert_int_equal(flushed, !flush);
    if (!flush) assert_int_equal(cause, EFBIG);
    return closed;
}

TEST(a_full_disk_keeps_the_older_file) {
    temp_path path = temp_file_write(&folder, "out", "older", 5);
    assert_false(fill_disk(path.text, false, OUTPUT_WHOLE));
    assert_false(fill_disk(path.text, true, OUTPUT_WHOLE));
    assert_false(fill_disk(path.text, false, OUTPUT_WHOLE_LINES)); /* no line was known to be whole */
    expect_text(path.text, "older");
    expect_files(1);
}

TEST(a_full_disk_keeps_whole_lines) {
    temp_path path = temp_file_write(&folder, "out", "older", 5);
    char lines[2 * LINE + 1];
    assert_false(fill_disk(path.text, true, OUTPUT_WHOLE_LINES));
    memset(lines, 'a', LINE);
    memset(lines + LINE, 'b', LINE);
    lines[LINE - 1] = lines[2 * LINE - 1] = '\n';
    lines[2 * LINE] = '\0';
    expect_text(path.text, lines);
    expect_files(1);
}

TEST(a_full_device_says_so) {
    struct stat status;
    output_file out = open_output("/dev/full");
    fputs("text", out.file);
    assert_false(output_file_flush(&out));
    assert_false(output_file_close(&out, OUTPUT_WHOLE_LINES));
    out = open_output("/dev/full");
    fputs("text", out.file);
    errno = 0;
    assert_false(output_file_close(&out, OUTPUT_WHOLE));
    assert_int_equal(errno, ENOSPC);
    assert_int_equal(stat("/dev/full", &status), 0);
    assert_true(S_ISCHR(status.st_mode));
}

/* ---- links and what is no file ----------------------------------------------------------------------- */

static void expect_link(const char *path) {
    struct stat status;
    assert_int_equal(lstat(path, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
}

/* A link that names its target as seen from its own folder, and one over two links; a path without a folder. */
TEST(links_stay_and_lead_to_the_new_file) {
    char here[1000];
    temp_path file = temp_file_write(&folder, "file", "older", 5);
    temp_path link = temp_file_path(&folder, "link"), second = temp_file_path(&folder, "second");
    assert_int_equal(symlink("file", link.text), 0);
    assert_int_equal(symlink(link.text, second.text), 0);
    write_output(link.text, "one");
    expect_text(file.text, "one");
    write_output(second.text, "two");
    expect_text(file.text, "two");
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(folder.path), 0);
    write_output("second", "three");
    assert_int_equal(chdir(here), 0);
    expect_text(file.text, "three");
    expect_link(link.text);
    expect_link(second.text);
    expect_files(3);
}

TEST(a_broken_link_gets_its_file) {
    temp_path link = temp_file_path(&folder, "link"), nowhere = temp_file_path(&folder, "nowhere");
    assert_int_equal(symlink("later", link.text), 0);
    assert_int_equal(symlink("none/file", nowhere.text), 0);
    output_file out = open_output(link.text);
    fputs("new", out.file);
    assert_int_not_equal(access(link.text, F_OK), 0);
    assert_true(output_file_close(&out, OUTPUT_WHOLE));
    expect_text(temp_file_path(&folder, "later").text, "new");
    expect_link(link.text);
    expect_refused(nowhere.text, ENOENT);
    expect_files(3);
}

TEST(links_in_a_circle_are_refused) {
    temp_path one = temp_file_path(&folder, "one"), two = temp_file_path(&folder, "two");
    assert_int_equal(symlink("two", one.text), 0);
    assert_int_equal(symlink("one", two.text), 0);
    expect_refused(one.text, ELOOP);
    expect_files(2);
}

TEST(a_pipe_is_written_to) {
    char text[16] = "";
    struct stat status;
    temp_path path = temp_file_path(&folder, "pipe");
    assert_int_equal(mkfifo(path.text, 0600), 0);
    int reader = open(path.text, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    write_output(path.text, "through");
    assert_int_equal(read(reader, text, sizeof text), 7);
    assert_string_equal(text, "through");
    close(reader);
    output_file out = open_output("/dev/null");
    assert_false(output_file_close(&out, OUTPUT_ABANDONED));
    assert_int_equal(stat(path.text, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
    assert_int_equal(stat("/dev/null", &status), 0);
}

/* The path of an open file names that very file, so it is not replaced. */
TEST(an_open_file_is_written_itself) {
    char name[64];
    struct stat before, after;
    temp_path path = temp_file_write(&folder, "out", "older and longer", 16);
    int descriptor = open(path.text, O_RDWR);
    assert_int_equal(fstat(descriptor, &before), 0);
    snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    write_output(name, "newer");
    assert_int_equal(stat(path.text, &after), 0);
    assert_true(before.st_ino == after.st_ino);
    expect_text(path.text, "newer");
    close(descriptor);
}

/* ---- permissions ------------------------------------------------------------------------------------- */

/* Writes as somebody who owns nothing here, in another process; returns 0, or why not. */
static int write_as_nobody(const char *path) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        output_file out;
        if (geteuid() == 0 && setresuid(NOBODY, NOBODY, NOBODY) != 0) _exit(255);
        if (!output_file_open(path, &out)) _exit(errno);
        fputs("newer", out.file);
        _exit(output_file_close(&out, OUTPUT_WHOLE) ? 0 : errno);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/* Where no file may be made, one that may be written is written itself. */
TEST(permissions_are_those_of_the_file) {
    temp_path open_one = temp_file_write(&folder, "open", "older and longer", 16);
    temp_path closed_one = temp_file_write(&folder, "closed", "older", 5);
    assert_int_equal(chmod(open_one.text, 0666), 0);
    assert_int_equal(chmod(closed_one.text, 0444), 0);
    assert_int_equal(chmod(folder.path, 0555), 0);
    assert_int_equal(write_as_nobody(open_one.text), 0);
    assert_int_equal(write_as_nobody(closed_one.text), EACCES);
    assert_int_equal(write_as_nobody(temp_file_path(&folder, "new").text), EACCES);
    expect_text(open_one.text, "newer");
    expect_text(closed_one.text, "older");
    assert_int_equal(chmod(folder.path, 0777), 0);
    assert_int_equal(write_as_nobody(closed_one.text), EACCES);
    expect_text(closed_one.text, "older");
    expect_files(2);
}

AROUND_EACH(make_folder, remove_folder)
