/* `cscd preprocess`: makes the plan of a mesh, prints what it found and saves it. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tool/common/command.h"
#include "tool/common/frame_range.h"
#include "tool/common/methods.h"
#include "tool/common/options.h"
#include "tool/common/plans.h"
#include "tool/common/provenance.h"
#include "tool/common/recording.h"
#include "tool/common/terminal.h"
#include "tool/io/io.h"
#include "tool/io/ply.h"
#include "tool/report/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- frames that a plan looks at ----------------------------------------------------------------------- */

/* As many as a plan looks at. */
enum { MOTION_FRAMES_MOST = 8 };

typedef struct motion_frames {
    uint32_t count;
    double *positions;
    cscd_view views[MOTION_FRAMES_MOST];
    const cscd_view *items[MOTION_FRAMES_MOST]; /* as cscd_plan_options takes them */
} motion_frames;

static uint32_t frame_of(const frame_choice *choice, uint32_t i, uint32_t wanted) {
    const uint32_t last = frame_choice_count(choice) - 1;
    return choice->first + choice->step * (uint32_t)((uint64_t)i * last / (wanted > 1 ? wanted - 1 : 1));
}

static void free_motion_frames(motion_frames *frames) {
    free(frames->positions);
    *frames = (motion_frames){0};
}

/* Reads frames of the range, evenly spaced, the first and the last among them. On false there is nothing to
 * free. */
static bool read_motion_frames(recording *r, const frame_range *range, motion_frames *out, io_error *error) {
    const uint32_t vertices = cscd_mesh_vertex_count(r->mesh);
    frame_choice choice;
    *out = (motion_frames){0};
    if (!frame_range_choose(range, r->frame_numbers, r->frame_count, &choice, error)) return false;
    const uint32_t found = frame_choice_count(&choice),
                   wanted = found < MOTION_FRAMES_MOST ? found : MOTION_FRAMES_MOST;
    out->positions = malloc((size_t)wanted * vertices * sizeof(double[3]));
    bool read = out->positions != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; i < wanted && read; i++) {
        double *positions = out->positions + (size_t)i * vertices * 3;
        read = recording_read(r, frame_of(&choice, i, wanted), positions, error);
        out->views[i] = *CSCD_DOUBLES(positions, vertices);
        out->items[i] = &out->views[i];
        out->count++;
    }
    if (!read) free_motion_frames(out);
    return read;
}

/* ---- for people ---------------------------------------------------------------------------------------- */

enum { LINES_MAX = 50 };

static double total_area(const cscd_plan *plan) {
    double area = 0.0;
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) area += cscd_plan_region(plan, i).area;
    return area;
}

static double percent_of(double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
}

static void print_components(const cscd_mesh *mesh, const cscd_plan *plan) {
    uint32_t count = cscd_mesh_component_count(mesh);
    for (uint32_t i = 0; i < count && i < LINES_MAX; i++)
        printf("component %u: %u triangles, capacitance %.6g\n", i,
               cscd_mesh_component(mesh, i).triangle_count, cscd_plan_capacitance(plan, i));
    if (count > LINES_MAX) printf("and %u more components\n", count - LINES_MAX);
}

static void print_regions(const cscd_plan *plan) {
    const uint32_t count = cscd_plan_region_count(plan);
    const double whole = total_area(plan);
    printf("%6s %9s %9s %13s %16s   detector point\n", "region", "component", "triangles", "share of area",
           "its point sees");
    for (uint32_t i = 0; i < count && i < LINES_MAX; i++) {
        const cscd_region r = cscd_plan_region(plan, i);
        const double *p = r.detector_point;
        printf("%6u %9u %9u %11.1f %% %14.1f %%   (%.6g, %.6g, %.6g)\n", i, r.component, r.triangle_count,
               percent_of(r.area, whole), 100.0 * r.visible_share, p[0], p[1], p[2]);
    }
    if (count > LINES_MAX) printf("and %u more regions\n", count - LINES_MAX);
}

/* The answer: how many regions there are, and how much of the model is seen. */
static void print_answer(const char *model_path, const cscd_plan *plan) {
    const uint32_t count = cscd_plan_region_count(plan);
    double seen = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const cscd_region r = cscd_plan_region(plan, i);
        seen += r.visible_share * r.area;
    }
    printf("%s: %u region%s by method %s; %s %.1f %% of the area\n", model_path, count, count == 1 ? "" : "s",
           cscd_method_name(cscd_plan_method(plan)), count == 1 ? "its point sees" : "their points see",
           percent_of(seen, total_area(plan)));
}

