/* Culling and start states that move over to another mesh: untouched components keep what they have. */
#include "runtime/culling/culling.h"

#include <string.h>

/* ---- regions ------------------------------------------------------------------------------------------- */

static array_list region_arrays(region_move *m, const cscd_mesh_change *change) {
    return (array_list){{ARRAY(m->to_new, m->old_count),
                         ARRAY(m->of_components, change->components.new_count),
                         ARRAY(m->fresh, m->fresh_count)}};
}

static uint32_t count_touched(const cscd_mesh_change *change) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < change->components.new_count; c++)
        count += change->components.to_old[c] == UINT32_MAX;
    return count;
}

/* A region lies in one component, so each of its triangles says the same. Objects that have not changed keep all of
 * their regions. */
static void keep_regions(const culling *c, const cscd_mesh_change *change, region_move *m) {
    memset(m->to_new, 0xff, m->old_count * sizeof *m->to_new);
    for (uint32_t i = 0; i < change->run_count; i++) {
        const uint32_t *regions = c->triangle_regions + change->runs[i].from.triangle;
        for (uint32_t t = 0; t < change->runs[i].from.triangle_count; t++) m->to_new[regions[t]] = 0;
    }
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
            if (change->components.to_old[change->mesh->triangle_components[t]] != UINT32_MAX)
                m->to_new[c->triangle_regions[change->triangles.to_old[t]]] = 0;
        }
    }
    for (uint32_t r = 0; r < m->old_count; r++) {
        if (m->to_new[r] != UINT32_MAX) m->to_new[r] = m->kept_count++;
    }
}

static void add_regions(const cscd_mesh_change *change, region_move *m) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < change->components.new_count; c++) {
        const cscd_component *component = &change->mesh->components[c];
        m->of_components[c] = UINT32_MAX;
        if (change->components.to_old[c] != UINT32_MAX) continue;
        m->of_components[c] = m->kept_count + count;
        m->fresh[count] = (fresh_region){.region = m->kept_count + count,
                                         .triangle_count = component->triangle_count,
                                         .vertex_count = component->vertex_count,
                                         .after = UINT32_MAX};
        count++;
    }
}

/* A new region takes the place of the one that its first old triangle was in. */
static void place_regions(const culling *c, const cscd_mesh_change *change, region_move *m) {
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
            uint32_t region = m->of_components[change->mesh->triangle_components[t]];
            uint32_t origin = change->triangles.to_old[t];
            if (region == UINT32_MAX || origin == UINT32_MAX) continue;
            fresh_region *fresh = &m->fresh[region - m->kept_count];
            if (fresh->after == UINT32_MAX) fresh->after = c->triangle_regions[origin];
        }
    }
}

cscd_status region_move_find(cscd_context *context, const culling *c, const cscd_mesh_change *change,
                             region_move *out) {
    region_move m = {.old_count = c->region_count, .fresh_count = count_touched(change)};
    if (!context_allocate_all(context, region_arrays(&m, change))) return CSCD_OUT_OF_MEMORY;
    keep_regions(c, change, &m);
    add_regions(change, &m);
    place_regions(c, change, &m);
    *out = m;
    return CSCD_OK;
}

void region_move_free(cscd_context *context, region_move *m) {
    context_free(context, m->to_new);
    context_free(context, m->of_components);
    context_free(context, m->fresh);
    *m = (region_move){.old_count = 0};
}

/* ---- culling ------------------------------------------------------------------------------------------- */

static void move_run(const culling *c, const object_run *run, const region_move *regions, culling *out) {
    const uint32_t *from = c->triangle_regions + run->from.triangle;
    uint32_t *to = out->triangle_regions + run->to.triangle;
    for (uint32_t i = 0; i < run->from.triangle_count; i++) to[i] = regions->to_new[from[i]];
    memcpy(out->triangle_weights + run->to.triangle, c->triangle_weights + run->from.triangle,
           run->from.triangle_count * sizeof *out->triangle_weights);
}

static void move_triangle(const culling *c, const cscd_mesh_change *change, const region_move *regions,
                          uint32_t triangle, culling *out) {
    uint32_t component = change->mesh->triangle_components[triangle],
             origin = change->triangles.to_old[triangle];
    bool touched = regions->of_components[component] != UINT32_MAX;
    out->triangle_regions[triangle] =
        touched ? regions->of_components[component] : regions->to_new[c->triangle_regions[origin]];
    out->triangle_weights[triangle] =
        touched ? 1.0 / change->mesh->components[component].triangle_count : c->triangle_weights[origin];
}

