/* What a detector knows of the start of its next step, and exact winding numbers beside the triangles that it calls clean. */
#include "tests/support/culling/clean_triangles.h"

#include "src/mesh/predicates.h"
#include "tests/support/test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* A line along an axis; the other two, in cyclic order, are those of its place. */
typedef struct axis_line {
    const double *positions;
    int axis;
    double place[2];
} axis_line;

/* Where the line passes through a triangle: along its normal (1), against it (-1), or not at all (0); in a corner or on
 * an edge. The height has at most this error. */
typedef struct line_pass {
    int sense;
    bool on_border;
    double height, error;
} line_pass;

static const double *corner_of(const axis_line *line, const uint32_t triangle[3], int i) {
    return line->positions + (size_t)triangle[i % 3] * 3;
}

static double place_of(const axis_line *line, const double *point, int i) {
    return point[(line->axis + 1 + i) % 3];
}

static bool box_misses(const axis_line *line, const uint32_t triangle[3]) {
    for (int k = 0; k < 2; k++) {
        double p[3];
        for (int i = 0; i < 3; i++) p[i] = place_of(line, corner_of(line, triangle, i), k);
        if (fmax(p[0], fmax(p[1], p[2])) < line->place[k]) return true;
        if (fmin(p[0], fmin(p[1], p[2])) > line->place[k]) return true;
    }
    return false;
}

/* The height by the areas that the place cuts the projected triangle into. Each factor of an area has one rounding, each
 * product one more, and their difference a last one. */
static void find_height(const axis_line *line, const uint32_t triangle[3], line_pass *pass) {
    double sum = 0.0, areas = 0.0, doubt = 0.0, largest = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *a = corner_of(line, triangle, i + 1), *b = corner_of(line, triangle, i + 2);
        double ax = place_of(line, a, 0) - line->place[0], ay = place_of(line, a, 1) - line->place[1];
        double bx = place_of(line, b, 0) - line->place[0], by = place_of(line, b, 1) - line->place[1];
        double area = fabs(ax * by - ay * bx), height = corner_of(line, triangle, i)[line->axis];
        doubt += 4.0 * DBL_EPSILON * (fabs(ax * by) + fabs(ay * bx));
        largest = fmax(largest, fabs(height));
        areas += area;
        sum += area * height;
    }
    pass->height = sum / areas;
    pass->error = areas > 2.0 * doubt ? 4.0 * largest * (doubt / areas + 4.0 * DBL_EPSILON) : INFINITY;
}

static line_pass pass_through(const axis_line *line, const uint32_t triangle[3]) {
    line_pass pass = {0, false, 0.0, 0.0};
    int signs[3];
    if (box_misses(line, triangle)) return pass;
    for (int i = 0; i < 3; i++) {
        const double *a = corner_of(line, triangle, i), *b = corner_of(line, triangle, i + 1);
        signs[i] = orient2d(place_of(line, a, 0), place_of(line, a, 1), place_of(line, b, 0),
                            place_of(line, b, 1), line->place[0], line->place[1]);
    }
    bool left = signs[0] >= 0 && signs[1] >= 0 && signs[2] >= 0;
    bool right = signs[0] <= 0 && signs[1] <= 0 && signs[2] <= 0;
    if (!left && !right) return pass;
    pass.on_border = signs[0] == 0 || signs[1] == 0 || signs[2] == 0;
    pass.sense = left ? 1 : -1;
    find_height(line, triangle, &pass);
    return pass;
}

/* The axis that is nearest to the normal; other `turn`s take the next ones. */
static int axis_of_normal(const double *positions, const uint32_t triangle[3], int turn) {
    const double *p[3];
    double normal[3];
    int best = 0;
    for (int i = 0; i < 3; i++) p[i] = positions + (size_t)triangle[i] * 3;
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        normal[k] =
            fabs((p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]));
        if (normal[k] > normal[best]) best = k;
    }
    return (best + turn) % 3;
}

/* A line through the inside of a triangle, another one in each try. */
static axis_line line_through(const double *positions, const uint32_t triangle[3], int try) {
    axis_line line = {positions, axis_of_normal(positions, triangle, try / 6), {0.0, 0.0}};
    double weights[3] = {0.41 - 0.05 * (try % 6), 0.33, 0.26 + 0.05 * (try % 6)};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++)
            line.place[k] += weights[i] * place_of(&line, corner_of(&line, triangle, i), k);
    }
    return line;
}

