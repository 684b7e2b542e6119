/* The detector of a replay: steps, checks, and a new one for each chunk. */
#include "tool/replay/replay_source.h"

#include "tool/common/command.h"
#include "tool/common/methods.h"
#include "tool/common/part_names.h"
#include "tool/io/io.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- what turns by about half a turn from one frame to the next ------------------------------------------ */

/* A component that shrinks half-way. */
typedef struct half_turn {
    uint32_t component;
    double
        size; /* half-way: the root mean square distance of its corners from their mean, as a share of that at the ends */
} half_turn;

/* The corners of a component's triangles, from its first one on, as x is far from 0 where a scene is. */
typedef struct spread {
    uint32_t first; /* a vertex; the sums are of differences to it */
    double count, sum0[3], sum1[3];
    double square0, square1, product;
} spread;

static void add_corner(spread *s, uint32_t vertex, const double *x0, const double *x1) {
    if (s->count == 0.0) s->first = vertex;
    s->count += 1.0;
    for (size_t i = 0; i < 3; i++) {
        const double a = x0[3 * (size_t)vertex + i] - x0[3 * (size_t)s->first + i],
                     b = x1[3 * (size_t)vertex + i] - x1[3 * (size_t)s->first + i];
        s->sum0[i] += a;
        s->sum1[i] += b;
        s->square0 += a * a;
        s->square1 += b * b;
        s->product += a * b;
    }
}

/* Half-way each corner is the mean of its ends: its square is (square0 + square1 + 2 product) / 4, about the
 * means. */
static double size_half_way(const spread *s) {
    double square0 = s->square0, square1 = s->square1, product = s->product;
    for (int i = 0; i < 3; i++) {
        square0 -= s->sum0[i] * s->sum0[i] / s->count;
        square1 -= s->sum1[i] * s->sum1[i] / s->count;
        product -= s->sum0[i] * s->sum1[i] / s->count;
    }
    const double ends = (square0 + square1) / 2.0;
    return ends > 0.0 ? sqrt(fmax((ends + product) / 2.0 / ends, 0.0)) : 1.0;
}

#define SHRINKS_BELOW 0.59

/* Finds the component that shrinks most between two frames (doubles, xyz of each vertex of the mesh), if one
 * shrinks below 0.59, as a flat thing does that turns by more than 107 degrees, and a ball by more than 161.
 * Returns false: none does, or no memory. */
static bool half_turn_find(const cscd_mesh *mesh, const double *x0, const double *x1, half_turn *out) {
    const uint32_t components = cscd_mesh_component_count(mesh);
    spread *spreads = io_zeroed(((size_t)components + 1) * sizeof *spreads);
    *out = (half_turn){.size = SHRINKS_BELOW};
    if (spreads == NULL) return false;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        uint32_t corners[3];
        cscd_mesh_triangle(mesh, t, corners);
        for (int i = 0; i < 3; i++)
            add_corner(&spreads[cscd_mesh_triangle_component(mesh, t)], corners[i], x0, x1);
    }
    bool found = false;
    for (uint32_t c = 0; c < components; c++) {
        const double size = size_half_way(&spreads[c]);
        if (!(size < out->size)) continue;
        *out = (half_turn){c, size};
        found = true;
    }
    free(spreads);
    return found;
}

static void name_component(const recording *r, const part_names *parts, uint32_t component, char *text,
                           size_t size) {
    uint32_t t = 0;
    while (cscd_mesh_triangle_component(r->mesh, t) != component) t++;
    if (parts->named && parts->labels[t] != NO_PART)
        snprintf(text, size, "part %.80s", part_names_at(parts, parts->labels[t]));
    else
        snprintf(text, size, "component %u", component);
}

/* A note for people about the interval from frame k on: "part rotor shrinks to 9 % of its size ...". */
static void half_turn_tell(const recording *r, const part_names *parts, uint32_t k, const half_turn *found) {
    char name[120];
    name_component(r, parts, found->component, name, sizeof name);
    note(
        "%s shrinks to %.0f %% of its size half-way from frame %d to %d, as straight ways do to what turns far between "
        "two frames: it may touch itself for that reason alone, and hits of its true way can be missed; record more "
        "frames",
        name, found->size * 100.0, r->frame_numbers[k], r->frame_numbers[k + 1]);
}

static bool api_failed(const replay_detector *d, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(d->recording->context));
}

