/* Pairs of features that a search at rest has found near each other: named in order, and described eight at a time. */
#include "runtime/detector/near_list.h"

#include "runtime/ccd/ccd.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- names --------------------------------------------------------------------------------------------- */

/* The bits that numbers of features have. */
static int bits_of_features(const cscd_mesh *mesh) {
    uint64_t largest = mesh->vertex_count | mesh->edge_count | mesh->triangle_count;
    int bits = 0;
    for (; largest > 0; largest >>= 1) bits++;
    return bits;
}

static uint64_t name_of(const near_list *list, uint32_t a, uint32_t b) {
    return (uint64_t)a << list->bits | b;
}

/* The place behind the last pair that has a name. */
static size_t named_end(const near_list *list) {
    return list->of_kind[CSCD_CONTACT_VF] + list->of_kind[CSCD_CONTACT_EE];
}

static const cscd_contact *known_at(const near_list *list, size_t i) {
    return ((const contact_key *)list->known.keys)[i].contact;
}

/* Contacts of other kinds are the last ones in order. */
static const cscd_contact *contact_of_other(const near_list *list, size_t pair) {
    return known_at(list, list->known_count - (list->count - pair));
}

cscd_contact_kind near_list_kind(const near_list *list, size_t pair) {
    if (pair < list->of_kind[CSCD_CONTACT_VF]) return CSCD_CONTACT_VF;
    return pair < named_end(list) ? CSCD_CONTACT_EE : contact_of_other(list, pair)->kind;
}

void near_list_name(const near_list *list, size_t pair, uint32_t *a, uint32_t *b) {
    if (pair < named_end(list)) {
        *a = (uint32_t)(list->names[pair] >> list->bits);
        *b = (uint32_t)(list->names[pair] & ((UINT64_C(1) << list->bits) - 1));
    } else {
        *a = contact_of_other(list, pair)->a;
        *b = contact_of_other(list, pair)->b;
    }
}

/* ---- gathering ----------------------------------------------------------------------------------------- */

/* Up to this number, every worker gets room for all candidates; beyond it, for this number and twice its share of all. */
enum { CANDIDATES_FOR_ALL = 4096 };

/* The number of pairs that a worker finds differs from run to run. */
static bool reserve_candidates(const search_space *s, cscd_contact_kind kind, size_t found) {
    const uint32_t workers = s->traversal.busy_workers;
    const size_t wanted =
        workers > 1 && found > CANDIDATES_FOR_ALL ? 2 * found / workers + CANDIDATES_FOR_ALL : found;
    for (uint32_t i = 0; workers > 1 && i < workers; i++) {
        if (!contact_worker_reserve_candidates(s->context, &s->workers[i], kind, wanted)) return false;
    }
    return true;
}

static bool reserve_names(cscd_context *context, near_list *list, size_t count) {
    if (count <= list->capacity && list->names != NULL) return true;
    context_free(context, list->names);
    list->names = context_reserve(context, room_with_spare(count), sizeof *list->names);
    list->capacity = list->names != NULL ? room_with_spare(count) : 0;
    return list->names != NULL;
}

/* Adds the candidates of a kind behind those that are there. */
static void add_candidates(const search_space *s, const exclusions *e, cscd_contact_kind kind,
                           near_list *list) {
    const bool any_left_out = exclusions_any(e);
    uint64_t *names = list->names + list->count;
    size_t kept = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        const candidate_list *found = &s->workers[i].candidates[kind];
        for (size_t j = 0; j < found->count; j++) {
            const uint32_t a = found->pairs[j][0], b = found->pairs[j][1];
            names[kept] = name_of(list, a, b);
            kept += !any_left_out || !exclusions_cover(e, kind, a, b, NULL);
        }
    }
    list->of_kind[kind] = kept;
    list->count += kept;
}

/* Contacts of these kinds have a name, too. */
static void add_contacts(cscd_contact_kind kind, near_list *list) {
    uint64_t *names = list->names + list->count;
    size_t kept = 0;
    for (size_t i = 0; i < list->known_count; i++) {
        const cscd_contact *contact = known_at(list, i);
        if (contact->kind == kind) names[kept++] = name_of(list, contact->a, contact->b);
    }
    list->of_kind[kind] += kept;
    list->count += kept;
}

