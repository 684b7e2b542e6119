/* Finds how far vertices may go from where they are: on any path, before two features can come together, and on straight lines, up to
 * planes between near pairs. */
#include "runtime/solver/near_pairs.h"
#include "runtime/solver/solver.h"
#include "src/core/floating.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <string.h>

/* ==== near pairs =========================================================================================== */

/* Pairs are looked for so much farther away than they need to, which covers the rounding of the sum, too. */
static const double farther = 1.0 + 0x1p-17;

static double search_distance(const cscd_detector *d, double search_radius) {
    return (search_radius + config_greatest_separation(&d->config)) * farther;
}

/* INVALID_ARGUMENT, unless pairs can be looked for within this radius. */
static cscd_status check_radius(const cscd_detector *d, double search_radius) {
    if (is_positive_length(search_radius) && is_positive_length(search_distance(d, search_radius)))
        return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "search_radius is %g, expected a length from 2^-300 to 2^300, also with "
                        "min_separation added to it",
                        search_radius);
}

/* Points that have no distance to keep from a wire, or from each other, may go where they want. */
static size_t keep_counting(cscd_proximity *items, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool of_points = items[i].kind == CSCD_CONTACT_VV || items[i].kind == CSCD_CONTACT_EV;
        if (!of_points || items[i].separation > 0.0) items[kept++] = items[i];
    }
    return kept;
}

/* Lists, in the detector's memory, every pair whose distance is at most its separation plus the radius, and some that
 * are farther apart. All others are farther apart than that by 2^-18 of the radius (docs/theory/displacement-bounds.md, lemma 1). */
static cscd_status find_near_pairs(cscd_detector *d, const double *x, double search_radius,
                                   cscd_proximities *out) {
    cscd_status status = proximity_find(d, x, search_distance(d, search_radius), CSCD_NEAR_PAIRS, out);
    if (status == CSCD_OK && d->mesh->loose.point_count > 0)
        out->count = keep_counting(d->results.proximities.items, out->count);
    return status;
}

/* Memory for count elements of size bytes, which the next call may use otherwise; NULL: there is none. */
static void *pair_scratch(cscd_detector *d, size_t count, size_t size) {
    if (d->pair_scratch != NULL && count <= d->pair_scratch_size / size) return d->pair_scratch;
    void *grown = context_allocate(d->context, count + count / 2 + 1, size);
    if (grown == NULL) return NULL;
    context_free(d->context, d->pair_scratch);
    d->pair_scratch = grown;
    d->pair_scratch_size = (count + count / 2 + 1) * size;
    return grown;
}

