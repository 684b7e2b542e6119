/* What check says of parts that share space, or only meet, and what a gate makes of it. */
#include "tests/support/own_folder.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
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

/* ---- how many lie inside ---------------------------------------------------------------------------------- */

/* Of boxes named a, b, c, d in the order of the file, so many lie inside others, in so many pairs. */
typedef struct nest_case {
    double halves[4]; /* of cubes; 0: there are no more */
    double shifts[4]; /* along an axis */
    int inside, pairs;
} nest_case;

static const nest_case nests[] = {
    {{4, 3, 2}, {0, 0, 0}, 2, 3},            /* dolls, */
    {{2, 4, 3}, {0, 0, 0}, 2, 3},            /* in another order, */
    {{1, 2, 3, 4}, {0.5, 0, 0.25, 0}, 3, 6}, /* and four of them */
    {{8, 1, 1}, {0, -3, 3}, 2, 2},           /* two in one that are apart, */
    {{1, 8, 1, 1}, {-3, 0, 0, 3}, 3, 3},     /* and three */
    {{2, 1, 2, 1}, {-3, -3, 3, 3}, 2, 2},    /* one in each of two */
    {{2, 1, 2}, {-3, -3, 3}, 1, 1},          /* in one of two */
};

static temp_path write_nest(const nest_case *c, int axis, double scale) {
    const temp_path path = temp_file_path(&folder, "nest.obj");
    FILE *file = fopen(path.text, "w");
    for (int i = 0; i < 4 && c->halves[i] > 0.0; i++) {
        double bounds[6];
        for (int k = 0; k < 3; k++) {
            const double middle = k == axis ? c->shifts[i] : 0.0;
            bounds[2 * k] = scale * (middle - c->halves[i]);
            bounds[2 * k + 1] = scale * (middle + c->halves[i]);
        }
        write_box(file, (const char[]){(char)('a' + i), '\0'}, bounds, false, 8 * i);
    }
    fclose(file);
    return path;
}

static void expect_nest(const nest_case *c, const char *path) {
    char line[100];
    const temp_path json = temp_file_path(&folder, "nest.json");
    snprintf(line, sizeof line, "%d part%s; no two triangles cross or touch. %d place", c->inside,
             c->inside > 1 ? "s lie inside others" : " lies inside another", c->pairs);
    tool_run run = RUN_TOOL("check", path, "--json", json.text);
    expect_start(run.out, line);
    tool_run_free(&run);
    json_node *root = json_node_read_file(json.text);
    const json_node *frame = json_node_item(json_node_member(root, "frames"), 0);
    assert_int_equal(json_node_number(frame, "inside_parts"), c->inside);
    json_node_free(root);
    run = RUN_TOOL("check", "--each", path);
    expect_in(run.out, line);
    tool_run_free(&run);
    EXPECT_ERROR(3,
                 TEXTS(c->inside > 1
                           ? "failed: parts lie inside others, though no triangles cross, worst: "
                           : "failed: a part lies inside another, though no triangles cross, worst: "),
                 "check", path, "--quiet", "--fail-on", "crossing");
}

/* A doll in two others is one part, though it makes two events. */
static void parts_inside_count_once(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof nests / sizeof *nests; i++) {
        const temp_path path = write_nest(&nests[i], (int)(i % 3), i % 2 == 0 ? 1.0 : 0.001);
        expect_nest(&nests[i], path.text);
    }
    const temp_path dolls = write_nest(&nests[0], 1, 1.0);
    tool_run run = RUN_TOOL("check", dolls.text, "--ignore-parts", "a,b", "--ignore-parts", "a,c");
    expect_start(run.out, "1 part lies inside another; ");
    tool_run_free(&run);
}

/* ---- what is left out --------------------------------------------------------------------------------------- */

/* All of a x b, a x c, b x c and the three with themselves. */
typedef struct left_out_case {
    const char *options[5];
    const char *said; /* at the end of the first line */
    int parts, components, triangles;
} left_out_case;

static const char *const clean_but = "Clean: no two triangles cross or touch. As asked, ";

