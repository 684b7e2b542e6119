/* Closed components of one object that lie in each other: which are bodies, which are cavities of what is around them, and what is taken as
 * turned around, by hand. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <string.h>

static body_rig rig; /* large; one test at a time */

enum { CUBE = 12 }; /* triangles */

static void add_cube(double x, double size) {
    const double low[3] = {x, x, x}, sizes[3] = {size, size, size};
    body_rig_add_box(&rig, low, sizes);
}

/* Cubes of sizes 4, 2 and 1, each in the one before, in one object or as parts of their own; and a small cube in the middle, an
 * object of its own. */
static void make_nested(uint32_t shells, int inverted, bool parts, int axis) {
    body_rig_begin(&rig);
    const double size[3] = {4, 2, 1};
    for (uint32_t i = 0; i < shells; i++) add_cube(-0.5 * size[i], size[i]);
    body_rig_end_body(&rig);
    add_cube(-0.125, 0.25);
    body_rig_end_body(&rig);
    body_rig_place(&rig, axis, false, 1.0);
    for (uint32_t i = 0; i < shells; i++) {
        if ((inverted >> i & 1) != 0) body_rig_turn(&rig, i * CUBE, CUBE);
    }
    body_rig_create(&rig, NULL, 2);
    uint32_t labels[4 * CUBE];
    for (uint32_t t = 0; t < 4 * CUBE; t++) labels[t] = t / CUBE;
    if (parts || inverted % 2 == 1) /* by object, parts do not matter */
        expect_ok(cscd_detector_set_parts(rig.detector, labels, 4));
    if (parts) rig.orientation = CSCD_ORIENTATION_BY_PART;
    body_rig_find(&rig);
}

/* The number of the object of the shells around the small cube. */
static int number_in_the_middle(uint32_t shells) {
    const cscd_patch *patch = &rig.found.patches->items[shells];
    assert_int_equal(patch->object, 1);
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        cscd_winding w = rig.found.patches->windings[patch->first_winding + i];
        if (w.body == 0) return w.number;
    }
    return 0;
}

/* By hand: what each of up to three shells is, from the outermost one, where + is outwards. A B is a body, which is turned around if it
 * is a -; a c is a cavity of the B before it, and turned with it. */
static const struct {
    const char *senses, *roles;
} nestings[] = {
    {"+", "B"},     {"-", "B"},     {"++", "BB"},   {"+-", "Bc"},   {"-+", "Bc"},
    {"--", "BB"},   {"+++", "BBB"}, {"++-", "BBc"}, {"+-+", "BcB"}, {"+--", "BcB"},
    {"-++", "BcB"}, {"-+-", "BcB"}, {"--+", "BBc"}, {"---", "BBB"},
};

static int read_inverted(const char *senses) {
    int inverted = 0;
    for (int i = 0; senses[i] != '\0'; i++) inverted |= (senses[i] == '-') << i;
    return inverted;
}

TEST(shells_keep_their_sense) {
    for (size_t n = 0; n < sizeof nestings / sizeof *nestings; n++) {
        const char *senses = nestings[n].senses, *roles = nestings[n].roles;
        const uint32_t shells = (uint32_t)strlen(senses);
        int number = 0;
        make_nested(shells, read_inverted(senses), false, (int)n % 3);
        for (uint32_t i = 0; i < shells; i++) {
            assert_int_equal(body_rig_is_turned(&rig, i), senses[roles[i] == 'c' ? i - 1 : i] == '-');
            number += roles[i] == 'c' ? -1 : 1;
        }
        assert_int_equal(number_in_the_middle(shells), number);
    }
}

/* The same shells in an object of their own, each of no part, from the outermost one or from the innermost one: a cavity has the body of
 * what it is a cavity of. */
TEST(cavities_belong_to_what_is_around_them) {
    for (size_t n = 0; n < 4 * sizeof nestings / sizeof *nestings; n++) {
        const char *senses = nestings[n / 4].senses, *roles = nestings[n / 4].roles;
        const uint32_t shells = (uint32_t)strlen(senses);
        const bool inner_first = n % 4 >= 2;
        body_rig_begin(&rig);
        for (uint32_t i = 0; i < shells; i++) {
            const double size = 1 << (inner_first ? i : shells - 1 - i);
            add_cube(-0.5 * size, size);
        }
        body_rig_end_body(&rig);
        for (uint32_t i = 0; i < shells; i++)
            if (senses[inner_first ? shells - 1 - i : i] == '-') body_rig_turn(&rig, i * CUBE, CUBE);
        body_rig_create(&rig, NULL, 2);
        rig.part_bodies = true;
        rig.orientation = n % 2 == 0 ? CSCD_ORIENTATION_BY_OBJECT : CSCD_ORIENTATION_AS_GIVEN;
        assert_int_equal(cscd_detector_body_labels(rig.detector, NULL), shells);
        for (int call = 0; call < 2; call++) { /* which keep nothing of each other */
            body_rig_find(&rig);
            for (uint32_t i = 0; i < shells; i++) {
                const uint32_t depth = inner_first ? shells - 1 - i : i, outer = inner_first ? i + 1 : i - 1;
                assert_int_equal(rig.found.patches->items[i].body, roles[depth] == 'c' ? outer : i);
            }
        }
    }
}