static bool create_detector(replay_detector *d, io_error *error) {
    const replay_options *o = d->options;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = d->method;
    options.mode = o->mode;
    options.start = o->start;
    options.ours = o->ours & ~ours_of_plans(o->ours);
    options.volume = o->volume;
    options.min_separation = o->min_separation;
    options.coherence = CSCD_COHERENCE_OFF; /* counters say what each interval costs by itself */
    ignore_pairs_choose(d->ignored, &options);
    if (cscd_detector_create(d->recording->context, d->recording->mesh, d->plan, &options, &d->detector) !=
        CSCD_OK)
        return api_failed(d, error);
    return answers_prepare(d->answers, d->detector, error);
}

bool replay_detector_open(replay_detector *d, io_error *error) {
    const size_t components = cscd_mesh_component_count(d->recording->mesh);
    if (!create_detector(d, error)) return false;
    d->guarantees = io_zeroed((components + 1) * sizeof *d->guarantees);
    return (d->guarantees != NULL &&
            orientation_row_create(d->detector, d->recording->mesh, &d->orientations)) ||
           io_fail(error, "out of memory");
}

void replay_detector_close(replay_detector *d) {
    cscd_detector_destroy(d->detector);
    free(d->guarantees);
    orientation_row_free(&d->orientations);
    *d = (replay_detector){0};
}

bool replay_detector_renew(replay_detector *d, io_error *error) {
    cscd_detector_destroy(d->detector);
    d->detector = NULL;
    return create_detector(d, error);
}

bool replay_detector_is_oriented(const replay_detector *d) {
    return d->orientations.region_count > 0;
}

/* The bytes that a contact takes in the library's lists, while they grow and are sorted, and in those of events. */
enum { CONTACT_SIZE = 512 };

/* The cap is for contacts alone: pairs of triangles have their own. */
static cscd_status step_within_memory(const replay_detector *d, const double *x0, const double *x1,
                                      cscd_contacts *out) {
    const uint32_t vertices = cscd_mesh_vertex_count(d->recording->mesh);
    const size_t given = d->options->answers.limits.memory,
                 most = given > 0 ? given : cscd_context_memory_share(d->recording->context);
    cscd_status status = cscd_detector_set_longest_list(d->detector, most / CONTACT_SIZE + 1);
    if (status != CSCD_OK) return status;
    status = cscd_detector_step(d->detector, CSCD_DOUBLES(x0, vertices), CSCD_DOUBLES(x1, vertices), out);
    cscd_detector_set_longest_list(d->detector, 0);
    return status;
}

/* Before the step, which may take long just there. */
static void look_for_half_turns(replay_detector *d, uint32_t k, const double *x0, const double *x1) {
    half_turn found;
    if (d->told_half_turn || d->options->quiet || !half_turn_find(d->recording->mesh, x0, x1, &found)) return;
    half_turn_tell(d->recording, &d->ignored->parts, k, &found);
    d->told_half_turn = true;
}

bool replay_detector_step(replay_detector *d, uint32_t k, const double *x0, const double *x1,
                          interval_step *out, io_error *error) {
    cscd_contacts contacts;
    look_for_half_turns(d, k, x0, x1);
    const cscd_status status = step_within_memory(d, x0, x1, &contacts);
    if (status == CSCD_LIST_TOO_LONG) {
        orientation_row_forget(&d->orientations);
        *out = (interval_step){.unlisted = contacts.count, .orientations = &d->orientations};
        return true;
    }
    if (status != CSCD_OK)
        return io_fail(error, "frame %d: %s", d->recording->frame_numbers[k],
                       cscd_context_detail(d->recording->context));
    for (uint32_t i = 0; i < cscd_mesh_component_count(d->recording->mesh); i++)
        d->guarantees[i] = cscd_detector_guarantee(d->detector, i);
    if (d->takes_orientations) orientation_row_take(&d->orientations, d->detector);
    *out = (interval_step){.contacts = contacts,
                           .counters = cscd_detector_counters(d->detector),
                           .timings = cscd_detector_timings(d->detector),
                           .guarantees = d->guarantees,
                           .orientations = &d->orientations};
    return true;
}

bool replay_detector_check(replay_detector *d, uint32_t frame, const double *positions, frame_check *out,
                           io_error *error) {
    *out = (frame_check){.checked = !d->options->no_check};
    if (!out->checked) return true;
    io_error reason;
    if (!answers_find(d->answers, d->detector, positions, &out->found, &reason))
        return io_fail(error, "frame %d: %s", d->recording->frame_numbers[frame], reason.text);
    out->ms = cscd_detector_timings(d->detector).check_ms;
    if (out->found.patches != NULL) out->turned = out->found.patches->turned;
    return true;
}
