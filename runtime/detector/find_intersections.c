/* Intersections by kind, of the public API: all, the first ones, their number, or whether there is one. */
#include "runtime/detector/detector.h"
#include "runtime/detector/surface_answers.h"
#include "runtime/intersections/intersections.h"
#include "src/core/least_sizes.h"
#include "src/core/sort.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"

#include <math.h>
#include <string.h>

/* ---- the API's names and defaults ---------------------------------------------------------------------- */

enum { KIND_COUNT = CSCD_INTERSECTION_TOUCHING + 1 };

static const uint64_t ALL_KINDS = (UINT64_C(1) << KIND_COUNT) - 1;

static const cscd_intersection_options default_options = {.struct_size = sizeof default_options,
                                                          .answer = CSCD_ANSWER_LIST,
                                                          .kinds = UINT64_MAX,
                                                          .depth_limit = (double)INFINITY};

void cscd_intersection_defaults_sized(cscd_intersection_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static cscd_status take_options(cscd_context *context, const cscd_intersection_options *options,
                                cscd_intersection_options *out) {
    *out = default_options;
    if (options == NULL) return CSCD_OK;
    cscd_status status = struct_take_options(context, out, sizeof *out, LEAST_SIZE(cscd_intersection_options),
                                             options, "cscd_intersection_defaults");
    if (status != CSCD_OK) return status;
    if ((unsigned)out->answer > CSCD_ANSWER_ANY)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown answer %d", (int)out->answer);
    if ((out->kinds & ALL_KINDS) == 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "kinds is %#llx, which has no kind: join sets of cscd_intersection_set",
                            (unsigned long long)out->kinds);
    if ((unsigned)out->orientation > CSCD_ORIENTATION_AS_GIVEN)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "unknown orientation %d", (int)out->orientation);
    if (!(out->depth_limit >= 0.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "depth_limit is %g; it is 0 or more",
                            out->depth_limit);
    bool all =
        out->answer == CSCD_ANSWER_LIST && (out->kinds & ALL_KINDS) == ALL_KINDS && out->stop_after == 0;
    if (surface_answers_wanted(out) && !all)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "curves, patches, overlaps, cut-offs and depths need the list of all pairs: answer LIST, every kind, and "
            "stop_after 0");
    if (out->parts && out->answer != CSCD_ANSWER_LIST)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "parts need a list of pairs: answer LIST");
    return CSCD_OK;
}

/* ---- memory -------------------------------------------------------------------------------------------- */

/* The most bytes that a pair takes: in the worker that finds it, and in the list, where it is sorted. */
enum { PAIR_SIZE = 64 };

static size_t most_memory(const cscd_detector *d, const cscd_intersection_options *options) {
    return options->max_memory > 0 ? options->max_memory : d->config.memory_most;
}

/* Before the first call that asks. */
static void look_at_memory(cscd_detector *d) {
    d->config.memory_most = memory_share();
}

static size_t longest_list(const cscd_detector *d, const cscd_intersection_options *options) {
    size_t fit = most_memory(d, options) / PAIR_SIZE, longest = d->config.options.longest_list;
    return longest > 0 && longest < fit ? longest : fit;
}

static cscd_status fail_too_long(const cscd_detector *d, const cscd_intersection_options *options,
                                 size_t count) {
    size_t longest = d->config.options.longest_list, most = most_memory(d, options);
    if (longest > 0 && count > longest) return list_cap_fail(d->context, &d->interval.cap, count);
    return context_fail(
        d->context, CSCD_LIST_TOO_LONG,
        "the list would have %zu pairs of triangles, of %d bytes each, more than max_memory, which is "
        "%zu bytes; are the vertices in another order than those of the triangles?",
        count, PAIR_SIZE, most);
}

/* ---- which pairs count --------------------------------------------------------------------------------- */

typedef struct kind_search {
    cscd_detector *detector;
    const double *positions;
    cscd_intersection_options options;
    size_t longest;             /* the most pairs that the list may have */
    exclusions without_host;    /* what is left out but by the caller's function, for any thread */
    size_t of_kind[KIND_COUNT]; /* pairs that count */
    bool keeps;                 /* these pairs stay in the workers */
    left_out_pairs *left_out;   /* gets those that are left out; NULL: nobody asks */
} kind_search;

static bool is_wanted(const kind_search *s, pair_note note) {
    return (s->options.kinds >> note.kind & 1) != 0;
}

static bool is_left_out(const kind_search *s, const exclusions *e, found_pair pair, pair_note note) {
    if (!exclusions_any(e)) return false;
    if (note.kind == CSCD_INTERSECTION_DUPLICATE) return exclusions_cover_duplicate(e, pair.a, pair.b);
    return exclusions_cover(e, CSCD_CONTACT_TT, pair.a, pair.b, s->positions);
}

