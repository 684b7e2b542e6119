/* Tests make install and make uninstall with names of any kind, and among folders that somebody else made. */
#include "cscd/cscd.h"
#include "tests/support/install/built_tree.h"
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static built_tree build;
static temp_folder folder;

static int find_tree(void **state) {
    (void)state;
    if (!built_tree_find(&build)) return -1;
    folder = temp_folder_make();
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    if (folder.path[0] != '\0') shell("rm -rf '%s'", folder.path);
    return 0;
}

static void expect_output(const char *what, char *found, const char *expected) {
    if (strcmp(found, expected) != 0) fail_msg("%s: found\n%s\nexpected\n%s", what, found, expected);
    free(found);
}

/* Every character that a shell, make, sed or pkg-config takes for its own; make wants a dollar twice. */
static void quotes_in_prefix(void **state) {
    (void)state;
    static const char name[] = "it'\\''s \"a\" %s & c|d\\e;f `g` *";
    char given[64], made[64], variables[96], place[512], where[640];
    snprintf(given, sizeof given, name, "$$b");
    snprintf(made, sizeof made, name, "$b");
    snprintf(variables, sizeof variables, "PREFIX='/opt/%s'", given);
    snprintf(place, sizeof place, "%s/quotes", folder.path);
    snprintf(where, sizeof where, "%s/opt/%s", place, made);
    built_tree_make(&build, "install", place, variables);
    shell("test -x '%s/bin/cscd' && cmp include/cscd/cscd.h '%s/include/cscd/cscd.h'", where, where);
    /* What pkg-config says is for a shell; it leaves the dollar to its reader. DESTDIR is not part of it. */
    char *flags =
        shell_output(0,
                     "PKG_CONFIG_PATH='%s/lib/pkgconfig' pkg-config --cflags cscd | sed 's/\\$/\\\\$/g' | "
                     "xargs -d '\\n' -I FLAGS sh -c 'printf \"%%s\\n\" FLAGS'",
                     where);
    char expected[128];
    snprintf(expected, sizeof expected, "-I/opt/it's \"a\" $b & c|d\\e;f `g` */include\n");
    expect_output("flags", flags, expected);
    expect_output("version of the tool", shell_output(0, "'%s/bin/cscd' --version | head -c 5", where),
                  "cscd ");
    built_tree_make(&build, "uninstall", place, variables);
    expect_output("what is left", shell_output(0, "ls -d '%s' 2>/dev/null || true", place), "");
}

static void expect_folders(const char *place, const char *expected) {
    expect_output("what is left", shell_output(0, "find '%s' -printf '<%%P>\n'", place), expected);
}

/* DESTDIR was there before, or was made anew after somebody removed it: uninstall leaves it, and takes what install made, there and
 * nowhere else. Two installations from one build, one DESTDIR written in two ways, and headers in a folder with a blank. */
static void destdirs_of_somebody_else(void **state) {
    (void)state;
    static const char variables[] = "PREFIX=/usr INCLUDEDIR='/usr/my headers'";
    char first[512], second[512];
    snprintf(first, sizeof first, "%s/first", folder.path);
    shell("mkdir '%s'", first);
    built_tree_make(&build, "install-library", first, variables);
    snprintf(second, sizeof second, "%s/./second/", folder.path);
    built_tree_make(&build, "install-library", second, variables);
    shell("flags=$(PKG_CONFIG_PATH='%s/usr/lib/pkgconfig' pkg-config --cflags cscd) && "
          "echo '#include <cscd/cscd.h>' | eval \"${CC:-cc} $flags -fsyntax-only -x c -\"",
          first);

    built_tree_make(&build, "uninstall", first, variables);
    expect_folders(first, "<>\n");
    snprintf(second, sizeof second, "%s/second", folder.path);
    shell("test -f '%s/usr/lib/libcscd.a' && test -f '%s/usr/my headers/cscd/cscd.h'", second, second);

    shell("mv '%s' '%s/old' && mkdir -p '%s/usr/lib'", second, folder.path, second);
    built_tree_make(&build, "uninstall", second, variables);
    expect_folders(second, "<>\n<usr>\n<usr/lib>\n");

    /* The same folders under their name again: these go. */
    shell("rm -r '%s' && mv '%s/old' '%s'", second, folder.path, second);
    built_tree_make(&build, "uninstall", second, variables);
    expect_output("what is left", shell_output(0, "ls -d '%s' 2>/dev/null || true", second), "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quotes_in_prefix),
        cmocka_unit_test(destdirs_of_somebody_else),
    };
    return cmocka_run_group_tests_name("places", tests, find_tree, remove_all);
}
