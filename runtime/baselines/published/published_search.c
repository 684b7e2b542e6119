/* The published pipelines, from the update of their trees to contacts. They run on one thread, as in the thesis. */
#include "runtime/baselines/published/published_search.h"

#include "cscd/research.h"
#include "runtime/baselines/iccd/patch.h"
#include "runtime/baselines/published/feature_assignment.h"
#include "runtime/baselines/published/orientation_check.h"
#include "runtime/baselines/published/plain_test.h"
#include "runtime/baselines/trees/volume_tree.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/baseline_library.h"
#include "src/core/timer.h"

#include <string.h>

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
    contact_lane *lane;
} feature_testing;

static void test_features(void *data, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const feature_testing *now = data;
    if (!pair_filter_admits_features(&now->interval->filter, kind, a, b)) return;
    now->lane->feature_pairs++;
    if (now->search->roots == NULL) {
        (kind == CSCD_CONTACT_VF ? narrow_phase_test_vf : narrow_phase_test_ee)(now->interval, a, b,
                                                                                now->lane);
        return;
    }
    elementary_query query;
    elementary_contact contact;
    swept_interval_load(now->interval, kind, a, b, &query);
    now->lane->decided[ELEMENTARY_ROOTS]++;
    if (plain_test(now->search->roots, &query, kind, &contact))
        contact_lane_add(now->search->context, now->lane, kind, a, b, &contact, false);
}

enum { PAIRS_BETWEEN_LOOKS = 256 };

static void test_pairs(void *state, const own_interval *interval, contact_lane *lane) {
    const published_search *s = state;
    feature_testing testing = {s, interval->swept, lane};
    lane->suspended = false;
    while (s->mesh != NULL && lane->cursor < s->pairs.count && !lane->out_of_memory) {
        if (lane->cursor % PAIRS_BETWEEN_LOOKS == 0 &&
            !progress_go_on(&s->context->progress, (double)lane->cursor / (double)s->pairs.count))
            return;
        const uint32_t *pair = s->pairs.pairs[lane->cursor++];
        if (pair_filter_admits_triangles(&interval->swept->filter, pair[0], pair[1]))
            feature_assignment_test(interval, pair[0], pair[1], test_features, &testing);
        if (lane->cursor % PAIRS_BETWEEN_LOOKS == 0 && contact_lane_suspend(lane, lane->cursor)) return;
    }
    narrow_phase_finish(interval->swept, lane);
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