static size_t count_found(const kind_search *s) {
    size_t count = 0;
    for (int kind = 0; kind < KIND_COUNT; kind++) count += s->of_kind[kind];
    return count;
}

/* ---- all pairs ----------------------------------------------------------------------------------------- */

/* Counts the pairs of a worker that are not settled yet, and drops what does not count. */
static void settle_worker(kind_search *s, intersection_worker *worker) {
    size_t kept = worker->settled;
    for (size_t i = worker->settled; i < worker->count; i++) {
        pair_note note = worker->notes[i];
        found_pair pair = worker->items[i];
        if (!is_wanted(s, note)) continue;
        if (is_left_out(s, &s->detector->config.exclusions, pair, note)) {
            if (s->left_out != NULL) left_out_pairs_add(s->left_out, pair.a, pair.b);
            continue;
        }
        s->of_kind[note.kind]++;
        if (s->keeps) intersection_worker_move(worker, i, kept++);
    }
    worker->settled = worker->count = kept;
}

static bool list_too_long(const kind_search *s) {
    return s->options.answer == CSCD_ANSWER_LIST && count_found(s) > s->longest;
}

/* Called between two rounds, on the calling thread. Once the list is too long, no pair is kept. */
static void settle_workers(void *data) {
    kind_search *s = data;
    static_check *check = &s->detector->known.check;
    for (uint32_t i = 0; i < check->worker_count; i++) settle_worker(s, &check->workers[i]);
    if (!list_too_long(s)) return;
    for (uint32_t i = 0; i < check->worker_count; i++)
        check->workers[i].settled = check->workers[i].count = 0;
}

static cscd_status find_all(kind_search *s) {
    cscd_detector *d = s->detector;
    list_cap_begin_pairs(&d->interval.cap, &d->known.check, s->keeps ? s->longest : 0, settle_workers, s);
    cscd_status status = static_check_kinds(&d->known.check, &d->space.traversal, &d->space.bvh, s->positions,
                                            d->config.exclusions.names);
    list_cap_end_pairs(&d->known.check);
    if (status == CSCD_OK) settle_workers(s);
    return status;
}

/* ---- the first pairs ----------------------------------------------------------------------------------- */

static bool pair_counts(void *data, found_pair pair, pair_note note) {
    const kind_search *s = data;
    return is_wanted(s, note) && !is_left_out(s, &s->without_host, pair, note);
}

static bool host_keeps(void *data, found_pair pair) {
    const kind_search *s = data;
    return !exclusions_host_ignores(&s->detector->config.exclusions, pair.a, pair.b);
}

static cscd_status find_first(kind_search *s) {
    cscd_detector *d = s->detector;
    bool any = s->options.answer == CSCD_ANSWER_ANY;
    const size_t most =
        s->keeps && s->longest < s->options.stop_after ? s->longest + 1 : s->options.stop_after;
    const pair_quest quest = {.enough = any ? 1 : most,
                              .any = any,
                              .data = s,
                              .counts = pair_counts,
                              .stays = d->config.exclusions.ignore != NULL ? host_keeps : NULL};
    s->without_host = d->config.exclusions;
    s->without_host.ignore = NULL;
    cscd_status status = first_pairs_find(&d->known.check, &d->space.traversal, &d->space.bvh, s->positions,
                                          d->config.exclusions.names, &quest);
    for (uint32_t i = 0; status == CSCD_OK && i < d->known.check.worker_count; i++) {
        const intersection_worker *worker = &d->known.check.workers[i];
        for (size_t j = 0; j < worker->count; j++) s->of_kind[worker->notes[j].kind]++;
    }
    return status;
}

/* If the caller wants more pairs than a list may have, the search cannot stop before that is known. */
static bool stops_early(const cscd_detector *d, const cscd_intersection_options *options) {
    size_t longest = options->answer == CSCD_ANSWER_LIST ? d->config.options.longest_list : 0;
    if (options->answer == CSCD_ANSWER_ANY) return true;
    return options->stop_after > 0 && (longest == 0 || options->stop_after <= longest);
}

/* ---- the result ---------------------------------------------------------------------------------------- */

/* The order of pairs, and what was found of them. */
typedef struct pair_key {
    uint64_t pair; /* a in the upper half, b in the lower one */
    uint32_t kind, shared;
} pair_key;

