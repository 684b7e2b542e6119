/* Steps that are certified free of contact: of a detector, by the stages of a step, and many along the one motion of a line
 * search, whose candidates serve every shorter step and every moment on it. */
#include "runtime/solver/solver.h"
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/core/timer.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <string.h>

/* ==== of a detector ======================================================================================== */

static void add_timings(cscd_timings *sum, const cscd_timings *more) {
    sum->update_ms += more->update_ms;
    sum->orientation_ms += more->orientation_ms;
    sum->contour_ms += more->contour_ms;
    sum->traversal_ms += more->traversal_ms;
    sum->contact_ms += more->contact_ms;
    sum->proof_ms += more->proof_ms;
}

static void add_counters(cscd_counters *sum, const cscd_counters *more) {
    sum->static_checks += more->static_checks;
    sum->clean += more->clean;
    sum->rebuilds += more->rebuilds;
    sum->passes += more->passes;
    sum->plus += more->plus;
    sum->minus += more->minus;
    sum->contours += more->contours;
    sum->sealed += more->sealed;
    sum->boxes_tested += more->boxes_tested;
    sum->pcp += more->pcp;
    sum->adjacent += more->adjacent;
    sum->feature_pairs += more->feature_pairs;
    sum->tests += more->tests;
    sum->by_signs += more->by_signs;
    sum->by_roots += more->by_roots;
    sum->by_exact += more->by_exact;
    sum->vf += more->vf;
    sum->ee += more->ee;
    sum->bounded += more->bounded;
    sum->loose += more->loose;
    sum->coherent += more->coherent;
}

_Static_assert(offsetof(cscd_counters, reserved) == 21 * sizeof(uint64_t), "add_counters adds every counter");

void tries_withdraw(tries *t) {
    if (t->any) step_withdraw(t->detector);
    t->any = false;
}

cscd_status tries_find(tries *t, const double *from, const double *to, cscd_mode mode, step_rule rule,
                       cscd_contacts *out) {
    step_outcome found;
    tries_withdraw(t);
    t->any = true;
    progress_part(&t->detector->context->progress, t->done, 0.5 + 0.5 * t->done);
    t->done = 0.5 + 0.5 * t->done;
    cscd_status status = step_find(t->detector, from, to, mode, rule, &found);
    if (status != CSCD_OK) return status;
    add_timings(&t->timings, &found.timings);
    add_counters(&t->counters, &found.counters);
    *out = found.contacts;
    return CSCD_OK;
}

cscd_status tries_fail(tries *t, cscd_status status) {
    tries_withdraw(t);
    return detector_fail_call(t->detector, status);
}

void tries_end(const tries *t, double since) {
    cscd_detector *d = t->detector;
    d->results.timings = t->timings;
    d->results.counters = t->counters;
    timer_lap(&since, &d->results.timings.total_ms);
}

static cscd_status try_motion(void *of, const double *from, const double *to, cscd_contacts *out) {
    return tries_find(of, from, to, CSCD_MODE_EARLIEST, STEP_BELOW_FLOOR, out);
}

cscd_status certified_check_method(const cscd_detector *d, const char *function) {
    if (!d->config.traits->loses_contacts) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "%s: method %s loses contacts and certifies nothing", function,
                        d->config.traits->name);
}

