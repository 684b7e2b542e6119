/* Loads saved states of event trackers, and lets the trackers do all that they can do afterwards. */
#include "tests/fuzz/tracker_reading.h"

#include "tool/io/file_reader.h"

#include <cscd/cscd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_SIZE = 8, RIGHT_NUMBERS = 2 };

static void insist_on(bool held, const char *what) {
    if (held) return;
    fprintf(stderr, "tracker: %s\n", what);
    abort();
}

/* The sum of runtime/events/event_state.c over all numbers but the last one, which becomes it. */
static void write_sum(unsigned char *bytes, size_t size) {
    uint64_t hash = 0;
    const size_t end = size / NUMBER_SIZE * NUMBER_SIZE - NUMBER_SIZE;
    for (size_t at = 0; at < end; at += NUMBER_SIZE) {
        uint64_t number = 0;
        for (size_t i = 0; i < NUMBER_SIZE; i++) number |= (uint64_t)bytes[at + i] << 8 * i;
        hash = (hash ^ number) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    for (size_t i = 0; i < NUMBER_SIZE; i++) bytes[end + i] = (unsigned char)(hash >> 8 * i);
}

static cscd_mesh *make_mesh(cscd_context *context) {
    static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const cscd_object_desc tetrahedron = cscd_object_of_triangles(4, 4, triangles);
    const cscd_object_desc both[] = {tetrahedron, tetrahedron};
    cscd_mesh *mesh = NULL;
    insist_on(cscd_mesh_create(context, both, 2, &mesh) == CSCD_OK, "the mesh is refused");
    return mesh;
}

static cscd_event_tracker *make_tracker(cscd_context *context, const cscd_mesh *mesh, bool later_chunk) {
    cscd_event_options options = cscd_event_defaults();
    cscd_event_tracker *tracker = NULL;
    options.gap = 1;
    options.rings = 1;
    options.later_chunk = later_chunk;
    insist_on(cscd_event_tracker_create(context, mesh, &options, &tracker) == CSCD_OK, "no tracker is made");
    return tracker;
}

/* Makes right what a damaged state cannot have. */
static void mend_bytes(cscd_event_tracker *empty, unsigned char *bytes, size_t size) {
    const uint8_t *whole;
    size_t whole_size;
    if (size < (RIGHT_NUMBERS + 1) * NUMBER_SIZE) return;
    insist_on(cscd_event_tracker_save(empty, &whole, &whole_size) == CSCD_OK, "an empty one is not saved");
    memcpy(bytes, whole, RIGHT_NUMBERS * NUMBER_SIZE);
    write_sum(bytes, size);
    unsigned char *copy = malloc(whole_size);
    insist_on(copy != NULL, "out of memory");
    memcpy(copy, whole, whole_size);
    write_sum(copy, whole_size);
    insist_on(memcmp(copy, whole, whole_size) == 0, "states are summed up otherwise now: see write_sum");
    free(copy);
}

/* What was loaded is saved as it came, takes frames, is merged into others and gives out events. */
static void use_tracker(cscd_context *context, const cscd_mesh *mesh, cscd_event_tracker *loaded) {
    static const cscd_intersection_pair touched = {.a = 1, .b = 6, .kind = CSCD_INTERSECTION_CROSSING};
    const cscd_intersection_pairs found = {.items = &touched, .count = 1, .crossing = 1};
    const uint8_t *bytes;
    size_t size;
    cscd_events events;
    cscd_event_tracker *all = make_tracker(context, mesh, false);
    insist_on(cscd_event_tracker_save(loaded, &bytes, &size) == CSCD_OK, "it is not saved again");
    insist_on(cscd_event_tracker_load(loaded, bytes, size) == CSCD_OK, "what it saved is refused");
    cscd_event_tracker_add_frame(all, 0, &found); /* which some states do not come after */
    cscd_event_tracker_merge(all, loaded);
    cscd_event_tracker_add_frame(all, UINT64_MAX - 1, &found);
    insist_on(cscd_event_tracker_take(all, &events) == CSCD_OK, "no events are taken");
    insist_on(cscd_event_tracker_finish(all, &events) == CSCD_OK, "the merged one does not finish");
    cscd_event_tracker_add_frame(loaded, UINT64_MAX - 1, &found);
    insist_on(cscd_event_tracker_finish(loaded, &events) == CSCD_OK, "the loaded one does not finish");
    cscd_event_tracker_destroy(all);
}

bool tracker_reading(const char *path, io_error *error) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    file_reader reader;
    options.thread_count = 1;
    if (!file_reader_open(&reader, path, error)) return false;
    insist_on(cscd_context_create(&options, &context) == CSCD_OK, "no context is made");
    cscd_mesh *mesh = make_mesh(context);
    cscd_event_tracker *tracker = make_tracker(context, mesh, true);
    mend_bytes(tracker, (unsigned char *)reader.bytes, reader.size);
    const bool loaded =
        cscd_event_tracker_load(tracker, (const uint8_t *)reader.bytes, reader.size) == CSCD_OK;
    if (loaded)
        use_tracker(context, mesh, tracker);
    else
        io_fail(error, "%s: %s", path, cscd_context_detail(context));
    cscd_event_tracker_destroy(tracker);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    file_reader_close(&reader);
    return loaded;
}
