/* The other sheet of a wrong patch: the triangles along its curves, and the patches beyond them. */
#include "runtime/untangle/lenses.h"

/* Adds the wrong patches of one sheet of a curve to a list, as (patch, number), perhaps more than once. */
static bool add_patches(lens_finder *f, const cscd_curves *curves, size_t curve, int sheet, int list,
                        uint32_t number) {
    const cscd_curve *c = &curves->items[curve];
    uint32_t last = UINT32_MAX;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        const uint32_t *corners = f->w->mesh->triangles[curve_piece_triangle(curves, i, sheet)];
        for (int k = 0; k < 3; k++) {
            if (!f->wrong[corners[k]] || f->patches[corners[k]] == last) continue;
            last = f->patches[corners[k]];
            if (!lens_finder_add(f, list, last, number)) return false;
        }
    }
    return true;
}

/* Lists for each wrong patch its vertices, and its curves, twice the number plus the sheet. */
bool lens_patches_list(lens_finder *f, const cscd_curves *curves) {
    for (int i = 0; i < LISTS; i++) f->entry_counts[i] = 0;
    for (uint32_t v = 0; v < f->w->mesh->vertex_count; v++) {
        if (f->wrong[v] && !lens_finder_add(f, OF_VERTICES, f->patches[v], v)) return false;
    }
    for (size_t i = 0; i < curves->count; i++) {
        for (int sheet = 0; sheet < 2; sheet++) {
            if (!add_patches(f, curves, i, sheet, OF_CURVES, (uint32_t)(2 * i) + (uint32_t)sheet))
                return false;
        }
    }
    if (!lens_finder_sort(f, OF_VERTICES) || !lens_finder_sort(f, OF_CURVES)) return false;
    lens_finder_unify(f, OF_CURVES);
    return true;
}

/* The triangles in which the points of a patch look for their places: along its curves, those of the other sheets, and the wrong
 * patches there; but none with a corner in the patch. */
bool lens_triangles_choose(lens_finder *f, const cscd_curves *curves, uint32_t patch, uint32_t rings) {
    const cscd_mesh *mesh = f->w->mesh;
    lens_triangles_begin(f);
    f->entry_counts[OF_PARTNERS] = 0;
    for (size_t i = lens_finder_first(f, OF_CURVES, patch);
         i < f->entry_counts[OF_CURVES] && entry_patch(f->entries[OF_CURVES][i]) == patch; i++) {
        const size_t curve = entry_number(f->entries[OF_CURVES][i]) / 2;
        const int other = 1 - (int)(entry_number(f->entries[OF_CURVES][i]) & 1);
        const cscd_curve *c = &curves->items[curve];
        for (size_t p = c->first_piece; p < c->first_piece + c->piece_count; p++) {
            if (!lens_triangles_add(f, curve_piece_triangle(curves, p, other))) return false;
        }
        if (!add_patches(f, curves, curve, other, OF_PARTNERS, 0)) return false;
    }
    if (!lens_triangles_widen(f, rings)) return false;
    if (!lens_finder_sort(f, OF_PARTNERS)) return false;
    lens_finder_unify(f, OF_PARTNERS);
    for (size_t i = 0; i < f->entry_counts[OF_PARTNERS]; i++) {
        const uint32_t partner = entry_patch(f->entries[OF_PARTNERS][i]);
        for (size_t k = lens_finder_first(f, OF_VERTICES, partner);
             k < f->entry_counts[OF_VERTICES] && entry_patch(f->entries[OF_VERTICES][k]) == partner; k++) {
            const uint32_t v = entry_number(f->entries[OF_VERTICES][k]);
            for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
                if (!lens_triangles_add(f, mesh->vertex_stars[s])) return false;
            }
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < f->triangle_count; i++) {
        const uint32_t *corners = mesh->triangles[f->triangles[i]];
        const bool own = f->patches[corners[0]] == patch || f->patches[corners[1]] == patch ||
                         f->patches[corners[2]] == patch;
        if (!own) f->triangles[kept++] = f->triangles[i];
    }
    f->triangle_count = kept;
    return true;
}
