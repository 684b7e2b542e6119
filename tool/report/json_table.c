/* Reads JSON that this tool has written, row by row; what does not have the expected form stays as it is. */
#include "tool/report/page.h"

#include "tool/io/io.h"
#include "tool/io/json.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 48, DEPTH_MAX = 3, NAME_SIZE = PAGE_ARRAY_NAME_SIZE };

typedef struct text_span {
    const char *begin, *end;
} text_span;

typedef enum column_kind {
    COLUMN_WHOLE,
    COLUMN_NUMBERS,
    COLUMN_TEXTS
} column_kind; /* the first that fits all values */

typedef struct text_column {
    text_span keys[DEPTH_MAX]; /* with their quotes, of the first row */
    int depth;
    column_kind kind;
    packed_array *values;
    char name[NAME_SIZE];
    growable texts;   /* text_span: of COLUMN_TEXTS, each once */
    growable buckets; /* uint32_t: a hash table of these, by number + 1; of a power of two */
} text_column;

typedef struct text_table {
    text_column columns[COLUMNS_MAX];
    size_t column_count, row_count;
    bool filling; /* the second time, or else looking at what there is */
    bool out_of_memory;
} text_table;

/* ---- JSON ------------------------------------------------------------------------------------------------ */

static const char *skip_blanks(const char *p) {
    while (*p == ' ' || *p == '\n' || *p == '\t' || *p == '\r') p++;
    return p;
}

/* The end of the string that begins at p; NULL: it does not end. */
static const char *string_end(const char *p) {
    for (p++; *p != '"'; p++) {
        if (*p == '\0') return NULL;
        if (*p == '\\' && *++p == '\0') return NULL;
    }
    return p + 1;
}

/* The end of the value that begins at p; NULL: there is none. */
static const char *value_end(const char *p) {
    int open = 0;
    do {
        if (*p == '"') {
            p = string_end(p);
            if (p == NULL) return NULL;
        } else if (*p == '{' || *p == '[') {
            open++;
            p++;
        } else if (*p == '}' || *p == ']') {
            if (--open < 0) return NULL;
            p++;
        } else if (*p == '\0') {
            return NULL;
        } else if (open == 0) {
            const size_t length = strcspn(p, ",}] \t\r\n");
            return length > 0 ? p + length : NULL;
        } else {
            p += strcspn(p, "\"{}[]");
        }
    } while (open > 0);
    return p;
}

/* Reads `"key":` at p. Returns where the value begins; NULL: there is no key. */
static const char *read_key(const char *p, text_span *key) {
    if (*p != '"') return NULL;
    *key = (text_span){p, string_end(p)};
    if (key->end == NULL) return NULL;
    p = skip_blanks(key->end);
    return *p == ':' ? skip_blanks(p + 1) : NULL;
}

/* Goes on behind a comma; *more becomes false at the closing bracket. NULL: neither follows. */
static const char *next_item(const char *p, char closing, bool *more) {
    p = skip_blanks(p);
    *more = *p == ',';
    if (*p != ',' && *p != closing) return NULL;
    return skip_blanks(p + 1);
}

static bool same_span(text_span a, text_span b) {
    const size_t length = (size_t)(a.end - a.begin);
    return length == (size_t)(b.end - b.begin) && memcmp(a.begin, b.begin, length) == 0;
}

/* ---- values ---------------------------------------------------------------------------------------------- */

static bool is_null(text_span value) {
    return value.end - value.begin == 4 && memcmp(value.begin, "null", 4) == 0;
}

/* JSON's numbers, but none that a double does not hold as it is written. */
static column_kind kind_of(text_span value) {
    if (is_null(value)) return COLUMN_NUMBERS;
    if (*value.begin != '-' && !isdigit((unsigned char)*value.begin)) return COLUMN_TEXTS;
    for (const char *p = value.begin; p < value.end; p++)
        if (!isdigit((unsigned char)*p)) return COLUMN_NUMBERS;
    return value.end - value.begin < 10 ? COLUMN_WHOLE : COLUMN_NUMBERS;
}

static uint32_t hash_span(text_span value) {
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (const char *p = value.begin; p < value.end; p++) hash = (hash ^ (uint8_t)*p) * 16777619u;
    return hash;
}

/* The place of a text in the table: its own, or the free one where it belongs. */
static uint32_t *find_bucket(const text_column *c, text_span value) {
    uint32_t *buckets = c->buckets.data;
    const text_span *texts = c->texts.data;
    const uint32_t mask = (uint32_t)c->buckets.capacity - 1;
    uint32_t place = hash_span(value) & mask;
    while (buckets[place] != 0 && !same_span(texts[buckets[place] - 1], value)) place = (place + 1) & mask;
    return &buckets[place];
}

