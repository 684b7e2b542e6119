/* The broad phase beside that of Embree: pairs of triangles whose swept volumes overlap, by refit and
 * self-intersection of the tree. */
#include "benchmarks/lib/options.h"
#include "benchmarks/lib/stages.h"
#include "src/core/timer.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>

static const char help[] =
    "usage: embree [options]\n"
    "\n"
    "The same frames, one thread: Embree's rtcCollide of a scene with itself, the boxes of the swept\n"
    "triangles as user geometry, and cscd's update and traversal, method none. In a scene of low quality\n"
    "Embree refits, but reports pairs of leaves of several boxes, so the callback tests the boxes; pairs are\n"
    "reported twice, once in each order. Pairs: distinct pairs whose boxes (cscd: 14-DOPs) overlap. "
    "Rebuild:\n"
    "the same with a new tree every interval. --threads, --simd and --data mean nothing here.\n"
    "\n";

typedef struct swept_bounds {
    float low[3], high[3];
} swept_bounds;

/* The data of the callbacks. */
typedef struct broad_phase {
    const deforming_body *b;
    const double *start, *end;
    swept_bounds *boxes;
    uint64_t reported, pairs;
    RTCDevice device;
    RTCScene scene;
    RTCGeometry geometry;
    double commit[SAMPLES_MAX], collide[SAMPLES_MAX];
    uint32_t count;
} broad_phase;

/* ---- callbacks --------------------------------------------------------------------------------------- */

static float round_up(double x) {
    return (float)(x + (fabs(x) * 0x1p-23 + 0x1p-149));
}

/* Returns the box of a swept triangle, rounded outward. */
static swept_bounds swept_box(const broad_phase *p, uint32_t triangle) {
    const uint32_t *corners = p->b->triangles + (size_t)triangle * 3;
    double low[3], high[3];
    swept_bounds out;
    for (int k = 0; k < 3; k++) low[k] = high[k] = p->start[(size_t)corners[0] * 3 + (size_t)k];
    for (int i = 0; i < 3; i++) {
        const double *ends[2] = {p->start + (size_t)corners[i] * 3, p->end + (size_t)corners[i] * 3};
        for (int k = 0; k < 6; k++) {
            double x = ends[k / 3][k % 3];
            low[k % 3] = x < low[k % 3] ? x : low[k % 3];
            high[k % 3] = x > high[k % 3] ? x : high[k % 3];
        }
    }
    for (int k = 0; k < 3; k++) {
        out.low[k] = -round_up(-low[k]);
        out.high[k] = round_up(high[k]);
    }
    return out;
}

static void give_bounds(const struct RTCBoundsFunctionArguments *arguments) {
    broad_phase *p = arguments->geometryUserPtr;
    struct RTCBounds *to = arguments->bounds_o;
    swept_bounds b = p->boxes[arguments->primID] = swept_box(p, arguments->primID);
    to->lower_x = b.low[0];
    to->lower_y = b.low[1];
    to->lower_z = b.low[2];
    to->upper_x = b.high[0];
    to->upper_y = b.high[1];
    to->upper_z = b.high[2];
}

static bool boxes_overlap(const swept_bounds *a, const swept_bounds *b) {
    return (a->low[0] <= b->high[0]) & (b->low[0] <= a->high[0]) & (a->low[1] <= b->high[1]) &
           (b->low[1] <= a->high[1]) & (a->low[2] <= b->high[2]) & (b->low[2] <= a->high[2]);
}

