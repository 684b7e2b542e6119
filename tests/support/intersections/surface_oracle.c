/* Piercings, pieces and winding numbers of a small scene by brute force. */
#include "tests/support/intersections/surface_oracle.h"

#include "tests/support/float113.h"

#include <assert.h>
#include <stdlib.h>

static uint32_t name_at(const surface_oracle *o, uint32_t triangle, uint32_t corner) {
    return o->scene->names[o->scene->mesh->triangles[triangle][corner % 3]];
}

static bool has_name(const uint32_t *names, int count, uint32_t name) {
    for (int i = 0; i < count; i++)
        if (names[i] == name) return true;
    return false;
}

static int sign_of(surface_oracle *o, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    return leading_sign(leading_orient3d(&o->terms, (const uint32_t[4]){a, b, c, d}));
}

/* ---- piercings ----------------------------------------------------------------------------------------- */

/* The names of an edge's ends, then of a triangle's corners; false if an end is a corner, too. */
static bool load_names(const surface_oracle *o, uint32_t edge, uint32_t triangle, uint32_t out[5]) {
    for (uint32_t i = 0; i < 2; i++) out[i] = o->scene->names[o->scene->mesh->edges[edge][i]];
    for (uint32_t i = 0; i < 3; i++) out[2 + i] = name_at(o, triangle, i);
    return !has_name(out + 2, 3, out[0]) && !has_name(out + 2, 3, out[1]);
}

static bool edge_passes(surface_oracle *o, uint32_t edge, uint32_t triangle) {
    uint32_t n[5];
    if (!load_names(o, edge, triangle, n)) return false;
    if (sign_of(o, n[2], n[3], n[4], n[0]) == sign_of(o, n[2], n[3], n[4], n[1])) return false;
    int turn = sign_of(o, n[0], n[1], n[2], n[3]);
    return turn == sign_of(o, n[0], n[1], n[3], n[4]) && turn == sign_of(o, n[0], n[1], n[4], n[2]);
}

static bool edges_agree(const grid_scene *s, uint32_t a, uint32_t b) {
    const uint32_t *p = s->mesh->edges[a], *q = s->mesh->edges[b], *names = s->names;
    return (names[p[0]] == names[q[0]] && names[p[1]] == names[q[1]]) ||
           (names[p[0]] == names[q[1]] && names[p[1]] == names[q[0]]);
}

static void name_edges(surface_oracle *o) {
    for (uint32_t e = 0; e < o->scene->mesh->edge_count; e++) {
        o->edge_names[e] = 0;
        while (!edges_agree(o->scene, o->edge_names[e], e)) o->edge_names[e]++;
    }
}

void surface_oracle_begin(surface_oracle *o, const grid_scene *s, double scale) {
    const cscd_mesh *mesh = s->mesh;
    assert(mesh->edge_count <= ORACLE_EDGES && mesh->triangle_count <= ORACLE_TRIANGLES);
    assert(s->vertex_count <= LEADING_POINTS);
    o->scene = s;
    o->scale = scale;
    leading_terms_clear(&o->terms);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        for (int k = 0; k < 3; k++)
            o->terms.points[s->names[v]][k] = (int64_t)(s->positions[3 * v + (uint32_t)k] * scale);
    }
    name_edges(o);
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        for (uint32_t t = 0; t < mesh->triangle_count; t++) o->passes[e][t] = edge_passes(o, e, t);
}

/* The ends that edges of one triangle give; the first one of a piece where they pass towards the side of the other's normal,
 * for the edges of a, and the last one for those of b. Returns how many there are. */
static uint32_t add_ends(surface_oracle *o, uint32_t from, uint32_t through, bool is_a, oracle_piece *out) {
    uint32_t found = 0, n[3] = {name_at(o, through, 0), name_at(o, through, 1), name_at(o, through, 2)};
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t edge = o->scene->mesh->triangle_edges[from][i];
        if (!o->passes[edge][through]) continue;
        bool rises = sign_of(o, n[0], n[1], n[2], name_at(o, from, i + 1)) > 0;
        out->ends[rises == is_a ? 0 : 1] = (oracle_piercing){o->edge_names[edge], through};
        found++;
    }
    return found;
}

bool surface_oracle_piece(surface_oracle *o, uint32_t a, uint32_t b, oracle_piece *out) {
    uint32_t shared = 0;
    *out = (oracle_piece){.a = a, .b = b};
    for (uint32_t i = 0; i < 9; i++) {
        if (name_at(o, a, i / 3) != name_at(o, b, i % 3)) continue;
        out->ends[0] = out->ends[1] = (oracle_piercing){AT_VERTEX, name_at(o, a, i / 3)};
        shared++;
    }
    uint32_t found = add_ends(o, a, b, true, out) + add_ends(o, b, a, false, out);
    if (found > 0 && found + shared != 2) abort();
    return found > 0;
}

