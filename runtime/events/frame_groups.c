/* One frame: what was found in it, joined to groups. */
#include "runtime/events/events.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* The work on one frame. */
typedef struct frame_grouping {
    frame_groups *groups;
    cscd_context *context;
    const cscd_mesh *mesh;
    const part_labels *labels;
    const mesh_rings *rings;
    const frame_input *input;
    bool no_memory;
} frame_grouping;

static array_list list_group_arrays(frame_groups *g) {
    size_t room = room_with_spare(g->group_count);
    return (array_list){{ARRAY(g->groups, room), ARRAY(g->times, room), ARRAY(g->ranks, room)}};
}

void frame_groups_free(cscd_context *context, frame_groups *g) {
    context_free(context, g->things);
    context_free(context, g->stamped);
    context_free(context, g->stamped_places);
    stamp_table_free(context, &g->stamps);
    context_free_all(context, list_group_arrays(g));
    *g = (frame_groups){.things = NULL};
}

double curve_piece_length(const cscd_curves *curves, const cscd_curve *curve, size_t piece) {
    const cscd_curve_point *points = &curves->points[curve->first_point];
    return sqrt(vec3_squared_distance(points[piece].x, points[(piece + 1) % curve->point_count].x));
}

/* ---- things that are joined ----------------------------------------------------------------------------- */

static uint32_t root_of_thing(group_thing *things, uint32_t x) {
    while (things[x].parent != x) {
        things[x].parent = things[things[x].parent].parent;
        x = things[x].parent;
    }
    return x;
}

static void join_things(frame_grouping *w, uint32_t x, uint32_t y) {
    group_thing *things = w->groups->things;
    uint32_t a = root_of_thing(things, x), b = root_of_thing(things, y);
    things[a < b ? b : a].parent = a < b ? a : b;
}

/* A stamp is in a table that grows to twice its length, has two places to four in it by its hash, and goes on in the history. */
enum { STAMP_SIZE = 4 * (MEMORY_WHILE_DOUBLING * sizeof(stamp) + 8 * sizeof(uint32_t)) };

static void stamp_element(frame_grouping *w, uint64_t parts, uint32_t element, uint32_t thing) {
    stamp_table *table = &w->groups->stamps;
    const stamp *known = stamp_table_find(table, parts, element);
    if (known != NULL)
        join_things(w, known->owner, thing);
    else if (memory_budget_take(w->input->budget, 1, STAMP_SIZE) && stamp_table_reserve(w->context, table, 1))
        stamp_table_add(table, (stamp){parts, 0, element, thing});
    else
        w->no_memory = true;
}

static void note_origin(group_thing *thing, uint64_t origin) {
    if (origin < thing->origin) thing->origin = origin;
}

/* A triangle is mostly in several things of one pair of parts, which are joined without looking at its vertices. */
static bool was_stamped(frame_grouping *w, uint32_t triangle, uint64_t parts, uint32_t thing) {
    frame_groups *g = w->groups;
    uint32_t place = g->stamped_places[triangle];
    if (place >= g->stamped_count || g->stamped[place].triangle != triangle) {
        place = (uint32_t)g->stamped_count;
        if (place == g->stamped_capacity) return false;
        g->stamped_places[triangle] = place;
        g->stamped[g->stamped_count++] = (stamped_triangle){parts, triangle, thing};
        return false;
    }
    stamped_triangle *known = &g->stamped[place];
    if (known->parts == parts) {
        join_things(w, known->thing, thing);
        return true;
    }
    *known = (stamped_triangle){parts, triangle, thing};
    return false;
}

static void stamp_triangle(frame_grouping *w, uint32_t triangle, uint32_t thing) {
    group_thing *t = &w->groups->things[thing];
    note_origin(t, triangle);
    if (was_stamped(w, triangle, t->parts, thing)) return;
    if (w->rings->same) {
        stamp_element(w, t->parts, triangle, thing);
        return;
    }
    for (int k = 0; k < 3; k++)
        stamp_element(w, t->parts, w->rings->names[w->mesh->triangles[triangle][k]], thing);
}

static void stamp_vertex(frame_grouping *w, uint32_t vertex, uint32_t thing) {
    const cscd_mesh *mesh = w->mesh;
    group_thing *t = &w->groups->things[thing];
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++)
        stamp_triangle(w, mesh->vertex_stars[i], thing);
    if (!vertex_has_no_triangle(mesh, vertex)) return;
    note_origin(t, origin_of_loose(vertex));
    stamp_element(w, t->parts, element_of_loose(w->rings, vertex), thing);
}

