/* Callers and libraries of different versions: a caller that was compiled with the headers of a later version, in which
 * every struct that may grow has one more member, runs on this library; and today's caller on a library of those headers.
 * Nothing is written behind the caller's structs, and members that only the caller knows are 0. */
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static char build[4096]; /* the folder of today's library */

static int make_headers(void **state) {
    (void)state;
    const char *tool = getenv("CSCD_TOOL");
    if (tool == NULL) fail_msg("CSCD_TOOL must name the built tool; run the tests through tests/run.sh");
    snprintf(build, sizeof build, "%s", tool);
    *strrchr(build, '/') = '\0';
    folder = temp_folder_make();
    shell("tests/install/api_headers.py later '%s/later/include'", folder.path);
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    if (folder.path[0] != '\0') shell("rm -rf '%s'", folder.path);
    return 0;
}

/* Compiles the caller with the headers in `include`, runs it on the library in `library`, and returns what it prints: the
 * structs that it has asked for. */
static char *run_caller(const char *include, const char *library, const char *flags) {
    shell("gcc -std=c11 -Wall -Wextra -Wno-missing-field-initializers -Werror %s -I'%s' -I. -o '%s/caller' "
          "tests/install/versions/caller.c -L'%s' -lcscd -Wl,-rpath,'%s'",
          flags, include, folder.path, library, library);
    return shell_output(0, "'%s/caller' | LC_ALL=C sort -u", folder.path);
}

/* Every struct that may grow must have been asked for; a new one is added to the caller. */
static void expect_all_structs(char *found) {
    char *expected = shell_output(0, "tests/install/api_headers.py grows");
    if (strcmp(found, expected) != 0)
        fail_msg(
            "tests/install/versions/caller.c has asked for or failed at\n%s\nexpected all that may grow:\n%s",
            found, expected);
    free(expected);
    free(found);
}

static void todays_caller_on_todays_library(void **state) {
    (void)state;
    expect_all_structs(run_caller("include", build, ""));
}

static void later_caller_on_todays_library(void **state) {
    char include[512];
    (void)state;
    snprintf(include, sizeof include, "%s/later/include", folder.path);
    expect_all_structs(run_caller(include, build, "-DWITH_LATER"));
}

/* A copy of the sources beside the later headers. What asserts that new members are looked after is left out, because
 * nobody has; and so are vectors and what the caller does not ask for, which compiles quicker. */
static void todays_caller_on_later_library(void **state) {
    char library[512];
    (void)state;
    snprintf(library, sizeof library, "%s/later/build/debug-without-gsl-without-charge", folder.path);
    shell(
        "for name in src preprocess runtime Makefile; do ln -s \"$PWD/$name\" '%s/later/'; done; "
        "cache=$(command -v ccache || true); env -u MAKEFLAGS -u MAKELEVEL -u MAKEOVERRIDES -u CC make -s -j2 -C '%s/later' "
        "library CC=\"$cache gcc\" CONFIG=debug GSL=0 CHARGE=0 OPTIMISE_debug='-O0 -DNDEBUG' LEVELS=scalar "
        "CORE_DEFINITIONS= WARNINGS=-w CFLAGS=\"'-D_Static_assert(holds,text)='\"",
        folder.path, folder.path);
    expect_all_structs(run_caller("include", library, ""));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(todays_caller_on_todays_library),
                                       cmocka_unit_test(later_caller_on_todays_library),
                                       cmocka_unit_test(todays_caller_on_later_library)};
    return cmocka_run_group_tests(tests, make_headers, remove_all);
}
