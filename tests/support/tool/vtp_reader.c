/* Reads the .vtp files that the tool writes: binary data behind the XML. */
#include "tests/support/tool/vtp_reader.h"

#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *find_text(const vtp_reader *reader, const char *text) {
    const char *found = memmem(reader->bytes, reader->size, text, strlen(text));
    if (found == NULL) fail_msg("no %s in the file", text);
    return found;
}

vtp_reader vtp_reader_open(const char *path) {
    static const char mark[] = "<AppendedData encoding=\"raw\">\n_";
    vtp_reader reader = {0};
    reader.bytes = read_whole_file(path, &reader.size);
    reader.data = find_text(&reader, mark) + strlen(mark);
    find_text(&reader, "byte_order=\"LittleEndian\" header_type=\"UInt64\"");
    return reader;
}

void vtp_reader_close(vtp_reader *reader) {
    free(reader->bytes);
    *reader = (vtp_reader){0};
}

size_t vtp_reader_count(const vtp_reader *reader, const char *attribute) {
    char text[64];
    snprintf(text, sizeof text, " %s=\"", attribute);
    return strtoul(find_text(reader, text) + strlen(text), NULL, 10);
}

/* The line of an array; NULL: there is none. */
static const char *find_line(const vtp_reader *reader, const char *section, const char *name) {
    char text[96], end[64];
    snprintf(text, sizeof text, "<%s>\n", section);
    snprintf(end, sizeof end, "</%s>\n", section);
    const char *begin = find_text(reader, text), *after = find_text(reader, end);
    snprintf(text, sizeof text, " Name=\"%s\"", name);
    const char *found = memmem(begin, (size_t)(after - begin), text, strlen(text));
    while (found != NULL && *found != '<') found--;
    return found;
}

int vtp_reader_has(const vtp_reader *reader, const char *section, const char *name) {
    return find_line(reader, section, name) != NULL;
}

void *vtp_reader_array(const vtp_reader *reader, const char *section, const char *name, const char *type,
                       size_t *size) {
    const char *line = find_line(reader, section, name);
    char found_type[16], found_name[64];
    unsigned long components, offset;
    if (line == NULL) fail_msg("%s has no array %s", section, name);
    assert_int_equal(sscanf(line, "<DataArray type=\"%15[^\"]\" Name=\"%63[^\"]\" NumberOfComponents=\"%lu\"",
                            found_type, found_name, &components),
                     3);
    assert_string_equal(found_type, type);
    const char *place = strstr(line, " offset=\"");
    assert_int_equal(sscanf(place, " offset=\"%lu\"", &offset), 1);
    uint64_t bytes;
    assert_true(reader->data + offset + sizeof bytes <= reader->bytes + reader->size);
    memcpy(&bytes, reader->data + offset, sizeof bytes);
    assert_true(reader->data + offset + sizeof bytes + bytes <= reader->bytes + reader->size);
    char *data = malloc(bytes + 1);
    assert_non_null(data);
    memcpy(data, reader->data + offset + sizeof bytes, bytes);
    *size = bytes;
    return data;
}
