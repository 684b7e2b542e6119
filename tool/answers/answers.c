/* The findings of each frame, and the events that these frames make up; of depths, those that are shown. */
#include "tool/answers/answers.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- depths that are shown ----------------------------------------------------------------------------- */

shown_depths shown_depths_of(const ignore_pairs *ignored) {
    return (shown_depths){.ignored = ignored,
                          .items = growable_of(sizeof(cscd_depth)),
                          .patches = growable_of(sizeof(cscd_patch_depth))};
}

void shown_depths_free(shown_depths *s) {
    growable_free(&s->items);
    growable_free(&s->patches);
}

static bool is_shown(const shown_depths *s, const cscd_depth *depth) {
    if (depth->vertex != UINT32_MAX)
        return !ignore_pairs_separate_vertex(s->ignored, depth->vertex, depth->triangle);
    if (depth->edge != UINT32_MAX)
        return !ignore_pairs_separate_edge(s->ignored, depth->edge, depth->triangle);
    return !ignore_pairs_separate_triangles(s->ignored, depth->face, depth->triangle);
}

/* The faces of a patch in one body follow each other. */
static bool keep_patch(shown_depths *s, const cscd_depth *face, size_t place) {
    cscd_patch_depth *last =
        s->patches.count > 0 ? (cscd_patch_depth *)s->patches.data + s->patches.count - 1 : NULL;
    if (face->patch == UINT32_MAX) return true;
    if (last != NULL && last->patch == face->patch && last->body == face->body) {
        const cscd_depth *items = s->items.data;
        if (face->depth > items[last->deepest].depth) last->deepest = place;
        return true;
    }
    cscd_patch_depth *kept = growable_push(&s->patches);
    if (kept != NULL) *kept = (cscd_patch_depth){face->patch, face->body, place};
    return kept != NULL;
}

bool shown_depths_choose(shown_depths *s, cscd_intersections *found) {
    const cscd_depths *all = found->depths;
    if (all == NULL || !ignore_pairs_any(s->ignored)) return true;
    s->items.count = s->patches.count = 0;
    s->list = (cscd_depths){0};
    s->all = all;
    const size_t points = all->vertex_count + all->edge_count;
    for (size_t i = 0; i < all->count; i++) {
        if (!is_shown(s, &all->items[i])) continue;
        cscd_depth *kept = growable_push(&s->items);
        if (kept == NULL) return false;
        *kept = all->items[i];
        if (i >= points && !keep_patch(s, &all->items[i], s->items.count - 1)) return false;
        s->list.vertex_count += i < all->vertex_count;
        s->list.edge_count += i >= all->vertex_count && i < points;
    }
    s->list.items = s->items.data;
    s->list.count = s->items.count;
    s->list.patches = s->patches.data;
    s->list.patch_count = s->patches.count;
    found->depths = &s->list;
    return true;
}

/* A pair of parts comes with the deepest of all its depths. If some are left out, others may still be there:
 * of a vertex between two parts, only one of which is left out. */
static void shown_depths_of_parts(const shown_depths *s, const cscd_intersections *found,
                                  cscd_part_pair *pair) {
    if (found->depths != &s->list || pair->deepest == SIZE_MAX) return;
    pair->depth = pair->bound = 0.0;
    for (size_t i = 0; i < s->list.count; i++) {
        const cscd_depth *depth = &s->list.items[i];
        const uint32_t part = s->ignored->parts.labels[depth->face];
        const uint32_t burier = s->ignored->parts.labels[depth->triangle];
        const bool of_pair = (part == pair->a && burier == pair->b) || (part == pair->b && burier == pair->a);
        if (of_pair && depth->depth > pair->depth) pair->depth = depth->depth;
        if (of_pair && depth->bound > pair->bound) pair->bound = depth->bound;
    }
}

/* ---- answers ------------------------------------------------------------------------------------------- */

static bool api_failed(const answers *a, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(a->recording->context));
}

