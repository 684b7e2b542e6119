/* What `cscd untangle` says: a sentence, what is not clean, and all of it as JSON. */
#include "tool/untangle/untangle_run.h"

#include <stdlib.h>
#include <string.h>

static bool frame_crossed(const untangled_frame *frame) {
    return frame->found.pairs_before + frame->found.near_before > 0;
}

static bool frame_left(const untangled_frame *frame) {
    return !frame->found.clean;
}

typedef bool frame_look(const untangled_frame *frame);

/* Of those that are done. */
static uint32_t count_frames(const untangle_answer *a, frame_look *look) {
    uint32_t count = 0;
    for (uint32_t i = a->first; i < a->end; i++) count += look(&a->frames[i]);
    return count;
}

static int32_t number_of(const untangle_answer *a, uint32_t i) {
    return a->recording->frame_numbers[a->choice.first + i * a->choice.step];
}

bool untangle_answer_clean(const untangle_answer *a) {
    return a->end > a->first && count_frames(a, frame_left) == 0;
}

/* ---- the sentence --------------------------------------------------------------------------------------- */

/* "346 pairs", or "346 pairs and 12 nearer than 1 mm". */
static void say_pairs(FILE *out, const untangle_answer *a, size_t pairs, size_t near) {
    char text[LENGTH_TEXT_SIZE];
    fprintf(out, "%zu pair%s", pairs, pairs == 1 ? "" : "s");
    if (near > 0) fprintf(out, " and %zu nearer than %s", near, length_text(a->gap, &a->unit, text));
}

static void say_what_is_not(FILE *out, const untangle_answer *a) {
    char text[LENGTH_TEXT_SIZE];
    fprintf(out,
            a->gap > 0.0 ? " two triangles cross, touch or are nearer than %s"
                         : " two triangles cross or touch",
            length_text(a->gap, &a->unit, text));
}

static void say_moves(FILE *out, const untangle_answer *a, const cscd_untangled *found) {
    char text[LENGTH_TEXT_SIZE];
    fprintf(out, "; %u %s moved, at most %s", found->moved_vertices,
            found->moved_vertices == 1 ? "vertex" : "vertices",
            length_text(found->displacement, &a->unit, text));
    if (found->thickness > 0.0)
        fprintf(out, " (the parts were %s in each other)", length_text(found->thickness, &a->unit, text));
    fputc('.', out);
}

static void say_mesh(FILE *out, const untangle_answer *a) {
    const untangled_frame *frame = &a->frames[a->first];
    const cscd_untangled *found = &frame->found;
    if (found->clean && !frame_crossed(frame)) {
        fprintf(out, "Clean: no");
        say_what_is_not(out, a);
        fprintf(out, "; nothing was moved.");
        return;
    }
    fprintf(out, found->clean ? "Clean: " : "Not clean: ");
    say_pairs(out, a, found->pairs_before, found->near_before);
    if (!found->moved) {
        fprintf(out, " before and after; nothing better was found, so nothing was moved.");
        return;
    }
    fprintf(out, " before, ");
    if (found->clean)
        fprintf(out, "none");
    else
        say_pairs(out, a, found->pairs_after, found->near_after);
    fprintf(out, " after");
    say_moves(out, a, found);
}

/* "of frames 60 to 119": those that are done. */
static void say_span(FILE *out, const untangle_answer *a) {
    if (a->end - a->first == 1)
        fprintf(out, "frame %d", number_of(a, a->first));
    else
        fprintf(out, "frames %d to %d", number_of(a, a->first), number_of(a, a->end - 1));
    if (a->choice.step > 1 && a->end - a->first > 1) fprintf(out, " in steps of %u", a->choice.step);
}

/* The most vertices, the greatest displacement, and where. */
static void say_most(FILE *out, const untangle_answer *a) {
    uint32_t most = 0, worst = a->first;
    char text[LENGTH_TEXT_SIZE];
    for (uint32_t i = a->first; i < a->end; i++) {
        if (a->frames[i].found.moved_vertices > most) most = a->frames[i].found.moved_vertices;
        if (a->frames[i].found.displacement > a->frames[worst].found.displacement) worst = i;
    }
    const cscd_untangled *found = &a->frames[worst].found;
    if (most == 0) {
        fprintf(out, "; nothing was moved.");
        return;
    }
    fprintf(out, "; up to %u %s moved in a frame, at most %s (frame %d", most,
            most == 1 ? "vertex" : "vertices", length_text(found->displacement, &a->unit, text),
            number_of(a, worst));
    if (found->thickness > 0.0)
        fprintf(out, "; the parts were %s in each other", length_text(found->thickness, &a->unit, text));
    fprintf(out, ").");
}

