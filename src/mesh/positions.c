/* Positions: checks their coordinates, and turns a caller's layout into packed doubles and back, unless scalars lie on each other. */
#include "src/mesh/positions.h"

#include "src/core/floating.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* ---- coordinates ------------------------------------------------------------------------------------------- */

enum { COORDINATES_PER_TASK = 6144 };

/* The bits of doubles, without the sign, are ordered as their magnitudes. */
static uint64_t magnitude_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits << 1;
}

/* Has no branch per coordinate. */
static bool all_acceptable(const double *x, size_t count) {
    uint64_t low = magnitude_bits(LENGTH_MIN), range = magnitude_bits(LENGTH_MAX) - low;
    unsigned refused = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t bits = magnitude_bits(x[i]);
        refused |= (unsigned)(bits - low > range) & (unsigned)(bits != 0);
    }
    return refused == 0;
}

typedef struct check {
    const double *x;
    size_t count;
    atomic_bool refused;
} check;

static void check_task(void *data, uint32_t index) {
    check *c = data;
    size_t begin = (size_t)index * COORDINATES_PER_TASK, rest = c->count - begin;
    if (!all_acceptable(c->x + begin, rest < COORDINATES_PER_TASK ? rest : COORDINATES_PER_TASK))
        atomic_store(&c->refused, true);
}

cscd_status positions_check(cscd_context *context, const double *positions, uint32_t vertex_count,
                            const char *name) {
    if (positions == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    check c = {.x = positions, .count = (size_t)vertex_count * 3};
    size_t tasks = (c.count + COORDINATES_PER_TASK - 1) / COORDINATES_PER_TASK;
    parallel_run(context->threads, (uint32_t)tasks, check_task, &c);
    for (size_t i = 0; atomic_load(&c.refused) && i < c.count; i++) {
        if (is_length(fabs(positions[i]))) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s: vertex %zu has %c = %g, expected 0 or a magnitude from 2^-300 to 2^300",
                            name, i / 3, "xyz"[i % 3], positions[i]);
    }
    return context_loop_status(context);
}

/* ---- overlaps ---------------------------------------------------------------------------------------------- */

static ptrdiff_t place_of(const view_grid *g, uint32_t vertex, uint32_t coordinate) {
    return (ptrdiff_t)(vertex * g->stride + coordinate * g->coordinate_stride);
}

/* The bytes from b's data to a's, which may be parts of different arrays. */
static ptrdiff_t distance_of(const view_grid *a, const view_grid *b) {
    return (ptrdiff_t)((uintptr_t)a->data - (uintptr_t)b->data);
}

static bool set_clash(view_clash *out, uint32_t i, uint32_t k, uint32_t j, uint32_t l) {
    *out = (view_clash){.vertices = {i, j}, .coordinates = {k, l}};
    return true;
}

/* ---- equal strides ------------------------------------------------------------------------------------- */

/* Do a scalar of the coordinate k of a and one of the coordinate l of b overlap? Scalar i of a begins
 * apart = distance + (i - j) stride bytes behind scalar j of b; they overlap when that is below the size of b's and
 * above minus the size of a's. The steps i - j next to apart = 0 decide. */
static bool steps_clash(const view_grid *a, uint32_t k, const view_grid *b, uint32_t l, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b) + place_of(a, 0, k) - place_of(b, 0, l);
    ptrdiff_t stride = (ptrdiff_t)a->stride, nearest = -distance / stride;
    ptrdiff_t least = 1 - (ptrdiff_t)b->vertex_count, most = (ptrdiff_t)a->vertex_count - 1;
    nearest = nearest < least ? least : nearest > most ? most : nearest;
    for (ptrdiff_t steps = nearest - 1; steps <= nearest + 1; steps++) {
        ptrdiff_t apart = distance + steps * stride;
        if (steps < least || steps > most || apart >= (ptrdiff_t)b->scalar_size ||
            -apart >= (ptrdiff_t)a->scalar_size)
            continue;
        return set_clash(out, steps > 0 ? (uint32_t)steps : 0, k, steps < 0 ? (uint32_t)-steps : 0, l);
    }
    return false;
}

bool view_overlaps_itself(const view_grid *g, view_clash *out) {
    if (g->vertex_count > 1 && g->stride < g->scalar_size) return set_clash(out, 0, 0, 1, 0);
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t l = k + 1; l < 3; l++) {
            if (steps_clash(g, k, g, l, out)) return true;
        }
    }
    return false;
}

/* ---- any strides --------------------------------------------------------------------------------------- */

/* The same for different strides: both rows of scalars are walked along from their beginnings. */
static bool rows_clash(const view_grid *a, uint32_t k, const view_grid *b, uint32_t l, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b);
    uint32_t i = 0, j = 0;
    while (i < a->vertex_count && j < b->vertex_count) {
        ptrdiff_t apart = distance + place_of(a, i, k) - place_of(b, j, l);
        if (apart >= (ptrdiff_t)b->scalar_size)
            j++;
        else if (-apart >= (ptrdiff_t)a->scalar_size)
            i++;
        else
            return set_clash(out, i, k, j, l);
    }
    return false;
}

