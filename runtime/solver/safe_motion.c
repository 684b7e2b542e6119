/* Makes a motion safe: responds to its contacts until none is left, and truncates what the response cannot solve. */
#include "runtime/solver/contact_response.h"
#include "runtime/solver/solver.h"
#include "src/core/floating.h"
#include "src/core/least_sizes.h"
#include "src/core/timer.h"
#include "src/core/vec3.h"
#include "src/mesh/positions.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- options ------------------------------------------------------------------------------------------- */

static const cscd_response_options default_options = {.struct_size = sizeof default_options};

void cscd_response_defaults_sized(cscd_response_options *out, size_t size) {
    struct_give_options(out, size, &default_options, sizeof default_options);
}

static cscd_status take_options(cscd_context *context, const cscd_response_options *options,
                                cscd_response_options *out) {
    *out = default_options;
    if (options == NULL) return CSCD_OK;
    return struct_take_options(context, out, sizeof *out, LEAST_SIZE(cscd_response_options), options,
                               "cscd_response_defaults");
}

static cscd_status check_numbers(cscd_context *context, const char *name, const double *numbers,
                                 size_t count) {
    for (size_t i = 0; numbers != NULL && i < count; i++) {
        if (numbers[i] >= 0.0 && isfinite(numbers[i])) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%zu] is %g, expected a finite number, 0 or more", name, i, numbers[i]);
    }
    return CSCD_OK;
}

/* ---- memory -------------------------------------------------------------------------------------------- */

typedef struct safe_work {
    cscd_detector *detector;
    const straight_motion *motion; /* as the caller wants it */
    const cscd_response_options *options;
    contact_response response;
    double *wanted;    /* the end that is still wanted: x1, less what is held */
    double *shares;    /* per object: of its motion, if it is an obstacle */
    uint8_t *kinds;    /* per vertex: cscd_response */
    double *end;       /* the detector's: the trial end, as it is stored */
    double *searched;  /* the end that was searched last */
    uint8_t *touching; /* per vertex: it was in contact there */
    uint32_t *changed; /* a list of vertices */
    bool any_searched;
    tries tries;
    double share;         /* of the motion, that this try wants */
    bool truncated;       /* what is wanted is the end of the response */
    bool start_looked_at; /* what touches at x0 is held */
    size_t held_count;
    cscd_safe_motion found;
    swept_interval rules;
} safe_work;

/* Makes a block at least as large as wanted, and keeps its first bytes. */
static cscd_status grow_block(cscd_context *context, void **block, size_t *size, size_t wanted, size_t kept) {
    if (wanted <= *size) return CSCD_OK;
    void *grown = context_allocate(context, wanted + wanted / 2, 1);
    if (grown == NULL) return CSCD_OUT_OF_MEMORY;
    if (kept > 0) memcpy(grown, *block, kept);
    context_free(context, *block);
    *block = grown;
    *size = wanted + wanted / 2;
    return CSCD_OK;
}

/* Makes room for so many more elements of a block that has some. */
static cscd_status grow_list(safe_work *w, void **block, size_t *block_size, size_t count, size_t more,
                             size_t size) {
    if (more >= UINT32_MAX - count || more > SIZE_MAX / 2 / size - count) return CSCD_OUT_OF_MEMORY;
    return grow_block(w->detector->context, block, block_size, (count + more) * size, count * size);
}

enum { BYTES_PER_VERTEX = 10 * sizeof(double) + 2 * sizeof(uint32_t) + 2 * sizeof(uint8_t) };