/* What is of another part is no cavity, whatever is asked about orientation; and parts join what comes after a component of none. */
TEST(bodies_go_by_parts) {
    static const uint32_t parts[][3] = {{0, 1, 2}, {UINT32_MAX, 0, 0}, {0, UINT32_MAX, 0}, {1, 1, 1}},
                          bodies[][3] = {{0, 1, 2}, {0, 1, 1}, {0, 1, 0}, {0, 0, 0}};
    static const char *const turned[] = {".t.", ".tt", ".t.", "..."};
    for (size_t n = 0; n < sizeof parts / sizeof *parts; n++) {
        make_nested(3, 2, false,
                    (int)n %
                        3); /* outwards, inwards, outwards: of one part, the last is a cavity of the second */
        rig.part_bodies = true;
        uint32_t labels[4 * CUBE], told[4 * CUBE];
        for (uint32_t t = 0; t < 4 * CUBE; t++) labels[t] = t < 3 * CUBE ? parts[n][t / CUBE] : UINT32_MAX;
        expect_ok(cscd_detector_set_parts(rig.detector, labels, 3));
        cscd_detector_body_labels(rig.detector, told);
        body_rig_find(&rig);
        for (uint32_t i = 0; i < 3; i++) {
            assert_int_equal(told[i * CUBE], bodies[n][i]);
            assert_int_equal(rig.found.patches->items[i].body, bodies[n][i]);
            assert_int_equal(body_rig_is_turned(&rig, i), turned[n][i] == 't');
        }
    }
}

/* A cavity that touches its hull along one side, or all of one face, whichever of the two comes first. */
TEST(cavities_may_touch_their_hull) {
    for (int round = 0; round < 12; round++) {
        const bool inner_first = round % 2 == 1, flush = round % 4 >= 2;
        body_rig_begin(&rig);
        for (int i = 0; i < 2; i++) {
            const double size[3] = {1.0, 1.0, 1.0}, low[3] = {flush ? 0.0 : 0.5, 1.0, 1.0};
            if ((i == 0) == inner_first)
                body_rig_add_box(&rig, low, size);
            else
                add_cube(0.0, 4.0);
        }
        body_rig_end_body(&rig);
        body_rig_turn(&rig, inner_first ? 0 : CUBE, CUBE);
        if (!flush) rig.all.x0[inner_first ? 0 : 8 * 3] = 0.0; /* one corner of the cavity is in the wall */
        body_rig_place(&rig, round % 3, false, 1.0);
        body_rig_create(&rig, NULL, 1);
        rig.part_bodies = true;
        body_rig_find(&rig);
        assert_true(rig.found.touching + rig.found.coplanar > 0 && rig.found.crossing == 0);
        assert_true(!body_rig_is_turned(&rig, 0) && !body_rig_is_turned(&rig, 1));
        for (size_t i = 0; i < rig.found.patches->count; i++)
            assert_int_equal(rig.found.patches->items[i].body, inner_first ? 1 : 0);
        for (size_t i = 0; i < rig.found.depths->count; i++)
            assert_true(rig.found.depths->items[i].depth == 0.0);
    }
}

static double greatest_depth(void) {
    double most = -1.0;
    for (size_t i = 0; i < rig.found.depths->count; i++) {
        const double depth = rig.found.depths->items[i].depth;
        if (depth > most) most = depth;
    }
    return most;
}

/* A hull from -3 to 3, its cavity from -2 to 2, and a box that crosses the cavity's wall, in each order. A small box reaches 0.5 into the
 * wall; if it has the cavity's sense it is a body all the same, turned around: two cavities do not cross. A large one encloses more
 * than the cavity, which stays one, as the box has the hull's sense. */
