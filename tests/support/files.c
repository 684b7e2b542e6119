/* A temporary folder for a test, files of given bytes in it, and random damage to bytes. */
#include "tests/support/files.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void require_done(bool done, const char *action, const char *path) {
    if (done) return;
    fprintf(stderr, "cannot %s %s: %s\n", action, path, strerror(errno));
    abort();
}

temp_folder temp_folder_make(void) {
    temp_folder folder;
    const char *parent = getenv("TMPDIR");
    if (parent == NULL || strlen(parent) > sizeof folder.path / 2) parent = "/tmp";
    snprintf(folder.path, sizeof folder.path, "%s/cscd-test-XXXXXX", parent);
    require_done(mkdtemp(folder.path) != NULL, "make", folder.path);
    return folder;
}

void temp_folder_remove(const temp_folder *folder) {
    DIR *entries = opendir(folder->path);
    require_done(entries != NULL, "list", folder->path);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        temp_path path = temp_file_path(folder, entry->d_name);
        require_done(remove(path.text) == 0, "remove", path.text);
    }
    closedir(entries);
    require_done(rmdir(folder->path) == 0, "remove", folder->path);
}

temp_path temp_file_path(const temp_folder *folder, const char *name) {
    temp_path path;
    int length = snprintf(path.text, sizeof path.text, "%s/%s", folder->path, name);
    require_done(length > 0 && (size_t)length < sizeof path.text, "name", name);
    return path;
}

temp_path temp_file_write(const temp_folder *folder, const char *name, const void *bytes, size_t size) {
    temp_path path = temp_file_path(folder, name);
    /* Where a file is emptied and written again, file systems wait for the disk; a new one takes as long under wine. */
    FILE *file = fopen(path.text, "r+b");
    if (file == NULL) file = fopen(path.text, "wb");
    require_done(file != NULL, "create", path.text);
    require_done(fwrite(bytes, 1, size, file) == size && fflush(file) == 0, "write", path.text);
    require_done(ftruncate(fileno(file), (off_t)size) == 0, "cut", path.text);
    require_done(fclose(file) == 0, "close", path.text);
    return path;
}

char *temp_file_read(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    require_done(file != NULL && fseek(file, 0, SEEK_END) == 0, "open", path);
    const long length = ftell(file);
    char *text = malloc((size_t)length + 1);
    rewind(file);
    require_done(text != NULL && fread(text, 1, (size_t)length, file) == (size_t)length, "read", path);
    text[length] = '\0';
    fclose(file);
    if (size != NULL) *size = (size_t)length;
    return text;
}

/* ---- one folder for a program -------------------------------------------------------------------------- */

temp_folder own_folder;

int own_folder_make(void **state) {
    (void)state;
    own_folder = temp_folder_make();
    return 0;
}

int own_folder_remove(void **state) {
    (void)state;
    temp_folder_remove(&own_folder);
    return 0;
}

/* ---- damage -------------------------------------------------------------------------------------------- */

static const char *const extreme_numbers[] = {
    "0",          "-1",         "1e999", "-1e308", "nan",
    "2147483648", "4294967295", "-0.0",  "1e-400", "18446744073709551616"};

/* Puts text in the place of `dropped` bytes; returns the new size. */
static size_t replace_bytes(unsigned char *bytes, size_t size, size_t at, size_t dropped, const char *text) {
    const size_t length = strlen(text);
    memmove(bytes + at + length, bytes + at + dropped, size - at - dropped);
    memcpy(bytes + at, text, length);
    return size + length - dropped;
}

static bool is_number_byte(unsigned char byte) {
    return isdigit(byte) || byte == '.' || byte == '-' || byte == 'e';
}

/* Replaces the number that `at` is in, if there is one. */
static size_t make_extreme(random_stream *random, unsigned char *bytes, size_t size, size_t at) {
    size_t begin = at, end = at;
    while (begin > 0 && is_number_byte(bytes[begin - 1])) begin--;
    while (end < size && is_number_byte(bytes[end])) end++;
    if (begin == end) return size;
    const uint32_t count = sizeof extreme_numbers / sizeof *extreme_numbers;
    return replace_bytes(bytes, size, begin, end - begin, extreme_numbers[stream_below(random, count)]);
}

static void copy_piece(random_stream *random, unsigned char *bytes, size_t size, size_t at) {
    const size_t from = stream_below(random, (uint32_t)size), last = at > from ? at : from;
    size_t length = 1 + stream_below(random, 64);
    if (length > size - last) length = size - last;
    memmove(bytes + at, bytes + from, length);
}

size_t damage_bytes(random_stream *random, unsigned char *bytes, size_t size) {
    const size_t at = stream_below(random, (uint32_t)size);
    switch (stream_below(random, 10)) {
    case 0:
        return stream_below(random, 4) == 0 && at > 0 ? at : size;
    case 1:
        memmove(bytes + at + 1, bytes + at, size - at);
        return size + 1;
    case 2:
        memmove(bytes + at, bytes + at + 1, size - at - 1);
        return size > 1 ? size - 1 : size;
    case 3:
        bytes[at] = (unsigned char)stream_bits(random);
        return size;
    case 4: /* numbers stay numbers */
        if (isdigit(bytes[at])) bytes[at] = (unsigned char)('0' + stream_below(random, 10));
        return size;
    case 5:
        return make_extreme(random, bytes, size, at);
    case 6:
        copy_piece(random, bytes, size, at);
        return size;
    default:
        bytes[at] ^= (unsigned char)(1u << stream_below(random, 8));
        return size;
    }
}
