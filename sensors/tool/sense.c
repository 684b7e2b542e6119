/* `cscd sense`: particles that warn where objects come near each other, interval by interval. */
#include "sensors/tool/sense.h"
#include "sensors/tool/object_pairs.h"
#include "tool/common/command.h"
#include "tool/common/frame_range.h"
#include "tool/common/options.h"
#include "tool/common/terminal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A run under way. */
typedef struct sense {
    const sense_options *options;
    recording recording;
    plan_choice plan;
    cscd_sensors *sensors;
    object_map map;
    object_pairs warned, confirmed, touching;
    cscd_detector *detector; /* NULL without --compare */
    double *x0, *x1;
    uint32_t first, last, shown; /* frames; shown: in the picture, UINT32_MAX: there is none */
    bool edge_told;
    sense_paths paths;
    sense_files files;
    sense_totals totals;
    frame_list missed_frames;
    terminal_progress progress;
} sense;

static bool api_failed(const sense *s, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(s->recording.context));
}

static sense_subject subject_of(const sense *s) {
    return (sense_subject){s->options, &s->recording, &s->plan, s->sensors};
}

static bool choose_frames(sense *s, io_error *error) {
    const int32_t *numbers = s->recording.frame_numbers;
    frame_choice frames;
    if (!frame_range_choose(&s->options->frames, numbers, s->recording.frame_count, &frames, error))
        return false;
    s->first = frames.first;
    s->last = frames.last;
    if (s->first >= s->last)
        return io_fail(error, "an interval needs two frames, and %d to %d leave one; the recording has %u",
                       numbers[s->first], numbers[s->last], s->recording.frame_count);
    s->shown = s->options->picture_path == NULL ? UINT32_MAX : s->last;
    if (s->options->picture_path == NULL || !s->options->frame.given) return true;
    uint32_t shown;
    if (!frame_range_find(s->options->frame.value, numbers + s->first, s->last - s->first + 1, &shown, error))
        return false;
    s->shown = s->first + shown;
    return true;
}

static bool prepare_plan(sense *s, io_error *error) {
    const sense_options *o = s->options;
    plan_request request = {.model_path = o->source.model_path,
                            .plan_path = o->plan_path,
                            .method = o->no_plan ? CSCD_METHOD_NONE : CSCD_METHOD_AUTO};
    terminal_progress_begin(&s->progress, o->quiet);
    terminal_progress_say(&s->progress, "preprocessing");
    bool chosen = plan_choose(&request, &s->recording, &s->plan, error);
    terminal_progress_end(&s->progress);
    return chosen;
}

/* Makes the cells from the mesh at rest. */
static bool prepare_sensors(sense *s, io_error *error) {
    const cscd_mesh *mesh = s->recording.mesh;
    size_t size = (size_t)cscd_mesh_vertex_count(mesh) * 3 * sizeof *s->x0;
    s->x0 = malloc(size);
    s->x1 = malloc(size);
    if (s->x0 == NULL || s->x1 == NULL) return io_fail(error, "out of memory");
    recording_rest(&s->recording, s->x0);
    if (cscd_sensors_create(s->recording.context, mesh, s->plan.plan,
                            CSCD_DOUBLES(s->x0, cscd_mesh_vertex_count(mesh)), &s->options->sensors,
                            &s->sensors) != CSCD_OK)
        return api_failed(s, error);
    return object_map_make(mesh, s->sensors, &s->map) || io_fail(error, "out of memory");
}

static bool prepare_detector(sense *s, io_error *error) {
    if (!s->options->compare) return true;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    options.start = CSCD_START_UNKNOWN;
    return cscd_detector_create(s->recording.context, s->recording.mesh, NULL, &options, &s->detector) ==
               CSCD_OK ||
           api_failed(s, error);
}

/* From here on a signal may not end the process by itself, or what is half written would lie about. */
static bool open_files(sense *s, io_error *error) {
    interrupt_catch();
    return sense_files_open(s->options, &s->files, error);
}

static bool begin_sense(sense *s, io_error *error) {
    return recording_open(&s->options->source, &s->recording, error) && choose_frames(s, error) &&
           output_paths_open(&sense_table, s->options, error) && prepare_plan(s, error) &&
           prepare_sensors(s, error) && prepare_detector(s, error) && open_files(s, error);
}

