/* Intersection curves on grids where everything degenerates: the piercings are those of polynomials that are written out, each
 * has the right number of pieces, and curves close where they must. */
#include "src/mesh/surface.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { COMPARED = NIGHTLY(30, 100), TRACED = NIGHTLY(500, 4000) };

static traced_scene traced; /* large; one test at a time */

/* Are these edges one, because they are sewn? */
static bool edges_are_one(uint32_t a, uint32_t b) {
    const grid_scene *grid = &traced.scene;
    const uint32_t *p = grid->mesh->edges[a], *q = grid->mesh->edges[b], *names = grid->names;
    return (names[p[0]] == names[q[0]] && names[p[1]] == names[q[1]]) ||
           (names[p[0]] == names[q[1]] && names[p[1]] == names[q[0]]);
}

/* How many points of curves are at a piercing. */
static size_t count_points(surface_piercing piercing) {
    size_t count = 0;
    for (size_t i = 0; i < traced.curves.point_count; i++) {
        const cscd_curve_point *point = &traced.curves.points[i];
        count += point->edge != UINT32_MAX && edges_are_one(point->edge, piercing.edge) &&
                 point->triangle == piercing.triangle;
    }
    return count;
}

static void compare_point(const cscd_curve_point *found) {
    exact_piercing_point truth =
        piercing_oracle_point(&traced.scene, (surface_piercing){found->edge, found->triangle});
    assert_true(found->s == (double)truth.s / (double)truth.s_sum);
    assert_true(found->u == (double)truth.u / (double)truth.uv_sum);
    assert_true(found->v == (double)truth.v / (double)truth.uv_sum);
    for (int k = 0; k < 3; k++) assert_true(found->x[k] == (double)truth.x[k] / (double)truth.s_sum);
}

/* Every piercing is a point of a curve, and the reverse. */
static size_t compare_piercings(bool closed) {
    const cscd_mesh *mesh = traced.scene.mesh;
    size_t piercings = 0, points = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            bool happens = piercing_oracle_happens(&traced.scene, (surface_piercing){e, t});
            size_t count = count_points((surface_piercing){e, t});
            assert_int_equal(happens, count > 0);
            if (closed) assert_true(count <= 1);
            piercings += happens;
        }
    }
    for (size_t i = 0; i < traced.curves.point_count; i++) {
        if (traced.curves.points[i].edge == UINT32_MAX) continue;
        compare_point(&traced.curves.points[i]);
        points++;
    }
    if (closed) assert_true(points == piercings);
    return piercings;
}

TEST(piercings_are_those_of_polynomials) {
    for (int family = 0; family < GRID_FAMILIES; family++) {
        size_t piercings = 0;
        for (uint64_t seed = 0; seed < COMPARED; seed++) {
            traced_scene_make((grid_family)family, seed, &traced);
            piercings += compare_piercings(grid_family_is_closed((grid_family)family));
            traced_scene_free(&traced);
        }
        print_message("  family %d: %zu piercings\n", family, piercings);
        assert_true(piercings > 50);
    }
}

/* ---- what holds of every curve ------------------------------------------------------------------------- */

static bool triangle_has_edge(uint32_t triangle, uint32_t edge) {
    const uint32_t *edges = traced.scene.mesh->triangle_edges[triangle];
    return edges_are_one(edges[0], edge) || edges_are_one(edges[1], edge) || edges_are_one(edges[2], edge);
}

/* Is the point on both triangles of the piece, on an edge of the one and within the other? */
static void check_incidence(cscd_curve_piece piece, const cscd_curve_point *point) {
    if (point->edge == UINT32_MAX) {
        assert_true(triangle_contains(traced.scene.mesh->triangles[piece.a], point->triangle) ||
                    triangle_contains(traced.scene.mesh->triangles[piece.b], point->triangle));
        return;
    }
    assert_true((piece.b == point->triangle && triangle_has_edge(piece.a, point->edge)) ||
                (piece.a == point->triangle && triangle_has_edge(piece.b, point->edge)));
}

/* The way from a point of the piece to the next one is that of the cross product of the normals, or has no length. */
static void check_direction(cscd_curve_piece piece, const cscd_curve_point *from,
                            const cscd_curve_point *to) {
    double normals[2][3], along[3], way[3];
    surface_normal(traced.scene.mesh, traced.scene.positions, piece.a, normals[0]);
    surface_normal(traced.scene.mesh, traced.scene.positions, piece.b, normals[1]);
    vec3_cross(normals[0], normals[1], along);
    vec3_subtract(to->x, from->x, way);
    assert_true(vec3_dot(along, way) > -1e-9);
}

