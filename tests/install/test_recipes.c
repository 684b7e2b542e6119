/* The recipes of package managers name the version, the licence, the options and the files of this tree. */
#include "tests/support/shell.h"
#include "tests/support/test.h"

static void recipes_fit_the_tree(void **state) {
    (void)state;
    shell("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tests/install/recipes.py");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(recipes_fit_the_tree)};
    return cmocka_run_group_tests_name("recipes", tests, NULL, NULL);
}
