/* An animation of a glTF file, keys of placements and weights over time; and the frames of a file: its scene,
 * moved by one of them. */
#include "tool/io/gltf/gltf_scene.h"

#include "tool/io/format_reader.h"
#include "tool/io/io.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- animations ---------------------------------------------------------------------------------------- */

typedef enum gltf_path { GLTF_TRANSLATION, GLTF_ROTATION, GLTF_SCALE, GLTF_WEIGHTS } gltf_path;
typedef enum gltf_interpolation { GLTF_LINEAR, GLTF_STEP, GLTF_CUBICSPLINE } gltf_interpolation;

/* The keys that move one property of one node. */
typedef struct gltf_channel {
    uint32_t node;
    gltf_path path;
    gltf_interpolation interpolation;
    uint32_t width; /* numbers of a key: 3, 4, or as many as there are weights */
    gltf_accessor times, values;
} gltf_channel;

typedef struct gltf_animation {
    gltf_channel *channels;
    uint32_t channel_count;
    double start, end; /* the first and the last key of all channels, in seconds */
} gltf_animation;

/* ---- the choice of an animation ------------------------------------------------------------------------ */

/* The longest name of an animation in a list; a longer one is cut. */
enum { SHOWN_NAME_LENGTH = 60 };

static const char *name_of(const gltf_element *element) {
    const char *name = gltf_string(element, "name");
    return name != NULL ? name : "(no name)";
}

/* The number of animations, and the names of all; "..." stands for those that do not fit into size, which is
 * 16 or more. */
static bool gltf_animation_names(const gltf_scene *scene, size_t *count, char *text, size_t size) {
    const gltf_element *root = &scene->document.root;
    size_t used = 0;
    text[0] = '\0';
    if (!gltf_array_length(root, "animations", count)) return false;
    for (size_t i = 0; i < *count; i++) {
        gltf_element element;
        if (!gltf_element_at(root, "animations", "animation", i, &element)) return false;
        const char *comma = i > 0 ? ", " : "", *name = name_of(&element);
        const int length = text_cut_length(name, SHOWN_NAME_LENGTH);
        if (used + (size_t)length + sizeof ", , ..." > size) {
            snprintf(text + used, size - used, "%s...", comma);
            break;
        }
        used += (size_t)snprintf(text + used, size - used, "%s%.*s", comma, length, name);
    }
    return true;
}

static bool find_animation(gltf_scene *scene, const char *name, gltf_element *out) {
    const gltf_element *root = &scene->document.root;
    size_t count;
    if (!gltf_array_length(root, "animations", &count)) return false;
    if (count == 0)
        return gltf_fail(root, "holds no animation, so it has no frames; export it with its animations");
    for (size_t i = 0; i < count; i++) {
        gltf_element element;
        if (!gltf_element_at(root, "animations", "animation", i, &element)) return false;
        const char *own = gltf_string(&element, "name");
        if (name == NULL || (own != NULL && strcmp(own, name) == 0)) {
            *out = element;
            return true;
        }
    }
    char names[300];
    if (!gltf_animation_names(scene, &count, names, sizeof names)) return false;
    return gltf_fail(root, "holds no animation %.*s, but: %s", TEXT_CUT(name, 100), names);
}

/* ---- channels ---------------------------------------------------------------------------------------- */

static bool read_path(const gltf_element *target, gltf_path *path, bool *known) {
    static const char *const names[] = {"translation", "rotation", "scale", "weights"};
    const char *name = gltf_string(target, "path");
    if (name == NULL) return gltf_fail(target, "target.path is missing");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0) {
            *path = (gltf_path)i;
            return true;
        }
    *known = false; /* of an extension: it moves no vertex that we know of */
    return true;
}

static bool read_interpolation(const gltf_element *sampler, gltf_interpolation *out) {
    static const char *const names[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    const char *name = gltf_string(sampler, "interpolation");
    *out = GLTF_LINEAR;
    if (name == NULL) return true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0) {
            *out = (gltf_interpolation)i;
            return true;
        }
    return gltf_fail(sampler, "interpolation is %.*s, expected LINEAR, STEP or CUBICSPLINE",
                     TEXT_CUT(name, 40));
}

/* Reads which node a channel moves, and what of it; *moves becomes false when this channel moves no vertex of
 * the scene. */
