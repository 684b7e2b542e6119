/* Finds the frames of a sequence that is given as a pattern, walk/f_%04d.obj, or as a folder. */
#include "tool/io/frames/frame_names.h"

#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- a pattern ----------------------------------------------------------------------------------------- */

enum { WIDTH_LIMIT = 32 };

/* The pattern without its conversion and with "%%" undone: the folder, the text before the number, and the
 * text after it. */
typedef struct frame_pattern {
    char *text;
    size_t name_start, number_start; /* positions in text; the suffix starts where the number does */
    size_t width;
} frame_pattern;

/* The length of the %d or %0Nd at text, 0 if it is neither; *width is the fewest digits it writes. */
static size_t conversion_length(const char *text, size_t *width) {
    size_t length = 1, value = 0;
    if (text[length] == '0') {
        length++;
        while (path_is_digit(text[length]) && value <= WIDTH_LIMIT)
            value = value * 10 + (size_t)(text[length++] - '0');
        if (value < 1 || value > WIDTH_LIMIT) return 0;
    }
    *width = value == 0 ? 1 : value;
    return text[length] == 'd' ? length + 1 : 0;
}

static bool bad_pattern(const char *source, size_t at, const char *found, io_error *error) {
    return io_fail(error,
                   "%s: bad pattern: %s at character %zu, expected one %%d or %%0Nd (N from 1 to %d) in the "
                   "file name, and %%%% for a percent sign",
                   source, found, at + 1, WIDTH_LIMIT);
}

/* pattern->text has room for all of source. */
static bool parse_pattern(frame_pattern *pattern, const char *source, io_error *error) {
    size_t length = 0, conversion_count = 0, conversion_at = 0;
    for (size_t at = 0; source[at] != '\0';) {
        if (source[at] != '%') {
            if (path_is_separator(source[at])) pattern->name_start = length + 1;
            pattern->text[length++] = source[at++];
        } else if (source[at + 1] == '%') {
            pattern->text[length++] = '%';
            at += 2;
        } else {
            const size_t conversion = conversion_length(source + at, &pattern->width);
            if (conversion == 0) return bad_pattern(source, at, "another conversion", error);
            if (conversion_count++ > 0) return bad_pattern(source, at, "a second number", error);
            conversion_at = at;
            pattern->number_start = length;
            at += conversion;
        }
    }
    pattern->text[length] = '\0';
    if (conversion_count == 0) return bad_pattern(source, length, "no number until the end", error);
    if (pattern->number_start < pattern->name_start)
        return bad_pattern(source, conversion_at, "a number in the folder", error);
    return true;
}

/* Whether the name is that of some *number by the pattern. printf counts the sign of a negative one among its
 * digits; others write as many digits as of any number. */
static bool matches_name(const frame_pattern *pattern, const char *name, int32_t *number) {
    const char *prefix = pattern->text + pattern->name_start, *suffix = pattern->text + pattern->number_start;
    const size_t length = strlen(name), suffix_length = strlen(suffix);
    const size_t prefix_length = pattern->number_start - pattern->name_start;
    if (length < prefix_length + pattern->width + suffix_length ||
        strncmp(name, prefix, prefix_length) != 0 || strcmp(name + length - suffix_length, suffix) != 0)
        return false;
    const bool negative = name[prefix_length] == '-';
    const char *digits = name + prefix_length + negative;
    const size_t digit_count = length - prefix_length - suffix_length - negative;
    if (digit_count == 0 || (digit_count > pattern->width && digits[0] == '0')) return false;
    int64_t value = 0;
    for (size_t i = 0; i < digit_count; i++) {
        if (!path_is_digit(digits[i])) return false;
        value = value * 10 + (digits[i] - '0');
        if (value > INT32_MAX) return false;
    }
    *number = (int32_t)(negative ? -value : value);
    return true;
}

static bool keep_match(const char *name, const void *context) {
    int32_t number;
    return matches_name(context, name, &number);
}

static bool read_numbers(const frame_pattern *pattern, frame_names *list) {
    for (size_t i = 0; i < frame_names_count(list); i++) {
        int32_t *number = growable_push(&list->numbers);
        if (number == NULL) return false;
        matches_name(pattern, frame_names_at(list, i), number);
    }
    return frame_names_sort_by_number(list);
}

/* -0001 and -001 are both what %04d may have been. */
static bool check_twins(const frame_names *list, const char *source, io_error *error) {
    const int32_t *numbers = list->numbers.data;
    for (size_t i = 1; i < list->numbers.count; i++)
        if (numbers[i] == numbers[i - 1])
            return io_fail(error, "%s: both %s and %s are frame %" PRId32, source,
                           frame_names_at(list, i - 1), frame_names_at(list, i), numbers[i]);
    return true;
}

