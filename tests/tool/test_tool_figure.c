/* The tool on a figure of which it is known which parts meet, and when: its events, by name and frame, in each of the forms in
 * which animations come, and with each of the options that leave parts out. */
#include "models/mannequin/mannequin.h"
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct known_event {
    const char *a, *b;
    int first, last, worst; /* worst -1: all frames are about as bad */
    double depth;           /* at the worst frame; 0: anything above 0 */
} known_event;

static const known_event left_arm = {"Trunk", "Arm.L", 17, 31, 24, 0.13},
                         right_arm = {"Trunk", "Arm.R", 36, 44, 40, 0.0},
                         left_eye = {"Head", "Eye.L", 0, 47, -1, 0.0},
                         right_eye = {"Head", "Eye.R", 0, 47, -1, 0.0},
                         teeth = {"Head", "Teeth", 0, 47, -1, 0.0}, belt = {"Trunk", "Belt", 0, 47, -1, 0.0};

static temp_folder folder;
static temp_path model, cache, skin, frames, json;

static int make_figure(void **state) {
    (void)state;
    folder = temp_folder_make();
    model = temp_file_path(&folder, "mannequin.obj");
    cache = temp_file_path(&folder, "mannequin.pc2");
    skin = temp_file_path(&folder, "mannequin.glb");
    frames = temp_file_path(&folder, "frame-%02d.obj");
    json = temp_file_path(&folder, "found.json");
    model_program_use("mannequin");
    EXPECT_TOOL(0, folder.path, "cache", "skin", "frames", "objects");
    model_program_use(NULL);
    return 0;
}

