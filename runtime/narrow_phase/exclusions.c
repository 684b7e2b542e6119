/* Pairs that the caller wants to be left out: by callback, by list, and by seams. */
#include "runtime/narrow_phase/exclusions.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- seams to be checked ------------------------------------------------------------------------------- */

cscd_status seam_list_create(const cscd_mesh *mesh, const uint32_t *pairs, size_t count, double reach,
                             seam_list *out) {
    cscd_context *context = mesh->context;
    for (size_t i = 0; i < count; i++) {
        if (pairs[2 * i] == pairs[2 * i + 1])
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "pair %zu of seams has vertex %u twice, expected two vertices; leave it out",
                                i, pairs[2 * i]);
    }
    *out = (seam_list){.count = count, .reach = reach};
    if (count == 0) return CSCD_OK;
    out->vertices = context_allocate(context, count, sizeof(uint32_t[2]));
    if (out->vertices == NULL) return context_out_of_memory(context);
    memcpy(out->vertices, pairs, count * sizeof(uint32_t[2]));
    return CSCD_OK;
}

void seam_list_free(cscd_context *context, seam_list *s) {
    context_free(context, s->vertices);
    s->vertices = NULL;
}

static double longest_edge_at(const cscd_mesh *mesh, const double *positions, uint32_t vertex) {
    double longest = 0.0;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        const uint32_t *edges = mesh->triangle_edges[mesh->vertex_stars[i]];
        for (int k = 0; k < 3; k++) {
            const uint32_t *ends = mesh->edges[edges[k]];
            if (ends[0] == vertex || ends[1] == vertex)
                longest = fmax(longest, surface_edge_length(mesh, positions, edges[k]));
        }
    }
    const loose_objects *loose = &mesh->loose;
    for (uint32_t i = 0; i < wires_at_vertex(mesh, vertex); i++) {
        uint32_t wire = loose->wire_stars[loose->wire_star_offsets[vertex] + i];
        longest = fmax(longest, surface_edge_length(mesh, positions, wire));
    }
    return longest;
}

/* A mistake in the indices joins vertices from anywhere, mostly much farther apart than neighbours are. */
static double usual_reach(const cscd_mesh *mesh, const double *positions, const uint32_t pair[2]) {
    return fmax(longest_edge_at(mesh, positions, pair[0]), longest_edge_at(mesh, positions, pair[1]));
}

static double distance_of(const double *positions, const uint32_t pair[2]) {
    double between[3];
    vec3_subtract(positions + (size_t)pair[0] * 3, positions + (size_t)pair[1] * 3, between);
    return surface_norm(between);
}

cscd_status seam_list_check(const cscd_mesh *mesh, seam_list *s, const double *positions) {
    if (s->vertices == NULL) return CSCD_OK;
    for (size_t i = 0; i < s->count; i++) {
        const uint32_t *pair = s->vertices + 2 * i;
        double distance = distance_of(positions, pair);
        double reach = s->reach > 0.0 ? s->reach : usual_reach(mesh, positions, pair);
        if (distance <= reach) continue;
        return context_fail(
            mesh->context, CSCD_INVALID_ARGUMENT,
            "pair %zu of seams joins the vertices %u and %u, which are %g apart at the first "
            "positions, farther than %s, %g: check the indices, or set seam_reach if they are "
            "to be that far apart",
            i, pair[0], pair[1], distance, s->reach > 0.0 ? "seam_reach" : "the longest edge at them", reach);
    }
    seam_list_free(mesh->context, s);
    return CSCD_OK;
}

/* ---- what the options say ------------------------------------------------------------------------------ */

static uint64_t key_of(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static cscd_status check_pairs(cscd_context *context, const uint32_t *pairs, size_t count, uint32_t limit,
                               const char *name, const char *of) {
    if (count > 0 && pairs == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL, but there are to be %zu pairs", name,
                            count);
    for (size_t i = 0; i < count; i++) {
        uint32_t larger = pairs[2 * i] > pairs[2 * i + 1] ? pairs[2 * i] : pairs[2 * i + 1];
        if (larger >= limit)
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "pair %zu of %s names %s %u, but there are %u", i, name, of, larger, limit);
    }
    return CSCD_OK;
}

