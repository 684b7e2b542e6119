/* Writes a report: the template, what the page is told as JSON, and its arrays. */
#include "tool/report/collected.h"

#include "tool/answers/answers.h"
#include "tool/common/methods.h"
#include "tool/io/io.h"
#include "tool/report/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- events -------------------------------------------------------------------------------------------- */

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

/* Writes the members "events_found" and "events" of an object. Points are in the page's unit. */
static void event_list_write(const event_list *list, const int32_t *frame_numbers, double scale, json *out) {
    if (!list->known) {
        json_null(out, "events");
        return;
    }
    json_integer(out, "events_found", list->found);
    json_begin_array(out, "events");
    for (size_t i = 0; i < list->count; i++) write_event(list, &list->items[i], frame_numbers, scale, out);
    json_end_array(out);
}

/* ---- the page ------------------------------------------------------------------------------------------ */

/* ---- what the page is told --------------------------------------------------------------------------- */

static int64_t frame_number_of(const report *r, uint32_t frame) {
    if (r->options.frame_numbers == NULL) return frame;
    return r->options.frame_numbers[frame];
}

static void write_frames(json *out, const report *r, bool all) {
    json_begin_array(out, "frames");
    for (uint32_t i = 0; i < (all ? report_frame_count(r) : 1); i++)
        json_signed(out, NULL, frame_number_of(r, report_frame(r, i)));
    json_end_array(out);
}

/* The numbers of all frames, also of those that are not kept. */
static void write_numbers(json *out, const report *r) {
    json_begin_array(out, "numbers");
    for (uint32_t frame = r->options.first; frame <= r->last; frame++)
        json_signed(out, NULL, frame_number_of(r, frame));
    json_end_array(out);
}

static void write_scenery(json *out, const report *r) {
    const report_scenery *scenery = &r->options.scenery;
    if (scenery->triangles == NULL) {
        json_null(out, "scenery");
        return;
    }
    json_begin_object(out, "scenery");
    json_integer(out, "vertices", scenery->vertex_count);
    json_integer(out, "triangles", scenery->triangle_count);
    write_frames(out, r, scenery->moves);
    json_end_object(out);
}

static void write_region(json *out, const cscd_region *region, double unit) {
    json_begin_object(out, NULL);
    json_integer(out, "component", region->component);
    json_integer(out, "triangles", region->triangle_count);
    json_number(out, "area", region->area);
    json_number(out, "visible_share", region->visible_share);
    json_begin_array(out, "detector_point");
    for (int k = 0; k < 3; k++) json_number(out, NULL, region->detector_point[k] / unit);
    json_end_array(out);
    json_end_object(out);
}

static void write_plan(json *out, const report *r) {
    const cscd_plan *plan = r->options.plan;
    if (plan == NULL) {
        json_null(out, "plan");
        return;
    }
    json_begin_object(out, "plan");
    json_string(out, "method", cscd_method_name(cscd_plan_method(plan)));
    json_begin_array(out, "regions");
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) {
        cscd_region region = cscd_plan_region(plan, i);
        write_region(out, &region, r->unit);
    }
    json_end_array(out);
    json_begin_array(out, "capacitances");
    if (method_facts_of(cscd_plan_method(plan)).by_charge)
        for (uint32_t c = 0; c < cscd_mesh_component_count(r->options.mesh); c++)
            json_number(out, NULL, cscd_plan_capacitance(plan, c));
    json_end_array(out);
    json_end_object(out);
}

static void write_contacts(json *out, const report *r) {
    if (r->contacts.heat == NULL) {
        json_null(out, "contacts");
        return;
    }
    json_begin_object(out, "contacts");
    json_integer(out, "found", r->contacts.found);
    json_integer(out, "kept", r->contacts.kept);
    json_integer(out, "interval_limit", REPORT_INTERVAL_CONTACTS_MAX);
    json_integer(out, "limit", REPORT_CONTACTS_MAX);
    json_end_object(out);
}

static void write_answers(json *out, const report *r) {
    const answer_arrays *a = &r->answers;
    if (a->frames_checked == 0) {
        json_null(out, "answers");
        return;
    }
    json_begin_object(out, "answers");
    json_integer(out, "frames_checked", a->frames_checked);
    json_integer(out, "triangles_found", a->found.triangles);
    json_integer(out, "triangles_kept", a->kept.triangles);
    json_integer(out, "points_found", a->found.points);
    json_integer(out, "points_kept", a->kept.points);
    json_integer(out, "depths_found", a->found.depths);
    json_integer(out, "depths_kept", a->kept.depths);
    event_list_write(&r->events, r->options.frame_numbers, 1.0 / r->unit, out);
    json_end_object(out);
}

