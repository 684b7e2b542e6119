/* Untangling of the public API: checks, starts that are tried in turn, and what is promised of the result. */
#include "runtime/untangle/untangle.h"

#include "runtime/untangle/lenses.h"
#include "src/core/least_sizes.h"
#include "src/core/timer.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <math.h>
#include <string.h>

/* ---- options ------------------------------------------------------------------------------------------- */

static const cscd_untangle_options default_options = {.struct_size = sizeof default_options,
                                                      .max_rounds = 60,
                                                      .max_steps = 40,
                                                      .max_seconds = (double)INFINITY};

void cscd_untangle_defaults_sized(cscd_untangle_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static cscd_status take_options(const cscd_mesh *mesh, cscd_context *context,
                                const cscd_untangle_options *options, cscd_untangle_options *out) {
    *out = default_options;
    if (options == NULL) return CSCD_OK;
    cscd_status status = struct_take_options(context, out, sizeof *out, LEAST_SIZE(cscd_untangle_options),
                                             options, "cscd_untangle_defaults");
    if (status != CSCD_OK) return status;
    for (uint32_t v = 0; out->weights != NULL && v < mesh->vertex_count; v++) {
        if (!(out->weights[v] > 0.0))
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "weights[%u] is %g; a weight is above 0, and INFINITY pins the vertex", v,
                                out->weights[v]);
    }
    if (!(out->steady >= 0.0 && out->steady < 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "steady is %g; it is 0 or more, and below 1",
                            out->steady);
    if (!(out->spread >= 0.0 && out->spread < (double)INFINITY))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "spread is %g; it is a length, or 0",
                            out->spread);
    if (!(out->bending >= 0.0 && out->bending < (double)INFINITY))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "bending is %g; it is a length, or 0",
                            out->bending);
    if (!(out->max_seconds >= 0.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT, "max_seconds is %g; it is 0 or more",
                            out->max_seconds);
    if (out->start_input != NULL && out->start == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "start_input is given, and start is not");
    return CSCD_OK;
}

/* ---- what stages share ----------------------------------------------------------------------------------- */

void work_say(untangle_work *w, const char *stage, double share) {
    progress_hold(&w->context->progress, stage, w->stage_begin + share * (w->stage_end - w->stage_begin));
}

bool work_goes_on(untangle_work *w) {
    if (!w->stopped) w->stopped = !progress_go_on(&w->context->progress, 0.0) || timer_now_ms() > w->until_ms;
    return !w->stopped;
}

cscd_status work_settle(untangle_work *w, cscd_status status) {
    if (status != CSCD_CANCELLED) return status;
    w->stopped = true;
    return CSCD_OK;
}

/* 0x1p-300 is the least magnitude. */
static const double least_magnitude = 0x1p-290, greatest_magnitude = 0x1p300;

void work_flush(const untangle_work *w, double *x) {
    const size_t n = 3 * (size_t)w->mesh->vertex_count;
    for (size_t i = 0; i < n; i++) {
        if (fabs(x[i]) < least_magnitude && !w->graph.fixed[i / 3]) x[i] = 0.0;
    }
}

bool work_in_range(const untangle_work *w, const double *x) {
    const size_t n = 3 * (size_t)w->mesh->vertex_count;
    for (size_t i = 0; i < n; i++) {
        if (!(fabs(x[i]) <= greatest_magnitude)) return false;
    }
    return true;
}

/* Pairs that are nearer than they have to keep: a list of what is at most a hair farther. */
static cscd_status count_near(untangle_work *w, const double *x, size_t *near) {
    const double kept = config_greatest_separation(&w->detector->config);
    cscd_proximities pairs;
    *near = 0;
    if (!(kept > 0.0)) return CSCD_OK;
    cscd_status status = solver_find_near(w->detector, WORK_VIEW(w, x), max_of(1e-6 * kept, least_length),
                                          CSCD_NEAR_PAIRS | CSCD_NEAR_BEYOND, &pairs);
    if (status != CSCD_OK) return status;
    for (size_t i = 0; i < pairs.count; i++) *near += pairs.items[i].distance < pairs.items[i].separation;
    return CSCD_OK;
}

