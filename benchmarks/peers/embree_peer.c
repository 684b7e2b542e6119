/* Embree's broad phase: rtcCollide of a scene with itself, the boxes of the swept triangles as user geometry. In a scene
 * of low quality Embree refits, but reports pairs of leaves of several boxes, so the callback tests the boxes. Pairs are reported
 * twice, once in each order, and pairs of neighbours too. */
#include "benchmarks/peers/peer_scenes.h"

#include "benchmarks/peers/peer_clock.h"
#include "models/shapes/body.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>

const char embree_peer_version[] = RTC_VERSION_STRING;

typedef struct swept_bounds {
    float low[3], high[3];
} swept_bounds;

struct embree_peer {
    const peer_scene *interval;
    swept_bounds *boxes;
    uint64_t reported, pairs;
    RTCDevice device;
    RTCScene scene;
    RTCGeometry geometry;
    bool attached;
};

/* ---- callbacks --------------------------------------------------------------------------------------- */

static float round_up(double x) {
    return (float)(x + (fabs(x) * 0x1p-23 + 0x1p-149));
}

/* Returns the box of a swept triangle, rounded outward. */
static swept_bounds swept_box(const peer_scene *s, uint32_t triangle) {
    const uint32_t *corners = s->triangles + (size_t)triangle * 3;
    double low[3], high[3];
    swept_bounds out;
    for (int k = 0; k < 3; k++) low[k] = high[k] = s->start[(size_t)corners[0] * 3 + (size_t)k];
    for (int i = 0; i < 3; i++) {
        const double *ends[2] = {s->start + (size_t)corners[i] * 3, s->end + (size_t)corners[i] * 3};
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
    embree_peer *p = arguments->geometryUserPtr;
    struct RTCBounds *to = arguments->bounds_o;
    swept_bounds b = p->boxes[arguments->primID] = swept_box(p->interval, arguments->primID);
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
    embree_peer *p = user;
    p->reported += count;
    for (unsigned int i = 0; i < count; i++) {
        const struct RTCCollision *c = &collisions[i];
        p->pairs += c->primID0 < c->primID1 && boxes_overlap(&p->boxes[c->primID0], &p->boxes[c->primID1]);
    }
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

embree_peer *embree_peer_open(const peer_scene *scene, bool refit, io_error *error) {
    RTCDevice device = rtcNewDevice("threads=1");
    if (device == NULL) {
        io_fail(error, "Embree gives no device");
        return NULL;
    }
    embree_peer *p = body_allocate(1, sizeof *p);
    *p = (embree_peer){.interval = scene, .device = device};
    p->boxes = body_allocate(scene->triangle_count, sizeof *p->boxes);
    p->scene = rtcNewScene(device);
    p->geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetSceneFlags(p->scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(p->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(p->geometry, refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(p->geometry, scene->triangle_count);
    rtcSetGeometryUserData(p->geometry, p);
    rtcSetGeometryBoundsFunction(p->geometry, give_bounds, NULL);
    return p;
}

void embree_peer_close(embree_peer *p) {
    if (p == NULL) return;
    rtcReleaseGeometry(p->geometry);
    rtcReleaseScene(p->scene);
    rtcReleaseDevice(p->device);
    free(p->boxes);
    free(p);
}

bool embree_peer_step(embree_peer *p, embree_pairs *out, io_error *error) {
    double since = peer_clock_ms();
    *out = (embree_pairs){.update_ms = 0.0};
    rtcCommitGeometry(p->geometry);
    if (!p->attached) rtcAttachGeometry(p->scene, p->geometry);
    p->attached = true;
    rtcCommitScene(p->scene);
    out->update_ms = peer_clock_ms() - since;
    since = peer_clock_ms();
    p->reported = p->pairs = 0;
    rtcCollide(p->scene, p->scene, take_pairs, p);
    out->find_ms = peer_clock_ms() - since;
    out->reported = p->reported;
    out->pairs = p->pairs;
    return rtcGetDeviceError(p->device) == RTC_ERROR_NONE || io_fail(error, "Embree reports an error");
}
