/* One small scene after another: curves, pieces, points, patches and winding numbers, as the library finds them and as the
 * oracle does. */
#include "tests/support/intersections/surface_trial.h"

#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SPREAD_BITS = 20, NO_PIECE = UINT32_MAX };

static const cscd_mesh *mesh_of(const surface_trial *t) {
    return t->traced.scene.mesh;
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

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

/* ---- pieces -------------------------------------------------------------------------------------------- */

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

/* ---- piercings ----------------------------------------------------------------------------------------- */

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
