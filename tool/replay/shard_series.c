/* Shards of a recording one after the other: the intervals that their files have. */
#include "tool/replay/replay_source.h"

#include <stdlib.h>
#include <string.h>

/* ---- one frame and interval after the other ---------------------------------------------------------------- */

static bool file_is_torn(const shard_series *s, io_error *error) {
    return io_fail(error, "%s: is damaged; start shard %u/%u again with --resume", s->reader.path,
                   s->reader.identity.shard.index, s->reader.identity.shard.count);
}

static bool next_record(shard_series *s, shard_record kind, packed_reader *bytes, io_error *error) {
    shard_record found;
    return (shard_reader_next(&s->reader, &found, bytes) == SHARD_GOES_ON && found == kind) ||
           file_is_torn(s, error);
}

static bool take_frame(shard_series *s, packed_reader *bytes, frame_check *out, io_error *error) {
    const shard_identity *of = &s->reader.identity;
    return step_bytes_take_frame(bytes, &s->place, out, of->object_count, of->component_count) ||
           file_is_torn(s, error);
}

static bool open_reader(shard_series *s, io_error *error) {
    shard_reader_close(&s->reader);
    const shard_entry *entry = &s->entries[s->current];
    if (!shard_reader_open(entry->path, &s->reader, error)) return false;
    s->place.orientations.triangle_count = entry->identity.triangle_count;
    return (entry->identity.object_count <= RECORDING_OBJECTS_MAX + 1 &&
            memcmp(&entry->identity, &s->reader.identity, sizeof entry->identity) == 0) ||
           io_fail(error, "%s: has changed while it was read", entry->path);
}

static void keep_hashes(shard_series *s, const frame_check *check) {
    memcpy(s->hashes, check->hashes, s->reader.identity.object_count * sizeof *s->hashes);
}

bool shard_series_begin(shard_series *s, frame_check *out, io_error *error) {
    packed_reader bytes;
    if (!open_reader(s, error) || !next_record(s, SHARD_FRAME, &bytes, error) ||
        !take_frame(s, &bytes, out, error))
        return false;
    keep_hashes(s, out);
    return true;
}

/* A shard begins with the frame that the one before has ended with, and must have seen the same positions. */
static bool pass_border(shard_series *s, io_error *error) {
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1];
    const char *before = s->entries[s->current].path;
    frame_check check;
    memcpy(hashes, s->hashes, sizeof hashes);
    s->current++;
    if (!shard_series_begin(s, &check, error)) return false;
    return memcmp(hashes, s->hashes, s->reader.identity.object_count * sizeof *hashes) == 0 ||
           io_fail(
               error,
               "%s and %s: their shards have seen different frames; have the files of frames changed in between?",
               before, s->reader.path);
}

static bool current_is_done(const shard_series *s, shard_record *kind, packed_reader *bytes, shard_end *end) {
    shard_reader *r = (shard_reader *)&s->reader;
    *end = shard_reader_next(r, kind, bytes);
    return *end == SHARD_ENDS && s->current + 1 < s->count;
}

bool shard_series_step(shard_series *s, interval_step *out, io_error *error) {
    shard_record kind;
    shard_end end;
    if (current_is_done(s, &kind, &s->rest, &end)) {
        if (!pass_border(s, error)) return false;
        end = shard_reader_next(&s->reader, &kind, &s->rest);
    }
    return (end == SHARD_GOES_ON && kind == SHARD_INTERVAL &&
            step_bytes_take_interval(&s->rest, &s->place, out, s->reader.identity.component_count)) ||
           file_is_torn(s, error);
}

bool shard_series_check(shard_series *s, frame_check *out, io_error *error) {
    if (!take_frame(s, &s->rest, out, error)) return false;
    keep_hashes(s, out);
    return true;
}

void shard_series_close(shard_series *s) {
    shard_reader_close(&s->reader);
    free(s->entries);
    free(s->arguments);
    *s = (shard_series){.entries = NULL};
}

/* ---- are all there? ---------------------------------------------------------------------------------------- */

/* Takes the command line of a reader. */
static void take_arguments(shard_series *s, shard_reader *r) {
    free(s->arguments);
    s->arguments = r->arguments;
    s->argument_count = r->argument_count;
    r->arguments = NULL;
}