static cscd_status reserve_work(safe_work *w) {
    cscd_detector *d = w->detector;
    size_t vertices = d->mesh->vertex_count, objects = d->mesh->object_count;
    cscd_status status = solver_reserve_reached(d);
    if (status != CSCD_OK) return status;
    if (d->response.vertices == NULL)
        d->response.vertices =
            context_allocate(d->context, vertices * BYTES_PER_VERTEX + objects * sizeof(double), 1);
    if (d->response.vertices == NULL) return CSCD_OUT_OF_MEMORY;
    contact_response *r = &w->response;
    double *doubles = d->response.vertices;
    w->wanted = doubles;
    r->shift = doubles + 3 * vertices;
    r->mobilities = doubles + 6 * vertices;
    w->searched = doubles + 7 * vertices;
    w->shares = doubles + 10 * vertices;
    r->shifted = (void *)(w->shares + objects);
    w->changed = r->shifted + vertices;
    w->kinds = (void *)(w->changed + vertices);
    w->touching = w->kinds + vertices;
    w->end = d->reached;
    return CSCD_OK;
}

/* ---- begin --------------------------------------------------------------------------------------------- */

/* Obstacles and half-spaces have given motions. */
static bool is_given(const cscd_mesh *mesh, uint32_t object) {
    return mesh->objects[object].obstacle || mesh->objects[object].kind == CSCD_OBJECT_HALF_SPACE;
}

static bool moves_as_wanted(const safe_work *w, uint32_t vertex) {
    const cscd_detector *d = w->detector;
    if (d->space.active.vertices != NULL && !d->space.active.vertices[vertex]) return true;
    return is_given(d->mesh, cscd_mesh_vertex_object(d->mesh, vertex));
}

/* Only ratios of masses matter, and those beyond 2^100 are as good as infinite. Until the sums are complete, the array has
 * masses. */
static void weigh_vertices(safe_work *w) {
    contact_response *r = &w->response;
    const double *inverse = w->options->inverse_masses;
    uint32_t count = w->detector->mesh->vertex_count;
    double largest = 0.0;
    for (uint32_t v = 0; v < count; v++) {
        r->mobilities[v] = 0.0;
        if (!moves_as_wanted(w, v)) largest = max_of(largest, inverse != NULL ? inverse[v] : 1.0);
    }
    for (uint32_t v = 0; v < count; v++) {
        double mobility = moves_as_wanted(w, v) ? 0.0 : inverse != NULL ? inverse[v] / largest : 1.0;
        r->mobilities[response_name(r, v)] += mobility > 0x1p-100 ? 1.0 / mobility : INFINITY;
    }
    for (uint32_t v = 0; v < count; v++)
        r->mobilities[v] = r->mobilities[v] > 0.0 ? 1.0 / r->mobilities[v] : 0.0;
}

static cscd_status check_mobile(const safe_work *w) {
    const double *inverse = w->options->inverse_masses;
    bool any_free = false;
    for (uint32_t v = 0; v < w->detector->mesh->vertex_count; v++) {
        if (moves_as_wanted(w, v)) continue;
        if (inverse == NULL || inverse[v] > 0.0) return CSCD_OK;
        any_free = true;
    }
    if (!any_free) return CSCD_OK;
    return context_fail(w->detector->context, CSCD_INVALID_ARGUMENT,
                        "inverse_masses is 0 for every vertex that could move");
}

/* The end of a motion as far as numbers may go. */
static double place_coordinate(double x, cscd_scalar scalar) {
    const double most = scalar == CSCD_SCALAR_FLOAT ? (double)FLT_MAX : 0x1p300;
    return stored_coordinate(max_of(-most, min_of(x, most)), scalar);
}

static cscd_scalar scalar_of(const safe_work *w, uint32_t object) {
    return w->motion->scalars != NULL ? w->motion->scalars[object] : CSCD_SCALAR_DOUBLE;
}

/* Makes a share of its motion what a vertex of the object wants. */
static void want_share(const safe_work *w, uint32_t object, size_t vertex, double share) {
    const double *x0 = w->motion->x0, *x1 = w->motion->x1;
    for (size_t i = 3 * vertex; i < 3 * vertex + 3; i++) {
        double x = place_coordinate(x0[i] + share * (x1[i] - x0[i]), scalar_of(w, object));
        w->wanted[i] = share == 1.0 ? x1[i] : share == 0.0 ? x0[i] : x;
    }
}