static size_t count_candidates(const search_space *s, cscd_contact_kind kind) {
    size_t count = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) count += s->workers[i].candidates[kind].count;
    return count;
}

cscd_status near_list_gather(search_space *s, const exclusions *e, near_list *out) {
    const size_t vf = count_candidates(s, CSCD_CONTACT_VF), ee = count_candidates(s, CSCD_CONTACT_EE);
    out->bits = bits_of_features(s->mesh);
    out->count = out->of_kind[CSCD_CONTACT_VF] = out->of_kind[CSCD_CONTACT_EE] = 0;
    cscd_status status = contact_list_gather(s, e, 0, &out->known, &out->known_count);
    if (status != CSCD_OK) {
        out->count = out->known_count;
        return status;
    }
    if (!reserve_names(s->context, out, vf + ee + out->known_count) ||
        !reserve_candidates(s, CSCD_CONTACT_VF, vf) || !reserve_candidates(s, CSCD_CONTACT_EE, ee))
        return CSCD_OUT_OF_MEMORY;
    for (int kind = CSCD_CONTACT_VF; kind <= CSCD_CONTACT_EE; kind++) {
        add_candidates(s, e, (cscd_contact_kind)kind, out);
        add_contacts((cscd_contact_kind)kind, out);
    }
    for (size_t i = 0; i < out->known_count; i++) out->count += known_at(out, i)->kind > CSCD_CONTACT_EE;
    return CSCD_OK;
}

void near_list_free(cscd_context *context, near_list *list) {
    context_free(context, list->names);
    result_buffer_free(context, &list->known);
    list->names = NULL;
}

/* ---- order --------------------------------------------------------------------------------------------- */

/* Sorts by b first and then by kind and a, which keeps the order by b where these are equal. */
static void sort_known(near_list *list) {
    contact_key *keys = list->known.keys;
    for (size_t i = 0; i < list->known_count; i++) keys[i].key = keys[i].contact->b;
    sort_by_number(keys, list->known.spare_keys, list->known_count, sizeof *keys);
    for (size_t i = 0; i < list->known_count; i++)
        keys[i].key = (uint64_t)keys[i].contact->kind << 32 | keys[i].contact->a;
    sort_by_number(keys, list->known.spare_keys, list->known_count, sizeof *keys);
}

/* Moves names to their places by the number that they have at `shift`; each of these has its first place. */
static void place_names(const uint64_t *from, uint64_t *to, size_t count, int shift, uint64_t mask,
                        uint64_t *places) {
    for (size_t i = 0; i < count; i++) to[places[from[i] >> shift & mask]++] = from[i];
}

/* Turns how often numbers occur into the first place of each. */
static void begin_places(uint64_t *places, size_t numbers) {
    uint64_t place = 0;
    for (size_t i = 0; i < numbers; i++) {
        const uint64_t next = place + places[i];
        places[i] = place;
        place = next;
    }
}

/* Sorts by b and then by a. Pairs that are found one after the other are close to each other in the mesh, so both leave most of the
 * places in the cache. spare has room for the names and as many places. */
static void sort_by_features(uint64_t *names, uint64_t *spare, size_t count, int bits) {
    const size_t numbers = (size_t)1 << bits;
    const uint64_t mask = numbers - 1;
    uint64_t *of_a = spare + count, *of_b = of_a + numbers;
    memset(of_a, 0, 2 * numbers * sizeof *of_a);
    for (size_t i = 0; i < count; i++) {
        of_a[names[i] >> bits]++;
        of_b[names[i] & mask]++;
    }
    begin_places(of_a, numbers);
    begin_places(of_b, numbers);
    place_names(names, spare, count, 0, mask, of_b);
    place_names(spare, names, count, bits, mask, of_a);
}

static void sort_names(uint64_t *names, uint64_t *spare, size_t count, int bits) {
    if (bits < 32 && count >> bits >= 2)
        sort_by_features(names, spare, count, bits);
    else if (count > 0)
        sort_by_number(names, spare, count, sizeof *names);
}

