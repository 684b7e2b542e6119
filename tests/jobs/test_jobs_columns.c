/* What the page and the XML of a night take from the line of a job: each number has its own column, and words stay words. */
#include "tests/support/report/page_reader.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { JOBS = 4 };

/* A recording of which no two numbers are equal, one that failed, a mesh, and a reason that begins with another name. */
static const char results[] =
    "{\"list\":\"0123456789abcdef\",\"jobs\":4,\"job\":1,\"result\":\"crossing\",\"found\":true,"
    "\"name\":\"<a> & 'b'\",\"error\":null,\"answer\":\"<i> & \\\"2\\\" cross\",\"frames\":120,"
    "\"frames_checked\":110,\"frames_crossing\":12,\"crossing_pairs\":15,\"depth\":14.5,\"events\":13}\n"
    "{\"list\":\"0123456789abcdef\",\"jobs\":4,\"job\":2,\"result\":\"failed\",\"found\":false,"
    "\"name\":\"b.obj\",\"error\":\"b.obj: <no> & \\\"file\\\"\",\"answer\":null,\"frames\":null,\"depth\":null}\n"
    "{\"list\":\"0123456789abcdef\",\"jobs\":4,\"job\":3,\"result\":\"clean\",\"found\":false,"
    "\"file\":\"c.obj\",\"crossing\":21,\"read_ms\":1250,\"check_ms\":250}\n"
    "{\"list\":\"0123456789abcdef\",\"jobs\":4,\"job\":4,\"result\":\"failed\",\"found\":false,"
    "\"name\":\"d\",\"error\":\"d.obj: it took longer than 3 s\",\"answer\":\"d\"}\n";

static temp_folder folder;
static temp_path night, page_path, xml;

static int make_page(void **state) {
    (void)state;
    folder = temp_folder_make();
    night = temp_file_write(&folder, "a&b.jsonl", results, strlen(results));
    page_path = temp_file_path(&folder, "night.html");
    xml = temp_file_path(&folder, "night.xml");
    EXPECT_TOOL(1, "report", night.text, "-o", page_path.text, "--junit", xml.text, "--quiet");
    return 0;
}

static int remove_page(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

static void expect_column(const page *p, const char *name, const double *expected) {
    page_bytes bytes = page_array(p, name);
    double found[JOBS];
    assert_int_equal(bytes.size, sizeof found);
    memcpy(found, bytes.data, sizeof found);
    for (int i = 0; i < JOBS; i++)
        if (isnan(expected[i]) ? !isnan(found[i]) : found[i] != expected[i])
            fail_msg("%s of job %d: %g, not %g", name, i + 1, found[i], expected[i]);
    free(bytes.data);
}

static void each_number_has_its_column(void **state) {
    (void)state;
    page p = {.text = read_whole_file(page_path.text, NULL)};
    expect_column(&p, "crossing_frames", (const double[]){12, NAN, NAN, NAN});
    expect_column(&p, "frames", (const double[]){110, NAN, NAN, NAN});
    expect_column(&p, "events", (const double[]){13, NAN, NAN, NAN});
    expect_column(&p, "depth", (const double[]){14.5, NAN, NAN, NAN});
    expect_column(&p, "pairs", (const double[]){15, NAN, 21, NAN});
    expect_column(&p, "seconds", (const double[]){NAN, NAN, 1.5, NAN});
    page_free(&p);
}

static void expect_bytes(const page *p, const char *name, const char *expected, size_t size) {
    page_bytes bytes = page_array(p, name);
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, expected, size);
    free(bytes.data);
}

/* A reason does not begin with the name that stands beside it. */
static void words_are_as_the_line_has_them(void **state) {
    static const char names[] = "<a> & 'b'\0b.obj\0c.obj\0d",
                      answers[] = "<i> & \"2\" cross\0<no> & \"file\"\0\0d.obj: it took longer than 3 s";
    (void)state;
    page p = {.text = read_whole_file(page_path.text, NULL)};
    expect_bytes(&p, "names", names, sizeof names);
    expect_bytes(&p, "answers", answers, sizeof answers);
    page_free(&p);
}

static void the_xml_escapes_all_words(void **state) {
    static const char expected[] =
        "/a&#38;b.jsonl\" tests=\"4\" failures=\"1\" errors=\"2\">\n"
        "    <testcase classname=\"cscd\" name=\"&#60;a&#62; &#38; 'b'\">\n"
        "      <failure message=\"&#60;i&#62; &#38; &#34;2&#34; cross\"/>\n    </testcase>\n"
        "    <testcase classname=\"cscd\" name=\"b.obj\">\n"
        "      <error message=\"b.obj: &#60;no&#62; &#38; &#34;file&#34;\"/>\n    </testcase>\n"
        "    <testcase classname=\"cscd\" name=\"c.obj\"/>\n"
        "    <testcase classname=\"cscd\" name=\"d\">\n"
        "      <error message=\"d.obj: it took longer than 3 s\"/>\n    </testcase>\n"
        "  </testsuite>\n</testsuites>\n";
    (void)state;
    char *found = read_whole_file(xml.text, NULL);
    const char *end = strlen(found) > strlen(expected) ? found + strlen(found) - strlen(expected) : found;
    assert_string_equal(end, expected);
    free(found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_has_its_column),
        cmocka_unit_test(words_are_as_the_line_has_them),
        cmocka_unit_test(the_xml_escapes_all_words),
    };
    return cmocka_run_group_tests(tests, make_page, remove_page);
}
