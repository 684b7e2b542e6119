/* GIFTI surfaces, as programs for brains write them: XML, and in it data arrays. */
#include "tool/io/file_reader.h"
#include "tool/io/format_reader.h"
#include "tool/io/io.h"
#include "tool/io/mesh_builder.h"
#include "tool/io/text_encoding.h"

#include <expat.h>
#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- data arrays --------------------------------------------------------------------------------------- */

typedef enum gifti_type { GIFTI_FLOAT32, GIFTI_FLOAT64, GIFTI_INT32 } gifti_type;
typedef enum gifti_encoding { GIFTI_ASCII, GIFTI_BASE64, GIFTI_ZIPPED } gifti_encoding;

/* A data array of a GIFTI file: what its attributes say, and its numbers. */
typedef struct gifti_array {
    gifti_type type;
    gifti_encoding encoding;
    bool big_endian, column_major;
    uint32_t row_count; /* of three numbers each */
    size_t line;        /* where its data begin */
    growable text;      /* of char: its data, as in the file, and a 0 that does not count */
    growable bytes; /* of unsigned char: decoded, unless it is ASCII; as numbers in this machine's order */
} gifti_array;

/* The size of a number in bytes. */
static size_t size_of_type(gifti_type type) {
    return type == GIFTI_FLOAT64 ? 8 : 4;
}

static size_t expected_size(const gifti_array *array) {
    return (size_t)array->row_count * 3 * size_of_type(array->type);
}

static bool fail_size(const gifti_array *array, file_reader *reader, size_t found) {
    return file_reader_fail_here(reader, "the data have %zu bytes, expected %zu for %" PRIu32 " rows of 3",
                                 found, expected_size(array), array->row_count);
}

static bool reserve_bytes(growable *bytes, file_reader *reader, size_t size) {
    return growable_reserve(bytes, size) ||
           file_reader_fail_here(reader, "out of memory for %zu bytes", size);
}

/* ---- text -------------------------------------------------------------------------------------------- */

/* The next word of the text; false at its end. */
static bool next_word(const gifti_array *array, size_t *at, text_token *word) {
    static const char blanks[] = " \t\r\n";
    const char *text = array->text.data;
    const size_t size = array->text.count;
    while (*at < size && memchr(blanks, text[*at], sizeof blanks) != NULL) (*at)++;
    *word = (text_token){text + *at, 0};
    while (*at < size && memchr(blanks, text[*at], sizeof blanks) == NULL) (*at)++;
    word->length = (size_t)(text + *at - word->text);
    return word->length > 0;
}

static bool parse_word(const gifti_array *array, file_reader *reader, text_token word, unsigned char *out) {
    double number;
    int64_t integer;
    const bool whole = array->type == GIFTI_INT32;
    if (whole ? !text_parse_integer(word, &integer) || integer < INT32_MIN || integer > INT32_MAX
              : !text_parse_number(word, &number))
        return file_reader_fail_here(reader, "found '%s', expected %s", text_show(word).text,
                                     whole ? "a whole number" : "a number");
    const float single = whole ? 0 : (float)number;
    const int32_t small = whole ? (int32_t)integer : 0;
    const void *from = array->type == GIFTI_FLOAT64 ? (const void *)&number : &single;
    memcpy(out, whole ? &small : from, size_of_type(array->type));
    return true;
}

/* Decimals are rounded to the type that the array has. */
static bool decode_text(gifti_array *array, file_reader *reader) {
    const size_t count = (size_t)array->row_count * 3, size = size_of_type(array->type);
    text_token word;
    size_t at = 0;
    if (count > array->text.count) /* at least a digit each: so that a wrong number of rows takes no memory */
        return file_reader_fail_here(reader, "the data have %zu characters, expected %zu numbers",
                                     array->text.count, count);
    if (!reserve_bytes(&array->bytes, reader, expected_size(array))) return false;
    for (size_t i = 0; i < count; i++) {
        if (!next_word(array, &at, &word))
            return file_reader_fail_here(reader, "the data have %zu numbers, expected %zu", i, count);
        if (!parse_word(array, reader, word, (unsigned char *)array->bytes.data + i * size)) return false;
    }
    array->bytes.count = count * size;
    return !next_word(array, &at, &word) ||
           file_reader_fail_here(reader, "found '%s' after the last of %zu numbers", text_show(word).text,
                                 count);
}

/* ---- base64 and zlib --------------------------------------------------------------------------------- */