static void want_share_of_object(const safe_work *w, uint32_t object) {
    const cscd_object *of = &w->detector->mesh->objects[object];
    for (size_t v = of->first_vertex; v < (size_t)of->first_vertex + of->vertex_count; v++)
        want_share(w, object, v, w->shares[object]);
}

/* What is sewn to an obstacle goes its share. */
static void want_share_of_sewn(const safe_work *w) {
    const cscd_mesh *mesh = w->detector->mesh;
    const uint32_t count = w->response.names != NULL ? mesh->vertex_count : 0;
    uint32_t *partners = w->changed;
    for (uint32_t v = 0; v < count; v++) partners[v] = UINT32_MAX;
    for (uint32_t v = 0; v < count; v++)
        if (is_given(mesh, cscd_mesh_vertex_object(mesh, v))) partners[response_name(&w->response, v)] = v;
    for (uint32_t v = 0; v < count; v++) {
        const uint32_t partner = partners[response_name(&w->response, v)];
        const uint32_t object = cscd_mesh_vertex_object(mesh, v);
        if (partner == UINT32_MAX || is_given(mesh, object)) continue;
        const double share = w->shares[cscd_mesh_vertex_object(mesh, partner)];
        if (share < 1.0) want_share(w, object, v, share);
    }
}

/* Writes the trial end: what is wanted with its shift, as it is stored. */
static void place_end(const safe_work *w) {
    const cscd_mesh *mesh = w->detector->mesh;
    for (uint32_t o = 0; o < mesh->object_count; o++) {
        size_t first = mesh->objects[o].first_vertex, last = first + mesh->objects[o].vertex_count;
        for (size_t v = first; v < last; v++) {
            const double *shift = w->response.shift + 3 * (size_t)response_name(&w->response, (uint32_t)v);
            for (size_t k = 0; k < 3; k++) {
                const double x = w->wanted[3 * v + k];
                const bool as_wanted = shift[k] == 0.0 && scalar_of(w, o) == CSCD_SCALAR_DOUBLE;
                w->end[3 * v + k] =
                    as_wanted ? x : place_coordinate(shift[k] == 0.0 ? x : x + shift[k], scalar_of(w, o));
            }
        }
    }
}

/* ---- what touches at the start ------------------------------------------------------------------------- */

static bool differ_in_place(const double *a, const double *b, size_t vertex) {
    for (size_t i = vertex * 3; i < vertex * 3 + 3; i++)
        if (a[i] != b[i]) return true;
    return false;
}

static void hold_vertex(const safe_work *w, uint32_t vertex) {
    const contact_response *r = &w->response;
    const size_t i = (size_t)vertex * 3, name = response_name(r, vertex);
    w->kinds[vertex] = CSCD_RESPONSE_HELD;
    memcpy(w->wanted + i, w->motion->x0 + i, sizeof(double[3]));
    memcpy(w->end + i, w->motion->x0 + i, sizeof(double[3]));
    memset(r->shift + 3 * name, 0, sizeof(double[3]));
    r->mobilities[name] = 0.0;
}

static bool is_held_vertex(const safe_work *w, uint32_t vertex) {
    return w->kinds[vertex] == CSCD_RESPONSE_HELD;
}

/* Returns whether that marked any vertex. */
static bool mark_seams(const safe_work *w) {
    bool any = false;
    const uint32_t count = w->response.names != NULL ? w->detector->mesh->vertex_count : 0;
    for (uint32_t v = 0; v < count; v++)
        if (is_held_vertex(w, v)) w->kinds[response_name(&w->response, v)] = CSCD_RESPONSE_HELD;
    for (uint32_t v = 0; v < count; v++) {
        if (is_held_vertex(w, v) || !is_held_vertex(w, response_name(&w->response, v))) continue;
        w->kinds[v] = CSCD_RESPONSE_HELD;
        any = true;
    }
    return any;
}