cscd_status solver_reserve_reached(cscd_detector *d) {
    if (d->reached == NULL)
        d->reached = context_allocate(d->context, d->mesh->vertex_count, sizeof(double[3]));
    return d->reached != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* ==== bounds for any path ================================================================================== */

/* Half of a gap, less the share that lets callers compare rounded lengths (lemma 3). */
static const double bounds_share = 0.5 * (1.0 - 0x1p-20);

typedef struct gap_work {
    near_rules rules;
    const double *x0;
    const cscd_proximities *near;
    cscd_scalar scalar;
    double *limits; /* per pair: how far each of its vertices may go */
} gap_work;

static void measure_share(void *data, uint32_t index) {
    const gap_work *w = data;
    size_t begin = (size_t)index * NEAR_PAIRS_PER_SHARE, end = begin + NEAR_PAIRS_PER_SHARE;
    for (size_t i = begin; i < end && i < w->near->count; i++) {
        const cscd_proximity *pair = &w->near->items[i];
        double points[4][3];
        near_pair_load(w->x0, pair->vertices, points);
        double gap = near_pair_gap(&w->rules, pair, (const double(*)[3])points);
        w->limits[i] = stored_below(bounds_share * gap, w->scalar);
    }
}

static void lower_bounds(const cscd_proximities *near, const double *limits, double *bounds) {
    for (size_t i = 0; i < near->count; i++) {
        for (int j = 0; j < 4; j++) {
            double *bound = &bounds[near->items[i].vertices[j]];
            *bound = min_of(*bound, limits[i]);
        }
    }
}

/* The vertices of a seam count as one. A name is the smallest vertex of its seam. */
static void join_seams(const cscd_detector *d, double *bounds) {
    const uint32_t *names = d->config.exclusions.names;
    uint32_t count = names != NULL ? d->mesh->vertex_count : 0;
    for (uint32_t v = 0; v < count; v++) bounds[names[v]] = min_of(bounds[names[v]], bounds[v]);
    for (uint32_t v = 0; v < count; v++) bounds[v] = bounds[names[v]];
}

/* Keeps the pairs that do not let their vertices move, in order, and returns how many there are. */
static size_t keep_blocked(cscd_proximity *items, size_t count, const double *limits) {
    size_t blocked = 0;
    for (size_t i = 0; i < count; i++) {
        if (limits[i] == 0.0) items[blocked++] = items[i];
    }
    return blocked;
}

static void sum_up_bounds(const double *bounds, uint32_t vertex_count, double farthest,
                          cscd_displacement_bounds *out) {
    out->least = farthest;
    for (uint32_t v = 0; v < vertex_count; v++) {
        out->limited += bounds[v] < farthest;
        if (bounds[v] >= out->least) continue;
        out->least = bounds[v];
        out->vertex = v;
    }
}

/* Writes a bound for each vertex, a number of the given scalar, and lists the pairs whose vertices have a bound of 0, in
 * the detector's memory (lemma 3). */
static cscd_status find_bounds(cscd_detector *d, const double *x0, double search_radius, cscd_scalar scalar,
                               double *bounds, cscd_displacement_bounds *out) {
    cscd_proximities near;
    cscd_status status = find_near_pairs(d, x0, search_radius, &near);
    if (status == CSCD_LIST_TOO_LONG) *out = (cscd_displacement_bounds){.near_count = near.count};
    if (status != CSCD_OK) return status;
    gap_work work = {
        {d->mesh, &d->config}, x0, &near, scalar, pair_scratch(d, near.count, sizeof *work.limits)};
    if (work.limits == NULL) return CSCD_OUT_OF_MEMORY;
    uint32_t shares = (uint32_t)((near.count + NEAR_PAIRS_PER_SHARE - 1) / NEAR_PAIRS_PER_SHARE);
    parallel_run(d->context->threads, shares, measure_share, &work);
    double farthest = stored_below(0.5 * search_radius, scalar);
    for (uint32_t v = 0; v < d->mesh->vertex_count; v++) bounds[v] = farthest;
    lower_bounds(&near, work.limits, bounds);
    join_seams(d, bounds);
    *out = (cscd_displacement_bounds){.blocked = d->results.proximities.items, .near_count = near.count};
    out->blocked_count = keep_blocked(d->results.proximities.items, near.count, work.limits);
    sum_up_bounds(bounds, d->mesh->vertex_count, farthest, out);
    return CSCD_OK;
}

/* ---- cscd_detector_displacement_bounds ----------------------------------------------------------------- */

static cscd_status check_array(const cscd_detector *d, double search_radius, cscd_scalar scalar,
                               const void *bounds, size_t size) {
    cscd_context *context = d->context;
    size_t wanted = d->mesh->vertex_count * (scalar == CSCD_SCALAR_FLOAT ? sizeof(float) : sizeof(double));
    if ((unsigned)scalar > CSCD_SCALAR_FLOAT)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "scalar is %d, expected CSCD_SCALAR_DOUBLE or CSCD_SCALAR_FLOAT", (int)scalar);
    if (bounds == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "bounds is NULL");
    if (size < wanted)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "bounds has %zu bytes, which is less than the %zu of %u vertices", size, wanted,
                            d->mesh->vertex_count);
    if (!(stored_below(0.5 * search_radius, scalar) > 0.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "search_radius is %g, and half of it is 0 as a float", search_radius);
    return CSCD_OK;
}

static void write_bounds(const double *bounds, uint32_t count, cscd_scalar scalar, void *out) {
    float *floats = out;
    for (uint32_t v = 0; scalar == CSCD_SCALAR_FLOAT && v < count; v++) floats[v] = (float)bounds[v];
    if (scalar == CSCD_SCALAR_DOUBLE) memcpy(out, bounds, count * sizeof *bounds);
}