static bool decode_base64(const gifti_array *array, file_reader *reader, growable *bytes) {
    size_t wrong;
    if (!reserve_bytes(bytes, reader, base64_room(array->text.count))) return false;
    return base64_decode(array->text.data, array->text.count, bytes->data, &bytes->count, &wrong) ||
           file_reader_fail_here(reader, "the data are no base64 at character %zu", wrong);
}

static void *zip_allocate(void *user, unsigned count, unsigned size) {
    (void)user;
    return io_realloc(NULL, (size_t)count * size);
}

static void zip_free(void *user, void *memory) {
    (void)user;
    free(memory);
}

/* Unzips as many bytes as the rows need; a file that has more or fewer is refused. */
static bool unzip_bytes(const growable *packed, const gifti_array *array, file_reader *reader,
                        growable *out) {
    const size_t size = expected_size(array);
    z_stream stream = {.zalloc = zip_allocate, .zfree = zip_free};
    if (packed->count > UINT_MAX || size / 1100 > packed->count) /* zlib packs 1032 times at most */
        return fail_size(array, reader, packed->count);
    if (!reserve_bytes(out, reader, size + 1)) return false;
    if (inflateInit2(&stream, MAX_WBITS + 32) != Z_OK) /* of zlib or of gzip */
        return file_reader_fail_here(reader, "out of memory for unzipping");
    stream.next_in = packed->data;
    stream.avail_in = (unsigned)packed->count;
    int status = Z_OK;
    while (status == Z_OK && out->count <= size) {
        const size_t room = size + 1 - out->count;
        stream.next_out = (unsigned char *)out->data + out->count;
        stream.avail_out = room > UINT_MAX ? UINT_MAX : (unsigned)room;
        const unsigned before = stream.avail_out;
        status = inflate(&stream, Z_NO_FLUSH);
        out->count += before - stream.avail_out;
    }
    inflateEnd(&stream);
    if (status == Z_MEM_ERROR) return file_reader_fail_here(reader, "out of memory for unzipping");
    if (out->count == size && status == Z_STREAM_END) return true;
    if (status == Z_STREAM_END || out->count > size) return fail_size(array, reader, out->count);
    return file_reader_fail_here(reader, "the data cannot be unzipped: they are damaged or cut off");
}

static bool is_big_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

static void swap_bytes(unsigned char *bytes, size_t count, size_t size) {
    for (size_t i = 0; i < count; i++, bytes += size)
        for (size_t k = 0; k < size / 2; k++) {
            const unsigned char kept = bytes[k];
            bytes[k] = bytes[size - 1 - k];
            bytes[size - 1 - k] = kept;
        }
}

static bool decode_binary(gifti_array *array, file_reader *reader) {
    growable packed = growable_of(1);
    const bool zipped = array->encoding == GIFTI_ZIPPED;
    bool done = decode_base64(array, reader, zipped ? &packed : &array->bytes);
    if (done && zipped) done = unzip_bytes(&packed, array, reader, &array->bytes);
    growable_free(&packed);
    if (done && array->bytes.count != expected_size(array))
        done = fail_size(array, reader, array->bytes.count);
    if (done && array->big_endian != is_big_endian())
        swap_bytes(array->bytes.data, (size_t)array->row_count * 3, size_of_type(array->type));
    return done;
}

/* ---- the interface ----------------------------------------------------------------------------------- */

/* Decodes the text. On false the reader's error is set. */
static bool decode_array(gifti_array *array, file_reader *reader) {
    reader->line = array->line;
    return array->encoding == GIFTI_ASCII ? decode_text(array, reader) : decode_binary(array, reader);
}

/* The number `column` of a decoded row. */
static double array_number(const gifti_array *array, uint32_t row, uint32_t column) {
    const size_t place =
        array->column_major ? (size_t)column * array->row_count + row : (size_t)row * 3 + column;
    const unsigned char *at = (const unsigned char *)array->bytes.data + place * size_of_type(array->type);
    float single;
    double number = 0;
    int32_t integer;
    switch (array->type) {
    case GIFTI_FLOAT32:
        memcpy(&single, at, sizeof single);
        return (double)single;
    case GIFTI_FLOAT64:
        memcpy(&number, at, sizeof number);
        return number;
    case GIFTI_INT32:
        memcpy(&integer, at, sizeof integer);
        return integer;
    }
    return number;
}

/* ---- the file ------------------------------------------------------------------------------------------ */

