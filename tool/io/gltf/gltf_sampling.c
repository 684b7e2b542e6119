/* The values of an animation between its keys: constant, linear, or a cubic spline. */
#include "tool/io/gltf/gltf_animation.h"

#include <math.h>

/* Four times the rounding of a float. */
bool gltf_same_time(double a, double b) {
    return fabs(a - b) <= 0x1p-22 * fmax(fabs(a), fabs(b));
}

/* Where a time lies among the keys of a channel. */
typedef struct key_place {
    uint32_t key;    /* at or before the time, but for times before the first key */
    double share;    /* of the way to the next key, 0 to 1; 0 also behind the last one */
    double interval; /* from this key to the next, in seconds */
} key_place;

static double key_time(const gltf_channel *channel, uint32_t key) {
    double time;
    gltf_accessor_get(&channel->times, key, &time);
    return time;
}

/* A key whose time was rounded past a frame's time belongs to that frame: otherwise a constant piece would begin a frame
 * late. */
static key_place find_place(const gltf_channel *channel, double time) {
    uint32_t low = 0,
             high = channel->times.count; /* keys below low are not behind the time, those from high on are */
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const double at = key_time(channel, middle);
        if (at <= time || gltf_same_time(at, time))
            low = middle + 1;
        else
            high = middle;
    }
    key_place place = {.key = low > 0 ? low - 1 : 0};
    if (low == 0 || low == channel->times.count) return place;
    const double before = key_time(channel, place.key), after = key_time(channel, low);
    place.interval = after - before;
    if (!gltf_same_time(before, time) && place.interval > 0) place.share = (time - before) / place.interval;
    return place;
}

/* Number `column` of a key: its value, or in splines also its tangents (part 0: into the key, 1: the value, 2: out of it). */
static double key_number(const gltf_channel *channel, uint32_t key, uint32_t part, uint32_t column) {
    const uint32_t elements = channel->path == GLTF_WEIGHTS ? channel->width : 1;
    const uint32_t parts = channel->interpolation == GLTF_CUBICSPLINE ? 3 : 1;
    double numbers[4];
    uint32_t element = (key * parts + (parts == 3 ? part : 0)) * elements;
    if (channel->path == GLTF_WEIGHTS) element += column;
    gltf_accessor_get(&channel->values, element, numbers);
    return numbers[channel->path == GLTF_WEIGHTS ? 0 : column];
}

static double spline_number(const gltf_channel *channel, key_place place, uint32_t column) {
    const double s = place.share, s2 = s * s, s3 = s2 * s;
    const double p0 = key_number(channel, place.key, 1, column),
                 p1 = key_number(channel, place.key + 1, 1, column);
    const double m0 = place.interval * key_number(channel, place.key, 2, column);
    const double m1 = place.interval * key_number(channel, place.key + 1, 0, column);
    return (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * p1 + (s3 - s2) * m1;
}

static double interpolated_number(const gltf_channel *channel, key_place place, uint32_t column) {
    const double value = key_number(channel, place.key, 1, column);
    if (place.share == 0 || channel->interpolation == GLTF_STEP) return value;
    if (channel->interpolation == GLTF_CUBICSPLINE) return spline_number(channel, place, column);
    return value + place.share * (key_number(channel, place.key + 1, 1, column) - value);
}

/* The shorter of the two turns between the keys, at constant speed. */
static void turn_between(const gltf_channel *channel, key_place place, double *out) {
    double a[4], b[4], cosine = 0, sine = 0;
    for (uint32_t i = 0; i < 4; i++) {
        a[i] = key_number(channel, place.key, 1, i);
        b[i] = key_number(channel, place.key + 1, 1, i);
    }
    for (int i = 0; i < 4; i++) cosine += a[i] * b[i];
    for (int i = 0; i < 4; i++) b[i] = cosine < 0 ? -b[i] : b[i];
    for (int i = 0; i < 4; i++)
        for (int k = i + 1; k < 4; k++) sine += (a[i] * b[k] - a[k] * b[i]) * (a[i] * b[k] - a[k] * b[i]);
    /* The angle from both, which is exact for small and for right angles alike. */
    const double angle = atan2(sqrt(sine), fabs(cosine)), s = sin(angle);
    const double of_a = s > 1e-9 ? sin((1 - place.share) * angle) / s : 1 - place.share;
    const double of_b = s > 1e-9 ? sin(place.share * angle) / s : place.share;
    for (int i = 0; i < 4; i++) out[i] = of_a * a[i] + of_b * b[i];
}

static void sample_channel(const gltf_channel *channel, double time, double *out) {
    const key_place place = find_place(channel, time);
    if (channel->path == GLTF_ROTATION && channel->interpolation == GLTF_LINEAR && place.share > 0) {
        turn_between(channel, place, out);
        return;
    }
    for (uint32_t i = 0; i < channel->width; i++) out[i] = interpolated_number(channel, place, i);
}

void gltf_animation_apply(const gltf_animation *animation, double time, gltf_pose *pose) {
    for (uint32_t i = 0; i < animation->channel_count; i++) {
        const gltf_channel *channel = &animation->channels[i];
        gltf_placement *placement = &pose->placements[channel->node];
        switch (channel->path) {
        case GLTF_TRANSLATION:
            sample_channel(channel, time, placement->translation);
            break;
        case GLTF_ROTATION:
            sample_channel(channel, time, placement->rotation);
            break;
        case GLTF_SCALE:
            sample_channel(channel, time, placement->scale);
            break;
        case GLTF_WEIGHTS:
            sample_channel(channel, time, pose->weights + pose->first_weight[channel->node]);
            break;
        }
    }
    gltf_pose_update(pose);
}