static void stamp_edge(frame_grouping *w, uint32_t edge, uint32_t thing) {
    const cscd_mesh *mesh = w->mesh;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        stamp_triangle(w, mesh->edge_stars[i], thing);
    if (!edge_is_loose(mesh, edge)) return;
    for (int k = 0; k < 2; k++) stamp_vertex(w, mesh->edges[edge][k], thing);
}

/* ---- the things of a frame ------------------------------------------------------------------------------ */

static uint32_t begin_thing(frame_grouping *w, uint64_t parts) {
    frame_groups *g = w->groups;
    uint32_t number = (uint32_t)g->thing_count++;
    g->things[number] = (group_thing){parts, UINT64_MAX, number};
    return number;
}

static void add_two_triangles(frame_grouping *w, uint32_t a, uint32_t b) {
    uint32_t part_a = part_of_triangle(w->labels, w->mesh, a),
             part_b = part_of_triangle(w->labels, w->mesh, b);
    uint32_t thing = begin_thing(w, key_of_parts(part_a, part_b));
    stamp_triangle(w, a, thing);
    stamp_triangle(w, b, thing);
}

static void add_pairs(frame_grouping *w) {
    const cscd_intersections *found = w->input->found;
    for (size_t i = 0; i < found->count && !w->no_memory; i++)
        add_two_triangles(w, found->items[i].a, found->items[i].b);
}

static void add_pieces(frame_grouping *w) {
    const cscd_curves *curves = w->input->found->curves;
    for (size_t c = 0; curves != NULL && c < curves->count; c++) {
        const cscd_curve *curve = &curves->items[c];
        for (size_t i = 0; i < curve->piece_count; i++) {
            const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + i];
            add_two_triangles(w, piece->a, piece->b);
        }
    }
}

static void add_depths(frame_grouping *w) {
    const cscd_depths *depths = w->input->found->depths;
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        const cscd_depth *depth = &depths->items[i];
        uint32_t part = part_of_triangle(w->labels, w->mesh, depth->face);
        uint32_t burier = part_of_triangle(w->labels, w->mesh, depth->triangle);
        uint32_t thing = begin_thing(w, key_of_parts(part, burier));
        if (depth->vertex != UINT32_MAX)
            stamp_vertex(w, depth->vertex, thing);
        else if (depth->edge != UINT32_MAX)
            stamp_edge(w, depth->edge, thing);
        else
            stamp_triangle(w, depth->face, thing);
    }
}

static void add_contact(frame_grouping *w, const tracked_contact *c) {
    uint32_t thing = begin_thing(w, parts_of_contact(w->labels, w->mesh, c->kind, c->a, c->b));
    if (c->kind == CSCD_CONTACT_EE || c->kind == CSCD_CONTACT_EV)
        stamp_edge(w, c->a, thing);
    else
        stamp_vertex(w, c->a, thing);
    if (c->kind == CSCD_CONTACT_VF)
        stamp_triangle(w, c->b, thing);
    else if (c->kind == CSCD_CONTACT_EE)
        stamp_edge(w, c->b, thing);
    else if (c->kind != CSCD_CONTACT_VH)
        stamp_vertex(w, c->b, thing);
}

/* Stamps spread over `radius` edges, and what is then one edge apart is joined, if `odd`. Stamps of one distance follow
 * those of the smaller ones. */
static void spread_stamps(frame_grouping *w) {
    const mesh_rings *rings = w->rings;
    const stamp_table *table = &w->groups->stamps;
    size_t begin = 0, end = table->count;
    for (uint32_t r = 0; r < rings->radius && begin < end && !w->no_memory; r++) {
        for (size_t i = begin; i < end; i++) {
            const stamp s = table->stamps[i];
            for (size_t n = rings->offsets[s.element]; n < rings->offsets[s.element + 1]; n++)
                stamp_element(w, s.parts, rings->neighbours[n], s.owner);
        }
        begin = end;
        end = table->count;
    }
    for (size_t i = begin; rings->odd && i < end; i++) {
        const stamp *s = &table->stamps[i];
        for (size_t n = rings->offsets[s->element]; n < rings->offsets[s->element + 1]; n++) {
            const stamp *near = stamp_table_find(table, s->parts, rings->neighbours[n]);
            if (near != NULL) join_things(w, s->owner, near->owner);
        }
    }
}

