/* Nanoseconds per pair of triangles for the feature filter, and per pair of features for signs and roots: on each
 * level of vector instructions, and one by one. */
#include "runtime/bvh/bvh.h"
#include "runtime/detector/detector.h"
#include "runtime/narrow_phase/feature_queue.h"
#include "tool/io/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char help[] =
    "usage: narrow_phase START END\n"
    "\n"
    "Records the pairs of triangles of the mesh START (OBJ, PLY, OFF) whose volumes overlap on the way to\n"
    "END, the same mesh at other positions, and all pairs of features that their feature_filter leaves, and times\n"
    "the narrow phase on them (one thread's processor time, least of 5).\n";

/* The features of this number of pairs of triangles never fill the queue. */
enum { REPEATS = 5, CHUNK = 480, TRIANGLE_CHUNK = 32 };

typedef struct recorded_pairs {
    uint32_t *a, *b;
    size_t count, capacity;
} recorded_pairs;

typedef struct recorded_triangles {
    triangle_pair *pairs; /* of slots */
    size_t count, capacity;
} recorded_triangles;

typedef struct interval_recording {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    mesh_file start, end;
    swept_interval interval;
    recorded_triangles triangles;
    recorded_pairs of_kind[2];
    contact_worker *worker;
    size_t left; /* after what was timed last */
} interval_recording;

/* ---- recording --------------------------------------------------------------------------------------- */

static bool record_list(recorded_pairs *to, feature_list *list) {
    if (to->count + list->count > to->capacity) {
        to->capacity = 2 * (to->count + list->count);
        to->a = realloc(to->a, to->capacity * sizeof *to->a);
        to->b = realloc(to->b, to->capacity * sizeof *to->b);
        if (to->a == NULL || to->b == NULL) return false;
    }
    memcpy(to->a + to->count, list->a, list->count * sizeof *list->a);
    memcpy(to->b + to->count, list->b, list->count * sizeof *list->b);
    to->count += list->count;
    list->count = 0;
    return true;
}

static bool record_triangles(recorded_triangles *to, const traversal_worker *batch) {
    if (to->count + batch->pair_count > to->capacity) {
        to->capacity = 2 * (to->count + batch->pair_count);
        to->pairs = realloc(to->pairs, to->capacity * sizeof *to->pairs);
        if (to->pairs == NULL) return false;
    }
    memcpy(to->pairs + to->count, batch->pairs, batch->pair_count * sizeof *batch->pairs);
    to->count += batch->pair_count;
    return true;
}

static uint32_t triangle_chunk(const interval_recording *r, size_t i) {
    return (uint32_t)(r->triangles.count - i < TRIANGLE_CHUNK ? r->triangles.count - i : TRIANGLE_CHUNK);
}

/* Records pairs as a step does when nothing is culled, but without orphan pairs. Takes the pairs out of the queue
 * before it is full. */
static bool record_pairs(interval_recording *r) {
    traversal *t = &r->detector->space.traversal;
    bool good = true, more = true;
    traversal_begin(t, &r->detector->space.bvh, TRAVERSAL_KEPT);
    while (good && more) {
        good = traversal_round(t, &more) == CSCD_OK;
        for (uint32_t i = 0; good && i < t->worker_count; i++)
            good = record_triangles(&r->triangles, &t->workers[i]);
    }
    for (size_t i = 0; good && i < r->triangles.count; i += TRIANGLE_CHUNK) {
        narrow_phase_test(&r->interval, r->triangles.pairs + i, triangle_chunk(r, i), r->worker);
        good = record_list(&r->of_kind[CSCD_CONTACT_VF], &r->worker->queue[CSCD_CONTACT_VF]) &&
               record_list(&r->of_kind[CSCD_CONTACT_EE], &r->worker->queue[CSCD_CONTACT_EE]);
    }
    return good;
}

static bool open_recording(interval_recording *r, io_error *error) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    cscd_object_desc desc =
        cscd_object_of_triangles(r->start.vertex_count, r->start.triangle_count, r->start.triangles);
    if (r->start.vertex_count != r->end.vertex_count) return io_fail(error, "different numbers of vertices");
    if (cscd_context_create(NULL, &r->context) != CSCD_OK) return io_fail(error, "no context");
    if (cscd_mesh_create(r->context, &desc, 1, &r->mesh) != CSCD_OK ||
        cscd_detector_create(r->context, r->mesh, NULL, &options, &r->detector) != CSCD_OK ||
        bvh_rebuild_move(&r->detector->rebuild, &r->detector->space.bvh, r->start.positions, r->end.positions,
                         uniform_growth(0.0), uniform_growth(0.0)) != CSCD_OK)
        return io_fail(error, "%s", cscd_context_detail(r->context));
    bvh_refit(&r->detector->space.bvh, r->start.positions, r->end.positions, uniform_growth(0.0));
    r->worker = &r->detector->space.workers[0];
    r->interval = (swept_interval){.mesh = r->mesh,
                                   .x0 = r->start.positions,
                                   .x1 = r->end.positions,
                                   .bvh = &r->detector->space.bvh,
                                   .skip_adjacent = true,
                                   .representatives = &r->detector->space.representatives,
                                   .filter = {.mesh = r->mesh},
                                   .limit = r->detector->config.limit};
    contact_worker_reset(r->worker);
    return record_pairs(r) || io_fail(error, "out of memory");
}

static void close_recording(interval_recording *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    mesh_file_free(&r->start);
    mesh_file_free(&r->end);
    free(r->triangles.pairs);
    for (int i = 0; i < 2; i++) {
        free(r->of_kind[i].a);
        free(r->of_kind[i].b);
    }
}

