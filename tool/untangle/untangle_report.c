/* The page of `cscd untangle`: where the vertices were, where they are, and what crosses. */
#include "tool/untangle/untangle_run.h"

#include "tool/common/provenance.h"
#include "tool/report/report.h"

#include <stdlib.h>
#include <string.h>

static size_t frame_size(const untangle_pages *p) {
    return (size_t)p->vertex_count * 3;
}

/* Every stride-th frame has a place, and the last one. */
static bool frame_has_place(const untangle_pages *p, uint32_t i) {
    return i % p->stride == 0 || i == p->frame_count - 1;
}

static uint32_t place_of(const untangle_pages *p, uint32_t i) {
    return (i + p->stride - 1) / p->stride;
}

bool untangle_pages_open(const char *path, uint32_t frame_count, uint32_t vertex_count, untangle_pages *out,
                         io_error *error) {
    if (path == NULL) return true;
    const uint32_t most = report_untangled_frames(vertex_count);
    untangle_pages p = {.path = path, .frame_count = frame_count, .vertex_count = vertex_count, .stride = 1};
    if (frame_count > most) p.stride = most > 1 ? (frame_count + most - 3) / (most - 1) : frame_count;
    p.place_count = place_of(&p, frame_count - 1) + 1;
    const size_t size = frame_size(&p) * p.place_count * sizeof *p.before + 1;
    p.before = malloc(size);
    p.after = malloc(size);
    p.numbers = malloc((p.place_count + 1) * sizeof *p.numbers);
    *out = p;
    return (p.before != NULL && p.after != NULL && p.numbers != NULL) ||
           io_fail(error, "out of memory for the report");
}

void untangle_pages_add(untangle_pages *p, uint32_t i, const double *before, const double *after) {
    if (p->path == NULL || !frame_has_place(p, i)) return;
    const size_t n = frame_size(p), at = place_of(p, i) * n;
    memcpy(p->before + at, before, n * sizeof *before);
    memcpy(p->after + at, after, n * sizeof *after);
}

void untangle_pages_close(untangle_pages *p) {
    free(p->before);
    free(p->after);
    free(p->numbers);
    *p = (untangle_pages){0};
}

/* ---- the page ------------------------------------------------------------------------------------------- */

/* What is being written. */
typedef struct page_draft {
    const untangle_answer *answer;
    cscd_detector *detector;
    report *report;
    uint32_t *frames; /* of those chosen, that are drawn */
    uint32_t count;
} page_draft;

/* What is left out of memory's sake is not drawn. */
static bool add_found(page_draft *d, uint32_t place, const double *x, uint32_t vertex_count,
                      io_error *error) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.depths = true;
    const cscd_status status =
        cscd_detector_find_intersections(d->detector, CSCD_DOUBLES(x, vertex_count), &options, &found);
    if (status == CSCD_LIST_TOO_LONG) return true;
    if (status != CSCD_OK) return io_fail(error, "%s", cscd_context_detail(d->answer->recording->context));
    return report_add_answers(d->report, place, &found, error);
}

static bool add_frames(page_draft *d, const untangle_pages *p, io_error *error) {
    bool added = true;
    for (uint32_t k = 0; k < d->count && added; k++) {
        const size_t at = place_of(p, d->frames[k]) * frame_size(p);
        added = report_add_untangled(d->report, p->before + at, p->after + at, error);
    }
    for (uint32_t k = 0; k < d->count && added; k++) {
        const size_t at = place_of(p, d->frames[k]) * frame_size(p);
        const cscd_untangled *found = &d->answer->frames[d->frames[k]].found;
        added = add_found(d, 2 * k, p->before + at, p->vertex_count, error) &&
                (found->pairs_after == 0 || add_found(d, 2 * k + 1, p->after + at, p->vertex_count, error));
    }
    return added;
}

/* Those that are done. */
static bool choose_drawn(page_draft *d, untangle_pages *p, io_error *error) {
    const untangle_answer *a = d->answer;
    d->frames = malloc((p->place_count + 1) * sizeof *d->frames);
    if (d->frames == NULL) return io_fail(error, "out of memory for the report");
    for (uint32_t i = a->first; i < a->end; i++) {
        if (!frame_has_place(p, i)) continue;
        p->numbers[d->count] = a->recording->frame_numbers[a->choice.first + i * a->choice.step];
        d->frames[d->count++] = i;
    }
    return true;
}

static bool create_page(page_draft *d, const untangle_pages *p, const char *generator, io_error *error) {
    const recording *r = d->answer->recording;
    const char *model = r->objects[0].source.model_path;
    const report_options options = {.kind = REPORT_UNTANGLED,
                                    .title = path_file_name(model),
                                    .fps = recording_fps(r),
                                    .length_unit = d->answer->unit.name,
                                    .generator = generator,
                                    .mesh = r->mesh,
                                    .frame_numbers = p->numbers,
                                    .last = d->count - 1,
                                    .up_axis = (int)up_axis_choose(UP_BY_FORMAT, model)};
    return report_create(&options, &d->report, error);
}

/* The answer as --json has it, to be freed; NULL: memory is short. */
static char *answer_text(const untangle_answer *a) {
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    if (memory == NULL) return NULL;
    json out = {.file = memory};
    untangle_answer_write_json(a, &out);
    if (fclose(memory) == 0) return text;
    free(text);
    return NULL;
}

static bool write_page(page_draft *d, const untangle_pages *p, io_error *error) {
    char *text = answer_text(d->answer);
    const bool written = text != NULL ? report_write(d->report, p->path, NULL, 0, text, error)
                                      : io_fail(error, "out of memory for the report");
    free(text);
    return written;
}

bool untangle_pages_write(untangle_pages *p, const untangle_answer *a, cscd_detector *detector,
                          io_error *error) {
    page_draft d = {.answer = a, .detector = detector};
    char generator[PROVENANCE_GENERATOR_SIZE];
    io_error reason = {""};
    if (p->path == NULL) return true;
    provenance_generator(generator);
    const bool written =
        choose_drawn(&d, p, &reason) && (d.count > 0 || io_fail(&reason, "no frame of it is done")) &&
        create_page(&d, p, generator, &reason) && add_frames(&d, p, &reason) && write_page(&d, p, &reason);
    report_destroy(d.report);
    free(d.frames);
    return written || io_fail(error, "no report was written: %s", reason.text);
}
