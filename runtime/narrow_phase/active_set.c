/* Which vertices may move in the next motions. Pairs of two features without any of them are not looked for. */
#include "runtime/narrow_phase/active_set.h"

#include <string.h>

static array_list list_arrays(const cscd_mesh *mesh, active_set *s) {
    return (array_list){{ARRAY(s->vertices, mesh->vertex_count), ARRAY(s->triangles, mesh->triangle_count)}};
}

cscd_status active_set_reserve(const cscd_mesh *mesh, active_set *s) {
    active_set fresh;
    if (s->vertices != NULL) return CSCD_OK;
    if (!context_allocate_all(mesh->context, list_arrays(mesh, &fresh))) return CSCD_OUT_OF_MEMORY;
    *s = fresh;
    return CSCD_OK;
}

static void fill_triangles(const cscd_mesh *mesh, active_set *s) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        s->triangles[t] = active_corners(s, mesh->triangles[t]) != 0;
}

void active_set_fill(const cscd_mesh *mesh, const uint32_t *vertices, size_t count, active_set *s) {
    memset(s->vertices, false, mesh->vertex_count * sizeof *s->vertices);
    for (size_t i = 0; i < count; i++) s->vertices[vertices[i]] = true;
    fill_triangles(mesh, s);
}

cscd_status active_set_copy(const active_set *s, const cscd_mesh *mesh, active_set *out) {
    active_set copy = *s;
    if (!context_copy_all(mesh->context, list_arrays(mesh, &copy))) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}

cscd_status active_set_move(const active_set *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            active_set *out) {
    active_set moved = {.vertices = NULL};
    if (s->vertices != NULL) {
        cscd_status status = active_set_reserve(mesh, &moved);
        if (status != CSCD_OK) return status;
        mesh_change_make_whole(change, &change->vertices);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            uint32_t origin = change->vertices.to_old[v];
            moved.vertices[v] = origin == UINT32_MAX || s->vertices[origin];
        }
        fill_triangles(mesh, &moved);
    }
    *out = moved;
    return CSCD_OK;
}

void active_set_free(cscd_context *context, active_set *s) {
    context_free(context, s->vertices);
    context_free(context, s->triangles);
    *s = (active_set){.vertices = NULL};
}

const char *active_set_validate(const active_set *s, const cscd_mesh *mesh) {
    if ((s->vertices != NULL) != (s->triangles != NULL)) return "an active set has no triangles";
    for (uint32_t t = 0; s->vertices != NULL && t < mesh->triangle_count; t++) {
        if (s->triangles[t] != (active_corners(s, mesh->triangles[t]) != 0))
            return "a triangle is not as active as its vertices";
    }
    return NULL;
}