static void expect_left_out(const char *model, const char *list, const left_out_case *c) {
    const temp_path json = temp_file_path(&folder, "left.json");
    const char *arguments[10] = {"check", model, "--json", json.text};
    for (int i = 0; i < 5 && c->options[i] != NULL; i++)
        arguments[4 + i] = strcmp(c->options[i], "LIST") == 0 ? list : c->options[i];
    tool_run run = run_tool(arguments);
    expect_in(run.out, c->said);
    if (strstr(run.out, "As asked") == NULL) fail_msg("nothing is said: %s", run.out);
    tool_run_free(&run);
    json_node *root = json_node_read_file(json.text);
    const json_node *left_out = json_node_member(root, "left_out");
    assert_int_equal(json_node_number(left_out, "part_pairs"), c->parts);
    assert_int_equal(json_node_number(left_out, "of_part_pairs"), 6);
    assert_int_equal(json_node_number(left_out, "component_pairs"), c->components);
    assert_int_equal(json_node_number(left_out, "triangle_pairs"), c->triangles);
    json_node_free(root);
}

static void what_is_left_out_is_said(void **state) {
    (void)state;
    static const left_out_case left_outs[] = {
        {{"--ignore-parts", "b"}, " As asked, 3 of 6 pairs of parts were not looked at.\n", 3, 0, 0},
        {{"--ignore-parts", "a,b"}, " As asked, 1 of 6 pairs of parts was not looked at.\n", 1, 0, 0},
        {{"--ignore-parts", "a,b", "--ignore-parts", "b,a"}, " 1 of 6 pairs of parts was not ", 1, 0, 0},
        {{"--only", "a,c"}, " As asked, 5 of 6 pairs of parts were not looked at.\n", 5, 0, 0},
        {{"--only", "a", "--ignore-parts", "a,b"}, " 4 of 6 pairs of parts were not looked at.\n", 4, 0, 0},
        {{"--ignore", "LIST"},
         " As asked, 1 pair of components and 2 pairs of triangles were not looked at.\n",
         0,
         1,
         2},
        {{"--ignore", "LIST", "--only", "a"},
         " As asked, 3 of 6 pairs of parts, 1 pair of components and 2 pairs of ",
         3,
         1,
         2},
        {{"--ignore-rest=parts"}, " As asked, 1 of 6 pairs of parts was not looked at.\n", 1, 0, 0},
    };
    const temp_path model = temp_file_path(&folder, "left.obj"), list = temp_file_path(&folder, "left.txt");
    FILE *file = fopen(model.text, "w");
    write_box(file, "a", (const double[]){0, 1, 0, 1, 0, 1}, false, 0);
    write_box(file, "b", (const double[]){0.5, 1.5, 0.5, 1.5, 0.5, 1.5}, false, 8);
    write_box(file, "c", (const double[]){5, 6, 0, 1, 0, 1}, false, 16);
    fclose(file);
    file = fopen(list.text, "w");
    fputs("components 1 0\ncomponents 0 1\n0 13\n3 30\n13 0\n", file);
    fclose(file);
    for (size_t i = 0; i < sizeof left_outs / sizeof *left_outs; i++)
        expect_left_out(model.text, list.text, &left_outs[i]);
    /* Clean but for what is left out, and nothing of that where nothing is. */
    tool_run run = RUN_TOOL("check", "--each", model.text, "--ignore-parts", "a,b");
    expect_in(run.out, clean_but);
    tool_run_free(&run);
    run = RUN_TOOL("replay", model.text, model.text, model.text, "--ignore-rest");
    expect_start(run.out, "No frame crosses or touches (2 checked). As asked, ");
    tool_run_free(&run);
    run = RUN_TOOL("check", model.text);
    assert_null(strstr(run.out, "As asked"));
    tool_run_free(&run);
}

/* ---- recordings -------------------------------------------------------------------------------------------- */

typedef struct frames_case {
    const char *frames; /* c crosses, o overlaps, i inside, s the same solid twice, t touches, n nothing */
    const char *line;
} frames_case;

