/* Energies that are asked for wrongly: a status and a sentence, and nothing is written. */
#include "cscd/cscd.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { UNTOUCHED = -4711 };

/* A face and a vertex, and all that a call takes; a test changes one thing of it. */
typedef struct wrong_call {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_energy *energy;
    cscd_proximity item;
    cscd_proximities items;
    double x[12], gradient[12], matrix[16 * 9];
    size_t rows[5];
    uint32_t columns[16];
    cscd_energy_pattern pattern;
    cscd_energy_targets targets;
    cscd_energy_options options;
    cscd_energy_sum sum;
} wrong_call;

static void set_pattern(wrong_call *w) {
    for (uint32_t i = 0; i < 16; i++) w->columns[i] = i % 4;
    for (size_t v = 0; v <= 4; v++) w->rows[v] = 4 * v;
    w->pattern = (cscd_energy_pattern){w->rows, w->columns, 16};
    w->targets = (cscd_energy_targets){.gradient = w->gradient, .matrix = w->matrix, .pattern = &w->pattern};
}

static void make_right(wrong_call *w) {
    static const double x[12] = {0.25, 0.25, 0.6, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    const cscd_object_desc points = cscd_object_of_points(4);
    memset(w, 0, sizeof *w);
    w->context = context_of(1, NULL);
    expect_ok(cscd_mesh_create(w->context, &points, 1, &w->mesh));
    expect_ok(cscd_energy_create(w->context, w->mesh, &w->energy));
    w->item = (cscd_proximity){.kind = CSCD_CONTACT_VF, .count = 1, .weight = 1.0, .vertices = {0, 1, 2, 3}};
    cscd_stencil_weights(CSCD_CONTACT_VF, 0.25, 0.25, w->item.weights);
    w->items = (cscd_proximities){&w->item, 1};
    memcpy(w->x, x, sizeof x);
    w->options = cscd_energy_defaults();
    w->options.reach = 1.0;
    w->options.slip = 0.1;
    set_pattern(w);
    for (int i = 0; i < 12; i++) w->gradient[i] = UNTOUCHED;
    for (int i = 0; i < 16 * 9; i++) w->matrix[i] = UNTOUCHED;
    w->sum.value = UNTOUCHED;
}

static void free_call(const wrong_call *w) {
    cscd_energy_destroy(w->energy);
    cscd_mesh_destroy(w->mesh);
    cscd_context_destroy(w->context);
}

static cscd_status evaluate_call(wrong_call *w) {
    return cscd_energy_evaluate(w->energy, &w->items, CSCD_DOUBLES(w->x, 4), &w->options, &w->targets,
                                &w->sum);
}

/* The call fails with a sentence that has these words, and has written nothing. */
static void expect_refused(wrong_call *w, const char *words) {
    assert_int_equal(evaluate_call(w), CSCD_INVALID_ARGUMENT);
    if (strstr(cscd_context_detail(w->context), words) == NULL)
        fail_msg("\"%s\" does not say \"%s\"", cscd_context_detail(w->context), words);
    for (int i = 0; i < 12; i++) assert_true(w->gradient[i] == UNTOUCHED);
    for (int i = 0; i < 16 * 9; i++) assert_true(w->matrix[i] == UNTOUCHED);
    assert_true(w->sum.value == UNTOUCHED);
    free_call(w);
}

#define REFUSED(words, ...)                                                                                  \
    do {                                                                                                     \
        wrong_call w;                                                                                        \
        make_right(&w);                                                                                      \
        __VA_ARGS__;                                                                                         \
        expect_refused(&w, words);                                                                           \
    } while (0)

TEST(what_is_right_is_taken) {
    wrong_call w;
    make_right(&w);
    expect_ok(evaluate_call(&w));
    assert_true(w.sum.value > 0.0 && w.gradient[2] < 0.0 && w.matrix[8] > 0.0);
    free_call(&w);
}

TEST(options_are_checked) {
    REFUSED("reach is 0", w.options.reach = 0.0);
    REFUSED("reach is", w.options.reach = (double)NAN);
    REFUSED("reach is", w.options.reach = -1.0);
    REFUSED("unknown law", w.options.law = 4);
    REFUSED("stiffness is", w.options.stiffness = -1.0);
    REFUSED("stiffness is", w.options.stiffness = INFINITY);
    REFUSED("cscd_energy_defaults", w.options.struct_size = 0);
}

TEST(items_are_checked) {
    REFUSED("items are NULL", w.items.items = NULL);
    REFUSED("a vertex that the mesh does not have", w.item.vertices[3] = 4);
    REFUSED("without an energy", w.item.kind = CSCD_CONTACT_TT);
    REFUSED("without an energy", w.item.kind = 6);
    REFUSED("weights", w.item.weights[1] = -1.5);
    REFUSED("weights", w.item.weights[0] = (double)NAN);
    REFUSED("weights", w.item.weights[2] = -0.5);
    REFUSED("weights", w.item.kind = CSCD_CONTACT_EE);
    REFUSED("weights", w.item.kind = CSCD_CONTACT_VV);
    REFUSED("threshold", w.item.threshold = -1.0);
    REFUSED("a weight below 0", w.item.weight = -1.0);
    REFUSED("a separation below 0", w.item.separation = (double)NAN);
    REFUSED("weights", w.item.weights[1] = -1.5; w.targets = (cscd_energy_targets){NULL});
}

TEST(positions_are_checked) {
    REFUSED("vertex 1", w.x[4] = (double)NAN);
}

TEST(patterns_are_checked) {
    REFUSED("no block for the vertices 3 and 2", w.columns[14] = 3, w.pattern.block_count = 15,
            w.rows[4] = 15);
    REFUSED("pattern is NULL", w.targets.pattern = NULL);
    REFUSED("rows is NULL", w.pattern.rows = NULL);
    REFUSED("columns is NULL", w.pattern.columns = NULL);
    REFUSED("ascending", w.columns[5] = 0);
    REFUSED("ascending", w.columns[15] = 4);
    REFUSED("begin at block 1", w.rows[0] = 1);
    REFUSED("end at 16", w.pattern.block_count = 12);
    REFUSED("from block 8 to 5", w.rows[2] = 8, w.rows[3] = 5);
    REFUSED("of 16", w.rows[1] = 17);
}

static cscd_status freeze_call(wrong_call *w) {
    return cscd_energy_freeze_friction(w->energy, &w->items, CSCD_DOUBLES(w->x, 4), &w->options);
}

TEST(friction_is_checked) {
    wrong_call w;
    make_right(&w);
    const double negative[1] = {-1.0};
    expect_ok(freeze_call(&w));
    w.options.slip = 0.0;
    assert_int_equal(freeze_call(&w), CSCD_INVALID_ARGUMENT);
    w.options.slip = 0.1;
    w.options.friction = -0.5;
    assert_int_equal(freeze_call(&w), CSCD_INVALID_ARGUMENT);
    w.options.friction = 0.5;
    w.options.object_friction = negative;
    assert_int_equal(freeze_call(&w), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(w.context), "object_friction[0] is -1"));
    w.options.object_friction = NULL;
    w.options.item_friction = negative;
    assert_int_equal(freeze_call(&w), CSCD_INVALID_ARGUMENT);
    w.options.item_friction = NULL;
    w.x[2] = 0.0;
    assert_int_equal(freeze_call(&w), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(w.context), "infinite"));
    assert_int_equal(cscd_energy_freeze_friction(w.energy, &w.items, CSCD_DOUBLES(w.x, 4), NULL),
                     CSCD_INVALID_ARGUMENT);
    free_call(&w);
}