enum { POINTS, TRIANGLES, ARRAY_COUNT };

static const char *const intents[ARRAY_COUNT] = {"NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE"};

typedef struct gifti_parser {
    file_reader *reader;
    XML_Parser xml;
    gifti_array arrays[ARRAY_COUNT];
    bool found[ARRAY_COUNT];
    bool in_array;         /* an element DataArray is open */
    gifti_array *current;  /* the array whose element that is; NULL: none of those that are read */
    gifti_array *receiver; /* the array whose element Data is open, which takes all text; NULL: none */
    bool is_gifti, failed;
} gifti_parser;

/* Ends the parsing: what follows would be of no use. */
static void stop_parsing(gifti_parser *parser) {
    parser->failed = true;
    XML_StopParser(parser->xml, XML_FALSE);
}

static file_reader *reader_here(gifti_parser *parser) {
    parser->reader->line = XML_GetCurrentLineNumber(parser->xml);
    return parser->reader;
}

/* ---- attributes -------------------------------------------------------------------------------------- */

static const char *find_attribute(const char **attributes, const char *name) {
    for (; attributes[0] != NULL; attributes += 2)
        if (strcmp(attributes[0], name) == 0) return attributes[1];
    return "";
}

/* Takes one of the words as its number; false, with an error, when the attribute is none of them. */
static bool choose_word(gifti_parser *parser, const char **attributes, const char *name,
                        const char *const *words, int word_count, int *out) {
    const char *value = find_attribute(attributes, name);
    for (int i = 0; i < word_count; i++)
        if (strcmp(value, words[i]) == 0) {
            *out = i;
            return true;
        }
    return file_reader_fail_here(reader_here(parser), "%s is '%.*s', expected %s%s%s", name,
                                 TEXT_CUT(value, 40), words[0], word_count > 1 ? " or " : "",
                                 word_count > 1 ? words[word_count - 1] : "");
}

static bool read_dimensions(gifti_parser *parser, const char **attributes, gifti_array *array) {
    const char *rows = find_attribute(attributes, "Dim0"), *columns = find_attribute(attributes, "Dim1");
    char *end;
    const long long count = strtoll(rows, &end, 10);
    if (*end != '\0' || end == rows || count < 1 || count > INT32_MAX)
        return file_reader_fail_here(reader_here(parser), "Dim0 is '%.*s', expected 1 to %" PRId32,
                                     TEXT_CUT(rows, 40), INT32_MAX);
    if (strcmp(find_attribute(attributes, "Dimensionality"), "2") != 0 || strcmp(columns, "3") != 0)
        return file_reader_fail_here(reader_here(parser),
                                     "Dim1 is '%.*s', expected two dimensions, the second of 3",
                                     TEXT_CUT(columns, 40));
    array->row_count = (uint32_t)count;
    return true;
}

static bool read_encoding(gifti_parser *parser, const char **attributes, gifti_array *array) {
    static const char *const encodings[] = {"ASCII", "Base64Binary", "GZipBase64Binary"};
    static const char *const orders[] = {"LittleEndian", "BigEndian"};
    static const char *const layouts[] = {"RowMajorOrder", "ColumnMajorOrder"};
    int encoding = 0, big_endian = 0, column_major = 0;
    if (strcmp(find_attribute(attributes, "Encoding"), "ExternalFileBinary") == 0)
        return file_reader_fail_here(
            reader_here(parser),
            "its data are in another file, '%.*s'; save the surface with its data inside, for "
            "example as GZipBase64Binary",
            TEXT_CUT(find_attribute(attributes, "ExternalFileName"), 200));
    if (!choose_word(parser, attributes, "Encoding", encodings, 3, &encoding) ||
        !choose_word(parser, attributes, "ArrayIndexingOrder", layouts, 2, &column_major) ||
        (encoding != GIFTI_ASCII && !choose_word(parser, attributes, "Endian", orders, 2, &big_endian)))
        return false;
    array->encoding = (gifti_encoding)encoding;
    array->big_endian = big_endian != 0;
    array->column_major = column_major != 0;
    return true;
}

