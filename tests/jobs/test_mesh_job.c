/* A mesh among many: an interrupt during its search. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/common/terminal.h"
#include "tool/jobs/jobs.h"

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

/* As the tool does when it is interrupted. */
static bool give_up(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    ++*(uint32_t *)user;
    assert_int_equal(raise(SIGTERM), 0);
    return !interrupted();
}

/* Thousands of triangles through one place take long enough to be asked whether they should go on. */
TEST(a_cancelled_search_has_no_answer) {
    enum { FAN = 700 };
    temp_path path = temp_file_path(&own_folder, "fan.obj");
    FILE *file = fopen(path.text, "w");
    for (int i = 0; i < FAN; i++)
        fprintf(file, "v %d 1 1\nv %d -9 1\nv 0.5 %d -9\nf -3 -2 -1\n", i - FAN / 2, FAN / 2 - i, i);
    fclose(file);
    uint32_t asked = 0;
    const ignore_options nothing = {.path = NULL};
    const recording_options source = {.model_path = NULL};
    const answer_options asking = {.events_path = NULL};
    const mesh_job job = {.path = path.text, .source = &source, .ignored = &nothing, .answers = &asking};
    interrupt_catch();
    cscd_context *context;
    cscd_context_options options = cscd_context_defaults();
    options.progress = (cscd_progress){give_up, &asked};
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    mesh_answer answer = {.triangle_count = 7};
    assert_false(mesh_job_run(&job, context, &answer));
    assert_int_equal(asked, 1);
    assert_int_equal(answer.triangle_count, 7);
    cscd_context_destroy(context);
}

AROUND_ALL(own_folder_make, own_folder_remove)
