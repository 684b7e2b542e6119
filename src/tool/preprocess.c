/* `cscd preprocess`: makes the plan of a mesh, prints what it found and saves it. */
#include "cscd/research.h"
#include "src/io/path_name.h"
#include "src/io/plan_file.h"
#include "src/tool/common/blas_kernels.h"
#include "src/tool/common/command.h"
#include "src/tool/common/methods.h"
#include "src/tool/common/motion_frames.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/plan_colours.h"
#include "src/tool/common/plan_source.h"
#include "src/tool/common/shared_options.h"
#include "src/tool/common/terminal.h"
#include "src/tool/plan_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LINES_MAX = 50 };

typedef struct preprocess_options {
    recording_options source;
    frame_range frames;
    cscd_plan_options plan;
    bool published;
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

static bool read_charge_solver(const char *text, void *place) {
    static const char *const names[] = {"tree", "dense", "coarse"};
    cscd_charge_solver *solver = place;
    for (*solver = CSCD_CHARGE_TREE; *solver <= CSCD_CHARGE_COARSE; ++*solver)
        if (strcmp(text, names[*solver]) == 0) return true;
    return false;
}

static const option_row rows[] = {
    {"o", "PLAN.ply", read_text, offsetof(preprocess_options, output_path),
     "default: MODEL with .plan.ply for its ending, where replay looks for it"},
    {"output", "PLAN.ply", read_text, offsetof(preprocess_options, output_path), NULL},
    {"report", "OUT.html", read_text, offsetof(preprocess_options, report.path),
     "also write a page that shows charge, regions and detector points in any browser"},
    {"up", "y|z", read_up, offsetof(preprocess_options, report.up),
     "of the report: which axis points up (default: y of OBJ and glTF, else z)"},
    {"method", "charge", read_plan_method, offsetof(preprocess_options, plan),
     "cut where little charge gathers on the mesh as a conductor (default)"},
    {"method", "kmeans:K", .help = "K regions by distance"},
    {"method", "single", .help = "one region per component"},
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
     .help = "by a dense matrix, to compare: 4 bytes for each pair of triangles of a component, "
             "and time with the cube of their number"},
    {"published", NULL, read_flag, offsetof(preprocess_options, published),
     "with charge: cut by the published rules, where clusters of low charge grow until they part a body"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(preprocess_options, frames),
     "of FRAMES, only those from A to B, both included (A: and :B are open ends)"},
    {"quiet", NULL, read_flag, offsetof(preprocess_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

static const option_table table = {
    "preprocess",
    "MODEL [FRAMES...] [-o PLAN.ply] [options]",
    "Cuts the mesh MODEL (OBJ, PLY, OFF, STL, glTF, GIFTI), at rest as in the file, into regions, each with a point that sees "
    "most of it, and saves this plan as a PLY that any viewer shows. cscd replay uses it to leave out pairs "
    "of triangles that cannot touch; it needs the same --weld. Contacts are the same with any plan and with none.\n"
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

static double total_area(const cscd_plan *plan) {
    double area = 0.0;
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) area += cscd_plan_region(plan, i).area;
    return area;
}

static double percent_of(double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
}

static bool is_kept(const cscd_plan *plan, const cscd_compared_plan *c) {
    return c->failure == NULL && c->method == cscd_plan_method(plan) &&
           c->region_count == cscd_plan_region_count(plan);
}

static void print_components(const cscd_mesh *mesh, const cscd_plan *plan) {
    uint32_t count = cscd_mesh_component_count(mesh);
    for (uint32_t i = 0; i < count && i < LINES_MAX; i++)
        printf("component %u: %u triangles, capacitance %.6g\n", i,
               cscd_mesh_component(mesh, i).triangle_count, cscd_plan_capacitance(plan, i));
    if (count > LINES_MAX) printf("and %u more components\n", count - LINES_MAX);
}

static void print_regions(const cscd_plan *plan) {
    uint32_t count = cscd_plan_region_count(plan);
    double whole = total_area(plan), seen = 0.0;
    printf("%u region%s by method %s\n", count, count == 1 ? "" : "s",
           cscd_method_name(cscd_plan_method(plan)));
    printf("%6s %9s %9s %13s %16s   detector point\n", "region", "component", "triangles", "share of area",
           "its point sees");
    for (uint32_t i = 0; i < count; i++) {
        cscd_region r = cscd_plan_region(plan, i);
        const double *p = r.detector_point;
        seen += r.visible_share * r.area;
        if (i < LINES_MAX)
            printf("%6u %9u %9u %11.1f %% %14.1f %%   (%.6g, %.6g, %.6g)\n", i, r.component, r.triangle_count,
                   percent_of(r.area, whole), 100.0 * r.visible_share, p[0], p[1], p[2]);
    }
    if (count > LINES_MAX) printf("and %u more regions\n", count - LINES_MAX);
    printf("seen in all: %.1f %% of the area\n", percent_of(seen, whole));
}

/* What method auto has compared, the best first to be read. */
static void print_compared(const cscd_plan *plan) {
    const uint32_t count = cscd_plan_compared_count(plan);
    if (count == 0) return;
    printf("%-10s %8s %30s\n", "method", "regions", "triangles left to test");
    for (uint32_t i = 0; i < count; i++) {
        const cscd_compared_plan c = cscd_plan_compared(plan, i);
        char name[24];
        snprintf(name, sizeof name, c.k > 0 ? "%s:%u" : "%s", cscd_method_name(c.method), c.k);
        if (c.failure != NULL)
            printf("%-10s %s\n", name, c.failure);
        else
            printf("%-10s %8u %28.1f %%%s\n", name, c.region_count, 100.0 * c.tested_share,
                   is_kept(plan, &c) ? "   kept" : "");
    }
}

static void print_plan(const preprocess_options *o, const recording *r, const cscd_plan *plan) {
    cscd_preprocess_timings t = cscd_plan_timings(plan);
    uint32_t components = cscd_mesh_component_count(r->mesh);
    printf("%s: %u vertices, %u triangles, %u component%s\n", o->source.model_path,
           cscd_mesh_vertex_count(r->mesh), cscd_mesh_triangle_count(r->mesh), components,
           components == 1 ? "" : "s");
    if (cscd_plan_method(plan) == CSCD_METHOD_CHARGE) print_components(r->mesh, plan);
    print_compared(plan);
    print_regions(plan);
    printf("seconds: assembly %.3f, solve %.3f, regions %.3f, total %.3f\n", t.assembly_ms * 1e-3,
           t.solve_ms * 1e-3, t.regions_ms * 1e-3, t.total_ms * 1e-3);
}

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
    if (!plan_report_write(&shown, error)) return false;
    if (!o->quiet) printf("written: %s\n", o->report.path);
    return true;
}

enum { PERCENT = 100 };

static bool show_progress(void *user, const char *stage, double fraction) {
    terminal_progress_update(user, (uint32_t)(fraction * PERCENT), PERCENT, stage);
    return !interrupted();
}

static bool print_and_save(const preprocess_options *o, const recording *r, const double *positions,
                           const cscd_plan *plan, io_error *error) {
    if (!save_plan(o, r, positions, plan, error)) return false;
    if (!o->quiet) {
        print_plan(o, r, plan);
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

static bool make_plan(const preprocess_options *o, recording *r, const double *positions,
                      const motion_frames *motion, io_error *error) {
    cscd_plan *plan = NULL;
    cscd_plan_options options = o->plan;
    if (options.method == CSCD_METHOD_CHARGE && options.charge_solver == CSCD_CHARGE_DENSE)
        blas_kernels_prepare(!o->quiet);
    options.variant = o->published ? CSCD_PLAN_VARIANT_PUBLISHED : 0;
    options.frames = motion->items;
    options.frame_count = motion->count;
    cscd_status status = cscd_plan_create(
        r->context, r->mesh, CSCD_DOUBLES(positions, cscd_mesh_vertex_count(r->mesh)), &options, &plan);
    terminal_progress_end(o->source.progress.user);
    if (status != CSCD_OK) return explain_failure(o, r, status, error);
    const bool saved = print_and_save(o, r, positions, plan, error);
    cscd_plan_destroy(plan);
    return saved;
}

/* Reads the mesh at rest: of the model's file, which is the only frame unless there are others. */
static bool read_positions(const preprocess_options *o, recording *r, double *positions,
                           motion_frames *motion, io_error *error) {
    *motion = (motion_frames){0};
    if (o->source.frame_path_count == 0) return recording_read(r, 0, positions, error);
    recording_rest(r, positions);
    return motion_frames_read(r, &o->frames, motion, error);
}

static bool plan_recording(const preprocess_options *o, recording *r, io_error *error) {
    double *positions = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    if (positions == NULL) return io_fail(error, "out of memory");
    motion_frames motion;
    bool made = read_positions(o, r, positions, &motion, error);
    if (made) {
        made = make_plan(o, r, positions, &motion, error);
        motion_frames_free(&motion);
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
    const char *others[] = {o->source.model_path, path};
    if (!report_request_is_safe(&o->report, others, 2, &error))
        return fail_usage("preprocess", "%s", error.text);
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
        code = check_output(&options, &given);
    if (code == EXIT_RAN) code = run_preprocess(&options);
    free(model_plan);
    return code;
}
