/* Finds the closed components that are inside out at one moment: docs/theory/orientation.md. The signs of
 * volumes tell it, except for objects that have both signs. There rays find which components lie in which. */
#include "runtime/intersections/named_surface.h"

#include "src/core/context.h"
#include "src/core/floating.h"
#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* Two components, or a component and a part, as a number: the first is in the upper half. */
typedef struct component_keys {
    uint64_t *items, *spare;
    size_t count, capacity;
} component_keys;

/* The memory of all calls. Arrays without a remark are per component. */
struct orientation_finder {
    const cscd_mesh *mesh;
    volume_estimate *volumes;
    int8_t *signs;         /* of the volume; 0 of open components, and where a closed one encloses nothing */
    bool *turned;          /* the component is taken as turned around */
    uint32_t *objects;     /* of the component */
    uint32_t *samples;     /* a triangle whose corners have different names; UINT32_MAX: none */
    uint32_t *around;      /* the component that it lies in, the innermost one; itself: in none */
    component_box *boxes;  /* where there are several */
    uint8_t *roles;        /* body or cavity */
    surface_bodies bodies; /* of the surface, with cavities joined with what is around them */
    winding_tally tally;   /* of components */
    uint8_t *orientations; /* per object: which signs its components have */
    uint32_t *triangles, *offsets; /* those of each component, made when first needed */
    uint32_t *holders;             /* made with them: room for those that one lies in */
    bool *touching;                /* per triangle: it is in a pair with another component */
    component_keys
        crossings; /* pairs of components of mixed objects that pass through each other, both ways round */
    component_keys parts; /* of components of mixed objects */
};

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_arrays(orientation_finder *o) {
    size_t components = o->mesh->component_count;
    winding_tally *t = &o->tally;
    return (array_list){
        {ARRAY(o->volumes, components), ARRAY(o->signs, components), ARRAY(o->turned, components),
         ARRAY(o->objects, components), ARRAY(o->samples, components), ARRAY(o->around, components),
         ARRAY(o->boxes, components), ARRAY(o->roles, components), ARRAY(o->bodies.components, components),
         ARRAY(t->numbers, components), ARRAY(t->is_touched, components), ARRAY(t->touched, components),
         ARRAY(o->orientations, o->mesh->object_count)}};
}

static array_list list_by_component(orientation_finder *o) {
    return (array_list){{ARRAY(o->triangles, o->mesh->triangle_count),
                         ARRAY(o->touching, o->mesh->triangle_count),
                         ARRAY(o->holders, o->mesh->component_count),
                         ARRAY(o->offsets, (size_t)o->mesh->component_count + 1)}};
}

static array_list list_of_keys(component_keys *k, size_t count) {
    return (array_list){{ARRAY(k->items, count), ARRAY(k->spare, count)}};
}

orientation_finder *orientation_finder_create(const cscd_mesh *mesh) {
    orientation_finder *o = context_allocate(mesh->context, 1, sizeof *o);
    if (o == NULL) return NULL;
    o->mesh = mesh;
    if (!context_allocate_all(mesh->context, list_arrays(o))) {
        context_free(mesh->context, o);
        return NULL;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        o->objects[mesh->triangle_components[t]] = cscd_mesh_vertex_object(mesh, mesh->triangles[t][0]);
    return o;
}

void orientation_finder_destroy(orientation_finder *o) {
    if (o == NULL) return;
    cscd_context *context = o->mesh->context;
    context_free_all(context, list_arrays(o));
    context_free_all(context, list_by_component(o));
    context_free_all(context, list_of_keys(&o->crossings, 0));
    context_free_all(context, list_of_keys(&o->parts, 0));
    context_free(context, o);
}

/* ---- boxes --------------------------------------------------------------------------------------------- */

static component_box empty_component_box(void) {
    const double most = (double)INFINITY;
    return (component_box){{most, most, most}, {-most, -most, -most}};
}

static void find_component_boxes(const cscd_mesh *mesh, const double *positions, component_box *boxes) {
    for (uint32_t c = 0; c < mesh->component_count; c++) boxes[c] = empty_component_box();
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        component_box *box = &boxes[mesh->triangle_components[t]];
        for (uint32_t i = 0; i < 3; i++) {
            const double *x = surface_corner(mesh, positions, t, i);
            for (int k = 0; k < 3; k++) {
                box->low[k] = min_of(box->low[k], x[k]);
                box->high[k] = max_of(box->high[k], x[k]);
            }
        }
    }
}

