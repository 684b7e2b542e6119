/* What a replay reads, and when: of a large recording its own frames only, and files that come late. */
#include "tests/support/own_folder.h"
#include "tests/support/page_cache.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

/* ---- a large recording ----------------------------------------------------------------------------------- */

/* A point cache of 100 GB that takes no room: all frames are holes but those of one shard of 32 intervals. */
enum { CHUNK = 32, HEADER = 32 };
enum { ROOM_KIB = 80 * 1024 }; /* what a sanitizer keeps of memory that was freed */
static const unsigned long long whole_size = 100ull * 1000 * 1000 * 1000;

typedef struct large_recording {
    temp_path mesh, small, large;
    unsigned long long frame_size, chunks;
    unsigned long long small_size; /* of the mesh and the small cache together */
} large_recording;

static unsigned long long file_size(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (unsigned long long)status.st_size;
}

/* The head of the small one with another count, its frames from frame `place` on, and holes. */
static void write_large(const large_recording *r, unsigned long long samples, unsigned long long place) {
    size_t size;
    char *bytes = read_whole_file(r->small.text, &size);
    for (int i = 0; i < 4; i++) bytes[HEADER - 4 + i] = (char)(samples >> 8 * i);
    FILE *file = fopen(r->large.text, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, HEADER, file), HEADER);
    assert_int_equal(fseeko(file, (off_t)(HEADER + place * r->frame_size), SEEK_SET), 0);
    assert_int_equal(fwrite(bytes + HEADER, 1, size - HEADER, file), size - HEADER);
    fclose(file);
    assert_int_equal(truncate(r->large.text, (off_t)(HEADER + samples * r->frame_size)), 0);
    free(bytes);
}

static large_recording make_large(void) {
    recorded scene = recorded_fold(120, 80, CHUNK + 1);
    large_recording r = {.mesh = recorded_write_mesh(&folder, "wide.obj", &scene, 0),
                         .small = recorded_write_cache(&folder, "small.pc2", &scene),
                         .large = temp_file_path(&folder, "large.pc2"),
                         .frame_size = scene.vertex_count * 12ull};
    recorded_free(&scene);
    r.chunks = (whole_size / r.frame_size - 1) / CHUNK;
    r.small_size = file_size(r.mesh.text) + file_size(r.small.text);
    write_large(&r, r.chunks * CHUNK + 1, r.chunks / 2 * CHUNK);
    return r;
}

/* The bytes that a command reads: Linux counts them, those of ended children too. */
static unsigned long long bytes_read(const char *arguments) {
    char *found = shell_output(
        0, "test -r /proc/self/io || exit 0; \"$CSCD_TOOL\" %s && sed -n 's/rchar: //p' /proc/$$/io",
        arguments);
    const unsigned long long bytes = strtoull(found, NULL, 10);
    free(found);
    return bytes;
}

static void a_shard_of_100_gb_reads_its_own_frames(void **state) {
    char arguments[2000];
    const large_recording r = make_large();
    (void)state;
    snprintf(arguments, sizeof arguments, "replay '%s' '%s' --quiet --no-depths --results '%s/small.shard'",
             r.mesh.text, r.small.text, folder.path);
    const unsigned long long least = bytes_read(arguments);
    snprintf(arguments, sizeof arguments,
             "replay '%s' '%s' --quiet --no-depths --shard %llu/%llu --results '%s/large.shard'", r.mesh.text,
             r.large.text, r.chunks / 2 + 1, r.chunks, folder.path);
    const unsigned long long most = bytes_read(arguments);
    if (least == 0) skip();                                                /* nobody counts here */
    assert_in_range(least, r.small_size, r.small_size + 2 * r.frame_size); /* each frame once */
    assert_in_range(most, (CHUNK + 1) * r.frame_size, least + r.frame_size / 2);
}

static void its_memory_is_that_of_an_interval(void **state) {
    char shard[64];
    const large_recording r = make_large();
    (void)state;
    snprintf(shard, sizeof shard, "%llu/%llu", r.chunks / 2 + 1, r.chunks);
    temp_path results = temp_file_path(&folder, "memory.shard");
    tool_run small = RUN_TOOL("replay", r.mesh.text, r.small.text, "--quiet", "--no-depths");
    tool_run large = RUN_TOOL("replay", r.mesh.text, r.large.text, "--quiet", "--no-depths", "--shard", shard,
                              "--results", results.text);
    assert_int_equal(small.code, 0);
    assert_int_equal(large.code, 0);
    const long numbers = (long)(r.chunks * CHUNK * 4 / 1024); /* a frame's number takes 4 bytes */
    assert_in_range(large.peak_kib, 0, small.peak_kib + numbers + ROOM_KIB);
    tool_run_free(&small);
    tool_run_free(&large);
}

