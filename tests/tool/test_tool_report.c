/* The tool's reports: what the page contains, what is refused, and what remains when a report cannot be
 * written. */
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static temp_folder folder;
static temp_path model, cache, page, csv, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(8);
    model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    recorded_free(&scene);
    page = temp_file_path(&folder, "page.html");
    csv = temp_file_path(&folder, "out.csv");
    summary = temp_file_path(&folder, "out.json");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static bool file_exists(const char *path) {
    struct stat status;
    return lstat(path, &status) == 0;
}

/* Returns the page's block of JSON. */
static json_node *read_page(const char *path) {
    static const char begin[] = "<script type=\"application/json\" id=\"cscd-report\">";
    char *text = read_whole_file(path, NULL), *block = strstr(text, begin);
    assert_non_null(block);
    block += sizeof begin - 1;
    char *end = strstr(block, "</script>");
    assert_non_null(end);
    size_t at = 0;
    json_node *root = json_node_parse(block, (size_t)(end - block), &at);
    assert_non_null(root);
    free(text);
    return root;
}

static const json_node *first_summary(const json_node *root) {
    return json_node_member(json_node_item(json_node_member(root, "summaries"), 0), "summary");
}

/* Expects the same kinds, names and values in the same order. */
static void expect_same(const json_node *a, const json_node *b) {
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->count, b->count);
    assert_true(a->boolean == b->boolean && a->number == b->number);
    if (a->text != NULL) assert_string_equal(a->text, b->text);
    for (const json_node *i = a->first, *j = b->first; i != NULL; i = i->next, j = j->next) {
        if (i->key != NULL) assert_string_equal(i->key, j->key);
        expect_same(i, j);
    }
}

static void the_page_of_a_replay_has_its_summary(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text, "--report", page.text, "--up",
                "y");
    json_node *root = read_page(page.text), *own = json_node_read_file(summary.text);
    assert_string_equal(json_node_string(root, "kind"), "replay");
    assert_string_equal(json_node_string(root, "title"), "model.obj");
    expect_same(first_summary(root), own);
    const json_node *scene = json_node_member(root, "scene");
    assert_string_equal(json_node_string(scene, "up"), "y");
    assert_true(json_node_number(scene, "vertices") == 8 && json_node_number(scene, "triangles") == 8);
    assert_true(json_node_number(scene, "first") == 0 && json_node_number(scene, "last") == 7);
    assert_int_equal(json_node_member(scene, "frames")->count, 8);
    assert_true(json_node_number(scene, "relative_error") < 1e-4);
    double found = json_node_number(json_node_member(scene, "contacts"), "found");
    const json_node *total = json_node_member(own, "summary");
    assert_true(found > 0 && found == json_node_number(total, "vf") + json_node_number(total, "ee"));
    json_node_free(root);
    json_node_free(own);
}

static void the_page_of_a_plan_has_charge_and_timings(void **state) {
    (void)state;
    temp_path plan = temp_file_path(&folder, "page.plan.ply");
    tool_run run = RUN_TOOL("preprocess", model.text, "-o", plan.text, "--report", page.text);
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, page.text));
    tool_run_free(&run);
    json_node *root = read_page(page.text);
    assert_string_equal(json_node_string(root, "kind"), "preprocess");
    const json_node *scene = json_node_member(root, "scene"), *shown = json_node_member(scene, "plan");
    assert_string_equal(json_node_string(shown, "method"), "charge");
    assert_int_equal(json_node_member(shown, "capacitances")->count, 2);
    const json_node *origin = json_node_member(root, "preprocess");
    assert_true(json_node_number(json_node_member(origin, "timings"), "total_ms") > 0.0);
    assert_int_equal(json_node_member(json_node_member(origin, "provenance"), "arguments")->count, 6);
    json_node_free(root);
}

static void summaries_stand_side_by_side(void **state) {
    (void)state;
    temp_path other = temp_file_path(&folder, "other.json");
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text);
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", other.text, "--method", "none");
    EXPECT_TOOL(0, "report", summary.text, other.text, "-o", page.text);
    json_node *root = read_page(page.text), *own = json_node_read_file(other.text);
    const json_node *summaries = json_node_member(root, "summaries");
    assert_string_equal(json_node_string(root, "kind"), "compare");
    assert_int_equal(summaries->count, 2);
    assert_string_equal(json_node_string(json_node_item(summaries, 0), "name"), summary.text);
    expect_same(json_node_member(json_node_item(summaries, 1), "summary"), own);
    json_node_free(root);
    json_node_free(own);
}

