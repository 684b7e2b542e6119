/* Parts that are inside out, and parts without a surface: in which frames. */
#include "tool/answers/answers.h"

#include "tool/common/command.h"
#include "tool/io/io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THINGS_NAMED = 3 };

bool turned_parts_open(const recording *r, const part_names *names, turned_parts *out) {
    const uint32_t count = cscd_mesh_component_count(r->mesh), triangles = cscd_mesh_triangle_count(r->mesh);
    turned_parts t = {.recording = r, .names = names};
    t.components = io_zeroed(((size_t)count + 1) * sizeof *t.components);
    t.parts = io_zeroed(((size_t)count + 1) * sizeof *t.parts);
    if (t.components == NULL || t.parts == NULL) {
        turned_parts_close(&t);
        return false;
    }
    const uint32_t *labels = cscd_mesh_array(r->mesh, CSCD_TRIANGLE_COMPONENTS);
    for (uint32_t i = triangles; i-- > 0;) t.parts[labels[i]] = names->labels[i];
    *out = t;
    return true;
}

void turned_parts_close(turned_parts *t) {
    free(t->components);
    free(t->parts);
    *t = (turned_parts){0};
}

static void count_frame(turned_frames *f, uint32_t frame) {
    if (f->count++ == 0) f->first = frame;
    f->last = frame;
}

void turned_parts_add(turned_parts *t, uint32_t frame, const bool *turned) {
    bool any = false;
    t->frame_count++;
    for (uint32_t c = 0; turned != NULL && c < cscd_mesh_component_count(t->recording->mesh); c++) {
        if (turned[c]) count_frame(&t->components[c], frame);
        any |= turned[c];
    }
    if (any) count_frame(&t->any, frame);
}

/* ---- for people ------------------------------------------------------------------------------------------ */

/* Closed components of a part, and how many of these were ever turned. */
typedef struct part_share {
    uint32_t turned, closed;
} part_share;

static uint32_t place_of_part(const turned_parts *t, uint32_t component) {
    const uint32_t part = t->parts[component];
    return part < t->names->count ? part : t->names->count;
}

/* Per part, and of what is in none; NULL: out of memory. */
static part_share *count_shares(const turned_parts *t) {
    part_share *shares = io_zeroed(((size_t)t->names->count + 1) * sizeof *shares);
    for (uint32_t c = 0; shares != NULL && c < cscd_mesh_component_count(t->recording->mesh); c++) {
        part_share *share = &shares[place_of_part(t, c)];
        share->closed += cscd_mesh_component(t->recording->mesh, c).closed_manifold;
        share->turned += t->components[c].count > 0;
    }
    return shares;
}

static size_t add_thing(const turned_parts *t, uint32_t part, const part_share *share, char *text,
                        size_t size) {
    const bool some = share->turned < share->closed;
    int length = 0;
    if (some) length = snprintf(text, size, "%u of %u components of ", share->turned, share->closed);
    if (part == t->names->count)
        return (size_t)length + (size_t)snprintf(text + length, size - (size_t)length, "what is in no part");
    return (size_t)length + (size_t)snprintf(text + length, size - (size_t)length, "part %.80s",
                                             part_names_at(t->names, part));
}

/* "part A, part B and 1 of 3 components of part C". Returns whether it is one thing. */
static bool list_things(const turned_parts *t, const part_share *shares, char *text, size_t size) {
    size_t count = 0, named = 0, length = 0;
    bool one = true;
    for (uint32_t i = 0; i <= t->names->count; i++) count += shares[i].turned > 0;
    for (uint32_t i = 0; i <= t->names->count && named < THINGS_NAMED; i++) {
        if (shares[i].turned == 0) continue;
        const bool last = ++named == count;
        if (named > 1) length += (size_t)snprintf(text + length, size - length, last ? " and " : ", ");
        length += add_thing(t, i, &shares[i], text + length, size - length);
        one = count == 1 && (shares[i].turned == 1 || shares[i].turned == shares[i].closed);
    }
    if (count > named) snprintf(text + length, size - length, " and %zu more", count - named);
    return one;
}

static void say_frames(const turned_parts *t, char *text, size_t size) {
    const int32_t *numbers = t->recording->frame_numbers;
    const int32_t first = numbers[t->any.first], last = numbers[t->any.last];
    text[0] = '\0';
    if (t->any.count == t->frame_count) return;
    if (first == last)
        snprintf(text, size, " in frame %d", first);
    else
        snprintf(text, size, " in %u frames, from %d to %d", t->any.count, first, last);
}

