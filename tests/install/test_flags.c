/* Flags of the caller that would change what is computed are refused with a sentence, by make and by the sources, as are those for
 * a 32-bit system; others are harmless. */
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* What make says and would run for one object of the library. */
static char *make_object(int status, const char *variables) {
    return shell_output(
        status,
        "env -u MAKEFLAGS -u MAKELEVEL -u MAKEOVERRIDES make -n BUILD_ROOT=build/no-such-build "
        "build/no-such-build/release/objects/src/core/sort.o %s",
        variables);
}

static void make_refuses_other_arithmetic(void **state) {
    (void)state;
    static const char *const variables[] = {"CFLAGS='-g -Ofast'", "CFLAGS=-ffast-math",
                                            "CPPFLAGS=-ffinite-math-only",
                                            "CC='clang -funsafe-math-optimizations'"};
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++) {
        char *said = make_object(2, variables[i]);
        if (strstr(said, "IEEE arithmetic: leave out -") == NULL) fail_msg("%s: %s", variables[i], said);
        free(said);
    }
}

/* Who compiles the sources in another way reads the sentence, too. */
static void sources_refuse_other_arithmetic(void **state) {
    (void)state;
    static const char compile[] = "echo '#include \"src/core/floating.h\"' | %s %s -I. -fsyntax-only -x c -";
    static const char *const flags[] = {"-Ofast", "-ffast-math", "-ffinite-math-only"};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        char *said = shell_output(1, compile, "${CC:-cc}", flags[i]);
        if (strstr(said, "IEEE arithmetic") == NULL) fail_msg("%s: %s", flags[i], said);
        free(said);
    }
    shell(compile, "${CC:-cc}", "-Ofast -fno-fast-math");
    shell(compile, "${CC:-cc}", "-Os -fno-math-errno -fno-trapping-math");
}

/* The sentence comes first, also where the headers of such a system are missing. */
static void sources_refuse_32_bits(void **state) {
    (void)state;
    static const char compile[] = "%s %s -Iinclude -I. -fsyntax-only src/core/system.c";
#ifdef __x86_64__
    static const char *const flags[] = {"-m32", "-mx32"};
#else
    static const char *const flags[] = {"-D__SIZEOF_POINTER__=4"};
#endif
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        char *said = shell_output(1, compile, "${CC:-cc}", flags[i]);
        if (strstr(said, "cscd runs on 64-bit systems") == NULL) fail_msg("%s: %s", flags[i], said);
        free(said);
    }
    shell(compile, "${CC:-cc}", "-D_GNU_SOURCE");
}

/* Flags of the caller are passed on, but for those that the library is built without. */
static void flags_that_are_left_out(void **state) {
    (void)state;
    char *said =
        make_object(0, "V=1 CPPFLAGS=-D_FORTIFY_SOURCE=2 CFLAGS='-Os -flto=auto -ffp-contract=fast -g3'");
    if (strstr(said, " -D_FORTIFY_SOURCE=2 -Os -g3 ") == NULL || strstr(said, " -ffp-contract=off ") == NULL)
        fail_msg("%s", said);
    if (strstr(said, "-flto") != NULL || strstr(said, "-ffp-contract=fast") != NULL) fail_msg("%s", said);
    free(said);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(make_refuses_other_arithmetic),
        cmocka_unit_test(sources_refuse_other_arithmetic),
        cmocka_unit_test(sources_refuse_32_bits),
        cmocka_unit_test(flags_that_are_left_out),
    };
    return cmocka_run_group_tests_name("flags", tests, NULL, NULL);
}
