/* `replay --shard` and `merge`: the shards of a recording give what one run gives, byte for byte. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* A fold that opens and closes, in five chunks: events go on over their borders. */
enum { FRAMES = 150, SHARDS_MAX = 7 };

/* What a run writes. */
static const char *const endings[] = {"contacts.csv", "events.csv", "summary.json", "page.html"};
enum { OUTPUTS = 4 };

static temp_folder folder;
static temp_path fold, cache, spindle, spindle_cache;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_fold(8, 6, 12);
    fold = recorded_write_mesh(&folder, "fold.obj", &scene, 0);
    cache = recorded_write_cycle(&folder, "fold.pc2", &scene, FRAMES);
    recorded_free(&scene);
    scene = recorded_spindle(12, 8, 14);
    spindle = recorded_write_mesh(&folder, "spindle.obj", &scene, 0);
    spindle_cache = recorded_write_cycle(&folder, "spindle.pc2", &scene, 70);
    recorded_free(&scene);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- runs ------------------------------------------------------------------------------------------------ */

static void whole_run(const char *options) {
    shell("\"$CSCD_TOOL\" replay %s --quiet --reproducible --contacts '%s/one.contacts.csv' --events "
          "'%s/one.events.csv' --json '%s/one.summary.json' --report '%s/one.page.html'",
          options, folder.path, folder.path, folder.path, folder.path);
}

static void shard_run(const char *options, int shard, int count) {
    shell("\"$CSCD_TOOL\" replay %s --quiet --shard %d/%d --results '%s/%d.shard'", options, shard, count,
          folder.path, shard);
}

static void remove_shards(void) {
    shell("rm -f '%s'/*.shard", folder.path);
}

static void all_shards(const char *options, int count) {
    remove_shards();
    for (int shard = 1; shard <= count; shard++) shard_run(options, shard, count);
}

static void merge_run(void) {
    shell("\"$CSCD_TOOL\" merge '%s'/*.shard --quiet --reproducible --contacts '%s/merged.contacts.csv' "
          "--events '%s/merged.events.csv' --json '%s/merged.summary.json' --report '%s/merged.page.html'",
          folder.path, folder.path, folder.path, folder.path, folder.path);
}

static void expect_same_outputs(void) {
    for (int i = 0; i < OUTPUTS; i++)
        shell("cmp '%s/one.%s' '%s/merged.%s'", folder.path, endings[i], folder.path, endings[i]);
}

static char *fold_with(const char *options) {
    static char text[2400];
    snprintf(text, sizeof text, "'%s' '%s' %s", fold.text, cache.text, options);
    return text;
}

static char *spindle_with(const char *options) {
    static char text[2400];
    snprintf(text, sizeof text, "'%s' '%s' %s", spindle.text, spindle_cache.text, options);
    return text;
}

/* ---- the same bytes -------------------------------------------------------------------------------------- */

static void expect_equal_in_shards(const char *options) {
    whole_run(options);
    for (int count = 1; count <= SHARDS_MAX; count += 2) {
        all_shards(options, count);
        merge_run();
        expect_same_outputs();
    }
}

static void shards_give_what_one_run_gives(void **state) {
    (void)state;
    expect_equal_in_shards(fold_with(""));
    shell("test $(wc -l <'%s/one.contacts.csv') -gt 100 && test $(wc -l <'%s/one.events.csv') -gt 3",
          folder.path, folder.path);
}

static void without_a_check_each_shard_proves_its_start(void **state) {
    (void)state;
    expect_equal_in_shards(fold_with("--no-check"));
}

static void of_part_of_the_frames(void **state) {
    (void)state;
    expect_equal_in_shards(fold_with("--frames 11:100 --no-depths --first-frame 1"));
}

/* Orientations and detector points come from the files of the shards. */
static void of_a_closed_body_with_regions(void **state) {
    (void)state;
    expect_equal_in_shards(spindle_with("--method kmeans:4"));
    expect_equal_in_shards(spindle_with("--method single --mode earliest"));
}

static void by_every_method(void **state) {
    (void)state;
    expect_equal_in_shards(spindle_with("--method charge"));
    expect_equal_in_shards(spindle_with("--method iccd"));
    expect_equal_in_shards(spindle_with("--method brute"));
}