static ptrdiff_t extent_of(const view_grid *g) {
    return place_of(g, g->vertex_count - 1, 2) + (ptrdiff_t)g->scalar_size;
}

bool views_overlap(const view_grid *a, const view_grid *b, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b);
    if (distance >= extent_of(b) || -distance >= extent_of(a)) return false;
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t l = 0; l < 3; l++) {
            if (a->stride == b->stride ? steps_clash(a, k, b, l, out) : rows_clash(a, k, b, l, out))
                return true;
        }
    }
    return false;
}

/* ---- views ------------------------------------------------------------------------------------------------- */

/* The members that both kinds of views have in common; the defaults are filled in. */
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

/* ---- checking ------------------------------------------------------------------------------------------ */

/* No memory is larger; below this, places in a view and their differences do not overflow. */
#define SIZE_OF_VIEW_MAX (SIZE_MAX / 8)

/* The number of vertices that lie in the memory of the view. */
static size_t room_of(const layout *l) {
    if (l->coordinate_stride > l->size) return 0;
    size_t one = 2 * l->coordinate_stride + l->scalar_size;
    return one <= l->size ? 1 + (l->size - one) / l->stride : 0;
}

static view_grid grid_of(const layout *l) {
    return (view_grid){l->data, l->stride, l->coordinate_stride, l->scalar_size, l->vertex_count};
}

static cscd_status check_layout(cscd_context *context, const layout *l, uint32_t place, const char *name) {
    view_grid grid = grid_of(l);
    view_clash clash;
    if (l->size > SIZE_OF_VIEW_MAX)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%u].size is %zu bytes, more than any memory has", name, place, l->size);
    if (room_of(l) < l->vertex_count)
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s[%u] has %zu bytes, room for %zu of its %u vertices (stride %zu, "
                            "coordinate_stride %zu): the array is too short, or its size is in another unit "
                            "than bytes",
                            name, place, l->size, room_of(l), l->vertex_count, l->stride,
                            l->coordinate_stride);
    if (view_overlaps_itself(&grid, &clash))
        return context_fail(
            context, CSCD_INVALID_ARGUMENT,
            "%s[%u]: %c of vertex %u and %c of vertex %u lie on the same bytes, with a stride "
            "of %zu, a coordinate_stride of %zu and %zu bytes a coordinate",
            name, place, "xyz"[clash.coordinates[0]], clash.vertices[0], "xyz"[clash.coordinates[1]],
            clash.vertices[1], l->stride, l->coordinate_stride, l->scalar_size);
    return CSCD_OK;
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
                            "%s[%u] is to hold %u objects, but only %u of the mesh %s left for it", name,
                            place, view->object_count, left, left == 1 ? "is" : "are");
    layout l = layout_of(mesh, view, first_object);
    return check_layout(context, &l, place, name);
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

/* Compares a view, which begins with an object, with the views before it. */
static cscd_status check_apart(cscd_context *context, const cscd_mesh *mesh, const cscd_mutable_view *views,
                               uint32_t place, uint32_t first_object, const char *name) {
    cscd_view view = as_view(&views[place]);
    layout l = layout_of(mesh, &view, first_object);
    view_grid grid = grid_of(&l);
    for (uint32_t object = 0, before = 0; before < place; before++) {
        cscd_view other = as_view(&views[before]);
        layout other_layout = layout_of(mesh, &other, object);
        view_grid other_grid = grid_of(&other_layout);
        view_clash clash;
        object = other_layout.end_object;
        if (!views_overlap(&other_grid, &grid, &clash)) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%c of vertex %u of %s[%u] and %c of vertex %u of %s[%u] lie on the same bytes",
                            "xyz"[clash.coordinates[0]], clash.vertices[0], name, before,
                            "xyz"[clash.coordinates[1]], clash.vertices[1], name, place);
    }
    return CSCD_OK;
}

cscd_status views_check_mutable(cscd_context *context, const cscd_mesh *mesh, const cscd_mutable_view *views,
                                const char *name) {
    uintptr_t end = 0; /* of the memory of all views before */
    for (uint32_t object = 0, place = 0; views != NULL && object < mesh->object_count; place++) {
        cscd_view view = as_view(&views[place]);
        uintptr_t begin = (uintptr_t)view.data;
        cscd_status status = check_view(context, mesh, &view, place, object, name);
        if (status == CSCD_OK && begin < end) status = check_apart(context, mesh, views, place, object, name);
        if (status != CSCD_OK) return status;
        end = begin + view.size > end ? begin + view.size : end;
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
