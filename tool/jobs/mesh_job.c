/* Jobs: one mesh among many, how it is read and checked, and its line of results; and what is said of a
 * recording among many. */
#include "tool/jobs/jobs.h"

#include "tool/answers/answers.h"
#include "tool/common/terminal.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- recordings ---------------------------------------------------------------------------------------- */

/* Sums over the frames, and the most in one of them. */
typedef struct frame_sums {
    size_t checked, crossing_frames, touching_frames, same;
    size_t crossing, touching, duplicates, contacts;
    uint32_t most_faces;
    double depth;
} frame_sums;

static frame_sums sum_frames(const answers *a) {
    frame_sums s = {.contacts = a->waiting_contacts};
    const frame_answer *frames = answers_frames(a);
    for (size_t i = 0; i < answers_frame_count(a); i++) {
        const frame_answer *f = &frames[i];
        s.checked += frame_answer_checked(f);
        s.crossing_frames += f->crossing > 0;
        s.touching_frames += f->crossing == 0 && f->touching > 0;
        s.same += f->same;
        s.crossing += f->crossing;
        s.touching += f->touching;
        s.duplicates += f->duplicates;
        s.contacts += f->contacts;
        if (f->crossing_faces > s.most_faces) s.most_faces = f->crossing_faces;
        if (f->depth > s.depth) s.depth = f->depth;
    }
    return s;
}

/* Unless all was looked at, there is no answer that anybody may rely on. */
/* The outcome of finished answers: JOB_FAILED where nobody can rely on them, since not all was looked at, or
 * in some frame no triangle has an area and nothing else was found. */
static job_outcome recording_answer_outcome(const answers *a, const fail_rules *rules) {
    const frame_sums s = sum_frames(a);
    if (answers_unfinished(a) != NULL || fail_rules_undecided(rules, a)) return JOB_FAILED;
    if (s.crossing > 0) return JOB_CROSSING;
    if (s.depth > 0.0 || s.same > 0) return JOB_INSIDE;
    if (s.touching + s.contacts > 0) return JOB_TOUCHING;
    if (s.duplicates > 0) return JOB_DUPLICATE;
    return answers_count(a, frame_answer_without_area) > 0 ? JOB_FAILED : JOB_CLEAN;
}

/* True if any frame fails by the rules. */
static bool recording_answer_found(const answers *a, const fail_rules *rules) {
    char text[FAIL_TEXT_SIZE];
    for (size_t i = 0; i < answers_frame_count(a); i++)
        if (fail_rules_meet(rules, a, &answers_frames(a)[i], text)) return true;
    return false;
}

/* ---- members --------------------------------------------------------------------------------------------------- */

static void write_worst(json *out, const answers *a) {
    if (a->event_count == 0) {
        json_null(out, "worst");
        return;
    }
    const cscd_event *event = &a->events[a->worst_first[0]];
    json_begin_object(out, "worst");
    json_string(out, "a", part_names_at(a->parts, event->a));
    json_string(out, "b", part_names_at(a->parts, event->b));
    json_signed(out, "first", answers_frame_number(a, event->first_frame));
    json_signed(out, "last", answers_frame_number(a, event->last_frame));
    json_signed(out, "worst", answers_frame_number(a, event->worst_frame));
    if (answers_event_depth_known(a, event))
        json_number(out, "depth", event->depth);
    else
        json_null(out, "depth");
    json_number(out, "length", event->length);
    json_end_object(out);
}

static void write_recording_members(json *out, const answers *a, const frame_sums *s) {
    const uint32_t triangles = cscd_mesh_triangle_count(a->recording->mesh);
    json_integer(out, "vertices", cscd_mesh_vertex_count(a->recording->mesh));
    json_integer(out, "triangles", triangles);
    json_integer(out, "frames", answers_frame_count(a));
    json_integer(out, "frames_checked", s->checked);
    json_integer(out, "frames_crossing", s->crossing_frames);
    json_integer(out, "frames_touching", s->touching_frames);
    json_integer(out, "crossing_pairs", s->crossing);
    json_integer(out, "touching_pairs", s->touching);
    json_integer(out, "duplicate_pairs", s->duplicates);
    json_integer(out, "crossing_faces", s->most_faces);
    json_number(out, "crossing_share", triangles > 0 ? (double)s->most_faces / triangles : 0.0);
    json_integer(out, "contacts", s->contacts);
    json_number(out, "depth", s->depth);
    json_integer(out, "events", a->event_count);
    write_worst(out, a);
}

