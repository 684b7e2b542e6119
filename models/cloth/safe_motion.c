/* Changes the motion that a solver wants into one near it that is certified to have no contact. */
#include "models/cloth/cloth.h"
#include "models/common/vec3.h"
#include "models/shapes/body.h"

#include <stdlib.h>
#include <string.h>

/* In the first rounds contacts only stop what approaches; in the others, the vertices of contacts move
 * together. */
enum { STOPPING_ROUNDS = 6, STOPPING_PASSES = 40, ROUNDS = 16 };

/* The share of the way to a contact that its features may go. */
static const double share_of_way = 0.7;

/* The share of an excess that a pass takes away: all of it at once would throw back the side that comes
 * first. */
static const double share_of_excess = 0.25;

/* Each separation is a quarter of the one before. */
static cscd_status take_separation(safe_motion *s, uint32_t which) {
    s->which = which;
    s->counts.tight += which == 1;
    if (which > s->counts.tightest) s->counts.tightest = which;
    return cscd_detector_set_separation(s->detector, ldexp(s->separation, -2 * (int)which), 0.0);
}

cscd_status safe_motion_open(const cscd_mesh *mesh, double separation, const double *inverse_masses,
                             const uint32_t *seams, uint32_t seam_count, safe_motion *out) {
    safe_motion s = {.mesh = mesh,
                     .separation = separation,
                     .inverse_masses = inverse_masses,
                     .seams = seams,
                     .seam_count = seam_count};
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = separation;
    options.seams = seams;
    options.seam_count = seam_count;
    cscd_status status = cscd_detector_create(cscd_mesh_context(mesh), mesh, NULL, &options, &s.detector);
    if (status != CSCD_OK) return status;
    s.vertex_count = cscd_mesh_vertex_count(mesh);
    s.parents = body_allocate(s.vertex_count, sizeof *s.parents);
    s.zones = body_allocate(s.vertex_count, sizeof *s.zones);
    s.told = body_allocate(s.vertex_count, sizeof *s.told);
    s.reached = body_allocate(s.vertex_count, sizeof(double[3]));
    *out = s;
    return CSCD_OK;
}

void safe_motion_close(safe_motion *s) {
    cscd_detector_destroy(s->detector);
    free(s->stops);
    free(s->parents);
    free(s->zones);
    free(s->told);
    free(s->reached);
    *s = (safe_motion){0};
}

void safe_motion_sew(const safe_motion *s, double *positions) {
    for (uint32_t i = 0; i < s->seam_count; i++) {
        uint32_t a = s->seams[2 * i], b = s->seams[2 * i + 1];
        double wa = s->inverse_masses[a], wb = s->inverse_masses[b];
        for (uint32_t k = 0; k < 3; k++) {
            double *x = &positions[a * 3 + k], *y = &positions[b * 3 + k];
            if (*x != *y) *x = *y = (wb * *x + wa * *y) / (wa + wb);
        }
    }
}

/* Returns by how much the two points approach along the normal. */
static double approach_of(const safe_motion_stop *stop, const double *x0, const double *x1) {
    double from[3], to[3];
    apart_sum(&stop->stencil, x0, from);
    apart_sum(&stop->stencil, x1, to);
    return vec3_dot(from, stop->normal) - vec3_dot(to, stop->normal);
}

static void take_stops(safe_motion *s, const cscd_contacts *found, const double *x0, const double *x1) {
    if (s->stop_count + found->count > s->stop_capacity) {
        s->stop_capacity = 2 * (s->stop_count + found->count);
        safe_motion_stop *grown = body_allocate(s->stop_capacity, sizeof *grown);
        if (s->stop_count > 0) memcpy(grown, s->stops, s->stop_count * sizeof *grown);
        free(s->stops);
        s->stops = grown;
    }
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        safe_motion_stop *stop = &s->stops[s->stop_count];
        stop->stencil = cscd_mesh_stencil(s->mesh, c->kind, c->a, c->b, c->u, c->v);
        memcpy(stop->normal, c->normal, sizeof stop->normal);
        double approach = approach_of(stop, x0, x1);
        if (approach <= 0.0) continue;
        stop->allowed = share_of_way * c->toi * approach;
        s->stop_count++;
    }
}

