/* Shortens the motion of each vertex, so that planes between near pairs keep these apart. */
#include "runtime/solver/truncation.h"

#include "runtime/culling/culling.h"
#include "runtime/detector/list_cap.h"
#include "runtime/detector/step.h"
#include "runtime/detector/waiting.h"
#include "runtime/solver/division_planes.h"
#include "runtime/solver/stored_scalar.h"
#include "src/core/vec3.h"
#include "src/mesh/views.h"

#include <string.h>

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
    double farthest; /* that a vertex may go, so that pairs that are not near stay apart */
    double *end;
    double *shares; /* per vertex: of its motion, up to the first plane; at last what it goes */
    size_t *tries;  /* per vertex: so many of them did not fit */
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
    if (!(sqrt(vec3_dot(moved, moved)) * (1.0 + 0x1p-50) <= w->farthest)) return false;
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
static size_t keep_held(const division_planes *planes, cscd_proximity *items) {
    size_t held = 0;
    for (size_t i = 0; i < planes->count; i++) {
        if (planes->planes[i].room[0] < 0.0) items[held++] = items[i];
    }
    return held;
}

/* ---- what is known ------------------------------------------------------------------------------------- */

/* Pairs that the caller leaves out may touch on the way, so their triangles lose what is known of them. */
static void taint_left_out(cscd_detector *d) {
    const search_space *s = &d->space;
    tainting t = {d->mesh, &d->starts, &d->culling, d->closes, d->touched, d->earliest, INFINITY};
    memset(d->closes, 0, d->mesh->component_count * sizeof *d->closes);
    for (uint32_t i = 0; exclusions_any(&d->exclusions) && i < s->traversal.lane_count; i++) {
        for (size_t j = 0; j < s->lanes[i].count; j++) {
            const cscd_contact *near = contact_lane_at(&s->lanes[i], j);
            if (exclusions_cover(&d->exclusions, near->kind, near->a, near->b, NULL)) tainting_look(&t, near);
        }
    }
    list_cap_taint(d, &t);
}

/* Lemma 6: triangles that were clean at x0 are so at the end. */
static void carry_states_over(cscd_detector *d, const double *end) {
    taint_left_out(d);
    start_states_count(&d->starts);
    memset(d->incomplete, 0, d->mesh->component_count * sizeof *d->incomplete);
    start_states_end(&d->starts, end, d->incomplete);
}

/* ---- the call ------------------------------------------------------------------------------------------ */

static cscd_status reserve_vertices(cscd_detector *d, truncation_work *w, size_t **first) {
    size_t count = d->mesh->vertex_count;
    if (d->vertex_scratch == NULL)
        d->vertex_scratch = context_allocate(d->context, count, 2 * sizeof(size_t) + sizeof(double));
    if (d->vertex_scratch == NULL) return CSCD_OUT_OF_MEMORY;
    w->shares = d->vertex_scratch;
    w->tries = (void *)(w->shares + count);
    *first = w->tries + count;
    return CSCD_OK;
}

cscd_status truncation_find(cscd_detector *d, const wanted_motion *motion, double search_radius, double *end,
                            cscd_truncation *out) {
    truncation_work work = {d->mesh, d->exclusions.names, motion, .farthest = 0.5 * search_radius,
                            .end = end};
    size_t *first;
    bool known = detector_culls(d) && start_states_hold(&d->starts, motion->x0);
    cscd_proximities near;
    cscd_status status = reserve_vertices(d, &work, &first);
    if (status == CSCD_OK) status = near_pairs_find(d, motion->x0, search_radius, &near);
    if (status == CSCD_LIST_TOO_LONG)
        *out = (cscd_truncation){.near_count = near.count};
    if (status == CSCD_OK)
        status = division_planes_find(d, motion->x0, motion->x1, work.farthest, &near, first, &work.planes);
    if (status != CSCD_OK) return status;
    truncate_all(&work, d->context->threads);
    status = context_progress_status(d->context); /* before anything is known of the end */
    if (status != CSCD_OK) return status;
    *out = (cscd_truncation){.held = d->proximities.items, .near_count = near.count};
    sum_up_vertices(&work, out);
    out->held_count = keep_held(&work.planes, d->proximities.items);
    if (known) carry_states_over(d, end);
    return CSCD_OK;
}

/* ---- of the API ---------------------------------------------------------------------------------------- */

/* The positions that are reached are compared with the planes in the scalar in which they are written, and a vertex
 * must be able to stay where it is. */
static cscd_status choose_scalars(cscd_detector *d, const cscd_view *x0, const cscd_mutable_view *reached,
                                  const cscd_scalar **out) {
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
                                "cscd_detector_truncate: object %u has doubles in x0 and floats in reached, "
                                "so its vertices could not stay where they are",
                                i);
    }
    return CSCD_OK;
}

static cscd_status truncate_between(cscd_detector *d, const wanted_motion *motion, double search_radius,
                                    cscd_truncation *out) {
    cscd_status status = step_check_positions(d, motion->x0, motion->x1);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    if (d->reached == NULL)
        d->reached = context_allocate(d->context, d->mesh->vertex_count, sizeof(double[3]));
    status = d->reached != NULL ? waiting_settle(d, motion->x0) : CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = waiting_only_touching(d, motion->x0);
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
    cscd_status status = near_pairs_check_radius(detector, search_radius);
    if (status == CSCD_OK) status = views_read(context, mesh, x0, "x0", &detector->unpacked[0], &motion.x0);
    if (status == CSCD_OK) status = views_read(context, mesh, x1, "x1", &detector->unpacked[1], &motion.x1);
    if (status == CSCD_OK) status = views_check_mutable(context, mesh, reached, "reached");
    if (status == CSCD_OK) status = choose_scalars(detector, x0, reached, &motion.scalars);
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
