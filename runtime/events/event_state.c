/* The state of a tracker as bytes: numbers of 64 bits, the lowest byte first, in an order that follows from the frames
 * alone. What is read is checked so far that no call can go wrong later, whoever made the bytes. */
#include "runtime/events/event_tracker.h"

#include "src/core/sort.h"

#include <math.h>
#include <string.h>

/* "CSCDevt" and the version of the format. */
static const uint64_t MAGIC = UINT64_C(0x0174766544435343);

enum { HEADER_NUMBERS = 11, EVENT_NUMBERS = 22, STAMP_NUMBERS = 4, NUMBER_SIZE = 8 };

/* ---- numbers -------------------------------------------------------------------------------------------- */

typedef struct number_stream {
    uint8_t *to;         /* what is written, */
    const uint8_t *from; /* or read */
    uint64_t hash;       /* of all so far */
} number_stream;

static void pass_number(number_stream *s, uint64_t *number) {
    uint8_t bytes[NUMBER_SIZE];
    if (s->from != NULL) {
        *number = 0;
        for (int i = 0; i < NUMBER_SIZE; i++) *number |= (uint64_t)s->from[i] << 8 * i;
        s->from += NUMBER_SIZE;
    } else {
        for (int i = 0; i < NUMBER_SIZE; i++) bytes[i] = (uint8_t)(*number >> 8 * i);
        memcpy(s->to, bytes, NUMBER_SIZE);
        s->to += NUMBER_SIZE;
    }
    s->hash = (s->hash ^ *number) * 0x9e3779b97f4a7c15u;
    s->hash ^= s->hash >> 29;
}

static void pass_double(number_stream *s, double *x) {
    uint64_t bits;
    memcpy(&bits, x, sizeof bits);
    pass_number(s, &bits);
    memcpy(x, &bits, sizeof bits);
}

static void pass_event(number_stream *s, tracked_event *e) {
    uint64_t *const numbers[] = {&e->parts,  &e->first, &e->last,  &e->first_frame, &e->last_frame,
                                 &e->origin, &e->kinds, &e->pairs, &e->depths,      &e->contacts};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pass_number(s, numbers[i]);
    pass_double(s, &e->length);
    event_group *w = &e->worst;
    uint64_t *const worst[] = {&w->pairs, &w->contacts, &w->index, &w->frame, &w->origin, &w->triangle};
    for (size_t i = 0; i < sizeof worst / sizeof *worst; i++) pass_number(s, worst[i]);
    double *const lengths[] = {&w->depth, &w->length, &w->x[0], &w->x[1], &w->x[2]};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) pass_double(s, lengths[i]);
}

static void pass_stamp(number_stream *s, stamp *passed) {
    uint64_t element = passed->element, owner = passed->owner;
    pass_number(s, &passed->parts);
    pass_number(s, &passed->frame);
    pass_number(s, &element);
    pass_number(s, &owner);
    passed->element = (uint32_t)element;
    passed->owner = owner <= UINT32_MAX && element <= UINT32_MAX ? (uint32_t)owner : NO_EVENT;
}

/* The numbers before the lists. */
typedef struct state_header {
    uint64_t magic, options_hash, keeps_first, gap, frame_count, first_frame, last_frame;
    uint64_t open, closed, first, last;
} state_header;

static void pass_header(number_stream *s, state_header *h) {
    uint64_t *const numbers[HEADER_NUMBERS] = {&h->magic,       &h->options_hash, &h->keeps_first, &h->gap,
                                               &h->frame_count, &h->first_frame,  &h->last_frame,  &h->open,
                                               &h->closed,      &h->first,        &h->last};
    for (int i = 0; i < HEADER_NUMBERS; i++) pass_number(s, numbers[i]);
}

/* ---- writing -------------------------------------------------------------------------------------------- */

/* What is written, in its order. */
typedef struct sorted_state {
    tracked_event *events, *spare_events;
    uint32_t *ranks; /* per event of the history that has it all */
    stamp *first, *last, *spare_stamps;
    size_t event_count, first_count, last_count;
} sorted_state;

static array_list list_arrays(const event_history *h, sorted_state *s) {
    size_t events = h->open_count > h->closed_count ? h->open_count : h->closed_count;
    size_t stamps = h->first.count > h->last.count ? h->first.count : h->last.count;
    return (array_list){{ARRAY(s->events, h->open_count), ARRAY(s->spare_events, events),
                         ARRAY(s->ranks, h->event_count), ARRAY(s->first, h->first.count),
                         ARRAY(s->last, h->last.count), ARRAY(s->spare_stamps, stamps)}};
}

static int compare_stamps(const void *left, const void *right) {
    const stamp *a = left, *b = right;
    if (a->parts != b->parts) return a->parts < b->parts ? -1 : 1;
    return a->element < b->element ? -1 : a->element > b->element;
}