void turned_parts_tell(const turned_parts *t) {
    char things[600], frames[80];
    part_share *shares = t->any.count > 0 ? count_shares(t) : NULL;
    if (shares == NULL) return;
    const bool one = list_things(t, shares, things, sizeof things);
    say_frames(t, frames, sizeof frames);
    note("%s %s inside out%s; %s taken as turned around", things, one ? "is" : "are", frames,
         one ? "it was" : "they were");
    free(shares);
}

/* ---- JSON ------------------------------------------------------------------------------------------------ */

void turned_parts_write(const turned_parts *t, json *out) {
    const int32_t *numbers = t->recording->frame_numbers;
    json_begin_array(out, "inside_out");
    for (uint32_t c = 0; c < cscd_mesh_component_count(t->recording->mesh); c++) {
        const turned_frames *f = &t->components[c];
        if (f->count == 0) continue;
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "part", part_names_at(t->names, t->parts[c]));
        json_integer(out, "component", c);
        json_integer(out, "frames", f->count);
        json_signed(out, "first", numbers[f->first]);
        json_signed(out, "last", numbers[f->last]);
        json_end_object(out);
    }
    json_end_array(out);
}

/* ---- parts without a surface, frame by frame ------------------------------------------------------------- */

collapsed_parts collapsed_parts_of(const recording *r, const part_names *names) {
    return (collapsed_parts){.recording = r, .names = names};
}

void collapsed_parts_free(collapsed_parts *c) {
    for (uint32_t i = 0; c->parts != NULL && i < c->names->count; i++) {
        frame_list_free(&c->parts[i].whole);
        frame_list_free(&c->parts[i].partly);
    }
    free(c->parts);
    free(c->sizes);
    free(c->without);
    free(c->components);
    *c = (collapsed_parts){.recording = NULL};
}

/* Most recordings have none, and need nothing of this. */
static bool make_room(collapsed_parts *c) {
    const cscd_mesh *mesh = c->recording->mesh;
    const size_t parts = c->names->count;
    if (c->parts != NULL) return true;
    if (c->sizes == NULL) c->sizes = io_zeroed(parts * sizeof *c->sizes);
    if (c->without == NULL) c->without = io_zeroed(parts * sizeof *c->without);
    if (c->components == NULL)
        c->components = io_zeroed(cscd_mesh_component_count(mesh) * sizeof *c->components);
    if (c->sizes == NULL || c->without == NULL || c->components == NULL) return false;
    c->parts = io_zeroed(parts * sizeof *c->parts);
    for (uint32_t t = 0; c->parts != NULL && t < cscd_mesh_triangle_count(mesh); t++) {
        if (c->names->labels[t] != NO_PART) c->sizes[c->names->labels[t]]++;
    }
    return c->parts != NULL;
}

static void count_without(collapsed_parts *c, const cscd_intersections *found) {
    const cscd_mesh *mesh = c->recording->mesh;
    memset(c->without, 0, c->names->count * sizeof *c->without);
    memset(c->components, 0, cscd_mesh_component_count(mesh) * sizeof *c->components);
    for (uint32_t i = 0; i < found->collapsed; i++) c->components[found->collapsed_components[i]] = true;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        const uint32_t part = c->names->labels[t];
        if (part != NO_PART) c->without[part] += c->components[cscd_mesh_triangle_component(mesh, t)];
    }
}

bool collapsed_parts_add(collapsed_parts *c, uint32_t frame, const cscd_intersections *found) {
    if (found->collapsed == 0) return true;
    if (!make_room(c)) return false;
    count_without(c, found);
    for (uint32_t i = 0; i < c->names->count; i++) {
        if (c->without[i] == 0) continue;
        collapsed_part *part = &c->parts[i];
        if (!frame_list_add(c->without[i] == c->sizes[i] ? &part->whole : &part->partly, frame)) return false;
    }
    return true;
}

const collapsed_part *collapsed_parts_at(const collapsed_parts *c, uint32_t part) {
    if (c->parts == NULL) return NULL;
    const collapsed_part *at = &c->parts[part];
    return at->whole.count + at->partly.count > 0 ? at : NULL;
}