/* Lets the pairs that were found in this and earlier rounds approach only by a share of their way to the
 * contact. */
static void stop_approaches(safe_motion *s, const cscd_contacts *found, const double *x0, double *x1) {
    take_stops(s, found, x0, x1);
    for (size_t i = 0; i < s->stop_count * STOPPING_PASSES; i++) {
        const safe_motion_stop *stop = &s->stops[i % s->stop_count];
        double excess = approach_of(stop, x0, x1) - stop->allowed, change[3];
        if (excess <= 0.0) continue;
        for (int k = 0; k < 3; k++) change[k] = share_of_excess * excess * stop->normal[k];
        apart_push(&stop->stencil, s->inverse_masses, change, x1);
    }
}

static void part_zones(safe_motion *s) {
    for (uint32_t v = 0; v < s->vertex_count; v++) s->parents[v] = v;
    memset(s->told, 0, s->vertex_count * sizeof *s->told);
    for (uint32_t i = 0; i < s->seam_count; i++) s->parents[s->seams[2 * i + 1]] = s->seams[2 * i];
}

static uint32_t zone_of(safe_motion *s, uint32_t vertex) {
    while (s->parents[vertex] != vertex) {
        s->parents[vertex] = s->parents[s->parents[vertex]];
        vertex = s->parents[vertex];
    }
    return vertex;
}

static bool is_told(const safe_motion *s, uint32_t vertex) {
    return s->inverse_masses[vertex] == 0.0;
}

/* Joins the zones of a contact's vertices. Vertices of obstacles do not join a zone, they only tell it how
 * they move; else all cloth on a floor were one zone. Returns UINT32_MAX when all vertices belong to
 * obstacles. */
static uint32_t join_zones(safe_motion *s, const cscd_stencil *stencil, const double *x0, const double *x1) {
    uint32_t zone = UINT32_MAX;
    for (int i = 0; i < 4; i++) {
        if (is_told(s, stencil->vertices[i])) continue;
        uint32_t other = zone_of(s, stencil->vertices[i]);
        if (zone == UINT32_MAX) zone = other;
        uint32_t least = zone < other ? zone : other;
        s->parents[zone] = s->parents[other] = least;
        zone = least;
    }
    for (int i = 0; i < 4 && zone != UINT32_MAX; i++) {
        size_t v = stencil->vertices[i];
        if (!is_told(s, stencil->vertices[i])) continue;
        vec3_add_scaled(s->told[zone], 1.0, x1 + v * 3);
        vec3_add_scaled(s->told[zone], -1.0, x0 + v * 3);
        s->told[zone][3] += 1.0;
    }
    return zone;
}

static void sum_up_zones(safe_motion *s, const double *x0, const double *x1) {
    for (uint32_t v = 0; v < s->vertex_count; v++) s->zones[v] = (safe_motion_zone){.share = 1.0};
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (is_told(s, v)) continue;
        safe_motion_zone *zone = &s->zones[zone_of(s, v)];
        double mass = 1.0 / s->inverse_masses[v];
        vec3_add_scaled(zone->motion, mass, x1 + (size_t)v * 3);
        vec3_add_scaled(zone->motion, -mass, x0 + (size_t)v * 3);
        zone->mass += mass;
        vec3_add_scaled(zone->told, 1.0, s->told[v]);
        zone->tellers += s->told[v][3];
    }
}

/* Brings the vertices of contacts nearer to the common motion of their zone: that of the obstacles in it,
 * or else that of its centre of mass, which keeps momentum. Vertices that move alike keep their distances. */
