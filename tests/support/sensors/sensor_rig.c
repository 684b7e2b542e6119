/* A context, a mesh, a plan and sensors for a scene; any failure to make them fails the test. */
#include "tests/support/sensors/sensor_rig.h"
#include "sensors/sensors.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <assert.h>
#include <math.h>

/* NULL goes on as NULL. */
static const cscd_view *view_of_packed(const cscd_mesh *mesh, const double *positions, cscd_view *view) {
    if (positions == NULL || mesh == NULL) return NULL;
    *view = cscd_view_doubles(positions, mesh->vertex_count);
    return view;
}

cscd_status sensors_create_packed(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                                  const cscd_sensor_options *options, cscd_sensors **out) {
    cscd_view x;
    cscd_context *context = mesh != NULL ? mesh->context : NULL;
    return cscd_sensors_create(context, mesh, plan, view_of_packed(mesh, positions, &x), options, out);
}

cscd_status sensors_renew_packed(cscd_sensors *sensors, const double *positions, uint32_t part) {
    cscd_view x;
    const cscd_mesh *mesh = sensors != NULL ? sensors->mesh : NULL;
    return cscd_sensors_renew(sensors, view_of_packed(mesh, positions, &x), part);
}

cscd_status sensors_step_packed(cscd_sensors *sensors, const double *x0, const double *x1,
                                cscd_warnings *out) {
    const cscd_mesh *mesh = sensors != NULL ? sensors->mesh : NULL;
    cscd_view from, to;
    return cscd_sensors_step(sensors, view_of_packed(mesh, x0, &from), view_of_packed(mesh, x1, &to), out);
}

sensor_rig sensor_rig_create(const scene *s, const sensor_setup *setup) {
    static const sensor_setup defaults = {0, NULL};
    if (setup == NULL) setup = &defaults;
    sensor_rig r = {NULL, NULL, NULL, NULL};
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_context_create(NULL, &r.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    if (setup->regions > 0) {
        cscd_plan_options options = cscd_plan_defaults();
        options.method = CSCD_METHOD_KMEANS;
        options.k = setup->regions;
        assert_int_equal(plan_create_packed(r.mesh, s->x0, &options, &r.plan), CSCD_OK);
    }
    assert_int_equal(sensors_create_packed(r.mesh, r.plan, s->x0, setup->sensors, &r.sensors), CSCD_OK);
    return r;
}

void sensor_rig_destroy(sensor_rig *r) {
    cscd_sensors_destroy(r->sensors);
    cscd_plan_destroy(r->plan);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_warnings sensor_rig_step(const sensor_rig *r, const double *start, const double *end) {
    cscd_warnings found;
    assert_int_equal(sensors_step_packed(r->sensors, start, end, &found), CSCD_OK);
    return found;
}

static bool of_objects(const cscd_warning *w, uint32_t a, uint32_t b) {
    return (w->object_a == a && w->object_b == b) || (w->object_a == b && w->object_b == a);
}

const cscd_warning *find_warning(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b) {
    for (size_t i = 0; i < warnings->count; i++)
        if (of_objects(&warnings->items[i], object_a, object_b)) return &warnings->items[i];
    return NULL;
}

const cscd_warning *find_contact(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b) {
    const cscd_warning *first = NULL;
    for (size_t i = 0; i < warnings->count; i++) {
        const cscd_warning *w = &warnings->items[i];
        if (!w->contact || !of_objects(w, object_a, object_b)) continue;
        if (first == NULL || w->toi < first->toi) first = w;
    }
    return first;
}

/* ---- tubes -----------------------------------------------------------------------------------------------
 */

static uint32_t add_vertex(scene *s, double x, double y, double z) {
    assert(s->vertex_count < SCENE_VERTICES_MAX);
    double p[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        s->x0[s->vertex_count * 3 + (uint32_t)k] = s->x1[s->vertex_count * 3 + (uint32_t)k] = p[k];
    return s->vertex_count++;
}

static void add_triangle(scene *s, uint32_t a, uint32_t b, uint32_t c) {
    assert(s->triangle_count < SCENE_TRIANGLES_MAX);
    uint32_t *t = s->triangles + (size_t)s->triangle_count++ * 3;
    t[0] = a, t[1] = b, t[2] = c;
}

/* Computes the unit normal of the path at point i, within the path's plane. */
static void across_path(const double (*path)[3], int count, int i, double normal[2]) {
    int before = i > 0 ? i - 1 : i, after = i < count - 1 ? i + 1 : i;
    double x = path[after][0] - path[before][0], y = path[after][1] - path[before][1];
    double length = sqrt(x * x + y * y);
    normal[0] = -y / length;
    normal[1] = x / length;
}

void scene_add_tube(scene *s, const double (*path)[3], int count, double radius, int segments) {
    uint32_t n = (uint32_t)segments, rings = (uint32_t)count, first = s->vertex_count;
    for (int i = 0; i < count; i++) {
        double normal[2];
        across_path(path, count, i, normal);
        for (uint32_t j = 0; j < n; j++) {
            double angle = 2.0 * 3.14159265358979 * j / n, out = radius * cos(angle);
            add_vertex(s, path[i][0] + out * normal[0], path[i][1] + out * normal[1],
                       path[i][2] + radius * sin(angle));
        }
    }
    for (uint32_t i = 0; i + 1 < rings; i++) {
        for (uint32_t j = 0; j < n; j++) {
            uint32_t a = first + i * n + j, b = first + i * n + (j + 1) % n;
            add_triangle(s, a, b, b + n);
            add_triangle(s, a, b + n, a + n);
        }
    }
    uint32_t begin = add_vertex(s, path[0][0], path[0][1], path[0][2]), last = rings - 1;
    uint32_t end = add_vertex(s, path[last][0], path[last][1], path[last][2]);
    for (uint32_t j = 0; j < n; j++) {
        add_triangle(s, begin, first + (j + 1) % n, first + j);
        add_triangle(s, end, first + last * n + j, first + last * n + (j + 1) % n);
    }
}

void scene_add_bent_tube(scene *s, const double (*corners)[3], int count, double radius, double step) {
    double path[256][3];
    int points = 0;
    for (int c = 0; c + 1 < count; c++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = corners[c + 1][k] - corners[c][k];
        int steps = (int)ceil(sqrt(d[0] * d[0] + d[1] * d[1]) / step);
        for (int i = c > 0; i <= steps; i++, points++) {
            assert(points < 256);
            for (int k = 0; k < 3; k++) path[points][k] = corners[c][k] + d[k] * i / steps;
        }
    }
    scene_add_tube(s, (const double(*)[3])path, points, radius, 8);
}

void shift_vertices(uint32_t first, uint32_t end, const double by[3], double *x) {
    for (uint32_t v = first; v < end; v++)
        for (uint32_t k = 0; k < 3; k++) x[v * 3 + k] += by[k];
}
