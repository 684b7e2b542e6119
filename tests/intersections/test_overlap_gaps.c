/* Overlaps whose curves are left out, wholly or in part, have no volume; all others have theirs. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <math.h>

static body_rig rig; /* large; one test at a time */

/* Which pairs of triangles the caller's function ignores: those of the first two bodies, but some. */
typedef struct ignored_range {
    uint32_t first_b, kept_a;
} ignored_range;

static bool ignore_pair(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const ignored_range *range = user;
    return kind == CSCD_CONTACT_TT && a < range->first_b && b >= range->first_b && b < range->first_b + 12 &&
           a != range->kept_a;
}

static void add_cube(double x, double y, double z, double size) {
    const double low[3] = {x, y, z}, sizes[3] = {size, size, size};
    body_rig_box(&rig, low, sizes);
}

/* Three cubes: the first one overlaps the other two, which are apart. With a hole the first one is open. */
static void add_cubes(bool with_hole) {
    body_rig_begin(&rig);
    const double low[3] = {0, 0, 0}, sizes[3] = {2, 2, 2};
    body_rig_add_box(&rig, low, sizes);
    if (with_hole) rig.all.triangle_count--;
    body_rig_end_body(&rig);
    add_cube(1.25, 1.5, 1.125, 2);
    add_cube(-1.5, -1.25, -1.125, 2);
}

static void find_ignoring(ignored_range *range) {
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignore_pair;
    options.ignore_user = range;
    body_rig_create(&rig, &options, 2);
    body_rig_find(&rig);
}

static void expect_volumes(bool known) {
    cscd_overlap left_out = body_rig_overlap(&rig, 0, 1), other = body_rig_overlap(&rig, 0, 2);
    assert_int_equal(isnan(left_out.volume), !known);
    if (known) assert_true(fabs(left_out.volume - 0.75 * 0.5 * 0.875) <= 1e-12);
    assert_true(fabs(other.volume - 0.5 * 0.75 * 0.875) <= 1e-12);
    assert_int_equal(rig.found.overlaps->count, 2);
}

/* Not even a piece of the curve tells that something is missing. */
TEST(a_whole_curve) {
    ignored_range range = {12, UINT32_MAX};
    add_cubes(false);
    find_ignoring(&range);
    assert_int_equal(rig.found.curves->count, 1);
    expect_volumes(false);
}

/* Two bars across each other have no vertices in each other, so nothing but the curves tells that they overlap. */
TEST(nothing_else_is_buried) {
    static const double low[3] = {-3, 0.1, 0.2}, size[3] = {6, 0.5, 0.25}, across[3] = {0.3, -2, 0.1},
                        other[3] = {0.5, 5, 2};
    ignored_range range = {12, UINT32_MAX};
    body_rig_begin(&rig);
    body_rig_box(&rig, low, size);
    body_rig_box(&rig, across, other);
    find_ignoring(&range);
    assert_int_equal(rig.found.overlaps->count, 1);
    assert_true(isnan(body_rig_overlap(&rig, 0, 1).volume));
}

TEST(all_but_some_pieces) {
    size_t open = 0;
    for (uint32_t kept = 0; kept < 12; kept++) {
        ignored_range range = {12, kept};
        add_cubes(false);
        find_ignoring(&range);
        for (size_t i = 0; i < rig.found.curves->count; i++) open += !rig.found.curves->items[i].closed;
        expect_volumes(false);
    }
    assert_true(open > 0);
}

/* Pairs without a piece of a curve may be left out: here two that only touch. */
TEST(pairs_that_carry_nothing) {
    size_t ignored = 0;
    add_cubes(false);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    uint32_t pairs[64][2];
    for (size_t i = 0; i < rig.found.count; i++) {
        if (rig.found.curves->pair_curves[i] != UINT32_MAX || ignored == 64) continue;
        pairs[ignored][0] = rig.found.items[i].a;
        pairs[ignored++][1] = rig.found.items[i].b;
    }
    assert_true(ignored == 0 || cscd_detector_set_ignored(rig.detector, pairs[0], ignored) == CSCD_OK);
    body_rig_find(&rig);
    expect_volumes(true);
}

/* A curve with an open component bounds nothing. */
TEST(open_components_have_none) {
    ignored_range range = {11, UINT32_MAX};
    add_cubes(true);
    find_ignoring(&range);
    assert_true(body_rig_overlap(&rig, 0, 1).volume == 0.0);
    assert_true(body_rig_overlap(&rig, 0, 2).volume == 0.0);
}