/* Sixteen times as many frames need no more memory: they would take half as much again as the room that a sanitizer gets. */
static void frames_are_not_kept(void **state) {
    recorded scene = recorded_fold(120, 80, 1);
    const temp_path mesh = recorded_write_mesh(&folder, "kept.obj", &scene, 0),
                    few = recorded_write_cycle(&folder, "few.pc2", &scene, CHUNK + 1),
                    many = recorded_write_cycle(&folder, "many.pc2", &scene, 16 * CHUNK + 1);
    recorded_free(&scene);
    (void)state;
    tool_run small = RUN_TOOL("replay", mesh.text, few.text, "--quiet", "--no-check");
    tool_run large = RUN_TOOL("replay", mesh.text, many.text, "--quiet", "--no-check");
    assert_int_equal(small.code, 0);
    assert_int_equal(large.code, 0);
    assert_in_range(large.peak_kib, 0, small.peak_kib + ROOM_KIB);
    tool_run_free(&small);
    tool_run_free(&large);
}

/* ---- a cold disk ----------------------------------------------------------------------------------------- */

/* Stops at a frame that is no mesh: the one behind it was asked of the disk before. */
static void the_disk_brings_the_next_frame(void **state) {
    (void)state;
    recorded scene = recorded_fold(60, 40, 6);
    const temp_path pattern = recorded_write_sequence(&folder, "cold_%04d.obj", &scene),
                    model = temp_file_path(&folder, "cold_0000.obj"),
                    next = temp_file_path(&folder, "cold_0004.obj");
    recorded_free(&scene);
    shell("echo nothing >'%s/cold_0003.obj'", folder.path);
    const bool dropped = page_cache_drop(next.text);
    EXPECT_ERROR(1, TEXTS("cold_0003.obj"), "replay", model.text, pattern.text, "--quiet");
    if (!dropped) skip();
    page_cache_expect(next.text);
}

/* No frame is brought that this machine does not need. */
static void the_disk_brings_no_frame_of_others(void **state) {
    (void)state;
    recorded scene = recorded_fold(60, 40, 6);
    const temp_path pattern = recorded_write_sequence(&folder, "own_%04d.obj", &scene),
                    model = temp_file_path(&folder, "own_0000.obj"),
                    behind = temp_file_path(&folder, "own_0004.obj");
    recorded_free(&scene);
    const bool dropped = page_cache_drop(behind.text);
    EXPECT_TOOL(0, "replay", model.text, pattern.text, "--quiet", "--frames", "0:3");
    if (!dropped) skip();
    assert_int_equal(page_cache_count(behind.text), 0);
}

/* ---- late files ------------------------------------------------------------------------------------------ */

static temp_path make_series(void) {
    recorded scene = recorded_tetrahedra(6);
    temp_path pattern = recorded_write_sequence(&folder, "late_%04d.obj", &scene);
    recorded_free(&scene);
    return pattern;
}

static char *with_late_frame(int code, const char *options) {
    const temp_path pattern = make_series();
    return shell_output(
        code,
        "cd '%s' && mv late_0003.obj hidden && { sleep 2; mv hidden late_0003.obj; } >/dev/null 2>&1 & "
        "sleep 0.2; \"$CSCD_TOOL\" replay '%s/late_0000.obj' '%s' --quiet --contacts - %s 2>&1; "
        "code=$?; wait; exit $code",
        folder.path, folder.path, pattern.text, options);
}

static void a_frame_that_comes_late_is_waited_for(void **state) {
    (void)state;
    const temp_path pattern = make_series();
    char *expected = shell_output(0, "\"$CSCD_TOOL\" replay '%s/late_0000.obj' '%s' --quiet --contacts -",
                                  folder.path, pattern.text);
    char *found = with_late_frame(0, "--wait-for-files 60");
    assert_string_equal(found, expected);
    free(found);
    free(expected);
}

