/* The main of a room of tests. */
#include "tests/support/room.h"

#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

enum { FILES_MAX = 64 };

typedef struct room_file {
    const char *name;
    int (*run)(void);
} room_file;

static room_file files[FILES_MAX];
static int file_count;
static int argument_count;
static char **arguments;

void room_add(const char *name, int (*run)(void)) {
    if (file_count < FILES_MAX) files[file_count] = (room_file){name, run};
    file_count++;
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
    if (file_count > FILES_MAX) return fprintf(stderr, "room.c has room for %d files\n", FILES_MAX), 2;
    const room_file *file = argc > 0 ? find_file(argv[0]) : NULL;
    const int own = file == NULL; /* the name is an argument */
    if (own && argc > 1) file = find_file(argv[1]);
    if (file == NULL) return tell_files(argc > 0 ? argv[0] : "room");
    argument_count = argc - own;
    arguments = argv + own;
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return file->run();
}
