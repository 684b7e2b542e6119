/* Piercings, pieces and winding numbers of a small scene by brute force, on the leading terms of determinants of
 * moved points; and trials that compare the library with these, one scene after another. */
#include "tests/support/intersections/surface_oracle.h"

#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/test.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIFFERENCE_TERMS = 3, PRODUCT_TERMS = 6 * DIFFERENCE_TERMS * DIFFERENCE_TERMS * DIFFERENCE_TERMS };

/* A sum of terms in any order; a power may be there more than once. */
typedef struct term_sum {
    leading_term terms[PRODUCT_TERMS];
    int count;
} term_sum;

void leading_terms_clear(leading_terms *t) {
    memset(t, 0, sizeof *t);
}

/* What coordinate k of a point is less that of another one. */
static void difference_of(const leading_terms *t, uint32_t from, uint32_t to, int k,
                          leading_term out[DIFFERENCE_TERMS]) {
    out[0] = (leading_term){0, t->points[to][k] - t->points[from][k]};
    out[1] = (leading_term){UINT64_C(1) << (3 * to + (uint32_t)k), 1};
    out[2] = (leading_term){UINT64_C(1) << (3 * from + (uint32_t)k), -1};
}

static leading_term least_term(const term_sum *sum) {
    uint64_t above = 0; /* the least power that has not been looked at */
    for (;;) {
        leading_term least = {UINT64_MAX, 0};
        for (int i = 0; i < sum->count; i++) {
            const leading_term *term = &sum->terms[i];
            if (term->power < above || term->power > least.power) continue;
            if (term->power < least.power) least = (leading_term){term->power, 0};
            least.coefficient += term->coefficient;
        }
        if (least.power == UINT64_MAX) abort(); /* the polynomial is 0 */
        if (least.coefficient != 0) return least;
        above = least.power + 1;
    }
}

/* Adds the product of so many differences, of coordinate axes[i] of point to[i] and point from. */
static void add_products(const leading_terms *t, uint32_t from, const uint32_t *to, const int *axes,
                         int factors, int sign, term_sum *sum) {
    leading_term differences[3][DIFFERENCE_TERMS];
    int all = 1;
    for (int i = 0; i < factors; i++) {
        difference_of(t, from, to[i], axes[i], differences[i]);
        all *= DIFFERENCE_TERMS;
    }
    for (int choice = 0; choice < all; choice++) {
        leading_term product = {0, sign};
        for (int i = 0, rest = choice; i < factors; i++, rest /= DIFFERENCE_TERMS) {
            product.power += differences[i][rest % DIFFERENCE_TERMS].power;
            product.coefficient *= differences[i][rest % DIFFERENCE_TERMS].coefficient;
        }
        if (product.coefficient != 0) sum->terms[sum->count++] = product;
    }
}

static leading_term expand_spatial(const leading_terms *t, const uint32_t names[4]) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}, {1, 0, 2}, {0, 2, 1}};
    term_sum sum = {.count = 0};
    for (int i = 0; i < 6; i++) add_products(t, names[0], names + 1, orders[i], 3, i < 3 ? 1 : -1, &sum);
    return least_term(&sum);
}

static leading_term expand_flat(const leading_terms *t, const uint32_t names[3], int axis) {
    const int along[2][2] = {{(axis + 1) % 3, (axis + 2) % 3}, {(axis + 2) % 3, (axis + 1) % 3}};
    term_sum sum = {.count = 0};
    for (int i = 0; i < 2; i++) add_products(t, names[0], names + 1, along[i], 2, i == 0 ? 1 : -1, &sum);
    return least_term(&sum);
}

/* Sorts names; -1 if that is an odd number of exchanges, else 1. */
static int sort_names(uint32_t *names, int count) {
    int sign = 1;
    for (int i = 1; i < count; i++) {
        for (int j = i; j > 0 && names[j - 1] > names[j]; j--) {
            uint32_t swapped = names[j];
            names[j] = names[j - 1];
            names[j - 1] = swapped;
            sign = -sign;
        }
    }
    return sign;
}

/* Where sorted names stand among all of their number: the combinatorial number system. */
static uint32_t rank_of(const uint32_t *names, int count) {
    uint32_t rank = 0;
    for (int i = 0; i < count; i++) {
        uint32_t ways = 1; /* names[i] over i + 1 */
        for (uint32_t k = 0; k <= (uint32_t)i; k++) ways = ways * (names[i] - k) / (k + 1);
        if (names[i] >= (uint32_t)i + 1) rank += ways;
    }
    return rank;
}

