/* Prints what preprocessing has found. */
#include "tool/preprocess/plan_print.h"
#include "tool/common/methods.h"

#include <stdio.h>

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

/* What method auto has compared. */
static void print_compared(const cscd_plan *plan) {
    const uint32_t count = cscd_plan_compared_count(plan);
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

void plan_print(const char *model_path, const cscd_mesh *mesh, const cscd_plan *plan) {
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