static void options_that_do_not_fit_are_refused(void **state) {
    (void)state;
    EXPECT_ERROR(2, TEXTS("--report OUT.html"), "replay", model.text, cache.text, "--scenery", model.text);
    EXPECT_ERROR(2, TEXTS("--scenery MODEL"), "replay", model.text, cache.text, "--report", page.text,
                 "--scenery-frames", cache.text);
    EXPECT_ERROR(2, TEXTS("--up cannot be 'x'"), "replay", model.text, cache.text, "--up", "x");
    EXPECT_ERROR(2, TEXTS("would overwrite"), "replay", model.text, cache.text, "--report", model.text);
    EXPECT_ERROR(2, TEXTS("would overwrite"), "replay", model.text, cache.text, "--report", page.text,
                 "--json", page.text);
    EXPECT_ERROR(2, TEXTS("named like a mesh"), "preprocess", model.text, "--report", "page.ply");
    EXPECT_ERROR(2, TEXTS("no summary"), "report", "-o", page.text);
    EXPECT_ERROR(2, TEXTS("no -o OUT.html"), "report", summary.text);
    EXPECT_ERROR(2, TEXTS("would overwrite"), "report", summary.text, "-o", summary.text);
}

static void an_unwritable_report_loses_nothing_else(void **state) {
    (void)state;
    temp_path full = temp_file_path(&folder, "full.html");
    assert_int_equal(symlink("/dev/full", full.text), 0);
    remove(csv.text);
    remove(summary.text);
    tool_run run = RUN_TOOL("replay", model.text, cache.text, "--contacts", csv.text, "--json", summary.text,
                            "--report", full.text);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "no report was written"));
    assert_non_null(strstr(run.error, "No space left"));
    assert_non_null(strstr(run.out, "contacts: "));
    tool_run_free(&run);
    json_node *root = json_node_read_file(summary.text);
    assert_true(json_node_boolean(json_node_member(root, "summary"), "complete"));
    json_node_free(root);
    assert_true(file_exists(csv.text));
    temp_path nowhere = temp_file_path(&folder, "nowhere/page.html");
    remove(csv.text);
    EXPECT_ERROR(1, TEXTS("nowhere/page.html", "No such file"), "replay", model.text, cache.text,
                 "--contacts", csv.text, "--report", nowhere.text);
    assert_false(file_exists(csv.text)); /* refused before anything is truncated */
}

static bool is_link(const char *path) {
    struct stat status;
    return lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
}

/* Links to files that do not exist yet stay links, and the outputs are at their targets. */
static void outputs_are_where_links_lead(void **state) {
    (void)state;
    static const char *const names[] = {"led.html", "led.json", "led.csv"};
    static const char *const link_names[] = {"link.html", "link.json", "link.csv"};
    temp_path links[3], targets[3];
    for (int i = 0; i < 3; i++) {
        links[i] = temp_file_path(&folder, link_names[i]);
        targets[i] = temp_file_path(&folder, names[i]);
        assert_int_equal(symlink(names[i], links[i].text), 0);
    }
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--report", links[0].text, "--json", links[1].text,
                "--contacts", links[2].text);
    struct stat status;
    for (int i = 0; i < 3; i++) {
        assert_true(is_link(links[i].text));
        assert_int_equal(lstat(targets[i].text, &status), 0);
        assert_true(S_ISREG(status.st_mode) && status.st_size > 0);
    }
    json_node_free(read_page(targets[0].text));
    json_node_free(json_node_read_file(targets[1].text));
}

/* The reader of a pipe gets the whole page: nothing opens and closes the pipe before. */
static void a_pipe_gets_the_page(void **state) {
    (void)state;
    temp_path pipe = temp_file_path(&folder, "pipe.html");
    assert_int_equal(mkfifo(pipe.text, 0600), 0);
    tool_process process = run_tool_start(
        (const char *const[]){"replay", model.text, cache.text, "--report", pipe.text, "--quiet", NULL});
    FILE *in = fopen(pipe.text, "rb"), *out = fopen(page.text, "wb"); /* waits for the first writer */
    assert_true(in != NULL && out != NULL);
    char buffer[4096];
    for (size_t count; (count = fread(buffer, 1, sizeof buffer, in)) > 0;)
        assert_int_equal(fwrite(buffer, 1, count, out), count);
    if (ftell(out) == 0) kill(process.pid, SIGKILL); /* it would wait for another reader */
    fclose(in);
    assert_int_equal(fclose(out), 0);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 0);
    tool_run_free(&run);
    json_node_free(read_page(page.text));
}