void recording_answer_write(const char *name, const answers *a, const length_unit *unit,
                            const fail_rules *rules, job_output *out) {
    const frame_sums sums = sum_frames(a);
    char *sentence = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&sentence, &size);
    if (stream != NULL) {
        answers_print_sentence(stream, a, unit);
        fclose(stream);
        if (sentence != NULL) sentence[strcspn(sentence, "\n")] = '\0';
    }
    out->outcome = recording_answer_outcome(a, rules);
    out->found = recording_answer_found(a, rules);
    fprintf(out->text, "%s: %s", name, sentence != NULL ? sentence : "");
    json_string(out->members, "name", name);
    if (out->outcome == JOB_FAILED)
        json_string(out->members, "error", sentence != NULL ? sentence : answers_unfinished(a));
    else
        json_null(out->members, "error");
    json_string(out->members, "answer", sentence != NULL ? sentence : "");
    write_recording_members(out->members, a, &sums);
    free(sentence);
}

void recording_answer_fail(const char *name, const char *reason, job_output *out) {
    static const char *const members[] = {
        "answer",          "vertices",        "triangles",      "frames",         "frames_checked",
        "frames_crossing", "frames_touching", "crossing_pairs", "touching_pairs", "duplicate_pairs",
        "crossing_faces",  "crossing_share",  "contacts",       "depth",          "events",
        "worst",           "report"};
    const size_t length = strlen(name);
    const bool named = strncmp(reason, name, length) == 0 && reason[length] == ':';
    fprintf(out->text, "%s%s%s", named ? "" : name, named ? "" : ": ", reason);
    json_string(out->members, "name", name);
    json_string(out->members, "error", reason);
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) json_null(out->members, members[i]);
}

/* ---- meshes -------------------------------------------------------------------------------------------- */

static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static void mesh_answer_free(mesh_answer *answer) {
    free(answer->error);
    free(answer->sentence);
    free(answer->unread);
    *answer = (mesh_answer){0};
}

/* A mesh while it is checked. */
typedef struct mesh_check {
    const mesh_job *job;
    recording *recording;
    ignore_pairs ignored;
    answers answers;
    cscd_detector *detector;
    double *positions;
    mesh_answer *out;
} mesh_check;

static bool prepare_check(mesh_check *c, io_error *error) {
    recording *r = c->recording;
    cscd_detector_options options = cscd_detector_defaults();
    c->positions = malloc((size_t)c->out->vertex_count * 3 * sizeof *c->positions);
    if (c->positions == NULL) return io_fail(error, "out of memory for %u vertices", c->out->vertex_count);
    if (!ignore_pairs_prepare(c->job->ignored, r, &c->ignored, error)) return false;
    ignore_pairs_choose(&c->ignored, &options);
    if (cscd_detector_create(r->context, r->mesh, NULL, &options, &c->detector) != CSCD_OK)
        return io_fail(error, "%s", cscd_context_detail(r->context));
    if (!answers_open(r, &c->ignored, !c->job->answers->no_depths, c->job->answers->limits, &c->answers,
                      error))
        return false;
    if (c->job->answers->as_given) c->answers.orientation = CSCD_ORIENTATION_AS_GIVEN;
    answers_expect(&c->answers, r->frame_count);
    return answers_prepare(&c->answers, c->detector, error);
}

