/* Sends pairs of features through the feature queue, as a step does: in batches of any size, on every level of
 * vector instructions that the processor has. */
#include "benchmarks/lib/pair_batches.h"

#include "runtime/narrow_phase/feature_queue.h"

#include <stdlib.h>
#include <string.h>

/* False when the processor lacks the level, or memory runs out. */
static bool open_level(pair_batches *b, int i, cscd_simd simd) {
    cscd_context_options options = cscd_context_defaults();
    options.simd = simd;
    options.thread_count = 1;
    if (cscd_context_create(&options, &b->contexts[i]) != CSCD_OK) {
        b->contexts[i] = NULL;
        return false;
    }
    b->workers[i] = context_allocate(b->contexts[i], 1, sizeof *b->workers[i]);
    return b->workers[i] != NULL;
}

bool pair_batches_open_best(pair_batches *b) {
    *b = (pair_batches){.random = 1};
    if (open_level(b, 0, CSCD_SIMD_AUTO)) return true;
    pair_batches_close(b);
    return false;
}

bool pair_batches_open(pair_batches *b) {
    *b = (pair_batches){.random = 1};
    for (int i = 0; i < PAIR_BATCH_LEVELS; i++) open_level(b, i, (cscd_simd)(CSCD_SIMD_SCALAR + i));
    if (b->workers[0] != NULL && b->workers[pair_batches_best_level(b)] != NULL) return true;
    pair_batches_close(b);
    return false;
}

void pair_batches_close(pair_batches *b) {
    for (int i = 0; i < PAIR_BATCH_LEVELS; i++) {
        free(b->found[i]);
        if (b->contexts[i] == NULL) continue;
        if (b->workers[i] != NULL) contact_worker_free(b->contexts[i], b->workers[i]);
        context_free(b->contexts[i], b->workers[i]);
        cscd_context_destroy(b->contexts[i]);
    }
    free(b->pairs);
    free(b->query_points[0]);
    free(b->query_points[1]);
    free(b->query_triangles);
    free(b->query_edges);
    *b = (pair_batches){.random = 1};
}

int pair_batches_best_level(const pair_batches *b) {
    int best = 0;
    for (int i = 0; i < PAIR_BATCH_LEVELS; i++) {
        if (b->contexts[i] != NULL) best = i;
    }
    return best;
}

const uint64_t *pair_batches_decided(const pair_batches *b) {
    return b->workers[0]->decided;
}

/* ---- order and sizes ------------------------------------------------------------------------------------- */

/* Uses the high bits of a linear congruence (Knuth, MMIX). */
static size_t random_below(pair_batches *b, size_t bound) {
    b->random = b->random * 6364136223846793005u + 1442695040888963407u;
    return (size_t)((b->random >> 33) % bound);
}

static void shuffle_pairs(pair_batches *b, size_t count) {
    for (size_t i = count; i > 1; i--) {
        size_t j = random_below(b, i);
        uint32_t moved[2] = {b->pairs[j][0], b->pairs[j][1]};
        memcpy(b->pairs[j], b->pairs[i - 1], sizeof moved);
        memcpy(b->pairs[i - 1], moved, sizeof moved);
    }
}

/* Every fourth batch is small, so that many end between two multiples of eight. */
static size_t random_size(pair_batches *b, size_t left) {
    size_t size = 1 + random_below(b, random_below(b, 4) == 0 ? 20 : PAIR_BATCH_MAX);
    return size < left ? size : left;
}

/* ---- batches --------------------------------------------------------------------------------------------- */

static void decide_batch(pair_batches *b, int level, cscd_contact_kind kind, size_t begin, size_t end) {
    feature_list *list = &b->workers[level]->queue[kind];
    b->mesh.context = b->contexts[level];
    swept_interval interval = {.mesh = &b->mesh, .x0 = b->x0, .x1 = b->x1};
    for (size_t i = begin; i < end; i++)
        list->count = feature_list_put(list, list->count, b->pairs[i][0], b->pairs[i][1], 1);
    feature_queue_decide(&interval, kind, b->workers[level]);
}

void pair_batches_run(pair_batches *b, int level, cscd_contact_kind kind, size_t begin, size_t end) {
    contact_worker_reset(b->workers[level]);
    decide_batch(b, level, kind, begin, end);
}

static void decide_on_level(pair_batches *b, int level, cscd_contact_kind kind, size_t count) {
    contact_worker_reset(b->workers[level]);
    shuffle_pairs(b, count);
    for (size_t begin = 0; begin < count;) {
        size_t end = begin + random_size(b, count - begin);
        decide_batch(b, level, kind, begin, end);
        begin = end;
    }
}

static int compare_contacts(const void *left, const void *right) {
    const cscd_contact *l = left, *r = right;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static uint64_t decided_pairs(const contact_worker *worker) {
    uint64_t sum = 0;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) sum += worker->decided[i];
    return sum;
}

static bool sort_worker(pair_batches *b, int level) {
    const contact_worker *worker = b->workers[level];
    cscd_contact *sorted = realloc(b->found[level], (worker->count + 1) * sizeof *sorted);
    if (sorted == NULL) return false;
    b->found[level] = sorted;
    for (size_t i = 0; i < worker->count; i++)
        memcpy(&sorted[i], contact_worker_at(worker, i), sizeof *sorted);
    qsort(sorted, worker->count, sizeof *sorted, compare_contacts);
    return true;
}