static cscd_status find_bounds_at(cscd_detector *d, const double *x0, double search_radius,
                                  cscd_scalar scalar, void *bounds, cscd_displacement_bounds *out) {
    uint32_t count = d->mesh->vertex_count;
    cscd_status status = positions_check(d->context, x0, count, "x0");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->config.exclusions.seams, x0);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = solver_reserve_reached(d);
    if (status == CSCD_OK) status = waiting_settle(&waiting, x0);
    if (status == CSCD_OK) status = find_bounds(d, x0, search_radius, scalar, d->reached, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    write_bounds(d->reached, count, scalar, bounds);
    return CSCD_OK;
}

static cscd_status find_bounds_of_views(cscd_detector *detector, const cscd_view *x0, double search_radius,
                                        cscd_scalar scalar, void *bounds, size_t size,
                                        cscd_displacement_bounds *out) {
    cscd_context *context = detector->context;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_displacement_bounds: out is NULL");
    const double *x = NULL;
    cscd_displacement_bounds found;
    cscd_status status = check_radius(detector, search_radius);
    if (status == CSCD_OK) status = check_array(detector, search_radius, scalar, bounds, size);
    if (status == CSCD_OK) status = views_read(context, detector->mesh, x0, "x0", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = find_bounds_at(detector, x, search_radius, scalar, bounds, &found);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_displacement_bounds(cscd_detector *detector, const cscd_view *x0,
                                              double search_radius, cscd_scalar scalar, void *bounds,
                                              size_t size, cscd_displacement_bounds *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry,
                         find_bounds_of_views(detector, x0, search_radius, scalar, bounds, size, out));
}

/* ==== truncation of straight motions ======================================================================= */

/* Rounding may carry a vertex across a plane that its shortened motion just reaches. Then it goes a little less far, and
 * at last it stays. Floats whose spacing is a hundredth of a gap need the fifth or sixth of these. */
static const double shorter[] = {1.0,    1.0 - 0x1p-40, 1.0 - 0x1p-20, 1.0 - 0x1p-10, 1.0 - 0x1p-6,
                                 0.9375, 0.75,          0.5,           0.25,          0.0625};
enum { SHORTER_COUNT = sizeof shorter / sizeof *shorter };

typedef struct truncation_work {
    const cscd_mesh *mesh;
    const uint32_t *names; /* of seams, whose vertices go alike; NULL: there are none */
    const wanted_motion *motion;
    division_planes planes;
    double farthest;    /* that a vertex may go, so that pairs that are not near stay apart */
    double *ways;       /* per vertex: so far, or as far as it wants, whichever is less */
    double *motions;    /* per vertex: what it wants, no longer than that */
    double *of_objects; /* per object: the greatest of its ways */
    double *end;
    double *shares; /* per vertex: of its motion, up to the first plane; at last what it goes */
    size_t *tries;  /* per vertex: how many of them did not fit */
} truncation_work;

/* ---- one vertex ---------------------------------------------------------------------------------------- */

/* Lemma 5: with 2^-50 of the products' magnitudes added, the sum that is computed is no less than the exact one. */
static bool keeps_side(const division_plane *plane, int place, const double moved[3]) {
    double sum = 0.0, magnitude = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += plane->normal[k] * moved[k];
        magnitude += fabs(plane->normal[k] * moved[k]);
    }
    return division_sign(plane, place) * sum + 0x1p-50 * magnitude <= plane->room[place];
}

static bool keeps_sides(const truncation_work *w, size_t vertex, const double moved[3]) {
    if (!(sqrt(vec3_dot(moved, moved)) * (1.0 + 0x1p-50) <= w->ways[vertex])) return false;
    for (size_t i = w->planes.first[vertex]; i != DIVISION_NONE;) {
        const division_plane *plane = &w->planes.planes[i / 4];
        if (!keeps_side(plane, (int)(i % 4), moved)) return false;
        i = plane->next[i % 4];
    }
    return true;
}

/* Returns the share of the motion that reaches the first plane, up to rounding. */
static double share_to_planes(const truncation_work *w, size_t vertex) {
    double motion[3];
    vec3_subtract(w->motion->x1 + vertex * 3, w->motion->x0 + vertex * 3, motion);
    double length = sqrt(vec3_dot(motion, motion));
    double share = length > w->farthest ? w->farthest / length : 1.0;
    for (size_t i = w->planes.first[vertex]; i != DIVISION_NONE && length > 0.0;) {
        const division_plane *plane = &w->planes.planes[i / 4];
        double room = plane->room[i % 4];
        double towards = division_sign(plane, (int)(i % 4)) * vec3_dot(plane->normal, motion);
        if (room < 0.0) return 0.0;
        if (towards * share > room) share = room / towards;
        i = plane->next[i % 4];
    }
    return share;
}

