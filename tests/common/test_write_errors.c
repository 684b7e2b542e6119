/* What cannot be written is said once, with its name and the reason, whichever output of whichever command it is. */
#include "tests/support/shell.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ARGUMENTS_MAX = 16 };

static temp_folder folder;

/* Names of a disk without room, with the endings that outputs have. */
static const char *const full_names[] = {"full.csv", "full.json", "full.jsonl", "full.html",
                                         "full.xml", "full.png",  "full.ply"};

/* What stands here without a slash lies in the folder. */
static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded scene = recorded_tetrahedra(8);
    recorded_write_mesh(&folder, "model.obj", &scene, 0);
    recorded_write_cache(&folder, "frames.pc2", &scene);
    recorded_free(&scene);
    for (size_t i = 0; i < sizeof full_names / sizeof *full_names; i++)
        assert_int_equal(symlink("/dev/full", temp_file_path(&folder, full_names[i]).text), 0);
    shell("cd '%s'; printf '{\"model\": \"%s/model.obj\"}\\n' >list.jsonl; "
          "\"$CSCD_TOOL\" check --list list.jsonl --results results.jsonl --quiet; "
          "\"$CSCD_TOOL\" replay model.obj frames.pc2 --json run.json --quiet",
          folder.path, folder.path);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Files of the folder by their paths, all other arguments as they are. */
static const char *place_argument(const char *argument, temp_path *place) {
    *place = temp_file_path(&folder, argument);
    const bool is_file = strchr(argument, '.') != NULL;
    return is_file ? place->text : argument;
}

/* arguments: in one text, with blanks between them. */
static void expect_said_once(int code, const char *full, const char *arguments) {
    const char *list[ARGUMENTS_MAX] = {NULL};
    temp_path places[ARGUMENTS_MAX];
    char *text = strdup(arguments), *rest = text, text_of_error[100];
    for (size_t i = 0; rest != NULL; i++) {
        assert_true(i + 1 < ARGUMENTS_MAX);
        list[i] = place_argument(strsep(&rest, " "), &places[i]);
    }
    snprintf(text_of_error, sizeof text_of_error, "/%s: cannot write", full);
    run_tool_expect_error(code, TEXTS(text_of_error, "No space left on device"), list);
    free(text);
}

static void a_full_disk_is_said_once(void **state) {
    (void)state;
    static const struct {
        const char *full, *arguments;
    } cases[] = {
        {"full.json", "check model.obj frames.pc2 --json full.json"},
        {"full.csv", "check model.obj frames.pc2 --csv full.csv"},
        {"full.csv", "check model.obj frames.pc2 --events full.csv"},
        {"full.xml", "check model.obj frames.pc2 --junit full.xml"},
        {"full.json", "check model.obj frames.pc2 --select full.json"},
        {"full.json", "check model.obj frames.pc2 --csv full.csv --json full.json"},
        {"full.csv", "replay model.obj frames.pc2 --contacts full.csv"},
        {"full.jsonl", "replay model.obj frames.pc2 --contacts full.jsonl"},
        {"full.json", "replay model.obj frames.pc2 --json full.json"},
        {"full.html", "replay model.obj frames.pc2 --report full.html"},
        {"full.csv", "replay model.obj frames.pc2 --contacts full.csv --json full.json --report full.html"},
        {"full.csv", "sense model.obj frames.pc2 --csv full.csv"},
        {"full.json", "sense model.obj frames.pc2 --json full.json"},
        {"full.png", "sense model.obj frames.pc2 --picture full.png"},
        {"full.ply", "preprocess model.obj -o full.ply"},
        {"full.html", "preprocess model.obj -o plan.ply --report full.html"},
        {"full.png", "render model.obj -o full.png"},
        {"full.json", "info model.obj --json full.json"},
        {"full.html", "report run.json -o full.html"},
        {"full.html", "report results.jsonl -o full.html"},
        {"full.jsonl", "merge results.jsonl -o full.jsonl"},
        {"full.xml", "merge results.jsonl --junit full.xml"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_said_once(1, cases[i].full, cases[i].arguments);
    expect_said_once(4, "full.jsonl", "check --list list.jsonl --results full.jsonl");
    expect_said_once(4, "full.jsonl", "check --each model.obj --json full.jsonl");
}

/* The standard output has no name of its own, and what is printed beside a JSON goes elsewhere. */
static void a_full_standard_output_is_said_once(void **state) {
    (void)state;
    static const char *const cases[] = {"check model.obj frames.pc2", "info model.obj", "--version",
                                        "check model.obj frames.pc2 --quiet --json -",
                                        "replay model.obj frames.pc2 --quiet --json -"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *said = shell_output(1, "cd '%s'; \"$CSCD_TOOL\" %s >/dev/full", folder.path, cases[i]);
        assert_string_equal(said, "cscd: standard output: cannot write: No space left on device\n");
        free(said);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_disk_is_said_once),
        cmocka_unit_test(a_full_standard_output_is_said_once),
    };
    return cmocka_run_group_tests_name("write_errors", tests, make_files, remove_files);
}