/* Waiting for each of the files would take an hour. */
static void what_is_there_is_not_waited_for(void **state) {
    (void)state;
    const temp_path pattern = make_series();
    shell("timeout 60 \"$CSCD_TOOL\" replay '%s/late_0000.obj' '%s' --quiet --wait-for-files 600",
          folder.path, pattern.text);
}

/* While the main thread waits for the frame, whose file is still empty, another one tries to read it. */
static void frames_are_read_on_a_thread_of_their_own(void **state) {
    (void)state;
    const temp_path pattern = make_series();
    shell("cp '%s/late_0003.obj' '%s/hidden' && : >'%s/late_0003.obj'", folder.path, folder.path,
          folder.path);
    char model[600];
    snprintf(model, sizeof model, "%s/late_0000.obj", folder.path);
    tool_process process = run_tool_start((const char *const[]){
        "replay", model, pattern.text, "--quiet", "--threads", "1", "--wait-for-files", "60", NULL});
    char *found =
        shell_output(0,
                     "cd /proc/%d/task || exit 0; for i in $(seq 400); do test $(ls | wc -l) -ge 2 && break; "
                     "sleep 0.05; done; ls | wc -l",
                     (int)process.pid);
    shell("mv '%s/hidden' '%s/late_0003.obj'", folder.path, folder.path);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 0);
    tool_run_free(&run);
    if (strtol(found, NULL, 10) == 1) fail_msg("one thread does all");
    free(found);
}

static void without_waiting_it_is_an_error(void **state) {
    (void)state;
    char *found = with_late_frame(1, "");
    assert_non_null(strstr(found, "late_0003"));
    free(found);
    found = with_late_frame(1, "--wait-for-files 0.3");
    assert_non_null(strstr(found, "late_0003"));
    free(found);
}

static void a_model_that_comes_late_is_waited_for(void **state) {
    (void)state;
    make_series();
    free(shell_output(
        0,
        "cd '%s' && mv late_0000.obj hidden && { sleep 1; mv hidden late_0000.obj; } >/dev/null 2>&1 & "
        "sleep 0.2; \"$CSCD_TOOL\" check '%s/late_0000.obj' --quiet --wait-for-files 60; code=$?; wait; "
        "exit $code",
        folder.path, folder.path));
}

/* Signals ever later, until the program has come so far that it waits. One that comes before it catches signals ends it, also where
 * whoever runs the tests ignores them. */
static void expect_stopped_wait(const char *command, const char *text) {
    const temp_path pattern = make_series(), model = temp_file_path(&folder, "late_0000.obj");
    shell(": >'%s/late_0003.obj'", folder.path); /* it is there, and its content comes late */
    void (*before)(int) = signal(SIGINT, SIG_DFL);
    for (unsigned wait = 50 * 1000;; wait *= 2) {
        tool_process process = run_tool_start(
            (const char *const[]){command, model.text, pattern.text, "--wait-for-files", "60", NULL});
        usleep(wait);
        kill(process.pid, SIGINT);
        tool_run run = run_tool_finish(&process);
        const bool waited = run.code == 128 + SIGINT && strstr(run.error, text) != NULL;
        if (!waited && (wait > 5 * 1000 * 1000 || run.code != 128 + SIGINT))
            fail_msg("%s ended with %d: %s", command, run.code, run.error);
        tool_run_free(&run);
        if (waited) break;
    }
    signal(SIGINT, before);
}

static void an_interrupt_ends_the_wait(void **state) {
    (void)state;
    expect_stopped_wait("replay", "interrupted after 2 of 5 intervals");
    expect_stopped_wait("check", "interrupted after 3 of 6 frames");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shard_of_100_gb_reads_its_own_frames),
        cmocka_unit_test(its_memory_is_that_of_an_interval),
        cmocka_unit_test(frames_are_not_kept),
        cmocka_unit_test(the_disk_brings_the_next_frame),
        cmocka_unit_test(the_disk_brings_no_frame_of_others),
        cmocka_unit_test(a_frame_that_comes_late_is_waited_for),
        cmocka_unit_test(what_is_there_is_not_waited_for),
        cmocka_unit_test(frames_are_read_on_a_thread_of_their_own),
        cmocka_unit_test(without_waiting_it_is_an_error),
        cmocka_unit_test(a_model_that_comes_late_is_waited_for),
        cmocka_unit_test(an_interrupt_ends_the_wait),
    };
    return cmocka_run_group_tests(tests, own_folder_make, own_folder_remove);
}
