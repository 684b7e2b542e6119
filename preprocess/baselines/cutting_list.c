/* The cuttingList of the thesis (Yeh 2012, section 3.3), its contours, and how it grows and shrinks. */
#include "preprocess/baselines/published_cuts.h"

static array_list list_arrays(cutting_list *c) {
    const size_t n = c->mesh->triangle_count;
    return (array_list){{ARRAY(c->triangles, n), ARRAY(c->listed, n), ARRAY(c->side_contours, n),
                         ARRAY(c->ring, n), ARRAY(c->stack, n), ARRAY(c->seen, n)}};
}

cscd_status cutting_list_create(const cscd_mesh *mesh, cutting_list *out) {
    cutting_list c = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, list_arrays(&c))) return context_out_of_memory(mesh->context);
    *out = c;
    return CSCD_OK;
}

void cutting_list_destroy(cutting_list *c) {
    if (c->mesh != NULL) context_free_all(c->mesh->context, list_arrays(c));
    *c = (cutting_list){.mesh = NULL};
}

static void add_triangle(cutting_list *c, uint32_t triangle) {
    c->triangles[c->count++] = triangle;
    c->listed[triangle] = true;
}

void cutting_list_begin(cutting_list *c, const uint32_t *cluster, uint32_t count) {
    for (uint32_t i = 0; i < c->count; i++) c->listed[c->triangles[i]] = false;
    c->count = c->contour_count = 0;
    for (uint32_t i = 0; i < count; i++) add_triangle(c, cluster[i]);
}

/* ---- islands ------------------------------------------------------------------------------------------- */

/* Marks the triangles beyond a side, up to `most` and one, and puts them into the ring from *end on. True:
 * these are all, so they are an island. Triangles that touch others which were marked before are a part of a
 * larger piece. */
static bool find_island(cutting_list *c, uint32_t first, uint32_t most, uint32_t *end) {
    const uint32_t begin = *end;
    c->seen[first] = true;
    c->ring[(*end)++] = first;
    for (uint32_t i = begin; i < *end; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t next = triangle_beyond(c->mesh, c->ring[i], k);
            if (c->listed[next]) continue;
            bool own = false;
            for (uint32_t j = begin; c->seen[next] && j < *end && !own; j++) own = c->ring[j] == next;
            if (own) continue;
            if (c->seen[next] || *end - begin > most) return false;
            c->seen[next] = true;
            c->ring[(*end)++] = next;
        }
    }
    return *end - begin <= most;
}

void cutting_list_fill(cutting_list *c, uint32_t most) {
    const uint32_t count = c->count;
    uint32_t end = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t beyond = triangle_beyond(c->mesh, c->triangles[i], k), begin = end;
            if (c->listed[beyond] || c->seen[beyond]) continue;
            if (!find_island(c, beyond, most, &end)) continue;
            for (uint32_t j = begin; j < end; j++) add_triangle(c, c->ring[j]);
        }
    }
    for (uint32_t i = 0; i < end; i++) c->seen[c->ring[i]] = false;
}

/* ---- contours ------------------------------------------------------------------------------------------ */

static bool bounds_list(const cutting_list *c, uint32_t triangle, uint32_t side) {
    return !c->listed[triangle_beyond(c->mesh, triangle, side)];
}

/* Follows one contour. From the end of a side it turns about that vertex, through the triangles of the list, to the next side that
 * bounds the list. So a contour that meets itself at a vertex does not cross itself there. */
static void follow_contour(cutting_list *c, uint32_t triangle, uint32_t side, uint32_t number) {
    const cscd_mesh *mesh = c->mesh;
    while (c->side_contours[triangle][side] == NO_CONTOUR) {
        c->side_contours[triangle][side] = number;
        side = (side + 1) % 3;
        while (!bounds_list(c, triangle, side)) {
            const uint32_t edge = mesh->triangle_edges[triangle][side];
            triangle = triangle_beyond(mesh, triangle, side);
            side = (side_of_edge(mesh, triangle, edge) + 1) % 3;
        }
    }
}

