/* Projects that build the library by CMake's add_subdirectory, static and shared, and that find what such a build
 * installed. Objects are compiled without optimisation, which is quicker. */
#include "cscd/cscd.h"
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;

static int make_folder(void **state) {
    (void)state;
    folder = temp_folder_make();
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    if (folder.path[0] != '\0') shell("rm -rf '%s'", folder.path);
    return 0;
}

/* Configures and builds the project in the folder `name`, and runs its program. */
static void build_project(const char *name, const char *options) {
    char expected[256];
    /* A compiler cache, where there is one, spares most of the second build. */
    shell("cache=$(command -v ccache || true); cd tests/install/embedding && unset MAKEFLAGS MAKELEVEL && "
          "cmake -S . -B '%s/%s' -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O0 "
          "-DCMAKE_C_COMPILER_LAUNCHER=\"$cache\" %s && cmake --build '%s/%s' -j2",
          folder.path, name, options, folder.path, name);
    char *printed = shell_output(0, "'%s/%s/client'", folder.path, name);
    snprintf(expected, sizeof expected, "cscd %s\nvf 4 0 at t = 0.667\n", cscd_version_string());
    assert_string_equal(printed, expected);
    free(printed);
}

static void expect_lines(const char *what, char *found, const char *expected) {
    if (strcmp(found, expected) != 0) fail_msg("%s: found\n%s\nexpected\n%s", what, found, expected);
    free(found);
}

/* Only public names leave the static library, and the flags of the project do not reach it. */
static void static_library(void **state) {
    (void)state;
    build_project("static", "-DCSCD_SOURCES=\"$(cd ../../.. && pwd)\" -DCSCD_INSTALL=ON");
    expect_lines("foreign names",
                 shell_output(0,
                              "nm -g --defined-only '%s/static/cscd/libcscd.a' | grep -E ' [A-Z] ' | "
                              "grep -v ' T cscd_' || true",
                              folder.path),
                 "");
}

/* The library that charge needs is beside it, and it needs the C library alone without GSL. */
static void shared_library(void **state) {
    (void)state;
    build_project("shared", "-DCSCD_SOURCES=\"$(cd ../../.. && pwd)\" -DBUILD_SHARED_LIBS=ON -DCSCD_GSL=OFF");
    expect_lines("needed",
                 shell_output(0,
                              "readelf -d '%s/shared/cscd/libcscd.so' | "
                              "sed -n 's/.*NEEDED.*\\[\\(lib[a-z]*\\)\\.so.*/\\1/p' | sort",
                              folder.path),
                 "libc\nlibm\n");
}

/* After static_library. */
static void installed_library(void **state) {
    char options[512];
    (void)state;
    shell("cmake --install '%s/static' --prefix '%s/prefix'", folder.path, folder.path);
    snprintf(options, sizeof options, "-DCMAKE_PREFIX_PATH='%s/prefix'", folder.path);
    build_project("installed", options);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(static_library), cmocka_unit_test(shared_library),
                                       cmocka_unit_test(installed_library)};
    return cmocka_run_group_tests_name("embedding", tests, make_folder, remove_all);
}
