/* All kinds of volumes on one recording, interval by interval and by turns: what they cost and what they find. */
#include "benchmarks/lib/volume_trial.h"

#include "benchmarks/lib/stages.h"
#include "runtime/detector/detector.h"
#include "runtime/narrow_phase/narrow_phase_kernels.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct volume_trial {
    const recording_data *recording;
    const volume_kernels *kernels;
    cscd_detector *detector;
    volume_tree tree;
    volume_search search, earlier[VOLUME_KINDS]; /* what the kinds have found in the present interval */
    swept_interval interval;
    contact_worker worker;
    wanted_pairs wanted;
    bool *keeps_adjacent; /* per region */
    double ms[VOLUME_KINDS][VOLUME_STAGES][VOLUME_ROUNDS];
    size_t tested[VOLUME_KINDS][2]; /* contacts: with the feature filter, and without */
    volume_result result;
} volume_trial;

static bool explain_trial(const volume_trial *t, const char *what, io_error *error) {
    return io_fail(error, "%s, %s: %s", t->recording->name, cscd_method_name(t->result.method), what);
}

/* ---- parts ------------------------------------------------------------------------------------------- */

static bool make_detector(volume_trial *t, cscd_simd simd) {
    const recording_data *r = t->recording;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = t->result.method;
    options.coherence = CSCD_COHERENCE_OFF; /* lists of pairs have no volumes */
    if (simd != CSCD_SIMD_AUTO) r->context->simd = simd;
    return cscd_detector_create(r->context, r->mesh,
                                t->result.method == CSCD_METHOD_CHARGE ? r->charge : NULL, &options,
                                &t->detector) == CSCD_OK;
}

/* The regions of the detector, by which it culls; without culling, components. */
static bool make_tree(volume_trial *t) {
    const cscd_detector *d = t->detector;
    const cscd_mesh *mesh = d->mesh;
    bool culls = detector_region_count(d) > 0;
    const uint32_t *regions = culls ? d->interval.culling.triangle_regions : mesh->triangle_components;
    uint32_t count = culls ? d->interval.culling.region_count : mesh->component_count;
    t->keeps_adjacent = calloc(count > 0 ? count : 1, sizeof *t->keeps_adjacent);
    bool good =
        t->keeps_adjacent != NULL &&
        volume_tree_build(mesh, recording_data_frame(t->recording, 0), regions, count, &t->tree) == CSCD_OK &&
        volume_search_open(&t->tree, &t->search) == CSCD_OK;
    for (int kind = 0; good && kind < VOLUME_KINDS; kind++)
        good = volume_search_open(&t->tree, &t->earlier[kind]) == CSCD_OK;
    return good;
}

static void free_trial(volume_trial *t) {
    contact_worker_free(t->recording->context, &t->worker);
    wanted_pairs_free(&t->wanted);
    for (int kind = 0; kind < VOLUME_KINDS; kind++) volume_search_close(&t->earlier[kind]);
    volume_search_close(&t->search);
    volume_tree_free(&t->tree);
    free(t->keeps_adjacent);
    cscd_detector_destroy(t->detector);
}

/* ---- tests of pairs ---------------------------------------------------------------------------------- */

enum { PAIRS_AT_ONCE = 256 };

/* As a step tests what its traversal has found. */
static void test_filtered(volume_trial *t) {
    const bvh *hierarchy = t->interval.bvh;
    triangle_pair slots[PAIRS_AT_ONCE];
    uint32_t count = 0;
    for (size_t i = 0; i < t->search.count; i++) {
        const uint32_t *pair = t->search.pairs[i];
        slots[count++] = (triangle_pair){hierarchy->slots[pair[0]], hierarchy->slots[pair[1]]};
        if (count < PAIRS_AT_ONCE && i + 1 < t->search.count) continue;
        narrow_phase_test(&t->interval, slots, count, &t->worker);
        count = 0;
    }
    narrow_phase_finish(&t->interval, &t->worker);
}

/* Only pairs of triangles that share a vertex have such features, and of these only the ones that culling lists. */
static bool features_adjacent(const uint32_t *a, int a_count, const uint32_t *b, int b_count) {
    bool shared = false;
    for (int i = 0; i < a_count; i++)
        for (int j = 0; j < b_count; j++) shared |= a[i] == b[j];
    return shared;
}

