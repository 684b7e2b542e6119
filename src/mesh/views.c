/* Views of positions: from a caller's layout to packed doubles, and back. */
#include "src/mesh/views.h"

#include <string.h>

/* What both kinds of views have in common; the defaults are filled in. */
typedef struct layout {
    const char *data;
    size_t size, stride, coordinate_stride, scalar_size;
    uint32_t first_object, end_object, first_vertex, vertex_count; /* whose vertices it holds */
} layout;

/* Both kinds have the same members in the same places, so that one can be read as the other. */
_Static_assert(sizeof(cscd_view) == sizeof(cscd_mutable_view), "views differ in const only");

static cscd_view as_view(const cscd_mutable_view *view) {
    return (cscd_view){view->data,   view->size,        view->stride, view->coordinate_stride,
                       view->scalar, view->object_count};
}

static size_t scalar_size_of(cscd_scalar scalar) {
    return scalar == CSCD_SCALAR_FLOAT ? sizeof(float) : sizeof(double);
}

/* Describes a view that begins with this object. The caller has checked that there is such an object. */
static layout layout_of(const cscd_mesh *mesh, const cscd_view *view, uint32_t first_object) {
    uint32_t left = mesh->object_count - first_object;
    uint32_t objects = view->object_count == 0 || view->object_count > left ? left : view->object_count;
    const cscd_object *first = &mesh->objects[first_object],
                      *last = &mesh->objects[first_object + objects - 1];
    size_t scalar_size = scalar_size_of(view->scalar);
    return (layout){.data = view->data,
                    .size = view->size,
                    .stride = view->stride != 0 ? view->stride : 3 * scalar_size,
                    .coordinate_stride = view->coordinate_stride != 0 ? view->coordinate_stride : scalar_size,
                    .scalar_size = scalar_size,
                    .first_object = first_object,
                    .end_object = first_object + objects,
                    .first_vertex = first->first_vertex,
                    .vertex_count = last->first_vertex + last->vertex_count - first->first_vertex};
}

/* Computes the bytes from the first coordinate to the end of the last one; false if they overflow. */
static bool find_extent(const layout *l, size_t *out) {
    size_t last = l->vertex_count - 1, places, coordinates;
    return !__builtin_mul_overflow(last, l->stride, &places) &&
           !__builtin_mul_overflow((size_t)2, l->coordinate_stride, &coordinates) &&
           !__builtin_add_overflow(places, coordinates, out) &&
           !__builtin_add_overflow(*out, l->scalar_size, out);
}

static cscd_status check_view(cscd_context *context, const cscd_mesh *mesh, const cscd_view *view,
                              uint32_t place, uint32_t first_object, const char *name) {
    if (view->data == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s[%u].data is NULL", name, place);
    if ((unsigned)view->scalar > CSCD_SCALAR_FLOAT)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%u].scalar is %d, expected CSCD_SCALAR_DOUBLE or CSCD_SCALAR_FLOAT", name,
                            place, (int)view->scalar);
    uint32_t left = mesh->object_count - first_object;
    if (view->object_count > left)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%u] is to hold %u objects, but only %u of the mesh are left for it", name,
                            place, view->object_count, left);
    layout l = layout_of(mesh, view, first_object);
    size_t extent;
    if (!find_extent(&l, &extent) || extent > l.size)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%u] has %zu bytes, which end before vertex %u of %u (stride %zu, %zu bytes a "
                            "coordinate): the array is too short, or its size is in another unit than bytes",
                            name, place, l.size, l.vertex_count - 1, l.vertex_count, l.stride, l.scalar_size);
    return CSCD_OK;
}