/* The same. An obstacle that wants to move waits. */
static bool mark_obstacles(const safe_work *w) {
    const cscd_mesh *mesh = w->detector->mesh;
    bool any = false;
    for (uint32_t o = 0; o < mesh->object_count; o++) {
        const uint32_t first = mesh->objects[o].first_vertex, last = first + mesh->objects[o].vertex_count;
        bool held = false, moves = false;
        if (!is_given(mesh, o)) continue;
        for (uint32_t v = first; v < last; v++) held |= is_held_vertex(w, v);
        for (uint32_t v = first; held && v < last; v++) {
            any |= !is_held_vertex(w, v);
            moves |= differ_in_place(w->motion->x0, w->motion->x1, v);
            w->kinds[v] = CSCD_RESPONSE_HELD;
        }
        if (moves) w->shares[o] = 0.0;
    }
    return any;
}

/* Vertices of the pairs that touch at x0 stay there, with those of their seam, and with their obstacle. */
static void hold_touching(const safe_work *w) {
    const cscd_contact *touching = w->detector->response.held;
    for (size_t i = 0; i < w->held_count; i++) {
        for (int j = 0; j < 4; j++) w->kinds[touching[i].vertices[j]] = CSCD_RESPONSE_HELD;
    }
    for (bool any = w->held_count > 0; any;) {
        any = mark_seams(w);
        any |= mark_obstacles(w);
    }
    for (uint32_t v = 0; w->held_count > 0 && v < w->detector->mesh->vertex_count; v++)
        if (is_held_vertex(w, v)) hold_vertex(w, v);
}

static bool is_held(const safe_work *w, const cscd_contact *c) {
    for (int j = 0; j < 4; j++) {
        if (!is_held_vertex(w, c->vertices[j])) return false;
    }
    return true;
}

/* Begins a try at this share of the motion. */
static void begin_work(safe_work *w, double share) {
    const cscd_mesh *mesh = w->detector->mesh;
    size_t coordinates = (size_t)mesh->vertex_count * 3;
    contact_response *r = &w->response;
    r->mesh = mesh;
    r->names = w->detector->config.exclusions.names;
    r->x0 = w->motion->x0;
    r->wanted = w->wanted;
    r->friction = w->options->friction;
    r->rounding = motion_rounding(w->motion);
    w->rules = config_search_begin(&w->detector->config, &w->detector->space, r->x0, r->x0).interval;
    r->rules = &w->rules;
    r->stop_count = 0;
    w->share = share;
    for (uint32_t o = 0; o < mesh->object_count; o++) {
        w->shares[o] = share;
        want_share_of_object(w, o);
    }
    memset(r->shift, 0, coordinates * sizeof(double));
    memset(w->kinds, CSCD_RESPONSE_FREE, mesh->vertex_count);
    r->clock = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) r->shifted[v] = 1;
    weigh_vertices(w);
    w->truncated = false;
    hold_touching(w);
}

/* Finds the pairs that touch at x0, and begins again with their vertices held. */
static cscd_status look_at_start(safe_work *w) {
    cscd_detector *d = w->detector;
    cscd_contacts touching;
    cscd_status status =
        tries_find(&w->tries, w->motion->x0, w->motion->x0, CSCD_MODE_ALL, STEP_BELOW_FLOOR, &touching);
    w->start_looked_at = true;
    if (status != CSCD_OK || touching.count == 0) return status;
    status = grow_list(w, &d->response.held, &d->response.held_size, 0, touching.count, sizeof(cscd_contact));
    if (status != CSCD_OK) return status;
    memcpy(d->response.held, touching.items, touching.count * sizeof(cscd_contact));
    w->held_count = touching.count;
    begin_work(w, w->share);
    place_end(w);
    return CSCD_OK;
}

/* ---- rounds -------------------------------------------------------------------------------------------- */