static void say_recording(FILE *out, const untangle_answer *a) {
    const uint32_t crossed = count_frames(a, frame_crossed), left = count_frames(a, frame_left);
    const char *what = a->gap > 0.0 ? "crossed, touched or were too near" : "crossed or touched";
    if (crossed == 0) {
        fprintf(out, "Clean: in none of ");
        say_span(out, a);
        fprintf(out, " do");
        say_what_is_not(out, a);
        fprintf(out, "; nothing was moved.");
        return;
    }
    if (left == 0 && crossed > 1)
        fprintf(out, "Clean: all %u frames that %s, of ", crossed, what);
    else if (left == 0)
        fprintf(out, "Clean: the one frame that %s, of ",
                a->gap > 0.0 ? "crossed, touched or was too near" : what);
    else
        fprintf(out, "Not clean: %u of %u frames that %s, of ", left, crossed, what);
    say_span(out, a);
    say_most(out, a);
}

static void say_sentence(FILE *out, const untangle_answer *a) {
    const uint32_t done = a->end - a->first;
    if (a->stopped_by != NULL) {
        const size_t length = strlen(a->stopped_by);
        fprintf(out, "Not finished: %s%s %u of %u frame%s done.%s", a->stopped_by,
                length > 0 && strchr(".?", a->stopped_by[length - 1]) != NULL ? "" : ".", done, a->count,
                a->count == 1 ? "" : "s", done > 0 ? " " : "");
    }
    if (done > 0 && a->count == 1) say_mesh(out, a);
    if (done > 0 && a->count > 1) say_recording(out, a);
}

static bool frame_stopped(const untangled_frame *frame) {
    return frame->found.stopped;
}

static void say_time(FILE *out, const untangle_answer *a) {
    const uint32_t stopped = count_frames(a, frame_stopped);
    if (stopped == 0 || a->seconds == 0.0 || a->stopped_by != NULL) return;
    if (a->count == 1)
        fprintf(out, " The time was up (--time %g).", a->seconds);
    else
        fprintf(out, " In %u frame%s the time was up (--time %g).", stopped, stopped == 1 ? "" : "s",
                a->seconds);
}

static void say_all(FILE *out, const untangle_answer *a) {
    say_sentence(out, a);
    say_time(out, a);
    ignored_pairs_say(out, a->ignored);
}

/* To be freed; NULL: memory is short. */
static char *sentence_of(const untangle_answer *a) {
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    if (memory == NULL) return NULL;
    say_all(memory, a);
    if (fclose(memory) == 0) return text;
    free(text);
    return NULL;
}

/* ---- tables --------------------------------------------------------------------------------------------- */

enum { ROWS_SHOWN = 20 };

static void print_names(const untangle_answer *a, const left_pairs *left) {
    const part_names *parts = &a->ignored->parts;
    printf("%s x %s", part_names_at(parts, left->a),
           left->a == left->b ? "itself" : part_names_at(parts, left->b));
}

/* Words for people, and those of --json. */
static const char *reason_words(left_reason reason) {
    static const char *const words[LEFT_REASONS] = {"no way out of each other was found",
                                                    "they lie on each other, and no way out was found",
                                                    "the time was up", "interrupted", "neither may move"};
    return words[reason];
}

static const char *reason_name(left_reason reason) {
    static const char *const names[LEFT_REASONS] = {"no_way", "flush", "time", "stopped", "immobile"};
    return names[reason];
}

static void print_left(const untangle_answer *a, const untangled_frame *frame) {
    if (frame->left_count == 0) return;
    printf("\n%9s  parts, and why they are left\n", "pairs");
    for (size_t i = 0; i < frame->left_count && i < ROWS_SHOWN; i++) {
        printf("%9zu  ", frame->left[i].pairs);
        print_names(a, &frame->left[i]);
        printf(": %s\n", reason_words(frame->left[i].reason));
    }
    if (frame->left_count > ROWS_SHOWN)
        printf("and %zu more; --json OUT.json writes all of them\n", frame->left_count - ROWS_SHOWN);
}