/* Sorts the open events. The index of the worst group holds the place meanwhile. */
static void sort_events(const event_history *h, sorted_state *s) {
    for (uint32_t e = 0; e < h->event_count; e++) {
        if (h->parents[e] != e) continue;
        tracked_event *event = &s->events[s->event_count++];
        *event = h->events[e];
        event->worst.index = e;
    }
    sort_items(s->events, s->spare_events, s->event_count, sizeof *s->events, tracked_event_compare);
    for (uint32_t i = 0; i < s->event_count; i++) {
        uint64_t *place = &s->events[i].worst.index;
        s->ranks[*place] = i;
        *place = h->events[*place].worst.index;
    }
}

static size_t sort_stamps(event_history *h, const stamp_table *table, sorted_state *s, bool first,
                          stamp *out) {
    size_t count = 0;
    for (size_t i = 0; i < table->count; i++) {
        if (!first && !frame_is_last(h, table->stamps[i].frame)) continue;
        out[count] = table->stamps[i];
        out[count].owner = s->ranks[event_root(h, out[count].owner)];
        count++;
    }
    sort_items(out, s->spare_stamps, count, sizeof *out, compare_stamps);
    return count;
}

static void write_lists(event_history *h, sorted_state *s, number_stream *stream) {
    sort_items(h->closed, s->spare_events, h->closed_count, sizeof *h->closed, tracked_event_compare);
    for (size_t i = 0; i < s->event_count; i++) pass_event(stream, &s->events[i]);
    for (size_t i = 0; i < h->closed_count; i++) pass_event(stream, &h->closed[i]);
    for (size_t i = 0; i < s->first_count; i++) pass_stamp(stream, &s->first[i]);
    for (size_t i = 0; i < s->last_count; i++) pass_stamp(stream, &s->last[i]);
}

static bool reserve_bytes(cscd_event_tracker *t, size_t count) {
    const array_list list = {{ARRAY(t->bytes, room_with_spare(count))}};
    return context_renew_all(t->context, list, &t->byte_capacity, count);
}

/* In 64 bits also where a size has fewer: the numbers of a header may come from anywhere. */
static uint64_t byte_count_of(const state_header *h) {
    uint64_t numbers = HEADER_NUMBERS + 1 + (h->open + h->closed) * EVENT_NUMBERS;
    return (numbers + (h->first + h->last) * STAMP_NUMBERS) * NUMBER_SIZE;
}