static const frames_case recordings[] = {
    {"cc", "All 2 frames cross. "},
    {"iii", "All 3 frames have one part inside another. "},
    {"nin", "Frame 1 has one part inside another (1 of 3). "},
    {"oo", "All 2 frames overlap. "},
    {"ont", "Frame 0 overlaps (1 of 3), frame 2 touches (1 of 3). "},
    {"snn", "Frame 0 has two copies of one solid (1 of 3). "},
    {"cin", "Frames 0 to 1 cross or have one part inside another (2 of 3). "},
    {"ons", "Frames 0, 2 overlap or have two copies of one solid (2 of 3). "},
    {"coist",
     "Frames 0 to 3 cross, overlap, have one part inside another or have two copies of one solid (4 of 5), "
     "frame 4 touches (1 of 5). "},
    {"tnt", "No frame crosses; frames 0, 2 touch (2 of 3). "},
};

static void write_frame(const char *path, char kind) {
    static const struct {
        char kind;
        double low[3], high[3];
    } boxes[] = {{'c', {0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}},
                 {'o', {0, 0, 0.75}, {1, 1, 1}},
                 {'i', {0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}},
                 {'s', {0, 0, 0}, {1, 1, 1}},
                 {'t', {1, 0, 0}, {2, 1, 1}},
                 {'n', {3, 0, 0}, {4, 1, 1}}};
    FILE *file = fopen(path, "w");
    write_box(file, "a", (const double[]){0, 1, 0, 1, 0, 1}, false, 0);
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        const double *l = boxes[i].low, *h = boxes[i].high;
        if (boxes[i].kind == kind)
            write_box(file, "b", (const double[]){l[0], h[0], l[1], h[1], l[2], h[2]}, false, 8);
    }
    fclose(file);
}

/* No frame is said to cross in which nothing does. */
static void recordings_say_what_there_is(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof recordings / sizeof *recordings; i++) {
        temp_path paths[5];
        const char *arguments[8] = {"check"};
        const size_t count = strlen(recordings[i].frames);
        for (size_t k = 0; k < count; k++) {
            paths[k] = temp_file_path(&folder, (const char[]){(char)('0' + k), '.', 'o', 'b', 'j', '\0'});
            write_frame(paths[k].text, recordings[i].frames[k]);
            arguments[k + 1] = paths[k].text;
        }
        tool_run run = run_tool(arguments);
        expect_start(run.out, recordings[i].line);
        tool_run_free(&run);
    }
}

static void expect_worst(const char *command, const temp_path frames[3], int worst) {
    const temp_path json = temp_file_path(&folder, "worst.json");
    EXPECT_TOOL(0, command, frames[0].text, frames[0].text, frames[1].text, frames[2].text, "--json",
                json.text);
    json_node *root = json_node_read_file(json.text);
    const json_node *event = json_node_item(json_node_member(root, "events"), 0);
    assert_int_equal(json_node_number(event, "worst"), worst);
    json_node_free(root);
}

/* The way to a frame is no part of it: of two that are equally deep the first is the worst, with contacts or without. */
static void check_and_replay_name_the_same_frame(void **state) {
    (void)state;
    static const char *const frames[] = {"cnc", "ini", "oco", "tnt", "ntc"};
    static const int worst[] = {0, 0, 1, 0, 2};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        temp_path paths[3];
        for (int k = 0; k < 3; k++) {
            paths[k] = temp_file_path(&folder, (const char[]){(char)('0' + k), '.', 'o', 'b', 'j', '\0'});
            write_frame(paths[k].text, frames[i][k]);
        }
        expect_worst("check", paths, worst[i]);
        expect_worst("replay", paths, worst[i]);
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
                                       cmocka_unit_test(parts_inside_count_once),
                                       cmocka_unit_test(recordings_say_what_there_is),
                                       cmocka_unit_test(what_is_left_out_is_said),
                                       cmocka_unit_test(check_and_replay_name_the_same_frame),
                                       cmocka_unit_test(rounded_distances_are_no_depth)};
    return cmocka_run_group_tests_name("overlap_words", tests, own_folder_make, own_folder_remove);
}
