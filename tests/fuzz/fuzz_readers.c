/* Files of ours with random damage: each is refused in one line that names it, or read, and no sanitizer complains. usage:
 * fuzz_readers SECONDS SEED FILE... The ending says what a file is: .plan.ply a plan of the mesh beside it that ends in .obj, .pc2 and
 * .mdd frames of such a mesh, .summary.json a summary, .jobs.jsonl a list of jobs, .results.jsonl their results; any other is a mesh.
 * The file that is read when the program dies is left where the first line says. */
#include "src/io/animation.h"
#include "src/io/mesh_file.h"
#include "src/io/path_name.h"
#include "src/io/plan_file.h"
#include "src/tool/jobs/job_list.h"
#include "src/tool/jobs/job_results.h"
#include "src/tool/summary_file.h"
#include "tests/support/io/byte_damage.h"
#include "tests/support/temp_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* What a file is read as, beside the mesh that it belongs to. */
typedef bool file_reading(const char *path, const mesh_file *model, io_error *error);

static void insist_on(bool held, const char *what) {
    if (held) return;
    fprintf(stderr, "%s\n", what);
    abort();
}

static bool read_frames(const char *path, const mesh_file *model, io_error *error) {
    animation *frames;
    if (!animation_open(&path, 1, model->vertex_count, NULL, &frames, error)) return false;
    double *positions = malloc(3 * sizeof *positions * model->vertex_count);
    insist_on(positions != NULL, "out of memory");
    bool read = true;
    const uint32_t count = animation_frame_count(frames);
    for (uint32_t i = 0; i < 3 && read; i++) {
        read = animation_read(frames, i == 0 ? 0 : i == 1 ? count / 2 : count - 1, positions, error);
        for (size_t k = 0; read && k < 3 * (size_t)model->vertex_count; k++)
            insist_on(isfinite(positions[k]), "a position is not finite");
    }
    free(positions);
    animation_close(frames);
    return read;
}

static bool read_mesh(const char *path, const mesh_file *model, io_error *error) {
    mesh_file mesh;
    (void)model;
    if (!mesh_file_read(path, &mesh, error)) return false;
    insist_on(mesh.vertex_count > 0 && mesh.triangle_count > 0, "an empty mesh was read");
    for (size_t i = 0; i < 3 * (size_t)mesh.vertex_count; i++)
        insist_on(isfinite(mesh.positions[i]), "a position is not finite");
    for (size_t i = 0; i < 3 * (size_t)mesh.triangle_count; i++)
        insist_on(mesh.triangles[i] < mesh.vertex_count, "a corner is no vertex");
    io_error no_frames = {""};
    if (mesh.format == MESH_FORMAT_GLTF) read_frames(path, &mesh, &no_frames);
    mesh_file_free(&mesh);
    return true;
}

static bool read_plan(const char *path, const mesh_file *model, io_error *error) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 1;
    cscd_object_desc desc =
        cscd_object_of_triangles(model->vertex_count, model->triangle_count, model->triangles);
    insist_on(cscd_context_create(&options, &context) == CSCD_OK &&
                  cscd_mesh_create(context, &desc, 1, &mesh) == CSCD_OK,
              "the mesh of the corpus is refused");
    const bool read = plan_file_read(path, context, mesh, &plan, error);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return read;
}

static bool read_summary(const char *path, const mesh_file *model, io_error *error) {
    (void)model;
    char *text = summary_file_read(path, error);
    free(text);
    return text != NULL;
}

static bool read_jobs(const char *path, const mesh_file *model, io_error *error) {
    job_list list;
    (void)model;
    if (!job_list_read(path, &list, error)) return false;
    bool read = true;
    for (uint32_t job = 0; job < list.count && read; job++) {
        job_line line;
        read = job_list_line(&list, job, &line, error);
        if (read) job_line_free(&line);
    }
    job_list_free(&list);
    return read;
}

/* The hash and the number of jobs are those of the file's first line, if that is whole. */
static bool read_results(const char *path, const mesh_file *model, io_error *error) {
    char text[4096] = "";
    job_record first;
    job_results results;
    (void)model;
    FILE *file = fopen(path, "rb");
    insist_on(file != NULL, "the damaged file cannot be opened");
    const size_t size = fread(text, 1, sizeof text, file);
    fclose(file);
    const char *end = memchr(text, '\n', size);
    if (end == NULL || !job_record_read(text, (size_t)(end - text), &first))
        return io_fail(error, "%s: no line of results", path);
    if (!job_results_open(path, RESUME_ALL, first.list, first.jobs, &results, error)) return false;
    return job_results_close(&results, error);
}

static const struct {
    const char *ending;
    file_reading *read;
} readings[] = {{".plan.ply", read_plan},
                {".pc2", read_frames},
                {".mdd", read_frames},
                {".summary.json", read_summary},
                {".jobs.jsonl", read_jobs},
                {".results.jsonl", read_results},
                {"", read_mesh}};

static bool ends_in(const char *text, const char *ending) {
    const size_t length = strlen(text), end = strlen(ending);
    return length >= end && strcmp(text + length - end, ending) == 0;
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
    unsigned char *bytes = malloc(*size);
    insist_on(*size > 0 && bytes != NULL && fread(bytes, 1, *size, file) == *size, path);
    fclose(file);
    return bytes;
}

static void fuzz_file(const char *path, const temp_folder *folder, double seconds, uint64_t seed) {
    const char *name = path_file_name(path);
    size_t whole = 0, kind = 0, inputs = 0, refused = 0;
    while (!ends_in(path, readings[kind].ending)) kind++;
    unsigned char *bytes = read_bytes(path, &whole), *damaged = malloc(whole + 4 * DAMAGE_GROWTH_MAX);
    mesh_file model = {0};
    if (readings[kind].read == read_plan || readings[kind].read == read_frames) model = model_of(path);
    insist_on(damaged != NULL, "out of memory");
    const double end = now_seconds() + seconds;
    random_stream random = stream_start(seed);
    for (; inputs == 0 || now_seconds() < end; inputs++) {
        io_error error = {""};
        size_t size = whole;
        memcpy(damaged, bytes, whole);
        for (uint32_t fault = 1 + stream_below(&random, 4); fault > 0; fault--)
            size = damage_bytes(&random, damaged, size);
        const temp_path input = temp_file_write(folder, name, damaged, size);
        if (readings[kind].read(input.text, &model, &error)) continue;
        refused++;
        if (strstr(error.text, name) == NULL || strpbrk(error.text, "\r\n") != NULL) {
            fprintf(stderr, "%s: input %zu is refused so: %s\n", name, inputs, error.text);
            abort();
        }
    }
    printf("%s: %zu inputs, %zu refused\n", name, inputs, refused);
    if (model.vertex_count > 0) mesh_file_free(&model);
    free(bytes);
    free(damaged);
}

int main(int argument_count, char **arguments) {
    if (argument_count < 4) {
        fprintf(stderr, "usage: %s SECONDS SEED FILE...\n", arguments[0]);
        return 2;
    }
    const double seconds = strtod(arguments[1], NULL) / (argument_count - 3);
    const uint64_t seed = strtoull(arguments[2], NULL, 16);
    const temp_folder folder = temp_folder_make();
    printf("inputs are in %s, seed %llx\n", folder.path, (unsigned long long)seed);
    fflush(stdout);
    for (int i = 3; i < argument_count; i++) fuzz_file(arguments[i], &folder, seconds, seed + (uint64_t)i);
    temp_folder_remove(&folder);
    return 0;
}