cscd_status max_step_find(cscd_detector *d, const straight_motion *m, cscd_free_step *out) {
    double since = timer_now_ms();
    tries t = {.detector = d, .timings = {.check_ms = d->results.timings.check_ms}};
    cscd_status status = motion_check(d->context, m);
    if (status == CSCD_OK) status = motion_check_still(d->context, m, &d->space.active);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_settle(&waiting, m->x0);
    if (status == CSCD_OK) status = waiting_only_touching(&waiting, m->x0);
    if (status == CSCD_OK) status = solver_reserve_reached(d);
    const step_quest quest = {d->context, d->config.options.step_factor, 1.0, try_motion, &t};
    if (status == CSCD_OK) status = free_step_find(&quest, m, d->reached, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return tries_fail(&t, status);
    step_take(d, d->reached);
    tries_end(&t, since);
    return CSCD_OK;
}

static cscd_status max_step_between(cscd_detector *d, const double *x0, const double *x1,
                                    cscd_free_step *out) {
    double since = timer_now_ms(), check_ms = 0.0;
    cscd_status status = step_check_positions(d, x0, x1);
    if (status != CSCD_OK) return status;
    straight_motion m = {d->mesh, x0, x1, d->reached_scalars};
    timer_lap(&since, &check_ms);
    status = max_step_find(d, &m, out);
    if (status == CSCD_OK) d->results.timings.total_ms += check_ms;
    return status;
}

cscd_status solver_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                            const cscd_mutable_view *reached, cscd_free_step *out) {
    cscd_context *context = detector->context;
    const cscd_mesh *mesh = detector->mesh;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_max_step: out is NULL");
    const double *from = NULL, *to = NULL;
    cscd_free_step step;
    cscd_status status = certified_check_method(detector, "cscd_detector_max_step");
    if (status == CSCD_OK) status = views_read(context, mesh, x0, "x0", &detector->unpacked[0], &from);
    if (status == CSCD_OK) status = views_read(context, mesh, x1, "x1", &detector->unpacked[1], &to);
    if (status == CSCD_OK) status = views_check_mutable(context, mesh, reached, "reached");
    if (status == CSCD_OK && reached == NULL) views_scalars(mesh, x0, detector->reached_scalars);
    if (status == CSCD_OK && reached != NULL) views_mutable_scalars(mesh, reached, detector->reached_scalars);
    if (status == CSCD_OK) status = max_step_between(detector, from, to, &step);
    if (status == CSCD_OK) views_write(mesh, reached, detector->reached);
    if (status == CSCD_OK || status == CSCD_IN_CONTACT) *out = step;
    return status;
}

cscd_status cscd_detector_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                   const cscd_mutable_view *reached, cscd_free_step *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, solver_max_step(detector, x0, x1, reached, out));
}

/* ==== of a line search ===================================================================================== */

struct cscd_line_search {
    reference_count references; /* the caller alone */
    cscd_detector *detector;    /* held, and with it: */
    cscd_context *context;
    double *x0, *x1, *reached; /* positions */
    cscd_scalar *scalars;      /* per object: of positions on the line */

    uint32_t rules_revision; /* of the detector, at the begin */
    uint32_t mesh_revision;  /* of the detector, when the arrays were allocated */
    double reach;
    double separation; /* of the detector, at the begin */
    double covered;    /* all pairs that come within so much more than they have to keep are candidates */
    bool begun;
    double done; /* estimated share of the current step: each try takes half of what is left */
    candidates candidates;
    uint8_t *states;            /* start states of the triangles at x0 */
    bool states_known, vouched; /* as in start_states */
};

/* The motion of the line. */
static straight_motion motion_of(const cscd_line_search *line) {
    return (straight_motion){line->detector->mesh, line->x0, line->x1, line->scalars};
}

/* ---- life ---------------------------------------------------------------------------------------------- */

static array_list list_arrays(cscd_line_search *line) {
    const cscd_mesh *mesh = line->detector->mesh;
    size_t coordinates = (size_t)mesh->vertex_count * 3;
    return (array_list){{ARRAY(line->x0, coordinates), ARRAY(line->x1, coordinates),
                         ARRAY(line->reached, coordinates), ARRAY(line->states, mesh->triangle_count),
                         ARRAY(line->scalars, mesh->object_count)}};
}

static void free_line(reference_count *references) {
    cscd_line_search *line = (cscd_line_search *)references;
    cscd_detector *detector = line->detector;
    cscd_context *context = detector->context;
    candidates_free(context, &line->candidates);
    context_free_all(context, list_arrays(line));
    context_free(context, line);
    detector_release(detector);
    context_release(context);
}

static const char *check_candidates(const candidate_list *list, uint32_t a_count, uint32_t b_count) {
    for (size_t i = 0; i < list->count; i++) {
        if (list->pairs[i][0] >= a_count || list->pairs[i][1] >= b_count)
            return "a candidate of a line search names a feature that there is not";
    }
    return NULL;
}

static const char *validate_listed(const reference_count *object) {
    const cscd_line_search *line = (const cscd_line_search *)object;
    const cscd_mesh *mesh = line->detector->mesh;
    if (line->detector->references.alive != REFERENCE_ALIVE) return "the detector of a line search was freed";
    if (!line->begun || line->mesh_revision != line->detector->mesh_revision) return NULL;
    const candidate_list *lists = line->candidates.lists;
    uint32_t edges = mesh->edge_count + mesh->loose.point_count;
    const char *fault = check_candidates(&lists[CSCD_CONTACT_VF], mesh->vertex_count, mesh->triangle_count);
    return fault != NULL ? fault : check_candidates(&lists[CSCD_CONTACT_EE], edges, edges);
}

