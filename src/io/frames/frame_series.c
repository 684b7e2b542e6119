/* Compares the numbers in file names: which one counts the frames, and which of its values is missing. */
#include "src/io/frames/frame_series.h"

#include "src/io/path_name.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Steps over the numbers that both names have here; true if their values are the same. */
static bool skip_equal_numbers(const char **a, const char **b) {
    *a += strspn(*a, "0");
    *b += strspn(*b, "0");
    const size_t a_length = strspn(*a, "0123456789"), b_length = strspn(*b, "0123456789");
    const bool equal = a_length == b_length && memcmp(*a, *b, a_length) == 0;
    *a += a_length;
    *b += b_length;
    return equal;
}

name_difference frame_series_compare(const char *a, const char *b) {
    name_difference difference = {0};
    for (size_t number = 0; *a != '\0' || *b != '\0';) {
        if (path_is_digit(*a) && path_is_digit(*b)) {
            if (!skip_equal_numbers(&a, &b)) {
                difference.number_count++;
                difference.last_number = number;
            }
            number++;
        } else if (*a++ != *b++) {
            difference.in_text = true;
            break;
        }
    }
    return difference;
}

bool frame_series_find(const frame_names *list, size_t *number) {
    for (size_t i = 1; i < frame_names_count(list); i++) {
        const char *name = frame_names_at(list, i);
        const name_difference from_first = frame_series_compare(frame_names_at(list, 0), name);
        if (from_first.in_text || from_first.number_count != 1) return false;
        if (i > 1 && from_first.last_number != *number) return false;
        if (frame_series_compare(frame_names_at(list, i - 1), name).number_count == 0) return false;
        *number = from_first.last_number;
    }
    return frame_names_count(list) > 1;
}

/* Where the number begins, and *length its digits; NULL if the name has fewer. */
static const char *find_number(const char *name, size_t number, size_t *length) {
    const bool last = number == SIZE_MAX;
    const char *found = NULL;
    for (const char *at = last ? path_file_name(name) : name; *at != '\0';) {
        const size_t digits = strspn(at, "0123456789");
        if (digits > 0 && (last || number-- == 0)) {
            found = at;
            *length = digits;
            if (!last) return found;
        }
        at += digits > 0 ? digits : 1;
    }
    return found;
}

static bool read_number(const char *name, size_t number, int32_t *value) {
    size_t length = 0;
    const char *digits = find_number(name, number, &length);
    if (digits == NULL) return false;
    int64_t sum = 0;
    for (size_t i = 0; i < length && sum <= INT32_MAX; i++) sum = sum * 10 + (digits[i] - '0');
    if (sum > INT32_MAX) return false;
    *value = (int32_t)sum;
    return true;
}

bool frame_series_read(const char *folder, const frame_names *list, size_t number, growable *numbers,
                       io_error *error) {
    int32_t value = 0;
    for (size_t i = 0; i < frame_names_count(list); i++) {
        if (!read_number(frame_names_at(list, i), number, &value)) {
            numbers->count = 0;
            return true;
        }
        int32_t *place = growable_push(numbers);
        if (place == NULL)
            return io_fail(error, "%s%s: out of memory for the numbers of %zu frames", folder,
                           frame_names_at(list, 0), frame_names_count(list));
        *place = value;
    }
    return true;
}

static int64_t greatest_divisor(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

bool frame_series_find_gap(const growable *numbers, frame_gap *gap) {
    const int32_t *values = numbers->data;
    int64_t step = 0;
    for (size_t i = 1; i < numbers->count; i++) step = greatest_divisor(step, (int64_t)values[i] - values[0]);
    for (size_t i = 1; i < numbers->count; i++) {
        const int64_t expected = values[0] + step * (int64_t)i;
        if (values[i] == expected) continue;
        *gap = (frame_gap){i - 1, expected, step};
        return true;
    }
    return false;
}

bool frame_series_fail(const char *folder, const frame_names *list, const frame_gap *gap, number_place place,
                       io_error *error) {
    const char *name = frame_names_at(list, gap->before);
    char steps[48] = "";
    if (gap->step > 1) snprintf(steps, sizeof steps, " in steps of %" PRId64, gap->step);
    return io_fail(
        error,
        "%s%.*s%0*" PRId64 "%s: missing, expected all frames from %s to %s%s; --allow-gaps takes those that "
        "exist",
        folder, (int)place.start, name, place.width, gap->missing, name + place.start + place.length,
        frame_names_at(list, 0), frame_names_at(list, frame_names_count(list) - 1), steps);
}

bool frame_series_is_complete(const char *folder, const frame_names *list, size_t number, io_error *error) {
    frame_gap gap;
    if (!frame_series_find_gap(&list->numbers, &gap)) return true;
    const char *name = frame_names_at(list, gap.before);
    size_t length = 0;
    const char *digits = find_number(name, number, &length);
    const number_place place = {(size_t)(digits - name), length, digits[0] == '0' ? (int)length : 1};
    return frame_series_fail(folder, list, &gap, place, error);
}