static void write_scene(json *out, const report *r, const page_arrays *arrays) {
    const cscd_mesh *mesh = r->options.mesh;
    if (mesh == NULL) {
        json_null(out, "scene");
        return;
    }
    json_begin_object(out, "scene");
    json_integer(out, "vertices", cscd_mesh_vertex_count(mesh));
    json_integer(out, "triangles", cscd_mesh_triangle_count(mesh));
    json_integer(out, "components", cscd_mesh_component_count(mesh));
    json_number(out, "unit", r->unit);
    json_string(out, "up", r->options.up_axis == 1 ? "y" : "z");
    if (r->options.fps > 0.0)
        json_number(out, "fps", r->options.fps);
    else
        json_null(out, "fps");
    if (r->options.length_unit != NULL)
        json_string(out, "length_unit", r->options.length_unit);
    else
        json_null(out, "length_unit");
    json_signed(out, "first", frame_number_of(r, r->options.first));
    json_signed(out, "last", frame_number_of(r, r->last));
    write_numbers(out, r);
    write_frames(out, r, true);
    json_number(out, "max_error", r->frames.max_error);
    json_number(out, "relative_error", r->frames.relative_error);
    write_scenery(out, r);
    write_plan(out, r);
    write_contacts(out, r);
    write_answers(out, r);
    page_file_list(out, arrays);
    json_end_object(out);
}

/* Writes the document that goes with the arrays; summaries and what was made are JSON already. */
typedef struct attached {
    const report_summary *summaries;
    size_t summary_count;
    const char *made;
} attached;

/* Long tables of theirs become arrays of the page. False: out of memory. */
static bool write_summaries(json *out, const attached *with, page_arrays *arrays) {
    bool made = true;
    json_begin_array(out, "summaries");
    for (size_t i = 0; i < with->summary_count && made; i++) {
        char prefix[32], *moved = NULL;
        snprintf(prefix, sizeof prefix, "summary-%zu", i);
        made = json_table_move(with->summaries[i].text, prefix, arrays, &moved);
        json_begin_object(out, NULL);
        json_string(out, "name", with->summaries[i].name);
        json_verbatim(out, "summary", moved != NULL ? moved : with->summaries[i].text);
        json_end_object(out);
        free(moved);
    }
    json_end_array(out);
    return made;
}

static bool write_json(FILE *file, const report *r, page_arrays *arrays, const attached *with) {
    static const char *const kinds[] = {"replay", "preprocess", "compare", "untangled"};
    json out = {.file = file};
    json_begin_object(&out, NULL);
    json_integer(&out, "format", 1);
    json_string(&out, "kind", kinds[r->options.kind]);
    json_string(&out, "title", r->options.title);
    json_string(&out, "generator", r->options.generator);
    write_scene(&out, r, arrays);
    const bool made = write_summaries(&out, with, arrays);
    const bool untangled = r->options.kind == REPORT_UNTANGLED;
    if (with->made != NULL && !untangled)
        json_verbatim(&out, "preprocess", with->made);
    else
        json_null(&out, "preprocess");
    if (with->made != NULL && untangled) json_verbatim(&out, "untangled", with->made);
    json_end_object(&out);
    return made;
}

/* The text, to be freed; NULL: out of memory. */
static char *make_json(const report *r, page_arrays *arrays, const attached *with) {
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    if (memory == NULL) return NULL;
    bool whole = write_json(memory, r, arrays, with) && !ferror(memory);
    whole = fclose(memory) == 0 && whole;
    if (whole) return text;
    free(text);
    return NULL;
}

/* ---- the file ---------------------------------------------------------------------------------------- */

bool report_write(report *r, const char *path, const report_summary *summaries, size_t summary_count,
                  const char *made, io_error *error) {
    report_template page;
    if (!report_template_load(TEMPLATE_REPORT, &page, error)) return false;
    page_arrays arrays = {.count = 0};
    const attached with = {summaries, summary_count, made};
    char *text = NULL;
    bool listed = (r->options.mesh == NULL || report_keep_last(r)) && page_arrays_list(r, &arrays) &&
                  (text = make_json(r, &arrays, &with)) != NULL;
    bool written = listed ? page_file_write(path, &page, text, &arrays, error)
                          : io_fail(error, "%s: out of memory for the report", path);
    free(text);
    page_arrays_free(&arrays);
    return written;
}