static bool read_frame(sense *s, uint32_t frame, double *positions, io_error *error) {
    if (!recording_read(&s->recording, frame, positions, error)) return false;
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1];
    recording_hash_frame(&s->recording, hashes);
    recording_add_hashes(&s->recording, hashes);
    return true;
}

/* Finds the detector's contacts in the same interval, and counts the pairs that both have found. */
static bool compare_with_detector(sense *s, uint32_t frame, sense_interval *interval, io_error *error) {
    cscd_contacts contacts;
    if (s->detector == NULL) return true;
    if (cscd_detector_step(s->detector, CSCD_DOUBLES(s->x0, cscd_mesh_vertex_count(s->recording.mesh)),
                           CSCD_DOUBLES(s->x1, cscd_mesh_vertex_count(s->recording.mesh)),
                           &contacts) != CSCD_OK)
        return api_failed(s, error);
    interval->trees_ms = cscd_detector_timings(s->detector).total_ms;
    if (!object_pairs_of_contacts(s->recording.mesh, &s->map, &contacts, s->options->sensors.within,
                                  &s->touching))
        return io_fail(error, "out of memory");
    interval->pairs.touching = object_pairs_count(&s->touching);
    interval->pairs.found = object_pairs_common(&s->touching, &s->warned);
    interval->pairs.confirmed_found = object_pairs_common(&s->touching, &s->confirmed);
    if (interval->pairs.found == interval->pairs.touching) return true;
    return frame_list_add(&s->missed_frames, frame) || io_fail(error, "out of memory");
}

/* Warns once: new cells would not shorten an edge. */
static void tell_edge(sense *s, int32_t frame, uint32_t part) {
    if (!s->edge_told && !s->options->quiet)
        warn("frame %d: part %u has an edge longer than --mu, so contacts there may be missed", frame, part);
    s->edge_told = true;
}

/* Makes new cells for the parts that need them, at the frame that ends the interval. */
static bool renew_cells(sense *s, uint32_t frame, sense_interval *interval, io_error *error) {
    int32_t number = s->recording.frame_numbers[frame];
    for (uint32_t p = 0; interval->warnings->renewals_due > 0 && p < cscd_sensors_part_count(s->sensors);
         p++) {
        cscd_renewal why = cscd_sensors_renewal(s->sensors, p);
        if (why == CSCD_RENEWAL_EDGE) tell_edge(s, number, p);
        if (why == CSCD_RENEWAL_NONE || why == CSCD_RENEWAL_EDGE) continue;
        if (cscd_sensors_renew(s->sensors, CSCD_DOUBLES(s->x1, cscd_mesh_vertex_count(s->recording.mesh)),
                               p) != CSCD_OK)
            return api_failed(s, error);
        if (!s->options->quiet)
            printf("frame %d: part %u has new cells, %u now (%s)\n", number, p,
                   cscd_sensors_part(s->sensors, p).cell_count, sense_renewal_name(why));
        interval->renewed++;
    }
    if (interval->renewed > 0) sense_paths_break(&s->paths);
    return true;
}

static bool draw_if_shown(const sense *s, const double *positions, uint32_t frame,
                          const cscd_warnings *warnings, io_error *error) {
    if (frame != s->shown) return true;
    sense_view view = {&s->recording, s->sensors, &s->paths, positions, s->recording.frame_numbers[frame],
                       warnings};
    return sense_picture_draw(&view, s->options, error);
}

static bool count_warnings(sense *s, sense_interval *interval, io_error *error) {
    for (size_t i = 0; i < interval->warnings->count; i++)
        interval->confirmed += interval->warnings->items[i].contact;
    if (!object_pairs_of_warnings(interval->warnings, false, &s->warned) ||
        !object_pairs_of_warnings(interval->warnings, true, &s->confirmed))
        return io_fail(error, "out of memory");
    interval->pairs.warned = object_pairs_count(&s->warned);
    interval->pairs.confirmed = object_pairs_count(&s->confirmed);
    return true;
}