static bool read_attributes(gifti_parser *parser, const char **attributes, int kind, gifti_array *array) {
    static const char *const numbers[] = {"NIFTI_TYPE_FLOAT32", "NIFTI_TYPE_FLOAT64"};
    static const char *const indices[] = {"NIFTI_TYPE_INT32"};
    int type = 0;
    if (!choose_word(parser, attributes, "DataType", kind == POINTS ? numbers : indices,
                     kind == POINTS ? 2 : 1, &type))
        return false;
    array->type = kind == POINTS ? (gifti_type)type : GIFTI_INT32;
    return read_dimensions(parser, attributes, array) && read_encoding(parser, attributes, array);
}

/* ---- elements ---------------------------------------------------------------------------------------- */

static void begin_array(gifti_parser *parser, const char **attributes) {
    const char *intent = find_attribute(attributes, "Intent");
    parser->in_array = true;
    for (int kind = 0; kind < ARRAY_COUNT; kind++) {
        if (strcmp(intent, intents[kind]) != 0 || parser->found[kind]) continue;
        parser->found[kind] = true;
        parser->current = &parser->arrays[kind];
        if (!read_attributes(parser, attributes, kind, parser->current)) stop_parsing(parser);
    }
}

static void begin_data(gifti_parser *parser) {
    gifti_array *array = parser->current;
    if (array->line != 0) {
        file_reader_fail_here(reader_here(parser), "a second element Data in one DataArray, expected one");
        stop_parsing(parser);
        return;
    }
    array->line = XML_GetCurrentLineNumber(parser->xml);
    parser->receiver = array;
}

/* The format has no arrays in arrays and nothing but text in Data; what is written so has no meaning that we
 * could guess. */
static void begin_element(void *user, const char *name, const char **attributes) {
    gifti_parser *parser = user;
    const bool is_array = strcmp(name, "DataArray") == 0;
    if (parser->failed) return;
    if (parser->receiver != NULL || (is_array && parser->in_array)) {
        file_reader_fail_here(reader_here(parser), "an element '%.*s' inside %s, expected %s",
                              TEXT_CUT(name, 40), parser->receiver != NULL ? "Data" : "a DataArray",
                              parser->receiver != NULL ? "numbers alone" : "its data");
        stop_parsing(parser);
        return;
    }
    if (strcmp(name, "GIFTI") == 0) parser->is_gifti = true;
    if (is_array) begin_array(parser, attributes);
    if (strcmp(name, "Data") == 0 && parser->current != NULL) begin_data(parser);
}

static void end_element(void *user, const char *name) {
    gifti_parser *parser = user;
    if (strcmp(name, "Data") == 0) parser->receiver = NULL;
    if (strcmp(name, "DataArray") != 0) return;
    parser->in_array = false;
    parser->current = NULL;
}

static void take_text(void *user, const char *text, int length) {
    gifti_parser *parser = user;
    if (parser->receiver == NULL || parser->failed) return;
    growable *all = &parser->receiver->text;
    const size_t needed = all->count + (size_t)length + 1; /* numbers are read up to what is none: a 0 */
    if (needed > all->capacity && !growable_reserve(all, needed > SIZE_MAX / 2 ? needed : 2 * needed)) {
        file_reader_fail_here(reader_here(parser), "out of memory for %zu characters", needed);
        stop_parsing(parser);
        return;
    }
    memcpy((char *)all->data + all->count, text, (size_t)length);
    all->count = needed - 1;
    ((char *)all->data)[all->count] = '\0';
}

/* A few hundred bytes of entities become gigabytes of text, and no program writes them into a surface. */
static void refuse_entity(gifti_parser *parser, const char *name) {
    if (parser->failed) return;
    file_reader_fail_here(reader_here(parser), "has the entity '%.*s', expected a surface without any",
                          TEXT_CUT(name, 40));
    stop_parsing(parser);
}

static void declare_entity(void *user, const char *name, int is_parameter, const char *value,
                           int value_length, const char *base, const char *system_id, const char *public_id,
                           const char *notation) {
    (void)is_parameter, (void)value, (void)value_length, (void)base;
    (void)system_id, (void)public_id, (void)notation;
    refuse_entity(user, name);
}

/* One that the file does not declare: the other file that its type names could, which is not read. */
static void skip_entity(void *user, const char *name, int is_parameter) {
    (void)is_parameter;
    refuse_entity(user, name);
}

/* ---- the file ---------------------------------------------------------------------------------------- */

static void *xml_allocate(size_t size) {
    return io_realloc(NULL, size);
}

