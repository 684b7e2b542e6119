/* The interval at hand: which components are culled in it, what contacts have done to them, and the limit of its list. */
#include "runtime/detector/interval.h"

#include <math.h>
#include <string.h>

/* ---- what culling learns ------------------------------------------------------------------------------- */

/* One interval in this many counts pairs, since counting takes a twentieth of the time where few are left. */
enum { INTERVALS_BETWEEN_COUNTS = 4 };

void interval_begin_counting(detector_interval *iv, const culling_rules *rules, start_states *starts,
                             bool proves) {
    size_t components = iv->space->mesh->component_count, workers = iv->space->traversal.worker_count;
    memset(iv->touched, 0, components * sizeof *iv->touched);
    iv->passes = 0;
    if (!rules->where_it_pays) return;
    culling_choice_decide(starts, proves);
    iv->counts_kept = iv->intervals % INTERVALS_BETWEEN_COUNTS == 0 || culling_choice_begins(starts);
    for (size_t i = 0; i < workers; i++)
        iv->space->workers[i].kept = iv->counts_kept ? iv->kept_by_workers + i * components : NULL;
    if (iv->counts_kept) memset(iv->kept_by_workers, 0, workers * components * sizeof *iv->kept_by_workers);
}

void interval_learn(detector_interval *iv, const culling_rules *rules, start_states *starts) {
    size_t components = iv->space->mesh->component_count, workers = iv->space->traversal.worker_count;
    if (!rules->where_it_pays) return;
    memset(iv->kept, 0, components * sizeof *iv->kept);
    for (size_t i = 0; iv->counts_kept && i < workers; i++) {
        const uint32_t *kept = iv->kept_by_workers + i * components;
        for (size_t c = 0; c < components; c++) iv->kept[c] += kept[c];
    }
    const culling_outcome outcome = {iv->culled, iv->counts_kept ? iv->kept : NULL, iv->touched,
                                     iv->lists_earliest, iv->passes};
    culling_choice_learn(starts, &outcome);
    iv->intervals++;
}

void interval_cull_everything(detector_interval *iv) {
    const cscd_mesh *mesh = iv->space->mesh;
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        iv->culled[c] = iv->closes[c] = !component_is_obstacle(mesh, c);
        iv->touched[c] = 0;
    }
}

/* ---- only the earliest contacts ------------------------------------------------------------------------ */

void earliest_begin(detector_interval *iv) {
    for (uint32_t c = 0; c < iv->space->mesh->component_count; c++) iv->earliest[c] = INFINITY;
}

void earliest_note(detector_interval *iv) {
    for (uint32_t i = 0; i < iv->space->traversal.worker_count; i++) {
        const contact_worker *worker = &iv->space->workers[i];
        for (size_t j = iv->contacts_seen[i]; j < worker->count; j++)
            tainting_note(iv->space->mesh, contact_worker_at(worker, j), iv->earliest);
    }
}

static bool is_later(const detector_interval *iv, const cscd_contact *contact, double within) {
    uint32_t component = tainting_component(iv->space->mesh, contact);
    return component != UINT32_MAX && contact->toi - within > iv->earliest[component];
}

/* Contacts stay in order, so those that were seen are still the first ones. */
static void drop_from_worker(detector_interval *iv, uint32_t index, double within) {
    contact_worker *worker = &iv->space->workers[index];
    size_t kept = 0, seen = 0;
    for (size_t i = 0; i < worker->count; i++) {
        if (is_later(iv, contact_worker_at(worker, i), within)) continue;
        seen += i < iv->contacts_seen[index];
        *contact_worker_at(worker, kept++) = *contact_worker_at(worker, i);
    }
    worker->count = kept;
    iv->contacts_seen[index] = seen;
}

void earliest_drop_later(detector_interval *iv, double within) {
    for (uint32_t i = 0; i < iv->space->traversal.worker_count; i++) drop_from_worker(iv, i, within);
}

/* ---- the limit of a list ------------------------------------------------------------------------------- */

/* The room of a worker besides its share of the limit, so that workers are seldom suspended. */
enum { CONTACTS_BESIDE = 2048 };

cscd_status list_cap_set(cscd_context *context, const cscd_mesh *mesh, list_cap *cap, size_t longest) {
    if (longest > 0 && cap->tainted == NULL) {
        cap->tainted = context_allocate(context, mesh->triangle_count, sizeof *cap->tainted);
        if (cap->tainted == NULL) return CSCD_OUT_OF_MEMORY;
    }
    cap->longest = longest;
    cap->beside = CONTACTS_BESIDE;
    return CSCD_OK;
}

