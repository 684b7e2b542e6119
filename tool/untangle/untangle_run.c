/* A run of `cscd untangle`: frame by frame, each from its neighbour's result. */
#include "tool/untangle/untangle_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct untangle_state {
    const untangle_options *options;
    recording recording;
    ignore_pairs ignored;
    cscd_detector *detector;
    untangle_output output;
    output_file json_file;
    untangle_pages pages;
    untangle_answer answer;
    terminal_progress progress;
    double spread, bending;            /* in the files' unit; 0: not given */
    double *rest;                      /* the rest shape; NULL: not given */
    double *weights;                   /* NULL: nothing is pinned */
    double *positions, *result;        /* of the frame at hand */
    double *start, *start_input;       /* the result for the frame before, and that frame; */
    double *first_clean, *first_input; /* those of the first frame that became clean, */
    uint32_t first_clean_frame;        /* which is this of those chosen; UINT32_MAX: none is yet */
    bool has_start;
    float
        *floats; /* of the model, where they are what is written: room for each set of positions of a call */
    bool *moved; /* per vertex */
} untangle_state;

enum { POSITIONS_OF_CALL = 4 };

static uint32_t vertex_count_of(const untangle_state *u) {
    return cscd_mesh_vertex_count(u->recording.mesh);
}

static size_t model_size(const untangle_state *u) {
    return (size_t)u->recording.objects[0].vertex_count * 3;
}

static bool api_failed(const untangle_state *u, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(u->recording.context));
}

/* ---- what stays where it is ------------------------------------------------------------------------------ */

static void pin_triangles(untangle_state *u, const bool *chosen) {
    const part_names *parts = &u->ignored.parts;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(u->recording.mesh); t++) {
        uint32_t corners[3];
        if (parts->labels[t] == NO_PART || !chosen[parts->labels[t]]) continue;
        cscd_mesh_triangle(u->recording.mesh, t, corners);
        for (int i = 0; i < 3; i++) u->weights[corners[i]] = (double)INFINITY;
    }
}

/* Chooses the parts of "A,B". */
static bool choose_parts(const part_names *parts, const char *text, bool *chosen, io_error *error) {
    for (size_t length; *text != '\0'; text += length + (text[length] == ',')) {
        length = strcspn(text, ",");
        if (length > 0 && part_names_choose(parts, text, length, chosen) == 0)
            return part_names_fail(parts, "--pin", text, length, error);
    }
    return true;
}

static bool pin_parts(untangle_state *u, io_error *error) {
    const part_names *parts = &u->ignored.parts;
    const part_pairs_list *pinned = &u->options->pinned;
    bool *chosen = io_zeroed(((size_t)parts->count + 1) * sizeof *chosen);
    bool good = chosen != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; i < pinned->count && good; i++)
        good = choose_parts(parts, pinned->items[i], chosen, error);
    if (good) pin_triangles(u, chosen);
    free(chosen);
    return good;
}

/* The model moves, and no other object does. */
static bool pin_vertices(untangle_state *u, io_error *error) {
    const uint32_t count = vertex_count_of(u), own = u->recording.objects[0].vertex_count;
    bool any_free = false;
    if (u->options->pinned.count == 0 && count == own) return true;
    u->weights = malloc(((size_t)count + 1) * sizeof *u->weights);
    if (u->weights == NULL) return io_fail(error, "out of memory");
    for (uint32_t v = 0; v < count; v++) u->weights[v] = v < own ? 1.0 : (double)INFINITY;
    if (!pin_parts(u, error)) return false;
    for (uint32_t v = 0; v < own; v++) any_free = any_free || isfinite(u->weights[v]);
    return any_free || io_fail(error, "--pin: every vertex of %s is pinned, so nothing could be moved",
                               u->recording.objects[0].source.name);
}

/* ---- preparing ------------------------------------------------------------------------------------------ */

static bool take_length(const char *option, const length_given *given, const length_unit *unit, double *out,
                        io_error *error) {
    io_error reason;
    if (!given->given || length_given_convert(given, unit, out, &reason)) return true;
    return io_fail(error, "%s %s", option, reason.text);
}

