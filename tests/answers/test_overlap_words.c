/* What check says of parts that share space, or only meet, and what a gate makes of it. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* A box, its bounds along x, y and z; other: its quads are cut along their other diagonals. */
static void write_box(FILE *file, const char *name, const double x[6], bool other, int before) {
    static const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                    {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    fprintf(file, "o %s\n", name);
    for (int v = 0; v < 8; v++)
        fprintf(file, "v %.17g %.17g %.17g\n", x[v & 1], x[2 + (v >> 1 & 1)], x[4 + (v >> 2 & 1)]);
    for (int i = 0; i < 6; i++) {
        int q[4];
        for (int k = 0; k < 4; k++) q[k] = before + quads[i][(k + (other ? 1 : 0)) % 4];
        fprintf(file, "f %d %d %d\nf %d %d %d\n", q[0], q[1], q[2], q[0], q[2], q[3]);
    }
}

typedef struct word_case {
    double boxes[2][6];
    bool other;              /* see write_box: the second one */
    const char *line, *word; /* the first line begins with this; the row of the event has this */
    int on_crossing, on_depth;
} word_case;

static const word_case cases[] = {
    {{{0, 4, 0, 1, 0, 3}, {3.75, 8, 0, 1, 0, 3}},
     false,
     "1 pair of parts overlaps; ",
     "a x b  overlap ",
     3,
     3},
    {{{0, 1, 0, 1, 0, 1}, {0, 1, 0.75, 1, 0, 1}},
     false,
     "1 pair of parts overlaps; ",
     "a x b  overlap ",
     3,
     3},
    {{{0, 1, 0, 1, 0, 1}, {0.25, 0.75, 0.25, 0.75, 0.25, 0.75}},
     false,
     "1 part lies inside another; ",
     "a x b  inside ",
     3,
     3},
    {{{0, 1, 0, 1, 0, 1}, {0, 1, 0, 1, 0, 1}},
     false,
     "1 pair of parts is two copies of one solid; ",
     "a x b  copies ",
     3,
     3},
    {{{0, 1, 0, 1, 0, 1}, {0, 1, 0, 1, 0, 1}},
     true,
     "1 pair of parts is two copies of one solid; ",
     "a x b  copies ",
     3,
     3},
    {{{0, 4, 0, 1, 0, 3}, {4, 8, 0, 1, 0, 3}},
     false,
     "62 pairs of triangles touch, none cross. ",
     "a x b  touch ",
     0,
     0},
    {{{-4, 4, -4, 4, -1, 0}, {-1, 1, -1, 1, 0, 2}}, false, "", "a x b  touch ", 0, 0},
    {{{0, 1, 0, 1, 0, 1}, {0.5, 1.5, 0.5, 1.5, 0.5, 1.5}}, false, "", "a x b  cross ", 3, 3},
};

static void expect_words(const char *first, const char *option, const char *second, const word_case *c) {
    tool_run run = RUN_TOOL("check", first, option, second);
    if (strncmp(run.out, c->line, strlen(c->line)) != 0)
        fail_msg("'%s' is not first in: %s", c->line, run.out);
    if (strstr(run.out, c->word) == NULL) fail_msg("'%s' is not in: %s", c->word, run.out);
    tool_run_free(&run);
    EXPECT_TOOL(c->on_crossing, "check", first, "--quiet", "--fail-on", "crossing", option, second);
    EXPECT_TOOL(c->on_depth, "check", first, "--quiet", "--fail-depth", "0.1", option, second);
}

/* In one file and in two. */
static void words_say_who_shares_space(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const temp_path both = temp_file_path(&folder, "both.obj"), a = temp_file_path(&folder, "a.obj"),
                        b = temp_file_path(&folder, "b.obj");
        FILE *files[3] = {fopen(both.text, "w"), fopen(a.text, "w"), fopen(b.text, "w")};
        write_box(files[0], "a", cases[i].boxes[0], false, 0);
        write_box(files[0], "b", cases[i].boxes[1], cases[i].other, 8);
        write_box(files[1], "a", cases[i].boxes[0], false, 0);
        write_box(files[2], "b", cases[i].boxes[1], cases[i].other, 0);
        for (int k = 0; k < 3; k++) fclose(files[k]);
        char object[600];
        snprintf(object, sizeof object, "b=%s", b.text);
        expect_words(both.text, NULL, NULL, &cases[i]);
        expect_words(a.text, "--object", object, &cases[i]);
    }
}

/* ---- rounding ---------------------------------------------------------------------------------------------- */

/* A triangle of x and y, from one z to another. */
static void write_prism(FILE *file, const char *name, const double xy[3][2], const double z[2], int before) {
    fprintf(file, "o %s\n", name);
    for (int v = 0; v < 6; v++) fprintf(file, "v %.17g %.17g %.17g\n", xy[v % 3][0], xy[v % 3][1], z[v / 3]);
    fprintf(file, "f %d %d %d\nf %d %d %d\n", before + 3, before + 2, before + 1, before + 4, before + 5,
            before + 6);
    for (int i = 0; i < 3; i++) {
        const int a = before + i + 1, b = before + (i + 1) % 3 + 1;
        fprintf(file, "f %d %d %d %d\n", a, b, b + 3, a + 3);
    }
}

/* The second stands on the slanted side of the first, 3x + 4y = 12, exactly, but distances from that plane are rounded: they
 * are some 1e-16, and no depth. */
static void rounded_distances_are_no_depth(void **state) {
    (void)state;
    static const double ends[4][2] = {{0.5, 2}, {1, 3}, {0.5, 3.5}, {3.25, 3.5}}; /* along x */
    for (size_t i = 0; i < 4; i++)
        for (double scale = 0.125; scale <= 1024.0; scale *= 8192.0) {
            const temp_path path = temp_file_path(&folder, "prisms.obj");
            const double from = scale * ends[i][0], to = scale * ends[i][1];
            const double first[3][2] = {{0, 0}, {4 * scale, 0}, {0, 3 * scale}},
                         second[3][2] = {{to, 3 * scale - 0.75 * to},
                                         {4 * scale, 5 * scale},
                                         {from, 3 * scale - 0.75 * from}};
            FILE *file = fopen(path.text, "w");
            write_prism(file, "a", first, (double[2]){0, 7 * scale}, 0);
            write_prism(file, "b", second, (double[2]){scale, 5.375 * scale}, 6);
            fclose(file);
            tool_run run = RUN_TOOL("check", path.text, "--fail-on", "crossing");
            if (run.code != 0 || strstr(run.out, "a x b  touch ") == NULL)
                fail_msg("%d: %s", run.code, run.out);
            tool_run_free(&run);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(words_say_who_shares_space),
                                       cmocka_unit_test(rounded_distances_are_no_depth)};
    return cmocka_run_group_tests_name("overlap_words", tests, own_folder_make, own_folder_remove);
}
