/* Which parts of surfaces are on the wrong side: buried in a closed component, or cut off from an open one. */
#include "runtime/untangle/wrong_sides.h"

#include "src/core/sort.h"

#include <string.h>

/* ---- patches of vertices ------------------------------------------------------------------------------- */

/* Of a curve point, whether the triangle there is of an open component. */
static bool is_open(const cscd_mesh *mesh, uint32_t triangle) {
    return !mesh->components[mesh->triangle_components[triangle]].closed_manifold;
}

static void count_crossings(lens_finder *f, const cscd_curves *curves) {
    memset(f->crossings, 0, f->w->mesh->edge_count * sizeof *f->crossings);
    for (size_t i = 0; i < curves->point_count; i++) {
        if (curves->points[i].edge != UINT32_MAX) f->crossings[curves->points[i].edge]++;
    }
}

/* A curve that ends at a vertex of both triangles goes on from there as its other trace, so no patch leads through that vertex. */
static void join_patches(lens_finder *f, const cscd_patches *patches) {
    const cscd_mesh *mesh = f->w->mesh;
    const uint32_t *names = f->w->graph.names;
    sets_begin(f->patches, mesh->vertex_count);
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        if (f->crossings[e] == 0 && patches->vertex_patches[ends[0]] != UINT32_MAX &&
            patches->vertex_patches[ends[1]] != UINT32_MAX)
            set_unite(f->patches, ends[0], ends[1]);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) set_unite(f->patches, v, names[v]);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) f->patches[v] = set_root(f->patches, v);
    f->next_patch = mesh->vertex_count;
}

/* ---- closed components ------------------------------------------------------------------------------- */

/* Returns 1 for a patch in a body, -1 for one around which its body winds less than 0 times, else 0. */
static int patch_side(const cscd_patches *patches, uint32_t patch) {
    if (patch == UINT32_MAX) return 0;
    const cscd_patch *p = &patches->items[patch];
    for (uint32_t i = 0; i < p->winding_count; i++) {
        if (patches->windings[p->first_winding + i].number >= 1) return 1;
    }
    return p->own < 0 ? -1 : p->own > 0 ? 1 : 0;
}

static void mark_buried(lens_finder *f, const cscd_patches *patches) {
    for (uint32_t v = 0; v < f->w->mesh->vertex_count; v++) {
        f->sides[v] = (int8_t)patch_side(patches, patches->vertex_patches[v]);
        f->wrong[v] = f->sides[v] != 0;
    }
}

/* ---- open components --------------------------------------------------------------------------------- */

/* Lists for each patch those across the curves at its border, and whether one changes sides there: whether the edge between them crosses
 * open surfaces an odd number of times. */
static bool list_neighbours(lens_finder *f, const cscd_curves *curves) {
    const cscd_mesh *mesh = f->w->mesh;
    f->entry_counts[0] = 0;
    for (size_t i = 0; i < curves->point_count; i++) {
        const cscd_curve_point *p = &curves->points[i];
        if (p->edge == UINT32_MAX) continue;
        if (!lens_finder_add(f, 0, p->edge, is_open(mesh, p->triangle))) return false;
    }
    if (!lens_finder_sort(f, 0)) return false;
    const size_t count = f->entry_counts[0];
    f->entry_counts[1] = 0;
    for (size_t i = 0; i < count;) {
        const uint32_t edge = entry_patch(f->entries[0][i]);
        uint32_t parity = 0;
        for (; i < count && entry_patch(f->entries[0][i]) == edge; i++)
            parity ^= entry_number(f->entries[0][i]);
        const uint32_t a = f->patches[mesh->edges[edge][0]], b = f->patches[mesh->edges[edge][1]];
        /* the colour is in the lowest bit */
        if (!lens_finder_add(f, 1, a, b << 1 | parity) || !lens_finder_add(f, 1, b, a << 1 | parity))
            return false;
    }
    return lens_finder_sort(f, 1);
}

enum { NO_COLOUR = 2 };

/* Colours what is reached from a patch over curves; where colours contradict each other, the first one stays. The smaller colour is
 * wrong. */