static void queue_vertex(volume_trial *t, uint32_t vertex, uint32_t triangle) {
    if (!features_adjacent(&vertex, 1, t->interval.mesh->triangles[triangle], 3))
        narrow_phase_test_vf(&t->interval, vertex, triangle, &t->worker);
}

static void queue_edges(volume_trial *t, uint32_t a, uint32_t b) {
    if (!features_adjacent(t->interval.mesh->edges[a], 2, t->interval.mesh->edges[b], 2))
        narrow_phase_test_ee(&t->interval, a, b, &t->worker);
}

static void queue_features(volume_trial *t, triangle_pair pair, uint32_t features) {
    const cscd_mesh *mesh = t->interval.mesh;
    for (; features != 0; features &= features - 1) {
        int bit = __builtin_ctz(features), edges = bit - FEATURE_EDGES;
        if (edges >= 0)
            queue_edges(t, mesh->triangle_edges[pair.a][edges / 3], mesh->triangle_edges[pair.b][edges % 3]);
        else if (bit >= FEATURE_VERTEX_B)
            queue_vertex(t, mesh->triangles[pair.b][bit - FEATURE_VERTEX_B], pair.a);
        else
            queue_vertex(t, mesh->triangles[pair.a][bit], pair.b);
    }
}

/* All pairs of features that a pair of triangles answers for reach the elementary tests. */
static void test_directly(volume_trial *t) {
    for (size_t i = 0; i < t->search.count; i++) {
        triangle_pair pair = {t->search.pairs[i][0], t->search.pairs[i][1]};
        pair_selection selection = representatives_select_early(&t->interval, pair);
        if (selection.features != 0 && !selection.settled)
            representatives_select(&t->interval, &pair, 1, &selection.features);
        queue_features(t, pair, selection.features);
    }
    narrow_phase_finish(&t->interval, &t->worker);
}

/* ---- an interval ------------------------------------------------------------------------------------- */

static double processor_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* The state after the detector's step says which pairs are culled, and how pairs are tested. */
static void follow_step(volume_trial *t, const double *x0, const double *x1) {
    const cscd_detector *d = t->detector;
    const cscd_mesh *mesh = d->mesh;
    bool any = false;
    for (uint32_t c = 0; c < mesh->component_count; c++) any |= d->interval.culled[c];
    t->interval = (swept_interval){.mesh = mesh,
                                   .x0 = x0,
                                   .x1 = x1,
                                   .bvh = &d->space.bvh,
                                   .skip_adjacent = true,
                                   .representatives = &d->space.representatives,
                                   .culling = any ? &d->interval.culling : NULL,
                                   .culled = d->interval.culled,
                                   .filter = {.mesh = mesh},
                                   .limit = d->config.limit};
    for (uint32_t i = 0; any && i < mesh->triangle_count; i++)
        t->keeps_adjacent[d->interval.culling.triangle_regions[i]] =
            d->interval.culled[mesh->triangle_components[i]];
    t->search.keeps_adjacent = any ? t->keeps_adjacent : NULL;
    volume_tree_orient(&t->tree, any ? d->interval.culling.orientations : NULL);
}

static void run_round(volume_trial *t, int round) {
    const double *x0 = t->interval.x0, *x1 = t->interval.x1;
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        double at[VOLUME_STAGES + 1];
        at[0] = processor_ms();
        t->kernels->refit(&t->tree, (volume_kind)kind, x0, x1);
        at[1] = processor_ms();
        t->kernels->search(&t->tree, (volume_kind)kind, &t->search);
        at[2] = processor_ms();
        contact_worker_reset(&t->worker);
        test_filtered(t);
        t->tested[kind][0] = t->worker.count;
        at[3] = processor_ms();
        contact_worker_reset(&t->worker);
        test_directly(t);
        t->tested[kind][1] = t->worker.count;
        at[4] = processor_ms();
        for (int i = 0; i < VOLUME_STAGES; i++) t->ms[kind][i][round] = at[i + 1] - at[i];
        volume_search last = t->earlier[kind];
        t->earlier[kind] = t->search;
        t->search = last;
        t->search.keeps_adjacent = t->earlier[kind].keeps_adjacent;
    }
}

