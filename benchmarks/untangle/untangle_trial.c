/* Runs one case, and judges it by a detector of its own. */
#include "benchmarks/untangle/untangle_trial.h"

#include "models/common/vec3.h"
#include "src/core/timer.h"
#include "tool/io/mesh_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PATH_LENGTH = 4096 };

/* ---- edges --------------------------------------------------------------------------------------------- */

typedef struct edge_side {
    uint32_t low, high, triangle;
    bool upwards; /* the triangle goes from low to high */
} edge_side;

static int compare_sides(const void *a, const void *b) {
    const edge_side *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static double mean_edge(const tangle_scene *s, const double *x) {
    double sum = 0.0;
    const size_t count = (size_t)s->triangle_count * 3;
    for (size_t i = 0; i < count; i++) {
        double side[3];
        vec3_subtract(x + 3 * (size_t)s->triangles[i],
                      x + 3 * (size_t)s->triangles[i % 3 == 2 ? i - 2 : i + 1], side);
        sum += vec3_norm(side);
    }
    return sum / (double)count;
}

static void find_edges(untangle_trial *t) {
    const tangle_scene *s = &t->scene;
    const size_t count = (size_t)s->triangle_count * 3;
    edge_side *sides = body_allocate(count, sizeof *sides);
    for (size_t i = 0; i < count; i++) {
        const uint32_t v = s->triangles[i], w = s->triangles[i % 3 == 2 ? i - 2 : i + 1];
        sides[i] = (edge_side){v < w ? v : w, v < w ? w : v, (uint32_t)(i / 3), v < w};
    }
    qsort(sides, count, sizeof *sides, compare_sides);
    t->edges = body_allocate(count, sizeof *t->edges);
    t->turned = body_allocate(count, sizeof *t->turned);
    for (size_t i = 0; i + 1 < count; i++) {
        const edge_side *p = &sides[i], *q = &sides[i + 1];
        if (p->low != q->low || p->high != q->high) continue;
        t->edges[t->edge_count][0] = p->triangle;
        t->edges[t->edge_count][1] = q->triangle;
        t->turned[t->edge_count++] = p->upwards == q->upwards;
    }
    free(sides);
}

/* ---- opening ------------------------------------------------------------------------------------------- */

static cscd_status make_detectors(untangle_trial *t) {
    const tangle_scene *s = &t->scene;
    cscd_object_desc objects[TANGLE_OBJECTS_MAX];
    for (uint32_t i = 0; i < s->object_count; i++) {
        const body *b = &s->objects[i];
        objects[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        objects[i].obstacle = s->obstacles[i];
    }
    cscd_status status = cscd_mesh_create(t->context, objects, s->object_count, &t->mesh);
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = s->seams;
    options.seam_count = s->seam_count;
    if (status == CSCD_OK) status = cscd_detector_create(t->context, t->mesh, NULL, &options, &t->judge);
    options.min_separation = t->gap;
    if (status == CSCD_OK) status = cscd_detector_create(t->context, t->mesh, NULL, &options, &t->detector);
    return status;
}

static cscd_status count_pairs(untangle_trial *t, const cscd_view *positions, size_t *count) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = CSCD_ANSWER_COUNT;
    cscd_status status = cscd_detector_find_intersections(t->judge, positions, &options, &found);
    if (status == CSCD_OK) *count = found.count;
    return status;
}

/* Whether features are nearer than the gap. */
static cscd_status find_within_gap(untangle_trial *t, const double *x, bool *found) {
    cscd_proximities near;
    *found = false;
    if (!(t->gap > 0.0)) return CSCD_OK;
    cscd_status status = cscd_detector_find_near(t->judge, CSCD_DOUBLES(x, t->scene.vertex_count), t->gap,
                                                 CSCD_NEAR_PAIRS, &near);
    for (size_t i = 0; status == CSCD_OK && i < near.count; i++)
        *found = *found || near.items[i].distance < t->gap * (1.0 - 1e-9);
    return status;
}

static cscd_status count_frame(untangle_trial *t, uint32_t frame) {
    const double *x = tangle_scene_frame(&t->scene, frame);
    cscd_status status = count_pairs(t, CSCD_DOUBLES(x, t->scene.vertex_count), &t->pairs[frame]);
    t->tangled[frame] = t->pairs[frame] > 0;
    return status == CSCD_OK && !t->tangled[frame] ? find_within_gap(t, x, &t->tangled[frame]) : status;
}

static cscd_status count_all_frames(untangle_trial *t) {
    const tangle_scene *s = &t->scene;
    cscd_status status = CSCD_OK;
    t->tangled = body_allocate(s->frame_count, sizeof *t->tangled);
    t->pairs = body_allocate(s->frame_count, sizeof *t->pairs);
    for (uint32_t f = 0; status == CSCD_OK && f < s->frame_count; f++) status = count_frame(t, f);
    return status;
}

static bool fail_trial(const untangle_trial *t, cscd_status status, io_error *error) {
    return io_fail(error, "%s: %s: %s", t->entry->name, cscd_status_string(status),
                   cscd_context_detail(t->context));
}

bool untangle_trial_open(const corpus_entry *entry, cscd_context *context, double gap, untangle_trial *out,
                         io_error *error) {
    untangle_trial t = {.entry = entry, .context = context, .max_seconds = INFINITY};
    if (!corpus_open(entry, &t.scene, error)) return false;
    const size_t size = (size_t)t.scene.vertex_count * 3;
    find_edges(&t);
    t.gap = gap * mean_edge(&t.scene, t.scene.frames);
    t.reached = body_allocate(size, sizeof *t.reached);
    t.start = body_allocate(size, sizeof *t.start);
    t.start_input = body_allocate(size, sizeof *t.start_input);
    for (int i = 0; i < 4; i++) t.narrow[i] = body_allocate(size, sizeof **t.narrow);
    cscd_status status = make_detectors(&t);
    if (status == CSCD_OK) status = count_all_frames(&t);
    if (status == CSCD_OK)
        *out = t;
    else
        untangle_trial_close(&t);
    return status == CSCD_OK || fail_trial(&t, status, error);
}

void untangle_trial_close(untangle_trial *t) {
    cscd_detector_destroy(t->detector);
    cscd_detector_destroy(t->judge);
    cscd_mesh_destroy(t->mesh);
    free(t->pairs);
    free(t->tangled);
    free(t->edges);
    free(t->turned);
    free(t->reached);
    free(t->start);
    free(t->start_input);
    for (int i = 0; i < 4; i++) free(t->narrow[i]);
    tangle_scene_free(&t->scene);
}

/* ---- measures ------------------------------------------------------------------------------------------ */

/* Half the cross product of two sides, and the quality: 1 for equal sides, 0 without an area. */
static double measure_triangle(const untangle_trial *t, const double *x, uint32_t triangle,
                               double normal[3]) {
    const uint32_t *c = t->scene.triangles + 3 * (size_t)triangle;
    const double *p = x + 3 * (size_t)c[0], *q = x + 3 * (size_t)c[1], *r = x + 3 * (size_t)c[2];
    double a[3], b[3], d[3];
    vec3_subtract(q, p, a);
    vec3_subtract(r, p, b);
    vec3_subtract(r, q, d);
    vec3_cross(a, b, normal);
    const double squares = vec3_dot(a, a) + vec3_dot(b, b) + vec3_dot(d, d);
    return squares > 0.0 ? 2.0 * sqrt(3.0) * vec3_norm(normal) / squares : 0.0;
}

/* The cosine between the normals on both sides of an edge; 1 where there is none. */
static double cosine_at_edge(const untangle_trial *t, const double *x, uint32_t edge) {
    double n[3], m[3];
    measure_triangle(t, x, t->edges[edge][0], n);
    measure_triangle(t, x, t->edges[edge][1], m);
    const double lengths = vec3_norm(n) * vec3_norm(m);
    if (!(lengths > 0.0)) return 1.0;
    return (t->turned[edge] ? -1.0 : 1.0) * vec3_dot(n, m) / lengths;
}

static void measure_shape(const untangle_trial *t, const double *before, const double *after,
                          untangle_case *c) {
    bool *bent = body_allocate(t->scene.triangle_count, sizeof *bent);
    for (uint32_t e = 0; e < t->edge_count; e++) {
        const double was = cosine_at_edge(t, before, e), is = cosine_at_edge(t, after, e);
        if (was < 0.0) bent[t->edges[e][0]] = bent[t->edges[e][1]] = true;
        c->creases += was >= -0.5 && is < -0.5;
    }
    c->quality_before = c->quality_after = 1.0;
    for (uint32_t i = 0; i < t->scene.triangle_count; i++) {
        double n[3], m[3];
        c->quality_before = fmin(c->quality_before, measure_triangle(t, before, i, n));
        c->quality_after = fmin(c->quality_after, measure_triangle(t, after, i, m));
        const bool flipped = vec3_dot(n, m) < 0.0;
        c->flips += flipped;
        c->smooth_flips += flipped && !bent[i];
    }
    free(bent);
}

static double greatest_displacement(const tangle_scene *s, const double *before, const double *after) {
    double greatest = 0.0;
    for (size_t v = 0; v < s->vertex_count; v++) {
        double way[3];
        vec3_subtract(after + 3 * v, before + 3 * v, way);
        greatest = fmax(greatest, vec3_norm(way));
    }
    return greatest;
}

static bool any_pin_moved(const tangle_scene *s, const double *before, const double *after) {
    size_t v = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        for (uint32_t j = 0; j < s->objects[i].vertex_count; j++, v++) {
            const bool pinned = s->obstacles[i] || (s->weights != NULL && isinf(s->weights[v]));
            if (pinned && memcmp(before + 3 * v, after + 3 * v, sizeof(double[3])) != 0) return true;
        }
    }
    return false;
}

