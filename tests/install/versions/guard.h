/* What a caller checks after each call: nothing was written behind its struct, and members that only its own header
 * knows are 0. WITH_LATER: the caller was compiled with the headers of a later version. */
#pragma once

#include <cscd/cscd.h>
#include <cscd/research.h>
#include <cscd/sensors.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GUARD_SIZE = 256 };

/* A struct of the API, and bytes behind it that nobody may touch. */
#define GUARDED(type, name)                                                                                  \
    struct {                                                                                                 \
        type value;                                                                                          \
        unsigned char guard[GUARD_SIZE];                                                                     \
    } name;                                                                                                  \
    memset(&name, 0xa5, sizeof name)

static inline void expect_that(int holds, const char *what, const char *detail) {
    if (holds) return;
    printf("%s: %s\n", what, detail);
    exit(1);
}

static inline void expect_guard(const unsigned char *guard, const char *what) {
    for (int i = 0; i < GUARD_SIZE; i++)
        expect_that(guard[i] == 0xa5, what, "bytes behind the caller's struct have changed");
}

#ifdef WITH_LATER
#define EXPECT_LATER(type, value)                                                                            \
    expect_that((value).later_member[0] == 0 && (value).later_member[1] == 0, #type,                         \
                "the later member is not 0")
#else
#define EXPECT_LATER(type, value) ((void)0)
#endif

/* Checks what a call has filled, and says so. */
#define EXPECT_FILLED(type, name)                                                                            \
    (expect_guard(name.guard, #type), EXPECT_LATER(type, name.value), (void)puts(#type))
