/* Replays that end early keep what they have written; replays that last do not grow in memory. */
#include "tests/support/test.h"
#include "tests/support/tool/contact_rows.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <glob.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

static temp_folder folder;
static temp_path csv, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* The JSON has the first interval_count intervals and the frames checked so far, says that it is not complete
 * and gives a reason that holds the text; the CSV has whole lines of these intervals only. */
static void expect_stopped(size_t interval_count, size_t frame_count, const char *reason) {
    json_node *root = json_node_read_file(summary.text);
    const json_node *total = json_node_member(root, "summary"),
                    *intervals = json_node_member(root, "intervals");
    assert_false(json_node_boolean(total, "complete"));
    assert_non_null(strstr(json_node_string(total, "stopped_by"), reason));
    assert_int_equal(intervals->count, interval_count);
    assert_int_equal(json_node_member(root, "frames")->count, frame_count);
    contact_rows rows = contact_rows_read_csv(csv.text);
    assert_true(json_node_number(total, "vf") + json_node_number(total, "ee") == (double)rows.count);
    for (size_t k = 0; k < interval_count; k++)
        assert_true(json_node_number(json_node_item(intervals, k), "frame") == (double)k);
    for (size_t i = 0; i < rows.count; i++) assert_true(rows.items[i].frame < (int32_t)interval_count);
    contact_rows_free(&rows);
    json_node_free(root);
}

/* Writes the point cache of the scene with one coordinate replaced. */
static temp_path write_spoilt_cache(const recorded *scene, uint32_t frame, uint32_t vertex, float value) {
    temp_path path = recorded_write_cache(&folder, "spoilt.pc2", scene);
    FILE *file = fopen(path.text, "r+b");
    assert_non_null(file);
    long offset = 32 + ((long)frame * (long)scene->vertex_count + (long)vertex) * 12;
    assert_int_equal(fseek(file, offset, SEEK_SET), 0);
    assert_int_equal(fwrite(&value, sizeof value, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    return path;
}

static void a_bad_frame_keeps_the_intervals_before(void **state) {
    (void)state;
    recorded scene = recorded_tetrahedra(8);
    temp_path model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    temp_path cache = write_spoilt_cache(&scene, 3, 5, NAN);
    EXPECT_ERROR(1, TEXTS("frame 3", "vertex 5"), "replay", model.text, cache.text, "--contacts", csv.text,
                 "--json", summary.text);
    expect_stopped(2, 3, "vertex 5");
    cache = write_spoilt_cache(&scene, 6, 0, INFINITY);
    EXPECT_ERROR(1, TEXTS("frame 6", "vertex 0"), "replay", model.text, cache.text, "--contacts", csv.text,
                 "--json", summary.text);
    expect_stopped(5, 6, "frame 6");
    cache = write_spoilt_cache(&scene, 0, 7, NAN);
    EXPECT_ERROR(1, TEXTS("frame 0", "vertex 7"), "replay", model.text, cache.text, "--contacts", csv.text,
                 "--json", summary.text);
    expect_stopped(0, 0, "frame 0");
    recorded_free(&scene);
}

static void a_frame_of_another_size_keeps_the_intervals_before(void **state) {
    (void)state;
    recorded scene = recorded_tetrahedra(8), other = recorded_cube(false);
    temp_path model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    temp_path pattern = recorded_write_sequence(&folder, "walk_%03d.obj", &scene);
    recorded_write_mesh(&folder, "walk_005.obj", &other, 0);
    EXPECT_ERROR(1, TEXTS("walk_005.obj", "12", "8"), "replay", model.text, pattern.text, "--contacts",
                 csv.text, "--json", summary.text);
    expect_stopped(4, 5, "walk_005.obj");
    temp_path cache = recorded_write_cache(&folder, "other.pc2", &other);
    EXPECT_ERROR(1, TEXTS("other.pc2", "12", "8"), "replay", model.text, cache.text);
    recorded_free(&scene);
    recorded_free(&other);
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    recorded scene = recorded_tetrahedra(8);
    temp_path model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    temp_path cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    temp_path full = temp_file_path(&folder, "full.csv");
    assert_int_equal(symlink("/dev/full", full.text), 0);
    tool_run run =
        RUN_TOOL("replay", model.text, cache.text, "--contacts", full.text, "--json", summary.text);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "full.csv: cannot write: No space left"));
    tool_run_free(&run);
    json_node *root = json_node_read_file(summary.text);
    assert_false(json_node_boolean(json_node_member(root, "summary"), "complete"));
    json_node_free(root);
    run = RUN_TOOL("replay", model.text, cache.text, "--json", "/dev/full");
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "/dev/full: cannot write: No space left"));
    tool_run_free(&run);
    recorded_free(&scene);
}