static bool any_seam_open(const tangle_scene *s, const double *before, const double *after) {
    for (uint32_t i = 0; i < s->seam_count; i++) {
        const size_t v = s->seams[2 * i], w = s->seams[2 * i + 1];
        if (memcmp(before + 3 * v, before + 3 * w, sizeof(double[3])) == 0 &&
            memcmp(after + 3 * v, after + 3 * w, sizeof(double[3])) != 0)
            return true;
    }
    return false;
}

/* How much the displacement has changed since the frame before. */
static double greatest_jitter(const untangle_trial *t, const double *x) {
    double greatest = 0.0;
    for (size_t i = 0; i < (size_t)t->scene.vertex_count * 3; i += 3) {
        double change[3];
        for (size_t c = i; c < i + 3; c++)
            change[c - i] = (t->reached[c] - x[c]) - (t->start[c] - t->start_input[c]);
        greatest = fmax(greatest, vec3_norm(change));
    }
    return greatest;
}

static uint32_t find_broken(const untangle_trial *t, const double *before, bool from_start,
                            const untangle_case *c) {
    const size_t size = (size_t)t->scene.vertex_count * 3 * sizeof(double);
    const bool same = memcmp(before, t->reached, size) == 0;
    const cscd_untangled *f = &c->found;
    uint32_t broken = 0;
    if (!same && c->pairs_after >= c->pairs_before && c->pairs_after > 0) broken |= BROKEN_WORSE;
    if (f->clean && c->pairs_after > 0) broken |= BROKEN_CLEAN;
    if (f->pairs_before != c->pairs_before || f->pairs_after != c->pairs_after || f->moved == same ||
        fabs(f->displacement - c->displacement) > 1e-9 * c->displacement)
        broken |= BROKEN_COUNTS;
    if (any_pin_moved(&t->scene, before, t->reached)) broken |= BROKEN_PINNED;
    if (from_start && c->pairs_after > 0) broken |= BROKEN_START;
    if (any_seam_open(&t->scene, before, t->reached)) broken |= BROKEN_SEAM;
    return broken;
}