cscd_status work_count(untangle_work *w, const double *x, tangle_count *out) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = CSCD_ANSWER_COUNT;
    cscd_status status = detector_find_intersections(w->detector, WORK_VIEW(w, x), &options, &found);
    if (status == CSCD_OK) status = count_near(w, x, &out->near);
    out->pairs = status == CSCD_OK ? found.count : SIZE_MAX;
    return status;
}

/* ---- results ------------------------------------------------------------------------------------------- */

/* The best positions so far, as they will be stored. */
typedef struct best_result {
    double *x;
    double *stored;             /* of those at hand */
    const cscd_scalar *scalars; /* per object; NULL: doubles */
    tangle_count count;
    double displacement; /* the greatest */
    bool rough;          /* clean, and no descent has made displacements smooth */
} best_result;

static bool is_clean(tangle_count a) {
    return a.pairs == 0 && a.near == 0;
}

/* Clean results are compared by how far they move; others by their pairs. */
static bool is_better(const best_result *best, tangle_count count, double displacement) {
    if (is_clean(count) && is_clean(best->count)) return best->rough || displacement < best->displacement;
    return count.pairs != best->count.pairs ? count.pairs < best->count.pairs : count.near < best->count.near;
}

static double greatest_displacement(const untangle_work *w, const double *x, const double *from) {
    double squared = 0.0;
    for (size_t v = 0; v < w->mesh->vertex_count; v++)
        squared = max_of(squared, vec3_squared_distance(x + 3 * v, from + 3 * v));
    return sqrt(squared);
}

/* Where a seam joins floats and doubles, what is at one place stays there: as floats. */
static void round_seams(const untangle_work *w, const best_result *best, const double *x) {
    const uint32_t *names = w->graph.names;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
            const size_t at = 3 * (size_t)v, name = 3 * (size_t)names[v];
            if (names[v] == v || w->graph.fixed[v]) continue;
            const bool is_float = best->scalars[cscd_mesh_vertex_object(w->mesh, v)] == CSCD_SCALAR_FLOAT;
            if (memcmp(x + at, x + name, sizeof(double[3])) != 0 || (pass == 0 && !is_float)) continue;
            if (pass == 0)
                memcpy(best->stored + name, best->stored + at, sizeof(double[3]));
            else
                memcpy(best->stored + at, best->stored + name, sizeof(double[3]));
        }
    }
}

/* Rounds positions as they will be stored. Vertices that are fixed are the input, bit for bit. */
static void round_positions(const untangle_work *w, const best_result *best, const double *x) {
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const uint32_t object = cscd_mesh_vertex_object(w->mesh, v);
        const cscd_scalar scalar = best->scalars != NULL ? best->scalars[object] : CSCD_SCALAR_DOUBLE;
        for (size_t k = 3 * (size_t)v; k < 3 * (size_t)v + 3; k++) {
            const bool kept = w->graph.fixed[v] || scalar == CSCD_SCALAR_DOUBLE;
            best->stored[k] = kept ? x[k] : stored_coordinate(x[k], scalar);
        }
    }
    if (best->scalars != NULL) round_seams(w, best, x);
    for (size_t k = 0; k < 3 * (size_t)w->mesh->vertex_count; k++) {
        if (best->stored[k] == w->input[k]) best->stored[k] = w->input[k]; /* with the sign of 0 */
    }
}

/* Has every vertex that is fixed come to where it is in the input, but for signs of 0? */
static bool fixed_arrived(const untangle_work *w, const double *x) {
    for (size_t v = 0; v < w->mesh->vertex_count; v++) {
        for (size_t k = 3 * v; k < 3 * v + 3; k++) {
            if (w->graph.fixed[v] && x[k] != w->input[k]) return false;
        }
    }
    return true;
}

/* Keeps positions if they are better than what there is. */
static cscd_status offer_positions(untangle_work *w, best_result *best, const double *x,
                                   cscd_untangle_start start, bool rough) {
    tangle_count count;
    if (!fixed_arrived(w, x)) return CSCD_OK;
    round_positions(w, best, x);
    const double displacement = greatest_displacement(w, best->stored, w->input);
    cscd_status status = work_count(w, best->stored, &count);
    if (status != CSCD_OK || (rough && is_clean(best->count)) || !is_better(best, count, displacement))
        return status;
    best->count = count;
    best->displacement = displacement;
    best->rough = rough;
    memcpy(best->x, best->stored, 3 * (size_t)w->mesh->vertex_count * sizeof *best->x);
    w->found.start = start;
    return CSCD_OK;
}