static cscd_status check_ignored(const cscd_mesh *mesh, const uint32_t *ignored, size_t count) {
    return check_pairs(mesh->context, ignored, count, mesh->triangle_count, "ignored", "triangle");
}

static cscd_status list_pairs(exclusions *e, const uint32_t *ignored, size_t count) {
    cscd_context *context = e->mesh->context;
    if (count == 0) return CSCD_OK;
    e->ignored = context_allocate(context, count, sizeof *e->ignored);
    uint64_t *scratch = context_allocate(context, count, sizeof *scratch);
    bool allocated = e->ignored != NULL && scratch != NULL;
    for (size_t i = 0; allocated && i < count; i++)
        e->ignored[i] = key_of(ignored[2 * i], ignored[2 * i + 1]);
    if (allocated) sort_by_number(e->ignored, scratch, count, sizeof *e->ignored);
    e->ignored_count = count;
    context_free(context, scratch);
    return allocated ? CSCD_OK : context_out_of_memory(context);
}

static cscd_status name_seams(exclusions *e, const uint32_t *seams, size_t seam_count) {
    uint32_t count = e->mesh->vertex_count;
    if (seam_count == 0) return CSCD_OK;
    uint32_t *names = e->names = context_allocate(e->mesh->context, count, sizeof *names);
    if (names == NULL) return context_out_of_memory(e->mesh->context);
    sets_begin(names, count);
    for (size_t i = 0; i < seam_count; i++) set_unite(names, seams[2 * i], seams[2 * i + 1]);
    for (uint32_t v = 0; v < count; v++) names[v] = set_root(names, v);
    return CSCD_OK;
}

static cscd_status take_seams(exclusions *e, const uint32_t *seams, size_t count, double reach) {
    const cscd_mesh *mesh = e->mesh;
    cscd_status status = check_pairs(mesh->context, seams, count, mesh->vertex_count, "seams", "vertex");
    if (status == CSCD_OK) status = seam_list_create(mesh, seams, count, reach, &e->seams);
    return status == CSCD_OK ? name_seams(e, seams, count) : status;
}

/* Gives *e to the caller, or frees it. */
static cscd_status give_exclusions(cscd_status status, exclusions *e, exclusions *out) {
    if (status == CSCD_OK)
        *out = *e;
    else
        exclusions_free(e->mesh->context, e);
    return status;
}

cscd_status exclusions_create(const cscd_mesh *mesh, const cscd_detector_options *options, exclusions *out) {
    exclusions e = {.mesh = mesh, .ignore = options->ignore, .ignore_user = options->ignore_user};
    cscd_status status = check_ignored(mesh, options->ignored, options->ignored_count);
    if (status == CSCD_OK) status = take_seams(&e, options->seams, options->seam_count, options->seam_reach);
    if (status == CSCD_OK) status = list_pairs(&e, options->ignored, options->ignored_count);
    return give_exclusions(status, &e, out);
}

/* ---- changes ------------------------------------------------------------------------------------------- */

/* Neither seams nor ignored pairs, but what else there is. */
static exclusions without_lists(const exclusions *e) {
    return (exclusions){
        .mesh = e->mesh, .ignore = e->ignore, .ignore_user = e->ignore_user, .waiting = e->waiting};
}

exclusions exclusions_listed(const exclusions *e) {
    return (exclusions){.mesh = e->mesh,
                        .ignored = e->ignored,
                        .ignored_count = e->ignored_count,
                        .names = e->names,
                        .seams = e->seams};
}