/* Two objects, one closed and at rest, of which more is promised than of the open one. */
static void of_several_components(void **state) {
    char options[700];
    (void)state;
    snprintf(options, sizeof options, "--object 'Spindle=%s' --method single --mode earliest", spindle.text);
    expect_equal_in_shards(fold_with(options));
    shell("grep -q 'embedded[^}]*\"count\":1' '%s/one.summary.json' && "
          "grep -q '\"reason\":\"open[^}]*\"count\":1' '%s/one.summary.json'",
          folder.path, folder.path);
}

static void exit_code_and_words_are_those_of_one_run(void **state) {
    (void)state;
    all_shards(fold_with(""), 2);
    char *one = shell_output(0, "\"$CSCD_TOOL\" replay %s", fold_with("")),
         *merged = shell_output(0, "\"$CSCD_TOOL\" merge '%s'/*.shard", folder.path);
    assert_string_equal(one, merged);
    free(one);
    free(merged);
    remove_shards();
    for (int shard = 1; shard <= 2; shard++)
        free(shell_output(
            3, "\"$CSCD_TOOL\" replay %s --fail-on crossing --quiet --shard %d/2 --results '%s/%d.shard'",
            fold_with(""), shard, folder.path, shard));
    free(shell_output(3, "\"$CSCD_TOOL\" merge '%s'/*.shard --quiet", folder.path));
}

static void with_times_all_else_is_the_same(void **state) {
    (void)state;
    all_shards(fold_with(""), 3);
    shell("\"$CSCD_TOOL\" merge '%s'/*.shard --quiet --json '%s/timed.json'", folder.path, folder.path);
    shell("grep -q '\"total_ms\"' '%s/timed.json' && grep -q '\"date\"' '%s/timed.json'", folder.path,
          folder.path);
}

/* ---- stopped and resumed --------------------------------------------------------------------------------- */

/* A file that ends anywhere is gone on with, and ends as if nothing had happened. A closed body, so that counters depend on where
 * its detector started. */
static void a_shard_that_was_stopped_goes_on(void **state) {
    char path[600];
    struct stat whole;
    (void)state;
    whole_run(spindle_with("--method single"));
    all_shards(spindle_with("--method single"), 1);
    snprintf(path, sizeof path, "%s/1.shard", folder.path);
    assert_int_equal(stat(path, &whole), 0);
    const off_t cuts[] = {whole.st_size,
                          whole.st_size - 1,
                          whole.st_size * 2 / 3,
                          whole.st_size / 2,
                          whole.st_size * 2 / 5,
                          400,
                          120,
                          80,
                          40,
                          1};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        shell("truncate -s %lld '%s'", (long long)cuts[i], path);
        shell("\"$CSCD_TOOL\" replay %s --quiet --results '%s' --resume", spindle_with("--method single"),
              path);
        merge_run();
        expect_same_outputs();
    }
}

/* Killed at any moment, again and again. */
static void a_shard_that_is_killed_loses_nothing(void **state) {
    char path[600];
    (void)state;
    whole_run(spindle_with("--method single"));
    remove_shards();
    snprintf(path, sizeof path, "%s/1.shard", folder.path);
    const char *const arguments[] = {"replay",   spindle.text, spindle_cache.text, "--quiet",
                                     "--method", "single",     "--results",        path,
                                     "--resume", NULL};
    for (int i = 0; i < 12; i++) {
        tool_process process = run_tool_start(arguments);
        usleep(1000 * (useconds_t)(1 + 3 * i));
        kill(process.pid, SIGKILL);
        tool_run run = run_tool_finish(&process);
        assert_true(run.code == 0 || run.code == 128 + SIGKILL);
        tool_run_free(&run);
    }
    run_tool_expect(0, arguments);
    merge_run();
    expect_same_outputs();
}

/* The disk is full after ever more bytes: what is whole is kept, and the next run goes on with it. */
static void a_full_disk_loses_nothing(void **state) {
    char path[600];
    struct stat status;
    (void)state;
    whole_run(spindle_with("--method single"));
    remove_shards();
    snprintf(path, sizeof path, "%s/1.shard", folder.path);
    shell("\"$CSCD_TOOL\" replay %s --quiet --results '%s'", spindle_with("--method single"), path);
    assert_int_equal(stat(path, &status), 0);
    const off_t whole = status.st_size, sizes[] = {0, 1, 100, whole / 3, whole / 2, whole - 1};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        remove_shards();
        char *output = shell_output(
            1, "trap '' XFSZ; prlimit --fsize=%lld \"$CSCD_TOOL\" replay %s --quiet --results '%s'",
            (long long)sizes[i], spindle_with("--method single"), path);
        if (strstr(output, "1.shard: cannot write: File too large") == NULL) fail_msg("%s", output);
        free(output);
        shell("\"$CSCD_TOOL\" replay %s --quiet --results '%s' --resume", spindle_with("--method single"),
              path);
        merge_run();
        expect_same_outputs();
    }
}

