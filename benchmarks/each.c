/* The tool on many meshes, and on tiny ones, compared with a process that only reads and checks them, and by
 * threads. */
#include "benchmarks/lib/options.h"
#include "cscd/cscd.h"
#include "src/core/timer.h"
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache.h"

#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ROUNDS = 9, MESHES = 1000, QUICK_MESHES = 100, FRAMES = 100, WAYS = 4 };

static const char help[] =
    "usage: each [options]\n"
    "\n"
    "`cscd check --each` on 1,000 meshes of each size (with --quick on 100), which this program writes as OBJ: wavy\n"
    "strips, each another one. Beside it this program is started once more to do nothing but read and check the same\n"
    "files, one after the other, by one thread, with one context and an allocator that keeps its memory. The tool runs\n"
    "with one thread and with one per processor, and once for each mesh (for a tenth of them, times ten). All count\n"
    "from the start of a process to its end.\n"
    "All take turns. Milliseconds, of the clock and of processors, are the least of the rounds; ratios are those of\n"
    "processor time, the middle one of the rounds' own, since other programs may run beside.\n"
    "Below it: `check` of one mesh and `replay` of 100 frames of it, over the same with one thread.\n"
    "--intervals: the rounds (default 9, with --quick 3).\n"
    "\n";

typedef struct mesh_folder {
    char path[64], tool[4096];
    char **arguments; /* of check --each: those of the tool, then the meshes, then NULL */
    uint32_t mesh_count;
} mesh_folder;

enum { FIRST_MESH = 5 }; /* cscd check --each --threads N */

/* ---- meshes -------------------------------------------------------------------------------------------- */

/* A strip of that many triangles, two rows of vertices, with waves of its own. */
static bool write_strip(const char *path, uint32_t triangle_count, uint32_t seed, io_error *error) {
    mesh_file mesh = mesh_file_of(triangle_count + 2, triangle_count, NULL, NULL);
    mesh.positions = malloc((size_t)mesh.vertex_count * 3 * sizeof *mesh.positions);
    mesh.triangles = malloc((size_t)triangle_count * 3 * sizeof *mesh.triangles);
    bool good = mesh.positions != NULL && mesh.triangles != NULL;
    for (uint32_t v = 0; good && v < mesh.vertex_count; v++) {
        double *x = mesh.positions + (size_t)v * 3;
        x[0] = v / 2 + 0.1 * sin(seed + v);
        x[1] = v % 2;
        x[2] = sin(0.01 * seed + 0.3 * v);
    }
    for (uint32_t t = 0; good && t < triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) mesh.triangles[3 * t + k] = t + (t % 2 == 1 ? (3 - k) % 3 : k);
    good = good ? mesh_file_write_obj(path, &mesh, error) : io_fail(error, "memory ran out");
    mesh_file_free(&mesh);
    return good;
}

/* The tool lies in the folder above that of the benchmarks. */
static bool find_tool(mesh_folder *f, io_error *error) {
    ssize_t length = readlink("/proc/self/exe", f->tool, sizeof f->tool - 16);
    f->tool[length > 0 ? length : 0] = '\0';
    for (int i = 0; i < 2; i++) {
        char *slash = strrchr(f->tool, '/');
        if (slash != NULL) *slash = '\0';
    }
    strcat(f->tool, "/cscd");
    return access(f->tool, X_OK) == 0 || io_fail(error, "%s: build the tool first", f->tool);
}

static bool make_folder(mesh_folder *f, uint32_t triangle_count, uint32_t mesh_count, io_error *error) {
    *f = (mesh_folder){.path = "/tmp/cscd-each-XXXXXX", .mesh_count = mesh_count};
    f->arguments = calloc(FIRST_MESH + (size_t)mesh_count + 1, sizeof *f->arguments);
    if (f->arguments == NULL || mkdtemp(f->path) == NULL)
        return io_fail(error, "%s: %s", f->path, strerror(errno));
    bool good = find_tool(f, error);
    for (uint32_t i = 0; good && i < mesh_count; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s/%04u.obj", f->path, i);
        f->arguments[FIRST_MESH + i] = strdup(path);
        good = write_strip(path, triangle_count, i, error);
    }
    return good;
}

static void remove_folder(mesh_folder *f) {
    for (uint32_t i = 0; f->arguments != NULL && i < f->mesh_count; i++) {
        if (f->arguments[FIRST_MESH + i] != NULL) remove(f->arguments[FIRST_MESH + i]);
        free(f->arguments[FIRST_MESH + i]);
    }
    free(f->arguments);
    char cache[128];
    snprintf(cache, sizeof cache, "%s/frames.pc2", f->path);
    remove(cache);
    rmdir(f->path);
}

/* ---- what takes turns ---------------------------------------------------------------------------------- */