static bool take_lengths(untangle_state *u, io_error *error) {
    const untangle_options *o = u->options;
    const answer_options unit_of = {.unit = o->unit};
    u->answer.unit = answer_options_unit(&unit_of, &u->recording);
    return take_length("--gap", &o->gap, &u->answer.unit, &u->answer.gap, error) &&
           take_length("--spread", &o->spread, &u->answer.unit, &u->spread, error) &&
           take_length("--bending", &o->bending, &u->answer.unit, &u->bending, error);
}

static bool create_detector(untangle_state *u, io_error *error) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = u->answer.gap;
    ignore_pairs_choose(&u->ignored, &options);
    return (cscd_detector_create(u->recording.context, u->recording.mesh, NULL, &options, &u->detector) ==
                CSCD_OK &&
            part_names_tell(&u->ignored.parts, u->detector) == CSCD_OK) ||
           api_failed(u, error);
}

static bool allocate_positions(untangle_state *u, io_error *error) {
    const size_t n = (size_t)vertex_count_of(u) * 3 + 1;
    const bool several = u->answer.count > 1;
    double **const always[] = {&u->positions, &u->result},
                   **const of_several[] = {&u->start, &u->start_input, &u->first_clean, &u->first_input};
    bool allocated = true;
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        allocated = (*always[i] = malloc(n * sizeof(double))) != NULL && allocated;
    for (size_t i = 0; several && i < sizeof of_several / sizeof *of_several; i++)
        allocated = (*of_several[i] = malloc(n * sizeof(double))) != NULL && allocated;
    u->floats = malloc(n * POSITIONS_OF_CALL * sizeof *u->floats);
    u->moved = malloc(n * sizeof *u->moved);
    u->answer.frames = io_zeroed(((size_t)u->answer.count + 1) * sizeof *u->answer.frames);
    allocated = allocated && u->floats != NULL && u->moved != NULL && u->answer.frames != NULL;
    return allocated || io_fail(error, "out of memory");
}

static bool read_rest(untangle_state *u, io_error *error) {
    const char *path = u->options->rest_path;
    if (path == NULL) return true;
    u->rest = malloc(((size_t)vertex_count_of(u) * 3 + 1) * sizeof *u->rest);
    if (u->rest == NULL) return io_fail(error, "out of memory");
    return rest_shape_read(path, &u->recording, u->rest, error);
}

static bool choose_frames(untangle_state *u, io_error *error) {
    const recording *r = &u->recording;
    if (!frame_range_choose(&u->options->frames, r->frame_numbers, r->frame_count, &u->answer.choice, error))
        return false;
    u->answer.count = frame_choice_count(&u->answer.choice);
    return untangle_output_fits(u->options->output_path, &r->objects[0], u->answer.count, error);
}

static bool open_json(untangle_state *u, io_error *error) {
    const char *path = u->options->json_path;
    return path == NULL || output_file_open(path, &u->json_file) || io_fail_write(error, path);
}

static bool prepare_run(untangle_state *u, io_error *error) {
    u->answer.recording = &u->recording;
    u->answer.ignored = &u->ignored;
    u->answer.seconds = u->options->seconds;
    u->first_clean_frame = UINT32_MAX;
    return choose_frames(u, error) && take_lengths(u, error) &&
           ignore_pairs_prepare(&u->options->ignored, &u->recording, &u->ignored, error) &&
           pin_vertices(u, error) && read_rest(u, error) && create_detector(u, error) &&
           allocate_positions(u, error) &&
           untangle_output_open(u->options->output_path, &u->recording, &u->answer.choice, &u->output,
                                error) &&
           untangle_pages_open(u->options->report_path, u->answer.count, vertex_count_of(u), &u->pages,
                               error) &&
           open_json(u, error);
}

static double distance_between(const double *a, const double *b) {
    const double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return sqrt(x * x + y * y + z * z);
}

/* Where edges are shorter than the gap, features that are neighbours by one more edge are nearer than it. */
static void warn_of_gap(untangle_state *u) {
    const cscd_mesh *mesh = u->recording.mesh;
    const uint32_t own = u->recording.objects[0].vertex_count;
    uint32_t count = 0, shorter = 0;
    char text[LENGTH_TEXT_SIZE];
    if (u->options->quiet || u->answer.gap == 0.0) return;
    recording_rest(&u->recording, u->positions);
    for (uint32_t edge = 0; edge < cscd_mesh_edge_count(mesh); edge++) {
        uint32_t ends[2];
        cscd_mesh_edge(mesh, edge, ends);
        if (ends[0] >= own) continue;
        const double *a = u->positions + (size_t)ends[0] * 3, *b = u->positions + (size_t)ends[1] * 3;
        count++;
        shorter += distance_between(a, b) < u->answer.gap;
    }
    if (shorter > 0)
        warn("%u of %u edges are shorter than the gap of %s, so what lies around them has to grow", shorter,
             count, length_text(u->answer.gap, &u->answer.unit, text));
}