/* The response ends after this many rounds, or after fewer when the contacts have not become fewer for a while. */
enum { ROUNDS = 32, PATIENCE = 6 };

/* Through what is pressed between two obstacles an impulse takes many passes, which are made where fewer did not help. */
enum { PASSES = 40, PASSES_WITHOUT_SUCCESS = 400 };

/* Lists the vertices whose end has changed since the last search, or that were in contact then. */
static uint32_t list_changed(const safe_work *w) {
    uint32_t count = 0;
    for (uint32_t v = 0; v < w->detector->mesh->vertex_count; v++)
        if (w->touching[v] || differ_in_place(w->end, w->searched, v)) w->changed[count++] = v;
    return count;
}

/* The contacts of a pair depend on the ends of its vertices alone. Where nothing is culled, only what has changed since the last
 * search needs another one, unless that is most of all. */
static cscd_status search_changed(safe_work *w, step_rule rule, cscd_contacts *found) {
    cscd_detector *d = w->detector;
    const uint32_t vertices = d->mesh->vertex_count;
    const bool alone = w->any_searched && !config_culls(&d->config) && d->space.active.vertices == NULL;
    const uint32_t count = alone ? list_changed(w) : vertices;
    const bool focused = count < vertices / 2;
    cscd_status status = focused ? detector_focus(d, w->changed, count) : CSCD_OK;
    if (status == CSCD_OK) status = tries_find(&w->tries, w->motion->x0, w->end, CSCD_MODE_ALL, rule, found);
    if (focused) detector_unfocus(d);
    if (status != CSCD_OK) return status;
    w->any_searched = true;
    memcpy(w->searched, w->end, vertices * sizeof(double[3]));
    memset(w->touching, 0, vertices);
    for (size_t i = 0; i < 4 * found->count; i++) w->touching[found->items[i / 4].vertices[i % 4]] = 1;
    return CSCD_OK;
}

/* Finds the contacts of the motion to the trial end but those that are held. */
static cscd_status find_contacts(safe_work *w, step_rule rule, cscd_contacts *found) {
    cscd_detector *d = w->detector;
    cscd_status status = search_changed(w, rule, found);
    if (status != CSCD_OK || found->count == 0) return status;
    if (rule == STEP_BELOW_FLOOR && found->items[0].toi == 0.0 && !w->start_looked_at) {
        status = look_at_start(w);
        return status == CSCD_OK ? find_contacts(w, rule, found) : status;
    }
    cscd_contact *items = d->results.contacts.items;
    size_t count = 0;
    for (size_t i = 0; i < found->count; i++) {
        if (!is_held(w, &items[i])) items[count++] = items[i];
    }
    found->count = count;
    return status;
}

/* Passes cost as much as there are stops. Where each vertex has very many, as in a mesh that shrinks to a point, no impulses help, and
 * there are fewer passes, so that the cost follows the mesh. */
static int affordable_passes(const safe_work *w, int passes) {
    const double most = 64.0 * w->detector->mesh->vertex_count, count = (double)w->response.stop_count;
    return count > most ? (int)max_of(8.0, passes * most / count) : passes;
}

/* Responds to contacts: to the first ones where they are, and later between their features, so that none of them comes back
 * elsewhere. */
static cscd_status respond_to(safe_work *w, const cscd_contacts *found, bool between_sides, int passes) {
    response_memory *memory = &w->detector->response;
    contact_response *r = &w->response;
    const size_t more = between_sides ? found->count * STOPS_PER_CONTACT : found->count;
    cscd_status status =
        grow_list(w, &memory->stops, &memory->stops_size, r->stop_count, more, sizeof(contact_stop));
    if (status != CSCD_OK) return status;
    r->stops = memory->stops;
    if (between_sides)
        response_take_sides(r, found->items, found->count);
    else
        response_take(r, found->items, found->count);
    response_stop(r, affordable_passes(w, passes));
    return CSCD_OK;
}

