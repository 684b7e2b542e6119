/* Queue of feature pairs. SIMD kernels decide them in batches of eight; the scalar test decides the rest. */
#include "runtime/narrow_phase/feature_queue.h"

#include "runtime/ccd/ccd.h"

#include <assert.h>

/* A point is an edge behind all others, so it is the second one; with another point it may be the first,
 * too. Its own parameter says nothing. */
static void add_contact_of_point(const cscd_mesh *mesh, uint32_t a, uint32_t b,
                                 const elementary_contact *contact, bool bounded, contact_worker *worker) {
    bool points = edge_is_point(mesh, a);
    elementary_contact where = *contact;
    where.u = points ? 0.0 : where.u;
    where.v = 0.0;
    contact_worker_add(mesh->context, worker, points ? CSCD_CONTACT_VV : CSCD_CONTACT_EV,
                       points ? mesh->edges[a][0] : a, mesh->edges[b][0], &where, bounded);
}

static void add_contact(const swept_interval *interval, cscd_contact_kind kind, const feature_pairs *pairs,
                        uint32_t i, const elementary_contact *contact, bool bounded, contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    if (kind == CSCD_CONTACT_EE && edge_is_point(mesh, pairs->b[i]))
        add_contact_of_point(mesh, pairs->a[i], pairs->b[i], contact, bounded, worker);
    else
        contact_worker_add(mesh->context, worker, kind, pairs->a[i], pairs->b[i], contact, bounded);
}

/* Fills up the last eight with the last pair. */
static void repeat_last(feature_pairs *pairs) {
    for (uint32_t i = 0; i < LANES - 1; i++) {
        pairs->a[pairs->count + i] = pairs->a[pairs->count - 1];
        pairs->b[pairs->count + i] = pairs->b[pairs->count - 1];
    }
}

/* The pairs of the eight from i on that are in a set of lanes move up to place kept. */
static uint32_t keep_lanes(feature_pairs *pairs, uint32_t i, uint32_t lanes, uint32_t kept) {
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t from = i + (uint32_t)__builtin_ctz(lanes);
        assert(kept <= from && from < pairs->count);
        pairs->a[kept] = pairs->a[from];
        pairs->b[kept++] = pairs->b[from];
    }
    return kept;
}

static uint32_t lanes_from(const feature_pairs *pairs, uint32_t i) {
    uint32_t rest = pairs->count - i;
    return rest < LANES ? (1u << rest) - 1 : (1u << LANES) - 1;
}

/* Pairs that touch, until they are eight. */
typedef struct pairs_to_describe {
    found_pairs pairs;
    uint32_t count;
} pairs_to_describe;

static elementary_contact described_contact(const described_contacts *described, uint32_t i) {
    elementary_contact contact = {described->toi[i], described->u[i], described->v[i], {0}, {0}};
    for (int k = 0; k < 3; k++) {
        contact.point[k] = described->point[k][i];
        contact.normal[k] = described->normal[k][i];
    }
    return contact;
}

/* Adds their contacts to the worker. The places that are left over describe the last pair again. */
static void describe_pairs(const swept_interval *interval, cscd_contact_kind kind,
                           pairs_to_describe *touching, contact_worker *worker) {
    const ccd_kernels *table = ccd_kernels_of(interval->mesh->context);
    feature_source source = swept_interval_source(interval);
    found_pairs *pairs = &touching->pairs;
    feature_pairs named = {pairs->a, pairs->b, touching->count};
    described_contacts described;
    if (touching->count == 0) return;
    for (uint32_t i = touching->count; i < LANES; i++) {
        pairs->a[i] = pairs->a[touching->count - 1];
        pairs->b[i] = pairs->b[touching->count - 1];
        pairs->begin[i] = pairs->begin[touching->count - 1];
    }
    (kind == CSCD_CONTACT_VF ? table->describe_vf : table->describe_ee)(&source, pairs, &described);
    for (uint32_t i = 0; i < touching->count; i++) {
        elementary_contact contact = described_contact(&described, i);
        add_contact(interval, kind, &named, i, &contact, false, worker);
    }
    touching->count = 0;
}

/* The pairs in a set of lanes, of the eight from i on, touch. */
static void note_touching(const swept_interval *interval, cscd_contact_kind kind, const feature_pairs *pairs,
                          uint32_t i, const root_outcomes *roots, uint32_t lanes, pairs_to_describe *touching,
                          contact_worker *worker) {
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t at = (uint32_t)__builtin_ctz(lanes), to = touching->count++;
        touching->pairs.a[to] = pairs->a[i + at];
        touching->pairs.b[to] = pairs->b[i + at];
        touching->pairs.begin[to] = roots->begin[at];
        if (touching->count == LANES) describe_pairs(interval, kind, touching, worker);
    }
}