leading_term leading_orient3d(leading_terms *t, const uint32_t names[4]) {
    uint32_t sorted[4] = {names[0], names[1], names[2], names[3]};
    int sign = sort_names(sorted, 4);
    leading_term *known = &t->spatial[rank_of(sorted, 4)];
    if (known->coefficient == 0) *known = expand_spatial(t, sorted);
    return (leading_term){known->power, sign * known->coefficient};
}

int leading_orient_along(leading_terms *t, const uint32_t names[3], int axis) {
    uint32_t sorted[3] = {names[0], names[1], names[2]};
    int sign = sort_names(sorted, 3);
    leading_term *known = &t->flat[axis][rank_of(sorted, 3)];
    if (known->coefficient == 0) *known = expand_flat(t, sorted, axis);
    return sign * leading_sign(*known);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

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

/* ---- trials -------------------------------------------------------------------------------------------- */

enum { SPREAD_BITS = 20, NO_PIECE = UINT32_MAX };

static const cscd_mesh *mesh_of(const surface_trial *t) {
    return t->traced.scene.mesh;
}

/* ---- a scene of a trial -------------------------------------------------------------------------------- */

static int64_t offset_of(trial_spread spread, random_stream *random) {
    if (spread == SPREAD_NEARLY) return (int64_t)stream_below(random, 3) - 1;
    return stream_below(random, 2) == 0 ? 0 : stream_below(random, 1 << SPREAD_BITS);
}

/* Vertices that are sewn stay together. */
static void spread_vertices(grid_scene *s, trial_spread spread, uint64_t seed) {
    random_stream random = stream_start(~seed);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            double *x = &s->positions[3 * v + k];
            *x += ldexp((double)offset_of(spread, &random), -SPREAD_BITS);
            if (s->names[v] != v) *x = s->positions[3 * s->names[v] + k];
        }
    }
}

static void trace_scene(surface_trial *t, grid_family family, trial_spread spread, uint64_t seed) {
    traced_scene *traced = &t->traced;
    grid_scene_make(family, seed, &traced->scene);
    if (spread != SPREAD_NONE) spread_vertices(&traced->scene, spread, seed);
    traced->joiner = (curve_joiner){.context = traced->scene.context};
    size_t count = grid_scene_pairs(&traced->scene, traced->pairs);
    expect_ok(
        curve_joiner_run(&traced->joiner, &traced->scene.surface, traced->pairs, count, &traced->curves));
    surface_oracle_begin(&t->oracle, &traced->scene, spread == SPREAD_NONE ? 1.0 : 0x1p20);
    t->closed = grid_family_is_closed(family);
}

/* ---- pieces compared ----------------------------------------------------------------------------------- */

static uint32_t root_of(surface_trial *t, uint32_t piece) {
    while (t->parents[piece] != piece) piece = t->parents[piece] = t->parents[t->parents[piece]];
    return piece;
}

static void count_pieces(surface_trial *t, oracle_piece *pieces, uint32_t *count) {
    memset(t->pieces_at, 0, sizeof t->pieces_at);
    *count = 0;
    for (uint32_t a = 0; a < mesh_of(t)->triangle_count; a++) {
        for (uint32_t b = a + 1; b < mesh_of(t)->triangle_count; b++) {
            oracle_piece *piece = &pieces[*count];
            if (!surface_oracle_piece(&t->oracle, a, b, piece)) continue;
            for (int i = 0; i < 2; i++) {
                if (piece->ends[i].edge_name != AT_VERTEX)
                    t->pieces_at[piece->ends[i].edge_name][piece->ends[i].triangle]++;
            }
            (*count)++;
        }
    }
}

/* Pieces are of one curve if they meet at a piercing that no third one has. */
static void join_pieces(surface_trial *t, const oracle_piece *pieces, uint32_t count) {
    static uint32_t first[ORACLE_EDGES][ORACLE_TRIANGLES];
    memset(first, 0xff, sizeof first);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t piece = pieces[i].a * ORACLE_TRIANGLES + pieces[i].b;
        t->parents[piece] = piece;
        for (int k = 0; k < 2; k++) {
            oracle_piercing piercing = pieces[i].ends[k];
            if (piercing.edge_name == AT_VERTEX || t->pieces_at[piercing.edge_name][piercing.triangle] != 2)
                continue;
            uint32_t *before = &first[piercing.edge_name][piercing.triangle];
            if (*before == NO_PIECE)
                *before = piece;
            else
                t->parents[root_of(t, piece)] = root_of(t, *before);
        }
    }
}

