/* `cscd report` of results of jobs: what the page holds is read back, and a night that is not done has its page, too. */
#include "src/tool/report/page_link.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { JOBS = 7, CLEAN = 0, CROSSING = 1, FAILED = 5, MISSING = 6 };

static temp_folder folder;
static temp_path list, shards[2], page_path, summary;

/* Jobs 1, 4 and 7 are clean, 2 and 5 cross, 3 and 6 fail. */
static void write_list(void) {
    static const char *const models[] = {"clean.obj", "crossing.obj", "none.obj"};
    char text[JOBS * 700];
    size_t used = 0;
    for (int i = 0; i < JOBS; i++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "{\"model\": \"%s/%s\", \"name\": \"</script> '%d\"}\n", folder.path,
                                 models[i % 3], i + 1);
    list = temp_file_write(&folder, "jobs.jsonl", text, used);
}

static void run_shard(int index) {
    char shard[8];
    snprintf(shard, sizeof shard, "%d/2", index);
    remove(shards[index - 1].text);
    EXPECT_TOOL(1, "check", "--list", list.text, "--results", shards[index - 1].text, "--shard", shard,
                "--fail-on", "crossing", "--quiet");
}

static int make_files(void **state) {
    static const char square[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
    static const char crossing[] =
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";
    (void)state;
    folder = temp_folder_make();
    temp_file_write(&folder, "clean.obj", square, strlen(square));
    temp_file_write(&folder, "crossing.obj", crossing, strlen(crossing));
    write_list();
    shards[0] = temp_file_path(&folder, "shard-1.jsonl");
    shards[1] = temp_file_path(&folder, "shard-2.jsonl");
    page_path = temp_file_path(&folder, "night.html");
    run_shard(1);
    run_shard(2);
    recorded fold = recorded_fold(8, 6, 3);
    temp_path model = recorded_write_mesh(&folder, "fold.obj", &fold, 0);
    temp_path frames = recorded_write_cache(&folder, "fold.pc2", &fold);
    recorded_free(&fold);
    summary = temp_file_path(&folder, "fold.json");
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--json", summary.text, "--quiet");
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- reading the page -------------------------------------------------------------------------------------------- */

static page_bytes unpack_array(const page *p, const char *name) {
    char mark[128];
    snprintf(mark, sizeof mark, "id=\"cscd-array-%s\">", name);
    const char *begin = strstr(p->text, mark);
    if (begin == NULL) fail_msg("the page has no array %s", name);
    begin += strlen(mark);
    return page_unpack(begin, (size_t)(strchr(begin, '<') - begin));
}

static bool has_array(const page *p, const char *name) {
    char mark[128];
    snprintf(mark, sizeof mark, "id=\"cscd-array-%s\">", name);
    return strstr(p->text, mark) != NULL;
}

static page read_page(void) {
    page p = {.text = read_whole_file(page_path.text, NULL)};
    static const char mark[] = "<script type=\"application/json\" id=\"cscd-report\">";
    const char *begin = strstr(p.text, mark);
    assert_non_null(begin);
    begin += strlen(mark);
    size_t at;
    p.json = json_node_parse(begin, (size_t)(strchr(begin, '<') - begin), &at);
    assert_non_null(p.json);
    return p;
}

/* Texts end with a 0 each. */
static void expect_texts(const page *p, const char *name, const char *const *expected, size_t count) {
    page_bytes bytes = unpack_array(p, name);
    const char *text = (const char *)bytes.data;
    for (size_t i = 0; i < count; i++, text += strlen(text) + 1) {
        assert_true(text < (const char *)bytes.data + bytes.size);
        if (strstr(text, expected[i]) == NULL)
            fail_msg("%s %zu: '%s', not '%s'", name, i + 1, text, expected[i]);
    }
    assert_ptr_equal(text, bytes.data + bytes.size);
    free(bytes.data);
}

static void expect_outcomes(const page *p, const uint8_t *expected) {
    page_bytes bytes = unpack_array(p, "outcome");
    assert_int_equal(bytes.size, JOBS);
    assert_memory_equal(bytes.data, expected, JOBS);
    free(bytes.data);
}

static void expect_missing(const page *p, const char *words) {
    assert_string_equal(json_node_string(p->json, "missing"), words);
}

/* ---- a whole night ------------------------------------------------------------------------------------------------- */

static tool_run report_shards(int count, int code) {
    remove(page_path.text);
    tool_run run = count == 1 ? RUN_TOOL("report", shards[0].text, "-o", page_path.text)
                              : RUN_TOOL("report", shards[0].text, shards[1].text, "-o", page_path.text);
    if (run.code != code) fail_msg("%d: %s%s", run.code, run.out, run.error);
    return run;
}

static void the_page_has_every_job(void **state) {
    static const uint8_t outcomes[JOBS] = {CLEAN, CROSSING, FAILED, CLEAN, CROSSING, FAILED, CLEAN};
    static const uint8_t found[JOBS] = {0, 1, 0, 0, 1, 0, 0};
    static const char *const names[JOBS] = {"</script> '1", "</script> '2", "</script> '3", "</script> '4",
                                            "</script> '5", "</script> '6", "</script> '7"};
    static const char *const answers[JOBS] = {
        "Clean", "cross", "none.obj: cannot open", "Clean", "cross", "none.obj: cannot open", "Clean"};
    (void)state;
    tool_run run = report_shards(2, 1);
    assert_non_null(strstr(run.out, "7 jobs: 3 clean, 2 with intersections, 2 failed\nwritten: "));
    assert_string_equal(run.error, "cscd: 2 of 7 jobs have failed\n");
    tool_run_free(&run);
    page p = read_page();
    assert_string_equal(json_node_string(p.json, "kind"), "jobs");
    assert_string_equal(json_node_string(p.json, "title"), "Jobs");
    expect_missing(&p, "");
    expect_outcomes(&p, outcomes);
    expect_texts(&p, "names", names, JOBS);
    expect_texts(&p, "answers", answers, JOBS);
    page_bytes bytes = unpack_array(&p, "found");
    assert_memory_equal(bytes.data, found, JOBS);
    free(bytes.data);
    bytes = unpack_array(&p, "pairs");
    double pairs[JOBS];
    assert_int_equal(bytes.size, sizeof pairs);
    memcpy(pairs, bytes.data, sizeof pairs);
    free(bytes.data);
    assert_true(pairs[0] == 0.0 && pairs[1] == 1.0 && isnan(pairs[2]));
    assert_false(has_array(&p, "seconds"));
    page_free(&p);
}

/* As those of merge. */
static void exit_codes_are_those_of_the_night(void **state) {
    (void)state;
    temp_path results = temp_file_path(&folder, "few.jsonl");
    char text[600];
    for (int with_crossing = 0; with_crossing < 2; with_crossing++) {
        snprintf(text, sizeof text, "{\"model\": \"%s/clean.obj\"}\n{\"model\": \"%s/%s\"}\n", folder.path,
                 folder.path, with_crossing ? "crossing.obj" : "clean.obj");
        temp_path few = temp_file_write(&folder, "few-jobs.jsonl", text, strlen(text));
        remove(results.text);
        EXPECT_TOOL(3 * with_crossing, "check", "--list", few.text, "--results", results.text, "--fail-on",
                    "crossing", "--quiet");
        EXPECT_TOOL(3 * with_crossing, "report", results.text, "-o", page_path.text);
    }
}

/* Lines of --each have other members: times, and no sentence. */
static void meshes_have_times(void **state) {
    (void)state;
    temp_path results = temp_file_path(&folder, "each.jsonl"), clean = temp_file_path(&folder, "clean.obj"),
              crossing = temp_file_path(&folder, "crossing.obj");
    remove(results.text);
    EXPECT_TOOL(0, "check", "--each", clean.text, crossing.text, "--results", results.text, "--quiet");
    EXPECT_TOOL(0, "report", results.text, "-o", page_path.text, "--title", "Meshes");
    page p = read_page();
    const char *const names[] = {"clean.obj", "crossing.obj"};
    assert_string_equal(json_node_string(p.json, "title"), "Meshes");
    expect_texts(&p, "names", names, 2);
    assert_true(has_array(&p, "seconds") && has_array(&p, "pairs") && has_array(&p, "depth"));
    assert_false(has_array(&p, "events") || has_array(&p, "crossing_frames"));
    page_free(&p);
}

/* ---- a night that is not done ---------------------------------------------------------------------------------------- */

static void missing_jobs_are_listed(void **state) {
    static const uint8_t outcomes[JOBS] = {CLEAN, MISSING, FAILED, MISSING, CROSSING, MISSING, CLEAN};
    static const char *const names[JOBS] = {"</script> '1", "job 2", "</script> '3", "job 4",
                                            "</script> '5", "job 6", "</script> '7"};
    (void)state;
    tool_run run = report_shards(1, 1);
    assert_non_null(strstr(run.out, "7 jobs: 2 clean, 1 with intersections, 1 failed, 3 not done\n"));
    assert_string_equal(run.error,
                        "cscd: 3 of 7 jobs are not done: 2, 4, 6; is a shard not named, or still running?\n");
    tool_run_free(&run);
    page p = read_page();
    expect_missing(&p, "2, 4, 6");
    expect_outcomes(&p, outcomes);
    expect_texts(&p, "names", names, JOBS);
    page_free(&p);
}

/* A shard is in the middle of a line, another has not begun. */
static void running_shards_are_no_fault(void **state) {
    (void)state;
    size_t size;
    char *text = read_whole_file(shards[1].text, &size);
    for (size_t cut = 1; cut < 900; cut += 83) {
        shell("head -c %zu '%s' > '%s/torn' && mv '%s/torn' '%s'", size - cut, shards[1].text, folder.path,
              folder.path, shards[1].text);
        tool_run run = report_shards(2, 1);
        assert_non_null(strstr(run.out, " not done\n"));
        tool_run_free(&run);
        temp_file_write(&folder, "shard-2.jsonl", text, size);
    }
    temp_file_write(&folder, "shard-2.jsonl", "", 0);
    tool_run run = report_shards(2, 1);
    assert_non_null(strstr(run.out, "1 failed, 3 not done\n"));
    tool_run_free(&run);
    EXPECT_ERROR(1, TEXTS("shard-2.jsonl: there are no results"), "report", shards[1].text, "-o",
                 page_path.text);
    temp_file_write(&folder, "shard-2.jsonl", text, size);
    free(text);
}

static void junit_has_the_missing_jobs(void **state) {
    (void)state;
    temp_path xml = temp_file_path(&folder, "night.xml");
    EXPECT_TOOL(1, "report", shards[0].text, "-o", page_path.text, "--junit", xml.text, "--quiet");
    char *found = read_whole_file(xml.text, NULL);
    assert_non_null(strstr(found, "tests=\"7\" failures=\"1\" errors=\"4\">"));
    assert_non_null(strstr(found, "<testcase classname=\"cscd\" name=\"job 2\">\n"
                                  "      <error message=\"not done\"/>\n    </testcase>\n"));
    free(found);
    EXPECT_ERROR(2, TEXTS("--junit", "would overwrite"), "report", shards[0].text, "-o", page_path.text,
                 "--junit", shards[0].text);
    EXPECT_ERROR(2, TEXTS("--junit"), "report", summary.text, "-o", page_path.text, "--junit", xml.text);
}

/* ---- what is refused -------------------------------------------------------------------------------------------------- */

static void double_and_foreign_jobs_are_named(void **state) {
    (void)state;
    temp_path other = temp_file_path(&folder, "other.jsonl");
    temp_file_write(&folder, "night.html", "old", 3);
    EXPECT_ERROR(1, TEXTS("is named twice"), "report", shards[0].text, shards[0].text, "-o", page_path.text);
    shell("head -1 '%s' > '%s'", shards[0].text, other.text);
    EXPECT_ERROR(1, TEXTS("shard-1.jsonl as well"), "report", shards[0].text, other.text, "-o",
                 page_path.text);
    shell("sed 's/\"list\":\"/&0/; s/\\(\"list\":\"................\\)./\\1/' '%s' > '%s'", shards[1].text,
          other.text);
    EXPECT_ERROR(1, TEXTS("other.jsonl:1: these are results of another list"), "report", shards[0].text,
                 other.text, "-o", page_path.text);
    temp_file_write(&folder, "other.jsonl", "{\"a\": 1}\n", 9);
    EXPECT_ERROR(1, TEXTS("other.jsonl:1: this is no line of results"), "report", shards[0].text, other.text,
                 "-o", page_path.text);
    char *left = read_whole_file(page_path.text, NULL);
    assert_string_equal(left, "old");
    free(left);
}

/* Content decides, and the name where there is none. */
static void results_and_summaries_are_told_apart(void **state) {
    (void)state;
    temp_path renamed = temp_file_path(&folder, "renamed.txt");
    EXPECT_ERROR(2, TEXTS("shard-1.jsonl' has results of jobs and '", "fold.json' has not"), "report",
                 summary.text, shards[0].text, "-o", page_path.text);
    shell("cp '%s' '%s'", shards[0].text, renamed.text);
    EXPECT_ERROR(2, TEXTS("renamed.txt' has results of jobs"), "report", renamed.text, summary.text, "-o",
                 page_path.text);
    EXPECT_TOOL(1, "report", renamed.text, shards[1].text, "-o", page_path.text);
    EXPECT_TOOL(0, "report", summary.text, "-o", page_path.text);
    temp_path shard = temp_file_path(&folder, "fold.shard"), model = temp_file_path(&folder, "fold.obj"),
              frames = temp_file_path(&folder, "fold.pc2");
    EXPECT_TOOL(0, "replay", model.text, frames.text, "--shard", "1/1", "--results", shard.text, "--quiet");
    EXPECT_ERROR(2, TEXTS("fold.shard' is a shard of one recording"), "report", shard.text, "-o",
                 page_path.text);
    EXPECT_ERROR(1, TEXTS("/nowhere/x.jsonl: cannot open"), "report", "/nowhere/x.jsonl", "-o",
                 page_path.text);
}

static void a_full_disk_leaves_nothing(void **state) {
    (void)state;
    EXPECT_ERROR(1, TEXTS("/dev/full", "No space left"), "report", shards[0].text, shards[1].text, "-o",
                 "/dev/full");
    temp_file_write(&folder, "night.html", "old", 3);
    EXPECT_ERROR(1, TEXTS("/dev/full", "No space left"), "report", shards[0].text, shards[1].text, "-o",
                 page_path.text, "--junit", "/dev/full");
    char *left = read_whole_file(page_path.text, NULL);
    assert_string_equal(left, "old");
    free(left);
    EXPECT_ERROR(1, TEXTS("/nowhere/a.html", "cannot write"), "report", shards[0].text, "-o",
                 "/nowhere/a.html");
}

/* ---- links ------------------------------------------------------------------------------------------------------------- */

static void jobs_name_their_pages(void **state) {
    char text[1200];
    (void)state;
    temp_path results = temp_file_path(&folder, "linked.jsonl"), pages = temp_file_path(&folder, "pages");
    const int size =
        snprintf(text, sizeof text,
                 "{\"model\": \"%s/fold.obj\", \"frames\": \"%s/fold.pc2\", \"outputs\": "
                 "{\"report\": \"%s/pages/a b.html\"}}\n{\"model\": \"%s/fold.obj\", \"frames\": "
                 "\"%s/none.pc2\", \"outputs\": {\"report\": \"%s/b.html\"}}\n",
                 folder.path, folder.path, folder.path, folder.path, folder.path, folder.path);
    temp_path jobs = temp_file_write(&folder, "linked-jobs.jsonl", text, (size_t)size);
    shell("mkdir -p '%s'", pages.text);
    EXPECT_TOOL(1, "replay", "--list", jobs.text, "--results", results.text, "--quiet");
    EXPECT_TOOL(1, "report", results.text, "-o", page_path.text);
    page p = read_page();
    page_bytes bytes = unpack_array(&p, "links");
    static const char links[] = "pages/a b.html\0"; /* and the empty one of the job that failed */
    assert_int_equal(bytes.size, sizeof links);
    assert_memory_equal(bytes.data, links, sizeof links);
    free(bytes.data);
    page_free(&p);
    shell("rm -r '%s'", pages.text);
}

static void expect_link(const char *from, const char *here, const char *path, const char *expected) {
    const page_folder places = {(char *)from, (char *)here};
    char *link = page_link_make(&places, path);
    if (strcmp(link, expected) != 0) fail_msg("%s from %s: %s, not %s", path, from, link, expected);
    free(link);
}

static void links_are_relative_to_the_page(void **state) {
    (void)state;
    expect_link("/a/b", "/a/b", "c.html", "c.html");
    expect_link("/a/b", "/a/b", "./x/../c//d.html", "c/d.html");
    expect_link("/a/b", "/a", "c.html", "../c.html");
    expect_link("/a/b", "/a", "bc/d.html", "../bc/d.html");
    expect_link("/a/b", "/a", "b/d.html", "d.html");
    expect_link("/a/b/c", "/x", "y", "../../../x/y");
    expect_link("/a/b", "/x", "/a/bc", "../bc");
    expect_link("", "", "a.html", "a.html");
    expect_link("", "/x", "../../../a", "a");
    expect_link("/a", "", "/b/c", "../b/c");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_has_every_job),
        cmocka_unit_test(exit_codes_are_those_of_the_night),
        cmocka_unit_test(meshes_have_times),
        cmocka_unit_test(missing_jobs_are_listed),
        cmocka_unit_test(running_shards_are_no_fault),
        cmocka_unit_test(junit_has_the_missing_jobs),
        cmocka_unit_test(double_and_foreign_jobs_are_named),
        cmocka_unit_test(results_and_summaries_are_told_apart),
        cmocka_unit_test(a_full_disk_leaves_nothing),
        cmocka_unit_test(jobs_name_their_pages),
        cmocka_unit_test(links_are_relative_to_the_page),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
