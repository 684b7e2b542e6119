/* Surfaces pushed out of each other, through what they have in common, with no regard to what is between: rounds of lenses and
 * elastic displacements. */
#include "runtime/untangle/lenses.h"
#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* Rounds that go on although no round since has had fewer pairs. */
enum { PATIENCE = 14, LOOK_BACK = 4, SMOOTHINGS = 25, RIM = 2 };

/* Fewer wrong points than this share of the fewest so far are progress, too. */
static const double progress_share = 0.9;

/* Less than this share of the pairs of LOOK_BACK rounds before is progress; else points take the other way, along axes or to the
 * nearest place. */
static const double axis_share = 0.7;

/* The greatest change of a displacement along an edge, in its lengths, but for a thousandth of the edges; a step is shortened to
 * it, but not to less than a quarter. */
static const double steepest = 0.4, shortest_step = 0.25;

/* Surfaces go this many times as far apart as they have to keep. */
static const double past_separation = 1.25;

/* How far vertices go at once to shorten curves, in edge lengths. */
static const double longest_shortening = 2.0;

typedef struct push_work {
    untangle_work *w;
    const push_rules *rules;
    double *x, *best, *start; /* positions */
    double *step;
    uint64_t *slopes; /* per edge: a double of 0 or more, as a number */
    lens_finder lenses;
    vertex_region relaxed;
    size_t fewest, fewest_points;
    size_t *history;
    uint32_t stuck, turned;
    bool along_axis;
    double spread;
} push_work;

static array_list list_arrays(push_work *p) {
    const size_t n = 3 * (size_t)p->w->mesh->vertex_count;
    return (array_list){{ARRAY(p->best, n), ARRAY(p->start, n), ARRAY(p->step, n),
                         ARRAY(p->slopes, 2 * (size_t)p->w->mesh->edge_count),
                         ARRAY(p->history, (size_t)p->w->options.max_rounds + 1)}};
}

/* ---- the elastic step ------------------------------------------------------------------------------------ */

static double mean_stiffness(const push_work *p) {
    const vertex_graph *g = &p->w->graph;
    double sum = 0.0;
    size_t count = 0;
    for (uint32_t v = 0; v < p->w->mesh->vertex_count; v++) {
        if (g->names[v] != v || g->fixed[v]) continue;
        sum += g->masses[v] + p->spread * p->spread * g->coupled[v];
        count++;
    }
    return count > 0 ? sum / (double)count : 0.0;
}

static void choose_region(push_work *p) {
    untangle_work *w = p->w;
    vertex_region_clear(&w->region);
    for (size_t i = 0; i < p->lenses.point_count; i++) {
        const lens_point *point = &p->lenses.points[i];
        for (int k = 0; k < 5; k++) {
            if (point->weights[k] != 0.0) vertex_region_add(&w->region, &w->graph, point->vertices[k]);
        }
    }
    vertex_region_grow(&w->region, &w->graph, elastic_rings(w, 4.0 * p->spread));
}

/* Adds one point to the system: stiffness / 2 times the square of the sum of weights * direction * step - thickness. */
static void add_point(const push_work *p, const lens_point *point, double stiffness, double beyond) {
    untangle_work *w = p->w;
    const vertex_region *r = &w->region;
    for (int a = 0; a < 5; a++) {
        const uint32_t row = vertex_region_row(r, &w->graph, point->vertices[a]);
        if (row == NO_ROW || point->weights[a] == 0.0) continue;
        const double force = stiffness * point->weights[a] * (point->thickness + beyond);
        for (size_t k = 0; k < 3; k++) w->right_side[3 * (size_t)row + k] += force * point->direction[k];
        for (int b = a; b < 5; b++) {
            const uint32_t column = vertex_region_row(r, &w->graph, point->vertices[b]);
            const double factor = stiffness * point->weights[a] * point->weights[b];
            double block[9];
            if (column == NO_ROW || factor == 0.0) continue;
            const double twice = column == row && a != b ? 2.0 : 1.0;
            for (int k = 0; k < 9; k++)
                block[k] = twice * factor * point->direction[k / 3] * point->direction[k % 3];
            block_system_add_block(&w->system, row, column, block);
        }
    }
}