/* ---- a frame -------------------------------------------------------------------------------------------- */

static uint32_t frame_at(const untangle_state *u, uint32_t i) {
    return u->answer.choice.first + i * u->answer.choice.step;
}

static int32_t number_at(const untangle_state *u, uint32_t i) {
    return u->recording.frame_numbers[frame_at(u, i)];
}

/* What the file will hold is what is untangled. */
static void round_model(const untangle_state *u, double *x) {
    for (size_t i = 0; u->output.holds_floats && i < model_size(u); i++) x[i] = (double)(float)x[i];
}

static bool read_frame(untangle_state *u, uint32_t i, io_error *error) {
    if (!recording_read(&u->recording, frame_at(u, i), u->positions, error)) return false;
    round_model(u, u->positions);
    return true;
}

/* Counts what intersects in positions. */
static bool count_pairs(untangle_state *u, const double *x, size_t *count, io_error *error) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = CSCD_ANSWER_COUNT;
    if (cscd_detector_find_intersections(u->detector, CSCD_DOUBLES(x, vertex_count_of(u)), &options,
                                         &found) != CSCD_OK)
        return api_failed(u, error);
    *count = found.count;
    return true;
}

/* Positions as the library takes them: those of the model as floats, if these are what is written. */
typedef struct typed_positions {
    float *floats;
    cscd_view views[2];
} typed_positions;

static const cscd_view *view_positions(const untangle_state *u, int set, const double *x,
                                       typed_positions *out) {
    const size_t own = model_size(u), all = (size_t)vertex_count_of(u) * 3;
    if (!u->output.holds_floats) {
        out->views[0] = cscd_view_doubles(x, all / 3);
        return out->views;
    }
    out->floats = u->floats + (size_t)set * own;
    for (size_t i = 0; i < own; i++) out->floats[i] = (float)x[i];
    out->views[0] = cscd_view_floats(out->floats, own / 3);
    out->views[0].object_count = 1;
    out->views[1] = cscd_view_doubles(x + own, (all - own) / 3);
    return out->views;
}

/* Calls the library for the positions, and takes what it has reached. */
static cscd_status reach_result(untangle_state *u, const cscd_untangle_options *options,
                                cscd_untangled *found) {
    const size_t own = model_size(u), all = (size_t)vertex_count_of(u) * 3;
    typed_positions positions, result;
    const cscd_view *from = view_positions(u, 0, u->positions, &positions);
    view_positions(u, 1, u->positions, &result);
    cscd_mutable_view reached[2] = {cscd_mutable_view_doubles(u->result, all / 3)};
    if (u->output.holds_floats) {
        reached[0] = cscd_mutable_view_floats(result.floats, own / 3);
        reached[0].object_count = 1;
        reached[1] = cscd_mutable_view_doubles(u->result + own, (all - own) / 3);
    }
    u->progress.may_stop = true;
    const cscd_status status = cscd_detector_untangle(u->detector, from, options, reached, found);
    u->progress.may_stop = false;
    for (size_t i = 0; u->output.holds_floats && i < own; i++) u->result[i] = (double)result.floats[i];
    return status;
}

static bool call_library(untangle_state *u, bool starts, cscd_untangled *found, io_error *error) {
    cscd_untangle_options options = cscd_untangle_defaults();
    typed_positions start, input;
    const cscd_view rest = cscd_view_doubles(u->rest, vertex_count_of(u));
    options.weights = u->weights;
    options.spread = u->spread;
    options.bending = u->bending;
    if (u->rest != NULL) options.rest = &rest;
    if (starts) {
        options.start = view_positions(u, 2, u->start, &start);
        options.start_input = view_positions(u, 3, u->start_input, &input);
        options.steady = u->options->steady;
    }
    if (u->options->seconds > 0.0) options.max_seconds = u->options->seconds;
    return reach_result(u, &options, found) == CSCD_OK || api_failed(u, error);
}

