/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#include "runtime/narrow_phase/narrow_phase.h"

#include "runtime/ccd/ccd.h"
#include "runtime/narrow_phase/feature_queue.h"
#include "runtime/narrow_phase/narrow_phase_kernels.h"

enum { PAIRS_AT_ONCE = 256 };

void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_worker *worker) {
    feature_list *list = &worker->queue[CSCD_CONTACT_VF];
    if (feature_list_full(list)) feature_queue_decide(interval, CSCD_CONTACT_VF, worker);
    list->count = feature_list_put(list, list->count, vertex, triangle, 1);
}

static uint32_t smaller_of(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

static uint32_t larger_of(uint32_t a, uint32_t b) {
    return a < b ? b : a;
}

/* Feature a is the edge of the smaller number, whichever way the pair was found: the test's rounding, and so
 * its result, never depends on the traversal. */
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_worker *worker) {
    feature_list *list = &worker->queue[CSCD_CONTACT_EE];
    if (feature_list_full(list)) feature_queue_decide(interval, CSCD_CONTACT_EE, worker);
    list->count = feature_list_put(list, list->count, smaller_of(a, b), larger_of(a, b), 1);
}

void narrow_phase_finish(const swept_interval *interval, contact_worker *worker) {
    feature_queue_decide(interval, CSCD_CONTACT_VF, worker);
    feature_queue_decide(interval, CSCD_CONTACT_EE, worker);
}

/* ---- from pairs of triangles to the queue ------------------------------------------------------------ */

static void queue_features(const swept_interval *interval, triangle_pair pair, uint32_t features,
                           contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    feature_list *vf = &worker->queue[CSCD_CONTACT_VF], *ee = &worker->queue[CSCD_CONTACT_EE];
    if (feature_list_full(vf)) feature_queue_decide(interval, CSCD_CONTACT_VF, worker);
    if (feature_list_full(ee)) feature_queue_decide(interval, CSCD_CONTACT_EE, worker);
    for (; features != 0; features &= features - 1) {
        worker->feature_pairs++;
        int bit = __builtin_ctz(features), edges = bit - FEATURE_EDGES;
        if (edges >= 0) {
            uint32_t a = mesh->triangle_edges[pair.a][edges / 3], b = mesh->triangle_edges[pair.b][edges % 3];
            ee->count = feature_list_put(ee, ee->count, smaller_of(a, b), larger_of(a, b), 1);
        } else if (bit >= FEATURE_VERTEX_B) {
            vf->count =
                feature_list_put(vf, vf->count, mesh->triangles[pair.b][bit - FEATURE_VERTEX_B], pair.a, 1);
        } else {
            vf->count = feature_list_put(vf, vf->count, mesh->triangles[pair.a][bit], pair.b, 1);
        }
    }
}

/* Pairs of triangles, by slots and by numbers, and the pairs of their features that they may have to test. */
typedef struct chosen_pairs {
    triangle_pair slots[PAIRS_AT_ONCE], pairs[PAIRS_AT_ONCE];
    uint16_t features[PAIRS_AT_ONCE];
    uint32_t count;
} chosen_pairs;

/* Most pairs are far from each other on the surface: whatever they represent is theirs. The others are
 * `open`. */
static void choose_pairs(const swept_interval *interval, const triangle_pair *slots, uint32_t count,
                         chosen_pairs *settled, chosen_pairs *open) {
    const bvh *hierarchy = interval->bvh;
    settled->count = open->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        triangle_pair pair = {bvh_triangle(hierarchy, slots[i].a), bvh_triangle(hierarchy, slots[i].b)};
        pair_selection selection = representatives_select_early(interval, pair);
        chosen_pairs *to = selection.settled ? settled : open;
        to->slots[to->count] = slots[i];
        to->pairs[to->count] = pair;
        to->features[to->count] = selection.features;
        to->count += selection.features != 0;
    }
}