static double share_tried(const truncation_work *w, size_t vertex) {
    return w->tries[vertex] < SHORTER_COUNT ? w->shares[vertex] * shorter[w->tries[vertex]] : 0.0;
}

/* Writes where the vertex is after this share of its motion, as it is stored. Returns whether its planes allow that. */
static bool place_vertex(const truncation_work *w, size_t vertex, double share, cscd_scalar scalar) {
    const double *x0 = w->motion->x0 + vertex * 3, *x1 = w->motion->x1 + vertex * 3;
    double *end = w->end + vertex * 3, moved[3];
    for (int k = 0; k < 3; k++) {
        double x = share == 1.0 ? x1[k] : x0[k] + share * (x1[k] - x0[k]);
        end[k] = share == 0.0 ? x0[k] : stored_coordinate(x, scalar);
        moved[k] = end[k] - x0[k];
    }
    return vec3_largest(moved) == 0.0 || keeps_sides(w, vertex, moved);
}

/* ---- all vertices -------------------------------------------------------------------------------------- */

/* The number of vertices that one thread takes at a time. */
enum { VERTICES_PER_SHARE = 4096 };

static void settle_object(const truncation_work *w, uint32_t object, size_t begin, size_t end) {
    const cscd_object *of = &w->mesh->objects[object];
    cscd_scalar scalar = w->motion->scalars != NULL ? w->motion->scalars[object] : CSCD_SCALAR_DOUBLE;
    size_t first = of->first_vertex, last = first + of->vertex_count;
    for (size_t v = first > begin ? first : begin; v < last && v < end; v++) {
        while (!place_vertex(w, v, share_tried(w, v), scalar)) w->tries[v]++;
    }
}

static void settle_share(void *data, uint32_t index) {
    const truncation_work *w = data;
    size_t begin = (size_t)index * VERTICES_PER_SHARE, end = begin + VERTICES_PER_SHARE;
    for (uint32_t i = 0; i < w->mesh->object_count; i++) settle_object(w, i, begin, end);
}

static void reach_planes(void *data, uint32_t index) {
    const truncation_work *w = data;
    size_t begin = (size_t)index * VERTICES_PER_SHARE, end = begin + VERTICES_PER_SHARE;
    for (size_t v = begin; v < end && v < w->mesh->vertex_count; v++) {
        w->shares[v] = share_to_planes(w, v);
        w->tries[v] = 0;
    }
}

/* All vertices of a seam go the least share of any. */
static void join_shares(const truncation_work *w) {
    uint32_t count = w->names != NULL ? w->mesh->vertex_count : 0;
    for (uint32_t v = 0; v < count; v++)
        w->shares[w->names[v]] = min_of(w->shares[w->names[v]], w->shares[v]);
    for (uint32_t v = 0; v < count; v++) w->shares[v] = w->shares[w->names[v]];
}

/* All vertices of a seam try what did not fit for none of them. Returns whether this is new to any. */
static bool join_tries(const truncation_work *w) {
    bool any = false;
    uint32_t count = w->names != NULL ? w->mesh->vertex_count : 0;
    for (uint32_t v = 0; v < count; v++) {
        size_t *of_seam = &w->tries[w->names[v]];
        any |= w->tries[v] != *of_seam;
        if (w->tries[v] > *of_seam) *of_seam = w->tries[v];
    }
    for (uint32_t v = 0; v < count; v++) w->tries[v] = w->tries[w->names[v]];
    return any;
}

/* Numbers of tries only grow, and where all have failed the vertex stays, which always fits. */
static void truncate_all(truncation_work *w, parallel *threads) {
    uint32_t shares = (w->mesh->vertex_count + VERTICES_PER_SHARE - 1) / VERTICES_PER_SHARE;
    parallel_run(threads, shares, reach_planes, w);
    join_shares(w);
    do parallel_run(threads, shares, settle_share, w);
    while (join_tries(w));
}