cscd_status culling_move(const culling *c, const cscd_mesh *mesh, const cscd_mesh_change *change,
                         const region_move *regions, culling *out) {
    culling moved = {
        .context = mesh->context, .mesh = mesh, .region_count = regions->kept_count + regions->fresh_count};
    if (!context_reserve_all(moved.context, culling_arrays(&moved))) return CSCD_OUT_OF_MEMORY;
    memset(moved.detector_points, 0, moved.region_count * sizeof *moved.detector_points);
    memset(moved.detector_offsets, 0, moved.region_count * sizeof *moved.detector_offsets);
    memset(moved.earlier, ORIENTATION_ZERO, mesh->triangle_count);
    for (uint32_t i = 0; i < change->run_count; i++) move_run(c, &change->runs[i], regions, &moved);
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        for (uint32_t t = 0; t < range->triangle_count; t++)
            move_triangle(c, change, regions, range->triangle + t, &moved);
    }
    for (uint32_t r = 0; r < regions->old_count; r++) {
        if (regions->to_new[r] == UINT32_MAX) continue;
        memcpy(moved.detector_offsets[regions->to_new[r]], c->detector_offsets[r],
               sizeof *c->detector_offsets);
    }
    culling_clear(&moved);
    *out = moved;
    return CSCD_OK;
}

/* ---- start states -------------------------------------------------------------------------------------- */

static void move_states_of_run(const start_states *s, const object_run *run, start_states *out) {
    memcpy(out->positions + (size_t)run->to.vertex * 3, s->positions + (size_t)run->from.vertex * 3,
           run->from.vertex_count * sizeof(double[3]));
    memcpy(out->triangles + run->to.triangle, s->triangles + run->from.triangle, run->from.triangle_count);
}

/* All bits set are no number, so that a vertex counts as moved whatever its position is. */
static void move_states_of_object(const start_states *s, const object_range *range,
                                  const cscd_mesh_change *change, start_states *out) {
    const cscd_mesh *mesh = change->mesh;
    memset(out->triangles + range->triangle, TRIANGLE_UNKNOWN, range->triangle_count);
    memset(out->positions + (size_t)range->vertex * 3, 0xff, range->vertex_count * sizeof(double[3]));
    for (uint32_t t = range->triangle; t < range->triangle + range->triangle_count; t++) {
        if (change->components.to_old[mesh->triangle_components[t]] == UINT32_MAX) continue;
        uint32_t origin = change->triangles.to_old[t];
        out->triangles[t] = s->triangles[origin];
        for (int i = 0; i < 3; i++)
            memcpy(out->positions + (size_t)mesh->triangles[t][i] * 3,
                   s->positions + (size_t)change->old_mesh->triangles[origin][i] * 3, sizeof(double[3]));
    }
}

cscd_status start_states_move(const start_states *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                              start_states *out) {
    if (!s->known) {
        cscd_status status = start_states_create(mesh, out);
        if (status == CSCD_OK) out->adapts = s->adapts;
        return status;
    }
    start_states moved = {.context = mesh->context, .mesh = mesh, .known = true};
    if (!context_reserve_all(moved.context, start_states_arrays(&moved))) return CSCD_OUT_OF_MEMORY;
    for (uint32_t c = 0; c < mesh->component_count; c++) component_start_begin(&moved.of[c]);
    moved.partly = s->partly || change->described_count > 0;
    moved.vouched = s->vouched;
    moved.share_worth_it = s->share_worth_it;
    moved.adapts = s->adapts;
    for (uint32_t i = 0; i < change->run_count; i++) move_states_of_run(s, &change->runs[i], &moved);
    for (uint32_t i = 0; i < change->described_count; i++)
        move_states_of_object(s, &change->described[i], change, &moved);
    for (uint32_t c = 0; c < change->components.new_count; c++) {
        uint32_t origin = change->components.to_old[c];
        if (origin == UINT32_MAX) continue;
        moved.of[c] = s->of[origin];
    }
    *out = moved;
    return CSCD_OK;
}