static void check_curve(const cscd_curve *curve, grid_family family) {
    const cscd_curve_point *points = traced.curves.points + curve->first_point;
    const cscd_curve_piece *pieces = traced.curves.pieces + curve->first_piece;
    double length = 0.0;
    assert_int_equal(curve->point_count, curve->piece_count + !curve->closed);
    for (size_t i = 0; i < curve->piece_count; i++) {
        length += sqrt(vec3_squared_distance(points[i].x, points[(i + 1) % curve->point_count].x));
        check_incidence(pieces[i], &points[i]);
        check_incidence(pieces[i], &points[(i + 1) % curve->point_count]);
        if (grid_family_is_closed(family))
            check_direction(pieces[i], &points[i], &points[(i + 1) % curve->point_count]);
        if (i > 0) assert_true((pieces[i].a == pieces[i - 1].a) != (pieces[i].b == pieces[i - 1].b));
    }
    assert_true(fabs(curve->length - length) <= 1e-12 * length);
    assert_int_equal(curve->closed, curve->start == CSCD_CURVE_END_NONE);
    assert_int_equal(curve->closed, curve->end == CSCD_CURVE_END_NONE);
    if (curve->components[0] != curve->components[1] && grid_family_is_closed(family))
        assert_true(curve->closed);
    if (!curve->closed && grid_family_is_closed(family))
        assert_true(curve->start == CSCD_CURVE_END_VERTEX && curve->end == CSCD_CURVE_END_VERTEX);
    if (grid_family_is_closed(family)) assert_false(curve->swapped);
}

typedef struct curve_tally {
    size_t crossings, curves, open, ends[5], swapped;
} curve_tally;

static void add_curve(const cscd_curve *curve, curve_tally *sum) {
    sum->curves++;
    sum->crossings += curve->point_count;
    sum->open += !curve->closed;
    sum->swapped += curve->swapped;
    sum->ends[curve->start]++;
    sum->ends[curve->end]++;
}

static curve_tally trace_family(grid_family family) {
    curve_tally sum = {0};
    for (uint64_t seed = 0; seed < TRACED; seed++) {
        size_t pieces = 0;
        traced_scene_make(family, seed, &traced);
        for (size_t i = 0; i < traced.curves.count; i++) {
            check_curve(&traced.curves.items[i], family);
            add_curve(&traced.curves.items[i], &sum);
            pieces += traced.curves.items[i].piece_count;
        }
        assert_int_equal(pieces, traced.curves.piece_count);
        traced_scene_free(&traced);
    }
    print_message(
        "  family %d: %zu curves with %zu points, %zu open, %zu swapped; ends: %zu %zu %zu %zu %zu\n", family,
        sum.curves, sum.crossings, sum.open, sum.swapped, sum.ends[0], sum.ends[1], sum.ends[2], sum.ends[3],
        sum.ends[4]);
    return sum;
}

TEST(curves_close_where_they_must) {
    size_t crossings = 0;
    for (int family = 0; family < GRID_FAMILIES; family++) {
        curve_tally sum = trace_family((grid_family)family);
        crossings += sum.crossings;
        assert_int_equal(sum.ends[CSCD_CURVE_END_LEFT_OUT], 0);
        assert_int_equal(sum.ends[CSCD_CURVE_END_BORDER] + sum.ends[CSCD_CURVE_END_JUNCTION] > 0,
                         !grid_family_is_closed((grid_family)family) && family != GRID_KLEIN_BOTTLE);
        if (family == GRID_TORUS) assert_true(sum.ends[CSCD_CURVE_END_VERTEX] > 100);
        if (family == GRID_SOUP) assert_true(sum.ends[CSCD_CURVE_END_JUNCTION] > 100);
        if (family != GRID_KLEIN_BOTTLE) assert_int_equal(sum.swapped, 0);
    }
    assert_true(crossings > 150 * TRACED);
}

/* In one of some thousand Klein bottles. */
TEST(sheets_may_change_places) {
    size_t swapped = 0;
    traced_scene_make(GRID_KLEIN_BOTTLE, 5347, &traced);
    for (size_t i = 0; i < traced.curves.count; i++) {
        check_curve(&traced.curves.items[i], GRID_KLEIN_BOTTLE);
        swapped += traced.curves.items[i].swapped;
    }
    assert_int_equal(swapped, 1);
    traced_scene_free(&traced);
}
