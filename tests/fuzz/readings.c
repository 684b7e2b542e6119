/* The reader of each format, and what must hold of what it makes of a file. */
#include "tests/fuzz/readings.h"

#include "tool/io/animation.h"
#include "tool/io/io.h"
#include "tool/io/ply.h"
#include "tool/jobs/job_list.h"
#include "tool/jobs/jobs.h"
#include "tool/tool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void insist_on(bool held, const char *what) {
    if (held) return;
    fprintf(stderr, "%s\n", what);
    abort();
}

static bool read_frames_of(const char *path, const mesh_file *model, io_error *error) {
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
    if (mesh.format == MESH_FORMAT_GLTF) read_frames_of(path, &mesh, &no_frames);
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

/* A line of results becomes a test case and a row of a page. */
static bool take_line(void *user, const char *line, size_t length, const job_record *record,
                      io_error *error) {
    FILE *junit = user;
    job_row row;
    (void)error;
    insist_on(job_junit_add(junit, line, length, record), "a line is no test case");
    if (line != NULL && job_row_read(line, length, &row)) job_row_free(&row);
    return true;
}

static bool merge_results(const char *path, job_merge_rule rule, io_error *error) {
    job_merge merge;
    char *text = NULL;
    size_t size;
    if (!job_merge_read(&path, 1, rule, &merge, error)) return false;
    FILE *junit = open_memstream(&text, &size);
    insist_on(junit != NULL, "out of memory");
    job_junit_begin(junit, "fuzz", &merge.sums);
    /* A test case for each job that is missing says nothing of the reader. */
    const bool read = merge.sums.missing > 1000 || job_merge_visit(&merge, take_line, junit, error);
    job_junit_end(junit);
    fclose(junit);
    free(text);
    job_merge_free(&merge);
    return read;
}

/* They are merged, and a run goes on with them. The hash and the number of jobs are those of the file's first line, if that is
 * whole. */
static bool read_results(const char *path, const mesh_file *model, io_error *error) {
    char text[4096] = "";
    job_record first;
    job_results results;
    io_error other;
    (void)model;
    FILE *file = fopen(path, "rb");
    insist_on(file != NULL, "the damaged file cannot be opened");
    const size_t size = fread(text, 1, sizeof text, file);
    fclose(file);
    merge_results(path, MERGE_WHOLE, &other);
    merge_results(path, MERGE_WHAT_IS_THERE, &other);
    const char *end = memchr(text, '\n', size);
    if (end == NULL || !job_record_read(text, (size_t)(end - text), &first))
        return io_fail(error, "%s: no line of results", path);
    /* The list itself has so many lines. */
    if (first.jobs > 1000) return io_fail(error, "%s: results of a long list", path);
    if (!job_results_open(path, RESUME_ALL, first.list, first.jobs, &results, error)) return false;
    return job_results_close(&results, error);
}

/* The first that has the ending of a file reads it. Zipped data of GIFTI may unpack to a thousand times their size, and a mesh takes a
 * few times more. */
static const reading readings[] = {{"plan", ".plan.ply", read_plan, true, 100},
                                   {"obj", ".obj", read_mesh, false, 100},
                                   {"ply", ".ply", read_mesh, false, 100},
                                   {"off", ".off", read_mesh, false, 100},
                                   {"stl", ".stl", read_mesh, false, 100},
                                   {"gltf", ".gltf", read_mesh, false, 100},
                                   {"gltf", ".glb", read_mesh, false, 100},
                                   {"gifti", ".gii", read_mesh, false, 10000},
                                   {"pc2", ".pc2", read_frames_of, true, 100},
                                   {"mdd", ".mdd", read_frames_of, true, 100},
                                   {"summary", ".summary.json", read_summary, false, 100},
                                   {"jobs", ".jobs.jsonl", read_jobs, false, 100},
                                   {"results", ".results.jsonl", read_results, false, 100}};

enum { READINGS = sizeof readings / sizeof *readings };

const reading *reading_named(const char *format) {
    for (size_t i = 0; i < READINGS; i++)
        if (strcmp(readings[i].format, format) == 0) return &readings[i];
    return NULL;
}

static bool ends_in(const char *text, const char *ending) {
    const size_t length = strlen(text), end = strlen(ending);
    return length >= end && strcmp(text + length - end, ending) == 0;
}

const reading *reading_of_file(const char *path) {
    for (size_t i = 0; i < READINGS; i++)
        if (ends_in(path, readings[i].ending)) return &readings[i];
    return NULL;
}

const mesh_file *reading_tetrahedron(void) {
    static double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    static const mesh_file mesh = {
        .positions = positions, .triangles = triangles, .vertex_count = 4, .triangle_count = 4};
    return &mesh;
}

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What every reader may take: buffers of streams, a context, tables. */
enum { CONSTANT_MEMORY = 4 << 20 };

bool reading_try(const reading *r, const temp_folder *folder, const char *name, const mesh_file *model,
                 const unsigned char *bytes, size_t size) {
    io_error error = {""};
    const temp_path path = temp_file_write(folder, name, bytes, size);
    const double begin = processor_seconds();
    reading_memory_begin();
    const bool read = r->read(path.text, model, &error);
    const size_t peak = reading_memory_peak();
    if (peak > CONSTANT_MEMORY + r->memory_share * size) {
        fprintf(stderr, "%s: %zu bytes take %zu bytes of memory\n", path.text, size, peak);
        abort();
    }
    insist_on(processor_seconds() - begin <= READING_SECONDS, "a file takes too long");
    if (!read && (strstr(error.text, name) == NULL || strpbrk(error.text, "\r\n") != NULL)) {
        fprintf(stderr, "%s is refused so: %s\n", path.text, error.text);
        abort();
    }
    return read;
}

/* ---- memory -------------------------------------------------------------------------------------------- */

/* Programs without the sanitizer lack them. */
extern int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void *, size_t),
                                                     void (*freed)(const volatile void *))
    __attribute__((weak));
extern size_t __sanitizer_get_allocated_size(const volatile void *memory) __attribute__((weak));

/* Of the thread that reads. Blocks from before may be freed meanwhile. */
static _Thread_local bool counting;
static _Thread_local ptrdiff_t held, peak;

static void count_allocation(const volatile void *memory, size_t size) {
    (void)memory;
    if (!counting) return;
    held += (ptrdiff_t)size;
    if (held > peak) peak = held;
}

static void count_freeing(const volatile void *memory) {
    if (counting && memory != NULL) held -= (ptrdiff_t)__sanitizer_get_allocated_size(memory);
}

void reading_memory_begin(void) {
    static bool installed;
    if (!installed && __sanitizer_install_malloc_and_free_hooks != NULL)
        __sanitizer_install_malloc_and_free_hooks(count_allocation, count_freeing);
    installed = true;
    held = peak = 0;
    counting = true;
}

size_t reading_memory_peak(void) {
    counting = false;
    return (size_t)peak;
}
