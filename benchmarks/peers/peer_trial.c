/* Us and the other programs on one scene, by turns. */
#include "benchmarks/peers/peer_trial.h"

#include "benchmarks/peers/cgal_peer.h"
#include "benchmarks/peers/peer_clock.h"
#include "benchmarks/peers/peer_scenes.h"

#include <math.h>
#include <stdlib.h>

const char *const peer_turn_names[TURN_COUNT] = {
    "none",           "none_broad", "single",   "single_new_start", "embree_refit",
    "embree_rebuild", "check",      "one_shot", "cgal_setup",       "cgal"};

double peer_trial_least(const peer_trial *t, peer_turn turn) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < t->rounds; i++) least = fmin(least, t->ms[turn][i]);
    return least;
}

double peer_trial_median(const peer_trial *t, peer_turn turn) {
    return median(t->ms[turn], t->rounds);
}

/* The objects that live through all rounds. */
typedef struct peer_contestants {
    const peer_scene *scene;
    subject *none, *single, *checker;
    embree_peer *refit, *rebuild;
    cscd_intersections checked; /* of the checker */
    peer_trial *trial;
} peer_contestants;

/* ---- opening ------------------------------------------------------------------------------------------- */

static subject *open_subject(const peer_scene *s, cscd_method method, io_error *error) {
    const deforming_body b = {.vertex_count = s->vertex_count,
                              .triangle_count = s->triangle_count,
                              .triangles = s->triangles,
                              .rest = s->start};
    const subject_options options = {method, CSCD_MODE_ALL, 1, CSCD_SIMD_AUTO, CSCD_VOLUME_BOX};
    return subject_make(&b, &options, error);
}

static bool open_contestants(const peer_scene *s, peer_contestants *out, io_error *error) {
    out->scene = s;
    return (out->none = open_subject(s, CSCD_METHOD_NONE, error)) != NULL &&
           (out->single = open_subject(s, CSCD_METHOD_SINGLE, error)) != NULL &&
           (out->checker = open_subject(s, CSCD_METHOD_NONE, error)) != NULL &&
           (out->refit = embree_peer_open(s, true, error)) != NULL &&
           (out->rebuild = embree_peer_open(s, false, error)) != NULL;
}

static void close_contestants(peer_contestants *c) {
    subject_destroy(c->none);
    subject_destroy(c->single);
    subject_destroy(c->checker);
    embree_peer_close(c->refit);
    embree_peer_close(c->rebuild);
}

/* ---- the interval -------------------------------------------------------------------------------------- */

static bool time_step(subject *s, const double *start, const double *end, double *ms, cscd_contacts *found,
                      io_error *error) {
    double since = peer_clock_ms();
    bool good = subject_step(s, start, end, false, found, error);
    *ms = peer_clock_ms() - since;
    return good;
}

static bool step_ours(peer_contestants *c, uint32_t sample, io_error *error) {
    const peer_scene *s = c->scene;
    peer_trial *t = c->trial;
    cscd_contacts found;
    double ignored;
    if (!time_step(c->none, s->start, s->end, &t->ms[TURN_NONE][sample], &found, error)) return false;
    cscd_timings ms = cscd_detector_timings(c->none->detector);
    /* Stages are taken by the wall clock: their share of the step. */
    t->ms[TURN_BROAD][sample] = t->ms[TURN_NONE][sample] * (ms.update_ms + ms.traversal_ms) / ms.total_ms;
    t->our_boxes = cscd_detector_counters(c->none->detector).pcp;
    t->contacts = found.count;
    return time_step(c->single, s->start, s->end, &t->ms[TURN_SINGLE_NEW][sample], &found, error) &&
           time_step(c->single, s->start, s->start, &ignored, &found, error) &&
           time_step(c->single, s->start, s->end, &t->ms[TURN_SINGLE][sample], &found, error);
}

static bool step_embree(peer_contestants *c, uint32_t sample, io_error *error) {
    peer_trial *t = c->trial;
    embree_pairs refit, rebuild;
    if (!embree_peer_step(c->refit, &refit, error) || !embree_peer_step(c->rebuild, &rebuild, error))
        return false;
    t->ms[TURN_EMBREE_REFIT][sample] = refit.update_ms + refit.find_ms;
    t->ms[TURN_EMBREE_REBUILD][sample] = rebuild.update_ms + rebuild.find_ms;
    t->embree_boxes = refit.pairs;
    t->embree_reported = refit.reported;
    return refit.pairs == rebuild.pairs ||
           io_fail(error, "%s: Embree finds other pairs after a refit than after a rebuild", c->scene->name);
}

