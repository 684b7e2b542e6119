/* The events of a report, and the names of the parts that they are of. */
#pragma once

#include "tool/io/json.h"
#include "tool/report/report.h"

typedef struct event_list {
    cscd_event *items; /* the worst ones, in the order of the tracker */
    size_t count, found;
    report_part_name name;
    void *name_user;
    bool known;
} event_list;

/* Copies the events. False: out of memory, and the list holds nothing to free. */
bool event_list_set(event_list *list, const cscd_event *events, size_t count, report_part_name name,
                    void *user);
void event_list_free(event_list *list); /* a zeroed struct is fine */

/* Writes the members "events_found" and "events" of an object. Points are in the page's unit. */
void event_list_write(const event_list *list, const int32_t *frame_numbers, double scale, json *out);
