/* A growing list of frames, by their indices, printed as ranges of their numbers. */
#include "tool/common/frame_list.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

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