static bool create_tracker(answers *a, io_error *error) {
    cscd_event_options options = cscd_event_defaults();
    options.max_memory = a->limits.memory;
    options.part_count = a->parts->count;
    options.labels = a->parts->labels;
    return cscd_event_tracker_create(a->recording->context, a->recording->mesh, &options, &a->tracker) ==
               CSCD_OK ||
           api_failed(a, error);
}

bool answers_open(recording *r, const ignore_pairs *ignored, bool depths, answer_limits limits, answers *out,
                  io_error *error) {
    answers a = {.recording = r,
                 .parts = &ignored->parts,
                 .depths = depths,
                 .orientation = CSCD_ORIENTATION_BY_PART,
                 .depth_limit = (double)INFINITY,
                 .limits = limits,
                 .shown = shown_depths_of(ignored),
                 .collapsed = collapsed_parts_of(r, &ignored->parts),
                 .frames = growable_of(sizeof(frame_answer))};
    a.seen = io_zeroed(((size_t)cscd_mesh_triangle_count(r->mesh) + 1) * sizeof *a.seen);
    a.seen_parts = io_zeroed(((size_t)a.parts->count + 1) * sizeof *a.seen_parts);
    if (a.seen == NULL || a.seen_parts == NULL || !turned_parts_open(r, a.parts, &a.turned)) {
        answers_close(&a);
        return io_fail(error, "out of memory");
    }
    if (!create_tracker(&a, error)) {
        answers_close(&a);
        return false;
    }
    *out = a;
    return true;
}

void answers_close(answers *a) {
    cscd_event_tracker_destroy(a->tracker);
    growable_free(&a->frames);
    shown_depths_free(&a->shown);
    turned_parts_close(&a->turned);
    if (a->parts != NULL) collapsed_parts_free(&a->collapsed);
    free(a->events);
    free(a->worst_first);
    free(a->seen);
    free(a->seen_parts);
    *a = (answers){0};
}

void answers_expect(answers *a, size_t frame_count) {
    a->wanted = frame_count;
}

void answers_leave_unfinished(answers *a, const char *format, ...) {
    if (a->unfinished.text[0] != '\0') return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(a->unfinished.text, sizeof a->unfinished.text, format, arguments);
    va_end(arguments);
}

const char *answers_unfinished(const answers *a) {
    return a->unfinished.text[0] != '\0' ? a->unfinished.text : NULL;
}

void answers_decide_depth(answers *a, double limit) {
    a->depth_limit = limit;
}

bool answers_prepare(const answers *a, cscd_detector *detector, io_error *error) {
    return part_names_tell(a->parts, detector) == CSCD_OK || api_failed(a, error);
}

const frame_answer *answers_frames(const answers *a) {
    return a->frames.data;
}

size_t answers_frame_count(const answers *a) {
    return a->frames.count;
}

bool answers_event_depth_known(const answers *a, const cscd_event *event) {
    const frame_answer *frames = answers_frames(a);
    if (event->depth > 0.0) return true;
    for (size_t i = 0; i < answers_frame_count(a); i++) {
        const bool within = frames[i].frame >= event->first_frame && frames[i].frame <= event->last_frame;
        if (within && !frames[i].spaces_known) return false;
    }
    return true;
}

size_t answers_count(const answers *a, frame_test *test) {
    size_t count = 0;
    for (size_t i = 0; i < answers_frame_count(a); i++) count += test(&answers_frames(a)[i]);
    return count;
}

bool answers_add_contacts(answers *a, const cscd_contacts *contacts, io_error *error) {
    a->waiting_contacts += contacts->count;
    return cscd_event_tracker_add_contacts(a->tracker, contacts->items, contacts->count) == CSCD_OK ||
           api_failed(a, error);
}

/* A new frame, with the contacts that wait for it. */
static frame_answer *push_frame(answers *a, uint32_t frame, io_error *error) {
    frame_answer *added = growable_push(&a->frames);
    if (added == NULL) {
        io_fail(error, "out of memory");
        return NULL;
    }
    *added =
        (frame_answer){.frame = frame, .contacts = a->waiting_contacts, .worst_parts = {NO_PART, NO_PART}};
    a->waiting_contacts = 0;
    return added;
}

