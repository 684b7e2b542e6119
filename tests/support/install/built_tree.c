/* The build whose files are installed, and make for it, as a user runs it. */
#include "tests/support/install/built_tree.h"

#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool built_tree_find(built_tree *out) {
    static const char without[] = "-without-gsl";
    const char *tool = getenv("CSCD_TOOL");
    if (tool == NULL) fail_msg("CSCD_TOOL must name the built tool; run the tests through tests/run.sh");
    snprintf(out->root, sizeof out->root, "%s", tool);
    *strrchr(out->root, '/') = '\0';
    char *name = strrchr(out->root, '/');
    assert_non_null(name);
    *name++ = '\0';
    char *suffix = strstr(name, without);
    out->gsl = suffix == NULL;
    if (suffix != NULL) *suffix = '\0';
    snprintf(out->config, sizeof out->config, "%s", name);
    if (strcmp(out->config, "release") == 0) return true;
    print_error("only a release is installed, and this is the configuration %s\n", out->config);
    return false;
}

void built_tree_make(const built_tree *build, const char *target, const char *place, const char *variables) {
    shell("env -u MAKEFLAGS -u MAKELEVEL -u MAKEOVERRIDES make -s %s BUILD_ROOT='%s' CONFIG=%s GSL=%d "
          "DESTDIR='%s' %s",
          target, build->root, build->config, build->gsl, place, variables);
}
