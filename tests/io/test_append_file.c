/* A record that a full disk lets through in part is taken back. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/io/output_file.h"

#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

TEST(torn_records_are_taken_back) {
    enum { RECORD = 100 };
    char record[RECORD];
    struct rlimit before, full;
    struct stat status;
    io_error error;
    append_file file;
    const temp_folder folder = temp_folder_make();
    const temp_path path = temp_file_path(&folder, "records");
    memset(record, 'x', sizeof record);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    full = before;
    full.rlim_cur = RECORD + RECORD / 2;
    assert_true(append_file_open(path.text, &file, &error));
    assert_true(append_file_add(&file, record, RECORD, &error));
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &full), 0);
    const bool added = append_file_add(&file, record, RECORD, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_false(added);
    assert_int_equal(stat(path.text, &status), 0);
    assert_int_equal(status.st_size, RECORD);
    assert_true(append_file_add(&file, record, RECORD, &error)); /* once there is room */
    assert_int_equal(stat(path.text, &status), 0);
    assert_int_equal(status.st_size, 2 * RECORD);
    assert_true(append_file_close(&file, &error));
    temp_folder_remove(&folder);
}