/* A clean result that moves vertices no farther than this, in thicknesses, is good enough; half is the least possible. */
static const double good_displacement = 1.1;

/* Lenses that are thinner than this, in edge lengths, say nothing of how far vertices must move. */
static const double thin_lens = 1.0;

static bool is_good(const untangle_work *w, const best_result *best) {
    const double thickness = max_of(w->found.thickness, thin_lens * w->graph.edge_length);
    return is_clean(best->count) && !best->rough && best->displacement <= good_displacement * thickness;
}

/* ---- starts -------------------------------------------------------------------------------------------- */

/* How displacements are spread where the caller does not say. */
static double spread_of(const untangle_work *w, const double *x) {
    if (w->options.spread > 0.0) return w->options.spread;
    const double thickness =
        w->found.thickness > 0.0 ? w->found.thickness : 2.0 * greatest_displacement(w, x, w->goal);
    return max_of(2.0 * thickness, 3.0 * w->graph.edge_length);
}

enum { HEALINGS = 60 };

/* Lets pairs part that are nearer than they have to keep, but do not touch. */
static cscd_status heal_gaps(untangle_work *w, double *x) {
    tangle_count count;
    bool moved = true; /* what has not moved once will not move again */
    cscd_status status = work_count(w, x, &count);
    for (int i = 0; i < HEALINGS && moved && work_goes_on(w); i++) {
        if (status != CSCD_OK || count.pairs > 0 || count.near == 0) break;
        status = approach_once(w, x, x, &moved);
        if (status == CSCD_OK) status = work_count(w, x, &count);
    }
    return status;
}

/* From positions that do not intersect to the result. far: they may be anywhere. */
static cscd_status refine_start(untangle_work *w, best_result *best, double *x, bool far,
                                cscd_untangle_start start) {
    cscd_status status = heal_gaps(w, x);
    if (status == CSCD_OK && (far || !fixed_arrived(w, x))) status = approach_goal(w, x);
    if (status == CSCD_OK) status = offer_positions(w, best, x, start, true);
    if (status == CSCD_OK) status = descent_run(w, spread_of(w, x), x);
    return status == CSCD_OK ? offer_positions(w, best, x, start, false) : status;
}

/* Writes the input plus a share of the displacement of the start. */
static void carry_displacement(untangle_work *w, const double *start, const double *start_input, double share,
                               double *out) {
    const size_t n = w->mesh->vertex_count;
    for (size_t v = 0; v < n; v++) {
        for (size_t k = 3 * v; k < 3 * v + 3; k++)
            out[k] = w->graph.fixed[v] ? w->input[k] : w->input[k] + share * (start[k] - start_input[k]);
    }
    work_flush(w, out);
}

/* Surfaces that touched in the start probably touch again, with the same displacements. */
static cscd_status follow_start(untangle_work *w, double *x, double *start_input) {
    carry_displacement(w, x, start_input, w->options.steady, w->goal);
    carry_displacement(w, x, start_input, 1.0, start_input);
    if (!work_in_range(w, w->goal) || !work_in_range(w, start_input)) {
        memcpy(w->goal, w->input, 3 * (size_t)w->mesh->vertex_count * sizeof *w->goal);
        return CSCD_OK;
    }
    bool moved;
    return work_settle(w, approach_once(w, x, start_input, &moved));
}

static cscd_status read_start(untangle_work *w, double *x, double *start_input, bool *carried) {
    double *unpacked = NULL;
    const double *from = NULL;
    const size_t size = 3 * (size_t)w->mesh->vertex_count * sizeof *x;
    cscd_status status = views_read(w->context, w->mesh, w->options.start, "start", &unpacked, &from);
    if (status == CSCD_OK) memcpy(x, from, size);
    *carried = w->options.start_input != NULL;
    if (status == CSCD_OK && *carried)
        status = views_read(w->context, w->mesh, w->options.start_input, "start_input", &unpacked, &from);
    if (status == CSCD_OK && *carried) memcpy(start_input, from, size);
    context_free(w->context, unpacked);
    return status;
}

