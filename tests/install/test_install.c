/* Tests make install, programs that use the installed files (pkg-config, CMake, moved trees), and make
 * uninstall. */
#include "cscd/cscd.h"
#include "tests/support/install/api_names.h"
#include "tests/support/install/built_tree.h"
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static built_tree build;
static temp_folder folder;
static char prefix[512]; /* DESTDIR and PREFIX: the folder of the files */

static void run_make(const char *target, const char *place, const char *variables) {
    built_tree_make(&build, target, place, variables);
}

static void expect_output(const char *what, char *found, const char *expected) {
    if (strcmp(found, expected) != 0) fail_msg("%s: found\n%s\nexpected\n%s", what, found, expected);
    free(found);
}

static int install_release(void **state) {
    (void)state;
    if (!built_tree_find(&build)) return -1;
    folder = temp_folder_make();
    snprintf(prefix, sizeof prefix, "%s/stage/opt/cscd", folder.path);
    char place[512];
    snprintf(place, sizeof place, "%s/stage", folder.path);
    run_make("install", place, "PREFIX=/opt/cscd");
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    if (folder.path[0] != '\0') shell("rm -rf '%s'", folder.path);
    return 0;
}

/* Returns the output that both clients must print, whichever library they use. */
static const char *clients_output(void) {
    static char text[256];
    snprintf(text, sizeof text, "cscd %s\nvf 4 0 at t = 0.667\n", cscd_version_string());
    return text;
}

static void files_are_where_they_belong(void **state) {
    (void)state;
    char expected[4096];
    const char *version = cscd_version_string();
    char *headers = shell_output(0, "LC_ALL=C ls include/cscd/*.h include/cscd/*.hpp | LC_ALL=C sort");
    snprintf(expected, sizeof expected,
             "bin/cscd\n%slib/cmake/cscd/cscdConfig.cmake\nlib/cmake/cscd/cscdConfigVersion.cmake\n"
             "lib/libcscd-charge.so.%d\nlib/libcscd-charge.so.%s\n"
             "lib/libcscd.a\nlib/libcscd.so\nlib/libcscd.so.%d\nlib/libcscd.so.%s\n"
             "lib/pkgconfig/cscd.pc\nshare/man/man1/cscd.1\nshare/man/man3/cscd.3\n",
             headers, CSCD_VERSION_MAJOR, version, CSCD_VERSION_MAJOR, version);
    free(headers);
    expect_output("installed files",
                  shell_output(0, "cd '%s' && find . ! -type d -printf '%%P\\n' | LC_ALL=C sort", prefix),
                  expected);
    shell("cmp '%s/bin/cscd' '%s/%s%s/cscd'", prefix, build.root, build.config,
          build.gsl ? "" : "-without-gsl");
    expect_output("places that no value was filled in",
                  shell_output(1, "grep -rn '@[A-Z_]*@' '%s/lib/pkgconfig' '%s/lib/cmake' '%s/share'", prefix,
                               prefix, prefix),
                  "");
}

/* Without the tool and its page; and nothing of it asks a package manager. */
/* What Debian's packages and the builds in other ways are asked, too. */
static void the_tool_answers(void **state) {
    (void)state;
    char *expected = shell_output(0, "cat tests/builds/crossing.txt");
    expect_output(
        "cscd check",
        shell_output(0, "LD_LIBRARY_PATH='%s/lib' '%s/bin/cscd' check tests/builds/crossing.obj | head -1",
                     prefix, prefix),
        expected);
    free(expected);
}

static void library_alone(void **state) {
    (void)state;
    char place[512];
    snprintf(place, sizeof place, "%s/library", folder.path);
    run_make("install-library", place, "PREFIX=/opt/cscd");
    expect_output(
        "files that the library lacks",
        shell_output(
            0,
            "cd '%s/opt/cscd' && find . ! -type d -printf '%%P\n' | LC_ALL=C sort >'%s/library.txt'; "
            "cd '%s' && find . ! -type d -printf '%%P\n' | LC_ALL=C sort | diff - '%s/library.txt' | grep '^[<>]'",
            place, folder.path, prefix, folder.path),
        "< bin/cscd\n< share/man/man1/cscd.1\n");
    run_make("uninstall", place, "PREFIX=/opt/cscd");
    expect_output("what is left", shell_output(0, "ls -d '%s' 2>/dev/null || true", place), "");
    expect_output("packages",
                  shell_output(1, "env -u MAKEFLAGS make -n library install-library | grep -n packages"), "");
}