static cscd_status solve_step(push_work *p, double beyond) {
    untangle_work *w = p->w;
    choose_region(p);
    memset(p->step, 0, 3 * (size_t)w->mesh->vertex_count * sizeof *p->step);
    if (!block_system_begin(&w->system, w->region.count) || !elastic_add(w, p->spread) ||
        !block_system_reserve(&w->system, 15 * p->lenses.point_count))
        return CSCD_OUT_OF_MEMORY;
    const double stiffness = p->rules->stiffness * mean_stiffness(p);
    memset(w->right_side, 0, 3 * (size_t)w->region.count * sizeof *w->right_side);
    for (size_t i = 0; i < p->lenses.point_count; i++) add_point(p, &p->lenses.points[i], stiffness, beyond);
    cscd_status status = block_system_factor(&w->system);
    if (status != CSCD_OK) return status;
    block_system_solve(&w->system, w->right_side);
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const uint32_t row = vertex_region_row(&w->region, &w->graph, v);
        if (row != NO_ROW)
            memcpy(p->step + 3 * (size_t)v, w->right_side + 3 * (size_t)row, sizeof(double[3]));
    }
    return CSCD_OK;
}

/* Shortens a step that would deform triangles too much. */
static void limit_step(push_work *p) {
    const cscd_mesh *mesh = p->w->mesh;
    size_t count = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const size_t a = 3 * (size_t)mesh->edges[e][0], b = 3 * (size_t)mesh->edges[e][1];
        const double length = sqrt(vec3_squared_distance(p->x + a, p->x + b));
        const double slope = sqrt(vec3_squared_distance(p->step + a, p->step + b)) /
                             max_of(length, 1e-3 * p->w->graph.edge_length);
        if (slope > 0.0) memcpy(&p->slopes[count++], &slope, sizeof slope);
    }
    if (count == 0) return;
    sort_by_number(p->slopes, p->slopes + count, count, sizeof *p->slopes);
    double steep;
    memcpy(&steep, &p->slopes[count - 1 - count / 1000], sizeof steep);
    const double share = steep > steepest ? max_of(steepest / steep, shortest_step) : 1.0;
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) p->x[i] += share * p->step[i];
}

/* ---- relaxation ------------------------------------------------------------------------------------------ */

/* Pairs that share a vertex, and those that pushing does not part, are smoothed. */
static void choose_relaxed(push_work *p, const cscd_intersections *found, bool all) {
    untangle_work *w = p->w;
    vertex_region_clear(&p->relaxed);
    for (size_t i = 0; i < found->count; i++) {
        if (!all && found->items[i].shared == 0) continue;
        for (int k = 0; k < 3; k++) {
            vertex_region_add(&p->relaxed, &w->graph, w->mesh->triangles[found->items[i].a][k]);
            vertex_region_add(&p->relaxed, &w->graph, w->mesh->triangles[found->items[i].b][k]);
        }
    }
    if (all) vertex_region_grow(&p->relaxed, &w->graph, p->stuck < 3 ? p->stuck : 3);
}

/* Writes share times the mean of the neighbours plus the rest of itself, at once for all. */
static void smooth_vectors(push_work *p, double share, double *vectors) {
    const vertex_graph *g = &p->w->graph;
    const vertex_region *r = &p->relaxed;
    for (uint32_t row = 0; row < r->count; row++) {
        const uint32_t v = r->vertices[row];
        double *mean = p->step + 3 * (size_t)v;
        const size_t count = g->begins[v + 1] - g->begins[v];
        for (int k = 0; k < 3; k++) mean[k] = 0.0;
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++)
            vec3_add_scaled(mean, 1.0 / (double)count, vectors + 3 * (size_t)g->neighbours[n], mean);
    }
    for (uint32_t row = 0; row < r->count; row++) {
        const size_t v = r->vertices[row];
        for (size_t k = 3 * v; k < 3 * v + 3; k++)
            vectors[k] = (1.0 - share) * vectors[k] + share * p->step[k];
    }
}

/* The vertices of a seam stay as far apart as they were. */
static void follow_names(push_work *p) {
    const uint32_t *names = p->w->graph.names;
    for (uint32_t v = 0; v < p->w->mesh->vertex_count; v++) {
        const size_t at = 3 * (size_t)v, name = 3 * (size_t)names[v];
        if (names[v] == v || p->w->graph.fixed[v]) continue;
        for (size_t k = 0; k < 3; k++)
            p->x[at + k] = p->x[name + k] + (p->start[at + k] - p->start[name + k]);
    }
}

