/* Makes tiles: what lies in one cell of a grid and is connected there. */
#include "preprocess/regions/tiles.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

enum { CELLS_A_SIDE = 1000 };

static array_list list_items(tile_graph *g) {
    return (array_list){{ARRAY(g->items, g->count), ARRAY(g->moved, (size_t)g->frame_count * g->count)}};
}

static array_list list_stiffness(tile_graph *g) {
    return (array_list){{ARRAY(g->stiffness, g->count)}};
}

static array_list list_links(tile_graph *g) {
    return (array_list){{ARRAY(g->offsets, (size_t)g->count + 1), ARRAY(g->neighbours, g->flow.link_count),
                         ARRAY(g->twins, g->flow.link_count), ARRAY(g->weights, g->flow.link_count)}};
}

/* ---- scaled triangles ---------------------------------------------------------------------------------- */

/* A component's positions in one frame, or at rest. */
typedef struct tile_frame {
    const double *positions;
    double middle[3]; /* of its box */
} tile_frame;

/* Finds the middle; returns the box's longest side. */
static double find_middle(const tile_surface *s, const tile_component *c, tile_frame *frame) {
    double extent = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < (size_t)c->count * 3; i++) {
            const double p = surface_corner(s->mesh, frame->positions, c->list[i / 3], (uint32_t)(i % 3))[k];
            low = fmin(low, p);
            high = fmax(high, p);
        }
        frame->middle[k] = 0.5 * low + 0.5 * high;
        extent = fmax(extent, high - low);
    }
    return extent;
}

static tile_frame rest_of(const tile_surface *s, const tile_component *c) {
    return (tile_frame){s->positions, {c->middle[0], c->middle[1], c->middle[2]}};
}

static void find_scale(const tile_surface *s, tile_component *c) {
    tile_frame rest = {.positions = s->positions};
    int exponent = 0;
    frexp(find_middle(s, c, &rest), &exponent);
    memcpy(c->middle, rest.middle, sizeof c->middle);
    c->scale = ldexp(1.0, -exponent);
}

/* The normal is as long as the area. */
static void scaled_triangle(const tile_surface *s, const tile_component *c, const tile_frame *frame,
                            uint32_t t, double centroid[3], double normal[3]) {
    double corners[3][3], u[3], v[3];
    for (uint32_t corner = 0; corner < 3; corner++) {
        const double *p = surface_corner(s->mesh, frame->positions, t, corner);
        for (int k = 0; k < 3; k++) corners[corner][k] = (p[k] - frame->middle[k]) * c->scale;
    }
    vec3_subtract(corners[1], corners[0], u);
    vec3_subtract(corners[2], corners[0], v);
    vec3_cross(u, v, normal);
    for (int k = 0; k < 3; k++) {
        normal[k] *= 0.5;
        centroid[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0;
    }
}

tile_component tiles_component(const tile_surface *surface, const uint32_t *list, uint32_t count) {
    tile_component c = {.list = list, .count = count};
    double centroid[3], normal[3];
    find_scale(surface, &c);
    const tile_frame rest = rest_of(surface, &c);
    for (uint32_t i = 0; i < count; i++) {
        scaled_triangle(surface, &c, &rest, list[i], centroid, normal);
        c.area += surface_norm(normal);
    }
    if (count <= TILES_WANTED) return c;
    c.side = fmax(sqrt(c.area / TILES_WANTED), 1.0 / CELLS_A_SIDE);
    c.least_side = sqrt(c.area / count);
    return c;
}

/* ---- numbers of tiles ---------------------------------------------------------------------------------- */

static uint32_t cell_along(double coordinate, double side) {
    return (uint32_t)((coordinate + 0.5) / side);
}

uint32_t tiles_number(const tile_surface *surface, tile_component *component, uint32_t *tile_of,
                      uint32_t *scratch) {
    double p[3], normal[3];
    const tile_frame rest = rest_of(surface, component);
    for (uint32_t i = 0; i < component->count; i++) {
        const uint32_t t = component->list[i];
        tile_of[t] = i;
        if (component->side == 0.0) continue;
        scaled_triangle(surface, component, &rest, t, p, normal);
        tile_of[t] = 0;
        for (int k = 0; k < 3; k++) tile_of[t] = tile_of[t] * 1024 + cell_along(p[k], component->side);
    }
    if (component->side == 0.0) return component->count;
    return dual_graph_pieces(surface->graph, component->list, component->count, tile_of, tile_of, scratch);
}

uint32_t tiles_halve(const tile_surface *surface, tile_component *component, const bool *marked,
                     uint32_t *tile_of, uint32_t *scratch) {
    double p[3], normal[3];
    const tile_frame rest = rest_of(surface, component);
    component->side *= 0.5;
    for (uint32_t i = 0; i < component->count; i++) {
        const uint32_t t = component->list[i];
        uint32_t octant = 0;
        scaled_triangle(surface, component, &rest, t, p, normal);
        for (int k = 0; k < 3 && marked[tile_of[t]]; k++)
            octant = octant * 2 + cell_along(p[k], component->side) % 2;
        tile_of[t] = tile_of[t] * 8 + octant;
    }
    return dual_graph_pieces(surface->graph, component->list, component->count, tile_of, tile_of, scratch);
}

/* ---- the tiles ----------------------------------------------------------------------------------------- */

static void add_triangle(const tile_surface *s, const tile_component *c, const tile_frame *frame, uint32_t t,
                         tile *to) {
    double centroid[3], normal[3];
    scaled_triangle(s, c, frame, t, centroid, normal);
    const double area = surface_norm(normal);
    to->area += area;
    for (int k = 0; k < 3; k++) {
        to->centroid[k] += area * centroid[k];
        to->normal[k] += normal[k];
        to->height += centroid[k] * normal[k];
    }
}

/* Makes the tiles of one frame. */
static void fill_tiles(const tile_surface *s, const tile_component *c, const tile_frame *frame,
                       const uint32_t *tile_of, tile *items, uint32_t count) {
    for (uint32_t i = 0; i < c->count; i++)
        add_triangle(s, c, frame, c->list[i], &items[tile_of[c->list[i]]]);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) items[i].centroid[k] /= items[i].area > 0.0 ? items[i].area : 1.0;
}

