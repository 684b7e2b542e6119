/* The files of a room of tests are one program. Each runs in a process of its own: as the program that has its name (a link), or by
 * its name as the first argument. A name of cases may follow, with * and ?. The macros of tests/support/test.h add tests to their file. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif
/* They run in the order of their lines. */
typedef struct room_test {
    const char *name;
    void (*run)(void **state);
    int line;
    struct room_test *next;
} room_test;

/* What stands around every test of a file, or around all of them: NULL for none. */
typedef enum room_span { ROOM_EACH_TEST, ROOM_ALL_TESTS } room_span;

void room_add_test(const char *file, room_test *test);
void room_add_around(const char *file, room_span span, int (*set_up)(void **state),
                     int (*tear_down)(void **state));

/* Runs in place of the tests of the file. */
void room_add_main(const char *file, int (*run)(void));

/* Runs the tests of the file: how many failed. */
int room_run_tests(const char *file);

/* What stands behind the name of the file; argv[0] of the program is first, as in main. */
int room_argument_count(void);
const char *room_argument(int index);
#ifdef __cplusplus
}
#endif