/* The interval from frame k, whose positions are in x0, to frame k + 1. */
static bool run_interval(sense *s, uint32_t k, io_error *error) {
    cscd_warnings warnings;
    if (!read_frame(s, k + 1, s->x1, error)) return false;
    if (cscd_sensors_step(s->sensors, CSCD_DOUBLES(s->x0, cscd_mesh_vertex_count(s->recording.mesh)),
                          CSCD_DOUBLES(s->x1, cscd_mesh_vertex_count(s->recording.mesh)),
                          &warnings) != CSCD_OK)
        return io_fail(error, "frame %d: %s", s->recording.frame_numbers[k],
                       cscd_context_detail(s->recording.context));
    sense_interval interval = {.frame = s->recording.frame_numbers[k],
                               .warnings = &warnings,
                               .timings = cscd_sensors_timings(s->sensors),
                               .counters = cscd_sensors_counters(s->sensors)};
    sense_subject subject = subject_of(s);
    if (!count_warnings(s, &interval, error) || !compare_with_detector(s, k, &interval, error)) return false;
    if (!sense_paths_follow(&s->paths, s->sensors)) return io_fail(error, "out of memory");
    if (!draw_if_shown(s, s->x1, k + 1, &warnings, error) || !renew_cells(s, k + 1, &interval, error))
        return false;
    sense_totals_add(&s->totals, &interval);
    if (!s->options->quiet) sense_print_row(&interval, s->options->compare);
    return sense_files_add(&s->files, &subject, &interval, error);
}

static bool run_intervals(sense *s, io_error *error) {
    if (!read_frame(s, s->first, s->x0, error) || !draw_if_shown(s, s->x0, s->first, NULL, error))
        return false;
    if (!s->options->quiet) sense_print_head(s->options->compare);
    for (uint32_t k = s->first; k < s->last && !interrupted(); k++) {
        terminal_progress_update(&s->progress, k - s->first, s->last - s->first, "sense");
        if (!run_interval(s, k, error)) return false;
        double *swap = s->x0;
        s->x0 = s->x1;
        s->x1 = swap;
    }
    return true;
}

static void print_results(const sense *s) {
    sense_subject subject = subject_of(s);
    sense_print_totals(&subject, &s->totals);
    if (frame_list_frames(&s->missed_frames) > 0)
        frame_list_print(&s->missed_frames, s->recording.frame_numbers,
                         "pairs were missed in the intervals from frame ");
}

static void tell_interrupt(const sense *s) {
    const sense_options *o = s->options;
    const char *const paths[] = {o->csv_path, o->json_path};
    interrupt_tell(&(interrupt_kept){.done = s->totals.intervals,
                                     .whole = s->last - s->first,
                                     .what = "intervals",
                                     .first = s->recording.frame_numbers[s->first],
                                     .last = s->recording.frame_numbers[s->first + s->totals.intervals],
                                     .paths = paths,
                                     .path_count = 2});
}

static void end_sense(sense *s) {
    cscd_detector_destroy(s->detector);
    cscd_sensors_destroy(s->sensors);
    plan_choice_free(&s->plan);
    object_map_free(&s->map);
    object_pairs_free(&s->warned);
    object_pairs_free(&s->confirmed);
    object_pairs_free(&s->touching);
    if (s->recording.mesh != NULL) recording_close(&s->recording);
    sense_paths_free(&s->paths);
    frame_list_free(&s->missed_frames);
    free(s->x0);
    free(s->x1);
}

static int run_sense(const sense_options *options) {
    sense s = {.options = options,
               .warned = object_pairs_none(),
               .confirmed = object_pairs_none(),
               .touching = object_pairs_none(),
               .paths = sense_paths_none()};
    io_error error = {""}, close_error = {""};
    int code = EXIT_RAN;
    bool begun = begin_sense(&s, &error), ran = false;
    if (begun) {
        if (!options->quiet) recording_warn(&s.recording);
        terminal_progress_begin(&s.progress, options->quiet);
        ran = run_intervals(&s, &error) || interrupt_ended_wait();
        terminal_progress_end(&s.progress);
    }
    const char *stopped_by = ran ? (interrupted() ? "interrupted" : NULL) : error.text;
    sense_subject subject = subject_of(&s);
    bool closed = sense_files_close(&s.files, &subject, &s.totals, stopped_by, &close_error);
    if (!options->quiet && s.totals.intervals > 0) print_results(&s);
    if (!ran) code = fail_input("%s", error.text);
    if (!closed && (ran || strcmp(close_error.text, error.text) != 0)) /* what ended the run was said above */
        code = fail_input("%s", close_error.text);
    if (code == EXIT_RAN && interrupted()) {
        tell_interrupt(&s);
        code = interrupt_exit_code();
    }
    end_sense(&s);
    return code;
}

int command_sense(int argument_count, char **arguments) {
    sense_options options;
    int code;
    if (!sense_options_parse(argument_count, arguments, &options, &code)) return code;
    return run_sense(&options);
}