/* Keeps the table at most half full. */
static bool make_buckets(text_column *c) {
    if (c->texts.count < c->buckets.capacity / 2) return true;
    const size_t capacity = c->buckets.capacity > 0 ? 2 * c->buckets.capacity : 64;
    growable buckets = growable_of(sizeof(uint32_t));
    if (!growable_reserve(&buckets, capacity)) return false;
    growable_free(&c->buckets);
    c->buckets = buckets;
    memset(c->buckets.data, 0, c->buckets.capacity * sizeof(uint32_t));
    const text_span *texts = c->texts.data;
    for (size_t i = 0; i < c->texts.count; i++) *find_bucket(c, texts[i]) = (uint32_t)i + 1;
    return true;
}

static bool add_text(text_column *c, text_span value) {
    if (!make_buckets(c)) return false;
    uint32_t *bucket = find_bucket(c, value);
    if (*bucket == 0) {
        text_span *added = growable_push(&c->texts);
        if (added == NULL) return false;
        *added = value;
        *bucket = (uint32_t)c->texts.count;
    }
    const uint32_t place = *bucket - 1;
    return packed_array_add_u32(c->values, &place, 1);
}

static bool add_value(text_column *c, text_span value) {
    if (c->kind == COLUMN_TEXTS) return add_text(c, value);
    const double number = is_null(value) ? NAN : strtod(value.begin, NULL);
    const uint32_t whole = (uint32_t)(number >= 0.0 ? number : 0.0);
    return c->kind == COLUMN_WHOLE ? packed_array_add_u32(c->values, &whole, 1)
                                   : packed_array_add_f64(c->values, &number, 1);
}

/* ---- rows ------------------------------------------------------------------------------------------------ */

/* The value of the next column of this row; false: it is not the first row's. */
static bool take_value(text_table *t, size_t *column, const text_span *keys, int depth, text_span value) {
    if (*column >= (t->row_count == 0 && !t->filling ? (size_t)COLUMNS_MAX : t->column_count)) return false;
    text_column *c = &t->columns[(*column)++];
    if (t->row_count == 0 && !t->filling) {
        *c = (text_column){.depth = depth,
                           .texts = growable_of(sizeof(text_span)),
                           .buckets = growable_of(sizeof(uint32_t))};
        memcpy(c->keys, keys, (size_t)depth * sizeof *keys);
        t->column_count++;
    }
    if (c->depth != depth) return false;
    for (int i = 0; i < depth; i++)
        if (!same_span(c->keys[i], keys[i])) return false;
    const column_kind kind = kind_of(value);
    if (!t->filling)
        c->kind = kind > c->kind ? kind : c->kind;
    else if (!add_value(c, value))
        t->out_of_memory = true;
    return !t->out_of_memory;
}

/* Takes the values of an object; objects in it are columns of their own. Returns its end; NULL: it has
 * another form. */
static const char *take_object(text_table *t, size_t *column, text_span keys[DEPTH_MAX], int depth,
                               const char *p) {
    bool more = true;
    if (depth == DEPTH_MAX) return NULL;
    for (p = skip_blanks(p + 1); more;) {
        p = read_key(p, &keys[depth]);
        if (p == NULL) return NULL;
        const char *end;
        if (*p == '{') {
            end = take_object(t, column, keys, depth + 1, p);
        } else {
            end = value_end(p);
            if (end != NULL && !take_value(t, column, keys, depth + 1, (text_span){p, end})) return NULL;
        }
        if (end == NULL) return NULL;
        p = next_item(end, '}', &more);
        if (p == NULL) return NULL;
    }
    return p;
}

/* Takes all rows of the array at p. Returns its end; NULL: it is no such table. */
static const char *take_rows(text_table *t, const char *p) {
    bool more = true;
    t->row_count = 0;
    for (p = skip_blanks(p + 1); more; t->row_count++) {
        text_span keys[DEPTH_MAX];
        size_t column = 0;
        if (*p != '{') return NULL;
        p = take_object(t, &column, keys, 0, p);
        if (p == NULL || column != t->column_count) return NULL;
        p = next_item(p, ']', &more);
        if (p == NULL) return NULL;
    }
    return p;
}

static bool begin_columns(text_table *t, const char *prefix, const char *key, size_t key_length,
                          page_arrays *arrays) {
    for (size_t i = 0; i < t->column_count; i++) {
        text_column *c = &t->columns[i];
        snprintf(c->name, sizeof c->name, "%s-%.*s-%zu", prefix, (int)key_length, key, i);
        c->values = page_arrays_add(arrays, c->name, c->kind == COLUMN_NUMBERS ? "f64" : "u32");
        if (c->values == NULL) return false;
    }
    return true;
}

