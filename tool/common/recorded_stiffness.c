/* How stiff the material of a recording is. */
#include "tool/common/recorded_stiffness.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const recorded_object *find_stiff(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.stiffness != NULL) return &r->objects[i];
    return NULL;
}

static bool read_triangle(const recording *r, uint32_t t, recorded_stiffness *s, io_error *error) {
    const recorded_object *object = &r->objects[recording_object_of_triangle(r, t)];
    s->of_triangle[t] = 1.0;
    if (object->file.stiffness == NULL) return true;
    const double value = object->file.stiffness[recording_file_triangle(r, t)];
    if (!(value > 0.0 && value <= DBL_MAX))
        return io_fail(error, "%s: the stiffness of face %u is %g, expected a positive finite number",
                       object->source.model_path, recording_file_face(r, t), value);
    s->of_triangle[t] = value;
    s->least = fmin(s->least, value);
    s->greatest = fmax(s->greatest, value);
    return true;
}

bool recorded_stiffness_read(const recording *r, recorded_stiffness *out, io_error *error) {
    const uint32_t count = cscd_mesh_triangle_count(r->mesh);
    const recorded_object *first = find_stiff(r);
    recorded_stiffness s = {.least = INFINITY};
    *out = (recorded_stiffness){0};
    if (first == NULL) return true;
    s.path = first->source.model_path;
    s.of_triangle = malloc(((size_t)count + 1) * sizeof *s.of_triangle);
    bool read = s.of_triangle != NULL || io_fail(error, "out of memory");
    for (uint32_t t = 0; t < count && read; t++) read = read_triangle(r, t, &s, error);
    if (read)
        *out = s;
    else
        free(s.of_triangle);
    return read;
}

void recorded_stiffness_free(recorded_stiffness *s) {
    free(s->of_triangle);
    *s = (recorded_stiffness){0};
}