static int remove_figure(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* ---- events -------------------------------------------------------------------------------------------- */

static bool has_kind(const json_node *event, const char *kind) {
    for (const json_node *k = json_node_member(event, "kinds")->first; k != NULL; k = k->next)
        if (strcmp(k->text, kind) == 0) return true;
    return false;
}

static bool joins_parts(const json_node *event, const char *a, const char *b) {
    const char *c = json_node_string(event, "a"), *d = json_node_string(event, "b");
    return (strcmp(a, c) == 0 && strcmp(b, d) == 0) || (strcmp(a, d) == 0 && strcmp(b, c) == 0);
}

static void check_event(const json_node *events, const known_event *known, bool with_depths) {
    const json_node *found = NULL;
    for (const json_node *event = events->first; event != NULL; event = event->next) {
        if (!joins_parts(event, known->a, known->b)) continue;
        if (found != NULL) fail_msg("%s x %s is there twice", known->a, known->b);
        found = event;
    }
    if (found == NULL) fail_msg("%s x %s is missing", known->a, known->b);
    assert_int_equal(json_node_number(found, "first"), known->first);
    assert_int_equal(json_node_number(found, "last"), known->last);
    assert_true(has_kind(found, "crossing"));
    if (!with_depths) return;
    if (known->worst >= 0) assert_int_equal(json_node_number(found, "worst"), known->worst);
    const double depth = json_node_number(found, "depth");
    assert_true(depth > 0.0);
    /* The mesh lies within its capsules, by up to a hundredth of their radii. */
    if (known->depth > 0.0) assert_true(depth > known->depth - 0.003 && depth < known->depth + 1e-6);
}

/* Runs check or replay and expects these events between different parts, a list up to NULL, and no others. Nothing crosses
 * itself. */
static void expect_events(const known_event *const *known, const char *const *arguments) {
    const char *all[64] = {NULL};
    size_t count = 0, between = 0, known_count = 0;
    bool with_depths = true;
    for (; arguments[count] != NULL; count++) {
        all[count] = arguments[count];
        with_depths &= strcmp(arguments[count], "--no-depths") != 0;
    }
    assert_true(count + 4 < sizeof all / sizeof *all);
    all[count++] = "--quiet";
    all[count++] = "--json";
    all[count++] = json.text;
    run_tool_expect(0, all);
    json_node *summary = json_node_read_file(json.text);
    const json_node *events = json_node_member(summary, "events");
    for (const json_node *event = events->first; event != NULL; event = event->next) {
        if (strcmp(json_node_string(event, "a"), json_node_string(event, "b")) == 0)
            assert_false(has_kind(event, "crossing") || has_kind(event, "touching"));
        else
            between++;
    }
    for (; known[known_count] != NULL; known_count++) check_event(events, known[known_count], with_depths);
    assert_int_equal(between, known_count);
    json_node_free(summary);
}

#define KNOWN(...)                ((const known_event *const[]){__VA_ARGS__, NULL})
#define NOTHING                   ((const known_event *const[]){NULL})
#define EXPECT_EVENTS(known, ...) expect_events(known, (const char *const[]){__VA_ARGS__, NULL})
#define ALL_EVENTS                KNOWN(&left_arm, &right_arm, &left_eye, &right_eye, &teeth, &belt)

/* ---- tests --------------------------------------------------------------------------------------------- */

static void all_forms_have_the_same_events(void **state) {
    (void)state;
    const known_event *const *arms = KNOWN(&left_arm, &right_arm);
    EXPECT_EVENTS(arms, "check", model.text, cache.text, "--ignore-rest=parts");
    EXPECT_EVENTS(arms, "check", skin.text, skin.text, "--ignore-rest=parts", "--no-depths");
    EXPECT_EVENTS(arms, "check", model.text, frames.text, "--ignore-rest=parts", "--no-depths");
}

/* A file and a cache for each part. */
static void objects_have_the_same_events(void **state) {
    (void)state;
    static char words[MANNEQUIN_PARTS][4][600];
    const char *arguments[64] = {"check"};
    size_t count = 1;
    for (int part = 0; part < MANNEQUIN_PARTS; part++) {
        const char *name = mannequin_part_names[part];
        char(*w)[600] = words[part];
        snprintf(w[0], sizeof w[0], "%s/%s.obj", folder.path, name);
        snprintf(w[1], sizeof w[1], "%s/%s.pc2", folder.path, name);
        snprintf(w[2], sizeof w[2], "%s=%s/%s.obj", name, folder.path, name);
        snprintf(w[3], sizeof w[3], "%s=%s/%s.pc2", name, folder.path, name);
        if (part == 0) {
            arguments[count++] = w[0];
            arguments[count++] = w[1];
            continue;
        }
        arguments[count++] = "--object";
        arguments[count++] = w[2];
        arguments[count++] = "--frames-of";
        arguments[count++] = w[3];
    }
    arguments[count] = "--no-depths";
    expect_events(ALL_EVENTS, arguments);
}

/* An eye turns, so other triangles of it meet the head; as a part it rests. */
static void triangles_that_meet_at_rest_are_not_enough(void **state) {
    (void)state;
    EXPECT_TOOL(0, "check", model.text, cache.text, "--ignore-rest", "--frames", "0:8", "--no-depths",
                "--quiet", "--json", json.text);
    json_node *summary = json_node_read_file(json.text);
    bool eye = false, moved_belt = false;
    for (const json_node *e = json_node_member(summary, "events")->first; e != NULL; e = e->next) {
        eye |= joins_parts(e, "Head", "Eye.L") && has_kind(e, "crossing");
        moved_belt |= joins_parts(e, "Trunk", "Belt") && has_kind(e, "crossing");
    }
    json_node_free(summary);
    assert_true(eye && !moved_belt);
}

/* Between two frames arms touch the trunk already, and still: an interval counts for the frame at its end. */
static void replay_has_the_same_events(void **state) {
    (void)state;
    known_event left = left_arm;
    left.last++;
    EXPECT_EVENTS(KNOWN(&left), "replay", skin.text, "--ignore-rest=parts", "--frames", "15:34", "--method",
                  "none");
}

/* From the frame 30 to 38, where the left arm goes and the right one comes. */
static const known_event left_goes = {"Trunk", "Arm.L", 30, 31, -1, 0.0},
                         right_comes = {"Trunk", "Arm.R", 36, 38, -1, 0.0},
                         eye_stays = {"Head", "Eye.L", 30, 38, -1, 0.0},
                         teeth_stay = {"Head", "Teeth", 30, 38, -1, 0.0};

#define FEW_FRAMES "--frames", "30:38", "--no-depths"

static void chosen_parts_have_their_events(void **state) {
    (void)state;
    EXPECT_EVENTS(KNOWN(&left_goes), "check", model.text, cache.text, FEW_FRAMES, "--only", "Arm.L");
    EXPECT_EVENTS(NOTHING, "check", model.text, cache.text, FEW_FRAMES, "--only", "Arm.L,Arm.R", "--only",
                  "Head,Belt");
    EXPECT_EVENTS(KNOWN(&eye_stays, &left_goes), "check", skin.text, skin.text, FEW_FRAMES, "--only",
                  "Arm.L,Trunk", "--only", "Head,Eye.L");
    EXPECT_EVENTS(KNOWN(&right_comes, &teeth_stay), "check", model.text, cache.text, FEW_FRAMES,
                  "--ignore-parts", "Arm.L", "--ignore-parts", "Head,Eye.L", "--ignore-parts", "Eye.R,Head",
                  "--ignore-parts", "Belt");
    EXPECT_EVENTS(KNOWN(&right_comes), "check", model.text, cache.text, FEW_FRAMES, "--ignore-rest=parts",
                  "--ignore-parts", "Trunk,Arm.L");
}

/* A table puts both arms into one part, and all else but the eyes into another. */
static void a_table_names_other_parts(void **state) {
    (void)state;
    static mannequin m;
    static char text[MANNEQUIN_TRIANGLES_MAX * 16];
    mannequin_make(&m);
    int used = snprintf(text, sizeof text, "triangle,name\n");
    for (int part = 0; part < MANNEQUIN_PARTS; part++) {
        const char *name = part == PART_ARM_L || part == PART_ARM_R ? "Arms" : "Body";
        for (uint32_t t = m.first_triangle[part]; t < m.first_triangle[part + 1]; t++)
            if (part != PART_EYE_L && part != PART_EYE_R)
                used += snprintf(text + used, sizeof text - (size_t)used, "%u,%s\n", t, name);
    }
    const temp_path table = temp_file_write(&folder, "table.csv", text, (size_t)used);
    EXPECT_TOOL(0, "check", model.text, cache.text, "--parts", table.text, FEW_FRAMES, "--only", "Arms,Body",
                "--quiet", "--json", json.text);
    json_node *summary = json_node_read_file(json.text);
    const json_node *events = json_node_member(summary, "events");
    static const int known[2][2] = {{30, 31}, {36, 38}};
    assert_int_equal(events->count, 2);
    for (size_t i = 0; i < 2; i++) {
        const json_node *event = json_node_item(events, i);
        assert_true(joins_parts(event, "Arms", "Body"));
        assert_int_equal(json_node_number(event, "first"), known[i][0]);
        assert_int_equal(json_node_number(event, "last"), known[i][1]);
    }
    json_node_free(summary);
}

static void the_program_refuses_what_it_does_not_know(void **state) {
    (void)state;
    model_program_refuses("mannequin", 2, "expected a folder", (const char *const[]){NULL});
    model_program_refuses("mannequin", 2, "'film' is not cache",
                          (const char *const[]){folder.path, "film", NULL});
    model_program_refuses("mannequin", 1, "No such file", (const char *const[]){"/no/folder", NULL});
    model_program_use(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_forms_have_the_same_events),
        cmocka_unit_test(objects_have_the_same_events),
        cmocka_unit_test(triangles_that_meet_at_rest_are_not_enough),
        cmocka_unit_test(replay_has_the_same_events),
        cmocka_unit_test(chosen_parts_have_their_events),
        cmocka_unit_test(a_table_names_other_parts),
        cmocka_unit_test(the_program_refuses_what_it_does_not_know),
    };
    return cmocka_run_group_tests_name("tool_figure", tests, make_figure, remove_figure);
}