static off_t size_of(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 ? status.st_size : 0;
}

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Have both outputs, which lie beside their places until they are whole, that many bytes? */
static bool outputs_have(off_t size) {
    char pattern[300];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/.cscd-output-*", folder.path);
    bool has = glob(pattern, 0, NULL, &found) == 0 && found.gl_pathc == 2;
    for (size_t i = 0; has && i < 2; i++) has = size_of(found.gl_pathv[i]) >= size;
    globfree(&found);
    return has;
}

/* Waits until the tool has written the contacts of two intervals; the test fails when that takes too long. */
static void wait_for_contacts(void) {
    double start = now_s();
    while (!outputs_have(400)) {
        if (now_s() - start > 120) fail_msg("no contacts after two minutes");
        usleep(2000);
    }
}

/* Brute force over a thousand features has far more intervals to do than it can finish before the signal. */
static void an_interrupt_keeps_what_is_written(void **state) {
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    recorded scene = recorded_fold(30, 20, 2);
    temp_path model = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    temp_path cache = recorded_write_cycle(&folder, "sheet.pc2", &scene, 5000);
    for (size_t i = 0; i < 3; i++) {
        remove(csv.text);
        remove(summary.text);
        tool_process process =
            run_tool_start((const char *const[]){"replay", model.text, cache.text, "--method", "brute",
                                                 "--contacts", csv.text, "--json", summary.text, NULL});
        wait_for_contacts();
        kill(process.pid, signals[i]);
        tool_run run = run_tool_finish(&process);
        assert_int_equal(run.code, 128 + signals[i]);
        assert_non_null(strstr(run.out, "contacts: "));
        json_node *root = json_node_read_file(summary.text);
        size_t done = json_node_member(root, "intervals")->count;
        json_node_free(root);
        char kept[1200];
        snprintf(kept, sizeof kept,
                 "cscd: interrupted after %zu of 4999 intervals (frames 0 to %zu); what was found is kept in "
                 "%s, %s\n",
                 done, done, csv.text, summary.text);
        if (strstr(run.error, kept) == NULL) fail_msg("expected '%s' in: %s", kept, run.error);
        tool_run_free(&run);
        assert_true(done >= 1 && done < 4999);
        expect_stopped(done, done + 1, "interrupted");
    }
    recorded_free(&scene);
}

/* Starts the tool, interrupts it when its outputs have been begun, and expects that nothing was finished of what it counts. */
static void interrupt_first(const char *const *arguments, const char *kept) {
    remove(csv.text);
    remove(summary.text);
    tool_process process = run_tool_start(arguments);
    double start = now_s();
    while (!outputs_have(0) && now_s() - start < 120) usleep(2000);
    usleep(300 * 1000);
    kill(process.pid, SIGINT);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 130);
    if (strstr(run.error, kept) == NULL) fail_msg("expected '%s' in: %s", kept, run.error);
    tool_run_free(&run);
}