/* Eight at a time; keeps the pairs that a kernel leaves open. */
static void decide_by_roots(const swept_interval *interval, cscd_contact_kind kind, root_kernel *kernel,
                            feature_pairs *pairs, contact_worker *worker) {
    feature_source source = swept_interval_source(interval);
    pairs_to_describe touching = {.count = 0};
    uint32_t kept = 0;
    if (pairs->count > 0) repeat_last(pairs);
    for (uint32_t i = 0; i < pairs->count; i += LANES) {
        root_outcomes roots;
        uint32_t real = lanes_from(pairs, i);
        kernel(&source, pairs->a + i, pairs->b + i, &roots);
        note_touching(interval, kind, pairs, i, &roots, real & roots.contacts, &touching, worker);
        kept = keep_lanes(pairs, i, real & ~roots.contacts & ~roots.apart, kept);
    }
    describe_pairs(interval, kind, &touching, worker);
    worker->decided[ELEMENTARY_ROOTS] += pairs->count - kept;
    pairs->count = kept;
}

static void decide_one_by_one(const swept_interval *interval, cscd_contact_kind kind,
                              const feature_pairs *pairs, contact_worker *worker) {
    for (uint32_t i = 0; i < pairs->count; i++) {
        elementary_query query;
        elementary_contact contact;
        swept_interval_load(interval, kind, pairs->a[i], pairs->b[i], &query);
        elementary_verdict verdict;
        if (!still_pair_decide(&query, kind, &verdict, &contact))
            verdict = elementary_after_signs(&query, kind, &contact);
        worker->decided[verdict.level]++;
        if (verdict.touching) add_contact(interval, kind, pairs, i, &contact, false, worker);
    }
}

static void decide_by_levels(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                             contact_worker *worker) {
    const ccd_kernels *table = ccd_kernels_of(interval->mesh->context);
    feature_source source = swept_interval_source(interval);
    uint32_t tests = pairs->count;
    (kind == CSCD_CONTACT_VF ? table->reject_by_signs_vf : table->reject_by_signs_ee)(&source, pairs);
    worker->decided[ELEMENTARY_SIGNS] += tests - pairs->count;
    bool vf = kind == CSCD_CONTACT_VF;
    decide_by_roots(interval, kind, vf ? table->roots_vf : table->roots_ee, pairs, worker);
    decide_by_roots(interval, kind, vf ? table->two_roots_vf : table->two_roots_ee, pairs, worker);
    decide_one_by_one(interval, kind, pairs, worker);
}

/* The nearest points of lane i at the start. */
static elementary_contact nearest_points(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                         const proximity_outcomes *near, uint32_t i) {
    elementary_contact contact = {.u = near->u[i], .v = near->v[i]};
    bool vf = kind == CSCD_CONTACT_VF;
    const double *first = interval->x0 + (size_t)(vf ? a : interval->mesh->edges[a][0]) * 3;
    const double *second = interval->x0 + (size_t)(vf ? a : interval->mesh->edges[a][1]) * 3;
    for (int k = 0; k < 3; k++) {
        contact.point[k] =
            first[k] + (vf ? 0.0 : contact.u * (second[k] - first[k])) - 0.5 * near->offset[k][i];
        contact.normal[k] = near->offset[k][i] / near->distance[i];
    }
    return contact;
}

/* The limit of one pair of features in the queue. */
static separation limit_of_pair(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                uint32_t b) {
    return separation_on_ways(interval, kind, a, b, pair_separation(interval, kind, a, b));
}

/* Do all pairs of a kind have one limit, which is that of the interval? */
static bool one_limit(const swept_interval *interval) {
    return !interval->thick && interval->motion == NULL;
}

/* The limits of the eight pairs from i on. */
static void load_limits(const swept_interval *interval, cscd_contact_kind kind, const feature_pairs *pairs,
                        uint32_t i, separations_x8 *limits) {
    for (uint32_t lane = 0; lane < LANES; lane++) {
        separation limit = limit_of_pair(interval, kind, pairs->a[i + lane], pairs->b[i + lane]);
        limits->distance[lane] = limit.distance;
        limits->tolerance[lane] = limit.tolerance;
    }
}

