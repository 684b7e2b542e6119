/* Pairs that a change has uncovered while they touched: they are left out until they have once been apart. */
#include "runtime/narrow_phase/waiting_pairs.h"

#include "runtime/narrow_phase/swept_interval.h"

#include <assert.h>

static void forget_former(const cscd_mesh *mesh, former_exclusions **link) {
    former_exclusions *former = *link;
    *link = former->next;
    exclusions_free(mesh->context, &former->exclusions);
    context_free(mesh->context, former->sets);
    context_free(mesh->context, former);
}

void waiting_pairs_settled(const cscd_mesh *mesh, waiting_pairs *w) {
    while (w->former != NULL) forget_former(mesh, &w->former);
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

/* Does the first one leave out all that the second one does? */
static bool covers_former(const cscd_mesh *mesh, const former_exclusions *a, const former_exclusions *b) {
    if ((a->sets == NULL) != (b->sets == NULL)) return false;
    if (a->sets == NULL) return !exclusions_uncover(&b->exclusions, &a->exclusions);
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        if (!object_sets_are_alike(&a->sets[i], &b->sets[i])) return false;
    }
    return true;
}

static void remember_former(const cscd_mesh *mesh, waiting_pairs *w, former_exclusions former) {
    assert(w->spare != NULL);
    *w->spare = former;
    for (former_exclusions **link = &w->former; *link != NULL;) {
        if (covers_former(mesh, w->spare, *link))
            forget_former(mesh, link);
        else
            link = &(*link)->next;
    }
    w->spare->next = w->former;
    w->former = w->spare;
    w->spare = NULL;
}

static bool is_remembered(const cscd_mesh *mesh, const waiting_pairs *w, const former_exclusions *former) {
    for (const former_exclusions *f = w->former; f != NULL; f = f->next) {
        if (covers_former(mesh, f, former)) return true;
    }
    return false;
}

void waiting_pairs_uncover(const cscd_mesh *mesh, waiting_pairs *w, exclusions *before) {
    const former_exclusions former = {.exclusions = exclusions_listed(before)};
    if (is_remembered(mesh, w, &former))
        exclusions_free(mesh->context, before);
    else
        remember_former(mesh, w, former);
    *before = (exclusions){.mesh = NULL};
}

void waiting_pairs_uncover_objects(const cscd_mesh *mesh, waiting_pairs *w, object_set *before) {
    const former_exclusions former = {.sets = before};
    if (is_remembered(mesh, w, &former))
        context_free(mesh->context, before);
    else
        remember_former(mesh, w, former);
}

/* ---- what was left out --------------------------------------------------------------------------------- */

static bool objects_left_out(const object_set *sets, const uint32_t of[2]) {
    const object_set *a = &sets[of[0]], *b = &sets[of[1]];
    return a->kinds != 0 && b->kinds != 0 && !object_sets_may_meet(a, b);
}

bool waiting_pairs_uncovered(const cscd_mesh *mesh, const waiting_pairs *w, cscd_contact_kind kind,
                             uint32_t a, uint32_t b, const double *positions) {
    uint32_t objects[2];
    mesh_objects_of_pair(mesh, kind, a, b, objects);
    for (const former_exclusions *f = w->former; f != NULL; f = f->next) {
        if (f->sets != NULL) {
            if (objects_left_out(f->sets, objects)) return true;
        } else if (kind == CSCD_CONTACT_TT ? exclusions_cover_triangles(&f->exclusions, a, b, positions)
                                           : exclusions_cover_features(&f->exclusions, kind, a, b)) {
            return true;
        }
    }
    return false;
}