/* Needles that lie across each other: every one of count crosses every one of another count. */
static temp_path write_crossed_needles(uint32_t count) {
    temp_path path = temp_file_path(&folder, "needles.obj");
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    for (uint32_t i = 0; i < count; i++) {
        fprintf(file, "v -1 %u -0.5\nv %u %u -0.5\nv 0 %u.1 0.5\n", i, count, i, i);
        fprintf(file, "v %u -1 -0.5\nv %u %u -0.5\nv %u.1 0 0.5\n", i, i, count, i);
    }
    for (uint32_t i = 0; i < 2 * count; i++) fprintf(file, "f %u %u %u\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* One interval, or one frame, that takes much longer than the signal needs is not waited for. */
static void an_interrupt_ends_a_long_call(void **state) {
    (void)state;
    recorded scene = recorded_fold(120, 80, 2);
    temp_path model = recorded_write_mesh(&folder, "large.obj", &scene, 0);
    temp_path cache = recorded_write_cycle(&folder, "large.pc2", &scene, 2);
    interrupt_first((const char *const[]){"replay", model.text, cache.text, "--method", "brute", "--no-check",
                                          "--contacts", csv.text, "--json", summary.text, NULL},
                    "cscd: interrupted after 0 of 1 intervals; what was found is kept in ");
    expect_stopped(0, 1, "interrupted");
    recorded_free(&scene);
    temp_path needles = write_crossed_needles(1500);
    interrupt_first(
        (const char *const[]){"check", needles.text, "--csv", csv.text, "--json", summary.text, NULL},
        "cscd: interrupted after 0 of 1 frames; what was found is kept in ");
    json_node *root = json_node_read_file(summary.text);
    assert_false(json_node_boolean(root, "complete"));
    assert_string_equal(json_node_string(root, "stopped_by"), "interrupted");
    assert_int_equal(json_node_member(root, "frames")->count, 0);
    json_node_free(root);
}

/* A signal that comes before the tool has begun ends it as any program, without a sentence. */
static tool_run interrupt_preprocess(const char *model) {
    for (useconds_t wait = 200 * 1000;; wait *= 2) {
        tool_process process = run_tool_start((const char *const[]){"preprocess", model, NULL});
        usleep(wait);
        kill(process.pid, SIGINT);
        tool_run run = run_tool_finish(&process);
        if (run.code != 128 + SIGINT || run.error[0] != '\0' || wait > 5 * 1000 * 1000) return run;
        tool_run_free(&run);
    }
}

/* A signal during seconds of work stops it at once, and there is no plan, neither partial nor whole. */
static void an_interrupted_preprocess_writes_nothing(void **state) {
    (void)state;
    recorded scene = recorded_fold(200, 200, 1);
    temp_path model = recorded_write_mesh(&folder, "wide.obj", &scene, 0);
    temp_path plan = temp_file_path(&folder, "wide.plan.ply");
    recorded_free(&scene);
    tool_run run = interrupt_preprocess(model.text);
    assert_int_equal(run.code, 130);
    assert_non_null(strstr(run.error, "interrupted; no plan was written"));
    assert_int_equal(size_of(plan.text), 0);
    tool_run_free(&run);
}

#if defined(__SANITIZE_ADDRESS__)
/* The sanitizer keeps freed memory, so there is nothing to measure, but the replays must run all the same. */
static void compare_peaks(const char *model, const char *short_cache, const char *long_cache) {
    EXPECT_TOOL(0, "replay", model, short_cache, "--frames", ":20");
    EXPECT_TOOL(0, "replay", model, long_cache, "--frames", "280:");
}
#else
/* Returns the least peak of several runs. */
static long peak_of_replays(const char *model, const char *cache, int count) {
    long least = LONG_MAX;
    for (int i = 0; i < count; i++) {
        tool_run run = RUN_TOOL("replay", model, cache, "--contacts", csv.text, "--json", summary.text);
        assert_int_equal(run.code, 0);
        if (run.peak_kib < least) least = run.peak_kib;
        tool_run_free(&run);
    }
    return least;
}

static void compare_peaks(const char *model, const char *short_cache, const char *long_cache) {
    struct rusage own;
    getrusage(RUSAGE_SELF, &own);
    long at_30 = peak_of_replays(model, short_cache, 3), at_300 = peak_of_replays(model, long_cache, 3);
    print_message("peak memory: %ld KiB for 30 frames, %ld KiB for 300\n", at_30, at_300);
    assert_true(at_30 > own.ru_maxrss); /* otherwise the measurement would show the test itself */
    /* The 270 further frames hold about 9,000 KiB, and the answers about them, which are kept, about 900. The system itself
     * counts up to 600 KiB more or less of the shared libraries from run to run. */
    assert_true(at_300 <= at_30 + at_30 / 50 + 1536);
}
#endif

/* Ten times the frames need no more memory, up to what the measurement itself can tell. */
static void memory_does_not_grow_with_the_frames(void **state) {
    (void)state;
    recorded scene = recorded_fold(70, 40, 16);
    temp_path model = recorded_write_mesh(&folder, "large.obj", &scene, 0);
    temp_path short_cache = recorded_write_cycle(&folder, "short.pc2", &scene, 30);
    temp_path long_cache = recorded_write_cycle(&folder, "long.pc2", &scene, 300);
    recorded_free(&scene);
    compare_peaks(model.text, short_cache.text, long_cache.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bad_frame_keeps_the_intervals_before),
        cmocka_unit_test(a_frame_of_another_size_keeps_the_intervals_before),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(an_interrupt_keeps_what_is_written),
        cmocka_unit_test(an_interrupt_ends_a_long_call),
        cmocka_unit_test(an_interrupted_preprocess_writes_nothing),
        cmocka_unit_test(memory_does_not_grow_with_the_frames),
    };
    return cmocka_run_group_tests_name("tool_stop", tests, make_files, remove_files);
}