static bool parse_bytes(gifti_parser *parser) {
    const file_reader *reader = parser->reader;
    enum { PIECE = 1 << 20 }; /* expat takes an int */
    for (size_t at = reader->at; !parser->failed; at += PIECE) {
        const size_t left = reader->size - at;
        const bool last = left <= PIECE;
        if (XML_Parse(parser->xml, reader->bytes + at, last ? (int)left : PIECE, last) == XML_STATUS_ERROR)
            break;
        if (last) return true;
    }
    if (parser->failed) return false;
    const enum XML_Error cause = XML_GetErrorCode(parser->xml);
    if (cause == XML_ERROR_NO_MEMORY) return file_reader_fail(parser->reader, "out of memory");
    return file_reader_fail_here(reader_here(parser), "no valid XML: %s", XML_ErrorString(cause));
}

static bool parse_file(gifti_parser *parser) {
    const XML_Memory_Handling_Suite memory = {xml_allocate, io_realloc, free};
    parser->xml = XML_ParserCreate_MM(NULL, &memory, NULL);
    if (parser->xml == NULL) return file_reader_fail(parser->reader, "out of memory");
    XML_SetUserData(parser->xml, parser);
    XML_SetElementHandler(parser->xml, begin_element, end_element);
    XML_SetCharacterDataHandler(parser->xml, take_text);
    XML_SetEntityDeclHandler(parser->xml, declare_entity);
    XML_SetSkippedEntityHandler(parser->xml, skip_entity);
    const bool done = parse_bytes(parser);
    XML_ParserFree(parser->xml);
    if (!done) return false;
    if (!parser->is_gifti)
        return file_reader_fail(parser->reader, "has no element GIFTI, expected a GIFTI surface");
    for (int kind = 0; kind < ARRAY_COUNT; kind++)
        if (!parser->found[kind])
            return file_reader_fail(parser->reader,
                                    "has no data array of %s, expected a surface with points and triangles",
                                    intents[kind]);
    return true;
}

static bool add_triangle(const gifti_array *array, uint32_t row, uint32_t vertex_count,
                         mesh_builder *builder) {
    if (!mesh_builder_begin_face(builder)) return false;
    for (uint32_t k = 0; k < 3; k++) {
        const double vertex = array_number(array, row, k);
        if (!(vertex >= 0 && vertex < vertex_count))
            return file_reader_fail_here(
                builder->reader, "triangle %" PRIu32 " names vertex %.0f, but there are %" PRIu32 ", from 0",
                row, vertex, vertex_count);
        if (!mesh_builder_add_corner(builder, (uint32_t)vertex)) return false;
    }
    return mesh_builder_end_face(builder);
}

static bool build_mesh(gifti_parser *parser, mesh_file *out) {
    gifti_array *points = &parser->arrays[POINTS], *triangles = &parser->arrays[TRIANGLES];
    mesh_builder builder = mesh_builder_of(parser->reader, 0);
    bool done = decode_array(points, parser->reader);
    for (uint32_t i = 0; done && i < points->row_count; i++) {
        double position[3];
        for (uint32_t k = 0; k < 3; k++) position[k] = array_number(points, i, k);
        done = mesh_builder_add_vertex(&builder, position);
    }
    done = done && decode_array(triangles, parser->reader);
    for (uint32_t i = 0; done && i < triangles->row_count; i++)
        done = add_triangle(triangles, i, points->row_count, &builder);
    done = done && mesh_builder_finish(&builder, out);
    mesh_builder_free(&builder);
    return done;
}

/* The tag stands behind a line of XML and one with the type of the document. */
/* The name has the ending, or the tag <GIFTI stands near the beginning. */
static bool recognise_gifti(const file_reader *reader) {
    const size_t beginning = reader->size < 1000 ? reader->size : 1000;
    return path_has_extension(reader->path, ".gii") || memmem(reader->bytes, beginning, "<GIFTI", 6) != NULL;
}

static bool read_gifti(file_reader *reader, mesh_file *out) {
    gifti_parser parser = {.reader = reader};
    for (int kind = 0; kind < ARRAY_COUNT; kind++)
        parser.arrays[kind] = (gifti_array){.text = growable_of(1), .bytes = growable_of(1)};
    const bool done = parse_file(&parser) && build_mesh(&parser, out);
    for (int kind = 0; kind < ARRAY_COUNT; kind++) {
        growable_free(&parser.arrays[kind].text);
        growable_free(&parser.arrays[kind].bytes);
    }
    return done;
}

const format_reader gifti_reader = {MESH_FORMAT_GIFTI, .recognise = recognise_gifti, .read = read_gifti};
