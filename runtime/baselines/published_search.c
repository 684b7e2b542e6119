/* The published pipelines, from the update of their trees to contacts. They run on one thread, as in the thesis. */
#include "cscd/research.h"
#include "runtime/baselines/baselines.h"
#include "runtime/baselines/patches.h"
#include "runtime/baselines/published.h"
#include "runtime/baselines/volume_tree.h"
#include "src/core/baseline_library.h"
#include "src/core/timer.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- orientations (section 4.4) ---------------------------------------------------------------------------- */

void detector_points_move(const own_interval *interval, bool still) {
    culling *c = interval->culling;
    const double *const ends[2] = {interval->swept->x0, interval->swept->x1};
    for (uint32_t r = 0; r < c->region_count; r++)
        for (int e = 0; e < 2; e++)
            memcpy(c->detector_points[r][e], c->detector_offsets[r], sizeof(double[3]));
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        const double share = c->triangle_weights[t] / 3.0;
        for (int e = 0; e < 2; e++) {
            double *point = c->detector_points[c->triangle_regions[t]][e];
            for (int i = 0; i < 3; i++) {
                const double *p = ends[still ? 0 : e] + (size_t)c->mesh->triangles[t][i] * 3;
                for (int k = 0; k < 3; k++) point[k] += share * p[k];
            }
        }
    }
}

/* The Bernstein coefficients of equation 4.2: (p0 - dp) . n is a cubic of time, since n is a quadratic. */
static void orientation_values(const double corners[3][2][3], const double point[2][3], double b[4]) {
    double u[2][3], v[2][3], d[2][3], n[3][3], one[3], other[3];
    for (int e = 0; e < 2; e++) {
        vec3_subtract(corners[1][e], corners[0][e], u[e]);
        vec3_subtract(corners[2][e], corners[0][e], v[e]);
        vec3_subtract(corners[0][e], point[e], d[e]);
        vec3_cross(u[e], v[e], n[2 * e]);
    }
    vec3_cross(u[0], v[1], one);
    vec3_cross(u[1], v[0], other);
    for (int k = 0; k < 3; k++) n[1][k] = 0.5 * (one[k] + other[k]);
    b[0] = vec3_dot(d[0], n[0]);
    b[1] = (vec3_dot(d[1], n[0]) + 2.0 * vec3_dot(d[0], n[1])) / 3.0;
    b[2] = (2.0 * vec3_dot(d[1], n[1]) + vec3_dot(d[0], n[2])) / 3.0;
    b[3] = vec3_dot(d[1], n[2]);
}

/* Equation 4.3. All coefficients above 0 make the value positive during the whole interval. */
static uint8_t orientation_of(const own_interval *interval, uint32_t triangle) {
    const cscd_mesh *mesh = interval->swept->mesh;
    const culling *c = interval->culling;
    double corners[3][2][3], b[4];
    if (!interval->culled[mesh->triangle_components[triangle]] ||
        (interval->clean != NULL && !interval->clean[triangle]))
        return ORIENTATION_ZERO;
    for (int i = 0; i < 3; i++) {
        const size_t at = (size_t)mesh->triangles[triangle][i] * 3;
        memcpy(corners[i][0], interval->swept->x0 + at, sizeof(double[3]));
        memcpy(corners[i][1], interval->swept->x1 + at, sizeof(double[3]));
    }
    orientation_values((const double(*)[2][3])corners,
                       (const double(*)[3])c->detector_points[c->triangle_regions[triangle]], b);
    if (b[0] > 0.0 && b[1] > 0.0 && b[2] > 0.0 && b[3] > 0.0) return ORIENTATION_PLUS;
    if (b[0] < 0.0 && b[1] < 0.0 && b[2] < 0.0 && b[3] < 0.0) return ORIENTATION_MINUS;
    return ORIENTATION_ZERO;
}

void orientations_check(const own_interval *interval) {
    culling *c = interval->culling;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) c->facing[t] = orientation_of(interval, t);
    culling_begin(c);
}

/* ---- the elementary test ----------------------------------------------------------------------------------- */

/* Returns how many there are, ascending. A leading coefficient of 0 leaves a quadratic; without any coefficient the points are always
 * coplanar, and there is none. */