static bool box_has_box(const component_box *box, const component_box *inner) {
    return component_box_has_point(box, inner->low) && component_box_has_point(box, inner->high);
}

/* ---- signs --------------------------------------------------------------------------------------------- */

/* The signs of the volumes of an object's components. */
enum { OUTWARD = 1, INWARD = 2, MIXED = OUTWARD | INWARD };

typedef struct orientation_work {
    orientation_finder *finder;
    const named_surface *surface;
    const bvh *bvh;
    const uint32_t *labels; /* of triangles; NULL: objects alone count */
} orientation_work;

static bool sort_triangles(orientation_finder *o) {
    if (o->triangles != NULL) return true;
    if (!context_allocate_all(o->mesh->context, list_by_component(o))) return false;
    mesh_list_by_component(o->mesh, o->triangles, o->offsets);
    return true;
}

static bool find_signs(const orientation_work *w) {
    orientation_finder *o = w->finder;
    const cscd_mesh *mesh = o->mesh;
    volume_estimates_find(mesh, w->surface->positions, o->volumes);
    memset(o->orientations, 0, mesh->object_count * sizeof *o->orientations);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        const volume_estimate *e = &o->volumes[c];
        o->signs[c] = e->volume < 0.0 ? -1 : 1;
        if (!mesh->components[c].closed_manifold) {
            o->signs[c] = 0;
        } else if (!volume_estimate_decides(e)) {
            if (!sort_triangles(o)) return false;
            o->signs[c] = (int8_t)volume_sign_exact(mesh, w->surface->positions, o->triangles + o->offsets[c],
                                                    o->offsets[c + 1] - o->offsets[c]);
        }
        o->turned[c] = o->signs[c] < 0;
        if (o->signs[c] != 0) o->orientations[o->objects[c]] |= o->signs[c] < 0 ? INWARD : OUTWARD;
    }
    return true;
}

static bool any_object_is(const orientation_finder *o, int orientation) {
    for (uint32_t i = 0; i < o->mesh->object_count; i++) {
        if ((o->orientations[i] & orientation) == orientation) return true;
    }
    return false;
}

