/* A response to contacts by accumulated impulses, and by impact zones. */
#include "runtime/solver/contact_response.h"

#include "src/core/floating.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* The share of the way to a contact that its points may go, where they need not keep a distance. */
static const double share_of_way = 0.7;

/* Where they do, in such distances: an end that is enough, and the one that is aimed at. The next motion then has some room,
 * and tests of pairs that are clearly apart take less time. */
static const double enough = 1.1, aim = 1.5;

/* The share of what is missing at the start that points part by in one motion. */
static const double healing = 0.25;

/* The share of the approach by which a pass aims below what is allowed, so that later passes and rounding may take some of
 * it. */
static const double slack = 0x1p-6;

/* A contact next to a vertex that cannot move pushes the others hardly at all, where they weigh little, rather than far away. */
static const double least_mobility = 0x1p-7;

enum { PASSES = 40, PASSES_OF_PUSHED = 4 };

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
    double distance = pair_separation(r->rules, c->kind, c->a, c->b).distance;
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

void response_take(contact_response *r, const cscd_contact *contacts, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const cscd_contact *c = &contacts[i];
        contact_stop *stop = &r->stops[r->stop_count++];
        *stop = (contact_stop){.friction = friction_between(r, c->vertices)};
        double from[3] = {0.0, 0.0, 0.0};
        cscd_stencil_weights(c->kind, c->u, c->v, stop->weights);
        for (int j = 0; j < 4; j++) {
            size_t v = c->vertices[j];
            stop->vertices[j] = response_name(r, c->vertices[j]);
            add_scaled(from, stop->weights[j], r->x0 + 3 * v);
            for (size_t k = 0; k < 3; k++)
                stop->motion[k] += stop->weights[j] * (r->wanted[v * 3 + k] - r->x0[v * 3 + k]);
        }
        double motion[3];
        memcpy(motion, stop->motion, sizeof motion);
        add_shifts(r, stop, motion);
        choose_normal(c, motion, stop->normal);
        limit_approach(r, c, vec3_dot(from, stop->normal), max_of(-vec3_dot(motion, stop->normal), 0.0),
                       stop);
        stop->mobility = mobility_of(r, stop);
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
void response_stop(contact_response *r) {
    uint32_t first_pushed;
    for (int pass = 0; pass < PASSES; pass++) {
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

/* ---- impact zones -------------------------------------------------------------------------------------- */

void response_begin_zones(contact_response *r) {
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) r->parents[v] = v;
    r->zone_begin = r->stop_count;
}

static uint32_t zone_of(const contact_response *r, uint32_t name) {
    while (r->parents[name] != name) {
        r->parents[name] = r->parents[r->parents[name]];
        name = r->parents[name];
    }
    return name;
}

static bool is_free(const contact_response *r, uint32_t name) {
    return r->mobilities[name] > 0.0;
}

/* Vertices that cannot move do not join: else all cloth on a floor were one zone. Returns the zone; UINT32_MAX: there is
 * none. */
static uint32_t join_stop(contact_response *r, const contact_stop *stop) {
    uint32_t zone = UINT32_MAX;
    for (int i = 0; i < 4; i++) {
        if (!is_free(r, stop->vertices[i])) continue;
        uint32_t other = zone_of(r, stop->vertices[i]);
        if (zone == UINT32_MAX) zone = other;
        uint32_t least = zone < other ? zone : other;
        r->parents[zone] = r->parents[other] = least;
        zone = least;
    }
    return zone;
}

/* Writes how the vertex moves with its shift. */
static void motion_with_shift(const contact_response *r, uint32_t vertex, double motion[3]) {
    vec3_subtract(r->wanted + (size_t)vertex * 3, r->x0 + (size_t)vertex * 3, motion);
    add_scaled(motion, 1.0, r->shift + (size_t)response_name(r, vertex) * 3);
}

static void sum_up_zones(contact_response *r) {
    uint32_t count = r->mesh->vertex_count;
    for (uint32_t v = 0; v < count; v++) r->zones[v] = (impact_zone){.share = 1.0};
    for (uint32_t v = 0; v < count; v++) {
        if (response_name(r, v) != v || !is_free(r, v)) continue;
        impact_zone *zone = &r->zones[zone_of(r, v)];
        double motion[3], mass = 1.0 / r->mobilities[v];
        motion_with_shift(r, v, motion);
        add_scaled(zone->momentum, mass, motion);
        zone->mass += mass;
    }
}

static void tell_zones(contact_response *r) {
    for (size_t i = r->zone_begin; i < r->stop_count; i++) {
        const contact_stop *stop = &r->stops[i];
        for (int j = 0; j < 4; j++) {
            if (!is_free(r, stop->vertices[j])) continue;
            impact_zone *zone = &r->zones[zone_of(r, stop->vertices[j])];
            for (int k = 0; k < 4; k++) {
                double motion[3];
                if (is_free(r, stop->vertices[k])) continue;
                motion_with_shift(r, stop->vertices[k], motion);
                add_scaled(zone->told, 1.0, motion);
                zone->tellers += 1.0;
            }
        }
    }
}

static void move_with_zone(contact_response *r, uint32_t name) {
    const impact_zone *zone = &r->zones[zone_of(r, name)];
    if (zone->share == 1.0) return;
    double motion[3];
    motion_with_shift(r, name, motion);
    for (size_t k = 0; k < 3; k++) {
        double common = zone->tellers > 0.0 ? zone->told[k] / zone->tellers : zone->momentum[k] / zone->mass;
        r->shift[(size_t)name * 3 + k] += (1.0 - zone->share) * (common - motion[k]);
    }
}

void response_join(contact_response *r, const cscd_contact *contacts, size_t count) {
    const contact_stop *taken = &r->stops[r->stop_count - count];
    for (size_t i = 0; i < count; i++) join_stop(r, &taken[i]);
    sum_up_zones(r);
    tell_zones(r);
    for (size_t i = 0; i < count; i++) {
        for (int j = 0; j < 4; j++) {
            if (!is_free(r, taken[i].vertices[j])) continue;
            impact_zone *zone = &r->zones[zone_of(r, taken[i].vertices[j])];
            zone->share = min_of(zone->share, share_of_way * contacts[i].toi);
        }
    }
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        if (response_name(r, v) == v && is_free(r, v)) move_with_zone(r, v);
    }
}

bool response_in_zone(const contact_response *r, uint32_t vertex) {
    uint32_t name = response_name(r, vertex), zone = zone_of(r, name);
    return is_free(r, name) && (zone != name || r->zones[name].share < 1.0);
}
