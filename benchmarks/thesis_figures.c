/* The steps of the published cuts as plans that any viewer shows, and cscd render draws: figures 3.2, 3.4, 6.1 to 6.3 and 7.1 of the
 * thesis (Yeh 2012), of our recordings at rest. */
#include "benchmarks/lib/scene_files.h"
#include "cscd/research.h"
#include "models/shapes/catalogue.h"
#include "preprocess/baselines/baselines.h"
#include "tool/io/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

/* A mesh at rest, its published plan, and what the steps of its cuts have left. */
typedef struct figure {
    const char *folder, *name;
    const cscd_mesh *mesh;
    const double *positions;
    cscd_plan *plan;
    double *charges, *capacitances, *equalized;
    uint32_t *clusters, *regions;
    bool *cutting, *contours;
    uint8_t *colours;
} figure;

/* Writes folder/name-kind.plan.ply. charges NULL: a plan of regions alone. Regions are numbered again,
 * without gaps. */
static bool write_plan(const figure *f, const char *kind, const double *charges, const uint32_t *labels,
                       io_error *error) {
    const uint32_t count = f->mesh->triangle_count;
    uint32_t *numbers = calloc(count + 1, sizeof *numbers), *regions = calloc(count, sizeof *regions),
             used = 0;
    double *points = calloc((size_t)count * 3, sizeof *points);
    char path[PATH_LENGTH];
    cscd_plan *plan = NULL;
    bool good = numbers != NULL && regions != NULL && points != NULL;
    for (uint32_t t = 0; good && t < count; t++) {
        const uint32_t label = labels[t] < count ? labels[t] + 1 : 0;
        if (numbers[label] == 0) numbers[label] = ++used;
        regions[t] = numbers[label] - 1;
        for (int k = 0; k < 3; k++)
            points[regions[t] * 3 + (uint32_t)k] = f->positions[f->mesh->triangles[t][0] * 3 + (uint32_t)k];
    }
    const cscd_plan_parts parts = {.method = charges != NULL ? CSCD_METHOD_CHARGE : CSCD_METHOD_SINGLE,
                                   .region_count = used,
                                   .triangle_regions = regions,
                                   .detector_points = points,
                                   .charges = charges,
                                   .capacitances = charges != NULL ? f->capacitances : NULL};
    good = good && cscd_plan_create_from_parts(f->mesh->context, f->mesh,
                                               CSCD_DOUBLES(f->positions, f->mesh->vertex_count), &parts,
                                               &plan) == CSCD_OK;
    snprintf(path, sizeof path, "%s/%s-%s.plan.ply", f->folder, f->name, kind);
    if (!good) io_fail(error, "%s: %s", path, cscd_context_detail(f->mesh->context));
    good = good && plan_file_write(path, f->mesh, f->positions, plan, f->colours, error);
    cscd_plan_destroy(plan);
    free(numbers);
    free(regions);
    free(points);
    return good;
}

static bool allocate_figure(figure *f) {
    const size_t n = f->mesh->triangle_count;
    f->charges = calloc(n, sizeof *f->charges);
    f->capacitances = calloc(f->mesh->component_count, sizeof *f->capacitances);
    f->equalized = calloc(n, sizeof *f->equalized);
    f->clusters = calloc(n, sizeof *f->clusters);
    f->regions = calloc(n, sizeof *f->regions);
    f->cutting = calloc(n, sizeof *f->cutting);
    f->contours = calloc(f->mesh->edge_count, sizeof *f->contours);
    f->colours = calloc(n, 3);
    return f->charges != NULL && f->capacitances != NULL && f->equalized != NULL && f->clusters != NULL &&
           f->regions != NULL && f->cutting != NULL && f->contours != NULL && f->colours != NULL;
}

static void free_figure(figure *f) {
    void *const blocks[] = {f->charges, f->capacitances, f->equalized, f->clusters,
                            f->regions, f->cutting,      f->contours,  f->colours};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) free(blocks[i]);
    cscd_plan_destroy(f->plan);
}

/* Figure 3.4 b to f: density, equalized density, clusters, the cutting triangles along the contours,
 * regions. */