static void count_faces(answers *a, const cscd_intersections *found, frame_answer *frame) {
    const uint32_t mark = (uint32_t)a->frames.count;
    for (size_t i = 0; i < found->count; i++) {
        if (found->items[i].kind != CSCD_INTERSECTION_CROSSING) continue;
        const uint32_t triangles[] = {found->items[i].a, found->items[i].b};
        for (int k = 0; k < 2; k++) {
            frame->crossing_faces += a->seen[triangles[k]] != mark;
            a->seen[triangles[k]] = mark;
        }
    }
}

static size_t count_pairs(const cscd_part_pair *pair) {
    return pair->crossing + pair->coplanar + pair->folded + pair->touching;
}

static bool lies_in_itself(const cscd_part_pair *pair) {
    return pair->a == pair->b && count_pairs(pair) == 0 && !pair->in_other_body;
}

static bool is_within(const cscd_part_pair *pair) {
    return pair->crossing > 0 || pair->depth > 0.0 || pair->same_solid;
}

/* In the order of events. */
static bool is_worse(const cscd_part_pair *a, const cscd_part_pair *b) {
    if (lies_in_itself(a) != lies_in_itself(b)) return lies_in_itself(b);
    if (is_within(a) != is_within(b)) return is_within(a);
    if (a->depth != b->depth) return a->depth > b->depth;
    if (a->length != b->length) return a->length > b->length;
    return count_pairs(a) > count_pairs(b);
}

static bool is_inside(const cscd_part_pair *pair) {
    return count_pairs(pair) == 0 && pair->depth > 0.0 && !pair->same_solid && !lies_in_itself(pair);
}

static void count_within(const cscd_part_pair *pair, frame_answer *frame) {
    if (pair->crossing > 0 || !is_within(pair) || lies_in_itself(pair)) return;
    if (pair->same_solid)
        frame->same++;
    else if (count_pairs(pair) > 0)
        frame->overlapping++;
}

static void count_part(answers *a, uint32_t part, frame_answer *frame) {
    uint32_t *seen = &a->seen_parts[part == NO_PART ? a->parts->count : part];
    frame->inside += *seen != (uint32_t)a->frames.count;
    *seen = (uint32_t)a->frames.count;
}

static int compare_part_pairs(const void *left, const void *right) {
    const cscd_part_pair *l = left, *r = right;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

/* Of two parts, the one that has the buried points is inside. A part inside of several counts once. */
static void count_inside(answers *a, const cscd_intersections *found, frame_answer *frame) {
    const uint32_t *labels = a->parts->labels;
    for (size_t i = 0; i < found->depths->count; i++) {
        const cscd_depth *depth = &found->depths->items[i];
        const uint32_t part = labels[depth->face], burier = labels[depth->triangle];
        if (!(depth->depth > 0.0)) continue;
        const cscd_part_pair key = {.a = part < burier ? part : burier, .b = part < burier ? burier : part};
        cscd_part_pair *pair =
            bsearch(&key, found->parts->items, found->parts->count, sizeof key, compare_part_pairs);
        if (pair != NULL && is_inside(pair)) count_part(a, part, frame);
    }
}

/* A part that only lies in itself follows from something else in the frame, if there is anything else. */
static void find_worst(answers *a, const cscd_intersections *found, frame_answer *frame) {
    cscd_part_pair worst = {.a = NO_PART, .b = NO_PART};
    bool worst_of_none = true, any_inside = false;
    size_t in_itself = 0;
    for (size_t i = 0; found->parts != NULL && i < found->parts->count; i++) {
        cscd_part_pair pair = found->parts->items[i];
        shown_depths_of_parts(&a->shown, found, &pair);
        if (count_pairs(&pair) == 0 && pair.depth == 0.0) continue;
        if (worst_of_none || is_worse(&pair, &worst)) worst = pair;
        worst_of_none = false;
        in_itself += lies_in_itself(&pair);
        any_inside = any_inside || is_inside(&pair);
        count_within(&pair, frame);
        if (pair.depth > frame->depth) frame->depth = pair.depth;
        if (pair.bound > frame->bound) frame->bound = pair.bound;
    }
    if (any_inside) count_inside(a, found, frame);
    if (!frame_answer_crosses(frame)) frame->inside = in_itself;
    frame->worst_parts[0] = worst.a;
    frame->worst_parts[1] = worst.b;
}

bool answers_find(const answers *a, cscd_detector *detector, const double *positions,
                  cscd_intersections *found, io_error *error) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.parts = true;
    options.curves = options.patches = options.depths = a->depths;
    options.orientation = a->orientation;
    options.depth_limit = a->depth_limit;
    options.part_bodies = true;
    options.max_memory = a->limits.memory;
    options.max_work = a->limits.work;
    const cscd_view *view = CSCD_DOUBLES(positions, cscd_mesh_vertex_count(a->recording->mesh));
    const cscd_status status = cscd_detector_find_intersections(detector, view, &options, found);
    if (status != CSCD_OK && status != CSCD_LIST_TOO_LONG) return api_failed(a, error);
    if (status == CSCD_LIST_TOO_LONG) found->count = 0;
    return true;
}