/* The pairs of the eight from i on that are in a set of lanes are near each other at the start. */
static void add_nearest(const swept_interval *interval, cscd_contact_kind kind, const feature_pairs *pairs,
                        uint32_t i, uint32_t lanes, const proximity_outcomes *near, contact_worker *worker) {
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t at = (uint32_t)__builtin_ctz(lanes);
        elementary_contact contact = nearest_points(interval, kind, pairs->a[i + at], near, at);
        add_contact(interval, kind, pairs, i + at, &contact, false, worker);
    }
}

/* The same, by name alone; there is room in the list. */
static void name_near(const feature_pairs *pairs, uint32_t i, uint32_t lanes, feature_list *named) {
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t at = i + (uint32_t)__builtin_ctz(lanes);
        named->count = feature_list_put(named, named->count, pairs->a[at], pairs->b[at], 1);
    }
}

/* How far some vertices of a pair go along a direction at the most; 0 if they go back. */
static double way_along(const swept_interval *interval, const uint32_t *vertices, int count,
                        const double direction[3], double sign) {
    double farthest = 0.0;
    for (int i = 0; i < count; i++) {
        const double *m = interval->motion->motions + (size_t)vertices[i] * 3;
        farthest =
            larger_way(farthest, sign * (m[0] * direction[0] + m[1] * direction[1] + m[2] * direction[2]));
    }
    return farthest;
}

/* The sides of a pair go towards each other by less than what is between them and what they have to keep, with some of it to
 * spare: planes across the offset would stop neither (docs/theory/displacement-bounds.md, lemma 4). All is times the distance,
 * which is the length of the offset. */
static bool motion_parts(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                         const proximity_outcomes *near, uint32_t lane) {
    const cscd_mesh *mesh = interval->mesh;
    const motion_bounds *motion = interval->motion;
    const double offset[3] = {near->offset[0][lane], near->offset[1][lane], near->offset[2][lane]};
    const double distance = near->distance[lane], room = 0.98 * distance - motion->kept - motion->rounding;
    const bool vf = kind == CSCD_CONTACT_VF;
    if (!(room > 0.0)) return false;
    const double of_a = way_along(interval, vf ? &a : mesh->edges[a], vf ? 1 : 2, offset, -1.0),
                 of_b =
                     way_along(interval, vf ? mesh->triangles[b] : mesh->edges[b], vf ? 3 : 2, offset, 1.0);
    return of_a + of_b <= room * distance;
}

/* Returns the lanes without those pairs, which are counted. */
static uint32_t drop_parted(const swept_interval *interval, cscd_contact_kind kind,
                            const feature_pairs *pairs, uint32_t i, uint32_t lanes,
                            const proximity_outcomes *near, contact_worker *worker) {
    uint32_t kept = lanes;
    for (; lanes != 0; lanes &= lanes - 1) {
        const uint32_t at = (uint32_t)__builtin_ctz(lanes);
        if (!motion_parts(interval, kind, pairs->a[i + at], pairs->b[i + at], near, at)) continue;
        kept &= ~(1u << at);
        worker->parted++;
    }
    return kept;
}

/* Eight at a time; keeps the pairs that the kernel leaves open. */
static void decide_proximity(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                             contact_worker *worker) {
    const ccd_kernels *table = ccd_kernels_of(interval->mesh->context);
    proximity_kernel *kernel = kind == CSCD_CONTACT_VF ? table->proximity_vf : table->proximity_ee;
    const bool counts = interval->naming && interval->motion != NULL && interval->motion->motions != NULL;
    feature_source source = swept_interval_source(interval);
    feature_list named;
    separations_x8 limits;
    uint32_t kept = 0;
    named.count = 0;
    if (pairs->count > 0) {
        repeat_last(pairs);
        load_limits(interval, kind, pairs, 0, &limits);
    }
    for (uint32_t i = 0; i < pairs->count; i += LANES) {
        proximity_outcomes near;
        uint32_t real = lanes_from(pairs, i);
        if (i > 0 && !one_limit(interval)) load_limits(interval, kind, pairs, i, &limits);
        kernel(&source, pairs->a + i, pairs->b + i, &limits, &near);
        uint32_t within = interval->floor_ratio > 0.0 ? 0 : near.within;
        uint32_t listed = real & within;
        if (counts) listed = drop_parted(interval, kind, pairs, i, listed, &near, worker);
        if (interval->naming)
            name_near(pairs, i, listed, &named);
        else
            add_nearest(interval, kind, pairs, i, listed, &near, worker);
        kept = keep_lanes(pairs, i, real & ~within & ~near.apart, kept);
    }
    if (named.count > 0) contact_worker_add_candidates(interval->mesh->context, worker, kind, &named);
    pairs->count = kept;
}