static void move_together(safe_motion *s, const cscd_contacts *found, const double *x0, double *x1) {
    cscd_stencil stencil;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        stencil = cscd_mesh_stencil(s->mesh, c->kind, c->a, c->b, c->u, c->v);
        join_zones(s, &stencil, x0, x1);
    }
    sum_up_zones(s, x0, x1);
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *c = &found->items[i];
        stencil = cscd_mesh_stencil(s->mesh, c->kind, c->a, c->b, c->u, c->v);
        for (int j = 0; j < 4; j++) {
            if (is_told(s, stencil.vertices[j])) continue;
            safe_motion_zone *zone = &s->zones[zone_of(s, stencil.vertices[j])];
            zone->share = fmin(zone->share, share_of_way * c->toi);
        }
    }
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (is_told(s, v)) continue;
        const safe_motion_zone *zone = &s->zones[zone_of(s, v)];
        if (zone->share == 1.0) continue;
        for (int k = 0; k < 3; k++) {
            size_t i = (size_t)v * 3 + (size_t)k;
            double common =
                zone->tellers > 0.0 ? zone->told[k] / zone->tellers : zone->motion[k] / zone->mass;
            x1[i] = x0[i] + common + zone->share * (x1[i] - x0[i] - common);
        }
    }
}

static cscd_status find_contacts(safe_motion *s, const double *x0, const double *x1, cscd_contacts *found) {
    cscd_status status = cscd_detector_step(s->detector, CSCD_DOUBLES(x0, s->vertex_count),
                                            CSCD_DOUBLES(x1, s->vertex_count), found);
    if (status != CSCD_OK) return status;
    s->counts.steps++;
    s->counts.contacts += found->count;
    return CSCD_OK;
}

/* A motion that begins this near the separation goes nowhere: then the next one is taken. */
static const double no_way = 1e-6;

static cscd_status go_as_far(safe_motion *s, const double *x0, const double *x1, cscd_free_step *way) {
    return cscd_detector_max_step(s->detector, CSCD_DOUBLES(x0, s->vertex_count),
                                  CSCD_DOUBLES(x1, s->vertex_count),
                                  CSCD_MUTABLE_DOUBLES(s->reached, s->vertex_count), way);
}

/* Shortens the whole motion. */
static cscd_status fall_back(safe_motion *s, const double *x0, double *x1, double *length) {
    cscd_free_step way = {.fraction = 0.0};
    cscd_status status = go_as_far(s, x0, x1, &way);
    while (status == CSCD_OK && way.fraction < no_way && s->which + 1 < SAFE_MOTION_SEPARATIONS) {
        status = take_separation(s, s->which + 1);
        if (status == CSCD_OK) status = go_as_far(s, x0, x1, &way);
    }
    s->counts.fallbacks++;
    *length = way.fraction;
    bool waits = status == CSCD_IN_CONTACT;
    s->counts.waits += waits;
    if (status == CSCD_OK || waits)
        memcpy(x1, waits ? x0 : s->reached, (size_t)s->vertex_count * 3 * sizeof *x1);
    return waits ? CSCD_OK : status;
}

/* Steps with the first separation that x0 keeps, or with the last. A contact at time 0 shows that x0 does
 * not keep it. */
static cscd_status find_first(safe_motion *s, const double *x0, const double *x1, cscd_contacts *found) {
    for (uint32_t which = 0; which < SAFE_MOTION_SEPARATIONS; which++) {
        cscd_status status = take_separation(s, which);
        if (status == CSCD_OK) status = find_contacts(s, x0, x1, found);
        if (status != CSCD_OK) return status;
        if (found->count == 0 || found->items[0].toi > 0.0) break;
    }
    s->counts.cut += found->count > 0;
    return CSCD_OK;
}

cscd_status safe_motion_find(safe_motion *s, const double *x0, double *x1, double *length) {
    cscd_contacts found;
    *length = 1.0;
    s->stop_count = 0;
    cscd_status status = find_first(s, x0, x1, &found);
    for (int round = 0; status == CSCD_OK && found.count > 0; round++) {
        if (round == ROUNDS) return fall_back(s, x0, x1, length);
        if (round == STOPPING_ROUNDS) part_zones(s);
        if (round < STOPPING_ROUNDS)
            stop_approaches(s, &found, x0, x1);
        else
            move_together(s, &found, x0, x1);
        safe_motion_sew(s, x1);
        status = find_contacts(s, x0, x1, &found);
    }
    return status;
}
