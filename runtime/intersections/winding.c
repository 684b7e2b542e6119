/* The winding numbers of bodies around a point of the mesh: the triangles that a ray along z passes through,
 * counted with signs. docs/theory/curves.md, lemma 5. */
#include "runtime/intersections/named_surface.h"

#include "runtime/bvh/bvh.h"

#include <math.h>

enum { RAY_AXIS = 2 };

/* The ray begins at the origin, from which the point is off towards first, then towards second. */
typedef struct ray_work {
    const named_surface *surface;
    winding_tally *tally;
    bool by_component;
    symbolic_point origin, first, second;
    uint32_t
        next_name; /* of the corner after the origin in the triangle that the point belongs to, seen from outside */
} ray_work;

void winding_tally_clear(winding_tally *tally) {
    for (uint32_t i = 0; i < tally->count; i++) {
        tally->numbers[tally->touched[i]] = 0;
        tally->is_touched[tally->touched[i]] = false;
    }
    tally->count = 0;
}

static void add_number(winding_tally *tally, uint32_t body, int number) {
    if (!tally->is_touched[body]) {
        tally->is_touched[body] = true;
        tally->touched[tally->count++] = body;
    }
    tally->numbers[body] += number;
}

static bool have_one_name(const symbolic_point p[3]) {
    return p[0].name == p[1].name || p[1].name == p[2].name || p[2].name == p[0].name;
}

static void load_points(const named_surface *s, uint32_t triangle, symbolic_point p[3]) {
    for (int i = 0; i < 3; i++) p[i] = surface_point(s, s->mesh->triangles[triangle][i]);
}

bool winding_is_collapsed(const named_surface *s, uint32_t triangle) {
    symbolic_point p[3];
    if (s->names == NULL) return false;
    load_points(s, triangle, p);
    return have_one_name(p);
}

static int turn_of(symbolic_point a, symbolic_point b, symbolic_point c) {
    return symbolic_orient_along(a, b, c, RAY_AXIS);
}

/* The ray passes out of a body through a triangle that faces upwards, and into it through one that faces downwards, if it
 * begins below the triangle's plane. side: the side of the normal on which it begins. */
static int pass_number(int facing, int side) {
    return facing != side ? facing : 0;
}

static int pass_of_stranger(const ray_work *work, const symbolic_point p[3]) {
    int facing = turn_of(p[0], p[1], p[2]);
    for (int i = 0; i < 3; i++) {
        if (turn_of(p[i], p[(i + 1) % 3], work->origin) != facing) return 0;
    }
    return pass_number(facing, symbolic_orient3d(p[0], p[1], p[2], work->origin));
}

/* On which side of a triangle (origin, b, c) is the point? If the triangle has all three vertices of the one that the point
 * belongs to, it is off that one's plane, to its outer side. */
static int side_of_neighbour(const ray_work *work, symbolic_point b, symbolic_point c) {
    const symbolic_point *towards[2] = {&work->first, &work->second};
    for (int i = 0; i < 2; i++) {
        if (towards[i]->name != b.name && towards[i]->name != c.name)
            return symbolic_orient3d(work->origin, b, c, *towards[i]);
    }
    return b.name == work->next_name ? 1 : -1;
}

/* The projection of a triangle (origin, b, c) has the point if it turns from b to the point, and from the point to c, as
 * from b to c. */
static int pass_of_neighbour(const ray_work *work, symbolic_point b, symbolic_point c) {
    int facing = turn_of(work->origin, b, c);
    symbolic_point from_b = work->first.name != b.name ? work->first : work->second;
    symbolic_point to_c = work->first.name != c.name ? work->first : work->second;
    if (turn_of(work->origin, b, from_b) != facing || turn_of(work->origin, to_c, c) != facing) return 0;
    return pass_number(facing, side_of_neighbour(work, b, c));
}

static bool is_collapsed(const named_surface *s, uint32_t component) {
    return s->collapsed != NULL && s->collapsed[component];
}

/* A closed surface winds around nothing that is outside its box. Its boundary counts, as the point is a little off the origin. */
static bool box_has_origin(const ray_work *work, uint32_t component) {
    const component_box *boxes = work->surface->boxes;
    return boxes == NULL || component_box_has_point(&boxes[component], work->origin.x);
}

static void pass_triangle(void *data, uint32_t triangle) {
    const ray_work *work = data;
    const cscd_mesh *mesh = work->surface->mesh;
    uint32_t component = mesh->triangle_components[triangle];
    if (!mesh->components[component].closed_manifold || is_collapsed(work->surface, component)) return;
    if (!box_has_origin(work, component)) return;
    symbolic_point p[3];
    load_points(work->surface, triangle, p);
    if (have_one_name(p)) return;
    int number = 0, corner = 0;
    while (corner < 3 && p[corner].name != work->origin.name) corner++;
    if (corner == 3)
        number = pass_of_stranger(work, p);
    else
        number = pass_of_neighbour(work, p[(corner + 1) % 3], p[(corner + 2) % 3]);
    if (number == 0) return;
    uint32_t of = work->by_component ? component : surface_body(work->surface, triangle);
    add_number(work->tally, of, number * surface_sense(work->surface, triangle));
}

static void cast_ray(const named_surface *s, const bvh *hierarchy, corner_side at, bool by_component,
                     winding_tally *tally) {
    symbolic_point p[3];
    load_points(s, at.triangle, p);
    if (have_one_name(p) || is_collapsed(s, s->mesh->triangle_components[at.triangle])) return;
    symbolic_point next = p[(at.corner + 1) % 3], before = p[(at.corner + 2) % 3];
    ray_work work = {.surface = s,
                     .tally = tally,
                     .by_component = by_component,
                     .origin = p[at.corner],
                     .first = at.next ? next : before,
                     .second = at.next ? before : next,
                     .next_name = surface_sense(s, at.triangle) > 0 ? next.name : before.name};
    const double *x = work.origin.x;
    query_box ray = {{x[0], x[1], x[2]}, {x[0], x[1], (double)INFINITY}};
    bvh_visit_box(hierarchy, &ray, true, pass_triangle, &work);
}

void winding_find(const named_surface *s, const bvh *hierarchy, corner_side at, winding_tally *tally) {
    cast_ray(s, hierarchy, at, false, tally);
}

void winding_find_by_component(const named_surface *s, const bvh *hierarchy, corner_side at,
                               winding_tally *tally) {
    cast_ray(s, hierarchy, at, true, tally);
}