/* ---- running ------------------------------------------------------------------------------------------- */

static void narrow_all(float *to, const double *from, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
}

static double now_seconds(const untangle_trial *t) {
    return t->wall_time ? 1e-3 * timer_now_ms() : (double)clock() / CLOCKS_PER_SEC;
}

static cscd_status untangle_floats(untangle_trial *t, const double *x, cscd_untangle_options *options,
                                   cscd_untangled *found) {
    const uint32_t count = t->scene.vertex_count;
    const size_t size = (size_t)count * 3;
    const cscd_view start = cscd_view_floats(t->narrow[1], count),
                    start_input = cscd_view_floats(t->narrow[2], count);
    narrow_all(t->narrow[0], x, size);
    narrow_all(t->narrow[1], t->start, size);
    narrow_all(t->narrow[2], t->start_input, size);
    if (options->start != NULL) {
        options->start = &start;
        options->start_input = &start_input;
    }
    cscd_status status = cscd_detector_untangle(t->detector, CSCD_FLOATS(t->narrow[0], count), options,
                                                CSCD_MUTABLE_FLOATS(t->narrow[3], count), found);
    for (size_t i = 0; i < size; i++) t->reached[i] = t->narrow[3][i];
    return status;
}

static cscd_status untangle_frame(untangle_trial *t, const double *x, bool from_start, untangle_case *c) {
    const uint32_t count = t->scene.vertex_count;
    const cscd_view start = cscd_view_doubles(t->start, count),
                    start_input = cscd_view_doubles(t->start_input, count);
    cscd_untangle_options options = cscd_untangle_defaults();
    options.weights = t->scene.weights;
    options.max_seconds = t->max_seconds;
    if (from_start) {
        options.steady = t->steady;
        options.start = &start;
        options.start_input = &start_input;
    }
    const double begin = now_seconds(t);
    cscd_status status = t->floats
                             ? untangle_floats(t, x, &options, &c->found)
                             : cscd_detector_untangle(t->detector, CSCD_DOUBLES(x, count), &options,
                                                      CSCD_MUTABLE_DOUBLES(t->reached, count), &c->found);
    c->seconds = now_seconds(t) - begin;
    return status;
}