static int compare_left(const void *a, const void *b) {
    const left_pairs *l = a, *r = b;
    if (l->pairs != r->pairs) return l->pairs > r->pairs ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

/* Marks the parts of which a vertex may move, and at its end whether one of those in no part may. To be freed; NULL:
 * out of memory. */
static bool *find_mobile(const untangle_state *u) {
    const part_names *parts = &u->ignored.parts;
    const uint32_t own = u->recording.objects[0].vertex_count;
    bool *mobile = io_zeroed(((size_t)parts->count + 1) * sizeof *mobile);
    for (uint32_t t = 0; mobile != NULL && t < cscd_mesh_triangle_count(u->recording.mesh); t++) {
        uint32_t corners[3];
        const uint32_t part = parts->labels[t] == NO_PART ? parts->count : parts->labels[t];
        cscd_mesh_triangle(u->recording.mesh, t, corners);
        for (int i = 0; i < 3; i++)
            if (u->weights == NULL ? corners[i] < own : isfinite(u->weights[corners[i]])) mobile[part] = true;
    }
    return mobile;
}

static bool may_move(const untangle_state *u, const bool *mobile, uint32_t part) {
    const uint32_t count = u->ignored.parts.count;
    return mobile[part < count ? part : count];
}

static left_reason reason_of(const untangle_state *u, const untangled_frame *frame,
                             const cscd_part_pair *pair, const bool *mobile) {
    if (!may_move(u, mobile, pair->a) && !may_move(u, mobile, pair->b)) return LEFT_IMMOBILE;
    if (frame->found.stopped) return interrupted() ? LEFT_STOPPED : LEFT_TIME;
    return pair->crossing + pair->folded > 0 ? LEFT_NO_WAY : LEFT_FLUSH;
}

static bool list_left(untangle_state *u, untangled_frame *frame, const cscd_part_pairs *parts,
                      io_error *error) {
    bool *mobile = find_mobile(u);
    frame->left = malloc((parts->count + 1) * sizeof *frame->left);
    if (mobile == NULL || frame->left == NULL) {
        free(mobile);
        return io_fail(error, "out of memory");
    }
    for (size_t i = 0; i < parts->count; i++) {
        const cscd_part_pair *pair = &parts->items[i];
        const size_t pairs =
            pair->crossing + pair->coplanar + pair->folded + pair->touching + pair->duplicate;
        if (pairs > 0)
            frame->left[frame->left_count++] =
                (left_pairs){pair->a, pair->b, pairs, reason_of(u, frame, pair, mobile)};
    }
    free(mobile);
    qsort(frame->left, frame->left_count, sizeof *frame->left, compare_left);
    return true;
}

/* The pairs that are left, by parts; none are known where they do not fit the memory. */
static bool find_left(untangle_state *u, untangled_frame *frame, io_error *error) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.parts = true;
    const cscd_status status = cscd_detector_find_intersections(
        u->detector, CSCD_DOUBLES(u->result, vertex_count_of(u)), &options, &found);
    if (status != CSCD_OK && status != CSCD_LIST_TOO_LONG) return api_failed(u, error);
    return status != CSCD_OK || found.parts == NULL || list_left(u, frame, found.parts, error);
}

/* Most programs read the numbers of a text as floats. */
static bool look_as_floats(untangle_state *u, untangled_frame *frame, io_error *error) {
    const size_t n = (size_t)vertex_count_of(u) * 3;
    size_t pairs = 0;
    if (!frame->found.clean || u->output.holds_floats || u->answer.count > 1) return true;
    for (size_t i = 0; i < n; i++) u->positions[i] = (double)(float)u->result[i];
    for (size_t i = 0; i < n; i++)
        if (!(fabs(u->positions[i]) < (double)INFINITY)) return true;
    if (!count_pairs(u, u->positions, &pairs, error)) return false;
    frame->crosses_as_floats = pairs > 0;
    return true;
}

static void mark_moved(untangle_state *u) {
    for (size_t v = 0; v < vertex_count_of(u); v++)
        u->moved[v] = memcmp(u->result + 3 * v, u->positions + 3 * v, sizeof(double[3])) != 0;
}

