/* `cscd merge`: shards together give what one run gives, and whatever is missing, there twice or foreign is named. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { JOBS = 40, SHARDS_MAX = 7 };

static temp_folder folder;
static temp_path list, whole, merged, shards[SHARDS_MAX];

/* Jobs of several sizes and kinds, a few without a size; none fails. */
static void write_list(const temp_path *models, size_t model_count) {
    char text[JOBS * 400];
    size_t used = 0;
    for (int i = 0; i < JOBS; i++) {
        char size[40] = "";
        if (i % 3 != 0) snprintf(size, sizeof size, ", \"size\": %d", (i * 37) % 50);
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "{\"model\": \"%s\", \"name\": \"job %d\"%s}\n",
                             models[(size_t)i % model_count].text, i + 1, size);
    }
    list = temp_file_write(&folder, "jobs.jsonl", text, used);
}

static int make_files(void **state) {
    static const char square[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
    (void)state;
    folder = temp_folder_make();
    recorded fold = recorded_fold(8, 6, 6);
    const temp_path models[] = {temp_file_write(&folder, "clean.obj", square, strlen(square)),
                                recorded_write_mesh(&folder, "open.obj", &fold, 0),
                                recorded_write_mesh(&folder, "closed.obj", &fold, 5)};
    recorded_free(&fold);
    write_list(models, 3);
    whole = temp_file_path(&folder, "whole.jsonl");
    merged = temp_file_path(&folder, "merged.jsonl");
    for (int i = 0; i < SHARDS_MAX; i++) {
        char name[32];
        snprintf(name, sizeof name, "shard-%d.jsonl", i + 1);
        shards[i] = temp_file_path(&folder, name);
    }
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- runs ------------------------------------------------------------------------------------------------ */

static void run_shard(int index, int count) {
    char shard[16];
    snprintf(shard, sizeof shard, "%d/%d", index, count);
    remove(shards[index - 1].text);
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", shards[index - 1].text, "--shard", shard,
                "--quiet");
}

static void run_shards(int count) {
    for (int i = 1; i <= count; i++) run_shard(i, count);
}

static tool_run merge_shards(int count, const char *output) {
    const char *arguments[SHARDS_MAX + 4] = {"merge"};
    for (int i = 0; i < count; i++) arguments[i + 1] = shards[i].text;
    if (output != NULL) {
        arguments[count + 1] = "-o";
        arguments[count + 2] = output;
    }
    return run_tool(arguments);
}

static void expect_merge(int count, int code) {
    tool_run run = merge_shards(count, merged.text);
    if (run.code != code) fail_msg("%d: %s", run.code, run.error);
    tool_run_free(&run);
}

/* The lines of one run, in the order of the jobs. */
static char *lines_of_one_run(void) {
    remove(whole.text);
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", whole.text, "--quiet", "--threads", "1");
    return read_whole_file(whole.text, NULL);
}

static void write_file(const char *path, const char *text, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    fclose(file);
}

/* ---- what merges ----------------------------------------------------------------------------------------- */

static void shards_give_what_one_run_gives(void **state) {
    (void)state;
    char *expected = lines_of_one_run();
    for (int count = 1; count <= SHARDS_MAX; count += 2) {
        run_shards(count);
        expect_merge(count, 0);
        char *found = read_whole_file(merged.text, NULL);
        assert_string_equal(found, expected);
        free(found);
    }
    free(expected);
}

/* Lines in any order in the files. */
static void the_order_of_lines_does_not_matter(void **state) {
    (void)state;
    char *expected = lines_of_one_run();
    run_shards(3);
    shell("for f in '%s'/shard-?.jsonl; do shuf --random-source=/dev/zero \"$f\" -o \"$f\"; done",
          folder.path);
    expect_merge(3, 0);
    char *found = read_whole_file(merged.text, NULL);
    assert_string_equal(found, expected);
    free(found);
    free(expected);
}

static void exit_codes_are_those_of_one_run(void **state) {
    (void)state;
    for (int i = 1; i <= 2; i++) {
        remove(shards[i - 1].text);
        tool_run run = RUN_TOOL("check", "--list", list.text, "--results", shards[i - 1].text, "--shard",
                                i == 1 ? "1/2" : "2/2", "--fail-on", "crossing", "--quiet");
        assert_int_equal(run.code, 3);
        tool_run_free(&run);
    }
    expect_merge(2, 3);
    remove(merged.text);
    tool_run run = merge_shards(2, NULL);
    assert_int_equal(run.code, 3);
    assert_string_equal(run.out, "40 jobs: 27 clean, 13 with intersections\n");
    assert_int_not_equal(access(merged.text, F_OK), 0);
    tool_run_free(&run);
}

static void a_dash_is_the_standard_output(void **state) {
    (void)state;
    char *expected = lines_of_one_run();
    run_shards(1);
    tool_run run = merge_shards(1, "-");
    assert_int_equal(run.code, 0);
    assert_string_equal(run.out, expected);
    tool_run_free(&run);
    free(expected);
}

/* A job that fails itself is an error, one that found something a failure. */
static void junit_has_a_case_for_each_job(void **state) {
    char text[1200], *expected = text;
    (void)state;
    temp_path xml = temp_file_path(&folder, "night.xml"), few;
    static const char crossing[] =
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";
    const char *names[] = {"clean.obj", "crossing.obj", "none.obj"};
    temp_file_write(&folder, "crossing.obj", crossing, strlen(crossing));
    for (int i = 0; i < 3; i++)
        expected +=
            sprintf(expected, "{\"model\": \"%s/%s\", \"name\": \"<%d>\"}\n", folder.path, names[i], i);
    few = temp_file_write(&folder, "few.jsonl", text, strlen(text));
    remove(whole.text);
    EXPECT_TOOL(1, "check", "--list", few.text, "--results", whole.text, "--fail-on", "crossing", "--quiet");
    EXPECT_TOOL(1, "merge", whole.text, "--junit", xml.text);
    char *found = read_whole_file(xml.text, NULL);
    assert_non_null(
        strstr(found, "tests=\"3\" failures=\"1\" errors=\"1\">\n"
                      "    <testcase classname=\"cscd\" name=\"&#60;0&#62;\"/>\n"
                      "    <testcase classname=\"cscd\" name=\"&#60;1&#62;\">\n      <failure message=\""));
    assert_non_null(strstr(found, " cross"));
    assert_non_null(strstr(found, "<error message=\""));
    assert_non_null(strstr(found, "none.obj: cannot open: No such file or directory\"/>\n    </testcase>\n"
                                  "  </testsuite>\n</testsuites>\n"));
    free(found);
    EXPECT_ERROR(2, TEXTS("--junit", "would overwrite"), "merge", whole.text, "--junit", whole.text);
    EXPECT_ERROR(2, TEXTS("--junit"), "merge", whole.text, "-o", merged.text, "--junit", merged.text);
}

/* ---- what does not --------------------------------------------------------------------------------------- */

/* Nothing is written, and what was there stays. */
static void expect_refused(int count, const char *text) {
    write_file(merged.text, "old\n", 4);
    tool_run run = merge_shards(count, merged.text);
    assert_int_equal(run.code, 1);
    assert_string_equal(run.out, "");
    if (strstr(run.error, text) == NULL) fail_msg("'%s' is not in: %s", text, run.error);
    tool_run_free(&run);
    char *left = read_whole_file(merged.text, NULL);
    assert_string_equal(left, "old\n");
    free(left);
    remove(merged.text);
}

static void missing_jobs_are_named(void **state) {
    (void)state;
    run_shards(3);
    shell("mv '%s' '%s/away'", shards[2].text, folder.path);
    expect_refused(2, "of 40 jobs are missing: ");
    shell("mv '%s/away' '%s'", folder.path, shards[2].text);
    shell("sed -i '/\"job\":1[0-3],/d' '%s' '%s' '%s'", shards[0].text, shards[1].text, shards[2].text);
    expect_refused(3, "4 of 40 jobs are missing: 10 to 13; is a shard not named, or not done?");
    shell("sed -i '/\"job\":40,/d' '%s' '%s' '%s'", shards[0].text, shards[1].text, shards[2].text);
    expect_refused(3, "5 of 40 jobs are missing: 10 to 13, 40; ");
    write_file(shards[0].text, "", 0);
    expect_refused(1, "there are no results");
}

static void double_jobs_are_named(void **state) {
    (void)state;
    run_shards(2);
    shell("head -1 '%s' >> '%s'", shards[1].text, shards[0].text);
    expect_refused(2, "shard-1.jsonl as well");
    run_shards(2);
    shell("tail -1 '%s' >> '%s'", shards[1].text, shards[1].text);
    expect_refused(2, "shard-2.jsonl as well");
    EXPECT_ERROR(1, TEXTS("shard-1.jsonl is named twice"), "merge", shards[0].text, shards[0].text);
}

static void foreign_results_are_named(void **state) {
    (void)state;
    run_shards(2);
    remove(shards[1].text);
    EXPECT_TOOL(0, "check", "--list", list.text, "--results", shards[1].text, "--shard", "2/2", "--quiet",
                "--ignore-rest");
    expect_refused(2,
                   "shard-2.jsonl:1: these are results of another list or of other options than those of ");
    write_file(shards[1].text, "{\"file\": \"a.obj\"}\n", 18);
    expect_refused(2, "shard-2.jsonl:1: this is no line of results");
    EXPECT_ERROR(1, TEXTS("/nowhere/x.jsonl: cannot open"), "merge", shards[0].text, "/nowhere/x.jsonl");
    EXPECT_ERROR(2, TEXTS("no results given"), "merge");
    EXPECT_ERROR(2, TEXTS("-o", "would overwrite"), "merge", shards[0].text, "-o", shards[0].text);
}

/* Whatever byte of a line is missing or another, it is never taken for the whole: it is refused, or its job is missing. */
static void damaged_lines_are_noticed(void **state) {
    (void)state;
    run_shards(2);
    char *text = read_whole_file(shards[1].text, NULL);
    const size_t size = strlen(text);
    size_t last = size - 1; /* where the last line begins */
    while (text[last - 1] != '\n') last--;
    for (size_t cut = size - 1; cut > last; cut -= cut > last + 7 ? 7 : 1) {
        write_file(shards[1].text, text, cut);
        expect_refused(2, text[cut - 1] == '\n' ? "1 of 40 jobs are missing: " : "shard-2.jsonl:");
    }
    const char *first_end = strchr(text, '\n');
    write_file(shards[1].text, first_end + 1, size - (size_t)(first_end + 1 - text));
    expect_refused(2, "1 of 40 jobs are missing: ");
    free(text);
}

static void a_full_disk_leaves_nothing(void **state) {
    (void)state;
    run_shards(2);
    EXPECT_ERROR(1, TEXTS("/dev/full", "No space left"), "merge", shards[0].text, shards[1].text, "-o",
                 "/dev/full");
    write_file(merged.text, "old\n", 4);
    char *output = shell_output(1, "trap '' XFSZ; prlimit --fsize=3000 '%s' merge '%s' '%s' -o '%s'",
                                getenv("CSCD_TOOL"), shards[0].text, shards[1].text, merged.text);
    if (strstr(output, "merged.jsonl: cannot write: File too large") == NULL) fail_msg("%s", output);
    free(output);
    output = shell_output(0, "cat '%s'; ls -A '%s' | grep -c output || true", merged.text, folder.path);
    assert_string_equal(output, "old\n0\n");
    free(output);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shards_give_what_one_run_gives),
        cmocka_unit_test(the_order_of_lines_does_not_matter),
        cmocka_unit_test(exit_codes_are_those_of_one_run),
        cmocka_unit_test(a_dash_is_the_standard_output),
        cmocka_unit_test(junit_has_a_case_for_each_job),
        cmocka_unit_test(missing_jobs_are_named),
        cmocka_unit_test(double_jobs_are_named),
        cmocka_unit_test(foreign_results_are_named),
        cmocka_unit_test(damaged_lines_are_noticed),
        cmocka_unit_test(a_full_disk_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