static cscd_status count_results(untangle_trial *t, untangle_case *c) {
    const uint32_t count = t->scene.vertex_count;
    cscd_status status = count_pairs(t, CSCD_DOUBLES(t->reached, count), &c->pairs_after);
    narrow_all(t->narrow[3], t->reached, (size_t)count * 3);
    if (status == CSCD_OK) status = count_pairs(t, CSCD_FLOATS(t->narrow[3], count), &c->pairs_as_floats);
    return status;
}

bool untangle_trial_run(untangle_trial *t, uint32_t frame, bool from_start, untangle_case *out,
                        io_error *error) {
    const double *x = tangle_scene_frame(&t->scene, frame);
    untangle_case c = {.entry = t->entry,
                       .frame = frame,
                       .triangle_count = t->scene.triangle_count,
                       .followed = from_start,
                       .pairs_before = t->pairs[frame]};
    cscd_status status = untangle_frame(t, x, from_start, &c);
    if (status == CSCD_OK) status = count_results(t, &c);
    bool near = false;
    if (status == CSCD_OK && c.found.clean) status = find_within_gap(t, t->reached, &near);
    if (status != CSCD_OK) return fail_trial(t, status, error);
    c.clean = c.pairs_after == 0 && (c.found.clean || t->gap == 0.0);
    c.displacement = greatest_displacement(&t->scene, x, t->reached);
    c.edge = mean_edge(&t->scene, x);
    measure_shape(t, x, t->reached, &c);
    c.jitter = from_start ? greatest_jitter(t, x) : 0.0;
    c.broken = find_broken(t, x, from_start, &c) | (near ? BROKEN_CLEAN : 0u);
    *out = c;
    return true;
}

static bool write_positions(const untangle_trial *t, const untangle_case *c, const char *folder,
                            const char *when, const double *x, io_error *error) {
    char path[PATH_LENGTH];
    const mesh_file mesh =
        mesh_file_of(t->scene.vertex_count, t->scene.triangle_count, (double *)x, t->scene.triangles);
    snprintf(path, sizeof path, "%s/%s-%u%s-%s.obj", folder, c->entry->name, c->frame,
             c->followed ? "-followed" : "", when);
    return mesh_file_write_obj(path, &mesh, error);
}

bool untangle_trial_write(const untangle_trial *t, const untangle_case *c, const char *folder,
                          io_error *error) {
    const double *x = tangle_scene_frame(&t->scene, c->frame);
    return write_positions(t, c, folder, "before", x, error) &&
           write_positions(t, c, folder, "after", t->reached, error);
}
