/* The quick oracle of surfaces: its terms are those of polynomials that are written out, its numbers those of the slow one;
 * and the library agrees with it on all families of small scenes. make fuzz-surfaces does the same for a million. */
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/intersections/surface_oracle.h"
#include "tests/support/test.h"

#include <string.h>

enum { DETERMINANTS = NIGHTLY(1000, 5000), NUMBERS = NIGHTLY(10, 40), SCENES = NIGHTLY(10, 60) };

static leading_terms terms;
static surface_trial trial; /* large, as the terms */

/* ---- determinants -------------------------------------------------------------------------------------- */

static void draw_points(random_stream *random, grid_point out[4]) {
    uint32_t width = 1 + stream_below(random, 3), first = stream_below(random, EPSILON_NAMES);
    leading_terms_clear(&terms);
    for (uint32_t i = 0; i < 4; i++) {
        out[i].name = (first + i * (1 + stream_below(random, 5))) % EPSILON_NAMES;
        for (uint32_t j = 0; j < i; j++) {
            if (out[j].name != out[i].name) continue;
            out[i].name = (out[i].name + 1) % EPSILON_NAMES;
            j = UINT32_MAX; /* again from the first one */
        }
        for (int k = 0; k < 3; k++) {
            out[i].x[k] = (int)stream_below(random, width + 1);
            terms.points[out[i].name][k] = out[i].x[k];
        }
    }
}

static void compare_terms(const grid_point p[4]) {
    const uint32_t names[4] = {p[0].name, p[1].name, p[2].name, p[3].name};
    epsilon_polynomial value;
    grid_orient3d(p, &value);
    for (int i = 0; i < 2; i++) { /* computed, then looked up */
        leading_term term = leading_orient3d(&terms, names);
        assert_true(term.power == value.terms[0].power && term.coefficient == value.terms[0].coefficient);
    }
    for (int axis = 0; axis < 3; axis++) {
        grid_orient_along(p, axis, &value);
        assert_int_equal(leading_orient_along(&terms, names, axis), epsilon_sign(&value));
    }
}

TEST(terms_are_those_of_polynomials) {
    random_stream random = stream_start(1);
    for (int i = 0; i < DETERMINANTS; i++) {
        grid_point p[4];
        draw_points(&random, p);
        compare_terms(p);
    }
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

TEST(numbers_are_those_of_polynomials) {
    const grid_family families[] = {GRID_TWO_TETRAHEDRA, GRID_PILLOW, GRID_OCTAHEDRON};
    int wound = 0;
    for (uint64_t seed = 0; seed < NUMBERS; seed++) {
        grid_scene s;
        grid_scene_make(families[seed % 3], seed, &s);
        surface_oracle_begin(&trial.oracle, &s, 1.0);
        for (uint32_t i = 0; i < s.mesh->triangle_count * 6; i++) {
            corner_side at = {i / 6, (uint8_t)(i % 3), i / 3 % 2 == 0};
            for (uint32_t object = 0; object < s.object_count; object++) {
                int number = winding_oracle_number(&s, at, object);
                assert_int_equal(surface_oracle_number(&trial.oracle, at, object), number);
                wound += number != 0;
            }
        }
        grid_scene_free(&s);
    }
    assert_true(wound > NUMBERS);
}

TEST(library_agrees) {
    memset(&trial.totals, 0, sizeof trial.totals);
    for (int family = 0; family < GRID_FAMILIES; family++) {
        for (uint64_t seed = 0; seed < SCENES; seed++) {
            const char *problem = surface_trial_run(&trial, (grid_family)family,
                                                    (trial_spread)(seed % SPREAD_COUNT), 5000 + seed);
            if (problem == NULL) continue;
            surface_trial_print(&trial);
            fail_msg("family %d, seed %d: %s", family, (int)seed, problem);
        }
    }
    const trial_totals *sum = &trial.totals;
    assert_true(sum->curves > 20 * SCENES && sum->open_curves > SCENES && sum->degenerate > 10 * SCENES);
    assert_true(sum->wound > 50 * SCENES && sum->twice > 0 && sum->cut > SCENES);
}