static cscd_intersection describe_pair(const cscd_mesh *mesh, const pair_key *key) {
    cscd_intersection pair = {.a = (uint32_t)(key->pair >> 32),
                              .b = (uint32_t)key->pair,
                              .kind = (cscd_intersection_kind)key->kind,
                              .shared = key->shared};
    pair.components[0] = mesh->triangle_components[pair.a];
    pair.components[1] = mesh->triangle_components[pair.b];
    mesh_objects_of_pair(mesh, CSCD_CONTACT_TT, pair.a, pair.b, pair.objects);
    return pair;
}

_Static_assert(2 * sizeof(pair_key) <= sizeof(cscd_intersection), "pairs are sorted in their own room");

/* Room for the list, with little to spare, since lists are long where memory matters. */
static cscd_status reserve_pairs(cscd_detector *d, size_t count) {
    if (count <= d->results.intersections.capacity && d->results.intersections.items != NULL) return CSCD_OK;
    const size_t room = count + count / 8 + 16;
    result_buffer_free(d->context, &d->results.intersections);
    d->results.intersections.items = context_reserve(d->context, room, sizeof(cscd_intersection));
    if (d->results.intersections.items == NULL) return CSCD_OUT_OF_MEMORY;
    d->results.intersections.capacity = room;
    return CSCD_OK;
}

/* Joins the lists of all workers, and sorts them. The keys and those to spare lie where the list will be, each half as long as
 * an item; the last items are described first, so that no key is written over before its turn. */
static cscd_status list_pairs(cscd_detector *d, size_t count, cscd_intersections *out) {
    cscd_status status = reserve_pairs(d, count);
    if (status != CSCD_OK) return status;
    pair_key *keys = d->results.intersections.items;
    size_t next = 0;
    for (uint32_t i = 0; i < d->known.check.worker_count; i++) {
        const intersection_worker *worker = &d->known.check.workers[i];
        for (size_t j = 0; j < worker->count; j++) {
            found_pair p = worker->items[j];
            keys[next++] =
                (pair_key){(uint64_t)p.a << 32 | p.b, worker->notes[j].kind, worker->notes[j].shared};
        }
    }
    sort_by_number(keys, keys + count, count, sizeof *keys);
    cscd_intersection *items = d->results.intersections.items;
    for (size_t i = count; i-- > 0;) {
        const pair_key key = keys[i];
        items[i] = describe_pair(d->mesh, &key);
    }
    out->items = items;
    return CSCD_OK;
}

static void count_zero_area(const static_check *check, cscd_intersections *out) {
    out->first_zero_area = UINT32_MAX;
    for (uint32_t i = 0; i < check->worker_count; i++) {
        const intersection_worker *worker = &check->workers[i];
        out->zero_area_triangles += worker->zero_area_triangles;
        if (worker->first_zero_area < out->first_zero_area) out->first_zero_area = worker->first_zero_area;
    }
}

/* Where pairs are not listed, nothing else is found. */
static void leave_out_list(const kind_search *s, cscd_intersections *out) {
    const size_t longest = s->detector->config.options.longest_list;
    const bool by_memory = longest == 0 || out->count <= longest;
    if (!by_memory) return;
    surface_answers_leave_out_list(&s->options, out);
    out->wanted_memory = out->count < SIZE_MAX / PAIR_SIZE ? out->count * PAIR_SIZE : SIZE_MAX;
}

static cscd_status give_result(const kind_search *s, cscd_intersections *out) {
    cscd_detector *d = s->detector;
    const size_t *of_kind = s->of_kind;
    cscd_intersections result = {.count = count_found(s),
                                 .collapsed = d->known.collapsed.count,
                                 .collapsed_components = collapsed_list(&d->known.collapsed)};
    count_zero_area(&d->known.check, &result);
    if (s->options.answer == CSCD_ANSWER_ANY) {
        result.stopped = result.count > 0;
    } else {
        result.crossing = of_kind[CSCD_INTERSECTION_CROSSING];
        result.coplanar = of_kind[CSCD_INTERSECTION_COPLANAR];
        result.folded = of_kind[CSCD_INTERSECTION_FOLDED];
        result.duplicate = of_kind[CSCD_INTERSECTION_DUPLICATE];
        result.touching = of_kind[CSCD_INTERSECTION_TOUCHING];
        result.stopped = s->options.stop_after > 0 && result.count == s->options.stop_after;
    }
    bool too_long = list_too_long(s);
    if (too_long) leave_out_list(s, &result);
    cscd_status status = CSCD_OK;
    if (s->options.answer == CSCD_ANSWER_LIST && !too_long) status = list_pairs(d, result.count, &result);
    if (status == CSCD_OK) *out = result;
    return too_long ? fail_too_long(d, &s->options, result.count) : status;
}

