/* One mesh among many: how it is read and checked, what was found in all frames that its file holds, and its line of results. */
#include "tool/jobs/mesh_job.h"

#include "tool/answers/answer_words.h"
#include "tool/common/terminal.h"
#include "tool/jobs/recording_answer.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

void mesh_answer_free(mesh_answer *answer) {
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
    cscd_intersection_pairs found;
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

/* What all frames come to. */
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

const char *mesh_answer_reason(const mesh_answer *answer) {
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

/* Of a mesh that was not checked all is null. */
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

static void write_members(json *line, const char *path, const char *reason, const mesh_answer *a,
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
        write_members(out->members, job.path, NULL, &answer, o->reproducible);
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
    write_members(out->members, name, reason, &(mesh_answer){.checked = false}, o->reproducible);
    free(whole);
}

job_kind mesh_kind_of(const mesh_kind_options *options) {
    return (job_kind){
        .one = "mesh", .several = "meshes", .user = options, .run = run_mesh, .fail = fail_mesh};
}