static bool read_target(const gltf_scene *scene, const gltf_element *element, gltf_channel *channel,
                        bool *moves) {
    gltf_element target;
    *moves = true;
    if (!gltf_object(element, "target", &target)) return false;
    if (target.value == NULL) return gltf_fail(element, "target is missing");
    channel->node = GLTF_NONE;
    if (!gltf_index(&target, "node", "nodes", scene->nodes.count, &channel->node) ||
        !read_path(&target, &channel->path, moves))
        return false;
    *moves = *moves && channel->node != GLTF_NONE;
    if (!*moves) return true;
    const gltf_node *node = &scene->nodes.nodes[channel->node];
    channel->width = channel->path == GLTF_ROTATION ? 4 : 3;
    if (channel->path == GLTF_WEIGHTS) {
        channel->width = node->mesh == GLTF_NONE ? 0 : scene->meshes[node->mesh].target_count;
        *moves = channel->width > 0;
    } else if (node->has_matrix) {
        return gltf_fail(
            element, "moves node %" PRIu32 ", which has a matrix, expected translation, rotation and scale",
            channel->node);
    }
    return true;
}

static bool check_times(const gltf_element *sampler, const gltf_accessor *times) {
    double before = -INFINITY;
    for (uint32_t i = 0; i < times->count; i++) {
        double time;
        gltf_accessor_get(times, i, &time);
        if (!isfinite(time) || time < before)
            return gltf_fail(sampler, "the time of key %" PRIu32 " is %g, after %g: expected rising times", i,
                             time, before);
        before = time;
    }
    return true;
}

static bool read_sampler(gltf_scene *scene, const gltf_element *animation, const gltf_element *element,
                         gltf_channel *channel) {
    size_t count;
    uint32_t index = GLTF_NONE;
    gltf_element sampler;
    if (!gltf_array_length(animation, "samplers", &count) ||
        !gltf_index(element, "sampler", "samplers of this animation", count, &index))
        return false;
    if (index == GLTF_NONE) return gltf_fail(element, "sampler is missing");
    const uint32_t components = channel->path == GLTF_WEIGHTS ? 1 : channel->width;
    if (!gltf_element_at(animation, "samplers", "sampler", index, &sampler) ||
        !read_interpolation(&sampler, &channel->interpolation) ||
        !gltf_accessor_require(&scene->document, &sampler, "input", 1, &channel->times) ||
        !gltf_accessor_require(&scene->document, &sampler, "output", components, &channel->values) ||
        !check_times(&sampler, &channel->times))
        return false;
    const uint64_t per_key = (channel->path == GLTF_WEIGHTS ? channel->width : 1) *
                             (channel->interpolation == GLTF_CUBICSPLINE ? UINT64_C(3) : 1);
    if (channel->values.count == channel->times.count * per_key) return true;
    return gltf_fail(&sampler, "has %" PRIu32 " times and %" PRIu32 " values, expected %" PRIu64 " values",
                     channel->times.count, channel->values.count, channel->times.count * per_key);
}

static void widen_span(gltf_animation *animation, const gltf_channel *channel) {
    double first, last;
    gltf_accessor_get(&channel->times, 0, &first);
    gltf_accessor_get(&channel->times, channel->times.count - 1, &last);
    if (animation->channel_count == 0 || first < animation->start) animation->start = first;
    if (animation->channel_count == 0 || last > animation->end) animation->end = last;
}

static bool read_channels(gltf_scene *scene, const gltf_element *element, size_t count,
                          gltf_animation *animation) {
    for (size_t i = 0; i < count; i++) {
        gltf_element channel_element;
        gltf_channel channel;
        bool moves;
        if (!gltf_element_at(element, "channels", "channel", i, &channel_element) ||
            !read_target(scene, &channel_element, &channel, &moves))
            return false;
        if (!moves) continue;
        if (!read_sampler(scene, element, &channel_element, &channel)) return false;
        widen_span(animation, &channel);
        animation->channels[animation->channel_count++] = channel;
    }
    if (animation->channel_count > 0) return true;
    return gltf_fail(element, "moves no node of the scene, so it has no frames");
}

static void gltf_animation_close(gltf_animation *animation) {
    free(animation->channels);
    *animation = (gltf_animation){0};
}

/* The animation of this name, or with NULL the first one. On false *out owns nothing, and the error of the
 * scene's reader is set. */
static bool gltf_animation_open(gltf_scene *scene, const char *name, gltf_animation *out) {
    gltf_element element;
    size_t count;
    gltf_animation animation = {0};
    if (!find_animation(scene, name, &element) || !gltf_array_length(&element, "channels", &count))
        return false;
    animation.channels = gltf_allocate(scene->document.reader, count, sizeof *animation.channels);
    if (animation.channels == NULL || !read_channels(scene, &element, count, &animation)) {
        gltf_animation_close(&animation);
        return false;
    }
    *out = animation;
    return true;
}

/* ---- the values of an animation between its keys: constant, linear, or a cubic spline -------------------- */

/* Four times the rounding of a float. */
static bool gltf_same_time(double a, double b) {
    return fabs(a - b) <= 0x1p-22 * fmax(fabs(a), fabs(b));
}

