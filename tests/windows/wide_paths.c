/* The paths that the functions of Windows get. Wine takes those of any length, and Windows 260 characters where the prefix is missing. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/windows/wide.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <windows.h>

/* Whether the path becomes one that begins and ends so. */
static void expect_wide(const char *path, const wchar_t *begin, const wchar_t *end) {
    wchar_t *wide = wide_path(path);
    assert_non_null(wide);
    const size_t size = wcslen(wide), end_size = wcslen(end);
    if (wcsncmp(wide, begin, wcslen(begin)) != 0 || size < end_size ||
        wcscmp(wide + size - end_size, end) != 0)
        fail_msg("%s became %ls, which should begin by %ls and end by %ls", path, wide, begin, end);
    assert_true(size < MAX_PATH - 12 || wcsncmp(wide, L"\\\\?\\", 4) == 0);
    free(wide);
}

/* Fills up to `length` bytes with folders of 100. */
static void add_folders(char *path, size_t length) {
    for (size_t at = strlen(path), i = 0; at < length; at++, i++)
        snprintf(path + at, 2, "%s", i % 100 == 0 ? "/" : "x");
}

static void short_paths_keep_their_form(void **state) {
    (void)state;
    expect_wide("C:/short/path.obj", L"C:\\short\\path.obj", L"path.obj");
    expect_wide("C:\\short/path.obj", L"C:\\short\\path.obj", L"path.obj");
    expect_wide("//server/share/path.obj", L"\\\\server\\share\\", L"path.obj");
    expect_wide("\\\\?\\C:\\short.obj", L"\\\\?\\C:\\short.obj", L"short.obj");
    expect_wide("/dev/null", L"NUL", L"NUL");
    expect_wide("C:/K\u00f6rper \U0001f9ca.obj", L"C:\\K\u00f6rper \U0001f9ca.obj", L".obj");
}

static void long_paths_get_the_prefix(void **state) {
    (void)state;
    char drive[1000] = "C:", share[1000] = "//server/share", dots[1000] = "C:";
    add_folders(drive, 400);
    add_folders(share, 400);
    add_folders(dots, 400);
    strcat(drive, "/end.obj");
    strcat(share, "\\end.obj");
    strcat(dots, "/../other/./end.obj");
    expect_wide(drive, L"\\\\?\\C:\\xxx", L"x\\end.obj");
    expect_wide(share, L"\\\\?\\UNC\\server\\share\\xxx", L"x\\end.obj");
    expect_wide(dots, L"\\\\?\\C:\\xxx", L"x\\other\\end.obj");
}

/* What counts is how long the whole path is. */
static void long_folders_lengthen_short_names(void **state) {
    (void)state;
    char before[1024], name[300];
    assert_non_null(getcwd(before, sizeof before));
    const temp_folder folder = temp_folder_make();
    assert_int_equal(chdir(folder.path), 0);
    memset(name, 'n', sizeof name);
    name[MAX_PATH - 14 - strlen(folder.path)] = '\0';
    expect_wide("short.obj", L"Z:\\", L"\\short.obj");
    expect_wide(name, L"\\\\?\\Z:\\", L"n");
    assert_int_equal(chdir(before), 0);
    temp_folder_remove(&folder);
}

static void other_text_is_refused(void **state) {
    (void)state;
    errno = 0;
    assert_null(wide_path(""));
    assert_int_equal(errno, ENOENT);
    assert_null(wide_path("K\xf6rper.obj"));
    assert_int_equal(errno, EILSEQ);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_paths_keep_their_form),
        cmocka_unit_test(long_paths_get_the_prefix),
        cmocka_unit_test(long_folders_lengthen_short_names),
        cmocka_unit_test(other_text_is_refused),
    };
    return cmocka_run_group_tests_name("wide_paths", tests, NULL, NULL);
}