static bool differ_in_place(const double *a, const double *b, size_t vertex) {
    for (size_t i = vertex * 3; i < vertex * 3 + 3; i++)
        if (a[i] != b[i]) return true;
    return false;
}

static void sum_up_vertices(const truncation_work *w, cscd_truncation *out) {
    out->fraction = out->obstacle_fraction = 1.0;
    for (uint32_t i = 0; i < w->mesh->object_count; i++) {
        const cscd_object *of = &w->mesh->objects[i];
        for (uint32_t v = of->first_vertex; v < of->first_vertex + of->vertex_count; v++) {
            bool moved = differ_in_place(w->end, w->motion->x0, v);
            bool wanted = differ_in_place(w->motion->x1, w->motion->x0, v);
            double share = !wanted ? 1.0 : moved ? share_tried(w, v) : 0.0;
            out->moved |= moved;
            out->shortened += share < 1.0;
            out->fraction = min_of(out->fraction, share);
            if (of->obstacle) out->obstacle_fraction = min_of(out->obstacle_fraction, share);
        }
    }
}

/* Keeps the pairs that no plane divides, in order, and returns how many there are. */
static size_t keep_held(cscd_detector *d, const double *x0, const division_planes *planes) {
    cscd_proximity *items = d->results.proximities.items;
    size_t held = 0;
    for (size_t i = 0; i < planes->count; i++) {
        if (planes->planes[i].room[0] >= 0.0) continue;
        if (items[i].count == 0)
            proximity_complete(d, x0, i, &items[held++]);
        else
            items[held++] = items[i];
    }
    return held;
}

/* ---- what is known ------------------------------------------------------------------------------------- */

static void taint_if_left_out(const cscd_detector *d, const tainting *t, const cscd_contact *near) {
    if (exclusions_cover(&d->config.exclusions, near->kind, near->a, near->b, NULL)) tainting_look(t, near);
}

/* Pairs that the caller leaves out may touch on the way, so their triangles lose what is known of them. */
static void taint_left_out(cscd_detector *d) {
    const search_space *s = &d->space;
    tainting t = {d->mesh,
                  &d->known.starts,
                  &d->interval.culling,
                  d->interval.closes,
                  d->interval.touched,
                  d->interval.earliest,
                  INFINITY};
    memset(d->interval.closes, 0, d->mesh->component_count * sizeof *d->interval.closes);
    for (uint32_t i = 0; exclusions_any(&d->config.exclusions) && i < s->traversal.worker_count; i++) {
        const contact_worker *worker = &s->workers[i];
        for (size_t j = 0; j < worker->count; j++) taint_if_left_out(d, &t, contact_worker_at(worker, j));
        for (int kind = CSCD_CONTACT_VF; kind <= CSCD_CONTACT_EE; kind++) {
            const candidate_list *named = &worker->candidates[kind];
            for (size_t j = 0; j < named->count; j++) {
                const cscd_contact near = {
                    .kind = (cscd_contact_kind)kind, .a = named->pairs[j][0], .b = named->pairs[j][1]};
                taint_if_left_out(d, &t, &near);
            }
        }
    }
    list_cap_taint(&d->interval, &t);
}

/* Lemma 6: triangles that were clean at x0 are so at the end. */
static void carry_states_over(cscd_detector *d, const double *end) {
    taint_left_out(d);
    start_states_count(&d->known.starts);
    memset(d->interval.incomplete, 0, d->mesh->component_count * sizeof *d->interval.incomplete);
    start_states_end(&d->known.starts, end, d->interval.incomplete);
}

/* ---- one truncation ----------------------------------------------------------------------------------- */

static cscd_status reserve_vertices(cscd_detector *d, truncation_work *w) {
    const size_t count = d->mesh->vertex_count, objects = d->mesh->object_count;
    if (d->vertex_scratch == NULL)
        d->vertex_scratch =
            context_allocate(d->context, count + objects, 2 * sizeof(size_t) + 5 * sizeof(double));
    if (d->vertex_scratch == NULL) return CSCD_OUT_OF_MEMORY;
    w->shares = d->vertex_scratch;
    w->ways = w->shares + count;
    w->motions = w->ways + count;
    w->of_objects = w->motions + 3 * count;
    w->tries = (void *)(w->of_objects + objects);
    w->planes.first = w->tries + count;
    return CSCD_OK;
}

