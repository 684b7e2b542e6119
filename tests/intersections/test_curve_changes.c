/* Changes of curves at contacts: every point of a curve that comes or goes in an interval has a contact, and each contact
 * names the points of which it is a cause. Events are those of polynomials on grids, and of the curves of bodies. */
#include "tests/support/counting_allocator.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/intersections/event_oracle.h"
#include "tests/support/packed.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the lists against one another --------------------------------------------------------------------- */

static bool is_cause(const cscd_mesh *mesh, const cscd_contact *c, uint32_t edge, uint32_t triangle) {
    uint32_t ends[2], sides[3];
    cscd_mesh_edge(mesh, edge, ends);
    cscd_mesh_triangle_edges(mesh, triangle, sides);
    if (c->kind == CSCD_CONTACT_VF) return c->b == triangle && (c->a == ends[0] || c->a == ends[1]);
    uint32_t other = c->a == edge ? c->b : c->a;
    return (c->a == edge || c->b == edge) && (other == sides[0] || other == sides[1] || other == sides[2]);
}

/* The causes of a change are all contacts of its features, by toi. */
static void check_causes(const cscd_mesh *mesh, const cscd_contact *contacts, size_t contact_count,
                         const cscd_curve_changes *changes, const cscd_curve_change *change) {
    const size_t *causes = changes->causes + change->first_cause;
    size_t expected = 0;
    for (size_t i = 0; i < contact_count; i++)
        expected += is_cause(mesh, &contacts[i], change->edge, change->triangle);
    assert_int_equal(change->cause_count, expected);
    assert_true(expected > 0);
    for (size_t i = 0; i < change->cause_count; i++) {
        assert_true(is_cause(mesh, &contacts[causes[i]], change->edge, change->triangle));
        if (i == 0) continue;
        double before = contacts[causes[i - 1]].toi, now = contacts[causes[i]].toi;
        assert_true(before < now || (before == now && causes[i - 1] < causes[i]));
    }
}

/* The list by contact is that by change, the other way round. */
static void check_inverse(const cscd_curve_changes *changes, size_t contact_count) {
    assert_int_equal(changes->contact_first[0], 0);
    assert_int_equal(changes->contact_first[contact_count], changes->cause_count);
    for (size_t i = 0; i < contact_count; i++) {
        for (size_t k = changes->contact_first[i]; k < changes->contact_first[i + 1]; k++) {
            const cscd_curve_change *change = &changes->items[changes->of_contacts[k]];
            bool listed = false;
            for (size_t j = 0; j < change->cause_count; j++)
                listed |= changes->causes[change->first_cause + j] == i;
            assert_true(listed);
            assert_true(k == changes->contact_first[i] ||
                        changes->of_contacts[k - 1] < changes->of_contacts[k]);
        }
    }
}

/* ---- grids ----------------------------------------------------------------------------------------------- */

typedef struct change_totals {
    size_t coming, going, with_several_causes, contacts_without_change;
} change_totals;

/* Some vertices stay, some go a step along an axis, and some go anywhere. */
static void move_vertices(random_stream *random, const grid_scene *s, double *out) {
    memcpy(out, s->positions, sizeof s->positions);
    uint32_t moving = 1 + stream_below(random, 3);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (stream_below(random, 3) >= moving) continue;
        if (stream_below(random, 2) == 0)
            out[v * 3 + stream_below(random, 3)] += (double)stream_below(random, 3) - 1.0;
        else
            for (uint32_t k = 0; k < 3; k++) out[v * 3 + k] = stream_below(random, 5);
    }
}

/* The first object stays, the second one moves as a whole. */
static void move_object(random_stream *random, const grid_scene *s, double *out) {
    memcpy(out, s->positions, sizeof s->positions);
    for (uint32_t k = 0; k < 3; k++) {
        double way = (double)stream_below(random, 7) - 3.0;
        for (uint32_t v = s->shapes[0].vertex_count; v < s->vertex_count; v++) out[v * 3 + k] += way;
    }
}

static cscd_detector *make_detector(const grid_scene *s, cscd_method method) {
    uint32_t seams[2 * EPSILON_NAMES];
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    options.method = method;
    options.seams = seams;
    options.seam_reach = INFINITY;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (s->names[v] == v) continue;
        seams[2 * options.seam_count] = s->names[v];
        seams[2 * options.seam_count++ + 1] = v;
    }
    expect_ok(cscd_detector_create(s->context, s->mesh, NULL, &options, &detector));
    return detector;
}

