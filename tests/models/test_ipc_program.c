/* Runs the program `ipc` as a user does: its list of scenes and its errors. */
#include "models/ipc/scenes.h"
#include "tests/support/models/model_program.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int use_program(void **state) {
    (void)state;
    model_program_use("ipc");
    return 0;
}

static void help_lists_the_scenes(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("--help"), usage = run_tool((const char *const[]){NULL});
    assert_int_equal(run.code, 0);
    assert_string_equal(run.error, "");
    for (uint32_t i = 0; i < ipc_scene_count; i++) {
        assert_non_null(strstr(run.out, ipc_scenes[i].name));
        assert_non_null(strstr(run.out, ipc_scenes[i].text));
    }
    assert_int_equal(usage.code, 2);
    assert_string_equal(usage.error, run.out);
    assert_string_equal(usage.out, "");
    tool_run_free(&run);
    tool_run_free(&usage);
    EXPECT_TOOL(2, "rings");
}

#define REFUSED(code, text, ...)                                                                             \
    model_program_refuses("ipc", (code), (text), (const char *const[]){__VA_ARGS__, NULL})

/* Arguments are checked before anything is recorded. */
static void unknown_scenes_are_refused(void **state) {
    (void)state;
    temp_folder empty = temp_folder_make();
    REFUSED(2, "'ring'", "ring", empty.path);
    REFUSED(2, "'pres'", "rings", "pres", empty.path);
    assert_int_not_equal(access(temp_file_path(&empty, "rings.obj").text, F_OK), 0);
    temp_folder_remove(&empty);
}

/* The error names the path. */
static void what_cannot_be_written_is_an_error(void **state) {
    (void)state;
    temp_folder blocked = temp_folder_make();
    temp_path none = temp_file_path(&blocked, "none"), cache = temp_file_path(&blocked, "rings.pc2");
    REFUSED(1, none.text, "rings", none.text);
    assert_int_not_equal(access(none.text, F_OK), 0);
    assert_int_equal(mkdir(cache.text, 0700), 0);
    REFUSED(1, cache.text, "rings", blocked.path);
    assert_int_equal(rmdir(cache.text), 0); /* still an empty folder */
    temp_folder_remove(&blocked);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_lists_the_scenes),
        cmocka_unit_test(unknown_scenes_are_refused),
        cmocka_unit_test(what_cannot_be_written_is_an_error),
    };
    return cmocka_run_group_tests_name("ipc: program", tests, use_program, NULL);
}