cscd_status event_state_write(cscd_event_tracker *t, size_t *byte_count) {
    event_history *h = &t->history;
    sorted_state s = {.events = NULL};
    if (!context_reserve_all(t->context, list_arrays(h, &s))) return CSCD_OUT_OF_MEMORY;
    sort_events(h, &s);
    s.first_count = sort_stamps(h, &h->first, &s, true, s.first);
    s.last_count = sort_stamps(h, &h->last, &s, false, s.last);
    state_header header = {MAGIC,           t->options_hash, h->keeps_first, h->gap,
                           h->frame_count,  h->first_frame,  h->last_frame,  s.event_count,
                           h->closed_count, s.first_count,   s.last_count};
    const uint64_t count = byte_count_of(&header);
    bool room = count < SIZE_MAX / 2 && reserve_bytes(t, (size_t)count);
    if (room) {
        number_stream stream = {.to = t->bytes};
        pass_header(&stream, &header);
        write_lists(h, &s, &stream);
        uint64_t hash = stream.hash;
        pass_number(&stream, &hash);
        *byte_count = (size_t)count;
    }
    context_free_all(t->context, list_arrays(h, &s));
    return room ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ---- reading -------------------------------------------------------------------------------------------- */

/* Why bytes are refused, or NULL. */
static const char *header_fault(const cscd_event_tracker *t, const state_header *h, size_t byte_count) {
    uint64_t most = byte_count / NUMBER_SIZE;
    if (h->magic != MAGIC) return "they are no state of a tracker, or of another version";
    if (h->options_hash != t->options_hash || h->gap != t->history.gap)
        return "they are of another mesh, or of other rings, gaps, labels or seams";
    if (h->keeps_first != t->history.keeps_first) return "they are of a tracker with another later_chunk";
    if (h->open > most || h->closed > most || h->first > most || h->last > most || h->open >= NO_EVENT ||
        byte_count_of(h) != byte_count)
        return "they are not whole";
    if (h->frame_count == 0 && (h->first_frame | h->last_frame | h->open | h->closed) != 0)
        return "they have events without a frame";
    if (h->frame_count > 0 &&
        (h->last_frame < h->first_frame || h->frame_count - 1 > h->last_frame - h->first_frame))
        return "the numbers of their frames do not fit together";
    return NULL;
}

static bool part_exists(const cscd_event_tracker *t, uint32_t part) {
    uint32_t count = t->parts.triangles != NULL ? t->parts.part_count : t->mesh.object_count;
    return part < count || part == UINT32_MAX;
}

static bool origin_exists(const cscd_event_tracker *t, uint64_t origin) {
    if (origin <= UINT32_MAX) return origin < t->mesh.triangle_count;
    return origin >> 32 == 1 && (uint32_t)origin < t->mesh.vertex_count;
}

static bool is_amount(double x) {
    return isfinite(x) && x >= 0.0;
}

static bool worst_fits(const cscd_event_tracker *t, const tracked_event *e) {
    const event_group *w = &e->worst;
    bool triangle = w->triangle < t->mesh.triangle_count || w->triangle == UINT32_MAX;
    return triangle && origin_exists(t, w->origin) && w->index >= e->first && w->index <= e->last &&
           w->frame >= e->first_frame && w->frame <= e->last_frame && is_amount(w->depth) &&
           is_amount(w->length) && w->length <= e->length;
}

static bool event_fits(const cscd_event_tracker *t, const event_history *h, const tracked_event *e) {
    uint32_t a = (uint32_t)(e->parts >> 32), b = (uint32_t)e->parts;
    return a <= b && part_exists(t, a) && part_exists(t, b) && e->first <= e->last &&
           e->last < h->frame_count && e->first_frame >= h->first_frame && e->last_frame <= h->last_frame &&
           e->first_frame <= e->last_frame && origin_exists(t, e->origin) && is_amount(e->length) &&
           worst_fits(t, e);
}

static bool is_open(const event_history *h, const tracked_event *e) {
    return frame_is_last(h, e->last) || frame_is_first(h, e->first);
}

static bool element_exists(const cscd_event_tracker *t, uint32_t element) {
    const cscd_mesh *mesh = &t->mesh;
    if (t->rings.same) return element < mesh->triangle_count || UINT32_MAX - element < mesh->vertex_count;
    return element < mesh->vertex_count && t->rings.names[element] == element;
}

static bool stamp_fits(const cscd_event_tracker *t, const event_history *h, const stamp *s, bool first) {
    if (s->owner >= h->event_count || !element_exists(t, s->element)) return false;
    const tracked_event *owner = &h->events[s->owner];
    bool in_time = first ? frame_is_first(h, s->frame) : frame_is_last(h, s->frame);
    return in_time && s->parts == owner->parts && s->frame >= owner->first && s->frame <= owner->last;
}

static bool read_events(const cscd_event_tracker *t, const event_history *h, number_stream *stream,
                        tracked_event *events, size_t count, bool open) {
    for (size_t i = 0; i < count; i++) {
        pass_event(stream, &events[i]);
        if (!event_fits(t, h, &events[i]) || is_open(h, &events[i]) != open) return false;
        if (i > 0 && tracked_event_compare(&events[i - 1], &events[i]) >= 0) return false;
    }
    return true;
}

static bool read_stamps(const cscd_event_tracker *t, const event_history *h, number_stream *stream,
                        stamp_table *table, size_t count, bool first) {
    for (size_t i = 0; i < count; i++) {
        stamp s = {0};
        pass_stamp(stream, &s);
        if (!stamp_fits(t, h, &s, first)) return false;
        if (i > 0 && compare_stamps(&table->stamps[i - 1], &s) >= 0) return false;
        stamp_table_add(table, s);
    }
    return true;
}

static bool read_lists(const cscd_event_tracker *t, event_history *h, const state_header *header,
                       number_stream *stream) {
    h->event_count = h->open_count = (size_t)header->open;
    h->closed_count = (size_t)header->closed;
    for (uint32_t e = 0; e < h->event_count; e++) h->parents[e] = e;
    if (!read_events(t, h, stream, h->events, h->event_count, true) ||
        !read_events(t, h, stream, h->closed, h->closed_count, false) ||
        !read_stamps(t, h, stream, &h->first, (size_t)header->first, true) ||
        !read_stamps(t, h, stream, &h->last, (size_t)header->last, false))
        return false;
    uint64_t expected = stream->hash, hash = 0;
    pass_number(stream, &hash);
    return hash == expected;
}

static cscd_status refuse_bytes(const cscd_event_tracker *t, const char *fault) {
    return context_fail(t->context, CSCD_INVALID_ARGUMENT, "the bytes cannot be loaded: %s", fault);
}

cscd_status event_state_read(const cscd_event_tracker *t, const uint8_t *bytes, size_t byte_count,
                             event_history *out) {
    state_header header;
    number_stream stream = {.from = bytes};
    if (byte_count < (HEADER_NUMBERS + 1) * NUMBER_SIZE) return refuse_bytes(t, "they are not whole");
    pass_header(&stream, &header);
    const char *fault = header_fault(t, &header, byte_count);
    if (fault != NULL) return refuse_bytes(t, fault);
    event_history h = {.frame_count = header.frame_count,
                       .first_frame = header.first_frame,
                       .last_frame = header.last_frame,
                       .gap = t->history.gap,
                       .keeps_first = t->history.keeps_first};
    cscd_context *context = t->context;
    bool room = event_history_reserve(context, &h, (size_t)header.open, (size_t)header.closed) &&
                stamp_table_reserve(context, &h.first, (size_t)header.first) &&
                stamp_table_reserve(context, &h.last, (size_t)header.last);
    bool fits = room && read_lists(t, &h, &header, &stream);
    if (fits) {
        *out = h;
        return CSCD_OK;
    }
    event_history_free(context, &h);
    return room ? refuse_bytes(t, "they were changed") : CSCD_OUT_OF_MEMORY;
}
