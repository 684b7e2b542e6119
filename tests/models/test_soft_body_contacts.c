/* The response to contacts of a body with itself, on a body of two parts: a slab, and a block that comes
 * down onto it. */
#include "models/common/vec3.h"
#include "models/softbody/softbody.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/models/soft_fixture.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* The block hangs `distance` above the slab's top at rest, farther than the response needs. */
static const double spacing = 0.4, near = 0.8, distance = 1.1;
static const material rubber = {.density = 1.0, .young = 300.0, .poisson = 0.4, .damping = 2.0};

typedef struct two_parts {
    body surface;
    soft_body soft;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    self_contacts contacts;
    double *start;
    uint32_t lowest; /* vertex of the block */
} two_parts;

/* The block is a cube, turned and scaled. */
static body parts_surface(double block[3][3], uint32_t *lowest) {
    body parts = body_of(BODY_CUBE, body_nearest_count(BODY_CUBE, 192)), cube = {0};
    double slab[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.25}};
    const double none[3] = {0.0, 0.0, 0.0};
    body_append(&cube, &parts, none);
    affine_map(slab, (double[3]){0.0, 0.0, -0.25}, parts.positions, parts.vertex_count, parts.positions);
    affine_map(block, (double[3]){0.13, 0.07, 0.0}, cube.positions, cube.vertex_count, cube.positions);
    uint32_t low = 0;
    for (uint32_t v = 0; v < cube.vertex_count; v++)
        low = cube.positions[v * 3 + 2] < cube.positions[low * 3 + 2] ? v : low;
    *lowest = parts.vertex_count + low;
    body_append(&parts, &cube, (double[3]){0.0, 0.0, distance - cube.positions[low * 3 + 2]});
    body_free(&cube);
    return parts;
}