/* The number of intervals that a shard has, up to the first that is not whole. */
static uint32_t count_intervals(shard_reader *r) {
    shard_record kind;
    packed_reader bytes;
    uint32_t count = 0;
    while (shard_reader_next(r, &kind, &bytes) == SHARD_GOES_ON) count += kind == SHARD_INTERVAL;
    return count;
}

static bool read_entry(const char *path, shard_series *s, shard_entry *out, io_error *error) {
    shard_reader r;
    if (!shard_reader_open(path, &r, error)) return false;
    *out = (shard_entry){path, r.identity};
    const uint32_t whole = r.identity.shard_last - r.identity.shard_first, have = count_intervals(&r);
    take_arguments(s, &r);
    shard_reader_close(&r);
    return have == whole ||
           io_fail(error, "%s: shard %u/%u has %u of %u intervals; start it again with --resume", path,
                   out->identity.shard.index, out->identity.shard.count, have, whole);
}

static int compare_entries(const void *a, const void *b) {
    const shard_entry *p = a, *q = b;
    return p->identity.shard.index < q->identity.shard.index
               ? -1
               : p->identity.shard.index > q->identity.shard.index;
}

/* "2, 4 to 6, 9" of the shards that are not there. */
static void name_missing(const shard_series *s, uint32_t count, char *text, size_t size) {
    size_t length = 0, at = 0;
    text[0] = '\0';
    for (uint32_t shard = 1; shard <= count && length + 40 < size; shard++) {
        if (at < s->count && s->entries[at].identity.shard.index == shard) {
            at++;
            continue;
        }
        const uint32_t begin = shard, next = at < s->count ? s->entries[at].identity.shard.index : count + 1;
        shard = next - 1;
        length += (size_t)snprintf(text + length, size - length, length > 0 ? ", %u" : "%u", begin);
        if (shard > begin)
            length +=
                (size_t)snprintf(text + length, size - length, shard > begin + 1 ? " to %u" : ", %u", shard);
    }
}

static bool prove_whole(const shard_series *s, io_error *error) {
    const shard_entry *first = &s->entries[0];
    for (size_t i = 1; i < s->count; i++) {
        const shard_entry *entry = &s->entries[i];
        const char *difference = shard_identity_difference(&first->identity, &entry->identity);
        if (difference != NULL)
            return io_fail(error, "%s: it is of %s than %s is, so they are not shards of one replay",
                           entry->path, difference, first->path);
        if (entry->identity.shard.index == entry[-1].identity.shard.index)
            return io_fail(error, "%s and %s: both are shard %u/%u", entry[-1].path, entry->path,
                           entry->identity.shard.index, entry->identity.shard.count);
    }
    char missing[200];
    name_missing(s, first->identity.shard.count, missing, sizeof missing);
    return missing[0] == '\0' ||
           io_fail(error, "of %u shards these are missing: %s", first->identity.shard.count, missing);
}

/* Shards without intervals have told that they are there. */
static void leave_out_empty(shard_series *s) {
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (s->entries[i].identity.shard_first < s->entries[i].identity.shard_last)
            s->entries[kept++] = s->entries[i];
    }
    s->count = kept;
    s->until = kept > 0 ? s->entries[kept - 1].identity.shard_last : 0;
}

static bool read_entries(const char *const *paths, size_t count, shard_series *s, io_error *error) {
    s->entries = calloc(count, sizeof *s->entries);
    if (s->entries == NULL) return io_fail(error, "out of memory");
    for (s->count = 0; s->count < count; s->count++)
        if (!read_entry(paths[s->count], s, &s->entries[s->count], error)) return false;
    qsort(s->entries, s->count, sizeof *s->entries, compare_entries);
    return prove_whole(s, error);
}

bool shard_series_open(const char *const *paths, size_t count, shard_series *out, io_error *error) {
    shard_series s = {.entries = NULL};
    if (!read_entries(paths, count, &s, error)) {
        shard_series_close(&s);
        return false;
    }
    leave_out_empty(&s);
    *out = s;
    return true;
}

bool shard_series_open_part(const char *path, uint32_t until, shard_series *out, io_error *error) {
    shard_series s = {.entries = calloc(1, sizeof *s.entries), .count = 1, .until = until};
    shard_reader r;
    if (s.entries == NULL) return io_fail(error, "out of memory");
    if (!shard_reader_open(path, &r, error)) {
        shard_series_close(&s);
        return false;
    }
    s.entries[0] = (shard_entry){path, r.identity};
    shard_reader_close(&r);
    *out = s;
    return true;
}