static bool check_gaps(const frame_pattern *pattern, const char *folder, const frame_names *list,
                       io_error *error) {
    frame_gap gap;
    if (!frame_series_find_gap(&list->numbers, &gap)) return true;
    const char *name = frame_names_at(list, gap.before), *suffix = pattern->text + pattern->number_start;
    number_place place = {.start = pattern->number_start - pattern->name_start, .width = (int)pattern->width};
    place.length = strlen(name) - place.start - strlen(suffix);
    if (gap.missing < 0 && place.length == pattern->width) place.width--; /* the sign is one of them */
    return frame_series_fail(folder, list, &gap, place, error);
}

static bool find_files(frame_pattern *pattern, const char *source, bool allow_gaps, char **folder,
                       frame_names *list, io_error *error) {
    if (!parse_pattern(pattern, source, error)) return false;
    if (path_mesh_ending(pattern->text + pattern->number_start) == 0)
        return io_fail(error, "%s: unknown extension, a pattern is expected to end in " MESH_FORMAT_ENDINGS,
                       source);
    char *found = frame_names_copy(pattern->text, pattern->name_start);
    if (found == NULL) return io_fail(error, "%s: out of memory", source);
    bool complete = frame_names_read_folder(list, found, keep_match, pattern, error);
    if (complete && frame_names_count(list) == 0)
        complete = io_fail(error, "%s: no such file, and no file matches it as a pattern", source);
    if (complete) {
        complete = read_numbers(pattern, list) || io_fail(error, "%s: out of memory", source);
        complete = complete && check_twins(list, source, error) &&
                   (allow_gaps || check_gaps(pattern, found, list, error));
    }
    if (complete)
        *folder = found;
    else
        free(found);
    return complete;
}

bool frame_pattern_find(const char *pattern, bool allow_gaps, char **folder, frame_names *list,
                        io_error *error) {
    frame_pattern parsed = {.text = io_realloc(NULL, strlen(pattern) + 1)};
    if (parsed.text == NULL) return io_fail(error, "%s: out of memory", pattern);
    const bool found = find_files(&parsed, pattern, allow_gaps, folder, list, error);
    free(parsed.text);
    return found;
}

/* ---- a folder ------------------------------------------------------------------------------------------ */

/* Plans lie beside the meshes that they were made for. */
static bool keep_mesh(const char *name, const void *context) {
    (void)context;
    return name[0] != '.' && path_mesh_ending(name) > 0 && !path_has_extension(name, ".plan.ply");
}

static bool check_extensions(const char *folder, const frame_names *list, io_error *error) {
    const char *first = frame_names_at(list, 0);
    for (size_t i = 1; i < frame_names_count(list); i++)
        if (strcmp(strrchr(first, '.'), strrchr(frame_names_at(list, i), '.')) != 0)
            return io_fail(error, "%s: holds both %s and %s, expected one extension", folder, first,
                           frame_names_at(list, i));
    return true;
}

/* Compares all names with the first: each must differ from it in one number, always the same one, and no two
 * may be equal. */
static bool check_series(const char *folder, const frame_names *list, size_t *number, io_error *error) {
    size_t series_number = 0;
    for (size_t i = 1; i < frame_names_count(list); i++) {
        const char *before = frame_names_at(list, i - 1), *name = frame_names_at(list, i);
        const name_difference from_first = frame_series_compare(frame_names_at(list, 0), name);
        if (from_first.in_text)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in a number only",
                           folder, frame_names_at(list, 0), name);
        if (frame_series_compare(before, name).number_count == 0)
            return io_fail(error, "%s: holds both %s and %s, which are the same frame", folder, before, name);
        if (i == 1) series_number = from_first.last_number;
        if (from_first.number_count != 1 || from_first.last_number != series_number)
            return io_fail(error, "%s: holds both %s and %s, expected names that differ in one number only",
                           folder, frame_names_at(list, 0), name);
    }
    *number = frame_names_count(list) > 1 ? series_number : SIZE_MAX;
    return true;
}

bool frame_folder_find(const char *folder, const char *prefix, bool allow_gaps, frame_names *list,
                       bool *fractions, io_error *error) {
    *fractions = false;
    if (!frame_names_read_folder(list, folder, keep_mesh, NULL, error)) return false;
    if (frame_names_count(list) == 0)
        return io_fail(error, "%s: no frames in this folder, expected " MESH_FORMAT_ENDINGS " files", folder);
    frame_names_sort(list);
    size_t number = SIZE_MAX;
    if (!check_extensions(folder, list, error)) return false;
    if (!frame_series_find(list, &number) && !frame_series_take_fractions(list, fractions))
        return io_fail(error, "%s: out of memory", folder);
    if (*fractions) return frame_series_end_fractions(prefix, list, allow_gaps, error);
    if (!check_series(folder, list, &number, error)) return false;
    return frame_series_read(prefix, list, number, &list->numbers, error) &&
           (allow_gaps || frame_series_is_complete(prefix, list, number, error));
}