/* ---- the moment ---------------------------------------------------------------------------------------- */

static bool check_known(peer_contestants *c, uint32_t sample, io_error *error) {
    const peer_scene *s = c->scene;
    double since = peer_clock_ms();
    cscd_status status =
        cscd_detector_check(c->checker->detector, CSCD_DOUBLES(s->start, s->vertex_count), &c->checked);
    c->trial->ms[TURN_CHECK][sample] = peer_clock_ms() - since;
    c->trial->our_pairs = c->checked.count;
    return status == CSCD_OK || io_fail(error, "%s: %s", s->name, cscd_context_detail(c->checker->context));
}

static cscd_status check_once(const peer_scene *s, size_t *count) {
    const cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_intersections found = {.count = 0};
    options.thread_count = 1;
    detector_options.method = CSCD_METHOD_NONE;
    cscd_status status = cscd_context_create(&options, &context);
    if (status == CSCD_OK) status = cscd_mesh_create(context, &desc, 1, &mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, NULL, &detector_options, &detector);
    if (status == CSCD_OK)
        status = cscd_detector_check(detector, CSCD_DOUBLES(s->start, s->vertex_count), &found);
    *count = found.count;
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return status;
}

static bool check_new(peer_contestants *c, uint32_t sample, io_error *error) {
    size_t count;
    double since = peer_clock_ms();
    cscd_status status = check_once(c->scene, &count);
    c->trial->ms[TURN_ONE_SHOT][sample] = peer_clock_ms() - since;
    if (status != CSCD_OK) return io_fail(error, "%s: %s", c->scene->name, cscd_status_string(status));
    return count == c->trial->our_pairs ||
           io_fail(error, "%s: a new detector checks to other pairs", c->scene->name);
}

/* Counts what one side lists and the other does not; both lists are sorted. */
static void compare_pairs(const cscd_intersections *ours, const cgal_pairs *theirs, peer_trial *t) {
    size_t i = 0, k = 0;
    t->ours_alone = t->cgal_alone = 0;
    while (i < ours->count || k < theirs->count) {
        uint64_t a = i < ours->count ? (uint64_t)ours->items[i].a << 32 | ours->items[i].b : UINT64_MAX;
        uint64_t b =
            k < theirs->count ? (uint64_t)theirs->items[k][0] << 32 | theirs->items[k][1] : UINT64_MAX;
        i += a <= b;
        k += b <= a;
        t->ours_alone += a < b;
        t->cgal_alone += b < a;
    }
}

static bool check_cgal(peer_contestants *c, uint32_t sample, io_error *error) {
    const peer_scene *s = c->scene;
    peer_trial *t = c->trial;
    cgal_pairs found;
    const char *problem = cgal_peer_check(s->start, s->vertex_count, s->triangles, s->triangle_count, &found);
    if (problem == NULL) {
        t->cgal_left_out = found.left_out;
        t->ms[TURN_CGAL_SETUP][sample] = found.setup_ms;
        t->ms[TURN_CGAL][sample] = found.setup_ms + found.find_ms;
        t->cgal_pairs = found.count;
        if (found.left_out == 0) compare_pairs(&c->checked, &found, t);
    }
    free(found.items);
    return problem == NULL || io_fail(error, "%s: CGAL says: %s", s->name, problem);
}

/* ---- rounds -------------------------------------------------------------------------------------------- */

bool peer_trial_run(const peer_scene *s, uint32_t rounds, peer_trial *out, io_error *error) {
    peer_contestants c = {.trial = out};
    *out = (peer_trial){.rounds = rounds};
    bool good = open_contestants(s, &c, error);
    for (uint32_t i = 0; good && i <= rounds; i++) {
        uint32_t sample = i == 0 ? 0 : i - 1; /* what the first round writes is written over */
        good = step_ours(&c, sample, error) && step_embree(&c, sample, error) &&
               check_known(&c, sample, error) && check_new(&c, sample, error) &&
               check_cgal(&c, sample, error);
    }
    close_contestants(&c);
    return good;
}
