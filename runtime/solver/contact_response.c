/* A response to contacts by accumulated impulses. */
#include "runtime/solver/contact_response.h"

#include "runtime/ccd/ccd.h"
#include "src/core/floating.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* The share of the way to a contact that its points may go, where they need not keep a distance. */
static const double share_of_way = 0.7;

/* Where they do, in such distances: an end that is enough, and the one that is aimed at. The next motion then has some room,
 * and tests of pairs that are clearly apart take less time. */
static const double enough = 1.1, aim = 1.5;

/* The shares of the room between two sides of a plane that their vertices may take, and that a pass aims at. */
static const double side_allowed = 0.75, side_goal = 0.5;

/* The share of what is missing at the start that points part by in one motion. */
static const double healing = 0.25;

/* The share of the approach by which a pass aims below what is allowed, so that later passes and rounding may take some of
 * it. */
static const double slack = 0x1p-6;

/* A contact next to a vertex that cannot move pushes the others hardly at all, where they weigh little, rather than far away. */
static const double least_mobility = 0x1p-7;

enum { PASSES_OF_PUSHED = 4 };

static void add_scaled(double sum[3], double s, const double x[3]) {
    vec3_add_scaled(sum, s, x, sum);
}

static double friction_between(const contact_response *r, const uint32_t vertices[4]) {
    if (r->friction == NULL) return 0.0;
    double a = r->friction[cscd_mesh_vertex_object(r->mesh, vertices[0])];
    double b = r->friction[cscd_mesh_vertex_object(r->mesh, vertices[3])];
    return sqrt(a) * sqrt(b);
}

/* Adds what the shifts change of the motion of the first point relative to the second. */
static void add_shifts(const contact_response *r, const contact_stop *stop, double motion[3]) {
    for (int i = 0; i < 4; i++)
        add_scaled(motion, stop->weights[i], r->shift + (size_t)stop->vertices[i] * 3);
}

static double mobility_of(const contact_response *r, const contact_stop *stop) {
    double sum = 0.0, largest = 0.0;
    for (int i = 0; i < 4; i++) {
        double mobility = r->mobilities[stop->vertices[i]];
        sum += mobility * stop->weights[i] * stop->weights[i];
        largest = max_of(largest, mobility);
    }
    return max_of(sum, least_mobility * largest);
}

/* Where the features have no normal, as parallel edges, the points stop relative to each other. */
static void choose_normal(const cscd_contact *c, const double motion[3], double normal[3]) {
    memcpy(normal, c->normal, sizeof c->normal);
    double length = sqrt(vec3_dot(motion, motion));
    if (vec3_dot(normal, normal) > 0.0 || !(length > 0.0)) return;
    for (int k = 0; k < 3; k++) normal[k] = -motion[k] / length;
}

/* An approach to the goal alone, which rounding and later passes exceed, would never be small enough. */
static void limit_approach(const contact_response *r, const cscd_contact *c, double start, double approach,
                           contact_stop *stop) {
    double distance = response_separation(r->rules, c);
    double share = slack * approach > 2.0 * r->rounding ? slack * approach : 2.0 * r->rounding;
    if (distance == 0.0) {
        stop->allowed = share_of_way * c->toi * approach;
        stop->goal = stop->allowed - share;
        return;
    }
    double missing = aim * distance - start;
    stop->goal = missing > 0.0 ? -healing * missing : -missing;
    stop->allowed = max_of(start - enough * distance, 0.5 * (start - distance));
    if (start <= distance) stop->allowed = stop->goal + share;
}

/* Begins a stop of a contact's vertices. */
static contact_stop *add_stop(contact_response *r, const cscd_contact *c, const double weights[4]) {
    contact_stop *stop = &r->stops[r->stop_count++];
    *stop = (contact_stop){.friction = friction_between(r, c->vertices)};
    for (int j = 0; j < 4; j++) {
        size_t v = c->vertices[j];
        stop->vertices[j] = response_name(r, c->vertices[j]);
        stop->weights[j] = weights[j];
        for (size_t k = 0; k < 3; k++)
            stop->motion[k] += weights[j] * (r->wanted[v * 3 + k] - r->x0[v * 3 + k]);
    }
    stop->mobility = mobility_of(r, stop);
    return stop;
}

static void take_points(contact_response *r, const cscd_contact *c) {
    double weights[4], motion[3], from[3] = {0.0, 0.0, 0.0};
    cscd_stencil_weights(c->kind, c->u, c->v, weights);
    for (int j = 0; j < 4; j++) add_scaled(from, weights[j], r->x0 + 3 * (size_t)c->vertices[j]);
    contact_stop *stop = add_stop(r, c, weights);
    memcpy(motion, stop->motion, sizeof motion);
    add_shifts(r, stop, motion);
    choose_normal(c, motion, stop->normal);
    limit_approach(r, c, vec3_dot(from, stop->normal), max_of(-vec3_dot(motion, stop->normal), 0.0), stop);
}

void response_take(contact_response *r, const cscd_contact *contacts, size_t count) {
    for (size_t i = 0; i < count; i++) take_points(r, &contacts[i]);
}

/* ---- sides of a plane ---------------------------------------------------------------------------------- */

