/* A file of results that changes between the two times that it is read. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/jobs/jobs.h"

#include <stdio.h>
#include <string.h>

#define LINE(list, jobs, job, result, found)                                                                 \
    "{\"list\":\"0123456789abcde" list "\",\"jobs\":" jobs ",\"job\":" job ",\"result\":\"" result           \
    "\",\"found\":" found ",\"name\":\"body\"}\n"

static bool count_line(void *user, const char *line, size_t length, const job_record *record,
                       io_error *error) {
    (void)error;
    assert_int_equal(line[length - 1], '}');
    assert_int_equal(record->job, *(uint32_t *)user);
    ++*(uint32_t *)user;
    return true;
}

/* Whatever of the second line is another one then, it is not written as if it had been proven. */
TEST(a_file_that_changes_while_it_is_read_is_noticed) {
    static const char first[] = LINE("f", "2", "1", "touching", "false"),
                      second[] = LINE("f", "2", "2", "touching", "false");
    static const char *const others[] = {second,
                                         LINE("f", "2", "1", "touching", "false"),
                                         LINE("e", "2", "2", "touching", "false"),
                                         LINE("f", "3", "2", "touching", "false"),
                                         LINE("f", "2", "2", "crossing", "false"),
                                         LINE("f", "2", "2", "touching", "true "),
                                         "{\"list\":\"0123456789abcdef\"",
                                         ""};
    enum {
        CUT = 4
    }; /* within the name, which is as long in both lines: "dy" of the first would make it whole */
    for (size_t i = 0; i <= sizeof others / sizeof *others; i++) {
        char text[400];
        job_merge merge;
        io_error error = {""};
        uint32_t lines = 0;
        snprintf(text, sizeof text, "%s%s", first, second);
        const temp_path path = temp_file_write(&own_folder, "changed.jsonl", text, strlen(text));
        const char *paths[] = {path.text};
        assert_true(job_merge_read(paths, 1, MERGE_WHOLE, &merge, &error));
        const bool cut = i == sizeof others / sizeof *others;
        snprintf(text, sizeof text, "%s%s", first, cut ? second : others[i]);
        temp_file_write(&own_folder, "changed.jsonl", text, strlen(text) - (cut ? CUT : 0));
        assert_int_equal(job_merge_visit(&merge, count_line, &lines, &error), i == 0);
        assert_int_equal(lines, i == 0 ? 2 : 1);
        assert_true(i == 0 || strstr(error.text, "changed.jsonl: has changed while it was read") != NULL);
        job_merge_free(&merge);
    }
}

AROUND_ALL(own_folder_make, own_folder_remove)