/* ---- the call ------------------------------------------------------------------------------------------ */

typedef struct kind_question {
    cscd_intersection_options options;
    bool
        early; /* the search may end early; else every triangle that intersects is marked, so states are known */
    surface_measure measure;
    cscd_intersections *out;
} kind_question;

static cscd_status sum_up_parts(cscd_detector *d, memory_budget *budget, cscd_intersections *found) {
    const same_solids *same = found->depths != NULL ? &d->results.answers->same_solids : NULL;
    cscd_status status = part_sums_run(&d->results.part_sums, d->mesh, &d->config.parts, found, same, budget,
                                       &d->results.part_pairs);
    if (status == CSCD_OK) found->parts = &d->results.part_pairs;
    if (status != CSCD_OUT_OF_MEMORY || !budget->exceeded) return status;
    part_sums_free(d->context, &d->results.part_sums);
    surface_answers_leave_out(budget, CSCD_LEFT_OUT_PARTS, found);
    return CSCD_OK;
}

#define MAX_WORK_DEFAULT ((uint64_t)1 << 28)

/* Memory that calls keep for the next ones does not count, so a quarter is left for it. If they keep more than that, it is given
 * back first. */
static memory_budget begin_memory(cscd_detector *d, const cscd_intersection_options *options) {
    size_t most = most_memory(d, options), kept = most / 8;
    if (d->results.part_sums.key_capacity > kept / sizeof(part_key))
        part_sums_free(d->context, &d->results.part_sums);
    surface_answers_shrink(d->context, &d->results.answers, kept);
    return (memory_budget){.most = most - most / 4,
                           .most_work = options->max_work > 0 ? options->max_work : MAX_WORK_DEFAULT};
}

static cscd_status find_kinds(cscd_detector *d, const double *positions, const kind_question *q) {
    memory_budget budget = begin_memory(d, &q->options);
    kind_search s = {.detector = d,
                     .positions = positions,
                     .options = q->options,
                     .longest = longest_list(d, &q->options),
                     .keeps = q->options.answer == CSCD_ANSWER_LIST};
    bool more = surface_answers_wanted(&q->options);
    left_out_pairs *left_out = more ? surface_answers_begin(&d->space, &d->results.answers) : NULL;
    if (more && left_out == NULL) return CSCD_OUT_OF_MEMORY;
    if (q->options.overlaps || q->measure == MEASURE_VOLUMES) s.left_out = left_out;
    cscd_status status = q->early ? find_first(&s) : find_all(&s);
    if (status == CSCD_OK && q->early && list_too_long(&s)) { /* than fits the memory: all are counted */
        memset(s.of_kind, 0, sizeof s.of_kind);
        status = find_all(&s);
    }
    if (status == CSCD_OK) status = give_result(&s, q->out);
    const surface_scene scene = {&d->config, &d->space, positions, d->known.check.collapsed, q->measure};
    if (status == CSCD_OK && more)
        status = surface_answers_find(d->results.answers, &scene, &q->options, &budget, q->out);
    if (status == CSCD_OK && q->options.parts) status = sum_up_parts(d, &budget, q->out);
    return status;
}

static cscd_status answer_question(cscd_detector *d, const double *positions, kind_question *question) {
    cscd_status status = bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, positions, uniform_growth(0.0),
                                             config_growth(&d->config));
    detector_find_collapsed(d, positions, positions);
    if (status == CSCD_OK) status = detector_leave_collapsed(d, COLLAPSED_LEFT);
    d->known.check.collapsed = collapsed_marks(&d->known.collapsed);
    if (status == CSCD_OK) status = find_kinds(d, positions, question);
    d->known.check.collapsed = NULL;
    detector_leave_collapsed(d, COLLAPSED_FOUND);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
}

/* Sets the marks of components whose triangles are not looked at with each other to false. */
static void unmark_masked(const cscd_detector *d, bool *triangles) {
    for (uint32_t t = 0; d->config.pair_rules.sets != NULL && t < d->mesh->triangle_count; t++)
        triangles[t] = triangles[t] && !config_masks(&d->config, d->mesh, d->mesh->triangle_components[t]);
}

/* Inactive triangles have been compared with active ones only, so nothing is known of those that do not cross them. */
static void unmark_inactive(const cscd_detector *d, bool *triangles) {
    const bool *active = d->space.active.triangles;
    for (uint32_t t = 0; active != NULL && t < d->mesh->triangle_count; t++)
        triangles[t] = active[t] || d->known.check.crossing[t];
}

/* States and positions belong together, so both are written when all is found. If the call is cancelled even now, or the
 * host's loop leaves out a task, the states may be those of other positions, and nothing is known. */
