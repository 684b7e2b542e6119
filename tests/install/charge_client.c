/* A program that makes plans, in C99: by charge, solved densely and by a tree, and from the parts of such a plan. */
#include <cscd/cscd.h>

#include <stdio.h>

static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
static const double corners[12] = {0, 0, 0, 4, 0, 0, 0, 3, 0, 0, 0, 2};

static void print_plan(const char *name, cscd_context *context, cscd_status status, cscd_plan *plan) {
    if (status == CSCD_OK)
        printf("%s: charge %a\n", name, cscd_plan_triangle_charge(plan, 0));
    else
        printf("%s: %s: %s\n", name, cscd_status_string(status), cscd_context_detail(context));
    cscd_plan_destroy(plan);
}

int main(void) {
    const cscd_object_desc object = cscd_object_of_triangles(4, 4, triangles);
    const uint32_t regions[4] = {0, 0, 0, 0};
    const double point[3] = {0.5, 0.5, 0.5}, charges[4] = {1, 2, 3, 4}, capacitance = 5;
    const cscd_plan_parts parts = {CSCD_METHOD_CHARGE, 1, regions, point, charges, &capacitance, NULL};
    cscd_plan_options options = cscd_plan_defaults();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK ||
        cscd_mesh_create(context, &object, 1, &mesh) != CSCD_OK)
        return 1;
    options.charge_solver = CSCD_CHARGE_DENSE;
    cscd_status status = cscd_plan_create(context, mesh, CSCD_DOUBLES(corners, 4), &options, &plan);
    print_plan("solved", context, status, plan);
    plan = NULL;
    status = cscd_plan_create_from_parts(context, mesh, CSCD_DOUBLES(corners, 4), &parts, &plan);
    print_plan("from parts", context, status, plan);
    plan = NULL;
    options.charge_solver = CSCD_CHARGE_TREE;
    status = cscd_plan_create(context, mesh, CSCD_DOUBLES(corners, 4), &options, &plan);
    print_plan("by a tree", context, status, plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return 0;
}