static uint32_t count_roots(surface_trial *t, const oracle_piece *pieces, uint32_t count) {
    uint32_t roots = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t piece = pieces[i].a * ORACLE_TRIANGLES + pieces[i].b;
        roots += root_of(t, piece) == piece;
    }
    return roots;
}

static bool point_is_end(const surface_trial *t, const cscd_curve_point *point, oracle_piercing end) {
    if (end.edge_name == AT_VERTEX)
        return point->edge == UINT32_MAX && t->traced.scene.names[point->triangle] == end.triangle;
    return point->edge != UINT32_MAX && t->oracle.edge_names[point->edge] == end.edge_name &&
           point->triangle == end.triangle;
}

/* Where surfaces have an orientation, so have curves. */
static const char *compare_piece(surface_trial *t, cscd_curve_piece found, const cscd_curve_point *from,
                                 const cscd_curve_point *to) {
    oracle_piece truth;
    bool turned = found.a > found.b;
    uint32_t a = turned ? found.b : found.a, b = turned ? found.a : found.b;
    if (!surface_oracle_piece(&t->oracle, a, b, &truth)) return "a piece without a piercing";
    if (t->piece_seen[a][b]) return "a pair with two pieces";
    t->piece_seen[a][b] = true;
    bool forth = point_is_end(t, from, truth.ends[turned]) && point_is_end(t, to, truth.ends[!turned]);
    bool back = point_is_end(t, from, truth.ends[!turned]) && point_is_end(t, to, truth.ends[turned]);
    if (!forth && !back) return "a piece with the wrong ends";
    return forth || !t->closed ? NULL : "a piece in the wrong direction";
}

static const char *compare_curve(surface_trial *t, const cscd_curve *curve) {
    const cscd_curve_point *points = t->traced.curves.points + curve->first_point;
    const cscd_curve_piece *pieces = t->traced.curves.pieces + curve->first_piece;
    uint32_t root = NO_PIECE;
    if (curve->point_count != curve->piece_count + !curve->closed) return "a wrong count of points";
    for (size_t i = 0; i < curve->piece_count; i++) {
        const char *problem = compare_piece(t, pieces[i], &points[i], &points[(i + 1) % curve->point_count]);
        if (problem != NULL) return problem;
        uint32_t a = pieces[i].a, b = pieces[i].b;
        uint32_t its = root_of(t, (a < b ? a : b) * ORACLE_TRIANGLES + (a < b ? b : a));
        if (root != NO_PIECE && its != root) return "a curve of pieces that are not joined";
        root = its;
    }
    t->totals.curves++;
    t->totals.open_curves += !curve->closed;
    return NULL;
}

static const char *compare_curves(surface_trial *t) {
    static oracle_piece pieces[ORACLE_TRIANGLES * ORACLE_TRIANGLES / 2];
    const cscd_curves *found = &t->traced.curves;
    uint32_t count;
    count_pieces(t, pieces, &count);
    join_pieces(t, pieces, count);
    memset(t->piece_seen, 0, sizeof t->piece_seen);
    for (size_t i = 0; i < found->count; i++) {
        const char *problem = compare_curve(t, &found->items[i]);
        if (problem != NULL) return problem;
    }
    t->totals.pieces += count;
    if (found->piece_count != count) return "a wrong count of pieces";
    return count_roots(t, pieces, count) == found->count ? NULL : "a wrong count of curves";
}

/* ---- piercings compared -------------------------------------------------------------------------------- */

static bool is_same_point(surface_trial *t, const cscd_curve_point *point) {
    double truth[6];
    surface_oracle_point(&t->oracle, point->edge, point->triangle, truth);
    if (truth[0] == 0.0 || truth[0] == 1.0) t->totals.degenerate++;
    return point->s == truth[0] && point->u == truth[1] && point->v == truth[2] && point->x[0] == truth[3] &&
           point->x[1] == truth[4] && point->x[2] == truth[5];
}

/* A piercing where two pieces meet is one point; else each of its pieces has one of its own. */
static const char *compare_piercings(surface_trial *t) {
    const cscd_curves *found = &t->traced.curves;
    const cscd_mesh *mesh = mesh_of(t);
    memset(t->points_at, 0, sizeof t->points_at);
    for (size_t i = 0; i < found->point_count; i++) {
        const cscd_curve_point *point = &found->points[i];
        if (point->edge == UINT32_MAX) continue;
        if (!t->oracle.passes[point->edge][point->triangle]) return "a piercing that is none";
        if (!is_same_point(t, point)) return "a piercing at a wrong place";
        t->points_at[t->oracle.edge_names[point->edge]][point->triangle]++;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (uint32_t f = 0; f < mesh->triangle_count; f++) {
            uint32_t name = t->oracle.edge_names[e], pieces = t->pieces_at[name][f];
            if (!t->oracle.passes[e][f]) continue;
            t->totals.piercings += name == e;
            if (pieces == 0 || (t->closed && pieces != 2)) return "a piercing with a wrong count of pieces";
            if (t->points_at[name][f] != (pieces == 2 ? 1 : pieces)) return "a piercing that is not a point";
        }
    }
    return NULL;
}