/* Responds until no contact is left, or while that helps. */
static cscd_status respond_in_rounds(safe_work *w, bool *free) {
    const bool quick = w->detector->config.limit.distance > 0.0 && !config_is_thick(&w->detector->config);
    cscd_contacts found;
    size_t fewest = SIZE_MAX;
    for (uint32_t round = 0, since = 0; round < ROUNDS && round - since < PATIENCE; round++) {
        place_end(w);
        cscd_status status = find_contacts(w, quick && round == 0 ? STEP_NEARLY : STEP_BELOW_FLOOR, &found);
        w->found.rounds++;
        *free = status == CSCD_OK && found.count == 0;
        if (status != CSCD_OK || *free) return status;
        if (found.count < fewest) since = round;
        fewest = found.count < fewest ? found.count : fewest;
        status = respond_to(w, &found, round > 0, round > since ? PASSES_WITHOUT_SUCCESS : PASSES);
        if (status != CSCD_OK) return status;
    }
    place_end(w);
    return CSCD_OK;
}

/* ---- truncation ---------------------------------------------------------------------------------------- */

/* Obstacles move as a whole, a little less than the least share of any of their vertices. */
static const double share_of_least = 1.0 - 0x1p-30;

/* Finds how far each obstacle went. Returns whether any fell short of its share. */
static bool lower_obstacle_shares(safe_work *w) {
    const cscd_mesh *mesh = w->detector->mesh;
    bool any = false;
    for (uint32_t o = 0; o < mesh->object_count; o++) {
        if (!is_given(mesh, o)) continue;
        double least = w->shares[o];
        for (size_t v = mesh->objects[o].first_vertex, i = 0; i < mesh->objects[o].vertex_count; i++, v++) {
            if (!differ_in_place(w->end, w->wanted, v)) continue;
            double squared = vec3_squared_distance(w->motion->x1 + 3 * v, w->motion->x0 + 3 * v);
            double went = vec3_squared_distance(w->end + 3 * v, w->motion->x0 + 3 * v);
            least = min_of(least, sqrt(went / squared) * share_of_least);
        }
        any |= least < w->shares[o];
        w->shares[o] = least;
    }
    return any;
}

enum { OBSTACLE_ROUNDS = 3 };

/* Shortens motions to planes between the pairs. Obstacles that cannot get where they want go back as a whole, at last to where
 * they were. */
static cscd_status divide_pairs(safe_work *w, const cscd_proximities *pairs, double share) {
    cscd_detector *d = w->detector;
    const wanted_motion motion = {w->motion->x0, w->wanted, w->motion->scalars};
    for (int round = 0;; round++) {
        cscd_status status = truncation_divide(d, &motion, pairs, w->end);
        if (status != CSCD_OK || !lower_obstacle_shares(w)) return status;
        for (uint32_t o = 0; o < d->mesh->object_count; o++) {
            if (!is_given(d->mesh, o) || w->shares[o] == share) continue;
            if (round >= OBSTACLE_ROUNDS) w->shares[o] = 0.0;
            want_share_of_object(w, o);
        }
        want_share_of_sewn(w);
    }
}

static cscd_status add_pairs(safe_work *w, const cscd_contacts *found, cscd_proximities *pairs) {
    response_memory *memory = &w->detector->response;
    cscd_status status = grow_list(w, &memory->divided, &memory->divided_size, pairs->count, found->count,
                                   sizeof(cscd_proximity));
    if (status != CSCD_OK) return status;
    cscd_proximity *items = memory->divided;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        cscd_proximity *pair = &items[pairs->count++];
        *pair = (cscd_proximity){.kind = c->kind, .a = c->a, .b = c->b};
        memcpy(pair->vertices, c->vertices, sizeof pair->vertices);
        pair->separation = response_separation(&w->rules, c);
    }
    pairs->items = items;
    return CSCD_OK;
}

enum { PLANE_ROUNDS = 16, MORE = 32 };