static cscd_status reserve_planes(cscd_detector *d, size_t count, division_planes *out) {
    out->planes = pair_scratch(d, count, sizeof *out->planes);
    return out->planes != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* The motion of a vertex is what division_planes_find divides by. The end that it wants, as it is stored, is within its way with the
 * rounding that keeps_sides adds. */
static void measure_way(truncation_work *w, size_t v, cscd_scalar scalar) {
    const double *x0 = w->motion->x0 + 3 * v, *x1 = w->motion->x1 + 3 * v;
    double *motion = w->motions + 3 * v, wanted[3];
    vec3_subtract(x1, x0, motion);
    const double length = sqrt(vec3_dot(motion, motion));
    for (int k = 0; k < 3; k++) {
        if (length > w->farthest) motion[k] *= w->farthest / length;
        wanted[k] = stored_coordinate(x1[k], scalar) - x0[k];
    }
    w->ways[v] = min_of(sqrt(vec3_dot(wanted, wanted)) * (1.0 + 0x1p-40), w->farthest);
}

/* Returns the largest coordinate. */
static double measure_ways(truncation_work *w) {
    double largest = 0.0;
    for (uint32_t i = 0; i < w->mesh->object_count; i++) {
        const cscd_object *of = &w->mesh->objects[i];
        cscd_scalar scalar = w->motion->scalars != NULL ? w->motion->scalars[i] : CSCD_SCALAR_DOUBLE;
        w->of_objects[i] = 0.0;
        for (size_t v = of->first_vertex; v < (size_t)of->first_vertex + of->vertex_count; v++) {
            measure_way(w, v, scalar);
            w->of_objects[i] = max_of(w->of_objects[i], w->ways[v]);
            largest = max_of(
                largest, max_of(vec3_largest(w->motion->x0 + 3 * v), vec3_largest(w->motion->x1 + 3 * v)));
        }
    }
    return largest;
}

/* More than rounding adds to the way of a vertex along any direction, as a share of the largest coordinate: of doubles, and of
 * positions that may be stored as floats. */
static const double rounding_of_doubles = 0x1p-36, rounding_of_floats = 0x1p-20;

/* Lists, in the detector's memory, the pairs that need a plane: others stay apart while vertices keep to their ways
 * (docs/theory/displacement-bounds.md, lemma 1), or have a plane that stops neither side. *near_count says how many there are with
 * the latter. Points that have no distance to keep from each other need none. */
static cscd_status find_pairs_to_divide(cscd_detector *d, truncation_work *w, double search_radius,
                                        cscd_proximities *out, size_t *near_count) {
    const double largest = measure_ways(w);
    size_t parted = 0;
    cscd_status status;
    if (d->mesh->loose.point_count > 0) {
        status = find_near_pairs(d, w->motion->x0, search_radius, out);
    } else {
        const double share = w->motion->scalars != NULL ? rounding_of_floats : rounding_of_doubles;
        near_ways ways = {{w->ways, .motions = w->motions, .rounding = share * largest},
                          w->of_objects,
                          search_distance(d, search_radius)};
        status = proximity_find_on_ways(d, w->motion->x0, &ways, &parted, out);
    }
    *near_count = out->count + parted;
    return status;
}

static cscd_status truncate_to_planes(cscd_detector *d, truncation_work *w, const cscd_proximities *pairs) {
    const near_rules rules = {d->mesh, &d->config};
    const division_quest quest = {w->motion->x0, w->motion->x1, w->farthest, pairs};
    cscd_status status = reserve_planes(d, pairs->count, &w->planes);
    if (status != CSCD_OK) return status;
    division_planes_find(&rules, &quest, &w->planes);
    truncate_all(w, d->context->threads);
    return CSCD_OK;
}

static truncation_work begin_truncation(const cscd_detector *d, const wanted_motion *motion, double farthest,
                                        double *end) {
    return (truncation_work){d->mesh, d->config.exclusions.names, motion, .farthest = farthest, .end = end};
}

cscd_status truncation_find(cscd_detector *d, const wanted_motion *motion, double search_radius, double *end,
                            cscd_truncation *out) {
    truncation_work work = begin_truncation(d, motion, 0.5 * search_radius, end);
    bool known = config_culls(&d->config) && start_states_hold(&d->known.starts, motion->x0);
    cscd_proximities near = {.count = 0};
    size_t near_count = 0;
    cscd_status status = reserve_vertices(d, &work);
    if (status == CSCD_OK) status = find_pairs_to_divide(d, &work, search_radius, &near, &near_count);
    if (status == CSCD_LIST_TOO_LONG) *out = (cscd_truncation){.near_count = near_count};
    if (status == CSCD_OK) status = truncate_to_planes(d, &work, &near);
    /* before anything is known of the end */
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return status;
    *out = (cscd_truncation){.held = d->results.proximities.items, .near_count = near_count};
    sum_up_vertices(&work, out);
    out->held_count = keep_held(d, motion->x0, &work.planes);
    if (known) carry_states_over(d, end);
    return CSCD_OK;
}

cscd_status truncation_divide(cscd_detector *d, const wanted_motion *motion, const cscd_proximities *pairs,
                              double *end) {
    truncation_work work = begin_truncation(d, motion, INFINITY, end);
    cscd_status status = reserve_vertices(d, &work);
    if (status != CSCD_OK) return status;
    measure_ways(&work);
    return truncate_to_planes(d, &work, pairs);
}

/* ---- cscd_detector_truncate ---------------------------------------------------------------------------- */

cscd_status truncation_scalars(cscd_detector *d, const char *function, const cscd_view *x0,
                               const cscd_mutable_view *reached, const cscd_scalar **out) {
    uint32_t count = d->mesh->object_count;
    if (reached == NULL) return CSCD_OK;
    if (d->scalars == NULL) d->scalars = context_allocate(d->context, count, 2 * sizeof *d->scalars);
    if (d->scalars == NULL) return context_out_of_memory(d->context);
    views_scalars(d->mesh, x0, d->scalars);
    views_mutable_scalars(d->mesh, reached, d->scalars + count);
    *out = d->scalars + count;
    for (uint32_t i = 0; i < count; i++) {
        if (d->scalars[i] == CSCD_SCALAR_DOUBLE && d->scalars[count + i] == CSCD_SCALAR_FLOAT)
            return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                                "%s: object %u has doubles in x0 and floats in reached, so its vertices "
                                "could not stay where they are",
                                function, i);
    }
    return CSCD_OK;
}

