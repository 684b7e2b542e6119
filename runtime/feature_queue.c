/* Pairs of features that wait for their elementary test: eight at a time through the kernels, and what these
 * leave open one by one. */
#include "runtime/feature_queue.h"

#include "runtime/narrow_phase.h"

static feature_source source_of(const swept_interval *interval) {
    return (feature_source){interval->x0, interval->x1, interval->vertex_volumes,
                            (const uint32_t(*)[3])interval->mesh->triangles,
                            (const uint32_t(*)[2])interval->mesh->edges};
}

/* What eight pairs' roots say, and for those of which they say nothing the other levels. */
static void decide_one_by_one(const swept_interval *interval, cscd_contact_kind kind, const uint32_t *a,
                              const uint32_t *b, uint32_t count, const root_outcomes *roots,
                              contact_lane *lane) {
    int first_count = kind == CSCD_CONTACT_VF ? 1 : 2;
    for (uint32_t i = 0; i < count; i++) {
        elementary_query query;
        elementary_hit hit;
        elementary_verdict verdict = {false, ELEMENTARY_ROOTS};
        if ((roots->misses >> i & 1) == 0) {
            narrow_phase_load(interval, kind, a[i], b[i], &query);
            if ((roots->hits >> i & 1) != 0) {
                verdict.touching = true;
                elementary_describe(&query, first_count, roots->begin[i], &hit);
            } else {
                verdict = elementary_after_signs(&query, first_count, &hit);
            }
        }
        lane->decided[verdict.level]++;
        if (verdict.touching) contact_lane_add(interval->mesh->context, lane, kind, a[i], b[i], &hit, false);
    }
}

static void decide_by_levels(const swept_interval *interval, cscd_contact_kind kind,
                             const feature_source *source, feature_pairs pairs, contact_lane *lane) {
    const kernels *table = kernels_of(interval->mesh->context);
    bool vf = kind == CSCD_CONTACT_VF;
    uint32_t tests = pairs.count;
    (vf ? table->keep_open_vf : table->keep_open_ee)(source, &pairs);
    lane->decided[ELEMENTARY_SIGNS] += tests - pairs.count;
    if (pairs.count == 0) return;
    for (uint32_t i = 0; i < KERNEL_LANES - 1; i++) {
        pairs.a[pairs.count + i] = pairs.a[pairs.count - 1];
        pairs.b[pairs.count + i] = pairs.b[pairs.count - 1];
    }
    for (uint32_t i = 0; i < pairs.count; i += KERNEL_LANES) {
        root_outcomes roots;
        uint32_t rest = pairs.count - i, count = rest < KERNEL_LANES ? rest : KERNEL_LANES;
        (vf ? table->roots_vf : table->roots_ee)(source, pairs.a + i, pairs.b + i, &roots);
        decide_one_by_one(interval, kind, pairs.a + i, pairs.b + i, count, &roots, lane);
    }
}

static void test_separations(const swept_interval *interval, cscd_contact_kind kind, feature_pairs pairs,
                             contact_lane *lane) {
    for (uint32_t i = 0; i < pairs.count; i++) {
        elementary_query query;
        elementary_hit hit;
        bool bounded = false;
        narrow_phase_load(interval, kind, pairs.a[i], pairs.b[i], &query);
        lane->separations++;
        if ((kind == CSCD_CONTACT_VF ? separation_vf : separation_ee)(&query, &interval->limit, &hit,
                                                                      &bounded))
            contact_lane_add(interval->mesh->context, lane, kind, pairs.a[i], pairs.b[i], &hit, bounded);
    }
}

static void decide(const swept_interval *interval, cscd_contact_kind kind, feature_list *list,
                   contact_lane *lane) {
    const kernels *table = kernels_of(interval->mesh->context);
    feature_source source = source_of(interval);
    feature_pairs pairs = {list->a, list->b, list->count};
    if (interval->vertex_volumes != NULL)
        (kind == CSCD_CONTACT_VF ? table->keep_near_vf : table->keep_near_ee)(&source, &pairs);
    if (interval->limit.distance > 0.0)
        test_separations(interval, kind, pairs, lane);
    else
        decide_by_levels(interval, kind, &source, pairs, lane);
    list->count = 0;
}

void feature_queue_decide_vf(const swept_interval *interval, contact_lane *lane) {
    decide(interval, CSCD_CONTACT_VF, &lane->queue.vf, lane);
}

void feature_queue_decide_ee(const swept_interval *interval, contact_lane *lane) {
    decide(interval, CSCD_CONTACT_EE, &lane->queue.ee, lane);
}
