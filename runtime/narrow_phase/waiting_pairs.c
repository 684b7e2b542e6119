/* Pairs that a change has uncovered while they touched: they are left out until they have once been apart. */
#include "runtime/narrow_phase/waiting_pairs.h"

#include "runtime/narrow_phase/swept_interval.h"

#include <assert.h>

void waiting_pairs_settled(const cscd_mesh *mesh, waiting_pairs *w) {
    while (w->former != NULL) {
        former_exclusions *first = w->former;
        w->former = first->next;
        exclusions_free(mesh->context, &first->exclusions);
        pair_rules_free(mesh, &first->rules);
        context_free(mesh->context, first);
    }
}

void waiting_pairs_free(const cscd_mesh *mesh, waiting_pairs *w) {
    waiting_pairs_settled(mesh, w);
    context_free(mesh->context, w->spare);
    named_pair_set_free(mesh->context, &w->pairs);
    named_pair_set_free(mesh->context, &w->torn);
}

cscd_status waiting_pairs_reserve(const cscd_mesh *mesh, waiting_pairs *w) {
    if (w->spare == NULL) w->spare = context_allocate(mesh->context, 1, sizeof *w->spare);
    return w->spare != NULL ? CSCD_OK : context_out_of_memory(mesh->context);
}

static void remember_former(waiting_pairs *w, former_exclusions former) {
    assert(w->spare != NULL);
    former.next = w->former;
    *w->spare = former;
    w->former = w->spare;
    w->spare = NULL;
}

void waiting_pairs_uncover(waiting_pairs *w, exclusions *before) {
    remember_former(w, (former_exclusions){.exclusions = exclusions_listed(before)});
    *before = (exclusions){.mesh = NULL};
}

void waiting_pairs_uncover_objects(waiting_pairs *w, pair_rules *before) {
    remember_former(w, (former_exclusions){.rules = *before, .by_rules = true});
    *before = (pair_rules){.object_count = 0};
}

/* ---- what was left out --------------------------------------------------------------------------------- */

static bool objects_left_out(const cscd_mesh *mesh, const pair_rules *rules, const uint32_t of[2]) {
    if (rules->sets == NULL) return mesh->objects[of[0]].obstacle && mesh->objects[of[1]].obstacle;
    return !pair_rules_look_at(rules, of[0], of[1]);
}

bool waiting_pairs_uncovered(const cscd_mesh *mesh, const waiting_pairs *w, cscd_contact_kind kind,
                             uint32_t a, uint32_t b, const double *positions) {
    uint32_t objects[2];
    mesh_objects_of_pair(mesh, kind, a, b, objects);
    for (const former_exclusions *f = w->former; f != NULL; f = f->next) {
        if (f->by_rules) {
            if (objects_left_out(mesh, &f->rules, objects)) return true;
        } else if (kind == CSCD_CONTACT_TT ? exclusions_cover_triangles(&f->exclusions, a, b, positions)
                                           : exclusions_cover_features(&f->exclusions, kind, a, b)) {
            return true;
        }
    }
    return false;
}