static void test_separations(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                             contact_worker *worker) {
    worker->separations += pairs->count;
    decide_proximity(interval, kind, pairs, worker);
    for (uint32_t i = 0; i < pairs->count; i++) {
        elementary_query query;
        elementary_contact contact;
        bool bounded = false;
        separation limit = limit_of_pair(interval, kind, pairs->a[i], pairs->b[i]);
        swept_interval_load(interval, kind, pairs->a[i], pairs->b[i], &query);
        if ((kind == CSCD_CONTACT_VF ? separation_vf : separation_ee)(&query, &limit, &contact, &bounded))
            add_contact(interval, kind, pairs, i, &contact, bounded, worker);
    }
}

static bool shares_seam(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const uint32_t *names = interval->filter.seam_names;
    if (names == NULL) return false;
    const cscd_stencil s = mesh_stencil(interval->mesh, kind, a, b, 0.0, 0.0);
    const int first = points_of_first(kind);
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++)
            if (names[s.vertices[i]] == names[s.vertices[j]]) return true;
    }
    return false;
}

/* Finds the pairs that fall below their floors. Those whose floor is 0 must not touch. */
static void test_floors(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                        contact_worker *worker) {
    uint32_t kept = 0;
    worker->separations += pairs->count;
    decide_proximity(interval, kind, pairs, worker);
    for (uint32_t i = 0; i < pairs->count; i++) {
        elementary_query query;
        elementary_contact contact;
        bool bounded = false;
        if (shares_seam(interval, kind, pairs->a[i], pairs->b[i])) continue;
        separation limit = pair_separation(interval, kind, pairs->a[i], pairs->b[i]);
        floor_ladder ladder = {limit.distance, interval->floor_ratio, limit.tolerance / limit.distance};
        swept_interval_load(interval, kind, pairs->a[i], pairs->b[i], &query);
        floor_verdict verdict = separation_floor_test(&query, kind, &ladder, &contact, &bounded);
        if (verdict == FLOOR_BROKEN) add_contact(interval, kind, pairs, i, &contact, bounded, worker);
        if (verdict == FLOOR_NONE) kept = keep_lanes(pairs, i, 1, kept);
    }
    pairs->count = kept;
    worker->separations -= kept;
    decide_by_levels(interval, kind, pairs, worker);
}

/* Pairs that have to stay apart by a distance go to the separations; what is left must not touch. */
static void split_by_distance(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                              feature_list *separations) {
    uint32_t kept = 0;
    separations->count = 0;
    for (uint32_t i = 0; i < pairs->count; i++) {
        uint32_t a = pairs->a[i], b = pairs->b[i];
        uint32_t apart = pair_separation(interval, kind, a, b).distance > 0.0;
        separations->count = feature_list_put(separations, separations->count, a, b, apart);
        pairs->a[kept] = a;
        pairs->b[kept] = b;
        kept += 1 - apart;
    }
    pairs->count = kept;
}

static void decide_with_distance(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                                 contact_worker *worker) {
    if (interval->floor_ratio > 0.0)
        test_floors(interval, kind, pairs, worker);
    else
        test_separations(interval, kind, pairs, worker);
}

static void decide_by_pair(const swept_interval *interval, cscd_contact_kind kind, feature_pairs *pairs,
                           contact_worker *worker) {
    feature_list list;
    split_by_distance(interval, kind, pairs, &list);
    feature_pairs separations = {list.a, list.b, list.count};
    decide_with_distance(interval, kind, &separations, worker);
    decide_by_levels(interval, kind, pairs, worker);
}

void feature_queue_decide(const swept_interval *interval, cscd_contact_kind kind, contact_worker *worker) {
    feature_list *list = &worker->queue[kind];
    feature_pairs pairs = {list->a, list->b, list->count};
    assert(list->count <= FEATURE_LIST_CAPACITY); /* kernels fill up behind it */
    if (interval->collecting)
        contact_worker_add_candidates(interval->mesh->context, worker, kind, list);
    else if (interval->thick)
        decide_by_pair(interval, kind, &pairs, worker);
    else if (interval->limit.distance > 0.0)
        decide_with_distance(interval, kind, &pairs, worker);
    else
        decide_by_levels(interval, kind, &pairs, worker);
    list->count = 0;
}
