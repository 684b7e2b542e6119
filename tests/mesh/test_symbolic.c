/* The signs of moved points against polynomials that are written out, on grids so small that everything degenerates. */
#include "src/mesh/predicates.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdbool.h>

enum { ROUNDS = 20000, POINTS = 5 };

typedef struct random_points {
    grid_point grid[POINTS];
    double x[POINTS][3];
    symbolic_point points[POINTS];
} random_points;

static bool name_is_taken(const random_points *r, int count) {
    for (int i = 0; i < count; i++) {
        if (r->grid[i].name == r->grid[count].name) return true;
    }
    return false;
}

/* Different names, and coordinates of which many are equal. */
static void make_points(random_stream *random, random_points *r) {
    uint32_t width = 1 + stream_below(random, 4);
    for (int i = 0; i < POINTS; i++) {
        do r->grid[i].name = stream_below(random, EPSILON_NAMES);
        while (name_is_taken(r, i));
        for (int k = 0; k < 3; k++) {
            r->grid[i].x[k] = (int)stream_below(random, width);
            r->x[i][k] = r->grid[i].x[k];
        }
        r->points[i] = (symbolic_point){r->x[i], r->grid[i].name};
    }
}

TEST(orientations_in_space) {
    random_stream random = stream_start(1);
    random_points r;
    int degenerate = 0;
    for (int round = 0; round < ROUNDS; round++) {
        epsilon_polynomial truth;
        make_points(&random, &r);
        grid_orient3d(r.grid, &truth);
        symbolic_term term = symbolic_orient3d_term(r.points);
        assert_int_equal(term.sign, epsilon_sign(&truth));
        assert_true(term.sign != 0);
        degenerate += term.moved != 0;
    }
    assert_true(degenerate > ROUNDS / 3);
}

TEST(orientations_in_projections) {
    random_stream random = stream_start(2);
    random_points r;
    for (int round = 0; round < ROUNDS; round++) {
        epsilon_polynomial truth;
        int axis = (int)stream_below(&random, 3);
        make_points(&random, &r);
        grid_orient_along(r.grid, axis, &truth);
        assert_int_equal(symbolic_orient_along(r.points[0], r.points[1], r.points[2], axis),
                         epsilon_sign(&truth));
    }
}

/* Two tetrahedra with a common face: their first terms may have one power. */
TEST(powers_of_terms) {
    random_stream random = stream_start(3);
    random_points r;
    int equal = 0, smaller = 0;
    for (int round = 0; round < ROUNDS; round++) {
        epsilon_polynomial first, second;
        make_points(&random, &r);
        const grid_point other[4] = {r.grid[0], r.grid[1], r.grid[2], r.grid[4]};
        const symbolic_point moved[4] = {r.points[0], r.points[1], r.points[2], r.points[4]};
        grid_orient3d(r.grid, &first);
        grid_orient3d(other, &second);
        symbolic_term a = symbolic_orient3d_term(r.points), b = symbolic_orient3d_term(moved);
        uint64_t p = first.terms[0].power, q = second.terms[0].power;
        assert_int_equal(symbolic_compare_terms(&a, r.points, &b, moved), (p > q) - (p < q));
        equal += p == q && p != 0;
        smaller += p < q;
    }
    assert_true(equal > 100 && smaller > 1000);
}