/* Vertices of a seam that are apart are two. */
static void name_by_place(grid_scene *s) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double *x = s->positions + (size_t)v * 3, *y = s->positions + (size_t)s->names[v] * 3;
        if (memcmp(x, y, sizeof(double[3])) != 0) s->names[v] = v;
    }
}

/* Is one vertex of the edge one of the triangle's by a seam, wherever they are? Then their contacts are left out. */
static bool share_seam(const grid_scene *s, const uint32_t *seam_names, uint32_t edge, uint32_t triangle) {
    for (int i = 0; i < 6; i++) {
        uint32_t v = s->mesh->edges[edge][i % 2], w = s->mesh->triangles[triangle][i / 2];
        if (seam_names[v] == seam_names[w]) return true;
    }
    return false;
}

static bool is_next(const cscd_curve_changes *changes, size_t next, uint32_t edge, uint32_t triangle) {
    return next < changes->count && changes->items[next].edge == edge &&
           changes->items[next].triangle == triangle;
}

/* The list is that of all events that polynomials let come or go, in the order of edges and triangles. */
static void compare_with_oracle(const grid_scene *start, const grid_scene *end, const uint32_t *seam_names,
                                const cscd_contact *contacts, size_t contact_count,
                                const cscd_curve_changes *changes, change_totals *totals) {
    size_t next = 0;
    for (uint32_t edge = 0; edge < start->mesh->edge_count; edge++) {
        for (uint32_t t = 0; t < start->mesh->triangle_count; t++) {
            bool before = event_oracle_happens(start, (surface_event){edge, t});
            bool after = event_oracle_happens(end, (surface_event){edge, t});
            bool listed = is_next(changes, next, edge, t);
            if (before == after || (!listed && share_seam(start, seam_names, edge, t))) continue;
            assert_true(listed);
            const cscd_curve_change *change = &changes->items[next++];
            assert_true(change->comes == after);
            check_causes(start->mesh, contacts, contact_count, changes, change);
            totals->coming += after;
            totals->going += before;
            totals->with_several_causes += change->cause_count > 1;
        }
    }
    assert_int_equal(next, changes->count);
    check_inverse(changes, contact_count);
    for (size_t i = 0; i < contact_count; i++)
        totals->contacts_without_change += changes->contact_first[i] == changes->contact_first[i + 1];
}

/* Every second list is given in reverse order. */
static cscd_contact *copy_contacts(const cscd_contacts *contacts, bool reversed) {
    cscd_contact *copy = malloc((contacts->count + 1) * sizeof *copy);
    assert_non_null(copy);
    for (size_t i = 0; i < contacts->count; i++)
        copy[i] = contacts->items[reversed ? contacts->count - 1 - i : i];
    return copy;
}

static void check_grid(grid_family family, uint64_t seed, change_totals *totals) {
    static grid_scene start, end;
    random_stream random = stream_start(seed * 100 + family);
    grid_scene_make(family, seed, &start);
    end = start;
    (start.object_count == 2 && seed % 3 == 0 ? move_object : move_vertices)(&random, &start, end.positions);
    uint32_t seam_names[EPSILON_NAMES];
    memcpy(seam_names, start.names, sizeof seam_names);
    cscd_detector *detector = make_detector(&start, seed % 2 == 0 ? CSCD_METHOD_AUTO : CSCD_METHOD_NONE);
    cscd_contacts contacts;
    cscd_curve_changes changes;
    const cscd_view x0 = *CSCD_DOUBLES(start.positions, start.vertex_count);
    const cscd_view x1 = *CSCD_DOUBLES(end.positions, end.vertex_count);
    expect_ok(cscd_detector_step(detector, &x0, &x1, &contacts));
    cscd_contact *given = copy_contacts(&contacts, seed / 2 % 2 == 1);
    expect_ok(cscd_detector_curve_changes(detector, &x0, &x1, given, contacts.count, &changes));
    name_by_place(&start);
    name_by_place(&end);
    compare_with_oracle(&start, &end, seam_names, given, contacts.count, &changes, totals);
    free(given);
    cscd_detector_destroy(detector);
    grid_scene_free(&start);
}

TEST(points_come_and_go_at_contacts) {
    change_totals totals = {0};
    for (int family = 0; family < GRID_FAMILIES; family++) {
        for (uint64_t seed = 0; seed < 16; seed++) check_grid((grid_family)family, seed, &totals);
    }
    print_message("%zu points come, %zu go, %zu of them with several contacts; %zu contacts change nothing\n",
                  totals.coming, totals.going, totals.with_several_causes, totals.contacts_without_change);
    assert_true(totals.coming > 1000 && totals.going > 1000);
    assert_true(totals.with_several_causes > 500 && totals.contacts_without_change > 1000);
}
