/* Pairs that the caller wants to be left out: by callback, by list, and by seams. */
#include "runtime/narrow_phase/exclusions.h"

#include "src/core/disjoint_sets.h"
#include "src/core/sort.h"
#include "src/mesh/triangle_intersection.h"

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

static cscd_status list_pairs(exclusions *e, const cscd_detector_options *options) {
    cscd_context *context = e->mesh->context;
    size_t count = options->ignored_count;
    if (count == 0) return CSCD_OK;
    e->ignored = context_allocate(context, count, sizeof *e->ignored);
    uint64_t *scratch = context_allocate(context, count, sizeof *scratch);
    bool allocated = e->ignored != NULL && scratch != NULL;
    for (size_t i = 0; allocated && i < count; i++)
        e->ignored[i] = key_of(options->ignored[2 * i], options->ignored[2 * i + 1]);
    if (allocated) sort_by_number(e->ignored, scratch, count, sizeof *e->ignored);
    e->ignored_count = count;
    context_free(context, scratch);
    return allocated ? CSCD_OK : context_out_of_memory(context);
}

static cscd_status name_seams(exclusions *e, const cscd_detector_options *options) {
    uint32_t count = e->mesh->vertex_count;
    if (options->seam_count == 0) return CSCD_OK;
    uint32_t *names = e->names = context_allocate(e->mesh->context, count, sizeof *names);
    if (names == NULL) return context_out_of_memory(e->mesh->context);
    sets_begin(names, count);
    for (size_t i = 0; i < options->seam_count; i++)
        set_unite(names, options->seams[2 * i], options->seams[2 * i + 1]);
    for (uint32_t v = 0; v < count; v++) names[v] = set_root(names, v);
    return CSCD_OK;
}

cscd_status exclusions_create(const cscd_mesh *mesh, const cscd_detector_options *options, exclusions *out) {
    exclusions e = {.mesh = mesh, .ignore = options->ignore, .ignore_user = options->ignore_user};
    cscd_status status = check_pairs(mesh->context, options->ignored, options->ignored_count,
                                     mesh->triangle_count, "ignored", "triangle");
    if (status == CSCD_OK)
        status = check_pairs(mesh->context, options->seams, options->seam_count, mesh->vertex_count, "seams",
                             "vertex");
    if (status == CSCD_OK)
        status = seam_list_create(mesh, options->seams, options->seam_count, options->seam_reach, &e.seams);
    if (status == CSCD_OK) status = list_pairs(&e, options);
    if (status == CSCD_OK) status = name_seams(&e, options);
    if (status != CSCD_OK) {
        exclusions_free(mesh->context, &e);
        return status;
    }
    *out = e;
    return CSCD_OK;
}

void exclusions_free(cscd_context *context, exclusions *e) {
    context_free(context, e->ignored);
    context_free(context, e->names);
    seam_list_free(context, &e->seams);
    *e = (exclusions){.mesh = NULL};
}

/* ---- pairs of triangles -------------------------------------------------------------------------------- */

static bool is_listed(const exclusions *e, uint64_t key) {
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

static bool host_ignores(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (e->ignore == NULL) return false;
    HOST_CALL(call, &e->mesh->context->entry, HOST_IGNORE);
    bool ignored = e->ignore(e->ignore_user, kind, a, b);
    host_call_end(&call);
    return ignored;
}

bool exclusions_cover_triangles(const exclusions *e, uint32_t a, uint32_t b, const double *positions) {
    if (e->ignored_count > 0 && is_listed(e, key_of(a, b))) return true;
    if (host_ignores(e, CSCD_CONTACT_TT, a, b)) return true;
    if (e->names == NULL) return false;
    const uint32_t *corners_a = e->mesh->triangles[a], *corners_b = e->mesh->triangles[b];
    return !triangles_intersect_by_names(corners_a, corners_b, e->names, positions);
}

/* ---- pairs of features --------------------------------------------------------------------------------- */

typedef struct triangle_list {
    const uint32_t *items;
    uint32_t count;
} triangle_list;

static triangle_list vertex_star(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t begin = mesh->vertex_star_offsets[vertex];
    return (triangle_list){mesh->vertex_stars + begin, mesh->vertex_star_offsets[vertex + 1] - begin};
}

static triangle_list edge_star(const cscd_mesh *mesh, uint32_t edge) {
    return (triangle_list){mesh->edge_stars + mesh->edge_star_offsets[edge], edge_star_size(mesh, edge)};
}

static bool any_pair_listed(const exclusions *e, triangle_list a, triangle_list b) {
    for (uint32_t i = 0; i < a.count; i++) {
        for (uint32_t j = 0; j < b.count; j++) {
            if (a.items[i] != b.items[j] && is_listed(e, key_of(a.items[i], b.items[j]))) return true;
        }
    }
    return false;
}

static bool features_listed(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    if (e->ignored_count == 0) return false;
    if (kind == CSCD_CONTACT_VF) return any_pair_listed(e, vertex_star(e->mesh, a), (triangle_list){&b, 1});
    return any_pair_listed(e, edge_star(e->mesh, a), edge_star(e->mesh, b));
}

static bool share_name(const uint32_t *names, const uint32_t *a, int a_count, const uint32_t *b,
                       int b_count) {
    for (int i = 0; i < a_count; i++) {
        for (int j = 0; j < b_count; j++) {
            if (names[a[i]] == names[b[j]]) return true;
        }
    }
    return false;
}

bool exclusions_cover_features(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const cscd_mesh *mesh = e->mesh;
    bool vf = kind == CSCD_CONTACT_VF;
    if (e->names != NULL) {
        if (vf ? share_name(e->names, &a, 1, mesh->triangles[b], 3)
               : share_name(e->names, mesh->edges[a], 2, mesh->edges[b], 2))
            return true;
    }
    return features_listed(e, kind, a, b) || host_ignores(e, kind, a, b);
}