TEST(objects_are_checked) {
    wrong_call w;
    make_right(&w);
    cscd_energy *made = NULL;
    assert_int_equal(cscd_energy_create(NULL, w.mesh, &made), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_energy_create(w.context, NULL, &made), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_energy_create(w.context, w.mesh, NULL), CSCD_INVALID_ARGUMENT);
    assert_null(made);
    assert_int_equal(cscd_energy_evaluate(NULL, &w.items, CSCD_DOUBLES(w.x, 4), &w.options, NULL, &w.sum),
                     CSCD_NULL_OBJECT);
    assert_int_equal(cscd_energy_make_pattern(NULL, &w.items, NULL, &w.pattern), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_energy_freeze_friction(NULL, &w.items, CSCD_DOUBLES(w.x, 4), &w.options),
                     CSCD_NULL_OBJECT);
    assert_int_equal(
        cscd_energy_evaluate_friction(NULL, CSCD_DOUBLES(w.x, 4), CSCD_DOUBLES(w.x, 4), NULL, &w.sum),
        CSCD_NULL_OBJECT);
    assert_int_equal(cscd_energy_evaluate(w.energy, &w.items, CSCD_DOUBLES(w.x, 4), &w.options, NULL, NULL),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_energy_evaluate(w.energy, &w.items, NULL, &w.options, NULL, &w.sum),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_energy_make_pattern(w.energy, &w.items, NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(
        cscd_energy_evaluate_friction(w.energy, CSCD_DOUBLES(w.x, 4), CSCD_DOUBLES(w.x, 3), NULL, &w.sum),
        CSCD_INVALID_ARGUMENT);
    cscd_energy_destroy(NULL);
    free_call(&w);
}
