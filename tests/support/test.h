/* Included by every file of tests: cmocka, the headers that must come before it, and its place in the program of its room. */
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

#ifdef TEST_FILE /* its name; the compiler is told that main is called otherwise, too */
#include "tests/support/room.h"

int main(void);
__attribute__((constructor)) static void room_add_file(void) {
    room_add(TEST_FILE, main);
}
#endif