static int find_roots(const plain_cubic_functions *roots, const double b[4], double t[3]) {
    const double c1 = 3.0 * (b[1] - b[0]), c2 = 3.0 * (b[0] - 2.0 * b[1] + b[2]),
                 c3 = (b[3] - b[0]) + 3.0 * (b[1] - b[2]);
    if (c3 == 0.0) return roots->quadratic(c2, c1, b[0], &t[0], &t[1]);
    return roots->cubic(c2 / c3, c1 / c3, b[0] / c3, &t[0], &t[1], &t[2]);
}

static void blend_vectors(const double ends[2][3], double t, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (1.0 - t) * ends[0][k] + t * ends[1][k];
}

/* Cramer's rule in the plane that the features are largest in; the parameters are those of inside_test.c. */
static bool touch_at(const point_vectors *vectors, cscd_contact_kind kind, double t) {
    double a[3], b[3], c[3], normal[3];
    blend_vectors(vectors->a, t, a);
    blend_vectors(vectors->b, t, b);
    blend_vectors(vectors->c, t, c);
    vec3_cross(a, b, normal);
    int k = 0;
    for (int i = 1; i < 3; i++) k = fabs(normal[i]) > fabs(normal[k]) ? i : k;
    const int y = (k + 1) % 3, z = (k + 2) % 3;
    const double w = normal[k];
    if (w == 0.0) return false;
    const double u = (c[y] * b[z] - c[z] * b[y]) / w;
    const double v = (kind == CSCD_CONTACT_VF ? a[y] * c[z] - a[z] * c[y] : c[y] * a[z] - c[z] * a[y]) / w;
    return u >= 0.0 && v >= 0.0 && (kind == CSCD_CONTACT_VF ? u + v <= 1.0 : u <= 1.0 && v <= 1.0);
}

bool plain_test(const plain_cubic_functions *roots, const elementary_query *query, cscd_contact_kind kind,
                elementary_contact *contact) {
    point_vectors vectors;
    double t[3];
    point_vectors_from(query, kind, &vectors);
    const coplanarity f = coplanarity_cubic(&vectors);
    const int count = find_roots(roots, f.b, t);
    for (int i = 0; i < count; i++) {
        if (!(t[i] >= 0.0 && t[i] <= 1.0) || !touch_at(&vectors, kind, t[i])) continue;
        contact_frame_describe(query, kind, &f, t[i], contact);
        return true;
    }
    return false;
}

/* ---- from pairs of triangles to pairs of features (section 4.6) -------------------------------------------- */

/* Tests a pair of features of two triangles; a and b as in cscd_contact. */
typedef void feature_test(void *data, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* The oneRingList of a feature: the triangles that contain it. */
typedef struct one_ring {
    const uint32_t *triangles;
    uint32_t count;
} one_ring;

static one_ring ring_of_vertex(const cscd_mesh *mesh, uint32_t v) {
    const uint32_t first = mesh->vertex_star_offsets[v];
    return (one_ring){mesh->vertex_stars + first, mesh->vertex_star_offsets[v + 1] - first};
}

static one_ring ring_of_edge(const cscd_mesh *mesh, uint32_t e) {
    const uint32_t first = mesh->edge_star_offsets[e];
    return (one_ring){mesh->edge_stars + first, mesh->edge_star_offsets[e + 1] - first};
}

static bool share_vertex(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (int i = 0; i < 3; i++)
        if (triangle_contains(mesh->triangles[b], mesh->triangles[a][i])) return true;
    return false;
}

/* Does the search list this pair, if its volumes overlap? */
static bool is_looked_at(const own_interval *interval, uint32_t a, uint32_t b) {
    const bool adjacent =
        (interval->ours & CSCD_OURS_NEIGHBOURS) == 0 && share_vertex(interval->swept->mesh, a, b);
    return !adjacent && culling_keeps(interval->culling, a, b);
}

/* Is (a, b) the first of the pairs of two rings, in their order, that is looked at? */
static bool is_first(const own_interval *interval, one_ring of_a, one_ring of_b, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < of_a.count; i++) {
        for (uint32_t j = 0; j < of_b.count; j++) {
            if (of_a.triangles[i] == a && of_b.triangles[j] == b) return true;
            if (is_looked_at(interval, of_a.triangles[i], of_b.triangles[j])) return false;
        }
    }
    return false;
}

