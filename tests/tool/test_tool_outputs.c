/* What a command writes takes the place of an older file when it is whole, and "-" is the standard output. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FULL_DISK = 600 };

static temp_folder folder;
static temp_path tetrahedra, flight, sheet, folding;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded pair = recorded_tetrahedra(8), fold = recorded_fold(30, 20, 6);
    tetrahedra = recorded_write_mesh(&folder, "pair.obj", &pair, 0);
    flight = recorded_write_cache(&folder, "pair.pc2", &pair);
    sheet = recorded_write_mesh(&folder, "sheet.obj", &fold, 0);
    folding = recorded_write_cache(&folder, "sheet.pc2", &fold);
    recorded_free(&pair);
    recorded_free(&fold);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static size_t files_in_folder(void) {
    size_t count = 0;
    DIR *entries = opendir(folder.path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) count++;
    closedir(entries);
    return count;
}

/* Runs the tool where no file may have more than FULL_DISK bytes, as by ulimit -f. The signal of that must not end it. */
static void expect_full_disk(const char *const *arguments) {
    struct rlimit usual;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    const struct rlimit small = {FULL_DISK, usual.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    tool_run run = run_tool(arguments);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    if (run.code != 1) fail_msg("%s ran with code %d", arguments[0], run.code);
    const char *said =
        strstr(run.error, ": File too large: a limit of the system on the size of files; raise it");
    if (said == NULL || strstr(said + 3, "File too large") != NULL) fail_msg("%s", run.error);
    tool_run_free(&run);
}

#define EXPECT_FULL_DISK(...) expect_full_disk((const char *const[]){__VA_ARGS__, NULL})

/* The older output is there, byte for byte, and nothing beside it. */
static void expect_kept(const temp_path *path, const char *older, size_t files) {
    char *text = read_whole_file(path->text, NULL);
    assert_string_equal(text, older);
    free(text);
    assert_int_equal(files_in_folder(), files);
}

static void a_full_disk_leaves_the_older_file(void **state) {
    (void)state;
    static const char older[] = "what was there";
    temp_path json = temp_file_write(&folder, "old.json", older, strlen(older));
    temp_path png = temp_file_write(&folder, "old.png", older, strlen(older));
    temp_path page = temp_file_write(&folder, "old.html", older, strlen(older));
    size_t files = files_in_folder();
    EXPECT_FULL_DISK("check", sheet.text, folding.text, "--json", json.text, "--quiet");
    expect_kept(&json, older, files);
    EXPECT_FULL_DISK("replay", sheet.text, folding.text, "--json", json.text, "--quiet");
    expect_kept(&json, older, files);
    EXPECT_FULL_DISK("sense", tetrahedra.text, flight.text, "--json", json.text, "--quiet");
    expect_kept(&json, older, files);
    EXPECT_FULL_DISK("render", sheet.text, "-o", png.text);
    expect_kept(&png, older, files);
    EXPECT_FULL_DISK("replay", tetrahedra.text, flight.text, "--report", page.text, "--quiet");
    expect_kept(&page, older, files);
    remove(json.text);
    remove(png.text);
    remove(page.text);
}

static void a_full_disk_leaves_the_good_plan(void **state) {
    (void)state;
    size_t size, now_size;
    temp_path plan = temp_file_path(&folder, "sheet.plan.ply");
    EXPECT_TOOL(0, "preprocess", sheet.text, "--method", "kmeans:3", "--quiet");
    char *good = read_whole_file(plan.text, &size);
    size_t files = files_in_folder();
    EXPECT_FULL_DISK("preprocess", sheet.text, "--method", "single", "--quiet");
    char *now = read_whole_file(plan.text, &now_size);
    assert_int_equal(now_size, size);
    assert_memory_equal(now, good, size);
    assert_int_equal(files_in_folder(), files);
    free(good);
    free(now);
    remove(plan.text);
}

/* Hours of contacts are not lost because the disk has no room for the last of them. */
static void a_full_disk_keeps_the_contacts_of_whole_intervals(void **state) {
    (void)state;
    temp_path whole = temp_file_path(&folder, "whole.csv"), cut = temp_file_path(&folder, "cut.csv");
    recorded scene = recorded_tetrahedra(8);
    temp_path often = recorded_write_cycle(&folder, "often.pc2", &scene, 60);
    recorded_free(&scene);
    EXPECT_TOOL(0, "replay", tetrahedra.text, often.text, "--csv", whole.text, "--quiet");
    EXPECT_FULL_DISK("replay", tetrahedra.text, often.text, "--csv", cut.text, "--quiet");
    size_t size, cut_size;
    char *all = read_whole_file(whole.text, &size), *kept = read_whole_file(cut.text, &cut_size);
    assert_true(cut_size > 300 && cut_size <= FULL_DISK && size > FULL_DISK);
    assert_memory_equal(kept, all, cut_size);
    assert_int_equal(kept[cut_size - 1], '\n');
    free(all);
    free(kept);
    remove(whole.text);
    remove(cut.text);
}

static void a_killed_replay_leaves_the_older_files(void **state) {
    (void)state;
    static const char older[] = "what was there";
    temp_path json = temp_file_write(&folder, "old.json", older, strlen(older));
    temp_path csv = temp_file_write(&folder, "old.csv", older, strlen(older));
    recorded scene = recorded_fold(30, 20, 2);
    temp_path long_one = recorded_write_cycle(&folder, "long.pc2", &scene, 5000);
    recorded_free(&scene);
    size_t files = files_in_folder();
    tool_process process =
        run_tool_start((const char *const[]){"replay", sheet.text, long_one.text, "--method", "brute",
                                             "--contacts", csv.text, "--json", json.text, NULL});
    while (files_in_folder() < files + 2) usleep(2000);
    kill(process.pid, SIGKILL);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 128 + SIGKILL);
    tool_run_free(&run);
    expect_kept(&json, older, files + 2);
    expect_kept(&csv, older, files + 2);
}

