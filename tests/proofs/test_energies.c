/* What every call promises (tests/support/proofs/proof.h), of energies of near pairs. */
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* A list of near pairs, which the detector's next call would overwrite, and what is written. */
typedef struct proof_energies {
    cscd_proximities near;
    cscd_proximity *items;
    cscd_energy_pattern pattern;
    double gradient[SCENE_VERTICES_MAX * 3];
    double *blocks, *matrix;
} proof_energies;

static cscd_energy_options options_of(const proof *p) {
    cscd_energy_options options = cscd_energy_defaults();
    options.reach = p->large ? 0.05 : 0.3;
    options.friction = 0.5;
    options.slip = 1e-3;
    return options;
}

static void open_energies(proof *p) {
    proof_energies *own = calloc(1, sizeof *own);
    assert_non_null(own);
    p->own = own;
    open_detector(p);
}

static void close_energies(proof *p) {
    proof_energies *own = p->own;
    free(own->items);
    free(own->blocks);
    free(own->matrix);
    free(own);
}

static cscd_status find_items(proof *p) {
    cscd_view x;
    return cscd_detector_find_near(p->detector, at_moment(p, 1, &x), options_of(p).reach, CSCD_NEAR_UNIQUE,
                                   &p->answer.near);
}

static void keep_items(proof *p) {
    proof_energies *own = p->own;
    own->near.count = p->answer.near.count;
    own->items = malloc((own->near.count + 1) * sizeof *own->items);
    own->blocks = malloc((own->near.count + 1) * 144 * sizeof *own->blocks);
    assert_true(own->items != NULL && own->blocks != NULL);
    if (own->near.count > 0) memcpy(own->items, p->answer.near.items, own->near.count * sizeof *own->items);
    own->near.items = own->items;
    read_near(p);
}

static cscd_status create_energy(proof *p) {
    return cscd_energy_create(p->context, p->mesh, &p->answer.energy);
}

static void keep_energy(proof *p) {
    p->energy = p->answer.energy;
}

static cscd_status make_pattern(proof *p) {
    const proof_energies *own = p->own;
    return cscd_energy_make_pattern(p->energy, &own->near, NULL, &p->answer.pattern);
}

static void keep_pattern(proof *p) {
    proof_energies *own = p->own;
    const cscd_energy_pattern *made = &p->answer.pattern;
    own->pattern = *made;
    own->matrix = realloc(own->matrix, made->block_count * 9 * sizeof *own->matrix);
    assert_non_null(own->matrix);
    proof_add_items(p, made->rows, p->shape.vertex_count + 1, sizeof *made->rows);
    proof_add_items(p, made->columns, made->block_count, sizeof *made->columns);
}

static cscd_energy_targets targets_of(proof_energies *own) {
    return (cscd_energy_targets){.gradient = own->gradient,
                                 .blocks = own->blocks,
                                 .matrix = own->matrix,
                                 .pattern = &own->pattern,
                                 .project = true};
}

static cscd_status evaluate_energy(proof *p) {
    proof_energies *own = p->own;
    const cscd_energy_options options = options_of(p);
    const cscd_energy_targets targets = targets_of(own);
    cscd_view x;
    return cscd_energy_evaluate(p->energy, &own->near, at_moment(p, 1, &x), &options, &targets,
                                &p->answer.energy_sum);
}

static cscd_status freeze_friction(proof *p) {
    const proof_energies *own = p->own;
    const cscd_energy_options options = options_of(p);
    cscd_view x;
    return cscd_energy_freeze_friction(p->energy, &own->near, at_moment(p, 1, &x), &options);
}

static cscd_status evaluate_friction(proof *p) {
    proof_energies *own = p->own;
    const cscd_energy_targets targets = targets_of(own);
    cscd_view x0, x1;
    return cscd_energy_evaluate_friction(p->energy, at_moment(p, 0, &x0), at_moment(p, 1, &x1), &targets,
                                         &p->answer.energy_sum);
}

static void read_sum(proof *p) {
    const proof_energies *own = p->own;
    proof_add(p, &p->answer.energy_sum, sizeof p->answer.energy_sum);
    proof_add_items(p, own->gradient, (size_t)p->shape.vertex_count * 3, sizeof *own->gradient);
    proof_add_items(p, own->blocks, own->near.count * 144, sizeof *own->blocks);
    proof_add_items(p, own->matrix, own->pattern.block_count * 9, sizeof *own->matrix);
}

static const proof_call near_items = {"detector_find_near", PROOF_BEGINS, find_items, keep_items};
static const proof_call energy_made = {"energy_create", PROOF_CREATES, create_energy, keep_energy};
static const proof_call pattern_made = {"energy_make_pattern", PROOF_BEGINS, make_pattern, keep_pattern};
static const proof_call evaluated = {"energy_evaluate", PROOF_ASKS, evaluate_energy, read_sum};
static const proof_call frozen = {"energy_freeze_friction", PROOF_CHANGES, freeze_friction, NULL};
static const proof_call rubbed = {"energy_evaluate_friction", PROOF_ASKS, evaluate_friction, read_sum};

#define ENERGIES                                                                                             \
    { &near_items, &energy_made, &pattern_made, &evaluated, &frozen, &pattern_made, &rubbed, &evaluated }
static const proof_row rows[] = {
    {"energies", ENERGIES, open_energies, close_energies, .family = SCENE_TWO_SPHERES, .seed = 1},
    {"energies_of_one_object", ENERGIES, open_energies, close_energies, .family = SCENE_SOUP, .seed = 3},
};

PROOFS(rows)
