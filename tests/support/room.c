/* The main of a room of tests. */
#include "tests/support/test.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILES_MAX = 64 };

typedef int (*room_fixture)(void **state);

typedef struct room_file {
    const char *name;
    int (*run)(void);
    room_test *tests; /* by their lines */
    int test_count;
    room_fixture set_up[2], tear_down[2]; /* by room_span */
} room_file;

static room_file files[FILES_MAX];
static int file_count;
static int argument_count;
static char **arguments;

static room_file *file_of(const char *name) {
    for (int i = 0; i < file_count; i++)
        if (strcmp(files[i].name, name) == 0) return &files[i];
    if (file_count == FILES_MAX) {
        fprintf(stderr, "room.c has room for %d files\n", FILES_MAX);
        exit(2);
    }
    files[file_count].name = name;
    return &files[file_count++];
}

void room_add_test(const char *name, room_test *test) {
    room_file *file = file_of(name);
    room_test **place = &file->tests;
    while (*place != NULL && (*place)->line < test->line) place = &(*place)->next;
    test->next = *place;
    *place = test;
    file->test_count++;
}

void room_add_around(const char *name, room_span span, room_fixture set_up, room_fixture tear_down) {
    room_file *file = file_of(name);
    file->set_up[span] = set_up;
    file->tear_down[span] = tear_down;
}

void room_add_main(const char *name, int (*run)(void)) {
    file_of(name)->run = run;
}

/* In a pattern, * stands for any characters and ? for one. */
static bool matches_pattern(const char *pattern, const char *text) {
    if (*pattern == '*')
        return matches_pattern(pattern + 1, text) || (*text != '\0' && matches_pattern(pattern, text + 1));
    if (*pattern == '\0' || *text == '\0') return *pattern == *text;
    return (*pattern == '?' || *pattern == *text) && matches_pattern(pattern + 1, text + 1);
}

int room_run_tests(const char *name) {
    const room_file *file = file_of(name);
    struct CMUnitTest *tests = calloc((size_t)file->test_count + 1, sizeof *tests);
    if (tests == NULL) return 1;
    size_t count = 0;
    const char *chosen = argument_count > 1 ? arguments[1] : "*";
    for (const room_test *t = file->tests; t != NULL; t = t->next)
        if (matches_pattern(chosen, t->name))
            tests[count++] = (struct CMUnitTest){t->name, t->run, file->set_up[ROOM_EACH_TEST],
                                                 file->tear_down[ROOM_EACH_TEST], NULL};
    if (count == 0) fprintf(stderr, "%s has no test that is called %s\n", name, chosen);
    int failed = count == 0 ? 1
                            : _cmocka_run_group_tests(name, tests, count, file->set_up[ROOM_ALL_TESTS],
                                                      file->tear_down[ROOM_ALL_TESTS]);
    free(tests);
    return failed;
}

int room_argument_count(void) {
    return argument_count;
}

const char *room_argument(int index) {
    return arguments[index];
}

/* The part of a path that names a file: behind folders, before the endings of programs. */
static const room_file *find_file(const char *path) {
    const char *name = path;
    for (const char *c = path; *c != '\0'; c++)
        if (*c == '/' || *c == '\\') name = c + 1;
    const size_t length = strcspn(name, ".");
    for (int i = 0; i < file_count; i++)
        if (strlen(files[i].name) == length && memcmp(files[i].name, name, length) == 0) return &files[i];
    return NULL;
}

static int tell_files(const char *program) {
    fprintf(stderr, "%s FILE [CASE]: the files are", program);
    for (int i = 0; i < file_count; i++) fprintf(stderr, " %s", files[i].name);
    fprintf(stderr, "\n");
    return 2;
}

int main(int argc, char **argv) {
    const room_file *file = argc > 0 ? find_file(argv[0]) : NULL;
    const int own = file == NULL; /* the name is an argument */
    if (own && argc > 1) file = find_file(argv[1]);
    if (file == NULL) return tell_files(argc > 0 ? argv[0] : "room");
    argument_count = argc - own;
    arguments = argv + own;
    return file->run != NULL ? file->run() : room_run_tests(file->name);
}