static void results_are_not_written_over(void **state) {
    char path[600];
    (void)state;
    all_shards(fold_with(""), 1);
    snprintf(path, sizeof path, "%s/1.shard", folder.path);
    EXPECT_ERROR(1, TEXTS("1.shard", "--resume"), "replay", fold.text, cache.text, "--results", path);
    EXPECT_ERROR(1, TEXTS("other options", "resumed"), "replay", fold.text, cache.text, "--results", path,
                 "--resume", "--no-check");
    EXPECT_ERROR(1, TEXTS("results of another model"), "replay", spindle.text, spindle_cache.text,
                 "--results", path, "--resume");
    EXPECT_ERROR(1, TEXTS("another number of shards"), "replay", fold.text, cache.text, "--results", path,
                 "--resume", "--shard", "1/2");
    all_shards(fold_with(""), 2);
    EXPECT_ERROR(1, TEXTS("results of another shard"), "replay", fold.text, cache.text, "--results", path,
                 "--resume", "--shard", "2/2");
    EXPECT_ERROR(1, TEXTS("this is no shard"), "replay", fold.text, cache.text, "--results",
                 temp_file_write(&folder, "notes.txt", "bread\n", 6).text, "--resume");
    FILE *locked = fopen(path, "a");
    assert_int_equal(flock(fileno(locked), LOCK_EX), 0);
    EXPECT_ERROR(1, TEXTS("another process"), "replay", fold.text, cache.text, "--results", path, "--resume");
    fclose(locked);
}

/* ---- what does not belong together ----------------------------------------------------------------------- */

static void expect_refused(const char *files, const char *words) {
    char *said =
        shell_output(1,
                     "cd '%s' && rm -f none.csv && \"$CSCD_TOOL\" merge %s --contacts none.csv 2>&1; "
                     "code=$?; test ! -e none.csv && exit $code",
                     folder.path, files);
    if (strstr(said, words) == NULL) print_error("%s", said);
    assert_non_null(strstr(said, words));
    free(said);
}

static void missing_doubled_and_foreign_shards_are_named(void **state) {
    (void)state;
    all_shards(fold_with(""), 5);
    expect_refused("1.shard 3.shard", "of 5 shards these are missing: 2, 4, 5");
    expect_refused("4.shard", "missing: 1 to 3, 5");
    shell("cp '%s/2.shard' '%s/again.shard'", folder.path, folder.path);
    expect_refused("1.shard 2.shard 3.shard 4.shard 5.shard again.shard", "both are shard 2/5");
    shell("mv '%s/1.shard' '%s/1.own'", folder.path, folder.path);
    shard_run(fold_with("--no-depths"), 1, 5);
    expect_refused("1.shard 2.shard", "2.shard: it is of other options than 1.shard is");
    shell("mv '%s/1.own' '%s/1.shard'", folder.path, folder.path);
    shell("truncate -s -5 '%s/3.shard'", folder.path);
    expect_refused("2.shard 3.shard",
                   "3.shard: shard 3/5 has 31 of 32 intervals; start it again with --resume");
    expect_refused("2.shard notes.none", "notes.none: cannot read");
    remove_shards();
}

static void files_that_have_changed_are_noticed(void **state) {
    (void)state;
    all_shards(fold_with(""), 2);
    shell("cp '%s' '%s/kept.obj' && sed -i '1,/^v /s/^v .*/v 9 9 9/' '%s'", fold.text, folder.path,
          fold.text);
    expect_refused("1.shard 2.shard", "the shard is of another model");
    shell("cp '%s/kept.obj' '%s' && rm '%s/kept.obj'", folder.path, fold.text, folder.path);
    merge_run();
    shell("printf x | dd of='%s/2.shard' bs=1 seek=2000 conv=notrunc status=none", folder.path);
    expect_refused("1.shard 2.shard",
                   "2.shard: shard 2/2 has 2 of 85 intervals; start it again with --resume");
}

