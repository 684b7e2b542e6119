/* Exclusions that move over to another mesh, or are copied. */
#include "runtime/narrow_phase/exclusions_move.h"

#include "src/core/disjoint_sets.h"
#include "src/core/sort.h"

#include <string.h>

/* ---- seams --------------------------------------------------------------------------------------------- */

/* Unites what has become of the vertices of each seam: the first that came from each, or all. first: scratch, per old
 * vertex. */
static void unite_seams(const exclusions *e, const cscd_mesh_change *change, bool all, uint32_t *first,
                        uint32_t *names) {
    memset(first, 0xff, change->vertices.old_count * sizeof *first);
    mesh_change_make_whole(change, &change->vertices);
    for (uint32_t v = 0; v < change->vertices.new_count; v++) {
        uint32_t origin = change->vertices.to_old[v];
        if (origin == UINT32_MAX || (!all && change->vertices.to_new[origin] != v)) continue;
        uint32_t *first_now = &first[e->names[origin]];
        if (*first_now == UINT32_MAX)
            *first_now = v;
        else
            set_unite(names, *first_now, v);
    }
}

static void settle_names(uint32_t *names, uint32_t count) {
    for (uint32_t v = 0; v < count; v++) names[v] = set_root(names, v);
}

static cscd_status move_names(const exclusions *e, const cscd_mesh_change *change, bool all,
                              exclusions *out) {
    if (e->names == NULL) return CSCD_OK;
    cscd_context *context = out->mesh->context;
    uint32_t count = change->vertices.new_count;
    uint32_t *names = out->names = context_allocate(context, count, sizeof *names);
    uint32_t *first = context_allocate(context, change->vertices.old_count, sizeof *first);
    if (names != NULL && first != NULL) {
        sets_begin(names, count);
        unite_seams(e, change, all, first, names);
        settle_names(names, count);
    }
    context_free(context, first);
    return names != NULL && first != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* Seams that are still to be checked at the first positions. */
static cscd_status move_list(const seam_list *s, const cscd_mesh_change *change, cscd_context *context,
                             seam_list *out) {
    *out = (seam_list){.reach = s->reach};
    if (s->vertices == NULL) return CSCD_OK;
    out->vertices = context_allocate(context, s->count, sizeof(uint32_t[2]));
    if (out->vertices == NULL) return CSCD_OUT_OF_MEMORY;
    for (size_t i = 0; i < s->count; i++) {
        uint32_t a = number_map_to_new(&change->vertices, s->vertices[2 * i]);
        uint32_t b = number_map_to_new(&change->vertices, s->vertices[2 * i + 1]);
        if (a == UINT32_MAX || b == UINT32_MAX) continue;
        out->vertices[2 * out->count] = a;
        out->vertices[2 * out->count++ + 1] = b;
    }
    return CSCD_OK;
}

/* ---- ignored pairs ------------------------------------------------------------------------------------- */

static size_t count_pairs(const exclusions *e, const mesh_heirs *h) {
    size_t count = 0;
    for (size_t i = 0; i < e->ignored_count; i++)
        count += mesh_heirs_of(h, (uint32_t)(e->ignored[i] >> 32)).count *
                 mesh_heirs_of(h, (uint32_t)e->ignored[i]).count;
    return count;
}

static void list_pairs_of(const mesh_heirs *h, uint32_t a, uint32_t b, exclusions *out) {
    heir_list of_a = mesh_heirs_of(h, a), of_b = mesh_heirs_of(h, b);
    for (size_t i = 0; i < of_a.count; i++) {
        for (size_t j = 0; j < of_b.count; j++) {
            uint64_t s = heir_at(&of_a, i), t = heir_at(&of_b, j);
            out->ignored[out->ignored_count++] = s < t ? s << 32 | t : t << 32 | s;
        }
    }
}

static cscd_status move_listed(const exclusions *e, const mesh_heirs *h, exclusions *out) {
    cscd_context *context = out->mesh->context;
    size_t count = count_pairs(e, h);
    out->ignored = context_allocate(context, count, sizeof *out->ignored);
    uint64_t *scratch = context_allocate(context, count, sizeof *scratch);
    bool made = out->ignored != NULL && scratch != NULL;
    for (size_t i = 0; made && i < e->ignored_count; i++)
        list_pairs_of(h, (uint32_t)(e->ignored[i] >> 32), (uint32_t)e->ignored[i], out);
    if (made) sort_by_number(out->ignored, scratch, count, sizeof *out->ignored);
    context_free(context, scratch);
    return made ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

static cscd_status move_ignored(const exclusions *e, const cscd_mesh_change *change, exclusions *out) {
    mesh_heirs h;
    if (e->ignored_count == 0) return CSCD_OK;
    cscd_status status = mesh_heirs_find(out->mesh->context, change, &change->triangles, &h);
    if (status == CSCD_OK) status = move_listed(e, &h, out);
    mesh_heirs_free(out->mesh->context, &h);
    return status;
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

static cscd_status move_all(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            bool all, exclusions *out) {
    exclusions moved = {.mesh = mesh, .ignore = e->ignore, .ignore_user = e->ignore_user};
    cscd_status status = move_names(e, change, all, &moved);
    if (status == CSCD_OK) status = move_list(&e->seams, change, mesh->context, &moved.seams);
    if (status == CSCD_OK) status = move_ignored(e, change, &moved);
    if (status != CSCD_OK) {
        exclusions_free(mesh->context, &moved);
        return status;
    }
    *out = moved;
    return CSCD_OK;
}

cscd_status exclusions_move(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            exclusions *out) {
    return move_all(e, mesh, change, false, out);
}

cscd_status exclusions_move_former(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                                   exclusions *out) {
    return move_all(e, mesh, change, true, out);
}

cscd_status exclusions_copy(const exclusions *e, const cscd_mesh *mesh, exclusions *out) {
    exclusions copy = *e;
    copy.mesh = mesh;
    copy.waiting = NULL;
    array_list list = {{ARRAY(copy.ignored, copy.ignored_count), ARRAY(copy.names, mesh->vertex_count),
                        ARRAY(copy.seams.vertices, 2 * copy.seams.count)}};
    if (!context_copy_all(mesh->context, list)) return CSCD_OUT_OF_MEMORY;
    *out = copy;
    return CSCD_OK;
}