/* On a machine without any library, where a compiler finds no header: make says what to type, and types nothing. */
static void plain_make_installs_no_package(void **state) {
    (void)state;
    shell("mkdir '%s/bare' && cd '%s/bare' && printf '#!/bin/sh\nexit 1\n' >cc && "
          "printf '#!/bin/sh\ntouch %s/asked\n' >apt-get && cp apt-get sudo && chmod +x cc apt-get sudo",
          folder.path, folder.path, folder.path);
    char *said = shell_output(2, "env -u MAKEFLAGS PATH=\"%s/bare:$PATH\" make -s all BUILD_ROOT='%s/none'",
                              folder.path, folder.path);
    assert_non_null(strstr(said, "apt-get install -y"));
    assert_non_null(strstr(said, "libopenblas-dev"));
    assert_null(strstr(said, "libcmocka-dev"));
    free(said);
    shell("test ! -e '%s/asked' && test ! -e '%s/none'", folder.path, folder.path);
}

static void shared_library_exports_the_api(void **state) {
    (void)state;
    char soname[32];
    snprintf(soname, sizeof soname, "libcscd.so.%d\n", CSCD_VERSION_MAJOR);
    expect_output(
        "soname",
        shell_output(0, "readelf -d '%s/lib/libcscd.so' | sed -n 's/.*SONAME.*\\[\\(.*\\)\\]/\\1/p'", prefix),
        soname);
    char *declared = api_symbols("*.h");
    expect_output(
        "declared (<) and exported (>)",
        shell_output(
            0,
            "nm -D --defined-only '%s/lib/libcscd.so' | sed -n 's/.* T \\(.*\\)@@CSCD_%d\\.[0-9]*$/\\1/p' | "
            "LC_ALL=C sort >'%s/exported' && echo '%s' | grep . | diff - '%s/exported' | "
            "grep '^[<>]' || true",
            prefix, CSCD_VERSION_MAJOR, folder.path, declared, folder.path),
        "");
    free(declared);
    expect_output(
        "anything else exported",
        shell_output(0, "nm -D --defined-only '%s/lib/libcscd.so' | grep -vE ' T cscd_| A CSCD_' || true",
                     prefix),
        "");
}

/* Compiles tests/install/client.c with the flags of pkg-config, changed by a filter; returns its output. */
static char *c_client(const char *pkg_config_options, const char *filter) {
    shell("set -e; export PKG_CONFIG_PATH='%s/lib/pkgconfig'; "
          "flags=$(pkg-config --cflags --libs %s cscd | %s); "
          "${CC:-cc} -std=c99 -Wall -Wextra -Wpedantic -Werror tests/install/client.c $flags -o '%s/client'",
          prefix, pkg_config_options, filter, folder.path);
    return shell_output(0, "LD_LIBRARY_PATH='%s/lib' '%s/client'", prefix, folder.path);
}

static void c_program_by_pkg_config(void **state) {
    (void)state;
    char version[32];
    snprintf(version, sizeof version, "%s\n", cscd_version_string());
    expect_output("version of cscd.pc",
                  shell_output(0, "PKG_CONFIG_PATH='%s/lib/pkgconfig' pkg-config --modversion cscd", prefix),
                  version);
    expect_output("shared", c_client("", "cat"), clients_output());
    shell("readelf -d '%s/client' | grep -q 'NEEDED.*libcscd.so.%d\\]'", folder.path, CSCD_VERSION_MAJOR);
    expect_output("static", c_client("--static", "sed 's/-lcscd/-l:libcscd.a/'"), clients_output());
    expect_output("libraries of the static client",
                  shell_output(0, "readelf -d '%s/client' | grep -c 'NEEDED.*libcscd' || true", folder.path),
                  "0\n");
    expect_output(
        "GSL beside the static client",
        shell_output(0, "readelf -d '%s/client' | grep -c 'NEEDED.*libgsl\\.' || true", folder.path),
        build.gsl ? "1\n" : "0\n");
}

/* The page cscd(3) ends with a program, between .nf and .fi; it is compiled as C99. */
static void example_of_the_manual(void **state) {
    (void)state;
    shell("set -e; export PKG_CONFIG_PATH='%s/lib/pkgconfig'; "
          "sed -n '/^\\.SH EXAMPLES/,/^\\.fi/p' '%s/share/man/man3/cscd.3' | sed -n '/^#include/,/^}/p' | "
          "sed -e 's/\\\\e/\\\\/g' -e 's/\\\\-/-/g' -e \"s/\\\\\\\\(aq/'/g\" > '%s/example.c'; "
          "${CC:-cc} -std=c99 -Wall -Wextra -Wpedantic -Werror '%s/example.c' "
          "$(pkg-config --cflags --libs cscd) -o '%s/example'",
          prefix, prefix, folder.path, folder.path, folder.path);
    char *printed = shell_output(0, "LD_LIBRARY_PATH='%s/lib' '%s/example'", prefix, folder.path);
    assert_non_null(strstr(printed, "vf 4 0 at t = 0.66"));
    free(printed);
}

