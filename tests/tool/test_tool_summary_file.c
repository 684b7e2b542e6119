/* The summaries that the tool's report reads back: what is none of them is named. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static temp_folder folder;
static temp_path model, cache, page, summary;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(8);
    model = recorded_write_mesh(&folder, "model.obj", &scene, 0);
    cache = recorded_write_cache(&folder, "frames.pc2", &scene);
    recorded_free(&scene);
    page = temp_file_path(&folder, "page.html");
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

static void what_is_no_summary_is_named(void **state) {
    (void)state;
    static const struct {
        const char *text, *reasons[3];
    } cases[] = {
        {"", {"other.json:1", "ends too early", NULL}},
        {"{\"intervals\":[\n{\"frame\":0", {"other.json:2", "ends too early", NULL}},
        {"{\"intervals\":[\n{\"frame\":zero}]}", {"other.json:2", NULL}},
        {"{\"intervals\":[],\n\"a\":\"\xff\"}", {"other.json:2", "utf-8", NULL}},
        {"[]", {"the file has no member 'intervals'", "cscd replay --json", NULL}},
        {"{\"intervals\":7}", {"the file: 'intervals' is not what cscd writes", NULL}},
        {"{\"intervals\":[{\"frame\":0}],\"frames\":[],\"summary\":{},\"provenance\":{}}",
         {"interval 0 of the file has no member 'vf'", NULL}},
        {"{\"intervals\":[],\"frames\":[],\"summary\":{},\"provenance\":{}}",
         {"the summary has no member", NULL}},
        {"{} {}", {"other.json:1", "unexpected character", NULL}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temp_path path = temp_file_write(&folder, "other.json", cases[i].text, strlen(cases[i].text));
        remove(page.text);
        EXPECT_ERROR(1, cases[i].reasons, "report", path.text, "-o", page.text);
        assert_false(file_exists(page.text));
    }
    EXPECT_ERROR(1, TEXTS("nowhere.json", "No such file"), "report", "nowhere.json", "-o", page.text);
}

/* Writes a correct summary with one part of it replaced. */
static void a_changed_summary_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *part, *instead, *reasons[2];
    } cases[] = {
        {"\"frame\":3", "\"frame\":2", {"interval 3 of the file: 'frame'", NULL}},
        {"\"frame\":0", "\"frame\":-2147483649", {"interval 0 of the file: 'frame'", NULL}},
        {"\"frame\":0", "\"frame\":1e300", {"interval 0 of the file: 'frame'", NULL}},
        {"\"frame\":0", "\"frame\":2147483648", {"interval 0 of the file: 'frame'", NULL}},
        {"\"state\":\"clean\"", "\"state\":\"tidy\"", {"'state' is not what cscd writes there", NULL}},
        {"\"processors\"", "\"possessors\"", {"the machine has no member 'processors'", NULL}},
        {"\"release\":", "\"release\":7,\"was\":", {"the machine: 'release' is not", NULL}},
        {"\"source\"", "\"sauce\"", {"the plan has no member 'source'", NULL}},
        {"\"complete\":true", "\"complete\":false", {"the summary has no member 'stopped_by'", NULL}},
        {"\"events\":[",
         "\"events\":7,\"were\":[",
         {"the file: 'events' is not what cscd writes there", NULL}},
        {"\"unit\":null", "\"unit\":7", {"the file: 'unit' is not what cscd writes there", NULL}},
        {"\"worst\":", "\"worst\":1234", {"event 0 of the file: its frames are not", NULL}},
        {"\"worst\":", "\"worse\":", {"event 0 of the file has no member 'worst'", NULL}},
        {"\"kinds\":[", "\"kinds\":[7,", {"event 0 of the file: its kinds are not", NULL}},
        {"\"point\":[", "\"point\":[1,", {"event 0 of the file: the coordinates are not", NULL}},
        {"\"point\":[",
         "\"point\":[null,null,null],\"place\":[",
         {"event 0 of the file: the coordinates are not", NULL}},
        {"\"object\":", "\"object\":7,\"body\":", {"event 0 of the file: 'object' is not", NULL}},
    };
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text);
    char *text = read_whole_file(summary.text, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *place = strstr(text, cases[i].part);
        assert_non_null(place);
        char *changed = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&changed, &size);
        assert_non_null(out);
        fprintf(out, "%.*s%s%s", (int)(place - text), text, cases[i].instead, place + strlen(cases[i].part));
        assert_int_equal(fclose(out), 0);
        temp_path path = temp_file_write(&folder, "changed.json", changed, size);
        free(changed);
        EXPECT_ERROR(1, cases[i].reasons, "report", path.text, "-o", page.text);
    }
    free(text);
}

/* An older version wrote a summary without events: the page says so. */
static void a_summary_without_events_is_read(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text);
    char *text = read_whole_file(summary.text, NULL), *place = strstr(text, "\"events\":");
    assert_non_null(place);
    memcpy(place, "\"remark\":", strlen("\"remark\":"));
    temp_path path = temp_file_write(&folder, "changed.json", text, strlen(text));
    free(text);
    remove(page.text);
    EXPECT_TOOL(0, "report", path.text, "-o", page.text);
    assert_true(file_exists(page.text));
}

/* Version 1 wrote an object for each component, and now there is one for each group of components. */
static void guarantees_of_version_1_are_read(void **state) {
    (void)state;
    static const struct {
        const char *part, *instead;
        int code;
    } cases[] = {{"\"count\":", "\"component\":", 0}, {"\"count\":", "\"number\":", 1}};
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--json", summary.text);
    char *text = read_whole_file(summary.text, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *place = strstr(text, cases[i].part);
        assert_non_null(place);
        char *changed = NULL;
        const int size = asprintf(&changed, "%.*s%s%s", (int)(place - text), text, cases[i].instead,
                                  place + strlen(cases[i].part));
        temp_path path = temp_file_write(&folder, "changed.json", changed, (size_t)size);
        free(changed);
        tool_run run = RUN_TOOL("report", path.text, "-o", page.text);
        assert_int_equal(run.code, cases[i].code);
        if (run.code != 0) assert_non_null(strstr(run.error, "interval 0 of the file has no member 'count'"));
        tool_run_free(&run);
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_summary_is_named),
        cmocka_unit_test(a_changed_summary_is_refused),
        cmocka_unit_test(a_summary_without_events_is_read),
        cmocka_unit_test(guarantees_of_version_1_are_read),
    };
    return cmocka_run_group_tests_name("tool_summary_file", tests, make_files, remove_files);
}