/* ---- what does not fit the memory ------------------------------------------------------------------------ */

enum { NAMES_SIZE = 200, SIZE_TEXT_SIZE = 32 };

/* "curves, patches and depths"; without pairs nothing else is named. Parts are ours, and not asked for by
 * anybody. */
static void name_left_out(uint64_t left_out, char text[NAMES_SIZE]) {
    const char *names[8];
    size_t count = 0, length = 0;
    for (int what = CSCD_LEFT_OUT_PAIRS; what < CSCD_LEFT_OUT_PARTS; what++) {
        if ((left_out >> what & 1) == 0 || what == CSCD_LEFT_OUT_PATCHES) continue;
        names[count++] =
            what == CSCD_LEFT_OUT_PAIRS ? "a list of them" : cscd_name(CSCD_LEFT_OUTS, (cscd_left_out)what);
        if (what == CSCD_LEFT_OUT_PAIRS) break;
    }
    if (count == 0) names[count++] = "sums by parts";
    for (size_t i = 0; i < count && length < NAMES_SIZE; i++)
        length += (size_t)snprintf(text + length, NAMES_SIZE - length, "%s%s",
                                   i == 0          ? ""
                                   : i + 1 < count ? ", "
                                                   : " and ",
                                   names[i]);
}

/* Values to try, in binary millions, upwards, as --max-memory and --max-work take them. */
static const char *size_text(const cscd_intersections *found, char text[SIZE_TEXT_SIZE]) {
    const bool large = found->wanted_work >> 20 > 0;
    if (found->wanted_work > 0)
        snprintf(text, SIZE_TEXT_SIZE, " (some %" PRIu64 "%c)", (found->wanted_work >> (large ? 20 : 10)) + 1,
                 large ? 'M' : 'K');
    else
        snprintf(text, SIZE_TEXT_SIZE, " (%zuM or more)", (found->wanted_memory >> 20) + 1);
    return text;
}

static void leave_out(answers *a, uint32_t frame, const cscd_intersections *found, const char *names,
                      const char *option, const char *size) {
    const size_t pairs =
        found->crossing + found->coplanar + found->folded + found->touching + found->duplicate;
    const bool tangled = pairs > cscd_mesh_triangle_count(a->recording->mesh);
    answers_leave_unfinished(
        a,
        "frame %d has %zu pairs of triangles that cross or touch, and %s would take more than %s allows%s%s",
        answers_frame_number(a, frame), pairs, names, option, size,
        tangled ? "; does the file list its vertices in another order than the model?" : "");
}

static void tell_left_out(answers *a, uint32_t frame, const cscd_intersections *found) {
    char names[NAMES_SIZE], size[SIZE_TEXT_SIZE];
    if (found->left_out == 0) return;
    name_left_out(found->left_out, names);
    leave_out(a, frame, found, names, found->wanted_work > 0 ? "--max-work" : "--max-memory",
              size_text(found, size));
}