/* Prints the methods that method auto has compared. */
static void print_compared(const cscd_plan *plan) {
    const uint32_t count = cscd_plan_describe(plan).compared_count;
    if (count == 0) return;
    printf("%-10s %8s %30s\n", "method", "regions", "triangles left to test");
    for (uint32_t i = 0; i < count; i++) {
        const cscd_compared_plan c = cscd_plan_compared(plan, i);
        char name[24];
        snprintf(name, sizeof name, c.k > 0 ? "%s:%u" : "%s", cscd_method_name(c.method), c.k);
        if (c.failure != NULL)
            printf("%-10s %8s %30s\n    %s\n", name, "-", "-", c.failure);
        else
            printf("%-10s %8u %28.1f %%%s\n", name, c.region_count, 100.0 * c.tested_share,
                   c.kept ? "   kept" : "");
    }
}

/* Prints components, regions and seconds on the standard output. */
static void print_plan(const char *model_path, const cscd_mesh *mesh, const cscd_plan *plan) {
    const cscd_preprocess_timings t = cscd_plan_timings(plan);
    const uint32_t components = cscd_mesh_component_count(mesh);
    print_answer(model_path, plan);
    printf("%u vertices, %u triangles, %u component%s\n", cscd_mesh_vertex_count(mesh),
           cscd_mesh_triangle_count(mesh), components, components == 1 ? "" : "s");
    if (method_facts_of(cscd_plan_method(plan)).by_charge) print_components(mesh, plan);
    print_compared(plan);
    print_regions(plan);
    printf("seconds: assembly %.3f, solve %.3f, regions %.3f, total %.3f\n", t.assembly_ms * 1e-3,
           t.solve_ms * 1e-3, t.regions_ms * 1e-3, t.total_ms * 1e-3);
}

/* ---- the report ---------------------------------------------------------------------------------------- */

typedef struct plan_report {
    const report_request *request;
    const char *model_path;
    const recording *recording;
    const double *positions; /* at rest */
    const cscd_plan *plan;
    int argument_count; /* the command line */
    char **arguments;
} plan_report;

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
    provenance_write(out, r->argument_count, r->arguments,
                     cscd_context_describe(r->recording->context).thread_count);
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

static bool write_plan_report(const plan_report *r, io_error *error) {
    char *origin = text_of_origin(r);
    io_error reason = {"out of memory"};
    bool written = origin != NULL && write_page(r, origin, &reason);
    free(origin);
    return written || io_fail(error, "no report was written: %s", reason.text);
}

/* ---- the command --------------------------------------------------------------------------------------- */

typedef struct preprocess_options {
    recording_options source;
    frame_range frames;
    cscd_plan_options plan;
    const char *output_path;
    report_request report;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
    bool quiet;
} preprocess_options;

static bool read_plan_method(const char *text, void *place) {
    cscd_plan_options *plan = place;
    return parse_method(text, &plan->method, &plan->k) &&
           (plan->method == CSCD_METHOD_AUTO || method_facts_of(plan->method).makes_plan);
}

static bool read_share(const char *text, void *place) {
    double *share = place;
    return parse_double(text, share) && *share > 0.0 && *share < 1.0;
}

static bool read_growing(const char *text, void *place) {
    double *share = place;
    return parse_double(text, share) && *share >= 0.0 && *share <= 1.0;
}

static bool read_charge_solver(const char *text, void *place) {
    static const char *const names[] = {"tree", "dense", "coarse"};
    cscd_charge_solver *solver = place;
    for (*solver = CSCD_CHARGE_TREE; *solver <= CSCD_CHARGE_COARSE; ++*solver)
        if (strcmp(text, names[*solver]) == 0) return true;
    return false;
}