/* ---- the groups ----------------------------------------------------------------------------------------- */

static void begin_group(const frame_grouping *w, size_t group, const group_thing *thing) {
    frame_groups *g = w->groups;
    uint64_t frame = w->input->frame;
    g->groups[group] =
        (tracked_event){.parts = thing->parts,
                        .first_frame = frame,
                        .last_frame = frame,
                        .origin = UINT64_MAX,
                        .worst = {.frame = frame, .triangle = UINT32_MAX, .x = {NAN, NAN, NAN}}};
    g->times[group] = INFINITY;
    g->ranks[group] = PLACE_OF_PAIR;
}

/* Numbers the groups, in the order of their first things, and makes them the parents of all things. A parent comes before
 * its things. */
static cscd_status number_groups(frame_grouping *w) {
    frame_groups *g = w->groups;
    g->group_count = 0;
    for (uint32_t t = 0; t < g->thing_count; t++) g->group_count += g->things[t].parent == t;
    if (!memory_budget_take_all(w->input->budget, list_group_arrays(g)) ||
        !context_renew_all(w->context, list_group_arrays(g), &g->group_capacity, g->group_count))
        return CSCD_OUT_OF_MEMORY;
    uint32_t count = 0;
    for (uint32_t t = 0; t < g->thing_count; t++) {
        group_thing *thing = &g->things[t];
        bool is_root = thing->parent == t;
        if (is_root) begin_group(w, count, thing);
        thing->parent = is_root ? count++ : g->things[thing->parent].parent;
        tracked_event *group = &g->groups[thing->parent];
        if (thing->origin < group->origin) group->origin = group->worst.origin = thing->origin;
    }
    for (size_t i = 0; i < g->stamps.count; i++)
        g->stamps.stamps[i].owner = g->things[g->stamps.stamps[i].owner].parent;
    return CSCD_OK;
}

/* A place to look at; x: NULL if none is known. */
static void place_group(frame_groups *g, uint32_t group, place_rank rank, uint64_t triangle,
                        const double *x) {
    event_group *worst = &g->groups[group].worst;
    g->ranks[group] = rank;
    worst->triangle = triangle <= UINT32_MAX ? triangle : UINT32_MAX;
    if (x != NULL) memcpy(worst->x, x, sizeof worst->x);
}

static void sum_pairs(frame_groups *g, const cscd_intersections *found, const group_thing *things) {
    for (size_t i = 0; i < found->count; i++) {
        uint32_t group = things[i].parent;
        tracked_event *event = &g->groups[group];
        if (event->pairs == 0) place_group(g, group, PLACE_OF_PAIR, found->items[i].a, NULL);
        event->pairs++;
        event->worst.pairs++;
        event->kinds |= cscd_intersection_set(found->items[i].kind);
    }
}

static void sum_pieces(frame_groups *g, const cscd_curves *curves, const group_thing *things) {
    for (size_t c = 0; curves != NULL && c < curves->count; c++) {
        const cscd_curve *curve = &curves->items[c];
        for (size_t i = 0; i < curve->piece_count; i++, things++) {
            uint32_t group = things->parent;
            if (g->ranks[group] < PLACE_OF_CURVE)
                place_group(g, group, PLACE_OF_CURVE, curves->pieces[curve->first_piece + i].a,
                            curves->points[curve->first_point + i].x);
            g->groups[group].length += curve_piece_length(curves, curve, i);
        }
    }
}

static void sum_depths(frame_groups *g, const cscd_intersections *found, const group_thing *things) {
    const cscd_depths *depths = found->depths;
    for (size_t i = 0; depths != NULL && i < depths->count; i++) {
        uint32_t group = things[i].parent;
        tracked_event *event = &g->groups[group];
        event->depths++;
        if (event->parts >> 32 == (uint32_t)event->parts && depth_is_in_other_body(found, &depths->items[i]))
            event->kinds |= CSCD_EVENT_IN_OTHER_BODY;
        if (g->ranks[group] == PLACE_OF_DEPTH && depths->items[i].depth <= event->worst.depth) continue;
        event->worst.depth = depths->items[i].depth;
        place_group(g, group, PLACE_OF_DEPTH, things[i].origin, depths->items[i].x);
    }
}