/* Configures and builds tests/install with the package in the tree `place`, and runs its two programs. */
static void cmake_project(const char *place) {
    shell("cmake -S tests/install -B '%s/project' -Dcscd_DIR='%s/lib/cmake/cscd' && "
          "cmake --build '%s/project' --clean-first",
          folder.path, place, folder.path);
    expect_output("CMake, shared", shell_output(0, "'%s/project/with-cscd'", folder.path), clients_output());
    expect_output("CMake, static", shell_output(0, "'%s/project/with-cscd-static'", folder.path),
                  clients_output());
    expect_output("libraries of the programs",
                  shell_output(0,
                               "cd '%s/project' && for program in with-cscd with-cscd-static; do "
                               "readelf -d $program | grep -c 'NEEDED.*libcscd' || true; done",
                               folder.path),
                  "1\n0\n");
}

/* A tree that was moved refers nowhere to its old place. */
static void cpp_program_by_cmake(void **state) {
    (void)state;
    cmake_project(prefix);
    char moved[512];
    snprintf(moved, sizeof moved, "%s/moved", folder.path);
    shell("mv '%s' '%s'", prefix, moved);
    cmake_project(moved);
    char *flags =
        shell_output(0, "PKG_CONFIG_PATH='%s/lib/pkgconfig' pkg-config --cflags --libs cscd", moved);
    assert_non_null(strstr(flags, moved));
    assert_null(strstr(flags, prefix));
    free(flags);
    shell("mv '%s' '%s'", moved, prefix);
}

/* Checks whether find_package accepts the installed version when `version` is asked for: the answer is ""
 * or "TRUE", and a second "TRUE" for exactly that version. */
static void expect_version(const char *version, const char *answer) {
    shell("printf 'set(PACKAGE_FIND_VERSION %%s)\\nset(PACKAGE_FIND_VERSION_MAJOR %%s)\\ninclude(\"%%s\")\\n"
          "message(\"${PACKAGE_VERSION_COMPATIBLE} ${PACKAGE_VERSION_EXACT}\")\\n' "
          "%s %d '%s/lib/cmake/cscd/cscdConfigVersion.cmake' >'%s/version.cmake'",
          version, atoi(version), prefix, folder.path);
    expect_output(version, shell_output(0, "cmake -P '%s/version.cmake'", folder.path), answer);
}

static void cmake_takes_the_same_major_version(void **state) {
    (void)state;
    char version[32];
    snprintf(version, sizeof version, "%d.9", CSCD_VERSION_MAJOR - 1);
    expect_version(version, " \n");
    snprintf(version, sizeof version, "%d", CSCD_VERSION_MAJOR);
    expect_version(version, "TRUE \n");
    expect_version(cscd_version_string(), "TRUE TRUE\n");
    snprintf(version, sizeof version, "%d.%d", CSCD_VERSION_MAJOR, CSCD_VERSION_MINOR + 1);
    expect_version(version, " \n");
    snprintf(version, sizeof version, "%d", CSCD_VERSION_MAJOR + 1);
    expect_version(version, " \n");
}

static void uninstall_leaves_nothing(void **state) {
    (void)state;
    char place[512];
    snprintf(place, sizeof place, "%s/stage", folder.path);
    run_make("uninstall", place, "PREFIX=/opt/cscd");
    expect_output("what is left", shell_output(0, "ls -d '%s' 2>/dev/null || true", place), "");
}

/* Folders may have any names. Files and empty folders that were there before stay. */
static void uninstall_leaves_what_others_made(void **state) {
    (void)state;
    char place[512];
    static const char variables[] = "PREFIX=/usr LIBDIR=/usr/lib/a-machine INCLUDEDIR=/elsewhere/include "
                                    "BINDIR=/usr/games MANDIR=/usr/man";
    snprintf(place, sizeof place, "%s/with space", folder.path);
    shell("mkdir -p '%s/usr/lib/a-machine/pkgconfig' '%s/usr/man/man1' && touch '%s/usr/man/man1/other.1'",
          place, place, place);
    run_make("install", place, variables);
    shell("test -e \"$(PKG_CONFIG_PATH='%s/usr/lib/a-machine/pkgconfig' pkg-config --variable=includedir "
          "cscd | tr -d '\\\\')/cscd/cscd.h\"",
          place);
    run_make("uninstall", place, variables);
    expect_output("what is left",
                  shell_output(0, "cd '%s' && find . -mindepth 1 -printf '%%P\\n' | LC_ALL=C sort", place),
                  "usr\nusr/lib\nusr/lib/a-machine\nusr/lib/a-machine/pkgconfig\nusr/man\nusr/man/man1\n"
                  "usr/man/man1/other.1\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_where_they_belong),
        cmocka_unit_test(the_tool_answers),
        cmocka_unit_test(library_alone),
        cmocka_unit_test(plain_make_installs_no_package),
        cmocka_unit_test(shared_library_exports_the_api),
        cmocka_unit_test(c_program_by_pkg_config),
        cmocka_unit_test(example_of_the_manual),
        cmocka_unit_test(cpp_program_by_cmake),
        cmocka_unit_test(cmake_takes_the_same_major_version),
        cmocka_unit_test(uninstall_leaves_nothing),
        cmocka_unit_test(uninstall_leaves_what_others_made),
    };
    return cmocka_run_group_tests(tests, install_release, remove_all);
}