static bool is_assigned(const own_interval *interval, one_ring of_a, one_ring of_b, uint32_t a, uint32_t b) {
    if ((interval->ours & CSCD_OURS_REPRESENTATIVES) != 0) return is_first(interval, of_a, of_b, a, b);
    return of_a.triangles[0] == a && of_b.triangles[0] == b;
}

static void test_vertices(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test,
                          void *data) {
    const cscd_mesh *mesh = interval->swept->mesh;
    const one_ring face = {&b, 1};
    for (int i = 0; i < 3; i++) {
        const uint32_t v = mesh->triangles[a][i];
        if (!triangle_contains(mesh->triangles[b], v) &&
            is_assigned(interval, ring_of_vertex(mesh, v), face, a, b))
            test(data, CSCD_CONTACT_VF, v, b);
    }
}

static void test_edges(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test, void *data) {
    const cscd_mesh *mesh = interval->swept->mesh;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const uint32_t e = mesh->triangle_edges[a][i], f = mesh->triangle_edges[b][j];
            if (edges_share_vertex(mesh->edges[e], mesh->edges[f])) continue;
            const bool ascending = e < f; /* one order of the pairs, whichever triangle comes first */
            const one_ring of_e = ring_of_edge(mesh, e), of_f = ring_of_edge(mesh, f);
            if (ascending ? is_assigned(interval, of_e, of_f, a, b) : is_assigned(interval, of_f, of_e, b, a))
                test(data, CSCD_CONTACT_EE, ascending ? e : f, ascending ? f : e);
        }
    }
}

/* Calls the test for the pairs of features that this pair of triangles is to test: those that share no vertex and are assigned to
 * it. A feature is assigned to the first triangle of its oneRingList, whichever pairs are looked at; or, with
 * CSCD_OURS_REPRESENTATIVES, a pair of features to the first pair of triangles that is. */
static void feature_assignment_test(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test,
                                    void *data) {
    test_vertices(interval, a, b, test, data);
    test_vertices(interval, b, a, test, data);
    test_edges(interval, a, b, test, data);
}

/* ---- the pipelines ----------------------------------------------------------------------------------------- */

typedef struct published_search {
    cscd_context *context;
    bool by_contours;                   /* ICCD, else detector points */
    const plain_cubic_functions *roots; /* NULL: elementary tests are ours */
    const cscd_mesh *mesh;              /* that the trees are of; NULL: there are none yet */
    volume_tree tree;
    volume_search pairs;
    bool *keeps_adjacent; /* per tree */
    patches patches;      /* of ICCD */
} published_search;

/* ---- trees ----------------------------------------------------------------------------------------------- */

static void free_trees(published_search *s) {
    volume_search_close(&s->pairs);
    volume_tree_free(&s->tree);
    context_free(s->context, s->keeps_adjacent);
    patches_free(s->context, &s->patches);
    s->keeps_adjacent = NULL;
    s->mesh = NULL;
}

/* The trees of ICCD: one of all bodies, and one of all obstacles, if there are both. Returns how many. */
static uint32_t join_components(const cscd_mesh *mesh, uint32_t *regions) {
    uint32_t obstacles = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        obstacles += regions[t] = triangle_of_obstacle(mesh, t);
    if (obstacles > 0 && obstacles < mesh->triangle_count) return 2;
    memset(regions, 0, mesh->triangle_count * sizeof *regions);
    return 1;
}