static void turn_tiles(tile *items, size_t count) {
    for (size_t i = 0; i < count; i++) {
        items[i].height = -items[i].height;
        for (int k = 0; k < 3; k++) items[i].normal[k] = -items[i].normal[k];
    }
}

static void fill_frames(const tile_surface *s, const tile_component *c, const uint32_t *tile_of,
                        tile_graph *g) {
    const tile_frame rest = rest_of(s, c);
    double volume = 0.0;
    fill_tiles(s, c, &rest, tile_of, g->items, g->count);
    for (uint32_t f = 0; f < g->frame_count; f++) {
        tile_frame frame = {.positions = s->frames[f]};
        find_middle(s, c, &frame);
        fill_tiles(s, c, &frame, tile_of, g->moved + (size_t)f * g->count, g->count);
    }
    for (uint32_t i = 0; i < g->count; i++) {
        g->area += g->items[i].area;
        volume += g->items[i].height;
    }
    g->turned = volume < 0.0;
    if (!g->turned) return;
    turn_tiles(g->items, g->count);
    turn_tiles(g->moved, (size_t)g->frame_count * g->count);
}

static bool any_soft(const tile_surface *s, const tile_component *c) {
    for (uint32_t i = 0; i < c->count && s->stiffness != NULL; i++)
        if (s->stiffness[c->list[i]] < 1.0) return true;
    return false;
}

/* Finds the means of the triangles of each tile; a tile without area is stiff. */
static cscd_status fill_stiffness(const tile_surface *s, const tile_component *c, const uint32_t *tile_of,
                                  tile_graph *g) {
    const tile_frame rest = rest_of(s, c);
    double centroid[3], normal[3];
    if (!any_soft(s, c)) return CSCD_OK;
    if (!context_allocate_all(g->context, list_stiffness(g))) return context_out_of_memory(g->context);
    for (uint32_t i = 0; i < c->count; i++) {
        scaled_triangle(s, c, &rest, c->list[i], centroid, normal);
        g->stiffness[tile_of[c->list[i]]] += surface_norm(normal) * s->stiffness[c->list[i]];
    }
    for (uint32_t i = 0; i < g->count; i++)
        g->stiffness[i] = g->items[i].area > 0.0 ? g->stiffness[i] / g->items[i].area : 1.0;
    return CSCD_OK;
}