static cscd_status check_file(cscd_context *context, const mesh_file *file, size_t *pairs) {
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_intersections found = {.count = 0};
    cscd_object_desc object =
        cscd_object_of_triangles(file->vertex_count, file->triangle_count, file->triangles);
    cscd_status status = cscd_mesh_create(context, &object, 1, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, NULL, NULL, &detector);
    if (status == CSCD_OK)
        status = cscd_detector_find_intersections(detector, CSCD_DOUBLES(file->positions, file->vertex_count),
                                                  NULL, &found);
    *pairs += found.count;
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    return status;
}

/* The process that the tool is compared with: it reads and checks all files. Without the thresholds the C
 * library gives memory back to the system after each tiny mesh, which takes three times as long as all
 * else. */
static bool check_here(char *const *paths, io_error *error) {
    cscd_context *context;
    size_t pairs = 0;
    mallopt(M_TRIM_THRESHOLD, 1 << 28);
    mallopt(M_MMAP_THRESHOLD, 1 << 25);
    bool good = cscd_context_create(NULL, &context) == CSCD_OK || io_fail(error, "memory ran out");
    for (; good && *paths != NULL; paths++) {
        mesh_file file;
        good = mesh_file_read(*paths, &file, error);
        if (!good) break;
        cscd_status status = check_file(context, &file, &pairs);
        good = status == CSCD_OK || io_fail(error, "%s", cscd_context_detail(context));
        mesh_file_free(&file);
    }
    cscd_context_destroy(context);
    return good;
}

/* Runs a program with its output thrown away. */
static bool run_program(char *const *arguments, const char *path, io_error *error) {
    int status = 0;
    pid_t child = fork();
    if (child == 0) {
        int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        execv(path, arguments);
        _exit(127);
    }
    return (child > 0 && waitpid(child, &status, 0) == child && status == 0) ||
           io_fail(error, "%s %s failed", path, arguments[1]);
}

static bool check_beside(mesh_folder *f, io_error *error) {
    f->arguments[FIRST_MESH - 2] = "each";
    f->arguments[FIRST_MESH - 1] = "--here";
    return run_program(f->arguments + FIRST_MESH - 2, "/proc/self/exe", error);
}

static bool check_each(mesh_folder *f, char *threads, io_error *error) {
    char *const first[FIRST_MESH] = {"cscd", "check", "--each", "--threads", threads};
    memcpy(f->arguments, first, sizeof first);
    return run_program(f->arguments, f->tool, error);
}

static bool check_one_by_one(mesh_folder *f, io_error *error) {
    bool good = true;
    for (uint32_t i = 0; good && i < f->mesh_count / 10; i++)
        good = run_program(
            (char *[]){"cscd", "check", f->arguments[FIRST_MESH + i], "--quiet", "--threads", "1", NULL},
            f->tool, error);
    return good;
}

/* Milliseconds of the clock, and of processors by this process and those that it has waited for. */
typedef struct spent_ms {
    double wall, processor;
} spent_ms;