cscd_status exclusions_with_seams(const exclusions *now, const uint32_t *seams, size_t seam_count,
                                  double seam_reach, exclusions *out) {
    cscd_context *context = now->mesh->context;
    exclusions e = without_lists(now);
    cscd_status status = take_seams(&e, seams, seam_count, seam_reach);
    if (status == CSCD_OK && now->ignored_count > 0) {
        e.ignored = context_allocate(context, now->ignored_count, sizeof *e.ignored);
        if (e.ignored == NULL) status = context_out_of_memory(context);
    }
    if (e.ignored != NULL) memcpy(e.ignored, now->ignored, now->ignored_count * sizeof *e.ignored);
    e.ignored_count = now->ignored_count;
    return give_exclusions(status, &e, out);
}

cscd_status exclusions_with_ignored(const exclusions *now, const uint32_t *ignored, size_t ignored_count,
                                    exclusions *out) {
    const cscd_mesh *mesh = now->mesh;
    exclusions e = without_lists(now);
    cscd_status status = check_ignored(mesh, ignored, ignored_count);
    if (status == CSCD_OK) status = list_pairs(&e, ignored, ignored_count);
    if (status == CSCD_OK && now->names != NULL) {
        e.names = context_allocate(mesh->context, mesh->vertex_count, sizeof *e.names);
        if (e.names == NULL) status = context_out_of_memory(mesh->context);
    }
    if (e.names != NULL) memcpy(e.names, now->names, mesh->vertex_count * sizeof *e.names);
    return give_exclusions(status, &e, out);
}

static bool has_key(const exclusions *e, uint64_t key) {
    size_t low = 0, high = e->ignored_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (e->ignored[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < e->ignored_count && e->ignored[low] == key;
}

bool exclusions_have(const exclusions *e, uint32_t a, uint32_t b) {
    return e->ignored_count > 0 && has_key(e, key_of(a, b));
}

static uint32_t name_of(const exclusions *e, uint32_t vertex) {
    return e->names != NULL ? e->names[vertex] : vertex;
}

bool exclusions_uncover(const exclusions *before, const exclusions *now) {
    for (size_t i = 0; i < before->ignored_count; i++) {
        if (!has_key(now, before->ignored[i])) return true;
    }
    for (uint32_t v = 0; before->names != NULL && v < before->mesh->vertex_count; v++) {
        if (name_of(now, v) != name_of(now, before->names[v])) return true;
    }
    return false;
}

void exclusions_free(cscd_context *context, exclusions *e) {
    context_free(context, e->ignored);
    context_free(context, e->names);
    seam_list_free(context, &e->seams);
    *e = (exclusions){.mesh = NULL};
}

/* ---- seams of another mesh --------------------------------------------------------------------------------------------- */

/* Unites what has become of the vertices of each seam: the first that came from each, or all. first:
 * scratch, per old vertex. */
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

/* ---- ignored pairs of another mesh ------------------------------------------------------------------------------------- */

static size_t count_pairs(const exclusions *e, const mesh_successors *h) {
    size_t count = 0;
    for (size_t i = 0; i < e->ignored_count; i++)
        count += mesh_successors_of(h, (uint32_t)(e->ignored[i] >> 32)).count *
                 mesh_successors_of(h, (uint32_t)e->ignored[i]).count;
    return count;
}

static void list_pairs_of(const mesh_successors *h, uint32_t a, uint32_t b, exclusions *out) {
    successor_list of_a = mesh_successors_of(h, a), of_b = mesh_successors_of(h, b);
    for (size_t i = 0; i < of_a.count; i++) {
        for (size_t j = 0; j < of_b.count; j++) {
            uint64_t s = successor_at(&of_a, i), t = successor_at(&of_b, j);
            out->ignored[out->ignored_count++] = s < t ? s << 32 | t : t << 32 | s;
        }
    }
}

static cscd_status move_listed(const exclusions *e, const mesh_successors *h, exclusions *out) {
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
    mesh_successors h;
    if (e->ignored_count == 0) return CSCD_OK;
    cscd_status status = mesh_successors_find(out->mesh->context, change, &change->triangles, &h);
    if (status == CSCD_OK) status = move_listed(e, &h, out);
    mesh_successors_free(out->mesh->context, &h);
    return status;
}

/* ---- another mesh, and copies ------------------------------------------------------------------------------------------- */

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
