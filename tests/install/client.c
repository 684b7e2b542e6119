/* A program that uses the installed library, in C99: two tetrahedra, one of which flies into the other. */
#include <cscd/cscd.h>

#include <stdio.h>

enum { VERTEX_COUNT = 8, TRIANGLE_COUNT = 8 };

static const uint32_t triangles[TRIANGLE_COUNT * 3] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3,
                                                       4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
static const double start[VERTEX_COUNT * 3] = {0, 0, 0,  4, 0, 0,  0, 4, 0,  0, 0, 4,
                                               1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};

/* Makes regions, which needs the linear algebra libraries, and prints the contacts of one step. */
static cscd_status print_contacts(cscd_context *context) {
    double end[VERTEX_COUNT * 3];
    const cscd_object_desc object = cscd_object_of_triangles(VERTEX_COUNT, TRIANGLE_COUNT, triangles);
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts contacts = {.count = 0};
    for (int i = 0; i < VERTEX_COUNT * 3; i++) end[i] = start[i] + (i >= 12 && i % 3 == 2 ? 1.5 : 0.0);
    cscd_status status = cscd_mesh_create(context, &object, 1, &mesh);
    if (status == CSCD_OK)
        status = cscd_plan_create(context, mesh, CSCD_DOUBLES(start, VERTEX_COUNT), NULL, &plan);
    if (status == CSCD_OK) status = cscd_detector_create(context, mesh, plan, NULL, &detector);
    if (status == CSCD_OK)
        status = cscd_detector_step(detector, CSCD_DOUBLES(start, VERTEX_COUNT),
                                    CSCD_DOUBLES(end, VERTEX_COUNT), &contacts);
    for (size_t i = 0; i < contacts.count; i++) {
        const cscd_contact *contact = &contacts.items[i];
        printf("%s %u %u at t = %.3f\n", cscd_contact_kind_name(contact->kind), contact->a, contact->b,
               contact->toi);
    }
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    return status;
}

int main(void) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 2;
    printf("cscd %s\n", cscd_version_string());
    cscd_status status = cscd_context_create(&options, &context);
    if (status == CSCD_OK) status = print_contacts(context);
    if (status != CSCD_OK)
        fprintf(stderr, "%s: %s\n", cscd_status_string(status), cscd_context_detail(context));
    cscd_context_destroy(context);
    return status == CSCD_OK ? 0 : 1;
}