/* The frame between two shards, which both have read. */
static void other_frames_are_noticed(void **state) {
    (void)state;
    remove_shards();
    shard_run(fold_with(""), 1, 2);
    shell(
        "cp '%s' '%s/kept.pc2' && printf x | dd of='%s' bs=1 seek=$((32 + 64 * 63 * 12 + 2)) conv=notrunc status=none",
        cache.text, folder.path, cache.text);
    shard_run(fold_with(""), 2, 2);
    shell("cp '%s/kept.pc2' '%s' && rm '%s/kept.pc2'", folder.path, cache.text, folder.path);
    expect_refused("1.shard 2.shard", "have seen different frames");
}

static void options_that_do_not_fit_are_refused(void **state) {
    (void)state;
    EXPECT_ERROR(2, TEXTS("--shard needs --results"), "replay", fold.text, cache.text, "--shard", "1/2");
    EXPECT_ERROR(2, TEXTS("--resume needs --results"), "replay", fold.text, cache.text, "--resume");
    EXPECT_ERROR(2, TEXTS("--contacts", "cscd merge"), "replay", fold.text, cache.text, "--shard", "1/2",
                 "--results", "none.shard", "--contacts", "none.csv");
    EXPECT_ERROR(2, TEXTS("--job-timeout is for --list"), "replay", fold.text, cache.text, "--job-timeout",
                 "3");
    EXPECT_ERROR(2, TEXTS("--resume=failed is for --list"), "replay", fold.text, cache.text, "--results",
                 "none.shard", "--resume=failed");
    all_shards(fold_with(""), 1);
    char *said = shell_output(2, "\"$CSCD_TOOL\" merge '%s'/*.shard -o none.jsonl 2>&1", folder.path);
    assert_non_null(strstr(said, "-o is for the results of a list"));
    free(said);
    said = shell_output(2, "cd '%s' && \"$CSCD_TOOL\" merge 1.shard --contacts 1.shard 2>&1", folder.path);
    assert_non_null(strstr(said, "--contacts"));
    free(said);
    merge_run();
}

/* --shard of a list says which jobs, each of which is a whole recording. */
static void shards_of_a_list_have_whole_recordings(void **state) {
    char text[1500];
    (void)state;
    snprintf(text, sizeof text, "{\"model\": \"%s\", \"frames\": \"%s\"}\n", fold.text, cache.text);
    const temp_path list = temp_file_write(&folder, "jobs.jsonl", text, strlen(text));
    char *one = shell_output(0, "\"$CSCD_TOOL\" replay --list '%s'", list.text),
         *shard = shell_output(
             0, "\"$CSCD_TOOL\" replay --list '%s' --shard 1/2 --results '%s/list-1.jsonl' --job-timeout 100",
             list.text, folder.path);
    assert_string_equal(one, shard);
    assert_non_null(strstr(one, "of 150"));
    free(one);
    free(shard);
}

/* The lines of meshes have times as well. */
static void two_checks_of_meshes_give_the_same_bytes(void **state) {
    (void)state;
    for (int i = 1; i <= 2; i++)
        shell(
            "\"$CSCD_TOOL\" check --each '%s' '%s' '%s/none.obj' --reproducible --quiet --json '%s/each%d.jsonl'; test $? = 1",
            fold.text, spindle.text, folder.path, folder.path, i);
    shell(
        "cd '%s' && cmp each1.jsonl each2.jsonl && test $(wc -l <each1.jsonl) = 3 && ! grep _ms each1.jsonl",
        folder.path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shards_give_what_one_run_gives),
        cmocka_unit_test(without_a_check_each_shard_proves_its_start),
        cmocka_unit_test(of_part_of_the_frames),
        cmocka_unit_test(of_a_closed_body_with_regions),
        cmocka_unit_test(by_every_method),
        cmocka_unit_test(of_several_components),
        cmocka_unit_test(exit_code_and_words_are_those_of_one_run),
        cmocka_unit_test(with_times_all_else_is_the_same),
        cmocka_unit_test(a_shard_that_was_stopped_goes_on),
        cmocka_unit_test(a_shard_that_is_killed_loses_nothing),
        cmocka_unit_test(a_full_disk_loses_nothing),
        cmocka_unit_test(results_are_not_written_over),
        cmocka_unit_test(missing_doubled_and_foreign_shards_are_named),
        cmocka_unit_test(files_that_have_changed_are_noticed),
        cmocka_unit_test(other_frames_are_noticed),
        cmocka_unit_test(options_that_do_not_fit_are_refused),
        cmocka_unit_test(shards_of_a_list_have_whole_recordings),
        cmocka_unit_test(two_checks_of_meshes_give_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