/* The place of a time among the keys of a channel. */
typedef struct key_place {
    uint32_t key;    /* at or before the time, unless that is before the first key */
    double share;    /* of the way to the next key, 0 to 1; 0 also behind the last one */
    double interval; /* from this key to the next, in seconds */
} key_place;

static double key_time(const gltf_channel *channel, uint32_t key) {
    double time;
    gltf_accessor_get(&channel->times, key, &time);
    return time;
}

/* A key whose time was rounded past a frame's time belongs to that frame: otherwise a constant piece would
 * begin a frame late. */
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

/* Number `column` of a key: its value, or in splines also its tangents (part 0: into the key, 1: the value,
 * 2: out of it). */
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

/* Moves the pose to this time; before its first key a channel holds that, and behind its last one that. */
static void gltf_animation_apply(const gltf_animation *animation, double time, gltf_pose *pose) {
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

/* ---- frames -------------------------------------------------------------------------------------------- */

struct gltf_frames {
    file_reader reader;
    gltf_scene scene;
    gltf_animation animation;
    gltf_pose pose;
    double fps;
    uint32_t count;
    char note[400]; /* "": nothing to say */
    char path[];    /* the reader's */
};

/* A frame for each step of 1 / fps from the start on; the end counts when the last step meets it, rounding
 * aside. */
static bool count_frames(gltf_frames *frames) {
    const double start = frames->animation.start, end = frames->animation.end;
    double steps = floor((end - start) * frames->fps);
    if (gltf_same_time(start + (steps + 1) / frames->fps, end)) steps++;
    if (!(steps < INT32_MAX))
        return file_reader_fail(&frames->reader, "%g frames in %g seconds, expected %" PRIu32 " at most",
                                steps + 1, end - start, UINT32_MAX);
    frames->count = (uint32_t)steps + 1;
    return true;
}

/* Whoever has several animations in a file may have meant another one. */
static bool write_note(gltf_frames *frames, const char *name) {
    char names[300];
    size_t count;
    if (!gltf_animation_names(&frames->scene, &count, names, sizeof names)) return false;
    if (count > 1 && name == NULL)
        snprintf(frames->note, sizeof frames->note, "the first of %zu animations is played: %s", count,
                 names);
    return true;
}

static bool open_frames(gltf_frames *frames, uint32_t vertex_count, const char *name) {
    if (!gltf_scene_open(&frames->reader, &frames->scene)) return false;
    if (frames->scene.vertex_count != vertex_count)
        return file_reader_fail(&frames->reader,
                                "holds %" PRIu32 " vertices, the model has %" PRIu32
                                " vertices: it was exported from another mesh",
                                frames->scene.vertex_count, vertex_count);
    return gltf_animation_open(&frames->scene, name, &frames->animation) &&
           gltf_pose_open(&frames->scene, &frames->pose) && count_frames(frames) && write_note(frames, name);
}

bool gltf_frames_open(const char *path, uint32_t vertex_count, double fps, const char *name,
                      gltf_frames **out, io_error *error) {
    const size_t size = strlen(path) + 1;
    if (!(fps > 0 && isfinite(fps)))
        return io_fail(error, "%s: %g frames a second, expected more than 0", path, fps);
    gltf_frames *frames = io_realloc(NULL, sizeof *frames + size);
    if (frames == NULL) return io_fail(error, "%s: out of memory", path);
    *frames = (gltf_frames){.fps = fps};
    memcpy(frames->path, path, size);
    if (!file_reader_open(&frames->reader, frames->path, error) || !open_frames(frames, vertex_count, name)) {
        gltf_frames_close(frames);
        return false;
    }
    *out = frames;
    return true;
}

void gltf_frames_close(gltf_frames *frames) {
    if (frames == NULL) return;
    gltf_pose_close(&frames->pose);
    gltf_animation_close(&frames->animation);
    gltf_scene_close(&frames->scene);
    file_reader_close(&frames->reader);
    free(frames);
}

uint32_t gltf_frames_count(const gltf_frames *frames) {
    return frames->count;
}

const char *gltf_frames_note(const gltf_frames *frames) {
    return frames->note[0] != '\0' ? frames->note : NULL;
}

int32_t gltf_frames_number(const gltf_frames *frames, uint32_t frame) {
    const double first = round(frames->animation.start * frames->fps);
    return first + frame > INT32_MAX || first < INT32_MIN ? (int32_t)frame : (int32_t)(first + frame);
}

bool gltf_frames_read(gltf_frames *frames, uint32_t frame, double *positions, io_error *error) {
    const double time = frames->animation.start + frame / frames->fps;
    io_error cause;
    frames->reader.error = &cause;
    gltf_animation_apply(&frames->animation, time, &frames->pose);
    const bool done = gltf_pose_write(&frames->pose, positions);
    frames->reader.error = NULL;
    return done || io_fail(error, "%s (at %g s)", cause.text, time);
}