static cscd_status keep_states(cscd_detector *d, const double *positions) {
    if (!start_states_hold(&d->known.starts, positions)) start_states_begin(&d->known.starts, positions);
    unmark_inactive(d, d->known.check.unproven);
    unmark_masked(d, d->known.check.unproven);
    start_states_checked(&d->known.starts, d->known.check.unproven, d->known.check.crossing);
    cscd_status status = context_progress_status(d->context);
    if (status != CSCD_OK) start_states_forget(&d->known.starts);
    return status;
}

/* Asks at positions in one call that can be cancelled or fail; the caller has read them. */
static cscd_status ask_moment(cscd_detector *d, const double *positions, kind_question *question) {
    double since = timer_now_ms(), spent = 0.0;
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, positions);
    if (status != CSCD_OK) return status;

    detector_begin_call(d);
    progress_stage(&d->context->progress, "static check", 0.0, 1.0);
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_settle(&waiting, positions);
    if (status == CSCD_OK) status = answer_question(d, positions, question);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    if (!question->early) status = keep_states(d, positions);
    if (status != CSCD_OK) return status;
    timer_lap(&since, &spent);
    d->results.timings.check_ms = spent;
    return CSCD_OK;
}

/* Reads the positions and asks; options and measure are those of the question. */
static cscd_status ask_of_views(cscd_detector *d, const cscd_view *positions, kind_question *question) {
    const double *x = NULL;
    cscd_status status = views_read(d->context, d->mesh, positions, "positions", &d->unpacked[0], &x);
    if (d->config.memory_most == 0) look_at_memory(d);
    question->early = stops_early(d, &question->options);
    return status == CSCD_OK ? ask_moment(d, x, question) : status;
}

cscd_status detector_find_intersections(cscd_detector *d, const cscd_view *positions,
                                        const cscd_intersection_options *options, cscd_intersections *out) {
    cscd_context *context = d->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_find_intersections: out is NULL");
    cscd_intersections found;
    kind_question question = {.out = &found, .measure = MEASURE_NOTHING};
    cscd_status status = take_options(context, options, &question.options);
    if (status == CSCD_OK) status = ask_of_views(d, positions, &question);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_find_intersections(cscd_detector *detector, const cscd_view *positions,
                                             const cscd_intersection_options *options,
                                             cscd_intersections *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, detector_find_intersections(detector, positions, options, out));
}

/* ---- what follows from curves -------------------------------------------------------------------------- */

static cscd_status take_curve_options(cscd_context *context, const cscd_intersection_options *options,
                                      bool patches, cscd_intersection_options *out) {
    cscd_intersection_options given;
    cscd_status status = take_options(context, options, &given);
    if (status != CSCD_OK) return status;
    if (given.answer != CSCD_ANSWER_LIST || (given.kinds & ALL_KINDS) != ALL_KINDS || given.stop_after != 0)
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "volumes, lengths and lenses need all pairs: answer LIST, every kind, and stop_after 0");
    *out = default_options;
    out->curves = true;
    out->patches = patches;
    out->part_bodies = given.part_bodies;
    out->orientation = given.orientation;
    out->max_memory = given.max_memory;
    return CSCD_OK;
}

static cscd_status ask_for_curves(cscd_detector *d, const cscd_view *positions,
                                  const cscd_intersection_options *options, bool patches,
                                  kind_question *question) {
    cscd_status status = take_curve_options(d->context, options, patches, &question->options);
    if (status == CSCD_OK) status = ask_of_views(d, positions, question);
    if (status != CSCD_OK || question->out->left_out == 0) return status;
    return context_fail(d->context, CSCD_LIST_TOO_LONG,
                        "what %zu pairs of triangles make up does not fit max_memory, which is %zu bytes; "
                        "%zu may be enough",
                        question->out->count, most_memory(d, &question->options),
                        question->out->wanted_memory);
}

cscd_status surface_measure_ask(cscd_detector *d, const cscd_view *positions,
                                const cscd_intersection_options *options, surface_measure measure,
                                cscd_measures *out) {
    cscd_intersections found;
    kind_question question = {.out = &found, .measure = measure};
    cscd_status status = ask_for_curves(d, positions, options, measure == MEASURE_VOLUMES, &question);
    if (status == CSCD_OK) *out = d->results.answers->measures;
    return status;
}

cscd_status detector_find_patches(cscd_detector *d, const cscd_view *positions,
                                  const cscd_intersection_options *options, cscd_intersections *out) {
    kind_question question = {.out = out, .measure = MEASURE_NOTHING};
    return ask_for_curves(d, positions, options, true, &question);
}