/* Takes the result of a frame into the answer. */
static bool take_result(untangle_state *u, uint32_t i, const cscd_untangled *found, io_error *error) {
    untangle_answer *a = &u->answer;
    untangled_frame *frame = &a->frames[i];
    const bool first = a->first == a->end;
    free(frame->left);
    *frame = (untangled_frame){.done = true, .found = *found};
    if (first || i < a->first) a->first = i;
    if (first || i >= a->end) a->end = i + 1;
    untangle_pages_add(&u->pages, i, u->positions, u->result);
    return found->clean ? look_as_floats(u, frame, error) : find_left(u, frame, error);
}

/* The frame's result is where the next one starts. */
static void keep_start(untangle_state *u, uint32_t i, bool clean) {
    const size_t size = (size_t)vertex_count_of(u) * 3 * sizeof *u->result;
    u->has_start = clean;
    if (!clean || u->answer.count == 1) return;
    memcpy(u->start, u->result, size);
    memcpy(u->start_input, u->positions, size);
    if (u->first_clean_frame != UINT32_MAX) return;
    u->first_clean_frame = i;
    memcpy(u->first_clean, u->result, size);
    memcpy(u->first_input, u->positions, size);
}

/* Untangles a frame, and writes it. An interrupt leaves it out, unless it is the only one. */
static bool untangle_frame(untangle_state *u, uint32_t i, io_error *error) {
    cscd_untangled found;
    io_error reason = {""};
    if (!read_frame(u, i, error)) return false;
    if (!call_library(u, u->has_start, &found, &reason))
        return io_fail(error, "frame %d: %s", number_at(u, i), reason.text);
    if (interrupted() && u->answer.count > 1) return true;
    mark_moved(u);
    keep_start(u, i, found.clean);
    const bool written = (u->answer.count == 1 && !found.clean && !u->options->partial) ||
                         untangle_output_write(&u->output, &u->recording, i, u->result, u->moved, error);
    return written && take_result(u, i, &found, error);
}

/* ---- all frames ----------------------------------------------------------------------------------------- */

static void show_progress(untangle_state *u, uint32_t done) {
    terminal_progress_update(&u->progress, done, u->answer.count, "untangle");
}

/* The first frame that does not intersect as it is, else the first of all. */
static bool find_anchor(untangle_state *u, uint32_t *anchor, io_error *error) {
    *anchor = 0;
    for (uint32_t i = 0; i < u->answer.count && u->answer.count > 1 && !interrupted(); i++) {
        size_t pairs;
        if (!read_frame(u, i, error)) return false;
        if (!count_pairs(u, u->positions, &pairs, error)) return false;
        if (pairs > 0) continue;
        *anchor = i;
        break;
    }
    return true;
}

static bool go_forwards(untangle_state *u, uint32_t anchor, io_error *error) {
    u->has_start = false;
    for (uint32_t i = anchor; i < u->answer.count && !interrupted(); i++) {
        show_progress(u, i - anchor);
        if (!untangle_frame(u, i, error)) return false;
    }
    return true;
}

/* From the first frame that became clean to those before it. */
static bool go_backwards(untangle_state *u, uint32_t anchor, io_error *error) {
    const size_t size = (size_t)vertex_count_of(u) * 3 * sizeof *u->result;
    if (u->first_clean_frame == UINT32_MAX || u->first_clean_frame == 0) return true;
    u->has_start = true;
    memcpy(u->start, u->first_clean, size);
    memcpy(u->start_input, u->first_input, size);
    for (uint32_t i = u->first_clean_frame; i-- > 0 && !interrupted();) {
        show_progress(u, u->answer.count - anchor + (i < anchor ? anchor - 1 - i : 0));
        if (!untangle_frame(u, i, error)) return false;
    }
    return true;
}

static bool untangle_frames(untangle_state *u, io_error *error) {
    uint32_t anchor;
    return find_anchor(u, &anchor, error) && go_forwards(u, anchor, error) && go_backwards(u, anchor, error);
}

/* ---- the end -------------------------------------------------------------------------------------------- */

/* What is not clean is kept only if that was asked for. */
static bool close_output(untangle_state *u, io_error *error) {
    untangle_answer *a = &u->answer;
    const bool kept = a->end > a->first && (untangle_answer_clean(a) || u->options->partial);
    recording_end_reading(&u->recording); /* a file that is open may not be replaced on every system */
    if (!untangle_output_close(&u->output, a->first, kept ? a->end - a->first : 0, error)) return false;
    if (kept) a->written = u->options->output_path;
    return true;
}