static cscd_status truncate_between(cscd_detector *d, const wanted_motion *motion, double search_radius,
                                    cscd_truncation *out) {
    cscd_status status = step_check_positions(d, motion->x0, motion->x1);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = solver_reserve_reached(d);
    if (status == CSCD_OK) status = waiting_settle(&waiting, motion->x0);
    if (status == CSCD_OK) status = waiting_only_touching(&waiting, motion->x0);
    if (status == CSCD_OK) status = truncation_find(d, motion, search_radius, d->reached, out);
    return status == CSCD_OK ? CSCD_OK : detector_fail_call(d, status);
}

static cscd_status truncate_views(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                  double search_radius, const cscd_mutable_view *reached,
                                  cscd_truncation *out) {
    cscd_context *context = detector->context;
    const cscd_mesh *mesh = detector->mesh;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_truncate: out is NULL");
    wanted_motion motion = {.scalars = NULL};
    cscd_truncation found;
    cscd_status status = check_radius(detector, search_radius);
    if (status == CSCD_OK) status = views_read(context, mesh, x0, "x0", &detector->unpacked[0], &motion.x0);
    if (status == CSCD_OK) status = views_read(context, mesh, x1, "x1", &detector->unpacked[1], &motion.x1);
    if (status == CSCD_OK) status = views_check_mutable(context, mesh, reached, "reached");
    if (status == CSCD_OK)
        status = truncation_scalars(detector, "cscd_detector_truncate", x0, reached, &motion.scalars);
    if (status == CSCD_OK) status = truncate_between(detector, &motion, search_radius, &found);
    if (status == CSCD_OK) views_write(mesh, reached, detector->reached);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_truncate(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                   double search_radius, const cscd_mutable_view *reached,
                                   cscd_truncation *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, truncate_views(detector, x0, x1, search_radius, reached, out));
}