static cscd_status create_line(cscd_detector *detector, cscd_line_search **out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_line_search_create: out is NULL");
    cscd_line_search *line = context_allocate(context, 1, sizeof *line);
    if (line == NULL) return context_out_of_memory(context);
    line->detector = detector;
    line->context = context;
    line->mesh_revision = detector->mesh_revision;
    if (!context_allocate_all(context, list_arrays(line))) {
        context_free(context, line);
        return context_out_of_memory(context);
    }
    detector_hold(detector);
    context_add_object(context, &line->references, free_line);
    context_list_object(context, &line->references, validate_listed);
    *out = line;
    return CSCD_OK;
}

cscd_status cscd_line_search_create(cscd_detector *detector, cscd_line_search **out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, create_line(detector, out));
}

void cscd_line_search_destroy(cscd_line_search *line) {
    if (line != NULL) context_destroy_object(line->detector->context, &line->references);
}

/* ---- begin --------------------------------------------------------------------------------------------- */

/* Remembers what the detector knows of the triangles at x0, because it will hold where a step of the
 * line ends. */
static void remember_states(cscd_line_search *line) {
    start_states *s = &line->detector->known.starts;
    line->states_known = config_culls(&line->detector->config) && start_states_hold(s, line->x0);
    line->vouched = s->vouched;
    if (line->states_known) memcpy(line->states, s->triangles, line->detector->mesh->triangle_count);
}

static cscd_status check_reach(cscd_context *context, double reach) {
    if (is_length(reach)) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT,
                        "cscd_line_search_begin: reach is %g, expected 0 or a length from 2^-300 to 2^300",
                        reach);
}

static cscd_status begin_between(cscd_line_search *line, const double *x0, const double *x1, double reach) {
    cscd_detector *d = line->detector;
    uint32_t vertices = d->mesh->vertex_count;
    cscd_status status = positions_check(d->context, x0, vertices, "x0");
    if (status == CSCD_OK) status = positions_check(d->context, x1, vertices, "x1");
    straight_motion m = {d->mesh, x0, x1, line->scalars};
    if (status == CSCD_OK) status = motion_check(d->context, &m);
    if (status == CSCD_OK) status = detector_check_still(d, x0, x1);
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, x0);
    if (status != CSCD_OK) return status;
    line->begun = false;
    line->reach = reach;
    memcpy(line->x0, x0, vertices * sizeof(double[3]));
    memcpy(line->x1, x1, vertices * sizeof(double[3]));
    remember_states(line);
    m = motion_of(line);
    line->separation = d->config.limit.distance;
    double floors = detector_floors_beyond(d, line->separation + reach, line->x0, line->x1);
    line->covered = reach + floors;
    line->rules_revision = d->config.rules_revision;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    const candidate_quest quest = {&d->space, &d->rebuild, config_growth(&d->config), reach,
                                   floors + motion_rounding(&m)};
    status = waiting_settle(&waiting, line->x0);
    if (status == CSCD_OK) status = candidates_collect(&quest, line->x0, line->x1, &line->candidates);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    line->begun = true;
    return CSCD_OK;
}

/* The arrays have the sizes of another mesh, if the detector has moved since. */
static cscd_status follow_mesh(cscd_line_search *line) {
    cscd_detector *d = line->detector;
    if (line->mesh_revision == d->mesh_revision) return CSCD_OK;
    cscd_line_search fresh = {.detector = d};
    if (!context_allocate_all(d->context, list_arrays(&fresh))) return context_out_of_memory(d->context);
    context_free_all(d->context, list_arrays(line));
    line->x0 = fresh.x0;
    line->x1 = fresh.x1;
    line->reached = fresh.reached;
    line->scalars = fresh.scalars;
    line->states = fresh.states;
    line->mesh_revision = d->mesh_revision;
    line->begun = false;
    return CSCD_OK;
}

static cscd_status begin_views(cscd_line_search *line, const cscd_view *x0, const cscd_view *x1,
                               double reach) {
    cscd_detector *d = line->detector;
    const double *from = NULL, *to = NULL;
    cscd_status status = check_reach(d->context, reach);
    if (status == CSCD_OK) status = follow_mesh(line);
    if (status == CSCD_OK) status = views_read(d->context, d->mesh, x0, "x0", &d->unpacked[0], &from);
    if (status == CSCD_OK) status = views_read(d->context, d->mesh, x1, "x1", &d->unpacked[1], &to);
    if (status != CSCD_OK) return status;
    line->begun = false;
    views_scalars(d->mesh, x0, line->scalars);
    return begin_between(line, from, to, reach);
}