static bool check_frame(mesh_check *c, uint32_t frame, io_error *error) {
    cscd_intersections found;
    mesh_answer *out = c->out;
    if (!recording_read(c->recording, frame, c->positions, error) ||
        !answers_find(&c->answers, c->detector, c->positions, &found, error))
        return false;
    out->crossing += found.crossing;
    out->coplanar += found.coplanar;
    out->folded += found.folded;
    out->duplicate += found.duplicate;
    out->touching += found.touching;
    if (found.zero_area_triangles > out->zero_area_triangles)
        out->zero_area_triangles = found.zero_area_triangles;
    if (!answers_add_found(&c->answers, frame, &found, cscd_detector_timings(c->detector).check_ms, error))
        return false;
    const frame_answer *answer = &answers_frames(&c->answers)[frame];
    if (answer->crossing_faces > out->crossing_faces) out->crossing_faces = answer->crossing_faces;
    if (answer->depth > out->depth) out->depth = answer->depth;
    return true;
}

static bool print_sentence(const answers *a, const length_unit *unit, char **out) {
    size_t size = 0;
    FILE *stream = open_memstream(out, &size);
    if (stream == NULL) return false;
    answers_print_sentence(stream, a, unit);
    if (fclose(stream) != 0 || *out == NULL) return false;
    (*out)[strcspn(*out, "\n")] = '\0';
    return true;
}

/* Sums up all frames. */
static bool conclude_check(mesh_check *c, io_error *error) {
    mesh_answer *out = c->out;
    const answers *a = &c->answers;
    const length_unit unit = answer_options_unit(c->job->answers, c->recording);
    fail_rules rules;
    if (!answers_finish(&c->answers, error) ||
        !fail_rules_create(&c->job->answers->fail, &unit, &rules, error))
        return false;
    const char *unfinished = answers_unfinished(a);
    if (unfinished != NULL) return io_fail(error, "%s", unfinished);
    out->frame_count = c->recording->frame_count;
    out->crossing_share = out->triangle_count > 0 ? (double)out->crossing_faces / out->triangle_count : 0.0;
    out->outcome = recording_answer_outcome(a, &rules);
    out->found = recording_answer_found(a, &rules);
    if (!print_sentence(a, &unit, &out->sentence)) return io_fail(error, "out of memory");
    return out->outcome != JOB_FAILED || io_fail(error, "%s", out->sentence);
}

static bool check_mesh(const mesh_job *job, recording *r, mesh_answer *out, io_error *error) {
    mesh_check c = {.job = job, .recording = r, .out = out};
    bool good = prepare_check(&c, error);
    for (uint32_t frame = 0; frame < r->frame_count && good; frame++) good = check_frame(&c, frame, error);
    good = good && conclude_check(&c, error);
    answers_close(&c.answers);
    cscd_detector_destroy(c.detector);
    ignore_pairs_free(&c.ignored);
    free(c.positions);
    return good;
}

/* The reason why the mesh was not checked. */
static const char *mesh_answer_reason(const mesh_answer *answer) {
    return answer->error != NULL ? answer->error : "out of memory";
}

bool mesh_job_run(const mesh_job *job, cscd_context *context, mesh_answer *out) {
    recording_options source = *job->source;
    source.model_path = job->path;
    source.context = context;
    source.plays_models = true;
    mesh_answer answer = {.checked = false};
    io_error error = {""};
    recording r;
    const double start = now_ms();
    const bool opened = recording_open(&source, &r, &error);
    answer.read_ms = now_ms() - start;
    if (opened) {
        answer.triangle_count = cscd_mesh_triangle_count(r.mesh);
        answer.vertex_count = cscd_mesh_vertex_count(r.mesh);
        answer.repairs = r.objects[0].file.repairs;
        answer.unread = r.objects[0].file.unread;
        r.objects[0].file.unread = NULL;
        answer.checked = check_mesh(job, &r, &answer, &error);
        answer.check_ms = now_ms() - start - answer.read_ms;
        recording_close(&r);
    }
    if (answer.checked) {
        *out = answer;
        return true;
    }
    mesh_answer_free(&answer);
    const bool cancelled = interrupted();
    if (!cancelled) *out = (mesh_answer){.error = strdup(error.text)};
    return !cancelled;
}

/* ---- jobs that check a mesh each ------------------------------------------------------------------------- */

/* ---- for people -------------------------------------------------------------------------------------- */