static bool finish_columns(text_table *t) {
    for (size_t i = 0; i < t->column_count; i++)
        if (!packed_array_finish(t->columns[i].values)) return false;
    return true;
}

static void free_table(text_table *t) {
    for (size_t i = 0; i < t->column_count; i++) {
        growable_free(&t->columns[i].texts);
        growable_free(&t->columns[i].buckets);
    }
}

/* ---- the text -------------------------------------------------------------------------------------------- */

static void put_span(FILE *file, text_span span) {
    fwrite(span.begin, 1, (size_t)(span.end - span.begin), file);
}

static void put_column(FILE *file, const text_column *c, size_t row_count) {
    fputs("{\"path\":[", file);
    for (int i = 0; i < c->depth; i++) {
        if (i > 0) fputc(',', file);
        put_span(file, c->keys[i]);
    }
    fprintf(file, "],\"array\":{\"name\":\"%s\",\"type\":\"%s\",\"count\":%zu}", c->name,
            c->kind == COLUMN_NUMBERS ? "f64" : "u32", row_count);
    const text_span *texts = c->texts.data;
    if (c->kind == COLUMN_TEXTS) fputs(",\"texts\":[", file);
    for (size_t i = 0; i < c->texts.count; i++) {
        if (i > 0) fputc(',', file);
        put_span(file, texts[i]);
    }
    fputs(c->kind == COLUMN_TEXTS ? "]}" : "}", file);
}

static void put_table(FILE *file, const text_table *t) {
    fprintf(file, "{\"count\":%zu,\"columns\":[", t->row_count);
    for (size_t i = 0; i < t->column_count; i++) {
        if (i > 0) fputc(',', file);
        put_column(file, &t->columns[i], t->row_count);
    }
    fputs("]}", file);
}

/* Writes the table at p in place of the array there, if it is one. False: out of memory. *end stays NULL if
 * it is none. */
static bool move_array(FILE *file, const char *p, text_span key, const char *prefix, page_arrays *arrays,
                       const char **end) {
    text_table *t = io_zeroed(sizeof *t);
    if (t == NULL) return false;
    *end = take_rows(t, p);
    bool moved = *end != NULL && t->row_count >= JSON_TABLE_ROWS_LEAST &&
                 page_arrays_room(arrays) >= t->column_count,
         made = true;
    if (moved) {
        t->filling = true;
        made = begin_columns(t, prefix, key.begin + 1, (size_t)(key.end - key.begin) - 2, arrays) &&
               take_rows(t, p) != NULL && finish_columns(t);
        if (made) put_table(file, t);
    } else {
        *end = NULL;
    }
    free_table(t);
    free(t);
    return made;
}

/* Names become parts of the page, so no others are taken from a file. */
static bool is_table(text_span key) {
    static const char *const names[] = {"\"intervals\"", "\"frames\""};
    bool found = false;
    for (int i = 0; i < 2; i++)
        found = found || same_span(key, (text_span){names[i], names[i] + strlen(names[i])});
    return found;
}

/* Copies the object, with tables in place of its long arrays. */
static bool copy_members(FILE *file, const char *text, const char *prefix, page_arrays *arrays, bool *moved) {
    const char *p = skip_blanks(text), *copied = p;
    bool more = true;
    if (*p != '{') return true;
    for (p = skip_blanks(p + 1); more;) {
        text_span key;
        const char *end = NULL;
        p = read_key(p, &key);
        if (p == NULL) break;
        if (*p == '[' && is_table(key)) {
            put_span(file, (text_span){copied, p});
            copied = p;
            if (!move_array(file, p, key, prefix, arrays, &end)) return false;
            if (end != NULL) {
                copied = end;
                *moved = true;
            }
        }
        if (end == NULL) end = value_end(p);
        p = end != NULL ? next_item(end, '}', &more) : NULL;
        if (p == NULL) break;
    }
    fputs(copied, file);
    return true;
}

bool json_table_move(const char *text, const char *prefix, page_arrays *arrays, char **out) {
    size_t size;
    bool moved = false;
    *out = NULL;
    FILE *file = open_memstream(out, &size);
    if (file == NULL) return false;
    bool made = copy_members(file, text, prefix, arrays, &moved) && !ferror(file);
    made = fclose(file) == 0 && made;
    if (made && moved) return *out != NULL;
    free(*out);
    *out = NULL;
    return made;
}
