/* Reads an animation of a glTF file: which of them, its channels, and when it begins and ends. */
#include "tool/io/gltf/gltf_animation.h"

#include "tool/io/text_escape.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- which animation --------------------------------------------------------------------------------- */

/* Of each animation in a list; a longer name is cut. */
enum { SHOWN_NAME_LENGTH = 60 };

static const char *name_of(const gltf_element *element) {
    const char *name = gltf_string(element, "name");
    return name != NULL ? name : "(no name)";
}

bool gltf_animation_names(const gltf_scene *scene, size_t *count, char *text, size_t size) {
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

/* Which node, and what of it; *moves becomes false when this channel moves no vertex of the scene. */
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

bool gltf_animation_open(gltf_scene *scene, const char *name, gltf_animation *out) {
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

void gltf_animation_close(gltf_animation *animation) {
    free(animation->channels);
    *animation = (gltf_animation){0};
}