static double processor_ms(int who) {
    struct rusage usage;
    getrusage(who, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) * 1e3 +
           (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1e-3;
}

static spent_ms read_clocks(void) {
    return (spent_ms){timer_now_ms(), processor_ms(RUSAGE_SELF) + processor_ms(RUSAGE_CHILDREN)};
}

/* The time since start, divided. */
static spent_ms spent_since(spent_ms start, double divisor) {
    spent_ms now = read_clocks();
    return (spent_ms){(now.wall - start.wall) / divisor, (now.processor - start.processor) / divisor};
}

static bool run_way(mesh_folder *f, int way, spent_ms *spent, io_error *error) {
    spent_ms start = read_clocks();
    bool good = way == 0   ? check_beside(f, error)
                : way == 1 ? check_each(f, "1", error)
                : way == 2 ? check_each(f, "0", error)
                           : check_one_by_one(f, error);
    *spent = spent_since(start, way == 3 ? 0.1 : 1.0);
    return good;
}

/* ---- tables -------------------------------------------------------------------------------------------- */

static int compare_doubles(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return a < b ? -1 : a > b;
}

static double middle_of(double *values, uint32_t count) {
    qsort(values, count, sizeof *values, compare_doubles);
    return values[count / 2];
}

/* The times of some ways: the least, and ratios over the first way of the same round. */
typedef struct way_times {
    spent_ms least[WAYS];
    double ratios[WAYS][INTERVALS_MAX];
    double first; /* processor time of this round's first way */
} way_times;

static void add_time(way_times *t, int way, uint32_t round, spent_ms spent) {
    if (way == 0) t->first = spent.processor;
    if (round == 0) t->least[way] = spent;
    t->least[way].wall = fmin(t->least[way].wall, spent.wall);
    t->least[way].processor = fmin(t->least[way].processor, spent.processor);
    t->ratios[way][round] = spent.processor / t->first;
}

static void report_way(uint32_t triangles, uint32_t meshes, const char *name, int way, uint32_t rounds,
                       way_times *t, json *out) {
    const double ratio = middle_of(t->ratios[way], rounds);
    printf("  %9u %6u  %-26s %10.2f %10.2f %7.2f\n", triangles, meshes, name, t->least[way].wall,
           t->least[way].processor, ratio);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", triangles);
    json_integer(out, "meshes", meshes);
    json_string(out, "way", name);
    json_number(out, "ms", t->least[way].wall);
    json_number(out, "processor_ms", t->least[way].processor);
    json_number(out, "ratio", ratio);
    json_end_object(out);
}

static bool compare_ways(mesh_folder *f, uint32_t triangles, uint32_t rounds, json *out, io_error *error) {
    static const char *const names[WAYS] = {"read and check", "check --each --threads 1",
                                            "check --each --threads 0", "check, one by one"};
    way_times times;
    for (uint32_t round = 0; round < rounds; round++) {
        for (int way = 0; way < WAYS; way++) {
            spent_ms spent;
            if (!run_way(f, way, &spent, error)) return false;
            add_time(&times, way, round, spent);
        }
    }
    for (int way = 0; way < WAYS; way++)
        report_way(triangles, f->mesh_count, names[way], way, rounds, &times, out);
    return true;
}

/* ---- threads for tiny meshes --------------------------------------------------------------------------- */

static bool write_frames(const char *path, const char *model, io_error *error) {
    mesh_file mesh;
    point_cache_writer *cache;
    if (!mesh_file_read(model, &mesh, error)) return false;
    bool good = point_cache_writer_open(path, mesh.vertex_count, FRAMES, &cache, error);
    for (uint32_t i = 0; good && i < FRAMES; i++) {
        mesh.positions[2] += 0.001;
        good = point_cache_writer_write(cache, mesh.positions, error);
    }
    mesh_file_free(&mesh);
    return good && point_cache_writer_close(cache, error);
}

enum { RUNS = 20, ARGUMENTS = 12 };

/* Runs a command some times with each number of threads. */
static bool compare_threads(const mesh_folder *f, char *const *command, uint32_t triangles, uint32_t rounds,
                            json *out, io_error *error) {
    static char *const counts[WAYS] = {"1", "0", "2", "16"};
    way_times times;
    char *arguments[ARGUMENTS] = {NULL};
    size_t used = 0;
    for (; command[used] != NULL; used++) arguments[used] = command[used];
    for (uint32_t round = 0; round < rounds; round++) {
        for (int way = 0; way < WAYS; way++) {
            spent_ms start = read_clocks();
            arguments[used] = counts[way];
            for (int i = 0; i < RUNS; i++)
                if (!run_program(arguments, f->tool, error)) return false;
            add_time(&times, way, round, spent_since(start, RUNS));
        }
    }
    for (int way = 0; way < WAYS; way++) {
        char name[64];
        snprintf(name, sizeof name, "%s --threads %s", command[1], counts[way]);
        report_way(triangles, 1, name, way, rounds, &times, out);
    }
    return true;
}

static bool run_threads(const mesh_folder *f, uint32_t triangles, uint32_t rounds, json *out,
                        io_error *error) {
    char frames[128], *model = f->arguments[FIRST_MESH];
    snprintf(frames, sizeof frames, "%s/frames.pc2", f->path);
    char *const check[] = {"cscd", "check", model, "--quiet", "--threads", NULL};
    char *const replay[] = {"cscd",     "replay", model,       frames, "--quiet",
                            "--method", "none",   "--threads", NULL};
    return write_frames(frames, model, error) && compare_threads(f, check, triangles, rounds, out, error) &&
           compare_threads(f, replay, triangles, rounds, out, error);
}

static bool run_sizes(const bench_options *o, json *out, io_error *error) {
    const uint32_t rounds = o->interval_count > 0 ? o->interval_count : o->quick ? 3 : ROUNDS;
    bool good = true;
    printf("  %9s %6s  %-26s %10s %10s %7s\n", "triangles", "meshes", "", "ms", "processors", "ratio");
    for (uint32_t i = 0; good && i < o->size_count; i++) {
        mesh_folder folder;
        good = make_folder(&folder, o->sizes[i], o->quick ? QUICK_MESHES : MESHES, error) &&
               compare_ways(&folder, o->sizes[i], rounds, out, error) &&
               run_threads(&folder, o->sizes[i], rounds, out, error);
        remove_folder(&folder);
    }
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {5, 5000};
    static const bench_program program = {"each", help, sizes, 2, 2, run_sizes};
    io_error error;
    if (argument_count > 2 && strcmp(arguments[1], "--here") == 0)
        return check_here(arguments + 2, &error) ? 0 : 1;
    return bench_main(&program, argument_count, arguments);
}
