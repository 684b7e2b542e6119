/* The rows of a PLY file, value by value: text and binary, either byte order. */
#include "tool/io/ply_data.h"

#include <inttypes.h>
#include <string.h>

static bool fail_end(ply_data *data) {
    data->reader->mark = data->reader->size;
    return file_reader_fail_here(data->reader, "file ends inside %s %" PRId64 " of %" PRId64,
                                 text_show(data->element->name).text, data->row + 1, data->element->count);
}

static bool fail_missing(ply_data *data, const ply_property *property) {
    if (data->reader->at == data->reader->size) return fail_end(data);
    return file_reader_fail_here(
        data->reader, "the line ends inside %s %" PRId64 " of %" PRId64 ", expected its property '%s'",
        text_show(data->element->name).text, data->row + 1, data->element->count,
        text_show(property->name).text);
}

static bool read_text_scalar(ply_data *data, const ply_property *property, ply_type type, double *value) {
    text_token token;
    int64_t integer;
    if (!text_next_token(data->reader, &token)) return fail_missing(data, property);
    if (!ply_type_is_integer(type)) {
        if (text_parse_number(token, value)) return true;
    } else if (text_parse_integer(token, &integer)) {
        *value = (double)integer;
        return true;
    }
    const bool whole = ply_type_is_integer(type);
    return file_reader_fail_here(data->reader, "found '%s', expected %s for property '%s'%s",
                                 text_show(token).text, whole ? "an integer" : "a number",
                                 text_show(property->name).text, whole ? "" : text_number_advice(token));
}

static uint64_t load_bits(const char *bytes, size_t size, bool big_endian) {
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = (unsigned char)bytes[big_endian ? i : size - 1 - i];
        bits = bits << 8 | byte;
    }
    return bits;
}

/* All types fit a double exactly. */
static double decode_value(uint64_t bits, ply_type type) {
    uint32_t half = (uint32_t)bits;
    float single_value;
    double double_value;
    switch (type) {
    case PLY_INT8:
        return (int8_t)bits;
    case PLY_INT16:
        return (int16_t)bits;
    case PLY_INT32:
        return (int32_t)bits;
    case PLY_FLOAT32:
        memcpy(&single_value, &half, sizeof single_value);
        return (double)single_value;
    case PLY_FLOAT64:
        memcpy(&double_value, &bits, sizeof double_value);
        return double_value;
    case PLY_UINT8:
    case PLY_UINT16:
    case PLY_UINT32:
        break;
    }
    return half;
}

static bool read_binary_scalar(ply_data *data, ply_type type, double *value) {
    file_reader *reader = data->reader;
    size_t size = ply_type_size(type);
    if (reader->size - reader->at < size) return fail_end(data);
    *value = decode_value(
        load_bits(reader->bytes + reader->at, size, data->header.encoding == PLY_BIG_ENDIAN), type);
    reader->mark = reader->at;
    reader->at += size;
    return true;
}

static bool read_scalar(ply_data *data, const ply_property *property, ply_type type, double *value) {
    if (data->header.encoding == PLY_ASCII) return read_text_scalar(data, property, type, value);
    return read_binary_scalar(data, type, value);
}

bool ply_data_number(ply_data *data, const ply_property *property, double *value) {
    return read_scalar(data, property, property->type, value);
}

bool ply_data_length(ply_data *data, const ply_property *property, int64_t *length) {
    double value;
    if (!read_scalar(data, property, property->length_type, &value)) return false;
    if (value < 0) {
        return file_reader_fail_here(data->reader, "the list '%s' has %.0f entries, expected 0 or more",
                                     text_show(property->name).text, value);
    }
    *length = (int64_t)value; /* below 10^18, also in text */
    return true;
}

/* Skips values that are not needed, without checking them. */
static bool skip_values(ply_data *data, const ply_property *property, int64_t count) {
    file_reader *reader = data->reader;
    if (data->header.encoding == PLY_ASCII) {
        text_token token;
        for (int64_t i = 0; i < count; i++) {
            if (!text_next_token(reader, &token)) return fail_missing(data, property);
        }
        return true;
    }
    size_t size = ply_type_size(property->type);
    if ((uint64_t)count > (reader->size - reader->at) / size) return fail_end(data);
    reader->at += (size_t)count * size;
    return true;
}

bool ply_data_skip(ply_data *data, const ply_property *property) {
    int64_t length = 1;
    if (property->is_list && !ply_data_length(data, property, &length)) return false;
    return skip_values(data, property, length);
}

/* Reads one vertex, face or other element; in text it is one line. */
static bool read_row(ply_data *data, const ply_visitor *visitor) {
    bool is_text = data->header.encoding == PLY_ASCII;
    size_t start = data->reader->at;
    if (is_text && !text_seek_token(data->reader)) return fail_end(data);
    const ply_property *property =
        (const ply_property *)data->header.properties.data + data->element->first_property;
    for (size_t i = 0; i < data->element->property_count; i++) {
        if (!visitor->visit(visitor->user, property + i)) return false;
    }
    if (is_text && !text_expect_line_end(data->reader)) return false;
    data->reader->mark = start;
    if (!visitor->end_row(visitor->user)) return false;
    if (is_text) text_skip_line(data->reader);
    return true;
}

/* More than the header promises means that the header is wrong, and the mesh is not what its author meant. */
static bool expect_file_end(ply_data *data) {
    file_reader *reader = data->reader;
    text_token token;
    if (data->header.encoding == PLY_ASCII) {
        if (!text_seek_token(reader)) return true;
        text_next_token(reader, &token);
        return file_reader_fail_here(
            reader, "found '%s' after the last element, expected the end of the file", text_show(token).text);
    }
    for (size_t i = reader->at; i < reader->size; i++) {
        char c = reader->bytes[i];
        if (c == '\0' || c == ' ' || c == '\n' || c == '\r') continue; /* padding */
        reader->mark = reader->at;
        return file_reader_fail_here(reader,
                                     "%zu bytes follow the last element, expected the end of the file",
                                     reader->size - reader->at);
    }
    return true;
}

bool ply_data_open(ply_data *data, file_reader *reader) {
    *data = (ply_data){.reader = reader};
    bool opened = ply_header_read(reader, &data->header);
    reader->binary = opened && data->header.encoding != PLY_ASCII;
    return opened;
}

void ply_data_close(ply_data *data) {
    ply_header_free(&data->header);
}

bool ply_data_read(ply_data *data, const ply_visitor *visitor) {
    const ply_element *elements = data->header.elements.data;
    for (size_t i = 0; i < data->header.elements.count; i++) {
        data->element = elements + i;
        /* An element without properties takes no room, whatever its count. */
        if (data->element->property_count == 0) continue;
        for (data->row = 0; data->row < data->element->count; data->row++) {
            if (!read_row(data, visitor)) return false;
        }
    }
    return expect_file_end(data);
}