/* Nodes stand in the order of a patch tree; a height is one more than those below it. */
static cscd_status make_patches(published_search *s, const cscd_mesh *mesh) {
    const volume_tree *t = &s->tree;
    patch_tree tree = {.node_count = t->node_count, .root_count = t->root_count};
    tree.nodes = context_allocate(s->context, t->node_count, sizeof *tree.nodes);
    tree.triangles = context_allocate(s->context, mesh->triangle_count, sizeof *tree.triangles);
    tree.roots = context_allocate(s->context, t->root_count, sizeof *tree.roots);
    if (tree.nodes == NULL || tree.triangles == NULL || tree.roots == NULL) {
        patch_tree_free(s->context, &tree);
        return CSCD_OUT_OF_MEMORY;
    }
    memcpy(tree.roots, t->roots, t->root_count * sizeof *tree.roots);
    for (uint32_t i = t->node_count; i-- > 0;) {
        const volume_node *n = &t->nodes[i];
        patch_node *out = &tree.nodes[i];
        *out = (patch_node){.right = n->second, .count = 1};
        if (n->second == 0) continue;
        const patch_node *first = &tree.nodes[i + 1], *second = &tree.nodes[n->second];
        out->height = 1 + (first->height > second->height ? first->height : second->height);
        out->count = first->count + second->count;
    }
    for (uint32_t i = 0, leaves = 0; i < t->node_count; i++) {
        tree.nodes[i].first = leaves;
        if (patch_is_leaf(&tree.nodes[i])) tree.triangles[leaves++] = t->nodes[i].triangle;
    }
    return patches_create(mesh, &tree, &sweep_test, &s->patches);
}

static cscd_status build_trees(published_search *s, const own_interval *interval) {
    const cscd_mesh *mesh = interval->swept->mesh;
    const culling *c = interval->culling;
    uint32_t *joined = context_allocate(s->context, mesh->triangle_count, sizeof *joined);
    if (joined == NULL) return CSCD_OUT_OF_MEMORY;
    const uint32_t count = s->by_contours ? join_components(mesh, joined) : c->region_count;
    cscd_status status = volume_tree_build(mesh, interval->swept->x0,
                                           s->by_contours ? joined : c->triangle_regions, count, &s->tree);
    context_free(s->context, joined);
    if (status == CSCD_OK) status = volume_search_open(&s->tree, &s->pairs);
    if (status == CSCD_OK) {
        s->keeps_adjacent = context_allocate(s->context, count, sizeof *s->keeps_adjacent);
        if (s->keeps_adjacent == NULL) status = CSCD_OUT_OF_MEMORY;
    }
    if (status == CSCD_OK && s->by_contours) status = make_patches(s, mesh);
    if (status != CSCD_OK) {
        free_trees(s);
        return status;
    }
    for (uint32_t r = 0; r < count; r++) s->keeps_adjacent[r] = true;
    s->mesh = mesh;
    return CSCD_OK;
}

/* ---- pairs of triangles ---------------------------------------------------------------------------------- */

/* Leaves out pairs by the signs of triangles. */
static void check_orientations(published_search *s, const own_interval *interval, cscd_counters *counters) {
    detector_points_move(interval, (interval->ours & CSCD_OURS_MOTION) == 0);
    orientations_check(interval);
    volume_tree_orient(&s->tree, interval->culling->orientations);
    counters->plus = interval->culling->plus;
    counters->minus = interval->culling->minus;
}

/* Leaves out pairs within patches that pass the contour test. */
static void seal_patches(published_search *s, const own_interval *interval, cscd_counters *counters) {
    patches_seal(&s->patches, interval->swept->mesh, interval->swept->x0, interval->swept->x1, true);
    for (uint32_t i = 0; i < s->tree.node_count; i++) s->tree.nodes[i].sealed = s->patches.passed[i];
    counters->contours = s->patches.contours;
    counters->sealed = s->patches.sealed;
}

static cscd_status list_pairs(published_search *s, const own_interval *interval, volume_kind kind,
                              cscd_counters *counters) {
    const bool neighbours = (interval->ours & CSCD_OURS_NEIGHBOURS) != 0;
    s->pairs.keeps_adjacent = neighbours ? s->keeps_adjacent : NULL;
    volume_kernels_of(s->context)->search(&s->tree, kind, &s->pairs);
    counters->boxes_tested += s->pairs.tests;
    counters->adjacent += neighbours ? 0 : s->pairs.adjacent;
    counters->pcp += s->pairs.count + (neighbours ? 0 : s->pairs.adjacent);
    return s->pairs.out_of_memory ? CSCD_OUT_OF_MEMORY : CSCD_OK;
}

