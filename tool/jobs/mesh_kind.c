/* Jobs that check a mesh each, and what is said of one: a line for people, and members of JSON. */
#include "tool/jobs/mesh_kind.h"

#include "tool/jobs/mesh_job.h"

#include <stdlib.h>
#include <string.h>

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