static void relax_surface(push_work *p, uint32_t round) {
    const size_t n = 3 * (size_t)p->w->mesh->vertex_count;
    if (p->relaxed.count == 0) return;
    if (p->rules->smooth_ways && round % 2 == 0 && p->stuck >= 2) {
        vertex_region_grow(&p->relaxed, &p->w->graph, RIM);
        for (size_t i = 0; i < n; i++) p->x[i] -= p->start[i];
        for (int i = 0; i < SMOOTHINGS; i++) smooth_vectors(p, 1.0, p->x);
        for (size_t i = 0; i < n; i++) p->x[i] += p->start[i];
    } else {
        smooth_vectors(p, 0.5, p->x);
    }
    follow_names(p);
}

/* ---- rounds ---------------------------------------------------------------------------------------------- */

static void judge_round(push_work *p, uint32_t round, size_t count) {
    p->history[round] = count;
    p->stuck++;
    if (count < p->fewest) {
        p->fewest = count;
        p->stuck = 0;
        memcpy(p->best, p->x, 3 * (size_t)p->w->mesh->vertex_count * sizeof *p->x);
    }
    if (round >= p->turned + LOOK_BACK &&
        (double)count > axis_share * (double)p->history[round - LOOK_BACK]) {
        p->along_axis = !p->along_axis;
        p->turned = round;
    }
}

static cscd_status push_once(push_work *p, const cscd_intersections *found, uint32_t round) {
    untangle_work *w = p->w;
    const lens_rules rules = {.rings = 2 + (p->stuck < 4 ? p->stuck : 4), .along_axis = p->along_axis};
    const double grown = 1.0 + 0.5 * (p->stuck < 8 ? p->stuck : 8);
    const double beyond = p->rules->beyond * w->graph.edge_length * grown +
                          past_separation * config_greatest_separation(&w->detector->config);
    cscd_status status = lenses_find(&p->lenses, found, p->x, &rules);
    if (status != CSCD_OK) return status;
    const bool points = p->lenses.point_count > 0;
    if (points && (double)p->lenses.point_count < progress_share * (double)p->fewest_points) {
        p->fewest_points = p->lenses.point_count;
        if (p->stuck > 2) p->stuck = 2;
    }
    choose_relaxed(p, found, p->stuck >= 3 && points);
    const double least = 3.0 * w->graph.edge_length;
    if (!points) {
        status = shorten_curves(w, max_of(p->spread, least), longest_shortening * w->graph.edge_length, p->x);
        if (status != CSCD_OK) return status;
    } else {
        p->spread = max_of(p->spread, max_of(least, p->rules->spread * (p->lenses.thickness + beyond)));
        status = solve_step(p, beyond);
        if (status != CSCD_OK) return status;
        limit_step(p);
    }
    relax_surface(p, round);
    work_flush(w, p->x);
    return CSCD_OK;
}

static cscd_status push_in_rounds(push_work *p) {
    untangle_work *w = p->w;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = options.patches = true;
    for (uint32_t round = 0; round <= w->options.max_rounds && work_goes_on(w); round++) {
        cscd_intersections found;
        work_say(w, "pushing out", (double)round / (w->options.max_rounds + 1.0));
        cscd_status status = detector_find_intersections(w->detector, WORK_VIEW(w, p->x), &options, &found);
        if (status != CSCD_OK) return status;
        judge_round(p, round, found.count);
        if (found.count == 0 || p->stuck > PATIENCE || round == w->options.max_rounds || found.left_out != 0)
            break;
        status = push_once(p, &found, round);
        if (status != CSCD_OK) return status;
        if (!work_in_range(w, p->x)) break;
        w->found.rounds++;
    }
    return CSCD_OK;
}

cscd_status push_out(untangle_work *w, const push_rules *rules, double *x, size_t *left) {
    const size_t size = 3 * (size_t)w->mesh->vertex_count * sizeof *x;
    push_work p = {.w = w,
                   .rules = rules,
                   .x = x,
                   .fewest = SIZE_MAX,
                   .fewest_points = SIZE_MAX,
                   .lenses = {.w = w, .set = {.context = w->context}}};
    cscd_status status = CSCD_OUT_OF_MEMORY;
    if (context_allocate_all(w->context, list_arrays(&p)) && vertex_region_make(&p.relaxed, &w->graph) &&
        lens_finder_make(&p.lenses, w)) {
        memcpy(p.start, x, size);
        memcpy(p.best, x, size);
        status = work_settle(w, push_in_rounds(&p));
        memcpy(x, p.best, size);
    }
    *left = p.fewest;
    vertex_region_free(&p.relaxed, w->context);
    lens_finder_free(&p.lenses);
    context_free_all(w->context, list_arrays(&p));
    return status;
}