/* Motions leave vertices that are not active where they are: is each of them in the start where it is in the input? */
static bool inactive_stayed(const untangle_work *w, const double *x) {
    const bool *active = w->detector->space.active.vertices;
    for (size_t v = 0; active != NULL && v < w->mesh->vertex_count; v++) {
        for (size_t k = 3 * v; k < 3 * v + 3; k++) {
            if (!active[v] && x[k] != w->input[k]) return false;
        }
    }
    return true;
}

static cscd_status try_given(untangle_work *w, best_result *best, double *x, double *scratch) {
    tangle_count count;
    bool carried = false;
    cscd_status status = read_start(w, x, scratch, &carried);
    if (status == CSCD_OK) status = work_count(w, x, &count);
    if (status != CSCD_OK) return status;
    if (!is_clean(count))
        return context_fail(
            w->context, CSCD_INVALID_ARGUMENT,
            "start is not clean: %zu pairs of triangles intersect, and %zu pairs of features are too near",
            count.pairs, count.near);
    if (!inactive_stayed(w, x)) return CSCD_OK; /* no way leads from there */
    if (carried) status = follow_start(w, x, scratch);
    if (status == CSCD_OK) status = refine_start(w, best, x, !carried, CSCD_UNTANGLE_GIVEN);
    if (status != CSCD_OK || is_clean(best->count)) return status;
    status = read_start(w, x, scratch, &carried); /* rounding may cost a result what the start has */
    return status == CSCD_OK ? offer_positions(w, best, x, CSCD_UNTANGLE_GIVEN, true) : status;
}

static cscd_status try_shrinking(untangle_work *w, best_result *best, double *x) {
    bool clean;
    cscd_status status = shrink_apart(w, x, &clean);
    if (status == CSCD_OK && clean) status = refine_start(w, best, x, true, CSCD_UNTANGLE_SHRUNK);
    return status;
}

static cscd_status try_pushing(untangle_work *w, best_result *best, const push_rules *rules, double *x) {
    size_t left;
    memcpy(x, w->input, 3 * (size_t)w->mesh->vertex_count * sizeof *x);
    cscd_status status = push_out(w, rules, x, &left);
    if (status != CSCD_OK) return status;
    return left > 0 ? offer_positions(w, best, x, CSCD_UNTANGLE_PUSHED, true)
                    : refine_start(w, best, x, false, CSCD_UNTANGLE_PUSHED);
}

/* What is tried in turn, until a result is good. Over-separation and stiffness help where curves bound no vertex; a descent takes
 * back what they add. Bodies on a skewer come apart only when they are shrunk. */
static cscd_status try_starts(untangle_work *w, best_result *best, double *x) {
    static const push_rules pushes[] = {{30.0, 0.02, 2.0, false},
                                        {300.0, 0.6, 3.0, true},
                                        {1000.0, 0.3, 2.0, true},
                                        {1000.0, 1.0, 3.0, true}};
    enum { SHRINKING = 2, STARTS = 5 };
    for (int i = 0; i < STARTS && work_goes_on(w); i++) {
        w->stage_begin = (double)i / STARTS;
        w->stage_end = (double)(i + 1) / STARTS;
        cscd_status status = i == SHRINKING ? try_shrinking(w, best, x)
                                            : try_pushing(w, best, &pushes[i < SHRINKING ? i : i - 1], x);
        if (status != CSCD_OK || is_good(w, best)) return status;
    }
    return CSCD_OK;
}

/* ---- vertices that hardly move ---------------------------------------------------------------------------- */

/* Displacements below this share of an edge, and of the greatest one, are taken back where this leaves the result clean. */
static const double slight_of_edge = 1e-3, slight_of_greatest = 1e-2;

/* Writes the result, but vertices that moved by less than this to where they were. Those of a seam move together. */
static void take_back(const untangle_work *w, const best_result *best, double slight, double *x) {
    const uint32_t *names = w->graph.names;
    const double *input = w->input;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const size_t at = 3 * (size_t)v, name = 3 * (size_t)names[v];
        const double squared = vec3_squared_distance(best->x + name, input + name);
        memcpy(x + at, (squared < slight * slight ? input : best->x) + at, sizeof(double[3]));
    }
}

