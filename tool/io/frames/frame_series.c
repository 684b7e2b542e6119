/* Compares the numbers in file names: which one counts the frames, and which of its values is missing. */
#include "tool/io/frames/frame_names.h"

#include "tool/io/io.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Steps over the numbers that both names have here; true if their values are the same. */
static bool skip_equal_numbers(const char **a, const char **b) {
    const bool a_negative = **a == '-', b_negative = **b == '-';
    *a += a_negative;
    *b += b_negative;
    *a += strspn(*a, "0");
    *b += strspn(*b, "0");
    const size_t a_length = strspn(*a, "0123456789"), b_length = strspn(*b, "0123456789");
    const bool equal =
        a_length == b_length && memcmp(*a, *b, a_length) == 0 && (a_negative == b_negative || a_length == 0);
    *a += a_length;
    *b += b_length;
    return equal;
}

name_difference frame_series_compare(const char *first, const char *second) {
    name_difference difference = {0};
    const char *a = first, *b = second;
    for (size_t number = 0; *a != '\0' || *b != '\0';) {
        if (frame_names_number_begins(first, a) && frame_names_number_begins(second, b)) {
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

/* Finds the beginning of the number, and its *length with its sign; NULL if the name has fewer. */
static const char *find_number(const char *name, size_t number, size_t *length) {
    const bool last = number == SIZE_MAX;
    const char *found = NULL;
    for (const char *at = last ? path_file_name(name) : name; *at != '\0';) {
        size_t own = 0;
        if (frame_names_number_begins(name, at))
            own = (at[0] == '-') + strspn(at + (at[0] == '-'), "0123456789");
        if (own > 0 && (last || number-- == 0)) {
            found = at;
            *length = own;
            if (!last) return found;
        }
        at += own > 0 ? own : 1;
    }
    return found;
}

static bool read_number(const char *name, size_t number, int32_t *value) {
    size_t length = 0;
    const char *digits = find_number(name, number, &length);
    if (digits == NULL) return false;
    const bool negative = digits[0] == '-';
    int64_t sum = 0;
    for (size_t i = negative; i < length && sum <= INT32_MAX; i++) sum = sum * 10 + (digits[i] - '0');
    if (sum > INT32_MAX) return false;
    *value = (int32_t)(negative ? -sum : sum);
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
    return io_fail(error,
                   "%s%.*s%s%0*" PRId64
                   "%s: missing, expected all frames from %s to %s%s; --allow-gaps takes those that "
                   "exist",
                   folder, (int)place.start, name, gap->missing < 0 ? "-" : "", place.width,
                   gap->missing < 0 ? -gap->missing : gap->missing, name + place.start + place.length,
                   frame_names_at(list, 0), frame_names_at(list, frame_names_count(list) - 1), steps);
}

bool frame_series_is_complete(const char *folder, const frame_names *list, size_t number, io_error *error) {
    frame_gap gap;
    if (!frame_series_find_gap(&list->numbers, &gap)) return true;
    const char *name = frame_names_at(list, gap.before);
    size_t length = 0;
    const char *digits = find_number(name, number, &length);
    const bool negative = digits[0] == '-';
    const number_place place = {(size_t)(digits - name), length,
                                digits[negative] == '0' ? (int)(length - negative) : 1};
    return frame_series_fail(folder, list, &gap, place, error);
}

/* ---- subframes ------------------------------------------------------------------------------------------- */

/* A whole number and the fraction behind it: how far they reach in a name. */
typedef struct name_time {
    size_t start, end, digits; /* of the fraction */
    int64_t value;             /* in units of its last digit */
} name_time;

/* The fraction is this number of the name, the whole the one before. */
static bool read_time(const char *name, size_t fraction, name_time *out) {
    size_t whole_length = 0, length = 0;
    const char *whole = find_number(name, fraction - 1, &whole_length),
               *digits = find_number(name, fraction, &length);
    if (whole == NULL || digits == NULL || whole_length > 10 || length > 9 || digits[0] == '-') return false;
    if (whole + whole_length + 1 != digits || digits[-1] != '.') return false;
    const bool negative = whole[0] == '-';
    int64_t value = 0;
    for (const char *at = whole + negative; at < digits + length; at++)
        if (path_is_digit(*at)) value = value * 10 + (*at - '0');
    *out = (name_time){(size_t)(whole - name), (size_t)(digits - name) + length, length,
                       negative ? -value : value};
    return value <= INT32_MAX;
}

/* Finds the number that is the fraction: the last one that differs anywhere; 0: none may be. */
static size_t find_fraction(const frame_names *list) {
    size_t fraction = 0, most = 0;
    for (size_t i = 1; i < frame_names_count(list); i++) {
        const name_difference d = frame_series_compare(frame_names_at(list, 0), frame_names_at(list, i));
        if (d.in_text) return 0;
        if (d.number_count > 0 && d.last_number > fraction) fraction = d.last_number;
        if (d.number_count > most) most = d.number_count;
    }
    return most <= 2 ? fraction : 0;
}

/* Appends the times to the numbers as long as the names are subframes; false when out of memory. */
static bool read_times(frame_names *list, size_t fraction, bool *found) {
    const char *first = frame_names_at(list, 0);
    name_time of_first, time;
    *found = read_time(first, fraction, &of_first);
    for (size_t i = 0; i < frame_names_count(list) && *found; i++) {
        const char *name = frame_names_at(list, i);
        *found = read_time(name, fraction, &time) && time.digits == of_first.digits &&
                 time.start == of_first.start && memcmp(name, first, time.start) == 0 &&
                 strcmp(name + time.end, first + of_first.end) == 0;
        int32_t *place = *found ? growable_push(&list->numbers) : NULL;
        if (*found && place == NULL) return false;
        if (place != NULL) *place = (int32_t)time.value;
    }
    return true;
}

bool frame_series_take_fractions(frame_names *list, bool *found) {
    const size_t fraction = find_fraction(list);
    *found = false;
    if (fraction == 0) return true;
    if (!read_times(list, fraction, found) || (*found && !frame_names_sort_by_number(list))) return false;
    const int32_t *times = list->numbers.data;
    for (size_t i = 1; i < list->numbers.count; i++)
        if (times[i] == times[i - 1]) *found = false;
    if (!*found) list->numbers.count = 0;
    return true;
}

bool frame_series_end_fractions(const char *folder, frame_names *list, bool allow_gaps, io_error *error) {
    frame_gap gap;
    const bool complete = allow_gaps || !frame_series_find_gap(&list->numbers, &gap);
    list->numbers.count = 0;
    return complete ||
           io_fail(error,
                   "%s%s: is not followed by the next frame but by %s, expected equal steps; "
                   "--allow-gaps takes those that exist",
                   folder, frame_names_at(list, gap.before), frame_names_at(list, gap.before + 1));
}