/* ---- patches ------------------------------------------------------------------------------------------- */

static int number_in(const cscd_patches *patches, uint32_t patch, uint32_t object) {
    const cscd_patch *of = &patches->items[patch];
    for (uint32_t i = 0; i < of->winding_count; i++) {
        if (patches->windings[of->first_winding + i].body == object)
            return patches->windings[of->first_winding + i].number;
    }
    return 0;
}

/* The patch of a corner has the numbers there, and a ray from its other side, too. */
static const char *compare_corner(surface_trial *t, const bvh *trees, const cscd_patches *patches,
                                  uint32_t triangle, uint8_t corner) {
    int32_t numbers[GRID_OBJECTS] = {0};
    bool is_touched[GRID_OBJECTS] = {false};
    uint32_t touched[GRID_OBJECTS], patch = patches->corner_patches[triangle * 3 + corner];
    winding_tally tally = {numbers, is_touched, touched, 0};
    if (patch >= patches->count) return "a corner without a patch";
    winding_find(&t->traced.scene.surface, trees, (corner_side){triangle, corner, false}, &tally);
    for (uint32_t object = 0; object < t->traced.scene.object_count; object++) {
        int truth = surface_oracle_number(&t->oracle, (corner_side){triangle, corner, true}, object);
        int other = surface_oracle_number(&t->oracle, (corner_side){triangle, corner, false}, object);
        if (number_in(patches, patch, object) != truth) return "a patch with a wrong number";
        if (numbers[object] != other) return "a ray with a wrong number";
        t->totals.wound += truth != 0;
        t->totals.twice += truth > 1 || truth < -1;
    }
    t->totals.corners++;
    return NULL;
}

static const char *compare_corners(surface_trial *t, const bvh *trees, const cscd_patches *patches) {
    for (uint32_t triangle = 0; triangle < mesh_of(t)->triangle_count; triangle++) {
        for (uint8_t corner = 0; corner < 3; corner++) {
            const char *problem = compare_corner(t, trees, patches, triangle, corner);
            if (problem != NULL) return problem;
        }
    }
    t->totals.cut += patches->count > mesh_of(t)->component_count;
    return NULL;
}

static const char *compare_patches(surface_trial *t) {
    traced_scene *traced = &t->traced;
    bvh trees;
    patch_finder finder;
    cscd_patches patches;
    mesh_trees_build(traced->scene.mesh, traced->scene.positions, BOX_AXES, &trees);
    expect_ok(patch_finder_create(traced->scene.mesh, 1, &finder));
    expect_ok(patch_finder_run(&finder, &traced->scene.surface, &trees, traced->joiner.found,
                               traced->joiner.piece_count, &patches));
    const char *problem = compare_corners(t, &trees, &patches);
    patch_finder_free(&finder);
    bvh_free(&trees);
    return problem;
}

/* ---- all ----------------------------------------------------------------------------------------------- */

const char *surface_trial_run(surface_trial *t, grid_family family, trial_spread spread, uint64_t seed) {
    trace_scene(t, family, spread, seed);
    const char *problem = compare_curves(t);
    if (problem == NULL) problem = compare_piercings(t);
    if (problem == NULL) problem = compare_patches(t);
    traced_scene_free(&t->traced);
    t->totals.scenes++;
    return problem;
}

void surface_trial_print(const surface_trial *t) {
    const grid_scene *s = &t->traced.scene;
    for (uint32_t v = 0; v < s->vertex_count; v++)
        printf("v %.17g %.17g %.17g\n", s->positions[3 * v], s->positions[3 * v + 1],
               s->positions[3 * v + 2]);
    for (uint32_t i = 0, first = 0; i < s->object_count; first += s->shapes[i++].vertex_count) {
        for (uint32_t k = 0; k < s->shapes[i].triangle_count; k++) {
            const uint32_t *corners = s->shapes[i].triangles[k];
            printf("f %u %u %u\n", first + corners[0], first + corners[1], first + corners[2]);
        }
    }
}