/* Shortens what is still in contact, and what that brings into contact, until nothing is, or planes bring about more than they end. What
 * is wanted is the end of the response from here on. */
static cscd_status truncate_rest(safe_work *w, double share, bool *free) {
    cscd_proximities pairs = {.count = 0};
    cscd_contacts found;
    size_t first = 0;
    memcpy(w->wanted, w->end, w->detector->mesh->vertex_count * sizeof(double[3]));
    w->truncated = true;
    for (uint32_t round = 0; round < PLANE_ROUNDS; round++) {
        cscd_status status = find_contacts(w, STEP_BELOW_FLOOR, &found);
        w->found.rounds++;
        *free = status == CSCD_OK && found.count == 0;
        if (status != CSCD_OK || *free) return status;
        if (round == 0) first = found.count;
        if (found.count / 2 > first + MORE) break;
        w->found.truncations++;
        status = add_pairs(w, &found, &pairs);
        if (status == CSCD_OK) status = divide_pairs(w, &pairs, share);
        if (status != CSCD_OK) return status;
    }
    return CSCD_OK;
}

/* ---- the answer ---------------------------------------------------------------------------------------- */

/* Is the vertex at x1, as it is stored? */
static bool is_at_end(const safe_work *w, size_t vertex, cscd_scalar scalar) {
    for (size_t i = 3 * vertex; i < 3 * vertex + 3; i++) {
        const double x = w->motion->x1[i];
        if (w->end[i] != (scalar == CSCD_SCALAR_DOUBLE ? x : place_coordinate(x, scalar))) return false;
    }
    return true;
}

static uint8_t kind_of(const safe_work *w, uint32_t vertex) {
    if (is_held_vertex(w, vertex)) return CSCD_RESPONSE_HELD;
    const uint32_t object = cscd_mesh_vertex_object(w->detector->mesh, vertex);
    const bool shifted =
        vec3_largest(w->response.shift + 3 * (size_t)response_name(&w->response, vertex)) > 0.0;
    if (w->truncated && differ_in_place(w->end, w->wanted, vertex)) return CSCD_RESPONSE_TRUNCATED;
    if ((!shifted || w->shares[object] < 1.0) && !is_at_end(w, vertex, scalar_of(w, object)))
        return CSCD_RESPONSE_TRUNCATED;
    return shifted ? CSCD_RESPONSE_STOPPED : CSCD_RESPONSE_FREE;
}

/* Returns how much of its wanted motion a vertex has made, along it, from 0 to 1; -1: it wanted none. */
static double surviving_share(const safe_work *w, size_t vertex) {
    const double *x0 = w->motion->x0 + 3 * vertex, *x1 = w->motion->x1 + 3 * vertex;
    double wanted[3], made[3], length;
    vec3_subtract(x1, x0, wanted);
    vec3_subtract(w->end + 3 * vertex, x0, made);
    length = sqrt(vec3_dot(wanted, wanted));
    if (length == 0.0) return -1.0;
    double share = 0.0;
    for (int k = 0; k < 3; k++) share += wanted[k] / length * made[k] / length;
    return max_of(0.0, min_of(share, 1.0));
}

static void sum_up_motion(safe_work *w) {
    const cscd_mesh *mesh = w->detector->mesh;
    cscd_safe_motion *out = &w->found;
    double sum = 0.0;
    size_t movers = 0;
    out->least_share = out->obstacle_share = 1.0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        w->kinds[v] = kind_of(w, v);
        out->response_counts[w->kinds[v]]++;
        out->moved |= differ_in_place(w->end, w->motion->x0, v);
        double share = surviving_share(w, v);
        if (share < 0.0 || is_given(mesh, cscd_mesh_vertex_object(mesh, v))) continue;
        sum += share;
        movers++;
        out->least_share = min_of(out->least_share, share);
    }
    for (uint32_t o = 0; o < mesh->object_count; o++)
        out->obstacle_share = min_of(out->obstacle_share, w->shares[o]);
    out->mean_share = movers > 0 ? sum / (double)movers : 1.0;
    out->pushed = response_count_pushed(&w->response);
    out->responses = w->kinds;
    out->held = w->detector->response.held;
    out->held_count = w->held_count;
}