static two_parts make_parts(double block[3][3]) {
    two_parts p = {0};
    p.surface = parts_surface(block, &p.lowest);
    const cscd_object_desc desc =
        cscd_object_of_triangles(p.surface.vertex_count, p.surface.triangle_count, p.surface.triangles);
    p.soft = soft_body_of(&p.surface, spacing, &rubber);
    p.start = body_allocate(p.surface.vertex_count, 3 * sizeof *p.start);
    assert_int_equal(cscd_context_create(NULL, &p.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(p.context, &desc, 1, &p.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(p.mesh, NULL, NULL, &p.detector), CSCD_OK);
    p.contacts = self_contacts_make(p.mesh, p.surface.positions, near);
    return p;
}

static void free_parts(two_parts *p) {
    self_contacts_free(&p->contacts);
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
    soft_body_free(&p->soft);
    body_free(&p->surface);
    free(p->start);
}

/* Makes a block that stands on its corner, or flat and turned so that no edges are parallel. */
static two_parts make_corner(void) {
    double turn[3][3];
    rotation_matrix((double[3]){1.0, -1.0, 0.1}, 0.955, turn);
    for (int i = 0; i < 9; i++) turn[i / 3][i % 3] *= 0.5;
    return make_parts(turn);
}

static two_parts make_flat(void) {
    double turn[3][3];
    rotation_matrix((double[3]){0.02, 0.01, 1.0}, 0.3, turn);
    for (int i = 0; i < 9; i++) turn[i / 3][i % 3] *= 0.5;
    return make_parts(turn);
}

static bool is_of_block(const two_parts *p, uint32_t node) {
    return p->soft.frame.rest[node * 3 + 2] > 0.5 * distance;
}

/* Places the block at rest at this height above the slab, or below 0 inside it. */
static void place_block(two_parts *p, double above, double x, double y) {
    lattice *l = &p->soft.frame;
    for (uint32_t n = 0; n < l->node_count; n++) {
        double *node = p->soft.nodes + n * 3;
        memcpy(node, l->rest + n * 3, 3 * sizeof *node);
        node[2] += soft_fixture_height;
        if (is_of_block(p, n)) vec3_add_scaled(node, 1.0, (double[3]){x, y, above - distance});
    }
    memcpy(p->soft.previous, p->soft.nodes, l->node_count * 3 * sizeof *p->soft.previous);
    lattice_place_vertices(l, p->soft.nodes, p->soft.vertices);
}

static cscd_contacts find_contacts(two_parts *p, const double *start, const double *end) {
    cscd_contacts found;
    assert_int_equal(step_packed(p->detector, start, end, &found), CSCD_OK);
    return found;
}

/* Moves the block from one height to another; returns the number of contacts that the detector found. */
static size_t move_block(two_parts *p, double from, double to) {
    place_block(p, from, 0.0, 0.0);
    memcpy(p->start, p->soft.vertices, (size_t)p->surface.vertex_count * 3 * sizeof *p->start);
    place_block(p, to, 0.0, 0.0);
    cscd_contacts found = find_contacts(p, p->start, p->soft.vertices);
    self_contacts_add(&p->contacts, &found, p->start, p->soft.vertices);
    return found.count;
}

static double height_above_slab(const two_parts *p) {
    return p->soft.vertices[p->lowest * 3 + 2] - soft_fixture_height;
}

TEST(pairs_are_taken_up_on_the_way_in) {
    two_parts p = make_corner();
    assert_int_equal(move_block(&p, 0.03, 0.01), 0);
    assert_int_equal(p.contacts.count, 0);
    assert_int_equal(move_block(&p, 0.01, -0.01), 1);
    assert_int_equal(p.contacts.count, 1);
    assert_int_equal(p.contacts.pairs[0].kind, CSCD_CONTACT_VF);
    assert_int_equal(p.contacts.pairs[0].a, p.lowest);
    assert_int_equal(move_block(&p, 0.01, -0.01), 1); /* once is enough */
    assert_int_equal(p.contacts.count, 1);
    free_parts(&p);
}

TEST(pairs_on_the_way_out_are_left) {
    two_parts corner = make_corner(), flat = make_flat();
    assert_int_equal(move_block(&corner, -0.01, 0.01), 1);
    assert_int_equal(corner.contacts.count, 0);
    assert_true(move_block(&flat, -0.05, 0.01) > 10);
    assert_int_equal(flat.contacts.count, 0);
    free_parts(&corner);
    free_parts(&flat);
}

/* The corner leaves through the lower side of the slab. It was inside before, so the response ignores it. */
TEST(pairs_from_the_inside_are_left) {
    two_parts p = make_corner();
    place_block(&p, -0.49, 0.0, 0.0);
    memcpy(p.start, p.soft.vertices, (size_t)p.surface.vertex_count * 3 * sizeof *p.start);
    place_block(&p, -0.51, 0.0, 0.0);
    cscd_contacts found = find_contacts(&p, p.start, p.soft.vertices);
    uint32_t leaving = 0;
    for (size_t i = 0; i < found.count; i++)
        leaving += found.items[i].kind == CSCD_CONTACT_VF && found.items[i].a == p.lowest;
    assert_int_equal(leaving, 1);
    self_contacts_add(&p.contacts, &found, p.start, p.soft.vertices);
    for (size_t i = 0; i < p.contacts.count; i++)
        assert_true(p.contacts.pairs[i].kind == CSCD_CONTACT_EE || p.contacts.pairs[i].a != p.lowest);
    free_parts(&p);
}

TEST(pairs_are_sorted_and_single) {
    two_parts p = make_flat();
    size_t found = move_block(&p, 0.005, -0.05), kinds[2] = {0, 0};
    found += move_block(&p, 0.006, -0.06);
    assert_true(p.contacts.count > 10 && p.contacts.count < found);
    for (size_t i = 0; i < p.contacts.count; i++) {
        const held_pair *now = &p.contacts.pairs[i], *last = now - 1;
        kinds[now->kind]++;
        if (i == 0) continue;
        assert_true(
            last->kind < now->kind ||
            (last->kind == now->kind && (last->a < now->a || (last->a == now->a && last->b < now->b))));
    }
    assert_true(kinds[CSCD_CONTACT_VF] > 0 && kinds[CSCD_CONTACT_EE] > 0);
    free_parts(&p);
}

/* Pairs that are near at rest are left to the lattice. */
TEST(near_pairs_are_ignored) {
    two_parts p = make_flat();
    self_contacts_free(&p.contacts);
    p.contacts = self_contacts_make(p.mesh, p.surface.positions, 4.0);
    assert_true(move_block(&p, 0.01, -0.05) > 10);
    assert_int_equal(p.contacts.count, 0);
    free_parts(&p);
}

TEST(pairs_are_kept_until_they_part_or_are_lost) {
    two_parts p = make_corner();
    const double gap = p.contacts.gap, depth = p.contacts.depth;
    const double heights[] = {-0.5 * gap, 0.5 * gap, 1.9 * gap, 2.1 * gap, -0.95 * depth, -1.05 * depth};
    const size_t kept[] = {1, 1, 1, 0, 1, 0};
    for (int i = 0; i < 6; i++) {
        move_block(&p, 0.01, -0.01);
        assert_int_equal(p.contacts.count, 1);
        place_block(&p, heights[i], 0.0, 0.0);
        self_contacts_solve(&p.contacts, &p.soft);
        assert_int_equal(p.contacts.count, kept[i]);
    }
    free_parts(&p);
}

/* Pairs that are too near are moved apart without gaining speed: nodes and previous nodes move alike. */
TEST(healing_gives_no_velocity) {
    two_parts p = make_corner();
    move_block(&p, 0.01, -0.01);
    double last = height_above_slab(&p);
    for (int i = 0; i < 10; i++) {
        self_contacts_solve(&p.contacts, &p.soft);
        lattice_place_vertices(&p.soft.frame, p.soft.nodes, p.soft.vertices);
        assert_true(height_above_slab(&p) > last && height_above_slab(&p) <= last + p.contacts.healing);
        assert_true(largest_distance(p.soft.nodes, p.soft.previous, p.soft.frame.node_count) < 1e-14);
        last = height_above_slab(&p);
    }
    free_parts(&p);
}

/* Pairs farther apart than the gap are not pushed. */
TEST(pairs_apart_are_left_alone) {
    two_parts p = make_corner();
    move_block(&p, 0.01, -0.01);
    place_block(&p, 1.5 * p.contacts.gap, 0.0, 0.0);
    double *nodes = body_allocate(p.soft.frame.node_count, 3 * sizeof *nodes);
    memcpy(nodes, p.soft.nodes, p.soft.frame.node_count * 3 * sizeof *nodes);
    self_contacts_solve(&p.contacts, &p.soft);
    assert_int_equal(p.contacts.count, 1);
    assert_memory_equal(nodes, p.soft.nodes, p.soft.frame.node_count * 3 * sizeof *nodes);
    free(nodes);
    free_parts(&p);
}

static bool is_above(const two_parts *p, uint32_t vertex, uint32_t triangle) {
    uint32_t v[3];
    const double *at = p->soft.vertices + vertex * 3;
    cscd_mesh_triangle(p->mesh, triangle, v);
    for (int i = 0; i < 3; i++) {
        const double *from = p->soft.vertices + v[i] * 3, *to = p->soft.vertices + v[(i + 1) % 3] * 3;
        if ((to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]) < -1e-9)
            return false;
    }
    return true;
}

/* The block slides over the slab: the pair of its corner always has the triangle below. */
TEST(pairs_follow_a_sliding_vertex) {
    two_parts p = make_corner();
    uint32_t visited = 1;
    move_block(&p, 0.01, -0.01);
    for (int i = 1; i <= 40; i++) {
        uint32_t last = p.contacts.pairs[0].b;
        place_block(&p, 1.5 * p.contacts.gap, 0.017 * i, -0.009 * i);
        for (int k = 0; k < 3; k++) self_contacts_solve(&p.contacts, &p.soft);
        assert_int_equal(p.contacts.count, 1);
        assert_int_equal(p.contacts.pairs[0].a, p.lowest);
        assert_true(is_above(&p, p.lowest, p.contacts.pairs[0].b));
        visited += p.contacts.pairs[0].b != last;
    }
    assert_true(visited >= 3);
    free_parts(&p);
}

/* ---- in motion ---- */

static void throw_block(two_parts *p, const double velocity[3]) {
    for (uint32_t n = 0; n < p->soft.frame.node_count; n++)
        memcpy(p->soft.velocities + n * 3, is_of_block(p, n) ? velocity : (double[3]){0.0, 0.0, 0.0},
               3 * sizeof *velocity);
}

static uint32_t count_intersections(two_parts *p) {
    cscd_intersections intersections;
    assert_int_equal(check_packed(p->detector, p->soft.vertices, &intersections), CSCD_OK);
    return (uint32_t)intersections.count;
}

/* Runs an interval as the recorder does, with or without a response. */
static void run_interval(two_parts *p, bool responds) {
    obstacles nothing = {0};
    memcpy(p->start, p->soft.vertices, (size_t)p->surface.vertex_count * 3 * sizeof *p->start);
    simulation_advance(&p->soft, &nothing, responds ? &p->contacts : NULL, 1.0 / 80.0, 10);
    cscd_contacts found = find_contacts(p, p->start, p->soft.vertices);
    if (responds) self_contacts_add(&p->contacts, &found, p->start, p->soft.vertices);
}

/* The parts touch, hold each other off and part. Momentum is kept. Kinetic energy is never gained, but the
 * push deforms the parts, which costs a few per cent here. In the end there are no intersections. */
static void check_bounce(two_parts *p) {
    size_t most_pairs = 0;
    uint32_t crossing_at_end = 1;
    place_block(p, 0.05, 0.0, 0.0);
    throw_block(p, (double[3]){0.2, 0.0, -1.5});
    soft_momentum before = soft_momentum_of(&p->soft);
    double start = soft_body_energy(&p->soft, 0.0), most_energy = start;
    for (int i = 0; i < 80; i++) {
        run_interval(p, true);
        most_energy = fmax(most_energy, soft_body_energy(&p->soft, 0.0));
        most_pairs = p->contacts.count > most_pairs ? p->contacts.count : most_pairs;
        crossing_at_end = count_intersections(p);
    }
    soft_momentum after = soft_momentum_of(&p->soft);
    double lost[3];
    vec3_subtract(after.linear, before.linear, lost);
    print_message("up to %zu pairs; energy at most %.3f of the start's, %.3f in the end\n", most_pairs,
                  most_energy / start, soft_body_energy(&p->soft, 0.0) / start);
    assert_true(vec3_norm(lost) < 1e-9 * vec3_norm(before.linear));
    assert_true(most_pairs > 0 && p->contacts.count == 0);
    assert_true(most_energy < 1.08 * start && soft_body_energy(&p->soft, 0.0) < start);
    assert_int_equal(crossing_at_end, 0);
}

TEST(parts_bounce_off_each_other) {
    two_parts corner = make_corner(), flat = make_flat();
    check_bounce(&corner);
    check_bounce(&flat);
    free_parts(&corner);
    free_parts(&flat);
}

/* Without the response the block goes into the slab. */
TEST(without_a_response_parts_intersect) {
    two_parts p = make_flat();
    place_block(&p, 0.05, 0.0, 0.0);
    throw_block(&p, (double[3]){0.2, 0.0, -1.5});
    for (int i = 0; i < 10; i++) run_interval(&p, false);
    assert_true(count_intersections(&p) > 0);
    assert_true(height_above_slab(&p) < -0.1);
    free_parts(&p);
}
