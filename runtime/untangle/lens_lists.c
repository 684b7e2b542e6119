/* The lists of a lens finder: wrong vertices, curves and partners of patches; triangles, each once; points. */
#include "runtime/untangle/lenses.h"

#include "src/core/sort.h"

static array_list list_arrays(lens_finder *f) {
    const cscd_mesh *mesh = f->w->mesh;
    const size_t n = mesh->vertex_count, t = mesh->triangle_count;
    return (array_list){{ARRAY(f->patches, n), ARRAY(f->wrong, n), ARRAY(f->reasons, n), ARRAY(f->folded, n),
                         ARRAY(f->sides, n), ARRAY(f->crossings, mesh->edge_count), ARRAY(f->stamps, t),
                         ARRAY(f->queue, n > t ? n : t), ARRAY(f->areas, n), ARRAY(f->colours, n),
                         ARRAY(f->distances, 2 * n)}};
}

bool lens_finder_make(lens_finder *f, untangle_work *w) {
    *f = (lens_finder){.w = w, .set = {.context = w->context}};
    return context_allocate_all(w->context, list_arrays(f));
}

void lens_finder_free(lens_finder *f) {
    cscd_context *context = f->w->context;
    context_free_all(context, list_arrays(f));
    for (int i = 0; i < LISTS; i++) context_free(context, f->entries[i]);
    context_free(context, f->triangles);
    context_free(context, f->points);
    triangle_set_free(&f->set);
}

/* Makes room for one more item of a list. */
static bool make_room(cscd_context *context, void **items, size_t count, size_t *capacity, size_t size) {
    if (count < *capacity) return true;
    const size_t more = room_with_spare(count);
    void *grown = context_grow(context, *items, count, more, size);
    if (grown == NULL) return false;
    *items = grown;
    *capacity = more;
    return true;
}

bool lens_finder_add(lens_finder *f, int list, uint32_t patch, uint32_t number) {
    void *items = f->entries[list];
    const bool room = make_room(f->w->context, &items, f->entry_counts[list], &f->entry_capacities[list],
                                sizeof(patch_entry));
    f->entries[list] = items;
    if (room) f->entries[list][f->entry_counts[list]++] = (patch_entry){(uint64_t)patch << 32 | number};
    return room;
}

bool lens_finder_sort(lens_finder *f, int list) {
    const size_t count = f->entry_counts[list];
    if (count < 2) return true;
    patch_entry *scratch = context_reserve(f->w->context, count, sizeof *scratch);
    if (scratch == NULL) return false;
    sort_by_number(f->entries[list], scratch, count, sizeof *scratch);
    context_free(f->w->context, scratch);
    return true;
}

size_t lens_finder_first(const lens_finder *f, int list, uint32_t patch) {
    size_t low = 0, high = f->entry_counts[list];
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (entry_patch(f->entries[list][middle]) < patch)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool lens_triangles_add(lens_finder *f, uint32_t triangle) {
    if (f->stamps[triangle] == f->stamp) return true;
    f->stamps[triangle] = f->stamp;
    void *items = f->triangles;
    const bool room =
        make_room(f->w->context, &items, f->triangle_count, &f->triangle_capacity, sizeof *f->triangles);
    f->triangles = items;
    if (room) f->triangles[f->triangle_count++] = triangle;
    return room;
}

void lens_triangles_begin(lens_finder *f) {
    f->triangle_count = 0;
    f->stamp++;
}

/* Adds the triangles around those that are there. */
bool lens_triangles_widen(lens_finder *f, uint32_t rings) {
    const cscd_mesh *mesh = f->w->mesh;
    size_t first = 0;
    for (uint32_t ring = 0; ring < rings; ring++) {
        const size_t end = f->triangle_count;
        for (size_t i = first; i < end; i++) {
            for (int k = 0; k < 3; k++) {
                const uint32_t v = mesh->triangles[f->triangles[i]][k];
                for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
                    if (!lens_triangles_add(f, mesh->vertex_stars[s])) return false;
                }
            }
        }
        first = end;
    }
    return true;
}

void lens_finder_unify(lens_finder *f, int list) {
    patch_entry *e = f->entries[list];
    size_t kept = 0;
    for (size_t i = 0; i < f->entry_counts[list]; i++) {
        if (kept == 0 || e[kept - 1].key != e[i].key) e[kept++] = e[i];
    }
    f->entry_counts[list] = kept;
}

bool lens_finder_add_point(lens_finder *f, const lens_point *point) {
    void *items = f->points;
    const bool room = make_room(f->w->context, &items, f->point_count, &f->point_capacity, sizeof *f->points);
    f->points = items;
    if (room) f->points[f->point_count++] = *point;
    return room;
}