/* ---- cscd_detector_make_safe --------------------------------------------------------------------------- */

/* Where so little of a motion cannot be made safe, nothing moves. */
static const double least_try = 0x1p-6;

/* Tries the motion, and as long as contacts are left, half of it. */
static cscd_status find_safe_motion(safe_work *w) {
    cscd_detector *d = w->detector;
    cscd_status status = CSCD_OK;
    bool free = false;
    for (double share = 1.0; status == CSCD_OK && !free; share *= 0.5) {
        if (share < least_try) share = 0.0;
        begin_work(w, share);
        status = respond_in_rounds(w, &free);
        if (status == CSCD_OK && !free) status = truncate_rest(w, share, &free);
        if (share == 0.0) break;
    }
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return status;
    step_take(d, w->end);
    sum_up_motion(w);
    return CSCD_OK;
}

static cscd_status make_safe_between(cscd_detector *d, const straight_motion *m,
                                     const cscd_response_options *options, cscd_safe_motion *out) {
    double since = timer_now_ms();
    cscd_status status = step_check_positions(d, m->x0, m->x1);
    if (status == CSCD_OK) status = motion_check(d->context, m);
    if (status != CSCD_OK) return status;
    safe_work work = {.detector = d, .motion = m, .options = options, .tries = {.detector = d}};
    work.tries.timings.check_ms = d->results.timings.check_ms;
    status = check_mobile(&work);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    const waiting_place waiting = detector_waiting_place(d);
    status = reserve_work(&work);
    if (status == CSCD_OK) status = waiting_settle(&waiting, m->x0);
    if (status == CSCD_OK) status = waiting_only_touching(&waiting, m->x0);
    if (status == CSCD_OK) status = find_safe_motion(&work);
    if (status != CSCD_OK) return tries_fail(&work.tries, status);
    tries_end(&work.tries, since);
    *out = work.found;
    return CSCD_OK;
}

cscd_status solver_make_safe(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                             const cscd_response_options *options, const cscd_mutable_view *reached,
                             cscd_safe_motion *out) {
    static const char function[] = "cscd_detector_make_safe";
    cscd_context *context = detector->context;
    const cscd_mesh *mesh = detector->mesh;
    cscd_response_options given;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: out is NULL", function);
    straight_motion motion = {.mesh = mesh};
    cscd_safe_motion found;
    cscd_status status = certified_check_method(detector, function);
    if (status == CSCD_OK) status = take_options(context, options, &given);
    if (status == CSCD_OK)
        status = check_numbers(context, "inverse_masses", given.inverse_masses, mesh->vertex_count);
    if (status == CSCD_OK) status = check_numbers(context, "friction", given.friction, mesh->object_count);
    if (status == CSCD_OK) status = views_read(context, mesh, x0, "x0", &detector->unpacked[0], &motion.x0);
    if (status == CSCD_OK) status = views_read(context, mesh, x1, "x1", &detector->unpacked[1], &motion.x1);
    if (status == CSCD_OK) status = views_check_mutable(context, mesh, reached, "reached");
    if (status == CSCD_OK) status = truncation_scalars(detector, function, x0, reached, &motion.scalars);
    if (status == CSCD_OK) status = make_safe_between(detector, &motion, &given, &found);
    if (status != CSCD_OK) return status;
    views_write(mesh, reached, detector->reached);
    *out = found;
    return CSCD_OK;
}

cscd_status cscd_detector_make_safe(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                    const cscd_response_options *options, const cscd_mutable_view *reached,
                                    cscd_safe_motion *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, solver_make_safe(detector, x0, x1, options, reached, out));
}