/* ---- the standard output --------------------------------------------------------------------------- */

/* The standard output holds the file that the same command writes, and the standard error what people read;
 * together with the file it stands on the standard output. */
static void expect_standard(const char *const *command, const char *option, const char *name) {
    const char *arguments[8];
    size_t count = 0;
    temp_path path = temp_file_path(&folder, name);
    for (; command[count] != NULL; count++) arguments[count] = command[count];
    arguments[count] = option;
    arguments[count + 1] = path.text;
    arguments[count + 2] = NULL;
    tool_run to_file = run_tool(arguments);
    char *file = read_whole_file(path.text, NULL);
    arguments[count + 1] = "-";
    tool_run to_standard = run_tool(arguments);
    assert_int_equal(to_file.code, 0);
    assert_int_equal(to_standard.code, 0);
    assert_true(to_file.out_size > 0);
    if (strstr(to_standard.error, " cross") == NULL && strstr(to_standard.error, "warnings") == NULL)
        fail_msg("nothing for people: %s", to_standard.error);
    if (strcmp(option, "--json") != 0) {
        assert_string_equal(to_standard.out, file);
    } else {
        FILE *copy = fopen(path.text, "w");
        fputs(to_standard.out, copy);
        fclose(copy);
        json_node_free(json_node_read_file(path.text)); /* it fails on anything else in the text */
    }
    free(file);
    tool_run_free(&to_file);
    tool_run_free(&to_standard);
    remove(path.text);
}

static void a_dash_is_the_standard_output(void **state) {
    (void)state;
    const char *const check[] = {"check", tetrahedra.text, flight.text, NULL};
    const char *const replay[] = {"replay", tetrahedra.text, flight.text, NULL};
    const char *const sense[] = {"sense", tetrahedra.text, flight.text, NULL};
    const char *const at_rest[] = {"replay", tetrahedra.text, flight.text, "--ignore-rest", NULL};
    expect_standard(check, "--json", "out.json");
    expect_standard(replay, "--json", "out.json");
    expect_standard(replay, "--contacts", "out.csv");
    expect_standard(replay, "--csv", "out.csv");
    expect_standard(at_rest, "--csv", "out.csv");
    expect_standard(sense, "--json", "out.json");
    expect_standard(sense, "--csv", "out.csv");
}

static void two_dashes_are_refused(void **state) {
    (void)state;
    EXPECT_ERROR(2, TEXTS("standard output twice"), "replay", tetrahedra.text, flight.text, "--json", "-",
                 "--csv", "-");
    EXPECT_ERROR(2, TEXTS("standard output twice"), "sense", tetrahedra.text, flight.text, "--json", "-",
                 "--csv", "-");
}

/* A name that says another format than the one that would be written is refused, and no file is there. */
static void names_of_other_formats_are_refused(void **state) {
    (void)state;
    size_t files = files_in_folder();
    EXPECT_ERROR(2, TEXTS("'x.jpg'", "ends in .png"), "render", sheet.text, "-o", "x.jpg");
    EXPECT_ERROR(2, TEXTS("'x.PDF'", "ends in .html"), "replay", sheet.text, folding.text, "--report",
                 "x.PDF");
    EXPECT_ERROR(2, TEXTS("'x.csv'", "ends in .json"), "replay", sheet.text, folding.text, "--json", "x.csv");
    EXPECT_ERROR(2, TEXTS("'x.pdf'", "ends in .html"), "preprocess", sheet.text, "--report", "x.pdf");
    EXPECT_ERROR(2, TEXTS("'x.html'", "ends in .json"), "check", sheet.text, "--json", "x.html");
    EXPECT_ERROR(2, TEXTS("'x.tiff'", "ends in .png"), "sense", sheet.text, folding.text, "--picture",
                 "x.tiff");
    EXPECT_ERROR(2, TEXTS("'x.json'", "ends in .csv"), "sense", sheet.text, folding.text, "--csv", "x.json");
    EXPECT_ERROR(2, TEXTS("'x.txt'", "ends in .html"), "report", "a.json", "-o", "x.txt");
    assert_int_equal(files_in_folder(), files);
    temp_path odd = temp_file_path(&folder, "frame.0012");
    EXPECT_TOOL(0, "render", sheet.text, "--size", "32x24", "-o", odd.text);
    remove(odd.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_disk_leaves_the_older_file),
        cmocka_unit_test(a_full_disk_leaves_the_good_plan),
        cmocka_unit_test(a_full_disk_keeps_the_contacts_of_whole_intervals),
        cmocka_unit_test(a_dash_is_the_standard_output),
        cmocka_unit_test(two_dashes_are_refused),
        cmocka_unit_test(names_of_other_formats_are_refused),
        cmocka_unit_test(a_killed_replay_leaves_the_older_files),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