/* What an elastic energy moves by a hair, far from all that intersects, stays bit for bit. */
static cscd_status keep_far_vertices(untangle_work *w, best_result *best, double *x) {
    tangle_count count;
    double slight = min_of(slight_of_edge * w->graph.edge_length, slight_of_greatest * best->displacement);
    cscd_status status = CSCD_OK;
    for (int i = 0; i < 2 && status == CSCD_OK && is_clean(best->count) && slight > 0.0; i++) {
        take_back(w, best, slight, x);
        status = work_count(w, x, &count);
        if (status == CSCD_OK && is_clean(count)) {
            memcpy(best->x, x, 3 * (size_t)w->mesh->vertex_count * sizeof *x);
            break;
        }
        slight *= 0.1;
    }
    return status;
}

/* ---- the call ------------------------------------------------------------------------------------------ */

static cscd_status measure_thickness(untangle_work *w, const cscd_intersections *found) {
    lens_finder lenses;
    const lens_rules rules = {.rings = 2};
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (found->left_out != 0) return CSCD_OK;
    if (lens_finder_make(&lenses, w)) status = lenses_find(&lenses, found, w->input, &rules);
    w->found.thickness = lenses.thickness;
    lens_finder_free(&lenses);
    return status;
}

/* Looks at the input. */
static cscd_status look_at_input(untangle_work *w, best_result *best) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.curves = options.patches = true;
    cscd_status status = detector_find_intersections(w->detector, WORK_VIEW(w, w->input), &options, &found);
    if (status != CSCD_OK) return status;
    best->count.pairs = w->found.pairs_before = found.count;
    status = found.count > 0 ? measure_thickness(w, &found) : CSCD_OK;
    if (status == CSCD_OK && w->rest != NULL)
        status = rest_shape_pull(w, w->rest, &found, spread_of(w, w->input));
    if (status == CSCD_OK) status = count_near(w, w->input, &best->count.near);
    w->found.near_before = best->count.near;
    return status;
}

static bool any_moves(const untangle_work *w) {
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        if (!w->graph.fixed[v]) return true;
    }
    return false;
}

static cscd_status search_result(untangle_work *w, best_result *best, double *x, double *scratch) {
    cscd_status status;
    if (is_clean(best->count) || !any_moves(w)) return CSCD_OK;
    if (w->options.start != NULL) {
        status = try_given(w, best, x, scratch);
        if (status != CSCD_OK || is_clean(best->count)) return status;
        memcpy(w->goal, w->input, 3 * (size_t)w->mesh->vertex_count * sizeof *w->goal);
    }
    if (w->found.pairs_before > 0) return try_starts(w, best, x);
    memcpy(x, w->input, 3 * (size_t)w->mesh->vertex_count * sizeof *x); /* some pairs are too near, no more */
    return refine_start(w, best, x, false, CSCD_UNTANGLE_PUSHED);
}

static void sum_up(untangle_work *w, const best_result *best) {
    cscd_untangled *out = &w->found;
    double sum = 0.0;
    out->pairs_after = best->count.pairs;
    out->near_after = best->count.near;
    out->clean = is_clean(best->count);
    out->stopped = w->stopped;
    out->farthest = UINT32_MAX;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const double *from = w->input + 3 * (size_t)v, *to = best->x + 3 * (size_t)v;
        if (memcmp(from, to, sizeof(double[3])) == 0) continue;
        const double way = sqrt(vec3_squared_distance(from, to));
        out->moved = true;
        out->moved_vertices++;
        sum += way;
        if (out->farthest == UINT32_MAX || way > out->displacement) {
            out->farthest = v;
            out->displacement = way;
        }
    }
    if (out->moved_vertices > 0) out->mean_displacement = sum / out->moved_vertices;
}

static array_list work_arrays(untangle_work *w, best_result *best, double **x, double **scratch) {
    const size_t n = 3 * (size_t)w->mesh->vertex_count;
    return (array_list){{ARRAY(w->goal, n), ARRAY(w->right_side, n), ARRAY(best->x, n),
                         ARRAY(best->stored, n), ARRAY(*x, n), ARRAY(*scratch, n),
                         ARRAY(w->inverse_masses, n), ARRAY(w->reached, n)}};
}

