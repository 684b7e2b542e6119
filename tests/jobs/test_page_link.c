/* The links from a page of jobs to the pages of each. */
#include "tests/support/test.h"
#include "tool/report/page.h"

#include <stdlib.h>
#include <string.h>

static void expect_link(const char *from, const char *here, const char *path, const char *expected) {
    const page_folder places = {(char *)from, (char *)here};
    char *link = page_link_make(&places, path);
    if (strcmp(link, expected) != 0) fail_msg("%s from %s: %s, not %s", path, from, link, expected);
    free(link);
}

TEST(links_are_relative_to_the_page) {
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