/* Drops what the volumes keep apart, and what is at rest. */
static void filter_features(const swept_interval *interval, bool settled, chosen_pairs *chosen) {
    uint32_t kept = 0;
    narrow_phase_kernels_of(interval->mesh->context)
        ->feature_filter(interval, chosen->slots, chosen->count, settled, chosen->features);
    for (uint32_t i = 0; i < chosen->count; i++) {
        triangle_pair pair = chosen->pairs[i];
        uint16_t features = chosen->features[i];
        if (features != 0) features &= (uint16_t)pair_filter_features(&interval->filter, pair.a, pair.b);
        chosen->pairs[kept] = pair;
        chosen->features[kept] = features;
        kept += features != 0;
    }
    chosen->count = kept;
}

static void queue_pairs(const swept_interval *interval, const chosen_pairs *chosen, contact_worker *worker) {
    for (uint32_t i = 0; i < chosen->count; i++)
        queue_features(interval, chosen->pairs[i], chosen->features[i], worker);
}

static void test_some(const swept_interval *interval, const triangle_pair *slots, uint32_t count,
                      contact_worker *worker) {
    chosen_pairs settled, open;
    choose_pairs(interval, slots, count, &settled, &open);
    filter_features(interval, true, &settled);
    filter_features(interval, false, &open);
    representatives_select(interval, open.pairs, open.count, open.features);
    queue_pairs(interval, &settled, worker);
    queue_pairs(interval, &open, worker);
}

/* Counts the pairs of components that are culled with themselves. */
static void count_kept(const swept_interval *interval, const triangle_pair *slots, uint32_t count,
                       uint32_t *kept) {
    const uint32_t *components = interval->mesh->triangle_components;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = components[bvh_triangle(interval->bvh, slots[i].a)],
                 b = components[bvh_triangle(interval->bvh, slots[i].b)];
        kept[a] += a == b && interval->culled[a];
    }
}

void narrow_phase_test(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                       contact_worker *worker) {
    if (interval->culling != NULL && worker->kept != NULL) count_kept(interval, pairs, count, worker->kept);
    for (uint32_t i = 0; i < count && !worker->out_of_memory; i += PAIRS_AT_ONCE)
        test_some(interval, pairs + i, count - i < PAIRS_AT_ONCE ? count - i : PAIRS_AT_ONCE, worker);
}

/* ---- orphan pairs ----------------------------------------------------------------------------------------- */

static bool parted_by_directions(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                 uint32_t b) {
    elementary_query query;
    swept_interval_load(interval, kind, a, b, &query);
    return directions_part(&query, kind, pair_reach(interval, kind, a, b));
}

/* Adjacent triangles of components that are culled are pairs like others, and some components are not looked
 * at with themselves. */
static bool left_to_others(const swept_interval *interval, uint32_t component) {
    return (interval->culling != NULL && interval->culled[component]) ||
           !pair_filter_admits_components(&interval->filter, component, component);
}

static void test_orphan_vf(const swept_interval *interval, const uint32_t pair[2], contact_worker *worker) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, pair[0], pair[1])) return;
    if (left_to_others(interval, interval->mesh->triangle_components[pair[1]])) return;
    if (parted_by_directions(interval, CSCD_CONTACT_VF, pair[0], pair[1])) return;
    worker->feature_pairs++;
    narrow_phase_test_vf(interval, pair[0], pair[1], worker);
}

static void test_orphan_ee(const swept_interval *interval, const uint32_t pair[2], contact_worker *worker) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, pair[0], pair[1])) return;
    if (left_to_others(interval, edge_component(interval->mesh, pair[0]))) return;
    if (parted_by_directions(interval, CSCD_CONTACT_EE, pair[0], pair[1])) return;
    worker->feature_pairs++;
    narrow_phase_test_ee(interval, pair[0], pair[1], worker);
}

/* The cursor counts the pairs of the worker, those of vertices and faces first. */
void narrow_phase_test_orphan_pairs(const swept_interval *interval, const orphan_pairs *orphans,
                                    uint32_t index, uint32_t stride, contact_worker *worker) {
    size_t all = orphans->vf_count + orphans->ee_count;
    for (size_t i = index + (size_t)worker->cursor * stride; i < all; i += stride) {
        if (i < orphans->vf_count)
            test_orphan_vf(interval, orphans->vf[i], worker);
        else
            test_orphan_ee(interval, orphans->ee[i - orphans->vf_count], worker);
        if (contact_worker_suspend(worker, worker->cursor + 1)) return;
    }
}