static cscd_status run_work(untangle_work *w, best_result *best, double *x, double *scratch) {
    const cscd_detector *d = w->detector;
    const size_t size = 3 * (size_t)w->mesh->vertex_count * sizeof *x;
    cscd_status status = CSCD_OK;
    memcpy(w->goal, w->input, size);
    memcpy(best->x, w->input, size);
    if (w->options.rest != NULL)
        status = views_read(w->context, w->mesh, w->options.rest, "rest", &w->unpacked_rest, &w->rest);
    const graph_source source = {w->input, w->rest, d->config.exclusions.names, w->options.weights,
                                 d->space.active.vertices};
    if (status == CSCD_OK) status = vertex_graph_make(&w->graph, w->context, w->mesh, &source);
    for (uint32_t v = 0; status == CSCD_OK && v < w->mesh->vertex_count; v++)
        w->inverse_masses[v] = w->graph.fixed[v] ? 0.0 : 1.0;
    if (status == CSCD_OK && !vertex_region_make(&w->region, &w->graph)) status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = energy_create(w->context, w->mesh, &w->energy);
    if (status == CSCD_OK) status = look_at_input(w, best);
    if (status == CSCD_OK) status = work_settle(w, search_result(w, best, x, scratch));
    if (status == CSCD_OK && w->found.pairs_before + w->found.near_before > 0)
        status = work_settle(w, keep_far_vertices(w, best, x));
    if (status == CSCD_OK) sum_up(w, best);
    return status;
}

static cscd_status untangle_positions(untangle_work *w, const cscd_mutable_view *reached,
                                      const cscd_scalar *scalars, cscd_untangled *out) {
    best_result best = {.scalars = scalars};
    double *x = NULL, *scratch = NULL;
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (context_allocate_all(w->context, work_arrays(w, &best, &x, &scratch)))
        status = run_work(w, &best, x, scratch);
    if (status == CSCD_OK) {
        (void)context_progress_status(w->context); /* the sentence that says who stopped it */
        views_write(w->mesh, reached, best.x);
        *out = w->found;
    }
    context_free_all(w->context, work_arrays(w, &best, &x, &scratch));
    vertex_graph_free(&w->graph);
    vertex_region_free(&w->region, w->context);
    block_system_free(&w->system);
    context_free(w->context, w->pulls);
    context_free(w->context, w->unpacked_rest);
    if (w->energy != NULL) cscd_energy_destroy(w->energy);
    return status == CSCD_OK ? CSCD_OK : context_explain(w->context, status);
}

static cscd_status untangle_views(cscd_detector *d, const cscd_view *positions,
                                  const cscd_untangle_options *options, const cscd_mutable_view *reached,
                                  cscd_untangled *out) {
    static const char function[] = "cscd_detector_untangle";
    cscd_context *context = d->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: out is NULL", function);
    untangle_work work = {.detector = d, .context = context, .mesh = d->mesh, .system = {.context = context}};
    const cscd_scalar *scalars = NULL;
    cscd_scalar *kept = NULL;
    const double started = timer_now_ms();
    cscd_status status = certified_check_method(d, function);
    if (status == CSCD_OK) status = take_options(d->mesh, context, options, &work.options);
    if (status == CSCD_OK)
        status = views_read(context, d->mesh, positions, "positions", &d->unpacked[0], &work.input);
    if (status == CSCD_OK) status = views_check_mutable(context, d->mesh, reached, "reached");
    if (status == CSCD_OK) status = truncation_scalars(d, function, positions, reached, &scalars);
    if (status != CSCD_OK) return status;
    work.until_ms = started + 1e3 * work.options.max_seconds;
    if (scalars != NULL) { /* calls within this one use the detector's */
        kept = context_reserve(context, d->mesh->object_count, sizeof *kept);
        if (kept == NULL) return context_out_of_memory(context);
        memcpy(kept, scalars, d->mesh->object_count * sizeof *kept);
    }
    progress_begin(&context->progress);
    work.stage_end = 1.0;
    work_say(&work, "looking", 0.0);
    status = untangle_positions(&work, reached, kept, out);
    progress_let_go(&context->progress);
    context_free(context, kept);
    return status;
}

cscd_status cscd_detector_untangle(cscd_detector *detector, const cscd_view *positions,
                                   const cscd_untangle_options *options, const cscd_mutable_view *reached,
                                   cscd_untangled *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, untangle_views(detector, positions, options, reached, out));
}