static const option_row rows[] = {
    {"o", "PLAN.ply", read_input_path, offsetof(preprocess_options, output_path),
     "default: MODEL with .plan.ply for its ending, where replay looks for it"},
    {"output", "PLAN.ply", read_input_path, offsetof(preprocess_options, output_path), NULL},
    {"report", "OUT.html", read_output_path, offsetof(preprocess_options, report.path),
     "also write a page that shows charge, regions and detector points in any browser"},
    {"up", "y|z", read_up, offsetof(preprocess_options, report.up),
     "of the report: which axis points up (default: y of OBJ and glTF, else z)"},
    {"method", "charge", read_plan_method, offsetof(preprocess_options, plan),
     "cut where little charge gathers on the mesh as a conductor (default)"},
    {"method", "kmeans:K", .help = "K regions by distance"},
    {"method", "single", .help = "one region per component"},
    {"method", "published", .help = "as published (Yeh 2012), to compare with: docs/theory/thesis.md"},
    {"method", "auto",
     .help = "the one of these that leaves the least to test, as predicted at rest and in the FRAMES"},
    {"seed", "N", read_unsigned, offsetof(preprocess_options, plan.seed),
     "with kmeans: another number gives other regions (default 1)"},
    {"threshold", "X", read_share, offsetof(preprocess_options, plan.threshold),
     "with charge: cuts run along the triangles of least charge; X is their share of all (default 0.1)"},
    {"charge", "tree", read_charge_solver, offsetof(preprocess_options, plan.charge_solver),
     "with charge: solve for it by iterations of a treecode, with about 2 kB a triangle (default)"},
    {"charge", "coarse", .help = "the same with half the iterations, to some percent"},
    {"charge", "dense",
     .help = "by a dense matrix, to compare: 8 bytes for each pair of triangles of a component, "
             "and time with the cube of their number"},
    {"growing", "X", read_growing, offsetof(preprocess_options, plan.growing),
     "with published: clusters with more than this share of the triangles grow (default 0.0025)"},
    {"ours", "STEP,...", read_ours_of_plans, offsetof(preprocess_options, plan.ours),
     "with published: take these steps from charge instead: charge, ranks, cuts, points"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(preprocess_options, frames),
     "of FRAMES, only those from A to B, both included (A: and :B are open ends)"},
    {"quiet", NULL, read_flag, offsetof(preprocess_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

static const option_table table = {
    "preprocess",
    "MODEL [FRAMES...] [-o PLAN.ply] [options]",
    "Cuts the mesh MODEL (" MESH_FORMAT_NAMES
    "), at rest as in the file, into regions, each with a point that sees "
    "most of it, and saves this plan as a PLY that any viewer shows. cscd replay uses it to leave out pairs "
    "of triangles that cannot touch; it needs the same --weld. Contacts are the same with any plan and with none.\n"
    "Faces of a PLY may say how stiff they are, in a property stiffness: charge then cuts where the model is soft.\n"
    "FRAMES: a motion that the plan is made for, of which eight frames, evenly spaced, count as the rest does: one .pc2 or .mdd "
    "point cache, one .glb or .gltf file, a pattern like f_%04d.obj, a folder, or a list of mesh files.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&frame_rows, offsetof(preprocess_options, source)}},
    .examples = {
        {"preprocess body.obj",
         "Cut a closed body into regions, once, and write them to body.plan.ply, where replay finds them."},
        {"preprocess body.obj --report plan.html",
         "Also write a page that shows the regions in any browser."},
        {"preprocess body.obj body.pc2 --method auto",
         "Make the plan for this motion, by the method that leaves the least to test."}}};

static bool save_plan(const preprocess_options *o, const recording *r, const double *positions,
                      const cscd_plan *plan, io_error *error) {
    uint32_t count = cscd_mesh_triangle_count(r->mesh);
    uint8_t *colours = malloc((size_t)count * 3);
    if (colours == NULL) return io_fail(error, "out of memory");
    plan_colour_regions(plan, count, colours);
    bool saved = plan_file_write(o->output_path, r->mesh, positions, plan, colours, error);
    free(colours);
    return saved;
}

static bool save_report(const preprocess_options *o, const recording *r, const double *positions,
                        const cscd_plan *plan, io_error *error) {
    if (o->report.path == NULL) return true;
    plan_report shown = {&o->report, o->source.model_path, r,           positions,
                         plan,       o->argument_count,    o->arguments};
    if (!write_plan_report(&shown, error)) return false;
    if (!o->quiet) printf("written: %s\n", o->report.path);
    return true;
}

enum { PERCENT = 100 };

static bool show_progress(void *user, const char *stage, double fraction) {
    terminal_progress_update(user, (uint32_t)(fraction * PERCENT), PERCENT, stage);
    return !interrupted();
}

static bool print_and_save(const preprocess_options *o, const recording *r, const double *positions,
                           const recorded_stiffness *stiffness, const cscd_plan *plan, io_error *error) {
    if (!save_plan(o, r, positions, plan, error)) return false;
    if (!o->quiet) {
        print_plan(o->source.model_path, r->mesh, plan);
        if (stiffness->of_triangle != NULL)
            printf("stiffness: %g to %g, from %s\n", stiffness->least, stiffness->greatest, stiffness->path);
        printf("written: %s\n", o->output_path);
    }
    return save_report(o, r, positions, plan, error);
}

static bool explain_failure(const preprocess_options *o, const recording *r, cscd_status status,
                            io_error *error) {
    if (status == CSCD_CANCELLED)
        return io_fail(error, "%s: interrupted; no plan was written", o->source.model_path);
    if (status == CSCD_OUT_OF_MEMORY && o->plan.method == CSCD_METHOD_CHARGE)
        return io_fail(error, "%s: %s; or give %s, which needs little", o->source.model_path,
                       cscd_context_detail(r->context),
                       o->plan.charge_solver == CSCD_CHARGE_DENSE ? "--charge tree" : "--method kmeans:8");
    return io_fail(error, "%s: %s", o->source.model_path, cscd_context_detail(r->context));
}

static bool solves_dense(const preprocess_options *o) {
    if (o->plan.method == CSCD_METHOD_PUBLISHED && (o->plan.ours & CSCD_OURS_CHARGE) == 0) return true;
    const bool charges = o->plan.method == CSCD_METHOD_AUTO || method_facts_of(o->plan.method).by_charge;
    return charges && o->plan.charge_solver == CSCD_CHARGE_DENSE;
}

static bool make_plan(const preprocess_options *o, recording *r, const double *positions,
                      const motion_frames *motion, const recorded_stiffness *stiffness, io_error *error) {
    cscd_plan *plan = NULL;
    cscd_plan_options options = o->plan;
    if (solves_dense(o)) blas_kernels_prepare(!o->quiet);
    options.frames = motion->items;
    options.frame_count = motion->count;
    options.stiffness = stiffness->of_triangle;
    cscd_status status = cscd_plan_create(
        r->context, r->mesh, CSCD_DOUBLES(positions, cscd_mesh_vertex_count(r->mesh)), &options, &plan);
    terminal_progress_end(o->source.progress.user);
    if (status != CSCD_OK) return explain_failure(o, r, status, error);
    const bool saved = print_and_save(o, r, positions, stiffness, plan, error);
    cscd_plan_destroy(plan);
    return saved;
}

/* Reads the mesh at rest: of the model's file, which is the only frame unless there are others. */
static bool read_positions(const preprocess_options *o, recording *r, double *positions,
                           motion_frames *motion, io_error *error) {
    *motion = (motion_frames){0};
    if (o->source.frame_path_count == 0) return recording_read(r, 0, positions, error);
    recording_rest(r, positions);
    return read_motion_frames(r, &o->frames, motion, error);
}

/* Makes the plan, with the stiffness of the model's file where its method knows of one. */
static bool make_stiff_plan(const preprocess_options *o, recording *r, const double *positions,
                            const motion_frames *motion, io_error *error) {
    recorded_stiffness stiffness = {0};
    const bool counts = o->plan.method == CSCD_METHOD_CHARGE || o->plan.method == CSCD_METHOD_AUTO;
    if (counts && !recorded_stiffness_read(r, &stiffness, error)) return false;
    const bool made = make_plan(o, r, positions, motion, &stiffness, error);
    recorded_stiffness_free(&stiffness);
    return made;
}

static bool plan_recording(preprocess_options *o, recording *r, io_error *error) {
    double *positions = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    if (positions == NULL) return io_fail(error, "out of memory");
    motion_frames motion;
    bool made = read_positions(o, r, positions, &motion, error);
    if (made) {
        made = make_stiff_plan(o, r, positions, &motion, error);
        free_motion_frames(&motion);
    }
    free(positions);
    return made;
}

static int run_preprocess(preprocess_options *o) {
    recording r;
    io_error error = {""};
    terminal_progress shown;
    interrupt_catch();
    terminal_progress_begin(&shown, o->quiet);
    o->source.progress = (cscd_progress){show_progress, &shown};
    if (!recording_open(&o->source, &r, &error)) return fail_input("%s", error.text);
    if (!o->quiet) recording_warn(&r);
    const bool made = output_path_opens(o->output_path, &error) &&
                      output_path_opens(o->report.path, &error) && plan_recording(o, &r, &error);
    recording_close(&r);
    if (made) return EXIT_RAN;
    fail_input("%s", error.text);
    return interrupted() ? interrupt_exit_code() : EXIT_BAD_INPUT;
}

/* Options that count with some methods only. */
static int check_methods(const preprocess_options *o, const given_options *given) {
    static const struct {
        const char *name;
        cscd_method methods[3];
        const char *names;
    } bound[] = {
        {"seed", {CSCD_METHOD_KMEANS, CSCD_METHOD_AUTO, CSCD_METHOD_AUTO}, "kmeans:K or auto"},
        {"threshold",
         {CSCD_METHOD_CHARGE, CSCD_METHOD_AUTO, CSCD_METHOD_PUBLISHED},
         "charge, auto or published"},
        {"charge",
         {CSCD_METHOD_CHARGE, CSCD_METHOD_AUTO, CSCD_METHOD_PUBLISHED},
         "charge or auto, or with --ours charge"},
        {"growing", {CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED}, "published"},
        {"ours", {CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED}, "published"}};
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        bool counts = false;
        for (int k = 0; k < 3; k++) counts |= bound[i].methods[k] == o->plan.method;
        if (option_given(&table, given, bound[i].name) && !counts)
            return fail_usage("preprocess", "--%s counts with --method %s; leave it out", bound[i].name,
                              bound[i].names);
    }
    io_error error;
    if (!ours_agrees(o->plan.method, o->plan.ours, &error)) return fail_usage("preprocess", "%s", error.text);
    if (o->plan.method == CSCD_METHOD_PUBLISHED && (o->plan.ours & CSCD_OURS_CHARGE) == 0 &&
        option_given(&table, given, "charge"))
        return fail_usage("preprocess",
                          "--method published solves the dense system, unless --ours has charge");
    return EXIT_RAN;
}

/* Frames count for plans by charge alone, and published ones do without. */
static int check_frames(const preprocess_options *o, const given_options *given) {
    const bool counts = o->plan.method == CSCD_METHOD_CHARGE || o->plan.method == CSCD_METHOD_AUTO;
    if (given->input_count == 1 && option_given(&table, given, "frames"))
        return fail_usage("preprocess", "--frames chooses among FRAMES, and none are given");
    if (given->input_count > 1 && !counts)
        return fail_usage("preprocess", "FRAMES count with --method charge or auto; leave them out");
    return EXIT_RAN;
}

/* A plan may replace a plan, but no other file. */
static int check_output(const preprocess_options *o, const given_options *given) {
    const char *path = o->output_path;
    struct stat status;
    io_error error;
    if (!path_has_extension(path, ".ply"))
        return fail_usage("preprocess", "-o '%s': expected a name that ends in .ply", path);
    if (!output_path_differs(path, given->inputs, given->input_count, &error))
        return fail_usage("preprocess", "-o %s", error.text);
    if (stat(path, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0 && !plan_file_is_plan(path))
        return fail_usage("preprocess", "-o '%s' exists and is no plan; choose another name", path);
    if (!output_paths_are_safe(&table, o, given, &error)) return fail_usage("preprocess", "%s", error.text);
    return EXIT_RAN;
}

int command_preprocess(int argument_count, char **arguments) {
    preprocess_options options = {.frames = frame_range_all(),
                                  .plan = cscd_plan_defaults(),
                                  .argument_count = argument_count,
                                  .arguments = arguments};
    given_options given;
    int code;
    if (!option_table_read(&table, argument_count, arguments, &options, &given, &code)) return code;
    if (given.input_count == 0) return fail_usage("preprocess", "expected MODEL");
    recording_options_take(&options.source, &given);
    char *model_plan = NULL;
    if (options.output_path == NULL) options.output_path = model_plan = plan_path_of_model(given.inputs[0]);
    if (options.output_path == NULL)
        code = fail_input("out of memory");
    else
        code = check_methods(&options, &given);
    if (code == EXIT_RAN) code = check_frames(&options, &given);
    if (code == EXIT_RAN) code = check_output(&options, &given);
    if (code == EXIT_RAN) code = run_preprocess(&options);
    free(model_plan);
    return code;
}