/* Returns what is wrong with a level's worker, by itself or compared with the lowest level's; NULL: nothing. */
static const char *find_problem(const pair_batches *b, int level, size_t count) {
    const contact_worker *first = b->workers[0], *worker = b->workers[level];
    const cscd_contact *found = b->found[level];
    if (worker->out_of_memory) return "memory ran out";
    if (decided_pairs(worker) != count) return "the queue lost pairs, or decided some twice";
    for (size_t i = 1; i < worker->count; i++) {
        if (compare_contacts(&found[i - 1], &found[i]) == 0) return "a pair is reported twice";
    }
    if (worker->count != first->count) return "two instruction sets differ in the number of contacts";
    if (memcmp(worker->decided, first->decided, sizeof worker->decided) != 0)
        return "two instruction sets differ in what each elementary level decided";
    if (memcmp(found, b->found[0], worker->count * sizeof *found) != 0)
        return "two instruction sets differ in a contact";
    return NULL;
}

/* Decides the count pairs of b->pairs. */
static const char *decide_on_all_levels(pair_batches *b, cscd_contact_kind kind, size_t count) {
    const char *problem = NULL;
    for (int level = 0; level < PAIR_BATCH_LEVELS && problem == NULL; level++) {
        if (b->workers[level] == NULL) continue;
        decide_on_level(b, level, kind, count);
        problem = sort_worker(b, level) ? find_problem(b, level, count) : "memory ran out";
    }
    return problem;
}

static bool reserve_pairs(pair_batches *b, size_t count) {
    if (count <= b->pair_capacity) return true;
    uint32_t(*grown)[2] = realloc(b->pairs, count * sizeof *grown);
    if (grown == NULL) return false;
    b->pairs = grown;
    b->pair_capacity = count;
    return true;
}

const cscd_contact *pair_batches_decide(pair_batches *b, const feature_source *source, cscd_contact_kind kind,
                                        const uint32_t (*pairs)[2], size_t count, size_t *contact_count,
                                        const char **problem) {
    *problem = "memory ran out";
    *contact_count = 0;
    if (!reserve_pairs(b, count)) return NULL;
    if (count > 0) memcpy(b->pairs, pairs, count * sizeof *pairs);
    b->x0 = source->x0;
    b->x1 = source->x1;
    b->mesh.triangles = (uint32_t(*)[3])source->triangles; /* nothing writes to them */
    b->mesh.edges = (uint32_t(*)[2])source->edges;
    *problem = decide_on_all_levels(b, kind, count);
    if (*problem != NULL) return NULL;
    *contact_count = b->workers[0]->count;
    return b->found[0];
}

/* ---- queries --------------------------------------------------------------------------------------------- */

static bool reserve_queries(pair_batches *b, size_t count) {
    if (count <= b->query_capacity) return true;
    size_t capacity = count + count / 2;
    for (int i = 0; i < 2; i++) free(b->query_points[i]);
    free(b->query_triangles);
    free(b->query_edges);
    for (int i = 0; i < 2; i++) b->query_points[i] = malloc(capacity * sizeof(double[4][3]));
    b->query_triangles = malloc(capacity * sizeof *b->query_triangles);
    b->query_edges = malloc(2 * capacity * sizeof *b->query_edges);
    bool allocated = b->query_points[0] != NULL && b->query_points[1] != NULL && b->query_triangles != NULL &&
                     b->query_edges != NULL;
    b->query_capacity = allocated ? capacity : 0;
    return allocated;
}

/* Query i has vertices 4i to 4i + 3. VF: vertex 4i and triangle i. EE: edges 2i and 2i + 1. */
bool pair_batches_load(pair_batches *b, cscd_contact_kind kind, const elementary_query *queries,
                       size_t count) {
    bool vf = kind == CSCD_CONTACT_VF;
    if (!reserve_queries(b, count) || !reserve_pairs(b, count)) return false;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(b->query_points[0] + (size_t)i * 12, queries[i].x0, sizeof queries[i].x0);
        memcpy(b->query_points[1] + (size_t)i * 12, queries[i].x1, sizeof queries[i].x1);
        for (uint32_t k = 0; k < 3; k++) b->query_triangles[i][k] = 4 * i + 1 + k;
        for (uint32_t k = 0; k < 4; k++) b->query_edges[2 * i + k / 2][k % 2] = 4 * i + k;
        b->pairs[i][0] = vf ? 4 * i : 2 * i;
        b->pairs[i][1] = vf ? i : 2 * i + 1;
    }
    b->x0 = b->query_points[0];
    b->x1 = b->query_points[1];
    b->mesh.triangles = b->query_triangles;
    b->mesh.edges = b->query_edges;
    return true;
}

static query_answer answer_of(const cscd_contact *contact) {
    query_answer answer = {.touching = true, .hit = {.toi = contact->toi, .u = contact->u, .v = contact->v}};
    memcpy(answer.hit.point, contact->point, sizeof answer.hit.point);
    memcpy(answer.hit.normal, contact->normal, sizeof answer.hit.normal);
    return answer;
}

bool pair_batches_decide_queries(pair_batches *b, cscd_contact_kind kind, const elementary_query *queries,
                                 size_t count, query_answer *answers, const char **problem) {
    *problem = "memory ran out";
    if (!pair_batches_load(b, kind, queries, count)) return false;
    *problem = decide_on_all_levels(b, kind, count);
    if (*problem != NULL) return false;
    for (size_t i = 0; i < count; i++) answers[i] = (query_answer){.touching = false};
    for (size_t i = 0; i < b->workers[0]->count; i++) {
        const cscd_contact *contact = &b->found[0][i];
        answers[kind == CSCD_CONTACT_VF ? contact->a / 4 : contact->a / 2] = answer_of(contact);
    }
    return true;
}