static void add_interval(volume_trial *t) {
    t->result.intervals++;
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        volume_cost *cost = &t->result.of[kind];
        cost->tests += (double)t->earlier[kind].tests;
        cost->pairs += (double)t->earlier[kind].count;
        cost->adjacent += (double)t->earlier[kind].adjacent;
        for (int i = 0; i < VOLUME_STAGES; i++) {
            cost->ms[i] += median(t->ms[kind][i], VOLUME_ROUNDS);
            for (int k = 0; k < VOLUME_ROUNDS; k++) cost->rounds[i][k] += t->ms[kind][i][k];
        }
    }
}

/* The kinds of an interval must agree with each other, and with the step. */
static bool check_interval(volume_trial *t, uint32_t interval, io_error *error) {
    const char *problem = NULL;
    for (int kind = 0; problem == NULL && kind < VOLUME_KINDS; kind++) {
        const volume_search *found = &t->earlier[kind];
        if (found->out_of_memory || t->worker.out_of_memory)
            problem = "out of memory";
        else if (!wanted_pairs_found(&t->wanted, found))
            problem = "misses triangles whose features are in contact";
        else if (t->tested[kind][0] != t->tested[0][0] || t->tested[kind][1] != t->tested[0][0])
            problem = "leads to other contacts than spheres with the feature filter";
        else if ((kind > VOLUME_BOX && !volume_search_within(found, &t->earlier[VOLUME_BOX])) ||
                 (kind == VOLUME_KDOP26 && (!volume_search_within(found, &t->earlier[VOLUME_KDOP14]) ||
                                            !volume_search_within(found, &t->earlier[VOLUME_KDOP18]))))
            problem = "finds what a k-DOP of fewer directions does not";
        if (problem != NULL)
            io_fail(error, "%s, %s, interval %u: the %s %s", t->recording->name,
                    cscd_method_name(t->result.method), interval, volume_kind_name((volume_kind)kind),
                    problem);
    }
    return problem == NULL;
}

static bool run_interval(volume_trial *t, uint32_t i, bool measured, io_error *error) {
    const double *x0 = recording_data_frame(t->recording, i), *x1 = recording_data_frame(t->recording, i + 1);
    uint32_t vertices = t->recording->model.vertex_count;
    cscd_contacts found;
    if (cscd_detector_step(t->detector, CSCD_DOUBLES(x0, vertices), CSCD_DOUBLES(x1, vertices), &found) !=
        CSCD_OK)
        return explain_trial(t, cscd_context_detail(t->recording->context), error);
    if (!measured) return true;
    follow_step(t, x0, x1);
    if (!wanted_pairs_collect(&t->wanted, t->detector->mesh, t->interval.culling, &found))
        return explain_trial(t, "out of memory", error);
    t->result.contacts += (double)found.count;
    for (int round = 0; round < VOLUME_ROUNDS; round++) run_round(t, round);
    add_interval(t);
    return check_interval(t, i, error);
}

static void divide_result(volume_result *r) {
    double n = r->intervals > 0 ? r->intervals : 1.0;
    r->contacts /= n;
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        volume_cost *cost = &r->of[kind];
        cost->tests /= n;
        cost->pairs /= n;
        cost->adjacent /= n;
        for (int i = 0; i < VOLUME_STAGES; i++) {
            cost->ms[i] /= n;
            for (int k = 0; k < VOLUME_ROUNDS; k++) cost->rounds[i][k] /= n;
        }
    }
}

bool volume_trial_run(const recording_data *r, cscd_method method, cscd_simd simd, uint32_t stride,
                      volume_result *out, io_error *error) {
    volume_trial *t =
        aligned_alloc(CACHE_LINE_SIZE, (sizeof *t + CACHE_LINE_SIZE - 1) / CACHE_LINE_SIZE * CACHE_LINE_SIZE);
    if (t == NULL) return io_fail(error, "out of memory");
    memset(t, 0, sizeof *t);
    t->recording = r;
    t->result.method = method;
    bool good = make_detector(t, simd) || explain_trial(t, cscd_context_detail(r->context), error);
    good = good && (make_tree(t) || explain_trial(t, "out of memory", error));
    t->kernels = volume_kernels_of(r->context);
    for (uint32_t i = 0; good && i + 1 < r->frame_count; i++)
        good = run_interval(t, i, i % stride == 0, error);
    divide_result(&t->result);
    *out = t->result;
    free_trial(t);
    free(t);
    return good;
}