void near_list_sort(near_list *list, uint64_t *spare) {
    const size_t vf = list->of_kind[CSCD_CONTACT_VF], ee = list->of_kind[CSCD_CONTACT_EE];
    sort_names(list->names, spare, vf, list->bits);
    sort_names(list->names + vf, spare, ee, list->bits);
    if (list->known_count > 0) sort_known(list);
}

/* Is the contact before the pair, in the order of sorted keys? */
static bool is_before(const contact_key *key, uint64_t kind_and_a, uint32_t b) {
    return key->key < kind_and_a || (key->key == kind_and_a && key->contact->b < b);
}

/* The place of the first contact that is not before the pair. */
static size_t first_known(const near_list *list, uint64_t kind_and_a, uint32_t b) {
    const contact_key *keys = list->known.keys;
    size_t begin = 0, end = list->known_count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (is_before(&keys[middle], kind_and_a, b))
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

static double distance_of(const near_scene *place, const cscd_contact *found) {
    const cscd_stencil s = mesh_stencil(place->mesh, found->kind, found->a, found->b, found->u, found->v);
    const double *x[4];
    double apart[3];
    for (int i = 0; i < 4; i++) x[i] = place->positions + (size_t)s.vertices[i] * 3;
    connection_between(x, s.weights, points_of_first(stencil_points(found->kind)), apart);
    return found->kind == CSCD_CONTACT_VH ? vec3_dot(apart, found->normal) : connection_length(apart);
}

static void describe_known(const near_scene *place, const cscd_contact *found, uint32_t i, near_eight *out) {
    out->a[i] = found->a;
    out->b[i] = found->b;
    out->at.u[i] = found->u;
    out->at.v[i] = found->v;
    out->at.distance[i] = distance_of(place, found);
    for (int k = 0; k < 3; k++) out->at.normal[k][i] = found->normal[k];
}

/* Replaces what a kernel says of pairs that it has left open. */
static void correct_known(const near_scene *place, near_eight *out) {
    const near_list *list = place->list;
    const contact_key *keys = list->known.keys;
    const uint64_t kind = (uint64_t)out->kind << 32;
    size_t next = first_known(list, kind | out->a[0], out->b[0]);
    for (uint32_t i = 0; next < list->known_count && i < out->count; i++) {
        while (next < list->known_count && is_before(&keys[next], kind | out->a[i], out->b[i])) next++;
        if (next < list->known_count && keys[next].key == (kind | out->a[i]) &&
            keys[next].contact->b == out->b[i])
            describe_known(place, keys[next].contact, i, out);
    }
}

/* Describes pairs of one kind that have names, and repeats the last one in the places behind it. */
static void describe_named(const near_scene *place, near_eight *out) {
    const ccd_kernels *table = ccd_kernels_of(place->mesh->context);
    const feature_source source = {place->positions, place->positions,
                                   (const uint32_t(*)[3])place->mesh->triangles,
                                   (const uint32_t(*)[2])place->mesh->edges};
    for (uint32_t i = out->count; i < LANES; i++) {
        out->a[i] = out->a[out->count - 1];
        out->b[i] = out->b[out->count - 1];
    }
    (out->kind == CSCD_CONTACT_VF ? table->nearest_vf : table->nearest_ee)(&source, out->a, out->b, &out->at);
    if (place->list->known_count > 0) correct_known(place, out);
}

void near_list_describe(const near_scene *place, const size_t *pairs, uint32_t count, near_eight *out) {
    const near_list *list = place->list;
    out->kind = near_list_kind(list, pairs[0]);
    out->count = count;
    for (uint32_t i = 0; i < count; i++) {
        if (out->kind <= CSCD_CONTACT_EE)
            near_list_name(list, pairs[i], &out->a[i], &out->b[i]);
        else
            describe_known(place, contact_of_other(list, pairs[i]), i, out);
    }
    if (out->kind <= CSCD_CONTACT_EE) describe_named(place, out);
}

void near_list_describe_from(const near_scene *place, size_t pair, size_t end, near_eight *out) {
    size_t pairs[LANES];
    uint32_t count = 1;
    const cscd_contact_kind kind = near_list_kind(place->list, pair);
    pairs[0] = pair;
    for (; count < LANES && pair + count < end; count++) {
        if (near_list_kind(place->list, pair + count) != kind) break;
        pairs[count] = pair + count;
    }
    near_list_describe(place, pairs, count, out);
}
