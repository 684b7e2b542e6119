/* The file of a shard of a recording: who it is, then a record for each of its intervals, in order
 * (docs/artist/formats.md). Shards consist of chunks of fixed length, which one run and all its shards have
 * in common. */
#include "tool/replay/shard_file.h"
#include "tool/replay/replay.h"

#include "tool/common/provenance.h"
#include "tool/io/io.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The first line is for people, and as long as whatever it says. */
enum { TITLE_SIZE = 80 };
static const char title_begin[] = "cscd shard ";

static void write_title(const shard_identity *identity, char title[TITLE_SIZE + 1]) {
    char text[TITLE_SIZE];
    snprintf(text, sizeof text, "%s%u/%u of a recording, by --shard and --results", title_begin,
             identity->shard.index, identity->shard.count);
    snprintf(title, TITLE_SIZE + 1, "%-*s\n", TITLE_SIZE - 1, text);
}

/* Before the bytes of a record. */
typedef struct record_head {
    uint64_t kind, size, hash; /* FNV-1a of the bytes */
} record_head;

const char *shard_identity_difference(const shard_identity *a, const shard_identity *b) {
    if (a->build != b->build) return "another version of cscd or another kind of machine";
    if (a->model != b->model) return "another model";
    if (a->plan != b->plan) return "another plan";
    if (a->options != b->options) return "other options";
    if (a->first != b->first || a->last != b->last) return "other frames";
    if (a->shard.count != b->shard.count) return "another number of shards";
    return NULL;
}

/* ---- reading ----------------------------------------------------------------------------------------------- */

static bool read_title(FILE *file) {
    char title[TITLE_SIZE];
    return fread(title, 1, sizeof title, file) == sizeof title &&
           memcmp(title, title_begin, sizeof title_begin - 1) == 0 && title[TITLE_SIZE - 1] == '\n';
}

bool shard_file_recognise(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) return false;
    const bool found = read_title(file);
    fclose(file);
    return found;
}

static bool make_room(shard_reader *r, size_t size) {
    if (size <= r->capacity) return true;
    unsigned char *larger = io_realloc(r->record, size);
    if (larger == NULL) return false;
    r->record = larger;
    r->capacity = size;
    return true;
}

/* Reads in pieces, so that a size that is wrong asks for no more memory than the file has bytes. */
static bool read_bytes(shard_reader *r, size_t size) {
    enum { PIECE = 1 << 20 };
    for (size_t done = 0; done < size;) {
        const size_t piece = size - done < PIECE ? size - done : PIECE, room = done + piece;
        if (room > r->capacity && !make_room(r, room < 2 * r->capacity ? 2 * r->capacity : room))
            return false;
        if (fread(r->record + done, 1, piece, r->file) != piece) return false;
        done += piece;
    }
    return true;
}

shard_end shard_reader_next(shard_reader *r, shard_record *kind, packed_reader *bytes) {
    record_head head;
    const size_t got = fread(&head, 1, sizeof head, r->file);
    if (got == 0) return SHARD_ENDS;
    if (got != sizeof head || head.kind > SHARD_INTERVAL || head.size > SIZE_MAX / 4 ||
        !read_bytes(r, (size_t)head.size) ||
        provenance_hash(PROVENANCE_HASH_START, r->record, (size_t)head.size) != head.hash)
        return SHARD_IS_TORN;
    *kind = (shard_record)head.kind;
    *bytes = (packed_reader){.at = r->record, .end = r->record + head.size};
    r->whole_size += (off_t)(sizeof head + head.size);
    return SHARD_GOES_ON;
}

/* The command line as texts that end with 0, one after the other. */
static bool take_arguments(shard_reader *r, packed_reader *bytes) {
    size_t size, count = 0;
    const char *texts = packed_reader_take_array(bytes, &size, 1);
    if (texts == NULL || size == 0 || texts[size - 1] != '\0') return false;
    for (size_t i = 0; i < size; i++) count += texts[i] == '\0';
    r->arguments = io_realloc(NULL, (count + 1) * sizeof *r->arguments + size);
    if (r->arguments == NULL) return false;
    char *copy = (char *)(r->arguments + count + 1);
    memcpy(copy, texts, size);
    for (size_t i = 0; i < count; i++) {
        r->arguments[i] = copy;
        copy += strlen(copy) + 1;
    }
    r->arguments[count] = NULL;
    r->argument_count = (int)count;
    return true;
}

static bool read_identity(shard_reader *r) {
    shard_record kind;
    packed_reader bytes;
    return shard_reader_next(r, &kind, &bytes) == SHARD_GOES_ON && kind == SHARD_IDENTITY &&
           packed_reader_copy(&bytes, &r->identity, sizeof r->identity) && take_arguments(r, &bytes);
}

bool shard_reader_open(const char *path, shard_reader *out, io_error *error) {
    shard_reader r = {.path = path, .file = pipe_file_read(path), .whole_size = TITLE_SIZE};
    if (r.file == NULL) return io_fail(error, "%s: cannot read: %s", path, strerror(errno));
    if (!read_title(r.file) || !read_identity(&r)) {
        shard_reader_close(&r);
        return io_fail(error,
                       "%s: this is no shard of a recording, which cscd replay --shard I/N --results writes",
                       path);
    }
    *out = r;
    return true;
}

void shard_reader_close(shard_reader *r) {
    if (r->file != NULL) fclose(r->file);
    free(r->record);
    free(r->arguments);
    *r = (shard_reader){.file = NULL};
}