static bool write_json(untangle_state *u, io_error *error) {
    if (u->json_file.file == NULL) return true;
    json out = {.file = u->json_file.file};
    untangle_answer_write_json(&u->answer, &out);
    fputc('\n', u->json_file.file);
    return output_file_close(&u->json_file, OUTPUT_WHOLE) || io_fail_write(error, u->options->json_path);
}

/* Without a frame that is done there is none. */
static bool write_report(untangle_state *u, io_error *error) {
    if (u->pages.path == NULL || u->answer.end == u->answer.first) return true;
    return untangle_pages_write(&u->pages, &u->answer, u->detector, error);
}

static void tell_what_was_written(const untangle_state *u) {
    const untangle_answer *a = &u->answer;
    const char *path = u->options->output_path;
    if (a->written == NULL)
        note(a->end > a->first
                 ? "%s was not written, since not all is clean; --partial writes the best that was found"
                 : "%s was not written",
             path);
    else if (!u->options->quiet && !output_file_is_standard(path))
        printf("written: %s\n", path);
    if (a->written != NULL && a->frames[a->first].crosses_as_floats)
        warn(
            "%s is clean as it stands, but not for a program that rounds its numbers to floats; --gap, or a .pc2, helps",
            path);
}

static void tell_interrupt(const untangle_state *u) {
    const untangle_answer *a = &u->answer;
    const char *const paths[] = {a->written, u->options->json_path, u->pages.path};
    interrupt_tell(&(interrupt_kept){.done = a->end - a->first,
                                     .whole = a->count,
                                     .what = "frames",
                                     .first = number_at(u, a->first),
                                     .last = number_at(u, a->end > a->first ? a->end - 1 : a->first),
                                     .paths = paths,
                                     .path_count = sizeof paths / sizeof *paths});
}

static int end_run(untangle_state *u, bool ran, const io_error *failure) {
    io_error error = {""};
    if (!ran) u->answer.stopped_by = failure->text;
    if (ran && interrupted()) u->answer.stopped_by = "interrupted";
    if (!u->options->quiet) {
        untangle_answer_print(&u->answer);
        recording_warn(&u->recording);
    }
    const bool closed = close_output(u, &error);
    if (closed) tell_what_was_written(u);
    const bool shown = closed && write_report(u, &error);
    const bool written = write_json(u, shown ? &error : NULL) && shown;
    if (!ran) return fail_input("%s", failure->text);
    if (!written) return fail_input("%s", error.text);
    if (interrupted()) {
        tell_interrupt(u);
        return interrupt_exit_code();
    }
    return untangle_answer_clean(&u->answer) ? EXIT_RAN : EXIT_CONTACT;
}

static void free_run(untangle_state *u) {
    if (u->json_file.file != NULL) output_file_close(&u->json_file, OUTPUT_ABANDONED);
    untangle_output_close(&u->output, 0, 0, NULL);
    for (uint32_t i = 0; u->answer.frames != NULL && i < u->answer.count; i++) free(u->answer.frames[i].left);
    free(u->answer.frames);
    untangle_pages_close(&u->pages);
    cscd_detector_destroy(u->detector);
    ignore_pairs_free(&u->ignored);
    recording_close(&u->recording);
    double *const arrays[] = {u->weights,     u->positions,   u->result,      u->start,
                              u->start_input, u->first_clean, u->first_input, u->rest};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    free(u->floats);
    free(u->moved);
}

int untangle_run_on(const untangle_options *options) {
    untangle_state u = {.options = options};
    io_error error = {""};
    recording_options source = options->source;
    int code;
    source.plays_models = true;
    source.progress = (cscd_progress){terminal_progress_within, &u.progress};
    if (!recording_open(&source, &u.recording, &error)) return fail_input("%s", error.text);
    interrupt_catch();
    if (prepare_run(&u, &error)) {
        warn_of_gap(&u);
        terminal_progress_begin(&u.progress, options->quiet);
        const bool ran = untangle_frames(&u, &error) || interrupt_ended_wait();
        terminal_progress_end(&u.progress);
        code = end_run(&u, ran, &error);
    } else {
        code = fail_input("%s", error.text);
    }
    free_run(&u);
    return code;
}
