/* Included by every file of tests: cmocka, the headers that must come before it, what makes a function a test, and
 * rooms of tests. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#include <cmocka.h>
#ifdef __cplusplus
}
#endif

/* How often something is repeated: less with sanitizers and in emulators. */
#ifdef SLOW_MACHINE
#define PACED(usual, slow) (slow)
#else
#define PACED(usual, slow) (usual)
#endif

/* How many random cases, steps or triangles there are: more with NIGHTLY=1, as in .ci/nightly. */
#ifdef NIGHTLY_TESTS
#define NIGHTLY(usual, nightly) (nightly)
#else
#define NIGHTLY(usual, nightly) (usual)
#endif

/* A call that must succeed: its status is CSCD_OK, which is 0. */
#define expect_ok(...) expect_ok_at(__VA_ARGS__, #__VA_ARGS__, __FILE__, __LINE__)
static inline void expect_ok_at(unsigned status, const char *call, const char *file, int line) {
    if (status == 0) return;
    print_error("status %u of %s\n", status, call);
    _fail(file, line);
}

/* ---- rooms --------------------------------------------------------------------------------------------- */

#ifdef __cplusplus
extern "C" {
#endif
/* The files of a room of tests are one program. Each runs in a process of its own: as the program that has its name (a link), or by
 * its name as the first argument. A name of cases may follow, with * and ?. The tests of a file run in the order of their lines. */
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

#ifdef TEST_FILE /* its name */
#define BEFORE_MAIN(function, call)                                                                          \
    __attribute__((constructor)) static void function(void) {                                                \
        call;                                                                                                \
    }

/* TEST(name) { ... } is a test of this file. What it is given as `state` is what a set-up has left there. */
#define TEST(name)                                                                                           \
    static void name(void **state);                                                                          \
    static room_test test_##name = {#name, name, __LINE__, NULL};                                            \
    BEFORE_MAIN(add_##name, room_add_test(TEST_FILE, &test_##name))                                          \
    static void name(__attribute__((unused)) void **state)

/* Runs before and after each test of this file, or all of them. */
#define AROUND_EACH(set_up, tear_down)                                                                       \
    BEFORE_MAIN(add_around_each, room_add_around(TEST_FILE, ROOM_EACH_TEST, set_up, tear_down))
#define AROUND_ALL(set_up, tear_down)                                                                        \
    BEFORE_MAIN(add_around_all, room_add_around(TEST_FILE, ROOM_ALL_TESTS, set_up, tear_down))

/* What this file does in place of running its tests. */
#define FILE_MAIN(function) BEFORE_MAIN(add_main, room_add_main(TEST_FILE, function))
#endif