void answers_leave_out_contacts(answers *a, uint32_t frame, size_t count) {
    a->waiting_contacts += count;
    answers_leave_unfinished(
        a,
        "the interval from frame %d has %zu contacts, and a list of them would take more than --max-memory allows; does "
        "the file list its vertices in another order than the model?",
        answers_frame_number(a, frame), count);
}

static bool track_frame(answers *a, uint32_t frame, const cscd_intersections *found, io_error *error) {
    const cscd_status status = cscd_event_tracker_add_frame(a->tracker, frame, found);
    if (status == CSCD_LIST_TOO_LONG) leave_out(a, frame, found, "events", "--max-memory", "");
    return status == CSCD_OK || status == CSCD_LIST_TOO_LONG || api_failed(a, error);
}

/* ---- frames ---------------------------------------------------------------------------------------------- */

bool answers_add_found(answers *a, uint32_t frame, cscd_intersections *found, double ms, io_error *error) {
    if (!shown_depths_choose(&a->shown, found)) return io_fail(error, "out of memory");
    frame_answer *added = push_frame(a, frame, error);
    if (added == NULL) return false;
    added->checked = true;
    added->crossing = found->crossing;
    added->touching = found->coplanar + found->folded + found->touching;
    added->duplicates = found->duplicate;
    added->spaces_known = found->depths != NULL && found->parts != NULL;
    added->unlisted = (found->left_out >> CSCD_LEFT_OUT_PAIRS & 1) != 0;
    added->ms = ms;
    added->without_area =
        found->collapsed > 0 && found->collapsed == cscd_mesh_component_count(a->recording->mesh);
    count_faces(a, found, added);
    if (!collapsed_parts_add(&a->collapsed, (uint32_t)a->frames.count - 1, found))
        return io_fail(error, "out of memory");
    find_worst(a, found, added);
    tell_left_out(a, frame, found);
    return track_frame(a, frame, found, error);
}

void answers_add_turned(answers *a, uint32_t frame, const bool *turned) {
    turned_parts_add(&a->turned, frame, turned);
}

bool answers_skip_frame(answers *a, uint32_t frame, io_error *error) {
    return push_frame(a, frame, error) != NULL && track_frame(a, frame, NULL, error);
}

/* ---- events -------------------------------------------------------------------------------------------- */

static bool copy_events(answers *a, const cscd_events *events) {
    a->events = io_realloc(NULL, (events->count + 1) * sizeof *a->events);
    a->worst_first = io_realloc(NULL, (events->count + 1) * sizeof *a->worst_first);
    if (a->events == NULL || a->worst_first == NULL) return false;
    a->event_count = events->count;
    if (events->count > 0) memcpy(a->events, events->items, events->count * sizeof *a->events);
    return consequences_leave_out(a->events, &a->event_count);
}

static bool order_events(answers *a) {
    const cscd_event **order = io_realloc(NULL, (a->event_count + 1) * sizeof *order);
    if (order == NULL) return false;
    for (size_t i = 0; i < a->event_count; i++) order[i] = &a->events[i];
    event_order_sort(order, a->event_count);
    for (size_t i = 0; i < a->event_count; i++) a->worst_first[i] = (size_t)(order[i] - a->events);
    free(order);
    return true;
}

bool answers_finish(answers *a, io_error *error) {
    const uint32_t next = a->frames.count > 0 ? answers_frames(a)[a->frames.count - 1].frame + 1 : 0;
    if (a->waiting_contacts > 0 && !answers_skip_frame(a, next, error)) return false;
    cscd_events events;
    if (cscd_event_tracker_finish(a->tracker, &events) != CSCD_OK) return api_failed(a, error);
    if (copy_events(a, &events) && order_events(a)) return true;
    a->event_count = 0; /* who looks at them goes by their order */
    return io_fail(error, "out of memory for the events");
}