cscd_status list_cap_fail(cscd_context *context, const list_cap *cap, size_t count) {
    return context_fail(context, CSCD_LIST_TOO_LONG,
                        "the list would have %zu items, more than longest_list, which is %zu: call "
                        "cscd_detector_set_longest_list, or look at less",
                        count, cap->longest);
}

/* The number of contacts that a worker has room for before it is suspended. */
static size_t room_of_worker(const detector_interval *iv) {
    return iv->cap.longest / iv->space->traversal.worker_count + iv->cap.beside;
}

/* Drops what is left out, then says that the rest is in the list. */
static void settle_worker(detector_interval *iv, contact_worker *worker) {
    const exclusions *e = iv->exclusions;
    bool left_out_alone = iv->cap.taint == CAP_TAINTS_LEFT_OUT;
    size_t kept = worker->settled;
    for (size_t i = worker->settled; i < worker->count; i++) {
        const cscd_contact *c = contact_worker_at(worker, i);
        bool left_out = exclusions_cover(e, c->kind, c->a, c->b, NULL);
        if (left_out || !left_out_alone) tainting_mark(iv->space->mesh, c, iv->cap.tainted, iv->touched);
        if (!left_out) *contact_worker_at(worker, kept++) = *c;
    }
    worker->settled = worker->count = kept;
}

static void empty_workers(detector_interval *iv) {
    for (uint32_t i = 0; i < iv->space->traversal.worker_count; i++)
        iv->space->workers[i].settled = iv->space->workers[i].count = 0;
}

/* Called between two runs of the workers, on the calling thread. Once the list is too long, no contact is kept. */
static void spill_workers(void *data) {
    detector_interval *iv = data;
    search_space *s = iv->space;
    size_t count = s->counted;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        contact_worker *worker = &s->workers[i];
        settle_worker(iv, worker);
        count += worker->settled;
    }
    if (count > s->longest) {
        s->counted = count;
        empty_workers(iv);
    }
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        s->workers[i].limit = s->workers[i].settled + room_of_worker(iv);
        iv->contacts_seen[i] = s->workers[i].settled;
    }
    iv->cap.any_tainted = true;
}

/* The least toi only falls from here on, so what is dropped would neither be listed nor taint later either. What is left
 * counts towards the limit when all contacts are known. */
static void spill_later(void *data) {
    detector_interval *iv = data;
    earliest_note(iv);
    earliest_drop_later(iv, earliest_tainting);
    for (uint32_t i = 0; i < iv->space->traversal.worker_count; i++)
        iv->space->workers[i].limit = iv->space->workers[i].count + room_of_worker(iv);
}

void list_cap_begin(detector_interval *iv, interval_search *search, cap_taint taint) {
    if (iv->cap.longest == 0) return;
    iv->space->longest = iv->cap.longest;
    iv->cap.taint = taint;
    iv->cap.any_tainted = false;
    memset(iv->cap.tainted, false, iv->space->mesh->triangle_count * sizeof *iv->cap.tainted);
    search->spill = taint == CAP_KEEPS_EARLIEST ? spill_later : spill_workers;
    search->spill_data = iv;
    for (uint32_t i = 0; i < iv->space->traversal.worker_count; i++)
        iv->space->workers[i].limit = room_of_worker(iv);
}

uint32_t list_cap_taint(detector_interval *iv, const tainting *t) {
    uint32_t newly_kept = 0;
    if (iv->cap.longest == 0 || !iv->cap.any_tainted) return 0;
    for (uint32_t i = 0; i < iv->space->mesh->triangle_count; i++) {
        if (!iv->cap.tainted[i]) continue;
        newly_kept += tainting_triangle(t, i);
        iv->cap.tainted[i] = false;
    }
    iv->cap.any_tainted = false;
    return newly_kept;
}

void list_cap_begin_pairs(const list_cap *cap, static_check *check, size_t longest, void (*spill)(void *data),
                          void *data) {
    check->limit = longest / check->worker_count + cap->beside;
    check->spill = spill;
    check->spill_data = data;
}

void list_cap_end_pairs(static_check *check) {
    check->limit = SIZE_MAX;
}
