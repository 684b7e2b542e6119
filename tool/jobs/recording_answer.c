/* The answer of a recording among many. */
#include "tool/jobs/recording_answer.h"

#include "tool/answers/answer_words.h"

#include <stdlib.h>
#include <string.h>

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

/* Where not all was looked at, there is no answer that anybody may rely on. */
job_outcome recording_answer_outcome(const answers *a, const fail_rules *rules) {
    const frame_sums s = sum_frames(a);
    if (answers_unfinished(a) != NULL || fail_rules_undecided(rules, a)) return JOB_FAILED;
    if (s.crossing > 0) return JOB_CROSSING;
    if (s.depth > 0.0 || s.same > 0) return JOB_INSIDE;
    if (s.touching + s.contacts > 0) return JOB_TOUCHING;
    if (s.duplicates > 0) return JOB_DUPLICATE;
    return answers_count(a, frame_answer_without_area) > 0 ? JOB_FAILED : JOB_CLEAN;
}

bool recording_answer_found(const answers *a, const fail_rules *rules) {
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

static void write_members(json *out, const answers *a, const frame_sums *s) {
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
    write_members(out->members, a, &sums);
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
