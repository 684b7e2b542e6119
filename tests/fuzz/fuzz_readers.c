/* Files of strangers: each is refused in one line that names it, or read, within limits of time and memory, and no sanitizer complains.
 * usage: fuzz_readers SECONDS SEED FILE... for files of ours with random damage, whose endings say what they are (readings.c): a plan or
 * frames belong to the mesh beside them that ends in .obj. fuzz_readers --replay FOLDER... for all files of folders that are called as
 * their formats. The file that is read when the program dies is left where the first line says. */
#include "tests/fuzz/readings.h"
#include "tests/support/files.h"
#include "tool/io/io.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void insist_on(bool held, const char *what) {
    if (held) return;
    fprintf(stderr, "%s\n", what);
    abort();
}

static double now_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The mesh that a plan or frames belong to: the same name with .obj, up to its first dot. */
static mesh_file model_of(const char *path) {
    char name[4096];
    mesh_file model;
    io_error error;
    const size_t folder = (size_t)(path_file_name(path) - path), stem = strcspn(path + folder, ".");
    snprintf(name, sizeof name, "%.*s.obj", (int)(folder + stem), path);
    insist_on(mesh_file_read(name, &model, &error), error.text);
    return model;
}

static unsigned char *read_bytes(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    insist_on(file != NULL && fseek(file, 0, SEEK_END) == 0, path);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    insist_on(bytes != NULL && fread(bytes, 1, *size, file) == *size, path);
    fclose(file);
    return bytes;
}

static void fuzz_file(const char *path, const temp_folder *folder, double seconds, uint64_t seed) {
    const char *name = path_file_name(path);
    const reading *r = reading_of_file(path);
    size_t whole = 0, inputs = 0, refused = 0;
    unsigned char *bytes = read_bytes(path, &whole), *damaged = malloc(whole + 4 * DAMAGE_GROWTH_MAX);
    mesh_file model = {0};
    insist_on(r != NULL && whole > 0 && damaged != NULL, path);
    if (r->has_model) model = model_of(path);
    const double end = now_seconds() + seconds;
    random_stream random = stream_start(seed);
    for (; inputs == 0 || now_seconds() < end; inputs++) {
        size_t size = whole;
        memcpy(damaged, bytes, whole);
        for (uint32_t fault = 1 + stream_below(&random, 4); fault > 0; fault--)
            size = damage_bytes(&random, damaged, size);
        refused += !reading_try(r, folder, name, &model, damaged, size);
    }
    printf("%s: %zu inputs, %zu refused\n", name, inputs, refused);
    if (r->has_model) mesh_file_free(&model);
    free(bytes);
    free(damaged);
}

static void replay_folder(const char *path, const temp_folder *folder) {
    const reading *r = reading_named(path_file_name(path));
    DIR *entries = opendir(path);
    size_t inputs = 0, refused = 0;
    insist_on(r != NULL && entries != NULL, path);
    for (struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        char file[4096], name[300];
        size_t size;
        if (entry->d_name[0] == '.') continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        snprintf(name, sizeof name, "%s%s", entry->d_name, r->ending);
        unsigned char *bytes = read_bytes(file, &size);
        refused += !reading_try(r, folder, name, reading_tetrahedron(), bytes, size);
        inputs++;
        free(bytes);
    }
    closedir(entries);
    insist_on(inputs > 0, path);
    printf("%s: %zu kept inputs, %zu refused\n", r->format, inputs, refused);
}

int main(int argument_count, char **arguments) {
    const bool replay = argument_count > 2 && strcmp(arguments[1], "--replay") == 0;
    if (!replay && argument_count < 4) {
        fprintf(stderr, "usage: %s SECONDS SEED FILE... | --replay FOLDER...\n", arguments[0]);
        return 2;
    }
    const double seconds = strtod(arguments[1], NULL) / (argument_count - 3);
    const uint64_t seed = strtoull(arguments[2], NULL, 16);
    const temp_folder folder = temp_folder_make();
    printf("inputs are in %s", folder.path);
    printf(replay ? "\n" : ", seed %llx\n", (unsigned long long)seed);
    fflush(stdout);
    for (int i = replay ? 2 : 3; i < argument_count; i++) {
        if (replay)
            replay_folder(arguments[i], &folder);
        else
            fuzz_file(arguments[i], &folder, seconds, seed + (uint64_t)i);
    }
    temp_folder_remove(&folder);
    return 0;
}