static void take_pairs(void *user, struct RTCCollision *collisions, unsigned int count) {
    broad_phase *p = user;
    p->reported += count;
    for (unsigned int i = 0; i < count; i++) {
        const struct RTCCollision *c = &collisions[i];
        p->pairs += c->primID0 < c->primID1 && boxes_overlap(&p->boxes[c->primID0], &p->boxes[c->primID1]);
    }
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

static bool open_scene(const deforming_body *b, enum RTCBuildQuality quality, broad_phase *out,
                       io_error *error) {
    broad_phase *p = out;
    *p = (broad_phase){.b = b, .boxes = body_allocate(b->triangle_count, sizeof *p->boxes)};
    p->device = rtcNewDevice("threads=1");
    if (p->device == NULL) {
        free(p->boxes);
        return io_fail(error, "Embree gives no device");
    }
    p->scene = rtcNewScene(p->device);
    p->geometry = rtcNewGeometry(p->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetSceneFlags(p->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(p->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(p->geometry, quality);
    rtcSetGeometryUserPrimitiveCount(p->geometry, b->triangle_count);
    rtcSetGeometryUserData(p->geometry, p);
    rtcSetGeometryBoundsFunction(p->geometry, give_bounds, NULL);
    return true;
}

static void close_scene(broad_phase *p) {
    rtcReleaseGeometry(p->geometry);
    rtcReleaseScene(p->scene);
    rtcReleaseDevice(p->device);
    free(p->boxes);
}

static bool step_scene(broad_phase *p, const double *start, const double *end, bool counts, io_error *error) {
    double since = timer_now_ms(), commit = 0.0, collide = 0.0;
    bool first = p->start == NULL;
    p->start = start;
    p->end = end;
    rtcCommitGeometry(p->geometry);
    if (first) rtcAttachGeometry(p->scene, p->geometry);
    rtcCommitScene(p->scene);
    timer_lap(&since, &commit);
    p->reported = p->pairs = 0;
    rtcCollide(p->scene, p->scene, take_pairs, p);
    timer_lap(&since, &collide);
    if (rtcGetDeviceError(p->device) != RTC_ERROR_NONE) return io_fail(error, "Embree reports an error");
    if (counts && p->count < SAMPLES_MAX) {
        p->commit[p->count] = commit;
        p->collide[p->count++] = collide;
    }
    return true;
}

/* ---- the program ------------------------------------------------------------------------------------- */

static void print_row(const deforming_body *b, const char *name, double update, double find, double reported,
                      double pairs, json *out) {
    printf("  %9u %-16s %9.3f %9.3f %9.3f %12.0f %10.0f\n", b->triangle_count, name, update, find,
           update + find, reported, pairs);
    fflush(stdout);
    if (out->file == NULL) return;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_integer(out, "triangles", b->triangle_count);
    json_string(out, "who", name);
    json_number(out, "update_ms", update);
    json_number(out, "find_ms", find);
    json_number(out, "reported", reported);
    json_number(out, "pairs", pairs);
    json_end_object(out);
}

static bool run_intervals(const bench_options *o, const deforming_body *b, broad_phase scenes[2], subject *s,
                          io_error *error) {
    size_t size = (size_t)b->vertex_count * 3;
    double *ends = body_allocate(2 * size, sizeof *ends);
    uint32_t intervals = bench_intervals(o, b->triangle_count);
    bool good = true;
    for (uint32_t i = 0; good && i <= intervals; i++) {
        cscd_contacts found;
        deforming_body_interval(b, i, 0.0, ends, ends + size);
        good = step_scene(&scenes[0], ends, ends + size, i > 0, error) &&
               step_scene(&scenes[1], ends, ends + size, i > 0, error) &&
               subject_step(s, ends, ends + size, i > 0, &found, error);
        if (good && scenes[0].pairs != scenes[1].pairs)
            good = io_fail(error, "Embree finds other pairs after a refit than after a rebuild");
    }
    free(ends);
    return good;
}

/* Runs one size. The numbers of pairs are those of the last interval, except for cscd's, which are means. */
static bool run_size(const bench_options *o, uint32_t size, json *out, io_error *error) {
    static const char *const names[] = {"embree, refit", "embree, rebuild"};
    deforming_body b;
    broad_phase scenes[2];
    subject_options options = {CSCD_METHOD_NONE, CSCD_MODE_ALL, 1, CSCD_SIMD_AUTO, CSCD_VOLUME_BOX};
    if (!deforming_body_make(o->kind, size, DEFORM_WAVE, o->shuffled, &b, error)) return false;
    subject *s = subject_make(&b, &options, error);
    bool good = s != NULL;
    int opened = 0;
    for (; good && opened < 2; opened++) {
        good = open_scene(&b, opened == 0 ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW, &scenes[opened],
                          error);
        if (!good) break;
    }
    good = good && run_intervals(o, &b, scenes, s, error);
    for (int i = 0; good && i < 2; i++)
        print_row(&b, names[i], median(scenes[i].commit, scenes[i].count),
                  median(scenes[i].collide, scenes[i].count), (double)scenes[i].reported,
                  (double)scenes[i].pairs, out);
    if (good)
        print_row(&b, "cscd, none", stage_median(&s->samples, stage_named("update")),
                  stage_median(&s->samples, stage_named("travers")), s->samples.pcp / s->samples.count,
                  s->samples.pcp / s->samples.count, out);
    for (int i = 0; i < opened; i++) close_scene(&scenes[i]);
    subject_destroy(s);
    deforming_body_free(&b);
    return good;
}

static bool run_sizes(const bench_options *o, json *out, io_error *error) {
    printf("%s, Embree %s, one thread; milliseconds\n  %9s %-16s %9s %9s %9s %12s %10s\n",
           body_kind_name(o->kind), RTC_VERSION_STRING, "triangles", "", "update", "find", "both", "reported",
           "pairs");
    bool good = true;
    for (uint32_t i = 0; good && i < o->size_count; i++) good = run_size(o, o->sizes[i], out, error);
    return good;
}

int main(int argument_count, char **arguments) {
    static const uint32_t sizes[] = {3000, 10000, 20000, 50000, 150000};
    static const bench_program program = {"embree", help, sizes, 5, 3, run_sizes};
    return bench_main(&program, argument_count, arguments);
}
