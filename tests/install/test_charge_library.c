/* The shared library opens libcscd-charge.so when charge is solved for by a dense matrix: beside itself, or where the system looks; and
 * so does the tool, beside itself or in its prefix. Without it, or with a wrong one, that call fails with a sentence and
 * everything else works, also where OpenBLAS would hang. */
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

/* Dense solutions fail with a sentence that has these words; all else is as it was. */
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

/* As distributions lay it out; the library has its own name there, and is loaded by a link. */
static void is_looked_for_in_a_folder_of_its_own(void **state) {
    (void)state;
    shell("mkdir '%s/lib/cscd' && cp '%s/%s' '%s/lib/cscd'", folder.path, build, charge_name, folder.path);
    expect_charge("");
    shell("rm -r '%s/lib/cscd'", folder.path);
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

/* GSL, which libcscd.so needs, has its own cblas_sgemm, which would be found first. */
static void takes_no_blas_of_others(void **state) {
    (void)state;
    char *names =
        shell_output(0, "nm -D --undefined-only '%s/%s' | grep -c cblas_ || true", build, charge_name);
    assert_string_equal(names, "0\n");
    free(names);
}

/* A plan fails with a sentence where OpenBLAS would hang as it is loaded, which each of its threads makes likelier, or
 * where it would hang as it computes. */
static void a_host_needs_little_memory(void **state) {
    static const char *const sentences[] = {"takes 60 MiB of address space", "takes 340 MiB of address space",
                                            "128 MiB of address space for buffers"};
    static const int mebibytes[] = {50, 320, 150}, threads[] = {1, 3, 1};
    (void)state;
    shell("cp '%s/%s' '%s/lib'", build, charge_name, folder.path);
    for (int i = 0; i < 3; i++) {
        char *printed = shell_output(0, "ulimit -v %d; OPENBLAS_NUM_THREADS=%d timeout 20 '%s/opens'",
                                     mebibytes[i] * 1024, threads[i], folder.path);
        if (strstr(printed, sentences[i]) == NULL) fail_msg("%d MiB: %s", mebibytes[i], printed);
        assert_non_null(strstr(printed, "from parts"));
        free(printed);
    }
    shell("rm '%s/lib/%s'", folder.path, charge_name);
}

/* ---- the tool --------------------------------------------------------------------------------------- */

/* Writes the model, and a prefix with the tool alone. */
static void lay_out_prefix(const char *libraries) {
    shell("mkdir -p '%s/prefix/bin' '%s/prefix/%s' && cp '%s/cscd' '%s/prefix/bin'", folder.path, folder.path,
          libraries, build, folder.path);
    shell(
        "printf 'v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 0 0 1\\nf 1 3 2\\nf 1 2 4\\nf 2 3 4\\nf 1 4 3\\n' >'%s/model.obj'",
        folder.path);
}

/* Runs the tool, as the shell finds it by `call`, in the prefix' folder of programs; returns what it says. */
static char *make_plan_by(const char *call, int status) {
    return shell_output(
        status,
        "cd '%s/prefix/bin' && PATH=.:$PATH %s preprocess ../../model.obj -o ../../plan.ply --charge "
        "dense 2>&1",
        folder.path, call);
}

static void expect_plan_by(const char *call) {
    char *said = make_plan_by(call, 0);
    if (strncmp(said, "written: ", 9) != 0 && strstr(said, "\nwritten: ") == NULL)
        fail_msg("%s: %s", call, said);
    free(said);
}

/* By its path, by its name alone, by a link from another folder, and under another name than its own. */
static void the_tool_looks_in_its_prefix(void **state) {
    char *machine = shell_output(0, "echo lib/$(${CC:-cc} -print-multiarch)");
    machine[strcspn(machine, "\n")] = '\0'; /* lib/ where the system has no such folders */
    const char *libraries[] = {"bin", "lib", "lib64", machine};
    (void)state;
    for (int i = 0; i < 4; i++) {
        lay_out_prefix(libraries[i]);
        char *said = make_plan_by("cscd", 1);
        assert_non_null(strstr(said, charge_name));
        free(said);
        shell("cp '%s/%s' '%s/prefix/%s'", build, charge_name, folder.path, libraries[i]);
        shell("ln -sfn prefix/bin/cscd '%s/link'", folder.path);
        expect_plan_by("./cscd");
        expect_plan_by("cscd");
        expect_plan_by("../../link");
        expect_plan_by("bash -c 'exec -a other ./cscd \"$@\"' -");
        shell("rm -rf '%s/prefix'", folder.path);
    }
    free(machine);
}

/* OpenBLAS hangs in so little memory when it is loaded, and when a thread computes in it. */
static void the_tool_needs_little_memory(void **state) {
    (void)state;
    lay_out_prefix("lib");
    shell("cp '%s/%s' '%s/prefix/lib'", build, charge_name, folder.path);
    for (int mebibytes = 60; mebibytes <= 140; mebibytes += 40) {
        shell("ulimit -v %d; timeout 20 '%s/prefix/bin/cscd' info '%s/model.obj' >'%s/printed'",
              mebibytes * 1024, folder.path, folder.path, folder.path);
        char *said =
            shell_output(1,
                         "ulimit -v %d; timeout 20 '%s/prefix/bin/cscd' preprocess '%s/model.obj' -o "
                         "'%s/plan.ply' --charge dense 2>&1",
                         mebibytes * 1024, folder.path, folder.path, folder.path);
        assert_non_null(strstr(said, "MiB of address space"));
        free(said);
    }
    shell("rm -rf '%s/prefix'", folder.path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_looked_for_beside_the_library),
        cmocka_unit_test(is_looked_for_in_a_folder_of_its_own),
        cmocka_unit_test(is_looked_for_where_the_system_looks),
        cmocka_unit_test(is_missing),
        cmocka_unit_test(is_damaged),
        cmocka_unit_test(is_of_another_version),
        cmocka_unit_test(is_opened_when_it_is_needed),
        cmocka_unit_test(takes_no_blas_of_others),
        cmocka_unit_test(a_host_needs_little_memory),
        cmocka_unit_test(the_tool_looks_in_its_prefix),
        cmocka_unit_test(the_tool_needs_little_memory),
    };
    return cmocka_run_group_tests_name("charge_library", tests, build_clients, remove_all);
}
