/* The interval's contacts from all threads as one sorted list. */
#include "runtime/contact_list.h"

#include "src/sort.h"

/* Every lane has room for so many contacts, or for all, and for twice its share of more. */
enum { CONTACTS_FOR_ALL = 4096 };

typedef struct triangle_list {
    const uint32_t *items;
    uint32_t count;
} triangle_list;

static triangle_list vertex_star(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t begin = mesh->vertex_star_offsets[vertex];
    return (triangle_list){mesh->vertex_stars + begin, mesh->vertex_star_offsets[vertex + 1] - begin};
}

static triangle_list edge_star(const cscd_mesh *mesh, uint32_t edge) {
    return (triangle_list){mesh->edge_stars + mesh->edge_star_offsets[edge], edge_star_size(mesh, edge)};
}

static bool any_pair_ignored(const cscd_detector_options *options, triangle_list a, triangle_list b) {
    for (uint32_t i = 0; i < a.count; i++) {
        for (uint32_t j = 0; j < b.count; j++) {
            uint32_t s = a.items[i], t = b.items[j];
            if (s != t && options->ignore(options->ignore_user, s < t ? s : t, s < t ? t : s)) return true;
        }
    }
    return false;
}

static bool ignored(const cscd_detector *d, const cscd_contact *contact) {
    if (d->options.ignore == NULL) return false;
    if (contact->kind == CSCD_CONTACT_VF)
        return any_pair_ignored(&d->options, vertex_star(d->mesh, contact->a),
                                (triangle_list){&contact->b, 1});
    return any_pair_ignored(&d->options, edge_star(d->mesh, contact->a), edge_star(d->mesh, contact->b));
}

static int compare_contacts(const void *left, const void *right) {
    const cscd_contact *l = left, *r = right;
    if (l->toi != r->toi) return l->toi < r->toi ? -1 : 1;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void count_lane(const contact_lane *lane, cscd_counters *counters) {
    counters->feature_pairs += lane->feature_pairs;
    counters->by_signs += lane->decided[ELEMENTARY_SIGNS];
    counters->by_roots += lane->decided[ELEMENTARY_ROOTS];
    counters->by_exact += lane->decided[ELEMENTARY_EXACT];
    counters->tests += lane->decided[ELEMENTARY_SIGNS] + lane->decided[ELEMENTARY_ROOTS] +
                       lane->decided[ELEMENTARY_EXACT] + lane->separations;
}

/* How many contacts each lane finds differs from run to run: without this a buffer might grow in an interval
 * like those before. */
static cscd_status reserve_lanes(cscd_detector *d, size_t found) {
    uint32_t lanes = d->traversal.busy_lanes;
    size_t wanted = lanes > 1 && found > CONTACTS_FOR_ALL ? 2 * found / lanes + CONTACTS_FOR_ALL : found;
    for (uint32_t i = 0; lanes > 1 && i < lanes; i++) {
        contact_lane *lane = &d->contact_lanes[i];
        if (lane->capacity >= wanted) continue;
        size_t capacity = wanted + wanted / 2;
        cscd_contact *grown = context_grow(d->context, lane->contacts, lane->count, capacity, sizeof *grown);
        if (grown == NULL) return CSCD_OUT_OF_MEMORY;
        lane->contacts = grown;
        lane->capacity = capacity;
    }
    return CSCD_OK;
}

cscd_status contact_list_collect(cscd_detector *d, cscd_counters *counters, cscd_contacts *out) {
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) found += d->contact_lanes[i].count;
    cscd_status status = result_buffer_reserve(d->context, &d->contacts, found, sizeof(cscd_contact));
    if (status == CSCD_OK) status = reserve_lanes(d, found);
    if (status != CSCD_OK) return status;
    cscd_contact *items = d->contacts.items;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const contact_lane *lane = &d->contact_lanes[i];
        count_lane(lane, counters);
        for (size_t j = 0; j < lane->count; j++) {
            if (ignored(d, &lane->contacts[j])) continue;
            *(lane->contacts[j].kind == CSCD_CONTACT_VF ? &counters->vf : &counters->ee) += 1;
            counters->bounded += lane->contacts[j].bounded;
            items[kept++] = lane->contacts[j];
        }
    }
    sort_items_together(d->context->threads, items, d->contacts.scratch, kept, sizeof *items,
                        compare_contacts);
    *out = (cscd_contacts){items, kept};
    return CSCD_OK;
}