static bool write_steps(figure *f, io_error *error) {
    const published_trace trace = {f->clusters, f->cutting, f->contours};
    uint32_t count = 0;
    for (uint32_t t = 0; t < f->mesh->triangle_count; t++)
        f->charges[t] = cscd_plan_triangle_charge(f->plan, t);
    for (uint32_t c = 0; c < f->mesh->component_count; c++)
        f->capacitances[c] = cscd_plan_capacitance(f->plan, c);
    const cscd_plan_options usual = cscd_plan_defaults();
    const published_thresholds thresholds = {usual.threshold, usual.growing};
    if (published_equalize(f->mesh, f->charges, f->equalized) != CSCD_OK ||
        published_cuts(f->mesh, f->positions, f->equalized, thresholds, &trace, f->regions, &count) !=
            CSCD_OK)
        return io_fail(error, "%s: %s", f->name, cscd_context_detail(f->mesh->context));
    uint32_t *bands = calloc(f->mesh->triangle_count, sizeof *bands),
             *whole = calloc(f->mesh->triangle_count, sizeof *whole);
    bool good = bands != NULL && whole != NULL;
    for (uint32_t t = 0; good && t < f->mesh->triangle_count; t++) {
        bool beside = false;
        for (int k = 0; k < 3; k++) beside |= f->contours[f->mesh->triangle_edges[t][k]];
        bands[t] = f->cutting[t] ? 1 : beside ? 2 : 0;
    }
    good = good && write_plan(f, "3.4b-density", f->charges, whole, error) &&
           write_plan(f, "3.4c-density", f->equalized, whole, error) &&
           write_plan(f, "3.4d-clusters", NULL, f->clusters, error) &&
           write_plan(f, "3.4e-contours", NULL, bands, error) &&
           write_plan(f, "3.4f-regions", NULL, f->regions, error);
    free(bands);
    free(whole);
    return good;
}

/* Figures 6.1 to 6.3: as many regions as the published cuts, and one more, from two seeds each. */
static bool write_kmeans(figure *f, io_error *error) {
    for (uint32_t i = 0; i < 4; i++) {
        cscd_plan_options options = cscd_plan_defaults();
        cscd_plan *plan = NULL;
        char kind[48];
        options.method = CSCD_METHOD_KMEANS;
        options.k = cscd_plan_region_count(f->plan) + i / 2;
        options.seed = 1 + i % 2;
        if (cscd_plan_create(f->mesh->context, f->mesh, CSCD_DOUBLES(f->positions, f->mesh->vertex_count),
                             &options, &plan) != CSCD_OK)
            return io_fail(error, "%s: %s", f->name, cscd_context_detail(f->mesh->context));
        for (uint32_t t = 0; t < f->mesh->triangle_count; t++)
            f->regions[t] = cscd_plan_triangle_region(plan, t);
        cscd_plan_destroy(plan);
        snprintf(kind, sizeof kind, "6-kmeans%u-seed%u", options.k, options.seed);
        if (!write_plan(f, kind, NULL, f->regions, error)) return false;
    }
    return true;
}

static bool write_figures(const char *folder, const char *name, const cscd_mesh *mesh,
                          const double *positions, io_error *error) {
    figure f = {.folder = folder, .name = name, .mesh = mesh, .positions = positions};
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_PUBLISHED;
    bool good = allocate_figure(&f) || io_fail(error, "out of memory");
    if (good && cscd_plan_create(mesh->context, mesh, CSCD_DOUBLES(positions, mesh->vertex_count), &options,
                                 &f.plan) != CSCD_OK)
        good = io_fail(error, "%s: %s", name, cscd_context_detail(mesh->context));
    good = good && write_steps(&f, error) && write_kmeans(&f, error);
    free_figure(&f);
    return good;
}

static bool draw_torus(const char *folder, io_error *error) {
    body torus;
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    if (!body_make(BODY_TORUS, 3000, &torus, error)) return false;
    const cscd_object_desc desc =
        cscd_object_of_triangles(torus.vertex_count, torus.triangle_count, torus.triangles);
    bool good = cscd_context_create(NULL, &context) == CSCD_OK &&
                cscd_mesh_create(context, &desc, 1, &mesh) == CSCD_OK;
    good =
        good ? write_figures(folder, "torus", mesh, torus.positions, error) : io_fail(error, "out of memory");
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    body_free(&torus);
    return good;
}

static bool draw_recording(const char *folder, const char *name, io_error *error) {
    recording_data r;
    if (!recording_data_open("build/models", name, 1, &r, error)) return false;
    const bool good = write_figures(folder, name, r.mesh, r.model.positions, error);
    recording_data_close(&r);
    return good;
}

int main(int argument_count, char **arguments) {
    static const char *const names[] = {"pawn-drop", "dumbbell-stairs", "figure-balls"};
    io_error error;
    if (argument_count != 2) {
        fprintf(
            stderr,
            "usage: thesis_figures FOLDER\n\nWrites the steps of the published cuts as plans: NAME-3.4b-density.plan.ply "
            "and so on.\n");
        return 2;
    }
    bool good = draw_torus(arguments[1], &error);
    for (int i = 0; good && i < 3; i++) good = draw_recording(arguments[1], names[i], &error);
    if (good) return 0;
    fprintf(stderr, "thesis_figures: %s\n", error.text);
    return 1;
}