static void sum_contacts(frame_groups *g, const frame_input *input, const group_thing *things) {
    for (size_t i = 0; i < input->contact_count; i++) {
        uint32_t group = things[i].parent;
        tracked_event *event = &g->groups[group];
        event->contacts++;
        event->worst.contacts++;
        if (g->ranks[group] > PLACE_OF_CONTACT || !(input->contacts[i].toi < g->times[group])) continue;
        g->times[group] = input->contacts[i].toi;
        place_group(g, group, PLACE_OF_CONTACT, things[i].origin, input->contacts[i].point);
    }
}

/* All groups of a pair of parts get what is known of it. */
static void mark_same_solids(frame_groups *g, const cscd_part_pairs *parts) {
    for (size_t i = 0; parts != NULL && i < parts->count; i++) {
        if (!parts->items[i].same_solid) continue;
        const uint64_t key = key_of_parts(parts->items[i].a, parts->items[i].b);
        for (size_t k = 0; k < g->group_count; k++)
            if (g->groups[k].parts == key && g->groups[k].pairs > 0)
                g->groups[k].kinds |= CSCD_EVENT_SAME_SOLID;
    }
}

static size_t piece_count_of(const cscd_curves *curves) {
    size_t count = 0;
    for (size_t c = 0; curves != NULL && c < curves->count; c++) count += curves->items[c].piece_count;
    return count;
}

static void sum_things(const frame_grouping *w) {
    frame_groups *g = w->groups;
    const cscd_intersections *found = w->input->found;
    const group_thing *things = g->things;
    if (found != NULL) {
        sum_pairs(g, found, things);
        mark_same_solids(g, found->parts);
        things += found->count;
        sum_pieces(g, found->curves, things);
        things += piece_count_of(found->curves);
        sum_depths(g, found, things);
        things += found->depths != NULL ? found->depths->count : 0;
    }
    sum_contacts(g, w->input, things);
    for (size_t i = 0; i < g->group_count; i++) g->groups[i].worst.length = g->groups[i].length;
}

/* ---- the frame ------------------------------------------------------------------------------------------ */

static size_t count_things(const frame_input *input) {
    const cscd_intersections *found = input->found;
    size_t count = input->contact_count;
    if (found == NULL) return count;
    count += found->count + piece_count_of(found->curves);
    return count + (found->depths != NULL ? found->depths->count : 0);
}

static cscd_status begin_frame(frame_grouping *w) {
    frame_groups *g = w->groups;
    size_t things = count_things(w->input), triangles = w->mesh->triangle_count;
    if (things >= UINT32_MAX) return CSCD_OUT_OF_MEMORY;
    const array_list list = {{ARRAY(g->things, room_with_spare(things))}};
    if (!memory_budget_take_all(w->input->budget, list) ||
        !context_renew_all(w->context, list, &g->thing_capacity, things))
        return CSCD_OUT_OF_MEMORY;
    if (g->stamped_places == NULL) {
        const array_list marks = {{ARRAY(g->stamped_places, triangles), ARRAY(g->stamped, triangles)}};
        if (!context_allocate_all(w->context, marks)) return CSCD_OUT_OF_MEMORY;
        g->stamped_capacity = triangles;
    }
    g->thing_count = g->stamped_count = 0;
    stamp_table_clear(&g->stamps);
    return CSCD_OK;
}

cscd_status frame_groups_find(frame_groups *g, const cscd_mesh *mesh, const part_labels *parts,
                              const mesh_rings *rings, const frame_input *input, frame_row *out) {
    frame_grouping w = {g, mesh->context, mesh, parts, rings, input, false};
    cscd_status status = begin_frame(&w);
    if (status != CSCD_OK) return status;
    if (input->found != NULL) {
        add_pairs(&w);
        add_pieces(&w);
        add_depths(&w);
    }
    for (size_t i = 0; i < input->contact_count; i++) add_contact(&w, &input->contacts[i]);
    spread_stamps(&w);
    status = w.no_memory ? CSCD_OUT_OF_MEMORY : number_groups(&w);
    if (status != CSCD_OK) return status;
    sum_things(&w);
    *out = (frame_row){input->frame, g->groups, g->group_count, g->stamps};
    return CSCD_OK;
}
