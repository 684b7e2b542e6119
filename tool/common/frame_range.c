/* Frames: those that --frames A:B:STEP chooses, and lists of spans for people to read. */
#include "tool/common/frame_range.h"

#include "tool/common/command.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

frame_range frame_range_all(void) {
    return (frame_range){INT64_MIN, INT64_MAX, 1};
}

/* Splits a text at its colons, in place. Returns the number of parts, 0 if there are more than three. */
static int split_range(char *text, char *parts[3]) {
    int count = 0;
    for (char *next = text; next != NULL; count++) {
        if (count == 3) return 0;
        parts[count] = next;
        next = strchr(next, ':');
        if (next != NULL) *next++ = '\0';
    }
    return count;
}

static bool read_number(const char *text, int64_t *number) {
    int32_t value;
    if (!parse_integer(text, &value)) return false;
    *number = value;
    return true;
}

bool frame_range_parse(const char *text, frame_range *out) {
    char copy[48], *parts[3];
    if (strlen(text) >= sizeof copy) return false;
    memcpy(copy, text, strlen(text) + 1);
    frame_range range = frame_range_all();
    int count = split_range(copy, parts);
    if (count == 0 || (count < 3 && parts[0][0] == '\0' && parts[count - 1][0] == '\0')) return false;
    if (parts[0][0] != '\0' && !read_number(parts[0], &range.first)) return false;
    if (count == 1) range.last = range.first;
    if (count > 1 && parts[1][0] != '\0' && !read_number(parts[1], &range.last)) return false;
    if (count > 2 && (!parse_unsigned(parts[2], &range.step) || range.step == 0)) return false;
    if (range.first > range.last) return false;
    *out = range;
    return true;
}

bool frame_range_choose(const frame_range *range, const int32_t *numbers, uint32_t frame_count,
                        frame_choice *out, io_error *error) {
    const int32_t first = numbers[0], last = numbers[frame_count - 1];
    const int64_t from = range->first == INT64_MIN ? first : range->first,
                  to = range->last == INT64_MAX ? last : range->last;
    if (from < first || from > last || to < first || to > last)
        return io_fail(error, "--frames: there is no frame %lld, the recording has the frames %d to %d",
                       (long long)(from < first || from > last ? from : to), first, last);
    frame_choice choice = {0, frame_count - 1, range->step};
    while (numbers[choice.first] < from) choice.first++;
    while (numbers[choice.last] > to) choice.last--;
    if (choice.first > choice.last)
        return io_fail(error, "--frames: the recording has no frame from %lld to %lld", (long long)from,
                       (long long)to);
    *out = choice;
    return true;
}

bool frame_range_find(int32_t number, const int32_t *numbers, uint32_t frame_count, uint32_t *frame,
                      io_error *error) {
    for (uint32_t i = 0; i < frame_count; i++) {
        *frame = i;
        if (numbers[i] == number) return true;
    }
    return io_fail(error, "--frame %d: there are the frames %d to %d", number, numbers[0],
                   numbers[frame_count - 1]);
}

uint32_t frame_choice_count(const frame_choice *choice) {
    return (choice->last - choice->first) / choice->step + 1;
}

/* ---- a growing list of frames, by their indices, printed as ranges of their numbers ---------------------- */

bool frame_list_add(frame_list *list, uint32_t frame) {
    assert(list->count == 0 || frame > list->spans[list->count - 1].last);
    if (list->count > 0 && list->spans[list->count - 1].last + 1 == frame) {
        list->spans[list->count - 1].last = frame;
        return true;
    }
    if (list->count == list->capacity) {
        uint32_t capacity = list->capacity == 0 ? 16 : list->capacity * 2;
        frame_span *grown = realloc(list->spans, capacity * sizeof *grown);
        if (grown == NULL) return false;
        list->spans = grown;
        list->capacity = capacity;
    }
    list->spans[list->count++] = (frame_span){frame, frame};
    return true;
}

uint32_t frame_list_frames(const frame_list *list) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < list->count; i++) sum += list->spans[i].last - list->spans[i].first + 1;
    return sum;
}

/* A long recording may have thousands of spans, which nobody reads. */
enum { SPANS_PRINTED = 20 };

void frame_list_print(const frame_list *list, const int32_t *numbers, const char *prefix) {
    for (uint32_t i = 0; i < list->count && i < SPANS_PRINTED; i++) {
        fputs(i == 0 ? prefix : ", ", stdout);
        printf("%d", numbers[list->spans[i].first]);
        if (list->spans[i].last > list->spans[i].first) printf("-%d", numbers[list->spans[i].last]);
    }
    if (list->count > SPANS_PRINTED) fputs(" and others", stdout);
    putchar('\n');
}

void frame_list_free(frame_list *list) {
    free(list->spans);
    *list = (frame_list){0};
}