static void colour_group(lens_finder *f, uint32_t root) {
    double areas[2] = {0.0, 0.0};
    uint32_t count = 0;
    f->colours[root] = 0;
    f->queue[count++] = root;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t patch = f->queue[i], colour = f->colours[patch];
        areas[colour] += f->areas[patch];
        for (size_t k = lens_finder_first(f, 1, patch);
             k < f->entry_counts[1] && entry_patch(f->entries[1][k]) == patch; k++) {
            const uint32_t other = entry_number(f->entries[1][k]) >> 1,
                           parity = entry_number(f->entries[1][k]) & 1;
            if (f->colours[other] != NO_COLOUR) continue;
            f->colours[other] = colour ^ parity;
            f->queue[count++] = other;
        }
    }
    const uint32_t wrong = areas[1] > areas[0] ? 0 : 1;
    for (uint32_t i = 0; i < count; i++) f->colours[f->queue[i]] = f->colours[f->queue[i]] == wrong;
}

/* Sorts the patches at curves, the largest first. */
static bool list_by_area(lens_finder *f, uint32_t *count) {
    typedef struct sized_patch {
        uint64_t key; /* an area, as the number that its bits are, of which larger ones are smaller */
        uint64_t patch;
    } sized_patch;
    const size_t entries = f->entry_counts[1];
    sized_patch *patches = context_reserve(f->w->context, 2 * entries, sizeof *patches);
    if (patches == NULL) return false;
    *count = 0;
    for (size_t i = 0; i < entries; i++) {
        const uint32_t patch = entry_patch(f->entries[1][i]);
        if (i > 0 && patch == entry_patch(f->entries[1][i - 1])) continue;
        uint64_t bits;
        memcpy(&bits, &f->areas[patch], sizeof bits);
        patches[(*count)++] = (sized_patch){~bits, patch};
    }
    sort_by_number(patches, patches + entries, *count, sizeof *patches);
    for (uint32_t i = 0; i < *count; i++) f->distances[i] = (uint32_t)patches[i].patch;
    context_free(f->w->context, patches);
    return true;
}

/* The largest patches come first, since the first colour of a contradiction stays. */
static bool colour_patches(lens_finder *f) {
    const cscd_mesh *mesh = f->w->mesh;
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        f->colours[v] = NO_COLOUR;
        f->areas[v] = 0.0;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (f->w->graph.names[v] == v) f->areas[f->patches[v]] += f->w->graph.masses[v];
    }
    if (!list_by_area(f, &count)) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (f->colours[f->distances[i]] == NO_COLOUR) colour_group(f, f->distances[i]);
    }
    return true;
}

/* A patch counts if a curve bounds it. */
static void take_colours(lens_finder *f) {
    for (uint32_t v = 0; v < f->w->mesh->vertex_count; v++) {
        const uint32_t colour = f->colours[f->patches[v]];
        f->wrong[v] = colour != NO_COLOUR && (f->wrong[v] || colour == 1);
        f->reasons[v] = f->sides[v] > 0   ? CSCD_LENS_BURIED
                        : f->sides[v] < 0 ? CSCD_LENS_INSIDE_OUT
                                          : CSCD_LENS_SMALLER;
    }
}

/* ---- what is buried for the most part ---------------------------------------------------------------- */

static const double mostly = 0.55;

static void look_out(lens_finder *f) {
    const cscd_mesh *mesh = f->w->mesh;
    double *all = f->areas, *buried = f->areas + mesh->component_count;
    if (2 * (size_t)mesh->component_count > mesh->vertex_count) return;
    memset(all, 0, 2 * (size_t)mesh->component_count * sizeof *all);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t first = mesh->vertex_star_offsets[v];
        if (first == mesh->vertex_star_offsets[v + 1]) continue;
        const uint32_t component = mesh->triangle_components[mesh->vertex_stars[first]];
        all[component] += f->w->graph.masses[v];
        if (f->sides[v] > 0) buried[component] += f->w->graph.masses[v];
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t first = mesh->vertex_star_offsets[v];
        if (first == mesh->vertex_star_offsets[v + 1]) continue;
        const uint32_t component = mesh->triangle_components[mesh->vertex_stars[first]];
        if (!mesh->components[component].closed_manifold || !(buried[component] > mostly * all[component]))
            continue;
        f->wrong[v] = f->colours[f->patches[v]] != NO_COLOUR && f->sides[v] == 0;
        f->reasons[v] = CSCD_LENS_LOOKS_OUT;
    }
}

bool wrong_sides_find(lens_finder *f, const cscd_intersections *found) {
    count_crossings(f, found->curves);
    join_patches(f, found->patches);
    mark_buried(f, found->patches);
    if (!list_neighbours(f, found->curves) || !colour_patches(f)) return false;
    take_colours(f);
    look_out(f);
    f->wrong_count = 0;
    for (uint32_t v = 0; v < f->w->mesh->vertex_count; v++) f->wrong_count += f->wrong[v];
    return true;
}
