/* Intervals and frames as bytes, packed and unpacked. */
#include "tool/replay/step_bytes.h"

#include "tool/common/provenance.h"

#include <string.h>

uint64_t step_bytes_layout(void) {
    const uint32_t order = 0x01020304;
    const size_t sizes[] = {sizeof(cscd_contact),
                            sizeof(cscd_counters),
                            sizeof(cscd_timings),
                            sizeof(cscd_guarantee),
                            sizeof(cscd_intersections),
                            sizeof(cscd_intersection),
                            sizeof(cscd_curves),
                            sizeof(cscd_curve),
                            sizeof(cscd_curve_point),
                            sizeof(cscd_curve_piece),
                            sizeof(cscd_depths),
                            sizeof(cscd_depth),
                            sizeof(cscd_patch_depth),
                            sizeof(cscd_part_pairs),
                            sizeof(cscd_part_pair),
                            sizeof(bool),
                            sizeof(void *)};
    const uint64_t hash = provenance_hash(PROVENANCE_HASH_START, &order, sizeof order);
    return provenance_hash(hash, sizes, sizeof sizes);
}

/* ---- intervals ------------------------------------------------------------------------------------------- */

void step_bytes_add_interval(packed_bytes *out, const interval_step *step, uint32_t component_count) {
    const orientation_row *row = step->orientations;
    const uint64_t unlisted = step->unlisted;
    packed_bytes_add(out, &unlisted, sizeof unlisted);
    packed_bytes_add_array(out, step->contacts.items, step->contacts.count, sizeof *step->contacts.items);
    packed_bytes_add(out, &step->counters, sizeof step->counters);
    packed_bytes_add(out, &step->timings, sizeof step->timings);
    packed_bytes_add_array(out, step->guarantees, step->guarantees != NULL ? component_count : 0,
                           sizeof *step->guarantees);
    packed_bytes_add_array(out, row->points, row->region_count, sizeof *row->points);
    packed_bytes_add_array(out, row->facing,
                           row->region_count > 0 ? orientation_row_size(row->triangle_count) : 0, 1);
}

bool step_bytes_take_interval(packed_reader *in, step_place *place, interval_step *out,
                              uint32_t component_count) {
    uint64_t unlisted = 0;
    size_t guarantees, regions, facing;
    *out = (interval_step){.orientations = &place->orientations};
    packed_reader_copy(in, &unlisted, sizeof unlisted);
    out->unlisted = (size_t)unlisted;
    out->contacts.items = packed_reader_take_array(in, &out->contacts.count, sizeof *out->contacts.items);
    packed_reader_copy(in, &out->counters, sizeof out->counters);
    packed_reader_copy(in, &out->timings, sizeof out->timings);
    out->guarantees = packed_reader_take_array(in, &guarantees, sizeof *out->guarantees);
    orientation_row *row = &place->orientations;
    row->points = (double(*)[6])packed_reader_take_array(in, &regions, sizeof *row->points);
    row->facing = (uint8_t *)packed_reader_take_array(in, &facing, 1);
    row->region_count = (uint32_t)regions;
    if (out->unlisted > 0) out->guarantees = NULL;
    return !in->torn && guarantees == (out->unlisted > 0 ? 0 : component_count) &&
           facing == (regions > 0 ? orientation_row_size(row->triangle_count) : 0);
}

/* ---- frames ---------------------------------------------------------------------------------------------- */

static void add_curves(packed_bytes *out, const cscd_curves *c) {
    packed_bytes_add_array(out, c->items, c->count, sizeof *c->items);
    packed_bytes_add_array(out, c->points, c->point_count, sizeof *c->points);
    packed_bytes_add_array(out, c->pieces, c->piece_count, sizeof *c->pieces);
    packed_bytes_add_array(out, c->pair_curves, c->pair_count, sizeof *c->pair_curves);
}

static void take_curves(packed_reader *in, cscd_curves *c) {
    c->items = packed_reader_take_array(in, &c->count, sizeof *c->items);
    c->points = packed_reader_take_array(in, &c->point_count, sizeof *c->points);
    c->pieces = packed_reader_take_array(in, &c->piece_count, sizeof *c->pieces);
    c->pair_curves = packed_reader_take_array(in, &c->pair_count, sizeof *c->pair_curves);
}

static void add_depths(packed_bytes *out, const cscd_depths *d) {
    const uint64_t counts[2] = {d->vertex_count, d->edge_count};
    packed_bytes_add_array(out, d->items, d->count, sizeof *d->items);
    packed_bytes_add(out, counts, sizeof counts);
    packed_bytes_add_array(out, d->patches, d->patch_count, sizeof *d->patches);
}

static void take_depths(packed_reader *in, cscd_depths *d) {
    uint64_t counts[2] = {0, 0};
    *d = (cscd_depths){0};
    d->items = packed_reader_take_array(in, &d->count, sizeof *d->items);
    packed_reader_copy(in, counts, sizeof counts);
    d->vertex_count = (size_t)counts[0];
    d->edge_count = (size_t)counts[1];
    d->patches = packed_reader_take_array(in, &d->patch_count, sizeof *d->patches);
}

static void add_parts(packed_bytes *out, const cscd_part_pairs *p) {
    packed_bytes_add(out, p, sizeof *p);
    packed_bytes_add_array(out, p->items, p->count, sizeof *p->items);
}

static void take_parts(packed_reader *in, cscd_part_pairs *p) {
    packed_reader_copy(in, p, sizeof *p);
    p->items = packed_reader_take_array(in, &p->count, sizeof *p->items);
}