TEST(what_crosses_its_cavity_is_a_body) {
    static const uint8_t orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    static const double low[2][3] = {{1.25, -0.5, -0.5}, {-2.5, -2.5, -2.5}},
                        size[2][3] = {{1.25, 1, 1}, {5, 5, 4}};
    for (int round = 0; round < 8 * 6; round++) {
        const bool large = round / 4 % 2 == 1, hull_inverted = round / 2 % 2 == 1,
                   box_inverted = large ? hull_inverted : round % 2 == 1;
        const uint8_t *order = orders[round / 8]; /* of hull, cavity and box: their places */
        body_rig_begin(&rig);
        for (uint32_t place = 0; place < 3; place++) {
            if (order[2] == place)
                body_rig_add_box(&rig, low[large], size[large]);
            else
                add_cube(order[0] == place ? -3 : -2, order[0] == place ? 6 : 4);
        }
        body_rig_end_body(&rig);
        if (box_inverted) body_rig_turn(&rig, order[2] * CUBE, CUBE);
        body_rig_turn(&rig, order[hull_inverted ? 0 : 1] * CUBE, CUBE);
        body_rig_place(&rig, round % 3, false, 1.0);
        body_rig_create(&rig, NULL, 1);
        rig.part_bodies = true;
        body_rig_find(&rig);
        assert_true(rig.found.crossing > 0 && (large || greatest_depth() == 0.5));
        for (uint32_t i = 0; i < 2; i++) assert_int_equal(body_rig_is_turned(&rig, order[i]), hull_inverted);
        assert_int_equal(body_rig_is_turned(&rig, order[2]), box_inverted);
        for (size_t i = 0; i < rig.found.patches->count; i++) {
            const cscd_patch *patch = &rig.found.patches->items[i];
            assert_int_equal(patch->body, order[patch->component == order[2] ? 2 : 0]);
        }
    }
}

/* Two hollow bodies that cross so far that their cavities cross, too: each stays the cavity of its own body. */
TEST(cavities_of_two_bodies_may_cross) {
    body_rig_begin(&rig);
    for (int i = 0; i < 2; i++) {
        add_cube(2 * i - 3, 6);
        add_cube(2 * i - 2, 4);
    }
    body_rig_end_body(&rig);
    body_rig_turn(&rig, CUBE, CUBE);
    body_rig_turn(&rig, 3 * CUBE, CUBE);
    body_rig_create(&rig, NULL, 1);
    rig.part_bodies = true;
    body_rig_find(&rig);
    for (uint32_t i = 0; i < 4; i++) assert_false(body_rig_is_turned(&rig, i));
    for (size_t i = 0; i < rig.found.patches->count; i++) {
        const cscd_patch *patch = &rig.found.patches->items[i];
        assert_int_equal(patch->body, patch->component / 2 * 2);
    }
}

/* The first triangle of a cube becomes its last one. */
static void rotate_triangles(uint32_t cube) {
    uint32_t *first = rig.all.triangles + (size_t)cube * 3, kept[3];
    memcpy(kept, first, sizeof kept);
    memmove(first, first + 3, 3 * (CUBE - 1) * sizeof *first);
    memcpy(first + 3 * (CUBE - 1), kept, sizeof kept);
    body_rig_turn(&rig, 0, 0); /* tells the bodies */
}

/* Two that cross, one of them inside out, although no pair of their triangles is looked at: neither lies in the other. */
TEST(left_out_pairs_make_no_cavity) {
    static uint32_t ignored[2 * CUBE * CUBE];
    cscd_detector_options options = cscd_detector_defaults();
    body_rig_begin(&rig);
    add_cube(0.0, 2.0);
    add_cube(1.0, 2.0);
    body_rig_end_body(&rig);
    body_rig_turn(&rig, CUBE, CUBE);
    for (uint32_t i = 0; i < CUBE * CUBE; i++) {
        ignored[2 * i] = i / CUBE;
        ignored[2 * i + 1] = CUBE + i % CUBE;
    }
    options.ignored = ignored;
    options.ignored_count = CUBE * CUBE;
    for (uint32_t turn = 0; turn < CUBE * CUBE; turn++) { /* each two triangles come first once */
        rotate_triangles(turn % CUBE == 0 ? 0 : CUBE);
        body_rig_create(&rig, &options, 1);
        rig.part_bodies = true;
        body_rig_find(&rig);
        assert_int_equal(rig.found.count, 0);
        assert_true(!body_rig_is_turned(&rig, 0) && body_rig_is_turned(&rig, 1));
    }
}

TEST(parts_are_bodies_of_their_own) {
    for (uint32_t shells = 1; shells <= 3; shells++) {
        for (int inverted = 0; inverted < 1 << shells; inverted++) {
            make_nested(shells, inverted, true, inverted % 3);
            for (uint32_t i = 0; i < shells; i++)
                assert_int_equal(body_rig_is_turned(&rig, i), (inverted >> i & 1) != 0);
            assert_int_equal(number_in_the_middle(shells), (int)shells);
        }
    }
}

/* One component of a part each, but the outer one has both parts: the inner one is a shell of it. */
TEST(a_shell_of_a_skin_with_limbs) {
    make_nested(2, 2, true, 0);
    uint32_t labels[3 * CUBE];
    for (uint32_t t = 0; t < 3 * CUBE; t++) labels[t] = t < 5 ? 0 : t < 2 * CUBE ? 1 : 2;
    expect_ok(cscd_detector_set_parts(rig.detector, labels, 3));
    body_rig_find(&rig);
    assert_true(!body_rig_is_turned(&rig, 0) && !body_rig_is_turned(&rig, 1));
    assert_int_equal(number_in_the_middle(2), 0);
}

AROUND_EACH(NULL, body_rigs_free)
