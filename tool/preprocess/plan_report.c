/* The report of a plan. */
#include "tool/preprocess/plan_report.h"

#include "tool/common/provenance.h"
#include "tool/io/io.h"
#include "tool/report/report.h"

#include <stdlib.h>

static void write_origin(json *out, const plan_report *r) {
    cscd_preprocess_timings t = cscd_plan_timings(r->plan);
    json_begin_object(out, NULL);
    json_begin_object(out, "timings");
    json_number(out, "assembly_ms", t.assembly_ms);
    json_number(out, "solve_ms", t.solve_ms);
    json_number(out, "regions_ms", t.regions_ms);
    json_number(out, "total_ms", t.total_ms);
    json_end_object(out);
    json_begin_object(out, "provenance");
    provenance_write(out, r->argument_count, r->arguments, cscd_context_thread_count(r->recording->context));
    json_begin_array(out, "inputs");
    provenance_write_input(out, r->model_path, recorded_object_hash_model(&r->recording->objects[0]));
    json_end_array(out);
    json_end_object(out);
    json_end_object(out);
}

/* NULL: out of memory. */
static char *text_of_origin(const plan_report *r) {
    char *text = NULL;
    size_t size = 0;
    json out = {.file = open_memstream(&text, &size)};
    if (out.file == NULL) return NULL;
    write_origin(&out, r);
    bool whole = !ferror(out.file);
    if (fclose(out.file) == 0 && whole) return text;
    free(text);
    return NULL;
}

static bool write_page(const plan_report *r, const char *origin, io_error *error) {
    char generator[PROVENANCE_GENERATOR_SIZE];
    provenance_generator(generator);
    report_options options = {.kind = REPORT_PREPROCESS,
                              .title = r->request->title != NULL ? r->request->title
                                                                 : path_file_name(r->model_path),
                              .generator = generator,
                              .mesh = r->recording->mesh,
                              .plan = r->plan,
                              .up_axis = (int)up_axis_choose(r->request->up, r->model_path)};
    report *page = NULL;
    bool written = report_create(&options, &page, error) && report_begin(page, r->positions, error) &&
                   report_write(page, r->request->path, NULL, 0, origin, error);
    report_destroy(page);
    return written;
}

bool plan_report_write(const plan_report *r, io_error *error) {
    char *origin = text_of_origin(r);
    io_error reason = {"out of memory"};
    bool written = origin != NULL && write_page(r, origin, &reason);
    free(origin);
    return written || io_fail(error, "no report was written: %s", reason.text);
}
