/* Included by every file of tests: cmocka, the headers that must come before it, and what makes a function a test. */
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

#ifdef TEST_FILE /* its name */
#include "tests/support/room.h"

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