static void print_repair(FILE *out, uint32_t count, const char *what) {
    if (count > 0)
        fprintf(out, " %u face%s %s %s.", count, count == 1 ? "" : "s", count == 1 ? "is" : "are", what);
}

/* The sentence is that of the mesh alone. */
static void print_answer(FILE *out, const char *path, const mesh_answer *a) {
    fprintf(out, "%s: %s", path, a->sentence);
    print_repair(out, a->repairs.dropped, "left out for having fewer than three different corners");
    print_repair(out, a->repairs.fanned, "filled by fans, as they cross themselves");
    if (a->unread != NULL) fprintf(out, " %s", a->unread);
}

/* ---- members ------------------------------------------------------------------------------------------- */

/* All values of a mesh that was not checked are null. */
static void write_count(json *line, const mesh_answer *a, const char *key, uint64_t count) {
    if (a->checked)
        json_integer(line, key, count);
    else
        json_null(line, key);
}

static void write_double(json *line, const mesh_answer *a, const char *key, double value) {
    if (a->checked)
        json_number(line, key, value);
    else
        json_null(line, key);
}

static void write_mesh_members(json *line, const char *path, const char *reason, const mesh_answer *a,
                               bool reproducible) {
    json_string(line, "file", path);
    if (reason == NULL)
        json_null(line, "error");
    else
        json_string(line, "error", reason);
    write_count(line, a, "triangles", a->triangle_count);
    write_count(line, a, "vertices", a->vertex_count);
    write_count(line, a, "crossing", a->crossing);
    write_count(line, a, "coplanar", a->coplanar);
    write_count(line, a, "folded", a->folded);
    write_count(line, a, "duplicate", a->duplicate);
    write_count(line, a, "touching", a->touching);
    write_count(line, a, "crossing_faces", a->crossing_faces);
    write_double(line, a, "crossing_share", a->crossing_share);
    write_double(line, a, "depth", a->depth);
    write_count(line, a, "frames", a->frame_count);
    write_count(line, a, "zero_area_triangles", a->zero_area_triangles);
    write_count(line, a, "shortened_faces", a->repairs.shortened);
    write_count(line, a, "dropped_faces", a->repairs.dropped);
    write_count(line, a, "fanned_faces", a->repairs.fanned);
    if (reproducible) return;
    write_double(line, a, "read_ms", a->read_ms);
    write_double(line, a, "check_ms", a->check_ms);
}

/* ---- jobs ---------------------------------------------------------------------------------------------- */

static bool run_mesh(const void *user, const job_line *line, cscd_context *context, job_output *out,
                     io_error *error) {
    const mesh_kind_options *o = user;
    const mesh_job job = {
        .path = line->inputs[0], .source = o->source, .ignored = o->ignored, .answers = o->answers};
    mesh_answer answer;
    out->given_up = !mesh_job_run(&job, context, &answer);
    if (out->given_up) return false;
    if (answer.checked) {
        out->outcome = answer.outcome;
        out->found = answer.found;
        print_answer(out->text, job.path, &answer);
        write_mesh_members(out->members, job.path, NULL, &answer, o->reproducible);
    } else
        io_fail(error, "%s", mesh_answer_reason(&answer));
    const bool checked = answer.checked;
    mesh_answer_free(&answer);
    return checked;
}

/* The reason begins with the name of the file, as those of readers do. */
static void fail_mesh(const void *user, const char *name, const char *reason, job_output *out) {
    const mesh_kind_options *o = user;
    const size_t length = strlen(name);
    const bool named = strncmp(reason, name, length) == 0 && reason[length] == ':';
    char *whole = NULL;
    if (!named && asprintf(&whole, "%s: %s", name, reason) >= 0) reason = whole;
    fputs(reason, out->text);
    write_mesh_members(out->members, name, reason, &(mesh_answer){.checked = false}, o->reproducible);
    free(whole);
}

job_kind mesh_kind_of(const mesh_kind_options *options) {
    return (job_kind){
        .one = "mesh", .several = "meshes", .user = options, .run = run_mesh, .fail = fail_mesh};
}