cscd_status cscd_line_search_begin(cscd_line_search *line, const cscd_view *x0, const cscd_view *x1,
                                   double reach) {
    if (line == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(line, &entry)) return entry.status;
    return context_leave(&entry, begin_views(line, x0, x1, reach));
}

static cscd_status check_begun(const cscd_line_search *line, const char *function) {
    if (line->begun && line->mesh_revision == line->detector->mesh_revision) return CSCD_OK;
    if (line->begun)
        return context_fail(line->detector->context, CSCD_INVALID_ARGUMENT,
                            "%s: the detector has moved to another mesh since the line was begun; call "
                            "cscd_line_search_begin again",
                            function);
    return context_fail(line->detector->context, CSCD_INVALID_ARGUMENT,
                        "%s: the line has no motion; call cscd_line_search_begin first", function);
}

size_t cscd_line_search_candidate_count(const cscd_line_search *line) {
    const candidate_list *lists = line->candidates.lists;
    bool current = line->mesh_revision == line->detector->mesh_revision;
    return line->begun && current ? lists[CSCD_CONTACT_VF].count + lists[CSCD_CONTACT_EE].count : 0;
}

/* Were the candidates collected for what is looked at now? */
static cscd_status check_rules(const cscd_line_search *line, const char *function) {
    if (line->rules_revision == line->detector->config.rules_revision) return CSCD_OK;
    return context_fail(line->detector->context, CSCD_INVALID_ARGUMENT,
                        "%s: the rules of objects or the active vertices have been set since the line was "
                        "begun; call cscd_line_search_begin again",
                        function);
}

/* Are all pairs candidates that come within so much more than they have to keep now? cscd_detector_set_separation may have
 * been called since the line began; the separation is added to what was covered beyond the one then. */
static bool more_covered(const cscd_line_search *line, double more) {
    double grown = max_of(line->detector->config.limit.distance - line->separation, 0.0);
    return grown + more <= line->covered;
}

/* ---- the list of candidates ---------------------------------------------------------------------------- */

/* The pair of a kind that a candidate is, as a in the upper half and b in the lower one. False: it is of another kind. Points
 * are edges behind all others, and the second ones of a pair. */
static bool name_candidate(const cscd_mesh *mesh, cscd_contact_kind kind, const uint32_t pair[2],
                           uint64_t *out) {
    uint32_t a = pair[0], b = pair[1];
    if (kind != CSCD_CONTACT_VF) {
        const bool points = edge_is_point(mesh, a), point = edge_is_point(mesh, b);
        if ((kind == CSCD_CONTACT_VV) != points || (kind == CSCD_CONTACT_EE) == point) return false;
        if (points) a = mesh->edges[a][0];
        if (point) b = mesh->edges[b][0];
    }
    if (a > b && (kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_VV)) {
        const uint32_t kept = a;
        a = b;
        b = kept;
    }
    *out = (uint64_t)a << 32 | b;
    return true;
}

/* Appends the candidates of one kind, each once, without those that are left out. */
static size_t list_candidates(const cscd_line_search *line, cscd_contact_kind kind, size_t count) {
    cscd_detector *d = line->detector;
    const candidate_list *list =
        &line->candidates.lists[kind == CSCD_CONTACT_VF ? CSCD_CONTACT_VF : CSCD_CONTACT_EE];
    uint64_t *keys = d->results.candidates.keys;
    cscd_candidate *items = d->results.candidates.items;
    size_t found = 0;
    for (size_t i = 0; i < list->count; i++)
        found += name_candidate(d->mesh, kind, list->pairs[i], &keys[found]);
    sort_by_number(keys, d->results.candidates.spare_keys, found, sizeof *keys);
    for (size_t i = 0; i < found; i++) {
        const uint32_t a = (uint32_t)(keys[i] >> 32), b = (uint32_t)keys[i];
        if (i > 0 && keys[i] == keys[i - 1]) continue;
        if (exclusions_cover(&d->config.exclusions, kind, a, b, NULL)) continue;
        items[count++] = (cscd_candidate){kind, a, b};
    }
    return count;
}

