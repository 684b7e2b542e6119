/* A growing list of frames, by their indices, printed as ranges of their numbers. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct frame_span {
    uint32_t first, last;
} frame_span;

typedef struct frame_list {
    frame_span *spans; /* ascending */
    uint32_t count, capacity;
} frame_list;

/* Adds a frame, which is larger than all before. False when out of memory. */
bool frame_list_add(frame_list *list, uint32_t frame);
/* How many frames the list holds. */
uint32_t frame_list_frames(const frame_list *list);

/* Prints prefix, then "3, 7-12, 20", and a line end; for an empty list the line end only. Behind the first 20 ranges stands
 * "and others". numbers: of all frames. */
void frame_list_print(const frame_list *list, const int32_t *numbers, const char *prefix);
void frame_list_free(frame_list *list);