/* ---- in batches -------------------------------------------------------------------------------------- */

/* Runs representatives, feature filter and queue, and drops what is then in the queue. */
static void feature_filter(interval_recording *r, cscd_contact_kind kind) {
    (void)kind;
    for (size_t i = 0; i < r->triangles.count; i += TRIANGLE_CHUNK) {
        narrow_phase_test(&r->interval, r->triangles.pairs + i, triangle_chunk(r, i), r->worker);
        for (int k = 0; k < 2; k++) r->worker->queue[k].count = 0;
    }
}

static void decide_list(interval_recording *r, cscd_contact_kind kind, feature_list *list, bool signs_only) {
    const ccd_kernels *table = ccd_kernels_of(r->context);
    feature_source source = swept_interval_source(&r->interval);
    feature_pairs pairs = {list->a, list->b, list->count};
    bool vf = kind == CSCD_CONTACT_VF;
    if (!signs_only) {
        feature_queue_decide(&r->interval, kind, r->worker);
        return;
    }
    (vf ? table->reject_by_signs_vf : table->reject_by_signs_ee)(&source, &pairs);
    r->left += pairs.count;
}

static void decide_in_batches(interval_recording *r, cscd_contact_kind kind, size_t size, bool signs_only) {
    const recorded_pairs *pairs = &r->of_kind[kind];
    feature_list *list = &r->worker->queue[kind];
    r->left = 0;
    for (size_t i = 0; i < pairs->count; i += size) {
        size_t count = pairs->count - i < size ? pairs->count - i : size;
        memcpy(list->a, pairs->a + i, count * sizeof *list->a);
        memcpy(list->b, pairs->b + i, count * sizeof *list->b);
        list->count = (uint32_t)count;
        decide_list(r, kind, list, signs_only);
    }
}

static void by_signs(interval_recording *r, cscd_contact_kind kind) {
    decide_in_batches(r, kind, CHUNK, true);
}

static void by_all(interval_recording *r, cscd_contact_kind kind) {
    decide_in_batches(r, kind, CHUNK, false);
}

static void one_by_one(interval_recording *r, cscd_contact_kind kind) {
    decide_in_batches(r, kind, 1, false);
}

/* ---- the table --------------------------------------------------------------------------------------- */

static double processor_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

/* Returns the least time in ns for each of count pairs. */
static double time_pairs(interval_recording *r, cscd_contact_kind kind, size_t count,
                         void (*decide)(interval_recording *, cscd_contact_kind)) {
    double least = 1e300;
    for (int i = 0; i < REPEATS; i++) {
        contact_worker_reset(r->worker);
        double start = processor_ns();
        decide(r, kind);
        double ns = (processor_ns() - start) / (double)(count > 0 ? count : 1);
        least = ns < least ? ns : least;
    }
    return least;
}

static double percent_of(uint64_t part, size_t whole) {
    return whole > 0 ? 100.0 * (double)part / (double)whole : 0.0;
}

static void use_level(interval_recording *r, cscd_simd level) {
    r->context->simd = level;
}

static void print_triangles(interval_recording *r) {
    cscd_simd best = r->context->simd;
    size_t pairs = r->triangles.count, left = r->of_kind[0].count + r->of_kind[1].count;
    puts("ns per pair of triangles      pairs    feature_filter");
    for (int level = CSCD_SIMD_SCALAR; level <= (int)best; level++) {
        use_level(r, (cscd_simd)level);
        printf("    %-10s %20zu %8.1f\n", cscd_name(CSCD_SIMDS, (cscd_simd)level), pairs,
               time_pairs(r, CSCD_CONTACT_VF, pairs, feature_filter));
    }
    printf("    leaves %.2f of 15 pairs of features\n\n", (double)left / (double)(pairs > 0 ? pairs : 1));
}

static void print_kind(interval_recording *r, cscd_contact_kind kind) {
    size_t pairs = r->of_kind[kind].count, open = 0;
    const char *name = cscd_contact_kind_name(kind);
    cscd_simd best = r->context->simd;
    printf("%-3s %-10s %20zu %8s %8.1f\n", name, "one by one", pairs, "",
           time_pairs(r, kind, pairs, one_by_one));
    for (int level = CSCD_SIMD_SCALAR; level <= (int)best; level++) {
        use_level(r, (cscd_simd)level);
        double signs = time_pairs(r, kind, pairs, by_signs);
        open = r->left;
        printf("%-3s %-10s %20zu %8.1f %8.1f\n", name, cscd_name(CSCD_SIMDS, (cscd_simd)level), pairs, signs,
               time_pairs(r, kind, pairs, by_all));
    }
    const uint64_t *decided = r->worker->decided;
    printf("    signs leave %.2f %%; in contact %.2f %%, by exact arithmetic %.4f %%\n",
           percent_of(open, pairs), percent_of(r->worker->count, pairs),
           percent_of(decided[ELEMENTARY_EXACT], pairs));
}

int main(int argument_count, char **arguments) {
    interval_recording r = {0};
    io_error error = {""};
    if (argument_count != 3) {
        fputs(help, stderr);
        return 2;
    }
    bool good = mesh_file_read(arguments[1], &r.start, &error) &&
                mesh_file_read(arguments[2], &r.end, &error) && open_recording(&r, &error);
    if (good) {
        print_triangles(&r);
        puts("ns per pair of features       pairs    signs  + roots");
        print_kind(&r, CSCD_CONTACT_VF);
        print_kind(&r, CSCD_CONTACT_EE);
    } else {
        fprintf(stderr, "narrow_phase: %s\n", error.text);
    }
    close_recording(&r);
    return good ? 0 : 1;
}
