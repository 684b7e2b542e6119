/* The tool's command line: usage errors, bad input, and outputs that must not overwrite anything. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static temp_path model, cache, missing;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(6);
    model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    missing = temp_file_path(&folder, "missing.obj");
    recorded_free(&scene);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static temp_path write_text(const char *name, const char *text) {
    return temp_file_write(&folder, name, text, strlen(text));
}

/* Expects exit code 0, nothing on stderr, and the text on stdout. */
static void expect_out(const char *text, const char *const *arguments) {
    tool_run run = run_tool(arguments);
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    if (strstr(run.out, text) == NULL) fail_msg("expected '%s' in: %s", text, run.out);
    tool_run_free(&run);
}

#define EXPECT_OUT(text, ...) expect_out((text), (const char *const[]){__VA_ARGS__, NULL})

static void says_its_version(void **state) {
    (void)state;
    EXPECT_OUT("cscd 2.0.0 (", "--version");
}

static void helps_on_every_command(void **state) {
    (void)state;
    static const char *const commands[] = {"preprocess", "replay", "check", "info", "render"};
    EXPECT_OUT("usage: cscd COMMAND", "--help");
    EXPECT_OUT("usage: cscd COMMAND", "help");
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        char usage[64];
        snprintf(usage, sizeof usage, "usage: cscd %s MODEL", commands[i]);
        EXPECT_OUT(usage, commands[i], "--help");
        EXPECT_OUT(usage, "help", commands[i]);
        EXPECT_OUT(commands[i], "--help");
    }
    EXPECT_ERROR(2, TEXTS("unknown command 'play'"), "help", "play");
}

static void refuses_unknown_commands_and_options(void **state) {
    (void)state;
    static const char *const commands[] = {"preprocess", "replay", "check", "info", "render"};
    run_tool_expect_error(2, TEXTS("no command given"), (const char *const[]){NULL});
    EXPECT_ERROR(2, TEXTS("unknown command 'play'", "'cscd --help'"), "play");
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        EXPECT_ERROR(2, TEXTS("unknown option '--fast'", commands[i]), commands[i], "--fast", model.text);
        EXPECT_ERROR(2, TEXTS("unknown option '-x'"), commands[i], model.text, "-xy");
        EXPECT_ERROR(2, TEXTS("--weld needs a value"), commands[i], model.text, "--weld");
        EXPECT_ERROR(2, TEXTS("--weld cannot be 'loosely'"), commands[i], "--weld=loosely", model.text);
        EXPECT_ERROR(2, TEXTS("MODEL"), commands[i]);
    }
    EXPECT_ERROR(2, TEXTS("no FRAMES given"), "replay", model.text);
    EXPECT_ERROR(2, TEXTS("no -o"), "render", model.text);
    EXPECT_ERROR(2, TEXTS("one MODEL"), "info", model.text, model.text);
}

static void refuses_unfit_values(void **state) {
    (void)state;
    static const char *const unfit[][2] = {
        {"--frames", "a:b"},       {"--frames", "3:1"},
        {"--frames", ":"},         {"--frames", ""},
        {"--frames", "1:2:0"},     {"--frames", "-:2"},
        {"--method", "icc"},       {"--mode", "some"},
        {"--threads", "-1"},       {"--threads", "257"},
        {"--threads", "two"},      {"--weld", "-1"},
        {"--weld", "0"},           {"--weld", "nan"},
        {"--contacts", "out.txt"}, {"--frames", "4294967296:"},
        {"--contacts", ".csv"},    {"--method", "kmeans:0"},
        {"--method", "kmeans:x"},  {"--start", "maybe"},
    };
    for (size_t i = 0; i < sizeof unfit / sizeof *unfit; i++)
        EXPECT_ERROR(2, TEXTS(unfit[i][0], unfit[i][1]), "replay", model.text, cache.text, unfit[i][0],
                     unfit[i][1]);
    EXPECT_ERROR(2, TEXTS("--frame cannot be 'x'"), "render", model.text, "-o", "a.png", "--frame", "x");
    EXPECT_ERROR(2, TEXTS("--colour cannot be 'red'"), "render", model.text, "-o", "a.png", "--colour=red");
    EXPECT_ERROR(2, TEXTS("--size cannot be '9x9'"), "render", model.text, "-o", "a.png", "--size", "9x9");
    EXPECT_ERROR(2, TEXTS("-o needs a value"), "render", model.text, "-o");
}

