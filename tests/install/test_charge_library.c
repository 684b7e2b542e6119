/* The shared library opens libcscd-charge.so when a plan by charge is made: beside itself, or where the system looks.
 * Without it, or with a wrong one, that call fails with a sentence and everything else works. */
#include "cscd/cscd.h"
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_folder folder;
static char build[4096], charge_name[64];
static char *linked; /* what the program prints that has the charge library inside */

/* Both clients, and a folder for the library alone. */
static int build_clients(void **state) {
    (void)state;
    const char *tool = getenv("CSCD_TOOL");
    if (tool == NULL) fail_msg("CSCD_TOOL must name the built tool; run the tests through tests/run.sh");
    snprintf(build, sizeof build, "%.*s", (int)(strrchr(tool, '/') - tool), tool);
    snprintf(charge_name, sizeof charge_name, "libcscd-charge.so.%d", CSCD_VERSION_MAJOR);
    folder = temp_folder_make();
    shell("mkdir '%s/lib' '%s/elsewhere' && cp '%s/libcscd.so.%d' '%s/lib'", folder.path, folder.path, build,
          CSCD_VERSION_MAJOR, folder.path);
    const char *compile = "${CC:-cc} -std=c99 -Wall -Wextra -Werror -Iinclude tests/install/charge_client.c";
    /* This way to its own libraries does not count when a library opens another one. */
    shell("%s '%s/lib/libcscd.so.%d' -Wl,--enable-new-dtags,-rpath,'%s/lib' -o '%s/opens'", compile,
          folder.path, CSCD_VERSION_MAJOR, folder.path, folder.path);
    shell("%s '%s/libcscd.a' -lgsl -llapacke -lopenblas -lm -pthread -o '%s/linked'", compile, build,
          folder.path);
    linked = shell_output(0, "'%s/linked'", folder.path);
    assert_non_null(strstr(linked, "solved: charge 0x1."));
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    free(linked);
    if (folder.path[0] != '\0') shell("rm -rf '%s'", folder.path);
    return 0;
}

static char *run_opening(const char *library_folders) {
    return shell_output(0, "LD_LIBRARY_PATH='%s' '%s/opens'", library_folders, folder.path);
}

/* Plans by charge fail with a sentence that has these words; all else is as it was. */
static void expect_sentence(const char *words) {
    char *printed = run_opening("");
    const char *others = strstr(linked, "from parts"), *found = strstr(printed, "from parts");
    if (strncmp(printed, "solved: the system refused", 26) != 0 || strstr(printed, words) == NULL)
        fail_msg("%sdoes not say \"%s\"", printed, words);
    assert_true(strstr(printed, charge_name) != NULL && found != NULL);
    assert_string_equal(found, others);
    free(printed);
}

static void expect_charge(const char *library_folders) {
    char *printed = run_opening(library_folders);
    assert_string_equal(printed, linked);
    free(printed);
}

static void is_looked_for_beside_the_library(void **state) {
    (void)state;
    shell("cp '%s/%s' '%s/lib'", build, charge_name, folder.path);
    expect_charge("");
    shell("rm '%s/lib/%s'", folder.path, charge_name);
}

static void is_looked_for_where_the_system_looks(void **state) {
    char elsewhere[512];
    (void)state;
    shell("cp '%s/%s' '%s/elsewhere'", build, charge_name, folder.path);
    snprintf(elsewhere, sizeof elsewhere, "%s/elsewhere", folder.path);
    expect_charge(elsewhere);
}

static void is_missing(void **state) {
    (void)state;
    expect_sentence("a build with CHARGE=1 makes it");
}

static void is_damaged(void **state) {
    (void)state;
    shell("echo text >'%s/lib/%s'", folder.path, charge_name);
    expect_sentence("/lib/libcscd-charge.so");
    shell("rm '%s/lib/%s'", folder.path, charge_name);
}

/* Another interface, or a library that is none. */
static void is_of_another_version(void **state) {
    (void)state;
    static const char *const texts[] = {
        "const void *cscd_charge_functions(unsigned i) {return i == 1000 ? \"\" : 0;}", "int unrelated;"};
    for (int i = 0; i < 2; i++) {
        shell("echo '%s' | ${CC:-cc} -xc -shared -fPIC - -o '%s/lib/%s'", texts[i], folder.path, charge_name);
        expect_sentence("are of different versions");
        shell("rm '%s/lib/%s'", folder.path, charge_name);
    }
}

/* A program that makes no plan by charge loads no linear algebra. */
static void is_opened_when_it_is_needed(void **state) {
    (void)state;
    shell("cp '%s/%s' '%s/lib'", build, charge_name, folder.path);
    char *needed =
        shell_output(0, "LD_LIBRARY_PATH='%s/lib' ldd '%s/opens' | grep -cE 'lapack|openblas' || true",
                     folder.path, folder.path);
    assert_string_equal(needed, "0\n");
    free(needed);
    shell("rm '%s/lib/%s'", folder.path, charge_name);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_looked_for_beside_the_library),
        cmocka_unit_test(is_looked_for_where_the_system_looks),
        cmocka_unit_test(is_missing),
        cmocka_unit_test(is_damaged),
        cmocka_unit_test(is_of_another_version),
        cmocka_unit_test(is_opened_when_it_is_needed),
    };
    return cmocka_run_group_tests_name("charge_library", tests, build_clients, remove_all);
}