static bool has_closed_curve(void) {
    for (size_t i = 0; i < rig.found.curves->count; i++) {
        const cscd_curve *curve = &rig.found.curves->items[i];
        if (curve->objects[1] == 1) return curve->closed;
    }
    return false;
}

/* A seam whose vertices are apart leaves out pairs whose features that meet have vertices of it, as many as all of a curve:
 * each pair of triangles at the two corners that are in the other cube. */
TEST(seams_whose_vertices_are_apart) {
    size_t unknown = 0;
    for (uint32_t v = 0; v < 64; v++) {
        const uint32_t seam[2] = {v / 8, 8 + v % 8};
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = seam;
        options.seam_count = 1;
        options.seam_reach = (double)INFINITY;
        add_cubes(false);
        body_rig_create(&rig, &options, 1);
        body_rig_find(&rig);
        bool known = !isnan(body_rig_overlap(&rig, 0, 1).volume);
        assert_int_equal(known, has_closed_curve());
        expect_volumes(known);
        unknown += !known;
    }
    assert_true(unknown > 0 && unknown < 64);
}

/* Two tips over a ring, one vertex of which passes through the other side: the curve goes from tip to tip. */
static void add_star_that_crosses_itself(void) {
    enum { RING = 7 };
    scene *all = &rig.all;
    const uint32_t first = all->vertex_count;
    for (uint32_t i = 0; i < RING + 2; i++, all->vertex_count++) {
        const double angle = 6.283185307179586 * i / RING, through = i == 0 ? -1.7 : 1.0;
        const double place[3] = {through * cos(angle), sin(angle) + 0.03 * i, 0.01 * i},
                     tip[3] = {0, 0, i == RING ? 1 : -1};
        for (uint32_t k = 0; k < 3; k++) all->x0[3 * (first + i) + k] = i < RING ? place[k] : tip[k];
    }
    for (uint32_t i = 0; i < RING; i++) {
        const uint32_t a = first + i, b = first + (i + 1) % RING;
        const uint32_t corners[6] = {a, b, first + RING, b, a, first + RING + 1};
        for (uint32_t k = 0; k < 6; k++) all->triangles[3 * all->triangle_count + k] = corners[k];
        all->triangle_count += 2;
    }
    body_rig_end_body(&rig);
}

/* Curves of a body with itself that begin at a vertex, and end where a pair is left out or not looked at: the body's volume is not
 * known, nor that of an overlap with another body, whichever of the two is first. */
static bool ends_are_told(uint32_t star) {
    bool gap = false;
    body_rig_find(&rig);
    for (size_t i = 0; i < rig.found.curves->count; i++) {
        const cscd_curve *c = &rig.found.curves->items[i];
        if (c->objects[0] == star && c->objects[1] == star)
            gap |= (c->start == CSCD_CURVE_END_LEFT_OUT) != (c->end == CSCD_CURVE_END_LEFT_OUT);
    }
    const cscd_overlap own = body_rig_overlap(&rig, star, star), common = body_rig_overlap(&rig, 0, 1);
    if (gap) assert_true(isnan(own.volume));
    if (gap) assert_true(isnan(common.volume) || (common.area_a == 0.0 && common.area_b == 0.0));
    return gap;
}

TEST(one_end_is_left_out) {
    size_t seams = 0, actives = 0;
    for (uint32_t star = 0; star < 2; star++) {
        const uint32_t base = star == 0 ? 0 : 8;
        for (uint32_t i = 0; i < 81; i++) {
            const uint32_t seam[2] = {base + i % 9, base + i / 9};
            cscd_detector_options options = cscd_detector_defaults();
            options.seams = seam[0] < seam[1] ? seam : NULL;
            options.seam_count = seam[0] < seam[1];
            options.seam_reach = (double)INFINITY;
            body_rig_begin(&rig);
            if (star == 1) add_cube(0.1, 0.2, 0.3, 2);
            add_star_that_crosses_itself();
            if (star == 0) add_cube(0.1, 0.2, 0.3, 2);
            body_rig_create(&rig, &options, 1);
            if (options.seams != NULL) {
                seams += ends_are_told(star);
            } else { /* with two active vertices, or one */
                assert_int_equal(cscd_detector_set_active(rig.detector, seam, 2), CSCD_OK);
                actives += ends_are_told(star);
            }
        }
    }
    print_message("  %zu seams and %zu active parts leave out the end of a curve\n", seams, actives);
    assert_true(seams > 0 && actives > 0);
}

AROUND_EACH(NULL, body_rigs_free)