static cscd_status check_views(cscd_context *context, const cscd_mesh *mesh, const cscd_view *views,
                               const char *name) {
    if (views == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    for (uint32_t object = 0, place = 0; object < mesh->object_count; place++) {
        cscd_status status = check_view(context, mesh, &views[place], place, object, name);
        if (status != CSCD_OK) return status;
        object = layout_of(mesh, &views[place], object).end_object;
    }
    return CSCD_OK;
}

/* ---- reading ------------------------------------------------------------------------------------------- */

static double load_scalar(const char *at, bool is_float) {
    if (is_float) {
        float value;
        memcpy(&value, at, sizeof value);
        return (double)value;
    }
    double value;
    memcpy(&value, at, sizeof value);
    return value;
}

static void unpack_view(const layout *l, double *out) {
    const char *at = l->data;
    bool is_float = l->scalar_size == sizeof(float);
    for (uint32_t v = 0; v < l->vertex_count; v++, at += l->stride) {
        for (size_t k = 0; k < 3; k++) *out++ = load_scalar(at + k * l->coordinate_stride, is_float);
    }
}

static bool is_packed(const layout *l) {
    return l->scalar_size == sizeof(double) && l->stride == sizeof(double[3]) &&
           l->coordinate_stride == sizeof(double) && (uintptr_t)l->data % sizeof(double) == 0;
}

cscd_status views_read(cscd_context *context, const cscd_mesh *mesh, const cscd_view *views, const char *name,
                       double **buffer, const double **out) {
    cscd_status status = check_views(context, mesh, views, name);
    if (status != CSCD_OK) return status;
    layout first = layout_of(mesh, views, 0);
    if (first.vertex_count == mesh->vertex_count && is_packed(&first)) {
        *out = views->data;
        return CSCD_OK;
    }
    if (*buffer == NULL) *buffer = context_allocate(context, mesh->vertex_count, sizeof(double[3]));
    if (*buffer == NULL) return context_out_of_memory(context);
    for (uint32_t object = 0; object < mesh->object_count; views++) {
        layout l = layout_of(mesh, views, object);
        unpack_view(&l, *buffer + (size_t)l.first_vertex * 3);
        object = l.end_object;
    }
    *out = *buffer;
    return CSCD_OK;
}

/* ---- writing ------------------------------------------------------------------------------------------- */

cscd_status views_check_mutable(cscd_context *context, const cscd_mesh *mesh, const cscd_mutable_view *views,
                                const char *name) {
    for (uint32_t object = 0, place = 0; views != NULL && object < mesh->object_count; place++) {
        cscd_view view = as_view(&views[place]);
        cscd_status status = check_view(context, mesh, &view, place, object, name);
        if (status != CSCD_OK) return status;
        object = layout_of(mesh, &view, object).end_object;
    }
    return CSCD_OK;
}

static void store_scalar(char *at, bool is_float, double x) {
    float narrow = (float)x;
    if (is_float)
        memcpy(at, &narrow, sizeof narrow);
    else
        memcpy(at, &x, sizeof x);
}

static void pack_view(const layout *l, char *at, const double *positions) {
    bool is_float = l->scalar_size == sizeof(float);
    for (uint32_t v = 0; v < l->vertex_count; v++, at += l->stride) {
        for (size_t k = 0; k < 3; k++) store_scalar(at + k * l->coordinate_stride, is_float, *positions++);
    }
}

void views_write(const cscd_mesh *mesh, const cscd_mutable_view *views, const double *positions) {
    for (uint32_t object = 0; views != NULL && object < mesh->object_count; views++) {
        cscd_view view = as_view(views);
        layout l = layout_of(mesh, &view, object);
        pack_view(&l, views->data, positions + (size_t)l.first_vertex * 3);
        object = l.end_object;
    }
}

/* ---- scalars ------------------------------------------------------------------------------------------- */

static uint32_t take_scalar(const cscd_mesh *mesh, const cscd_view *view, uint32_t object,
                            cscd_scalar *of_objects) {
    uint32_t end = layout_of(mesh, view, object).end_object;
    while (object < end) of_objects[object++] = view->scalar;
    return end;
}

void views_scalars(const cscd_mesh *mesh, const cscd_view *views, cscd_scalar *of_objects) {
    for (uint32_t object = 0; object < mesh->object_count; views++)
        object = take_scalar(mesh, views, object, of_objects);
}

void views_mutable_scalars(const cscd_mesh *mesh, const cscd_mutable_view *views, cscd_scalar *of_objects) {
    for (uint32_t object = 0; object < mesh->object_count; views++) {
        cscd_view view = as_view(views);
        object = take_scalar(mesh, &view, object, of_objects);
    }
}