/* ---- links --------------------------------------------------------------------------------------------- */

typedef struct tile_link {
    uint32_t a, b; /* a < b */
    double weight;
} tile_link;

static int by_tiles(const void *left, const void *right) {
    const tile_link *x = left, *y = right;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

/* Lists the edges between tiles, or only counts them; where tiles meet at a vertex only, the link has no weight. */
static uint32_t list_edges(const tile_surface *s, const tile_component *c, const uint32_t *tile_of,
                           tile_link *links) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t t = c->list[i];
        for (uint32_t j = s->graph->offsets[t]; j < s->graph->offsets[t + 1]; j++) {
            const uint32_t a = tile_of[t], b = tile_of[s->graph->neighbours[j]], edge = s->graph->edges[j];
            if (a >= b) continue;
            if (links != NULL)
                links[found] = (tile_link){a, b, edge == DUAL_NO_EDGE ? 0.0 : s->weights[edge] * c->scale};
            found++;
        }
    }
    return found;
}

/* Joins the links between the same tiles; returns how many are left. */
static uint32_t join_links(tile_link *links, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (kept > 0 && by_tiles(&links[kept - 1], &links[i]) == 0)
            links[kept - 1].weight += links[i].weight;
        else
            links[kept++] = links[i];
    }
    return kept;
}

static void put_links(const tile_link *links, uint32_t count, tile_graph *g) {
    uint32_t *offsets = g->offsets;
    for (uint32_t i = 0; i < count; i++) {
        offsets[links[i].a + 1]++;
        offsets[links[i].b + 1]++;
    }
    for (uint32_t p = 0; p < g->count; p++) offsets[p + 1] += offsets[p];
    for (uint32_t i = 0; i < count; i++) { /* offsets[p] moves to the end of p's links */
        const uint32_t forth = offsets[links[i].a]++, back = offsets[links[i].b]++;
        g->neighbours[forth] = links[i].b;
        g->neighbours[back] = links[i].a;
        g->weights[forth] = g->weights[back] = links[i].weight;
        g->twins[forth] = back;
        g->twins[back] = forth;
    }
    for (uint32_t p = g->count; p > 0; p--) offsets[p] = offsets[p - 1];
    offsets[0] = 0;
    g->flow = (flow_graph){g->count, 2 * count, g->offsets, g->neighbours, g->twins};
}

static cscd_status link_tiles(const tile_surface *s, const tile_component *c, const uint32_t *tile_of,
                              tile_graph *g) {
    cscd_context *context = g->context;
    uint32_t found = list_edges(s, c, tile_of, NULL);
    tile_link *links = context_reserve(context, 2 * (size_t)found + 1, sizeof *links);
    if (links == NULL) return context_out_of_memory(context);
    list_edges(s, c, tile_of, links);
    sort_items(links, links + found, found, sizeof *links, by_tiles);
    found = join_links(links, found);
    g->flow.link_count = 2 * found;
    cscd_status status = CSCD_OK;
    if (context_allocate_all(context, list_links(g)))
        put_links(links, found, g);
    else
        status = context_out_of_memory(context);
    context_free(context, links);
    return status;
}

cscd_status tiles_create(const tile_surface *surface, const tile_component *component,
                         const uint32_t *tile_of, uint32_t tile_count, tile_graph *out) {
    cscd_context *context = surface->mesh->context;
    *out = (tile_graph){.context = context, .count = tile_count, .frame_count = surface->frame_count};
    if (!context_allocate_all(context, list_items(out))) return context_out_of_memory(context);
    fill_frames(surface, component, tile_of, out);
    cscd_status status = fill_stiffness(surface, component, tile_of, out);
    if (status == CSCD_OK) status = link_tiles(surface, component, tile_of, out);
    if (status != CSCD_OK) tiles_destroy(out);
    return status;
}

void tiles_destroy(tile_graph *g) {
    if (g->context == NULL) return;
    context_free_all(g->context, list_items(g));
    context_free_all(g->context, list_stiffness(g));
    context_free_all(g->context, list_links(g));
    *g = (tile_graph){0};
}