/* Writes a recording whose first coordinate in a frame is infinite. */
static temp_path write_spoilt(uint32_t frame) {
    recorded scene = recorded_tetrahedra(8);
    temp_path spoilt = recorded_write_cache(&folder, "spoilt.pc2", &scene);
    FILE *file = fopen(spoilt.text, "r+b");
    static const float infinite = (float)1e39;
    assert_non_null(file);
    assert_int_equal(fseek(file, 32 + (long)frame * 8 * 12, SEEK_SET), 0);
    assert_int_equal(fwrite(&infinite, sizeof infinite, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    recorded_free(&scene);
    return spoilt;
}

static void a_replay_that_stops_reports_what_it_has(void **state) {
    (void)state;
    temp_path spoilt = write_spoilt(5);
    EXPECT_ERROR(1, TEXTS("frame 5"), "replay", model.text, spoilt.text, "--report", page.text);
    json_node *root = read_page(page.text);
    const json_node *total = json_node_member(first_summary(root), "summary");
    assert_non_null(strstr(json_node_string(total, "stopped_by"), "frame 5"));
    assert_true(json_node_number(json_node_member(root, "scene"), "last") == 4);
    assert_int_equal(json_node_member(json_node_member(root, "scene"), "frames")->count, 5);
    json_node_free(root);
}

static void a_replay_without_an_interval_says_that_it_reports_nothing(void **state) {
    (void)state;
    temp_path spoilt = write_spoilt(1);
    remove(page.text);
    EXPECT_ERROR(1, TEXTS("frame 1", "; no report was written"), "replay", model.text, spoilt.text,
                 "--report", page.text);
    assert_false(file_exists(page.text));
}

/* Has a file so many bytes that lies beside its place until it is whole? */
static bool an_output_has(off_t size) {
    char pattern[300];
    glob_t found;
    bool has = false;
    snprintf(pattern, sizeof pattern, "%s/.cscd-output-*", folder.path);
    if (glob(pattern, 0, NULL, &found) == 0) {
        for (size_t i = 0; i < found.gl_pathc; i++) {
            struct stat status;
            has |= stat(found.gl_pathv[i], &status) == 0 && status.st_size >= size;
        }
    }
    globfree(&found);
    return has;
}

static void an_interrupted_replay_reports_what_it_has(void **state) {
    (void)state;
    recorded scene = recorded_fold(30, 20, 2);
    temp_path sheet = recorded_write_mesh(&folder, "sheet.obj", &scene, 0);
    temp_path cycle = recorded_write_cycle(&folder, "sheet.pc2", &scene, 5000);
    recorded_free(&scene);
    remove(summary.text);
    tool_process process =
        run_tool_start((const char *const[]){"replay", sheet.text, cycle.text, "--method", "brute", "--json",
                                             summary.text, "--report", page.text, NULL});
    for (int i = 0; i < 60000 && !an_output_has(800); i++) usleep(2000);
    kill(process.pid, SIGINT);
    tool_run run = run_tool_finish(&process);
    assert_int_equal(run.code, 130);
    tool_run_free(&run);
    json_node *root = read_page(page.text);
    size_t done = json_node_member(first_summary(root), "intervals")->count;
    assert_true(done >= 1 && done < 4999);
    assert_true(json_node_number(json_node_member(root, "scene"), "last") == (double)done);
    json_node_free(root);
}

/* Names are text in the page, whatever they contain. */
static void names_are_never_markup(void **state) {
    (void)state;
    recorded scene = recorded_tetrahedra(3);
    const char *name = "a<img src=x onerror=alert(1)>&\"'<!--<script>.obj";
    temp_path odd = recorded_write_mesh(&folder, name, &scene, 0);
    recorded_free(&scene);
    EXPECT_TOOL(0, "replay", odd.text, cache.text, "--frames", "0:2", "--report", page.text);
    json_node *root = read_page(page.text);
    assert_string_equal(json_node_string(root, "title"), name);
    json_node_free(root);
    char *text = read_whole_file(page.text, NULL);
    assert_null(strstr(text, "<img src=x"));
    assert_null(strstr(text, "<!--<script>"));
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_of_a_replay_has_its_summary),
        cmocka_unit_test(the_page_of_a_plan_has_charge_and_timings),
        cmocka_unit_test(summaries_stand_side_by_side),
        cmocka_unit_test(options_that_do_not_fit_are_refused),
        cmocka_unit_test(an_unwritable_report_loses_nothing_else),
        cmocka_unit_test(outputs_are_where_links_lead),
        cmocka_unit_test(a_pipe_gets_the_page),
        cmocka_unit_test(a_replay_that_stops_reports_what_it_has),
        cmocka_unit_test(a_replay_without_an_interval_says_that_it_reports_nothing),
        cmocka_unit_test(an_interrupted_replay_reports_what_it_has),
        cmocka_unit_test(names_are_never_markup),
    };
    return cmocka_run_group_tests_name("tool_report", tests, make_files, remove_files);
}