/* ---- contacts ---------------------------------------------------------------------------------------- */

static uint64_t key_of(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static bool add_key(wanted_pairs *p, uint64_t key) {
    if (p->count == p->capacity) {
        size_t capacity = 2 * p->capacity + 64;
        uint64_t *keys = realloc(p->keys, capacity * sizeof *keys);
        if (keys == NULL) return false;
        p->keys = keys;
        bool *marks = realloc(p->marks, capacity * sizeof *marks);
        if (marks == NULL) return false;
        p->marks = marks;
        p->capacity = capacity;
    }
    p->keys[p->count++] = key;
    return true;
}

/* Triangles that have a feature. */
typedef struct feature_star {
    const uint32_t *triangles;
    uint32_t count;
} feature_star;

static feature_star star_of(const uint32_t *offsets, const uint32_t *stars, uint32_t feature) {
    return (feature_star){stars + offsets[feature], offsets[feature + 1] - offsets[feature]};
}

static bool share_vertex(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (int i = 0; i < 9; i++) {
        if (mesh->triangles[a][i / 3] == mesh->triangles[b][i % 3]) return true;
    }
    return false;
}

static bool add_stars(wanted_pairs *p, const cscd_mesh *mesh, const culling *by, feature_star a,
                      feature_star b) {
    for (uint32_t i = 0; i < a.count; i++) {
        for (uint32_t j = 0; j < b.count; j++) {
            uint32_t first = a.triangles[i], second = b.triangles[j];
            if (share_vertex(mesh, first, second)) continue;
            if (by != NULL && !culling_keeps(by, first, second)) continue;
            if (!add_key(p, key_of(first, second))) return false;
        }
    }
    return true;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

bool wanted_pairs_collect(wanted_pairs *p, const cscd_mesh *mesh, const culling *by,
                          const cscd_contacts *contacts) {
    p->count = 0;
    for (size_t i = 0; i < contacts->count; i++) {
        const cscd_contact *c = &contacts->items[i];
        feature_star a, b = {&c->b, 1};
        if (c->kind == CSCD_CONTACT_VF) {
            a = star_of(mesh->vertex_star_offsets, mesh->vertex_stars, c->a);
        } else {
            a = star_of(mesh->edge_star_offsets, mesh->edge_stars, c->a);
            b = star_of(mesh->edge_star_offsets, mesh->edge_stars, c->b);
        }
        if (!add_stars(p, mesh, by, a, b)) return false;
    }
    if (p->count == 0) return true;
    qsort(p->keys, p->count, sizeof *p->keys, compare_keys);
    size_t kept = 1;
    for (size_t i = 1; i < p->count; i++) {
        if (p->keys[i] != p->keys[i - 1]) p->keys[kept++] = p->keys[i];
    }
    p->count = kept;
    return true;
}

void wanted_pairs_free(wanted_pairs *p) {
    free(p->keys);
    free(p->marks);
    *p = (wanted_pairs){0};
}

bool wanted_pairs_found(wanted_pairs *p, const volume_search *s) {
    size_t found = 0;
    if (p->count == 0) return true;
    memset(p->marks, 0, p->count * sizeof *p->marks);
    for (size_t i = 0; i < s->count; i++) {
        uint64_t key = key_of(s->pairs[i][0], s->pairs[i][1]);
        const uint64_t *at = bsearch(&key, p->keys, p->count, sizeof *p->keys, compare_keys);
        if (at == NULL || p->marks[at - p->keys]) continue;
        p->marks[at - p->keys] = true;
        found++;
    }
    return found == p->count;
}

/* ---- nesting ----------------------------------------------------------------------------------------- */

bool volume_search_within(const volume_search *s, const volume_search *of) {
    size_t at = 0;
    if (s->tests > of->tests || s->adjacent > of->adjacent) return false;
    for (size_t i = 0; i < s->count; i++) {
        while (at < of->count && memcmp(of->pairs[at], s->pairs[i], sizeof *s->pairs) != 0) at++;
        if (at++ == of->count) return false;
    }
    return true;
}
