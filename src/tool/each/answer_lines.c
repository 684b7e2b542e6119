/* What is said of each mesh among many: a line for people, and a line of JSON. */
#include "src/tool/each/answer_lines.h"

#include "src/io/json.h"

/* ---- for people -------------------------------------------------------------------------------------- */

/* "34 pairs of triangles cross" when it comes first, and then ", 2 touch". */
static void print_kind(FILE *out, size_t count, const char *one, const char *several, bool *first) {
    if (count == 0) return;
    if (*first)
        fprintf(out, " %zu pair%s of triangles %s", count, count == 1 ? "" : "s", count == 1 ? one : several);
    else
        fprintf(out, ", %zu %s", count, count == 1 ? one : several);
    *first = false;
}

static void print_share(FILE *out, double share) {
    const double percent = 100.0 * share;
    if (percent == 0.0) return;
    if (percent < 0.001)
        fprintf(out, "; less than 0.001 %% of the faces");
    else
        fprintf(out, percent < 10.0 ? "; %.2g %% of the faces" : "; %.0f %% of the faces", percent);
}

static void print_repair(FILE *out, uint32_t count, const char *what) {
    if (count > 0) fprintf(out, "; %u face%s %s", count, count == 1 ? "" : "s", what);
}

void answer_print(FILE *out, const char *path, const mesh_answer *a) {
    if (!a->checked) {
        fprintf(out, "%s%s%s\n", a->error == NULL ? path : "", a->error == NULL ? ": " : "",
                mesh_answer_reason(a));
        return;
    }
    bool first = true;
    fprintf(out, "%s:", path);
    print_kind(out, a->crossing, "crosses", "cross", &first);
    print_kind(out, a->coplanar, "lies in one plane", "lie in one plane", &first);
    print_kind(out, a->folded, "is folded", "are folded", &first);
    print_kind(out, a->duplicate, "is a duplicate", "are duplicates", &first);
    print_kind(out, a->touching, "touches", "touch", &first);
    if (first) fputs(" clean", out);
    print_share(out, a->crossing_share);
    print_repair(out, a->repairs.dropped, "left out for having fewer than three different corners");
    print_repair(out, a->repairs.fanned, "filled by fans, as they cross themselves");
    fputc('\n', out);
}

void answer_sums_add(answer_sums *sums, const mesh_answer *a) {
    if (!a->checked)
        sums->failed++;
    else if (a->crossing > 0)
        sums->crossing++;
    else if (a->coplanar + a->folded + a->touching > 0)
        sums->touching++;
    else if (a->duplicate > 0)
        sums->duplicate++;
    else
        sums->clean++;
}

void answer_sums_print(FILE *out, const answer_sums *s) {
    const uint32_t count = s->clean + s->crossing + s->touching + s->duplicate + s->failed;
    fprintf(out, "%u mesh%s: %u clean", count, count == 1 ? "" : "es", s->clean);
    if (s->crossing > 0) fprintf(out, ", %u with intersections", s->crossing);
    if (s->touching > 0) fprintf(out, ", %u only touching", s->touching);
    if (s->duplicate > 0) fprintf(out, ", %u only with duplicates", s->duplicate);
    if (s->failed > 0) fprintf(out, ", %u failed", s->failed);
    fputc('\n', out);
}

/* ---- JSON -------------------------------------------------------------------------------------------- */

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

void answer_write_json(FILE *out, const char *path, const mesh_answer *a) {
    json line = {.file = out};
    json_begin_object(&line, NULL);
    json_string(&line, "file", path);
    if (a->checked)
        json_null(&line, "error");
    else
        json_string(&line, "error", mesh_answer_reason(a));
    write_count(&line, a, "triangles", a->triangle_count);
    write_count(&line, a, "vertices", a->vertex_count);
    write_count(&line, a, "crossing", a->crossing);
    write_count(&line, a, "coplanar", a->coplanar);
    write_count(&line, a, "folded", a->folded);
    write_count(&line, a, "duplicate", a->duplicate);
    write_count(&line, a, "touching", a->touching);
    write_count(&line, a, "crossing_faces", a->crossing_faces);
    write_double(&line, a, "crossing_share", a->crossing_share);
    write_count(&line, a, "zero_area_triangles", a->zero_area_triangles);
    write_count(&line, a, "shortened_faces", a->repairs.shortened);
    write_count(&line, a, "dropped_faces", a->repairs.dropped);
    write_count(&line, a, "fanned_faces", a->repairs.fanned);
    write_double(&line, a, "read_ms", a->read_ms);
    write_double(&line, a, "check_ms", a->check_ms);
    json_end_object(&line);
    fputc('\n', out);
}