static cscd_status give_candidates(cscd_line_search *line, cscd_candidates *out) {
    static const cscd_contact_kind kinds[] = {CSCD_CONTACT_VF, CSCD_CONTACT_EE, CSCD_CONTACT_VV,
                                              CSCD_CONTACT_EV};
    cscd_detector *d = line->detector;
    cscd_status status = check_begun(line, "cscd_line_search_candidates");
    if (status == CSCD_OK) status = check_rules(line, "cscd_line_search_candidates");
    if (status != CSCD_OK) return status;
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_line_search_candidates: out is NULL");
    status = result_buffer_reserve(d->context, &d->results.candidates, cscd_line_search_candidate_count(line),
                                   sizeof(cscd_candidate), sizeof(uint64_t));
    if (status != CSCD_OK) return context_out_of_memory(d->context);
    size_t count = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) count = list_candidates(line, kinds[i], count);
    *out = (cscd_candidates){d->results.candidates.items, count};
    return CSCD_OK;
}

cscd_status cscd_line_search_candidates(cscd_line_search *line, cscd_candidates *out) {
    if (line == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(line, &entry)) return entry.status;
    return context_leave(&entry, give_candidates(line, out));
}

/* ---- moments ------------------------------------------------------------------------------------------- */

static cscd_status check_fraction(const cscd_line_search *line, double fraction, const char *function) {
    if (fraction >= 0.0 && fraction <= 1.0) return check_begun(line, function);
    return context_fail(line->detector->context, CSCD_INVALID_ARGUMENT,
                        "%s: fraction is %g, expected a number in [0,1]", function, fraction);
}

/* The motion with the scalars in which its positions are asked for. Candidates that were collected for doubles do not do
 * for floats. */
static cscd_status motion_in(const cscd_line_search *line, const cscd_mutable_view *asked,
                             const char *function, straight_motion *out) {
    cscd_detector *d = line->detector;
    *out = motion_of(line);
    if (asked == NULL) return CSCD_OK;
    views_mutable_scalars(d->mesh, asked, d->reached_scalars);
    out->scalars = d->reached_scalars;
    for (uint32_t o = 0; o < d->mesh->object_count; o++) {
        if (d->reached_scalars[o] != CSCD_SCALAR_FLOAT || line->scalars[o] == CSCD_SCALAR_FLOAT) continue;
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "%s: object %u is asked for in floats, but the line was begun with x0 in doubles",
                            function, o);
    }
    return CSCD_OK;
}

static cscd_status write_positions(cscd_line_search *line, double fraction,
                                   const cscd_mutable_view *positions) {
    cscd_detector *d = line->detector;
    cscd_status status = check_fraction(line, fraction, "cscd_line_search_positions");
    if (status == CSCD_OK && positions == NULL)
        status =
            context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_line_search_positions: positions is NULL");
    if (status == CSCD_OK) status = views_check_mutable(d->context, d->mesh, positions, "positions");
    straight_motion m;
    if (status == CSCD_OK) status = motion_in(line, positions, "cscd_line_search_positions", &m);
    if (status != CSCD_OK) return status;
    motion_at(&m, fraction, line->reached);
    views_write(d->mesh, positions, line->reached);
    return CSCD_OK;
}

cscd_status cscd_line_search_positions(cscd_line_search *line, double fraction,
                                       const cscd_mutable_view *positions) {
    if (line == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(line, &entry)) return entry.status;
    return context_leave(&entry, write_positions(line, fraction, positions));
}

static cscd_status find_near_on_line(cscd_line_search *line, double fraction, double distance,
                                     cscd_near_form form, cscd_proximities *out) {
    cscd_detector *d = line->detector;
    cscd_status status = check_fraction(line, fraction, "cscd_line_search_find_near");
    if (status == CSCD_OK) status = check_rules(line, "cscd_line_search_find_near");
    if (status == CSCD_OK) status = proximity_check_form(d->context, form);
    if (status == CSCD_OK) status = proximity_check_distance(d, distance, form);
    if (status != CSCD_OK) return status;
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_line_search_find_near: out is NULL");
    if (distance > line->reach)
        return context_fail(
            d->context, CSCD_INVALID_ARGUMENT,
            "cscd_line_search_find_near: distance is %g, but the line was begun with a reach of %g", distance,
            line->reach);
    if ((form & CSCD_NEAR_BEYOND) != 0 && !more_covered(line, distance))
        return context_fail(
            d->context, CSCD_INVALID_ARGUMENT,
            "cscd_line_search_find_near: min_separation is %g since the line was begun, and its "
            "candidates reach to %g only; call cscd_line_search_begin again",
            d->config.limit.distance, line->separation + line->covered);
    detector_begin_call(d);
    straight_motion m = motion_of(line);
    motion_at(&m, fraction, line->reached);
    cscd_proximities found;
    const waiting_place waiting = detector_waiting_place(d);
    status = waiting_look(&waiting, line->x0);
    interval_search search = proximity_search(d, line->reached, distance, form);
    if (status == CSCD_OK) status = candidates_test(&line->candidates, &search);
    if (status == CSCD_OK) status = proximity_collect(d, line->reached, form, &found);
    if (status == CSCD_LIST_TOO_LONG) *out = found;
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    *out = found;
    return CSCD_OK;
}