/* ---- points -------------------------------------------------------------------------------------------- */

/* The coefficients that count in the limit: those with the least power of all. */
static void keep_least(const leading_term *terms, int count, __int128 *out) {
    uint64_t least = UINT64_MAX;
    for (int i = 0; i < count; i++)
        if (terms[i].power < least) least = terms[i].power;
    for (int i = 0; i < count; i++) {
        __int128 size = terms[i].coefficient < 0 ? -terms[i].coefficient : terms[i].coefficient;
        out[i] = terms[i].power == least ? size : 0;
    }
}

/* The wide format has 113 bits: what is rounded there and then to double is the nearest double, but for quotients within
 * about 2^-111 of the middle between two doubles. */
static double rounded_quotient(__int128 a, __int128 b) {
    return (double)((float113)a / (float113)b);
}

void surface_oracle_point(surface_oracle *o, uint32_t edge, uint32_t triangle, double out[6]) {
    uint32_t n[5];
    leading_term terms[3];
    __int128 weights[3];
    load_names(o, edge, triangle, n);
    terms[0] = leading_orient3d(&o->terms, (const uint32_t[4]){n[2], n[3], n[4], n[1]});
    terms[1] = leading_orient3d(&o->terms, (const uint32_t[4]){n[2], n[3], n[4], n[0]});
    keep_least(terms, 2, weights);
    __int128 sum = weights[0] + weights[1];
    out[0] = rounded_quotient(weights[1], sum);
    for (int k = 0; k < 3; k++) {
        __int128 at = weights[0] * o->terms.points[n[0]][k] + weights[1] * o->terms.points[n[1]][k];
        out[3 + k] = rounded_quotient(at, sum) / o->scale;
    }
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t names[4] = {n[0], n[1], n[2 + (i + 1) % 3], n[2 + (i + 2) % 3]};
        terms[i] = leading_orient3d(&o->terms, names);
    }
    keep_least(terms, 3, weights);
    sum = weights[0] + weights[1] + weights[2];
    out[1] = rounded_quotient(weights[1], sum);
    out[2] = rounded_quotient(weights[2], sum);
}

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* The first of the names c, first and second of a corner_side that is none of these. A determinant with the point
 * c + step (first - c) + step^2 (second - c) + step^3 normal in one row is a sum of those with the points in that row,
 * and those that have a row twice are 0. Returns 3 if there is none, so that the normal decides. */
static int deciding_name(const uint32_t point[3], const uint32_t *names, int count) {
    int i = 0;
    while (i < 3 && has_name(names, count, point[i])) i++;
    return i;
}

/* Does the triangle's order of names come from the other one's by an even number of exchanges? */
static bool is_even(const uint32_t a[3], const uint32_t b[3]) {
    for (int i = 0; i < 3; i++)
        if (a[0] == b[i]) return a[1] == b[(i + 1) % 3];
    return false;
}

/* What the ray along x from the point counts at a triangle. */
static int pass_of(surface_oracle *o, uint32_t triangle, const uint32_t point[3], const uint32_t order[3]) {
    const uint32_t n[3] = {name_at(o, triangle, 0), name_at(o, triangle, 1), name_at(o, triangle, 2)};
    int facing = leading_orient_along(&o->terms, n, 0), side;
    for (int i = 0; i < 3; i++) {
        uint32_t pair[3] = {n[i], n[(i + 1) % 3], 0};
        pair[2] = point[deciding_name(point, pair, 2)];
        if (leading_orient_along(&o->terms, pair, 0) != facing) return 0;
    }
    int decides = deciding_name(point, n, 3);
    side = decides < 3 ? sign_of(o, n[0], n[1], n[2], point[decides]) : is_even(n, order) ? 1 : -1;
    return side != facing ? facing : 0;
}

int surface_oracle_number(surface_oracle *o, corner_side at, uint32_t object) {
    const cscd_mesh *mesh = o->scene->mesh;
    uint32_t order[3], point[3];
    int number = 0;
    for (uint32_t i = 0; i < 3; i++) order[i] = name_at(o, at.triangle, at.corner + i);
    point[0] = order[0];
    point[1] = order[at.next ? 1 : 2];
    point[2] = order[at.next ? 2 : 1];
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (cscd_mesh_vertex_object(mesh, mesh->triangles[t][0]) != object) continue;
        if (mesh->components[mesh->triangle_components[t]].closed_manifold)
            number += pass_of(o, t, point, order);
    }
    return number;
}