/* ---- writing ----------------------------------------------------------------------------------------------- */

void shard_file_begin(packed_bytes *bytes) {
    const record_head head = {0};
    packed_bytes_clear(bytes);
    packed_bytes_add(bytes, &head, sizeof head);
}

bool shard_file_add(append_file *f, shard_record kind, packed_bytes *bytes, io_error *error) {
    if (bytes->failed) return io_fail(error, "out of memory for the shard's file");
    unsigned char *record = bytes->bytes.data;
    const size_t size = bytes->bytes.count - sizeof(record_head);
    const record_head head = {kind, size,
                              provenance_hash(PROVENANCE_HASH_START, record + sizeof(record_head), size)};
    memcpy(record, &head, sizeof head);
    return append_file_add(f, record, bytes->bytes.count, error);
}

static bool add_identity(append_file *f, const shard_identity *identity, int argument_count, char **arguments,
                         io_error *error) {
    char title[TITLE_SIZE + 1];
    write_title(identity, title);
    growable texts = growable_of(1);
    packed_bytes bytes = packed_bytes_create();
    bool whole = true;
    for (int i = 0; i < argument_count && whole; i++) {
        const size_t size = strlen(arguments[i]) + 1;
        whole = growable_reserve(&texts, texts.count + size);
        if (whole) memcpy((char *)texts.data + texts.count, arguments[i], size);
        texts.count += whole ? size : 0;
    }
    shard_file_begin(&bytes);
    packed_bytes_add(&bytes, identity, sizeof *identity);
    packed_bytes_add_array(&bytes, texts.data, texts.count, 1);
    bytes.failed = bytes.failed || !whole;
    const bool added =
        append_file_add(f, title, TITLE_SIZE, error) && shard_file_add(f, SHARD_IDENTITY, &bytes, error);
    packed_bytes_free(&bytes);
    growable_free(&texts);
    return added;
}

/* Finds out how far a shard has come: whole chunks count. *size: the bytes that have them. */
static void find_end(shard_reader *r, uint32_t *next, off_t *size) {
    shard_record kind;
    packed_reader bytes;
    const shard_identity *identity = &r->identity;
    uint32_t frame = identity->shard_first;
    *next = frame;
    *size = r->whole_size;
    while (shard_reader_next(r, &kind, &bytes) == SHARD_GOES_ON) {
        if (kind != SHARD_INTERVAL) continue;
        frame++;
        if (frame != identity->shard_last && !chunk_begins(identity->first, frame)) continue;
        *next = frame;
        *size = r->whole_size;
    }
}

/* Was the program ended before it had written who the file is of? */
static bool ends_in_its_head(const append_file *f) {
    char begin[sizeof title_begin - 1];
    FILE *file = fopen(f->path, "rb");
    const size_t got = file != NULL ? fread(begin, 1, sizeof begin, file) : 0;
    if (file != NULL) fclose(file);
    io_error error;
    shard_reader r;
    if (got == 0 || memcmp(begin, title_begin, got) != 0) return false;
    const bool readable = shard_reader_open(f->path, &r, &error);
    if (readable) shard_reader_close(&r);
    return !readable;
}

static bool resume_file(append_file *f, const shard_identity *identity, uint32_t *next, bool *anew,
                        io_error *error) {
    shard_reader r;
    *anew = ends_in_its_head(f);
    if (*anew) return append_file_cut(f, 0, error);
    if (!shard_reader_open(f->path, &r, error)) return false;
    const char *difference = shard_identity_difference(&r.identity, identity);
    if (difference == NULL && r.identity.shard.index != identity->shard.index) difference = "another shard";
    off_t size = 0;
    if (difference == NULL) find_end(&r, next, &size);
    shard_reader_close(&r);
    if (difference != NULL)
        return io_fail(error, "%s: these are results of %s, so nothing can be resumed", f->path, difference);
    return append_file_cut(f, size, error);
}

bool shard_file_open(const char *path, bool resume, const shard_identity *identity, int argument_count,
                     char **arguments, append_file *out, uint32_t *next, io_error *error) {
    append_file f;
    bool anew = true;
    *next = identity->shard_first;
    if (!append_file_open(path, &f, error)) return false;
    bool good = true;
    if (f.size > 0 && !resume)
        good = io_fail(
            error, "%s: holds results already; --resume goes on with them, or give --results another name",
            path);
    else if (f.size > 0)
        good = resume_file(&f, identity, next, &anew, error);
    if (good && anew) good = add_identity(&f, identity, argument_count, arguments, error);
    if (!good) append_file_drop(&f);
    *out = f;
    return good;
}

/* ---- intervals in chunks of fixed length, which one run and all its shards have in common ---------------- */

bool chunk_begins(uint32_t first, uint32_t frame) {
    return (frame - first) % CHUNK_INTERVALS == 0;
}

static uint32_t frame_of_chunk(uint32_t first, uint32_t last, uint64_t chunk) {
    const uint64_t frame = first + chunk * CHUNK_INTERVALS;
    return frame < last ? (uint32_t)frame : last;
}

void chunks_of_shard(uint32_t first, uint32_t last, shard_choice shard, uint32_t *shard_first,
                     uint32_t *shard_last) {
    const uint64_t intervals = last - first, chunks = (intervals + CHUNK_INTERVALS - 1) / CHUNK_INTERVALS;
    *shard_first = frame_of_chunk(first, last, chunks * (shard.index - 1) / shard.count);
    *shard_last = frame_of_chunk(first, last, chunks * shard.index / shard.count);
}