cscd_status cscd_line_search_find_near(cscd_line_search *line, double fraction, double distance,
                                       cscd_near_form form, cscd_proximities *out) {
    if (line == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(line, &entry)) return entry.status;
    return context_leave(&entry, find_near_on_line(line, fraction, distance, form, out));
}

/* ---- steps --------------------------------------------------------------------------------------------- */

static cscd_status test_candidates_on_motion(void *of, const double *from, const double *to,
                                             cscd_contacts *out) {
    cscd_line_search *line = of;
    cscd_detector *d = line->detector;
    cscd_counters counters = {.vf = 0};
    progress_part(&d->context->progress, line->done, 0.5 + 0.5 * line->done);
    line->done = 0.5 + 0.5 * line->done;
    interval_search search = detector_search_floors(d, from, to);
    cscd_status status = candidates_test(&line->candidates, &search);
    return status == CSCD_OK
               ? contact_list_collect(&d->space, &d->config.exclusions, &d->results.contacts, &counters, out)
               : status;
}

/* Without any contact, contacts that the caller ignores included, the states of triangles are what they were. */
static void carry_states_over(cscd_line_search *line) {
    cscd_detector *d = line->detector;
    if (!line->states_known || !config_culls(&d->config) || search_space_found_any(&d->space)) return;
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->interval.incomplete[c] = false;
    memcpy(d->known.starts.triangles, line->states, d->mesh->triangle_count);
    d->known.starts.vouched |= line->vouched;
    d->known.starts.counted = false;
    start_states_count(&d->known.starts);
    start_states_end(&d->known.starts, line->reached, d->interval.incomplete);
}

/* Do the candidates still cover the separation? cscd_detector_set_separation may have been called since the line
 * began. */
static cscd_status check_covered(const cscd_line_search *line) {
    const cscd_detector *d = line->detector;
    if (more_covered(line, detector_floors_beyond(d, d->config.limit.distance, line->x0, line->x1)))
        return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "cscd_line_search_max_step: min_separation is %g since the line was begun, and its "
                        "candidates reach to %g only; call cscd_line_search_begin again",
                        d->config.limit.distance, line->separation + line->covered);
}

static cscd_status max_step_on_line(cscd_line_search *line, double longest, const cscd_mutable_view *reached,
                                    cscd_free_step *out) {
    cscd_detector *d = line->detector;
    cscd_status status = check_begun(line, "cscd_line_search_max_step");
    if (status == CSCD_OK) status = check_rules(line, "cscd_line_search_max_step");
    if (status == CSCD_OK) status = check_covered(line);
    if (status == CSCD_OK) status = views_check_mutable(d->context, d->mesh, reached, "reached");
    straight_motion m;
    if (status == CSCD_OK) status = motion_in(line, reached, "cscd_line_search_max_step", &m);
    if (status != CSCD_OK) return status;
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_line_search_max_step: out is NULL");
    if (!(longest > 0.0 && longest <= 1.0))
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_line_search_max_step: longest is %g, expected a number in (0,1]", longest);
    detector_begin_call(d);
    line->done = 0.0;
    cscd_free_step step;
    const waiting_place waiting = detector_waiting_place(d);
    const step_quest quest = {d->context, d->config.options.step_factor, longest, test_candidates_on_motion,
                              line};
    status = waiting_look(&waiting, line->x0);
    if (status == CSCD_OK) status = waiting_only_touching(&waiting, line->x0);
    if (status == CSCD_OK) status = free_step_find(&quest, &m, line->reached, &step);
    if (status == CSCD_IN_CONTACT) *out = step;
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    carry_states_over(line);
    views_write(d->mesh, reached, line->reached);
    *out = step;
    return CSCD_OK;
}

cscd_status cscd_line_search_max_step(cscd_line_search *line, double longest,
                                      const cscd_mutable_view *reached, cscd_free_step *out) {
    if (line == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(line, &entry)) return entry.status;
    return context_leave(&entry, max_step_on_line(line, longest, reached, out));
}