static void print_frame(const untangle_answer *a, uint32_t i) {
    const untangled_frame *frame = &a->frames[i];
    char text[LENGTH_TEXT_SIZE];
    printf("%8d  %9zu  %9zu", number_of(a, i), frame->found.pairs_before, frame->found.pairs_after);
    if (a->gap > 0.0) printf("  %9zu", frame->found.near_after);
    printf("  %9s  ", frame->found.moved ? length_text(frame->found.displacement, &a->unit, text) : "-");
    if (frame->left_count == 0) {
        printf("-\n");
        return;
    }
    print_names(a, &frame->left[0]);
    printf(": %s\n", reason_words(frame->left[0].reason));
}

static void print_frames(const untangle_answer *a) {
    uint32_t shown = 0;
    const uint32_t left = count_frames(a, frame_left);
    if (left == 0) return;
    printf("\n%8s  %9s  %9s", "frame", "before", "after");
    if (a->gap > 0.0) printf("  %9s", "too near");
    printf("  %9s  most of them, and why\n", "moved by");
    for (uint32_t i = a->first; i < a->end && shown < ROWS_SHOWN; i++) {
        if (!frame_left(&a->frames[i])) continue;
        print_frame(a, i);
        shown++;
    }
    if (left > shown) printf("and %u more; --json OUT.json writes all of them\n", left - shown);
}

void untangle_answer_print(const untangle_answer *a) {
    say_all(stdout, a);
    putchar('\n');
    if (a->end > a->first && a->count == 1) print_left(a, &a->frames[a->first]);
    if (a->count > 1) print_frames(a);
}

/* ---- JSON ----------------------------------------------------------------------------------------------- */

static void write_text(json *out, const char *key, const char *text) {
    if (text != NULL)
        json_string(out, key, text);
    else
        json_null(out, key);
}

static const char *start_name(cscd_untangle_start start) {
    static const char *const names[] = {"none", "neighbour", "pushed", "shrunk"};
    return (size_t)start < sizeof names / sizeof *names ? names[start] : "other";
}

static void write_left(const untangle_answer *a, const untangled_frame *frame, json *out) {
    const part_names *parts = &a->ignored->parts;
    json_begin_array(out, "left");
    for (size_t i = 0; i < frame->left_count; i++) {
        const left_pairs *left = &frame->left[i];
        json_begin_object(out, NULL);
        write_text(out, "part_a", left->a < parts->count ? parts->names[left->a] : NULL);
        write_text(out, "part_b", left->b < parts->count ? parts->names[left->b] : NULL);
        json_integer(out, "pairs", left->pairs);
        json_string(out, "reason", reason_name(left->reason));
        json_end_object(out);
    }
    json_end_array(out);
}

static void write_frame(const untangle_answer *a, uint32_t i, json *out) {
    const untangled_frame *frame = &a->frames[i];
    const cscd_untangled *found = &frame->found;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_signed(out, "frame", number_of(a, i));
    json_boolean(out, "clean", found->clean);
    json_integer(out, "pairs_before", found->pairs_before);
    json_integer(out, "pairs_after", found->pairs_after);
    json_integer(out, "near_before", found->near_before);
    json_integer(out, "near_after", found->near_after);
    json_integer(out, "moved_vertices", found->moved_vertices);
    json_number(out, "displacement", found->displacement);
    json_number(out, "mean_displacement", found->mean_displacement);
    if (found->moved)
        json_integer(out, "farthest", recording_file_vertex(a->recording, found->farthest));
    else
        json_null(out, "farthest");
    json_number(out, "thickness", found->thickness);
    json_string(out, "start", start_name(found->start));
    json_boolean(out, "stopped", found->stopped);
    if (!found->clean) write_left(a, frame, out);
    json_end_object(out);
}

void untangle_answer_write_json(const untangle_answer *a, json *out) {
    char *sentence = sentence_of(a);
    json_begin_object(out, NULL);
    write_text(out, "answer", sentence);
    free(sentence);
    json_boolean(out, "clean", a->stopped_by == NULL && untangle_answer_clean(a));
    json_boolean(out, "complete", a->stopped_by == NULL);
    write_text(out, "stopped_by", a->stopped_by);
    write_text(out, "written", a->written);
    write_text(out, "unit", a->unit.name);
    json_number(out, "gap", a->gap);
    json_begin_array(out, "frames");
    for (uint32_t i = a->first; i < a->end; i++) write_frame(a, i, out);
    json_end_array(out);
    json_end_object(out);
}