/* The lists that a frame has. */
enum { HAS_CHECK = 1, HAS_CURVES = 2, HAS_DEPTHS = 4, HAS_PARTS = 8, HAS_TURNED = 16 };

void step_bytes_add_frame(packed_bytes *out, const frame_check *check, uint32_t object_count,
                          uint32_t component_count) {
    const cscd_intersections *f = &check->found;
    const uint64_t has = (check->checked ? HAS_CHECK : 0) | (f->curves != NULL ? HAS_CURVES : 0) |
                         (f->depths != NULL ? HAS_DEPTHS : 0) | (f->parts != NULL ? HAS_PARTS : 0) |
                         (check->turned != NULL ? HAS_TURNED : 0);
    packed_bytes_add(out, &has, sizeof has);
    packed_bytes_add_array(out, check->hashes, object_count, sizeof *check->hashes);
    if (!check->checked) return;
    packed_bytes_add(out, &check->ms, sizeof check->ms);
    packed_bytes_add(out, f, sizeof *f);
    packed_bytes_add_array(out, f->items, f->count, sizeof *f->items);
    packed_bytes_add_array(out, f->collapsed_components, f->collapsed, sizeof *f->collapsed_components);
    if (f->curves != NULL) add_curves(out, f->curves);
    if (f->depths != NULL) add_depths(out, f->depths);
    if (f->parts != NULL) add_parts(out, f->parts);
    if (check->turned != NULL)
        packed_bytes_add_array(out, check->turned, component_count, sizeof *check->turned);
}

static void take_found(packed_reader *in, uint64_t has, step_place *place, cscd_intersections *f) {
    size_t collapsed;
    packed_reader_copy(in, f, sizeof *f);
    f->patches = NULL;
    f->overlaps = NULL;
    f->cut_offs = NULL;
    f->curves = has & HAS_CURVES ? &place->curves : NULL;
    f->depths = has & HAS_DEPTHS ? &place->depths : NULL;
    f->parts = has & HAS_PARTS ? &place->parts : NULL;
    f->items = packed_reader_take_array(in, &f->count, sizeof *f->items);
    f->collapsed_components = packed_reader_take_array(in, &collapsed, sizeof *f->collapsed_components);
    f->collapsed = (uint32_t)collapsed;
    if (has & HAS_CURVES) take_curves(in, &place->curves);
    if (has & HAS_DEPTHS) take_depths(in, &place->depths);
    if (has & HAS_PARTS) take_parts(in, &place->parts);
}

bool step_bytes_take_frame(packed_reader *in, step_place *place, frame_check *out, uint32_t object_count,
                           uint32_t component_count) {
    uint64_t has = 0;
    size_t objects, components = component_count;
    *out = (frame_check){.checked = false};
    packed_reader_copy(in, &has, sizeof has);
    out->hashes = packed_reader_take_array(in, &objects, sizeof *out->hashes);
    out->checked = (has & HAS_CHECK) != 0;
    if (out->checked) {
        packed_reader_copy(in, &out->ms, sizeof out->ms);
        take_found(in, has, place, &out->found);
        if (has & HAS_TURNED) out->turned = packed_reader_take_array(in, &components, sizeof *out->turned);
    }
    return !in->torn && objects == object_count && components == component_count;
}

/* ---- structs and arrays one after the other in memory, each on a multiple of 8 bytes --------------------- */

packed_bytes packed_bytes_create(void) {
    return (packed_bytes){.bytes = growable_of(1)};
}

void packed_bytes_free(packed_bytes *p) {
    growable_free(&p->bytes);
}

void packed_bytes_clear(packed_bytes *p) {
    p->bytes.count = 0;
    p->failed = false;
}

static size_t round_up(size_t size) {
    return (size + 7) / 8 * 8;
}

void packed_bytes_add(packed_bytes *p, const void *data, size_t size) {
    const size_t whole = round_up(size);
    p->failed = p->failed || whole < size || !growable_reserve(&p->bytes, p->bytes.count + whole);
    if (p->failed || size == 0) return;
    char *end = (char *)p->bytes.data + p->bytes.count;
    memcpy(end, data, size);
    memset(end + size, 0, whole - size);
    p->bytes.count += whole;
}

void packed_bytes_add_array(packed_bytes *p, const void *items, size_t count, size_t element_size) {
    const uint64_t number = count;
    packed_bytes_add(p, &number, sizeof number);
    packed_bytes_add(p, items, count * element_size); /* they are in memory, so this does not overflow */
}

const void *packed_reader_take(packed_reader *r, size_t size) {
    const size_t left = (size_t)(r->end - r->at);
    r->torn = r->torn || size > left || round_up(size) > left;
    if (r->torn) return NULL;
    const void *taken = r->at;
    r->at += round_up(size);
    return taken;
}

bool packed_reader_copy(packed_reader *r, void *out, size_t size) {
    const void *found = packed_reader_take(r, size);
    if (found != NULL) memcpy(out, found, size);
    return found != NULL;
}

const void *packed_reader_take_array(packed_reader *r, size_t *count, size_t element_size) {
    uint64_t number = 0;
    *count = 0;
    r->torn = !packed_reader_copy(r, &number, sizeof number) || number > SIZE_MAX / element_size;
    const void *items = packed_reader_take(r, (size_t)number * element_size);
    if (items != NULL) *count = (size_t)number;
    return items;
}
