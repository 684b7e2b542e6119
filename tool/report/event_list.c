/* The events of a report, and the names of the parts that they are of. */
#include "tool/report/event_list.h"

#include "tool/common/event_order.h"
#include "tool/io/io.h"
#include "tool/report/page_coordinate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int compare_places(const void *left, const void *right) {
    const cscd_event *a = *(const cscd_event *const *)left, *b = *(const cscd_event *const *)right;
    return (a > b) - (a < b);
}

bool event_list_set(event_list *list, const cscd_event *events, size_t count, report_part_name name,
                    void *user) {
    *list = (event_list){.found = count, .name = name, .name_user = user, .known = true};
    if (count == 0) return true;
    const cscd_event **order = io_realloc(NULL, count * sizeof *order);
    list->count = count < REPORT_EVENTS_MAX ? count : REPORT_EVENTS_MAX;
    list->items = io_realloc(NULL, list->count * sizeof *list->items);
    bool copied = order != NULL && list->items != NULL;
    if (copied) {
        for (size_t i = 0; i < count; i++) order[i] = &events[i];
        if (count > list->count) event_order_sort(order, count);
        qsort(order, list->count, sizeof *order, compare_places);
        for (size_t i = 0; i < list->count; i++) list->items[i] = *order[i];
    }
    free(order);
    if (!copied) event_list_free(list);
    return copied;
}

void event_list_free(event_list *list) {
    free(list->items);
    *list = (event_list){0};
}

static void write_kinds(json *out, uint64_t kinds) {
    json_begin_array(out, "kinds");
    for (int kind = CSCD_INTERSECTION_CROSSING; kind <= CSCD_INTERSECTION_TOUCHING; kind++)
        if (kinds & cscd_intersection_set((cscd_intersection_kind)kind))
            json_string(out, NULL, cscd_intersection_kind_name((cscd_intersection_kind)kind));
    if (kinds & CSCD_EVENT_SAME_SOLID) json_string(out, NULL, "same_solid");
    json_end_array(out);
}

static void write_point(json *out, const double x[3], double scale) {
    if (isnan(x[0])) {
        json_null(out, "point");
        return;
    }
    json_begin_array(out, "point");
    for (int k = 0; k < 3; k++) json_number(out, NULL, page_coordinate(x[k], scale));
    json_end_array(out);
}

static void write_part(const event_list *list, const char *member, uint32_t part, json *out) {
    char buffer[REPORT_PART_NAME_SIZE];
    json_string(out, member, list->name(list->name_user, part, buffer));
}

static void write_event(const event_list *list, const cscd_event *event, const int32_t *frame_numbers,
                        double scale, json *out) {
    const uint64_t frames[] = {event->first_frame, event->last_frame, event->worst_frame};
    static const char *const names[] = {"first", "last", "worst"};
    json_begin_object(out, NULL);
    write_part(list, "a", event->a, out);
    write_part(list, "b", event->b, out);
    for (int i = 0; i < 3; i++)
        json_signed(out, names[i], frame_numbers != NULL ? frame_numbers[frames[i]] : (int64_t)frames[i]);
    write_kinds(out, event->kinds);
    json_integer(out, "pairs", event->pairs);
    json_integer(out, "contacts", event->contacts);
    json_number(out, "depth", event->depth);
    json_number(out, "length", event->length);
    write_point(out, event->x, scale);
    if (event->triangle == UINT32_MAX)
        json_null(out, "triangle");
    else
        json_integer(out, "triangle", event->triangle);
    json_end_object(out);
}

void event_list_write(const event_list *list, const int32_t *frame_numbers, double scale, json *out) {
    if (!list->known) {
        json_null(out, "events");
        return;
    }
    json_integer(out, "events_found", list->found);
    json_begin_array(out, "events");
    for (size_t i = 0; i < list->count; i++) write_event(list, &list->items[i], frame_numbers, scale, out);
    json_end_array(out);
}