static bool is_of_mixed(const orientation_finder *o, uint32_t component) {
    return o->signs[component] != 0 && o->orientations[o->objects[component]] == MIXED;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */

static uint64_t key_of(uint32_t component, uint32_t other) {
    return (uint64_t)component << 32 | other;
}

static bool reserve_keys(const orientation_finder *o, component_keys *k, size_t count) {
    k->count = 0;
    return context_renew_all(o->mesh->context, list_of_keys(k, room_with_spare(count)), &k->capacity, count);
}

static void add_key(component_keys *k, uint64_t key) {
    if (k->count == 0 || k->items[k->count - 1] != key) k->items[k->count++] = key;
}

static void sort_keys(component_keys *k) {
    size_t count = k->count;
    sort_by_number(k->items, k->spare, count, sizeof *k->items);
    k->count = 0;
    for (size_t i = 0; i < count; i++) add_key(k, k->items[i]);
}

/* The first of the keys that is not below. */
static size_t place_of_key(const component_keys *k, uint64_t key) {
    size_t low = 0, high = k->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (k->items[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool has_key(const component_keys *k, uint64_t key) {
    const size_t at = place_of_key(k, key);
    return at < k->count && k->items[at] == key;
}

/* Those that share a triangle, as copies do, are neither in the other. */
static bool list_crossings(orientation_finder *o, const cscd_intersection *pairs, size_t pair_count) {
    if (!reserve_keys(o, &o->crossings, 2 * pair_count)) return false;
    for (size_t i = 0; i < pair_count; i++) {
        if (pairs[i].kind != CSCD_INTERSECTION_CROSSING && pairs[i].kind != CSCD_INTERSECTION_DUPLICATE)
            continue;
        uint32_t a = o->mesh->triangle_components[pairs[i].a], b = o->mesh->triangle_components[pairs[i].b];
        if (a == b || o->objects[a] != o->objects[b] || !is_of_mixed(o, a)) continue;
        o->crossings.items[o->crossings.count++] = key_of(a, b);
        o->crossings.items[o->crossings.count++] = key_of(b, a);
    }
    sort_keys(&o->crossings);
    return true;
}

static bool list_parts(const orientation_work *w) {
    orientation_finder *o = w->finder;
    if (w->labels == NULL) return true;
    if (!reserve_keys(o, &o->parts, o->mesh->triangle_count)) return false;
    for (uint32_t t = 0; t < o->mesh->triangle_count; t++) {
        uint32_t component = o->mesh->triangle_components[t];
        if (is_of_mixed(o, component)) add_key(&o->parts, key_of(component, w->labels[t]));
    }
    sort_keys(&o->parts);
    return true;
}

/* ---- nesting ------------------------------------------------------------------------------------------- */

/* A triangle of each component, the first one that touches nothing if there is one: at others it is the symbolic motion that says
 * what they lie in. */
static void find_samples(const orientation_work *w, const cscd_intersection *pairs, size_t pair_count) {
    orientation_finder *o = w->finder;
    const uint32_t *components = o->mesh->triangle_components;
    memset(o->touching, 0, o->mesh->triangle_count * sizeof *o->touching);
    for (size_t i = 0; i < pair_count; i++)
        if (components[pairs[i].a] != components[pairs[i].b])
            o->touching[pairs[i].a] = o->touching[pairs[i].b] = true;
    memset(o->samples, 0xff, o->mesh->component_count * sizeof *o->samples);
    for (uint32_t t = 0; t < o->mesh->triangle_count; t++) {
        uint32_t *sample = &o->samples[components[t]];
        if (winding_is_collapsed(w->surface, t)) continue;
        if (*sample == UINT32_MAX || (o->touching[*sample] && !o->touching[t])) *sample = t;
    }
}

/* May a component be a shell within another one, if it lies there? What has a part of its own is a body of its own. */
static bool may_hold(const orientation_work *w, uint32_t outer, uint32_t inner) {
    const orientation_finder *o = w->finder;
    if (outer == inner || o->objects[outer] != o->objects[inner] || o->signs[outer] == 0) return false;
    if (has_key(&o->crossings, key_of(outer, inner))) return false;
    return w->labels == NULL || has_key(&o->parts, key_of(outer, w->labels[o->samples[inner]]));
}

static bool is_larger(const orientation_finder *o, uint32_t a, uint32_t b) {
    double of_a = fabs(o->volumes[a].volume), of_b = fabs(o->volumes[b].volume);
    return of_a != of_b ? of_a > of_b : a < b;
}

/* Up to rounding, copies enclose the same volume, and neither lies in the other. */
static bool are_of_one_size(const orientation_finder *o, uint32_t a, uint32_t b) {
    const double of_a = fabs(o->volumes[a].volume), of_b = fabs(o->volumes[b].volume);
    return fabs(of_a - of_b) <= 0x1p-40 * max_of(of_a, of_b);
}

/* Does its size let a component lie in another one? What lies in something has its box in the other's. This tells of crossings, too, that
 * nobody looks at, because their pairs are left out. */
static bool size_holds(const orientation_finder *o, uint32_t outer, uint32_t inner) {
    return is_larger(o, outer, inner) && !are_of_one_size(o, outer, inner) &&
           box_has_box(&o->boxes[outer], &o->boxes[inner]);
}

/* Is a nearer to the component in the file than b? What comes before it is nearer than what comes after it. */
static bool is_nearer(uint32_t component, uint32_t a, uint32_t b) {
    if ((a < component) != (b < component)) return a < component;
    return a < component ? a > b : a < b;
}

/* The one right around a component, among those that it lies in, or itself. Those that do not cross lie in
 * each other, so the smallest is the innermost. Among copies it is the nearest in the file, since files
 * mostly list a cavity behind its body. */
static uint32_t find_innermost(const orientation_work *w, uint32_t component) {
    winding_tally *tally = &w->finder->tally;
    uint32_t innermost = component;
    winding_tally_clear(tally);
    winding_find_by_component(w->surface, w->bvh, (corner_side){w->finder->samples[component], 0, true},
                              tally);
    uint32_t count = 0, *around = w->finder->holders;
    for (uint32_t i = 0; i < tally->count; i++) {
        uint32_t outer = tally->touched[i];
        if (tally->numbers[outer] == 0 || !may_hold(w, outer, component)) continue;
        if (!size_holds(w->finder, outer, component)) continue;
        if (innermost == component || is_larger(w->finder, innermost, outer)) innermost = outer;
        around[count++] = outer;
    }
    uint32_t nearest = innermost;
    for (uint32_t i = 0; i < count; i++) {
        if (are_of_one_size(w->finder, innermost, around[i]) && is_nearer(component, around[i], nearest))
            nearest = around[i];
    }
    return nearest;
}

static bool is_sampled(const orientation_finder *o, uint32_t component) {
    return is_of_mixed(o, component) && o->samples[component] != UINT32_MAX;
}

/* The role of a component: a body of its own, a cavity of the one right around it, or not known yet. */
enum { SHELL_UNKNOWN, SHELL_OF_BODY, SHELL_OF_CAVITY };

/* Writes what is right around each component; without anything it is a body. */
static void find_around(const orientation_work *w) {
    orientation_finder *o = w->finder;
    for (uint32_t c = 0; c < o->mesh->component_count; c++) {
        o->around[c] = is_sampled(o, c) ? find_innermost(w, c) : c;
        o->roles[c] = o->around[c] == c ? SHELL_OF_BODY : SHELL_UNKNOWN;
    }
    winding_tally_clear(&o->tally);
}

/* Does a shell cross a larger one that is turned the same way, with the same one around both? Two cavities of one body do not cross: the
 * smaller one is a mirrored body that reaches into the wall. */
static bool crosses_larger_shell(const orientation_finder *o, uint32_t c) {
    const component_keys *k = &o->crossings;
    for (size_t i = place_of_key(k, key_of(c, 0)); i < k->count && k->items[i] >> 32 == c; i++) {
        const uint32_t other = (uint32_t)k->items[i];
        if (o->around[other] == o->around[c] && o->signs[other] == o->signs[c] && is_larger(o, other, c))
            return true;
    }
    return false;
}

/* From the outermost shell that is not known yet down to the component: a shell is a cavity if it is turned the other way round than
 * the one around it, and that one is none. */
static void find_role(orientation_finder *o, uint32_t component) {
    uint32_t depth = 0, *path = o->tally.touched; /* of the tally, which is clear */
    for (uint32_t c = component; o->roles[c] == SHELL_UNKNOWN; c = o->around[c]) path[depth++] = c;
    while (depth > 0) {
        const uint32_t c = path[--depth], outer = o->around[c];
        const bool cavity =
            o->signs[c] != o->signs[outer] && o->roles[outer] == SHELL_OF_BODY && !crosses_larger_shell(o, c);
        o->roles[c] = cavity ? SHELL_OF_CAVITY : SHELL_OF_BODY;
    }
}

/* A cavity is turned with the shell around it, whose body it belongs to. */
static void turn_cavities(const orientation_work *w) {
    orientation_finder *o = w->finder;
    find_around(w);
    for (uint32_t c = 0; c < o->mesh->component_count; c++) find_role(o, c);
    for (uint32_t c = 0; c < o->mesh->component_count; c++) {
        if (o->roles[c] != SHELL_OF_CAVITY) continue;
        o->turned[c] = o->signs[o->around[c]] < 0;
        o->bodies.components[c] = o->bodies.components[o->around[c]];
    }
}

/* Gives the surface bodies that cavities may be joined with; where objects are the bodies, there are none. */
static void own_bodies(orientation_finder *o, named_surface *s, bool by_component) {
    uint32_t *components = o->bodies.components;
    if (by_component) {
        for (uint32_t c = 0; c < o->mesh->component_count; c++) components[c] = c;
        o->bodies = (surface_bodies){components, o->objects, o->mesh->component_count};
    } else if (s->bodies != NULL && s->bodies->components != NULL) {
        memcpy(components, s->bodies->components, o->mesh->component_count * sizeof *components);
        o->bodies = (surface_bodies){components, s->bodies->objects, s->bodies->count};
    } else {
        return;
    }
    s->bodies = &o->bodies;
}

bool orientation_finder_run(orientation_finder *o, named_surface *s, const bvh *hierarchy,
                            const orientation_request *request) {
    const orientation_work work = {o, s, hierarchy, request->labels};
    own_bodies(o, s, request->by_component);
    if (o->mesh->component_count > 1) {
        find_component_boxes(o->mesh, s->positions, o->boxes);
        s->boxes = o->boxes;
    }
    if (!find_signs(&work)) return false;
    if (any_object_is(o, MIXED)) {
        if (!sort_triangles(o) || !list_crossings(o, request->pairs, request->pair_count)) return false;
        find_samples(&work, request->pairs, request->pair_count);
        if (!list_parts(&work)) return false;
        turn_cavities(&work);
    }
    if (!request->as_given && any_object_is(o, INWARD)) s->turned = o->turned;
    return true;
}