static void refuses_frames_that_are_not_there(void **state) {
    (void)state;
    static const char *const ranges[] = {"0:6", "6:", "9:12", ":6"};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        EXPECT_ERROR(1, TEXTS("frames 0 to 5"), "replay", model.text, cache.text, "--frames", ranges[i]);
    EXPECT_ERROR(1, TEXTS("an interval needs two frames"), "replay", model.text, cache.text, "--frames", "3");
    EXPECT_ERROR(1, TEXTS("an interval needs two frames"), "replay", model.text, cache.text, "--frames",
                 "5:");
    EXPECT_ERROR(1, TEXTS("an interval needs two frames"), "replay", model.text, model.text);
    EXPECT_ERROR(1, TEXTS("frames 0 to 5"), "check", model.text, cache.text, "--frames", "6");
}

static void names_missing_files(void **state) {
    (void)state;
    EXPECT_ERROR(1, TEXTS(missing.text, "No such file"), "replay", missing.text, cache.text);
    EXPECT_ERROR(1, TEXTS(missing.text, "No such file"), "replay", model.text, missing.text);
    EXPECT_ERROR(1, TEXTS("missing.pc2", "No such file"), "replay", model.text,
                 temp_file_path(&folder, "missing.pc2").text);
    EXPECT_ERROR(1, TEXTS("none_%04d.obj"), "replay", model.text,
                 temp_file_path(&folder, "none_%04d.obj").text);
    EXPECT_ERROR(1, TEXTS(missing.text, "No such file"), "check", missing.text);
    EXPECT_ERROR(1, TEXTS(missing.text, "No such file"), "info", missing.text);
    EXPECT_ERROR(1, TEXTS(missing.text, "No such file"), "render", missing.text, "-o",
                 temp_file_path(&folder, "a.png").text);
    EXPECT_ERROR(1, TEXTS("missing.list", "No such file"), "replay", model.text, cache.text, "--ignore",
                 temp_file_path(&folder, "missing.list").text);
}