/* Sums up what lies beyond the triangle on its outer side. False: the line passes through a border or another triangle
 * too near to this one to tell, so another line has to be taken. */
static bool count_beyond(const cscd_mesh *mesh, const axis_line *line, uint32_t triangle, int *number) {
    line_pass own = pass_through(line, mesh->triangles[triangle]);
    uint32_t component = mesh->triangle_components[triangle];
    if (own.sense == 0 || own.on_border) return false;
    *number = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (t == triangle || mesh->triangle_components[t] != component) continue;
        line_pass other = pass_through(line, mesh->triangles[t]);
        if (other.sense == 0) continue;
        double ahead = own.sense * (other.height - own.height);
        if (other.on_border || !(fabs(ahead) > own.error + other.error)) return false;
        if (ahead > 0.0) *number += own.sense * other.sense;
    }
    return true;
}

bool exact_number_outside(const cscd_mesh *mesh, const double *positions, uint32_t triangle, int *number) {
    for (int try = 0; try < 18; try++) {
        axis_line line = line_through(positions, mesh->triangles[triangle], try);
        if (count_beyond(mesh, &line, triangle, number)) return true;
    }
    return false;
}

/* Which of the clean triangles are looked at, and what has been found. */
typedef struct number_check {
    const cscd_mesh *mesh;
    const start_states *starts;
    const char *where;
    bool *done; /* per triangle */
    uint32_t *queue;
    uint32_t compared, undecided;
} number_check;

/* Marks the patch that clean triangles form around one as done. */
static void pass_over_patch(number_check *c, uint32_t triangle) {
    const cscd_mesh *mesh = c->mesh;
    uint32_t end = 0;
    c->queue[end++] = triangle;
    for (uint32_t begin = 0; begin < end; begin++) {
        for (int i = 0; i < 3; i++) {
            uint32_t edge = mesh->triangle_edges[c->queue[begin]][i];
            for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++) {
                uint32_t next = mesh->edge_stars[j];
                if (c->done[next] || c->starts->triangles[next] != TRIANGLE_CLEAN) continue;
                c->done[next] = true;
                c->queue[end++] = next;
            }
        }
    }
}

static void check_component(number_check *c, uint32_t component, bool everywhere, bool outer) {
    bool any = outer;
    int first = 0, number = 0;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        if (c->mesh->triangle_components[t] != component || c->starts->triangles[t] != TRIANGLE_CLEAN)
            continue;
        if (c->done[t]) continue;
        bool decided = exact_number_outside(c->mesh, c->starts->positions, t, &number);
        c->undecided += !decided;
        c->compared += decided;
        if (!decided) continue;
        c->done[t] = true;
        if (!everywhere) pass_over_patch(c, t);
        if (!any) first = number;
        any = true;
        if (number != first)
            fail_msg(
                "%s: triangle %u of component %u is called clean; the winding number outside it is %d, where it "
                "should be %d",
                c->where, t, component, number, first);
    }
}

static uint32_t check_numbers(const cscd_detector *detector, bool everywhere, bool outer, const char *where) {
    const cscd_mesh *mesh = detector->mesh;
    const start_states *starts = &detector->known.starts;
    if (!starts->known || starts->partly || starts->vouched) return 0;
    number_check c = {mesh,
                      starts,
                      where,
                      calloc(mesh->triangle_count + 1, sizeof *c.done),
                      calloc(mesh->triangle_count + 1, sizeof *c.queue),
                      0,
                      0};
    if (c.done == NULL || c.queue == NULL) abort();
    for (uint32_t i = 0; i < mesh->component_count; i++) {
        if (mesh->components[i].closed_manifold) check_component(&c, i, everywhere, outer);
    }
    free(c.done);
    free(c.queue);
    if (c.undecided > 10 && c.undecided * 100 > c.compared)
        fail_msg("%s: %u of %u numbers are undecided", where, c.undecided, c.compared + c.undecided);
    return c.compared;
}

uint32_t expect_one_number(const cscd_detector *detector, const char *where) {
    return check_numbers(detector, false, false, where);
}

uint32_t expect_one_number_everywhere(const cscd_detector *detector, bool outer, const char *where) {
    return check_numbers(detector, true, outer, where);
}