static cscd_status find_pairs(void *state, const own_interval *interval, cscd_timings *timings,
                              cscd_counters *counters) {
    published_search *s = state;
    const swept_interval *swept = interval->swept;
    const volume_kind kind = (interval->ours & CSCD_OURS_BOXES) != 0 ? VOLUME_BOX : VOLUME_KDOP14;
    if (swept->mesh->triangle_count == 0) return CSCD_OK;
    cscd_status status = s->mesh != NULL ? CSCD_OK : build_trees(s, interval);
    if (status != CSCD_OK) return status;
    double since = timer_now_ms();
    volume_kernels_of(s->context)->refit(&s->tree, kind, swept->x0, swept->x1);
    timer_lap(&since, &timings->update_ms);
    (s->by_contours ? seal_patches : check_orientations)(s, interval, counters);
    timer_lap(&since, s->by_contours ? &timings->contour_ms : &timings->orientation_ms);
    status = list_pairs(s, interval, kind, counters);
    timer_lap(&since, &timings->traversal_ms);
    return status;
}

/* ---- pairs of features ----------------------------------------------------------------------------------- */

typedef struct feature_testing {
    const published_search *search;
    const swept_interval *interval;
    contact_worker *worker;
} feature_testing;

static void test_features(void *data, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const feature_testing *now = data;
    if (!pair_filter_admits_features(&now->interval->filter, kind, a, b)) return;
    now->worker->feature_pairs++;
    if (now->search->roots == NULL) {
        (kind == CSCD_CONTACT_VF ? narrow_phase_test_vf : narrow_phase_test_ee)(now->interval, a, b,
                                                                                now->worker);
        return;
    }
    elementary_query query;
    elementary_contact contact;
    swept_interval_load(now->interval, kind, a, b, &query);
    now->worker->decided[ELEMENTARY_ROOTS]++;
    if (plain_test(now->search->roots, &query, kind, &contact))
        contact_worker_add(now->search->context, now->worker, kind, a, b, &contact, false);
}

enum { PAIRS_BETWEEN_LOOKS = 256 };

static void test_pairs(void *state, const own_interval *interval, contact_worker *worker) {
    const published_search *s = state;
    feature_testing testing = {s, interval->swept, worker};
    worker->suspended = false;
    while (s->mesh != NULL && worker->cursor < s->pairs.count && !worker->out_of_memory) {
        if (worker->cursor % PAIRS_BETWEEN_LOOKS == 0 &&
            !progress_go_on(&s->context->progress, (double)worker->cursor / (double)s->pairs.count))
            return;
        const uint32_t *pair = s->pairs.pairs[worker->cursor++];
        if (pair_filter_admits_triangles(&interval->swept->filter, pair[0], pair[1]))
            feature_assignment_test(interval, pair[0], pair[1], test_features, &testing);
        if (worker->cursor % PAIRS_BETWEEN_LOOKS == 0 && contact_worker_suspend(worker, worker->cursor))
            return;
    }
    narrow_phase_finish(interval->swept, worker);
}

/* ---- as a search ----------------------------------------------------------------------------------------- */

static cscd_status create_search(cscd_context *context, uint64_t ours, bool by_contours, void **out) {
    const void *roots = NULL;
    if ((ours & CSCD_OURS_TESTS) == 0) {
        const cscd_status status = baseline_library_find(
            context, PLAIN_CUBIC_ENTRY, PLAIN_CUBIC_INTERFACE,
            "the published method: its elementary test, without CSCD_OURS_TESTS,", &roots);
        if (status != CSCD_OK) return status;
    }
    published_search *s = context_allocate(context, 1, sizeof *s);
    if (s == NULL) return context_out_of_memory(context);
    s->context = context;
    s->by_contours = by_contours;
    s->roots = roots;
    *out = s;
    return CSCD_OK;
}

static cscd_status create_detector_based(cscd_context *context, uint64_t ours, void **out) {
    return create_search(context, ours, false, out);
}

static cscd_status create_iccd(cscd_context *context, uint64_t ours, void **out) {
    return create_search(context, ours, true, out);
}

static void destroy_search(cscd_context *context, void *state) {
    free_trees(state);
    context_free(context, state);
}

const own_search detector_based_search = {create_detector_based, destroy_search, find_pairs, test_pairs};
const own_search iccd_search = {create_iccd, destroy_search, find_pairs, test_pairs};