/* Features that are too near at the start part, as the points of a contact do. */
static void limit_between_sides(double start, double distance, contact_stop *stop) {
    const double room = start - distance, missing = aim * distance - start;
    stop->goal = room > 0.0 ? side_goal * room : -healing * missing;
    stop->allowed = room > 0.0 ? side_allowed * room : -(side_allowed * healing) * missing;
}

static void take_sides(contact_response *r, const cscd_contact *c) {
    const cscd_contact_kind kind = stencil_points(c->kind);
    const double distance = response_separation(r->rules, c);
    const int first = points_of_first(kind);
    double points[4][3];
    pair_plane plane;
    for (int j = 0; j < 4; j++) memcpy(points[j], r->x0 + 3 * (size_t)c->vertices[j], sizeof points[j]);
    pair_plane_find(kind, (const double(*)[3])points, &plane);
    if (!(plane.gap > 0.0)) {
        take_points(r, c);
        return;
    }
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) {
            double weights[4] = {0.0, 0.0, 0.0, 0.0};
            weights[i] = 1.0;
            weights[j] = -1.0;
            contact_stop *stop = add_stop(r, c, weights);
            memcpy(stop->normal, plane.normal, sizeof stop->normal);
            limit_between_sides(plane.height[i] - plane.height[j], distance, stop);
        }
    }
}

/* The plane of a half-space is where its points stop anyway. */
void response_take_sides(contact_response *r, const cscd_contact *contacts, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (contacts[i].kind == CSCD_CONTACT_VH)
            take_points(r, &contacts[i]);
        else
            take_sides(r, &contacts[i]);
    }
}

/* ---- impulses ------------------------------------------------------------------------------------------ */

/* Friction takes away what slides, as far as the impulse along the normal lets it. */
static void rub_points(contact_stop *stop, const double motion[3], double approach, double change[3]) {
    double wanted[3];
    for (int k = 0; k < 3; k++)
        wanted[k] = stop->rubbed[k] - (motion[k] + approach * stop->normal[k]) / stop->mobility;
    double length = sqrt(vec3_dot(wanted, wanted)), most = stop->friction * stop->pushed;
    for (int k = 0; k < 3; k++) {
        if (length > most) wanted[k] *= most / length;
        change[k] += wanted[k] - stop->rubbed[k];
        stop->rubbed[k] = wanted[k];
    }
}

/* Has a vertex of the stop been shifted since the stop was last looked at? */
static bool is_news(const contact_response *r, const contact_stop *stop) {
    bool any = false;
    for (int i = 0; i < 4; i++) any |= r->shifted[stop->vertices[i]] > stop->seen;
    return any;
}

/* Returns whether the pair approached by more than is small enough. */
static bool solve_stop(contact_response *r, contact_stop *stop) {
    double motion[3], change[3];
    memcpy(motion, stop->motion, sizeof motion);
    add_shifts(r, stop, motion);
    double approach = -vec3_dot(motion, stop->normal);
    stop->seen = r->clock;
    if (approach <= stop->allowed && (stop->pushed == 0.0 || approach >= 2.0 * stop->goal - stop->allowed))
        return false;
    double pushed = max_of(stop->pushed + (approach - stop->goal) / stop->mobility, 0.0);
    for (int k = 0; k < 3; k++) change[k] = (pushed - stop->pushed) * stop->normal[k];
    stop->pushed = pushed;
    if (stop->friction > 0.0) rub_points(stop, motion, approach, change);
    stop->seen = ++r->clock;
    for (int i = 0; i < 4; i++) {
        add_scaled(r->shift + (size_t)stop->vertices[i] * 3,
                   r->mobilities[stop->vertices[i]] * stop->weights[i], change);
        r->shifted[stop->vertices[i]] = r->clock;
    }
    return approach > stop->allowed;
}

/* Goes over all stops, and links those on which an impulse acts. Returns whether any approached by too much. */
static bool pass_over_all(contact_response *r, uint32_t *first_pushed) {
    bool any = false;
    uint32_t *link = first_pushed;
    for (uint32_t i = 0; i < r->stop_count; i++) {
        contact_stop *stop = &r->stops[i];
        if (stop->mobility > 0.0 && is_news(r, stop)) any |= solve_stop(r, stop);
        if (stop->pushed == 0.0) continue;
        *link = i;
        link = &stop->next_pushed;
    }
    *link = UINT32_MAX;
    return any;
}

static void pass_over_pushed(contact_response *r, uint32_t first) {
    for (uint32_t i = first; i != UINT32_MAX; i = r->stops[i].next_pushed) {
        contact_stop *stop = &r->stops[i];
        if (stop->pushed > 0.0 && is_news(r, stop)) solve_stop(r, stop);
    }
}

/* Between two passes over all stops there are some over those on which an impulse acts, mostly few. */
void response_stop(contact_response *r, int passes) {
    uint32_t first_pushed;
    for (int pass = 0; pass < passes; pass++) {
        if (pass % PASSES_OF_PUSHED != 0)
            pass_over_pushed(r, first_pushed);
        else if (!pass_over_all(r, &first_pushed))
            return;
    }
}

size_t response_count_pushed(const contact_response *r) {
    size_t count = 0;
    for (size_t i = 0; i < r->stop_count; i++) count += r->stops[i].pushed > 0.0;
    return count;
}