void cutting_list_trace(cutting_list *c) {
    c->contour_count = 0;
    for (uint32_t i = 0; i < c->count; i++)
        for (int k = 0; k < 3; k++) c->side_contours[c->triangles[i]][k] = NO_CONTOUR;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t t = c->triangles[i];
        for (uint32_t k = 0; k < 3; k++) {
            if (c->side_contours[t][k] == NO_CONTOUR && bounds_list(c, t, k))
                follow_contour(c, t, k, c->contour_count++);
        }
    }
}

/* ---- growing ------------------------------------------------------------------------------------------- */

/* Lists the triangles outside that share a vertex with those of the list from `first` on: those before it have no neighbours
 * outside any more. */
static void list_ring(cutting_list *c, uint32_t first) {
    const cscd_mesh *mesh = c->mesh;
    c->ring_count = 0;
    for (uint32_t i = first; i < c->count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t v = mesh->triangles[c->triangles[i]][k];
            for (uint32_t j = mesh->vertex_star_offsets[v]; j < mesh->vertex_star_offsets[v + 1]; j++) {
                const uint32_t t = mesh->vertex_stars[j];
                if (c->listed[t] || c->seen[t]) continue;
                c->seen[t] = true;
                c->ring[c->ring_count++] = t;
            }
        }
    }
}

/* In how many pieces does the ring lie, whose triangles are joined by edges? Takes back their marks. */
static uint32_t count_pieces(cutting_list *c) {
    uint32_t pieces = 0;
    for (uint32_t i = 0; i < c->ring_count; i++) {
        uint32_t depth = 0;
        if (!c->seen[c->ring[i]]) continue;
        pieces++;
        c->seen[c->ring[i]] = false;
        c->stack[depth++] = c->ring[i];
        while (depth > 0) {
            const uint32_t t = c->stack[--depth];
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t next = triangle_beyond(c->mesh, t, k);
                if (!c->seen[next]) continue;
                c->seen[next] = false;
                c->stack[depth++] = next;
            }
        }
    }
    return pieces;
}

bool cutting_list_grow(cutting_list *c) {
    for (uint32_t first = 0;;) {
        list_ring(c, first);
        const uint32_t pieces = count_pieces(c);
        if (pieces != 1) return pieces > 1;
        first = c->count;
        for (uint32_t i = 0; i < c->ring_count; i++) add_triangle(c, c->ring[i]);
    }
}

/* ---- shrinking ----------------------------------------------------------------------------------------- */

/* The only contour that a triangle has sides on; NO_CONTOUR: it has none, or sides on two, and is a cutting triangle. */
static uint32_t only_contour(const cutting_list *c, uint32_t triangle) {
    uint32_t found = NO_CONTOUR;
    for (int k = 0; k < 3; k++) {
        const uint32_t number = c->side_contours[triangle][k];
        if (number == NO_CONTOUR) continue;
        if (found != NO_CONTOUR && number != found) return NO_CONTOUR;
        found = number;
    }
    return found;
}

/* Takes a triangle away; its contour goes along its other sides now. Queues the neighbours that it reaches. */
static uint32_t shrink_triangle(cutting_list *c, uint32_t triangle, uint32_t number, uint32_t end) {
    const cscd_mesh *mesh = c->mesh;
    c->listed[triangle] = false;
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t next = triangle_beyond(mesh, triangle, k);
        if (!c->listed[next]) continue;
        c->side_contours[next][side_of_edge(mesh, next, mesh->triangle_edges[triangle][k])] = number;
        if (c->seen[next]) continue;
        c->seen[next] = true;
        c->ring[end++] = next;
    }
    return end;
}

/* All contours move at the same pace, a triangle after the other in the order in which contours reach them. Each triangle waits
 * once: when its turn comes it goes or has sides on two contours, and that stays so. */
void cutting_list_shrink(cutting_list *c) {
    uint32_t end = 0, kept = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t t = c->triangles[i];
        bool at_contour = false;
        for (int k = 0; k < 3; k++) at_contour |= c->side_contours[t][k] != NO_CONTOUR;
        if (!at_contour) continue;
        c->seen[t] = true;
        c->ring[end++] = t;
    }
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t number = only_contour(c, c->ring[i]);
        if (number != NO_CONTOUR) end = shrink_triangle(c, c->ring[i], number, end);
    }
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t t = c->triangles[i];
        c->seen[t] = false;
        if (c->listed[t]) c->triangles[kept++] = t;
    }
    c->count = kept;
}