static void names_the_line_of_a_malformed_mesh(void **state) {
    (void)state;
    temp_path bad = write_text("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 one 0\nf 1 2 3\n");
    EXPECT_ERROR(1, TEXTS("bad.obj:3: "), "info", bad.text);
    EXPECT_ERROR(1, TEXTS("bad.obj:3: "), "replay", bad.text, cache.text);
    temp_path outside = write_text("outside.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    EXPECT_ERROR(1, TEXTS("outside.obj:4: "), "check", outside.text);
    temp_path repeated = write_text("repeated.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n");
    EXPECT_ERROR(1, TEXTS("repeated.obj", "no faces found"), "info", repeated.text);
}

static void names_the_bytes_of_a_truncated_cache(void **state) {
    (void)state;
    size_t size;
    char *bytes = read_whole_file(cache.text, &size);
    temp_path cut = temp_file_write(&folder, "cut.pc2", bytes, size - 5);
    char found[32], expected[32];
    snprintf(found, sizeof found, "%zu", size - 5);
    snprintf(expected, sizeof expected, "%zu", size);
    EXPECT_ERROR(1, TEXTS("cut.pc2", "byte", found, expected), "replay", model.text, cut.text);
    free(bytes);
}

/* When outputs cannot be created, nothing is computed and only the error is printed. */
static void refuses_outputs_it_cannot_write(void **state) {
    (void)state;
    char nowhere[600];
    static const char *const options[] = {"--contacts", "--json"}, *const names[] = {"out.csv", "out.json"};
    for (int i = 0; i < 2; i++) {
        snprintf(nowhere, sizeof nowhere, "%s/no/such/folder/%s", folder.path, names[i]);
        tool_run run = RUN_TOOL("replay", model.text, cache.text, options[i], nowhere);
        assert_int_equal(run.code, 1);
        assert_string_equal(run.out, "");
        assert_non_null(strstr(run.error, nowhere));
        tool_run_free(&run);
    }
    EXPECT_ERROR(1, TEXTS("no/such/folder"), "check", model.text, "--json", nowhere);
    snprintf(nowhere, sizeof nowhere, "%s/no/such/folder/out.png", folder.path);
    EXPECT_ERROR(1, TEXTS("no/such/folder"), "render", model.text, "-o", nowhere);
}

static void expect_untouched(const temp_path *path, const char *bytes, size_t size) {
    size_t now_size;
    char *now = read_whole_file(path->text, &now_size);
    assert_int_equal(now_size, size);
    assert_memory_equal(now, bytes, size);
    free(now);
}

static void never_overwrites_an_input(void **state) {
    (void)state;
    size_t model_size, cache_size;
    char *model_bytes = read_whole_file(model.text, &model_size);
    char *cache_bytes = read_whole_file(cache.text, &cache_size);
    temp_path linked = temp_file_path(&folder, "linked.csv"), list = write_text("list.txt", "# no pairs\n");
    assert_int_equal(symlink(cache.text, linked.text), 0);
    char roundabout[600];
    snprintf(roundabout, sizeof roundabout, "%s/../%s/model.obj", folder.path, strrchr(folder.path, '/') + 1);

    const char *const overwrite = "would overwrite";
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", model.text, cache.text, "--json", model.text);
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", model.text, cache.text, "--json", roundabout);
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", "--json", cache.text, model.text, cache.text);
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", model.text, cache.text, "--contacts", linked.text);
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", model.text, cache.text, "--json", list.text, "--ignore",
                 list.text);
    EXPECT_ERROR(2, TEXTS(overwrite), "replay", model.text, cache.text, "--json", "same.csv", "--contacts",
                 "same.csv");
    EXPECT_ERROR(2, TEXTS(overwrite), "check", model.text, cache.text, "--json", cache.text);
    EXPECT_ERROR(2, TEXTS(overwrite), "render", model.text, cache.text, "-o", cache.text);
    EXPECT_ERROR(2, TEXTS("named like"), "replay", model.text, cache.text, "--json", missing.text);

    expect_untouched(&model, model_bytes, model_size);
    expect_untouched(&cache, cache_bytes, cache_size);
    free(model_bytes);
    free(cache_bytes);
}

/* The line of contacts behind "; from frame ", of a recording that goes there and back for so many frames. */
static void find_ranges(uint32_t frame_count, char line[1000]) {
    recorded scene = recorded_tetrahedra(6);
    const temp_path cycle = recorded_write_cycle(&folder, "cycle.pc2", &scene, frame_count);
    recorded_free(&scene);
    tool_run run = RUN_TOOL("replay", model.text, cycle.text);
    const char *ranges = strstr(run.out, "; from frame ");
    assert_non_null(ranges);
    snprintf(line, 1000, "%.*s", (int)strcspn(ranges, "\n"), ranges);
    tool_run_free(&run);
}

static size_t count_commas(const char *line) {
    size_t count = 0;
    for (; *line != '\0'; line++) count += *line == ',';
    return count;
}

static void names_the_first_ranges_of_a_long_recording(void **state) {
    (void)state;
    char line[1000];
    find_ranges(31, line);
    assert_true(count_commas(line) < 19 && strstr(line, "others") == NULL);
    find_ranges(1001, line);
    assert_int_equal(count_commas(line), 19);
    assert_string_equal(line + strlen(line) - strlen(" and others"), " and others");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(says_its_version),
        cmocka_unit_test(helps_on_every_command),
        cmocka_unit_test(refuses_unknown_commands_and_options),
        cmocka_unit_test(refuses_unfit_values),
        cmocka_unit_test(refuses_frames_that_are_not_there),
        cmocka_unit_test(names_missing_files),
        cmocka_unit_test(names_the_line_of_a_malformed_mesh),
        cmocka_unit_test(names_the_bytes_of_a_truncated_cache),
        cmocka_unit_test(refuses_outputs_it_cannot_write),
        cmocka_unit_test(never_overwrites_an_input),
        cmocka_unit_test(names_the_first_ranges_of_a_long_recording),
    };
    return cmocka_run_group_tests_name("tool", tests, make_files, remove_files);
}
