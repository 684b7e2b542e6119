/* A recording for an event tracker: a mesh, and what each of its frames has, random or copied from a detector. */
#include "tests/support/events/recorded_frames.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SHEET = 5, STRIP = 9, TRIANGLES_MAX = 64 };

/* ---- the mesh ------------------------------------------------------------------------------------------- */

static uint32_t list_sheet(uint32_t width, uint32_t height, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t y = 0; y + 1 < height; y++) {
        for (uint32_t x = 0; x + 1 < width; x++) {
            uint32_t v = y * width + x;
            const uint32_t two[6] = {v, v + 1, v + width, v + width, v + 1, v + width + 1};
            memcpy(&out[6 * count++], two, sizeof two);
        }
    }
    return 2 * count;
}

static void create_mesh(recorded_frames *r) {
    static const uint32_t wires[] = {0, 1, 1, 2, 3, 4};
    const double up[3] = {0, 0, 1};
    uint32_t sheet[3 * TRIANGLES_MAX], strip[3 * TRIANGLES_MAX];
    uint32_t in_sheet = list_sheet(SHEET, SHEET, sheet), in_strip = list_sheet(STRIP, 2, strip);
    const cscd_object_desc objects[] = {cscd_object_of_triangles(SHEET * SHEET, in_sheet, sheet),
                                        cscd_object_of_triangles(2 * STRIP, in_strip, strip),
                                        cscd_object_of_wires(5, 3, wires), cscd_object_of_points(3),
                                        cscd_object_half_space(up)};
    assert_int_equal(cscd_mesh_create(r->context, objects, 5, &r->mesh), CSCD_OK);
}

/* ---- what a frame has ----------------------------------------------------------------------------------- */

static uint32_t random_below(uint32_t count) {
    return (uint32_t)random_integer(0, (int)count - 1);
}

/* Few depths and lengths, so that many are equal. */
static double random_amount(void) {
    return random_integer(0, 3) * 0.5;
}

static void *new_items(size_t count, size_t size) {
    void *items = calloc(count + 1, size);
    assert_non_null(items);
    return items;
}

static void make_pairs(const recorded_frames *r, recorded_frame *f, int most) {
    uint32_t triangles = cscd_mesh_triangle_count(r->mesh);
    f->found.count = (size_t)random_integer(0, most);
    cscd_intersection *items = new_items(f->found.count, sizeof *items);
    for (size_t i = 0; i < f->found.count; i++) {
        items[i].a = random_below(triangles);
        items[i].b = random_below(triangles);
        items[i].kind = (cscd_intersection_kind)random_integer(0, 4);
    }
    f->found.items = items;
}

static void make_curves(const recorded_frames *r, recorded_frame *f, int most) {
    uint32_t triangles = cscd_mesh_triangle_count(r->mesh);
    size_t count = (size_t)random_integer(0, most), points = 0;
    cscd_curve *curves = new_items(count, sizeof *curves);
    cscd_curve_point *all_points = new_items(5 * count, sizeof *all_points);
    cscd_curve_piece *pieces = new_items(4 * count, sizeof *pieces);
    for (size_t i = 0; i < count; i++) {
        size_t pieces_here = (size_t)random_integer(1, 4);
        bool closed = pieces_here > 2 && random_integer(0, 1) == 0;
        curves[i] = (cscd_curve){.first_point = points,
                                 .point_count = pieces_here + !closed,
                                 .first_piece = f->curves.piece_count,
                                 .piece_count = pieces_here,
                                 .closed = closed};
        for (size_t k = 0; k < pieces_here; k++)
            pieces[f->curves.piece_count++] =
                (cscd_curve_piece){random_below(triangles), random_below(triangles)};
        for (size_t k = 0; k < curves[i].point_count; k++) {
            for (int c = 0; c < 3; c++) all_points[points].x[c] = random_amount();
            points++;
        }
    }
    f->curves.items = curves;
    f->curves.count = count;
    f->curves.points = all_points;
    f->curves.point_count = points;
    f->curves.pieces = pieces;
    f->found.curves = &f->curves;
}

static void make_depths(const recorded_frames *r, recorded_frame *f, int most) {
    f->depths.count = (size_t)random_integer(0, most);
    cscd_depth *items = new_items(f->depths.count, sizeof *items);
    for (size_t i = 0; i < f->depths.count; i++) {
        const int kind = random_integer(0, 3); /* an edge, a face, or most often a vertex */
        uint32_t count = 0;
        const uint32_t *star = NULL;
        items[i].vertex = kind > 1 ? random_below(SHEET * SHEET + 2 * STRIP) : UINT32_MAX;
        items[i].edge = kind == 0 ? random_below(cscd_mesh_object(r->mesh, 0).edge_count) : UINT32_MAX;
        if (kind > 1) star = cscd_mesh_vertex_triangles(r->mesh, items[i].vertex, &count);
        if (kind == 0) star = cscd_mesh_edge_triangles(r->mesh, items[i].edge, &count);
        items[i].face = count > 0 ? star[0] : random_below(cscd_mesh_triangle_count(r->mesh));
        items[i].triangle = random_below(cscd_mesh_triangle_count(r->mesh));
        items[i].depth = random_amount();
        for (int c = 0; c < 3; c++) items[i].x[c] = random_unit();
    }
    f->depths.items = items;
    f->found.depths = &f->depths;
}

static cscd_contact random_contact(const recorded_frames *r) {
    const cscd_object wires = cscd_mesh_object(r->mesh, 2), points = cscd_mesh_object(r->mesh, 3);
    uint32_t triangles = cscd_mesh_triangle_count(r->mesh), edges = cscd_mesh_edge_count(r->mesh);
    uint32_t with_triangles = SHEET * SHEET + 2 * STRIP;
    uint32_t point = points.first_vertex + random_below(points.vertex_count);
    cscd_contact c = {.toi = random_amount(), .kind = CSCD_CONTACT_VF};
    for (int i = 0; i < 3; i++) c.point[i] = random_unit();
    c.a = random_integer(0, 3) == 0 ? point : random_below(with_triangles);
    c.b = random_below(triangles);
    switch (random_integer(0, 7)) {
    case 0:
    case 1:
    case 2:
        c.kind = CSCD_CONTACT_EE;
        c.a = random_below(edges);
        c.b = random_below(edges);
        break;
    case 3:
        c.kind = CSCD_CONTACT_EV;
        c.a = wires.first_edge + random_below(wires.edge_count);
        c.b = point;
        break;
    case 4:
        c.kind = CSCD_CONTACT_VV;
        c.a = points.first_vertex;
        c.b = point;
        break;
    case 5:
        c.kind = CSCD_CONTACT_VH;
        c.b = 4;
        break;
    default:;
    }
    return c;
}

static void make_frame(const recorded_frames *r, recorded_frame *f) {
    f->looked = random_integer(0, 5) > 0;
    int most = random_integer(0, 3);
    if (f->looked) {
        make_pairs(r, f, most);
        if (random_integer(0, 1) == 0) make_curves(r, f, most > 2 ? 2 : most);
        if (random_integer(0, 1) == 0) make_depths(r, f, most);
    }
    f->contact_count = (size_t)random_integer(0, random_integer(0, 3));
    f->contacts = new_items(f->contact_count, sizeof *f->contacts);
    for (size_t i = 0; i < f->contact_count; i++) f->contacts[i] = random_contact(r);
}

/* ---- the recording -------------------------------------------------------------------------------------- */

static void choose_options(recorded_frames *r) {
    uint32_t triangles = cscd_mesh_triangle_count(r->mesh);
    r->options = cscd_event_defaults();
    r->options.rings = random_below(6);
    r->options.gap = random_integer(0, 2) == 0 ? random_below(4) : 0;
    if (random_integer(0, 1) == 0) {
        r->options.part_count = 3;
        for (uint32_t t = 0; t < triangles; t++)
            r->labels[t] = random_integer(0, 9) == 0 ? UINT32_MAX : (t / 7 + 1) % 3;
        r->options.labels = r->labels;
    }
    if (random_integer(0, 1) == 0) {
        r->options.seam_count = 1 + random_below(3);
        for (size_t i = 0; i < 2 * r->options.seam_count; i++)
            r->seams[i] = random_below(cscd_mesh_vertex_count(r->mesh));
        r->options.seams = r->seams;
    }
}

void recorded_frames_create(recorded_frames *r, const cscd_allocator *allocator, uint32_t frame_count) {
    *r = (recorded_frames){.frame_count = frame_count};
    cscd_context_options options = cscd_context_defaults();
    if (allocator != NULL) options.allocator = *allocator;
    assert_int_equal(cscd_context_create(&options, &r->context), CSCD_OK);
    create_mesh(r);
    r->labels = new_items(cscd_mesh_triangle_count(r->mesh), sizeof *r->labels);
    choose_options(r);
    uint64_t number = random_bits() % 5;
    for (uint32_t i = 0; i < frame_count; i++) {
        make_frame(r, &r->frames[i]);
        r->frames[i].number = number;
        number += 1 + random_below(3);
    }
}

static void *copy_items(const void *items, size_t count, size_t size) {
    void *copy = new_items(count, size);
    if (count > 0) memcpy(copy, items, count * size);
    return copy;
}

static void copy_found(recorded_frame *to, const cscd_intersections *found) {
    to->looked = true;
    to->found.count = found->count;
    to->found.items = copy_items(found->items, found->count, sizeof *found->items);
    if (found->curves != NULL) {
        const cscd_curves *c = found->curves;
        to->curves = *c;
        to->curves.items = copy_items(c->items, c->count, sizeof *c->items);
        to->curves.points = copy_items(c->points, c->point_count, sizeof *c->points);
        to->curves.pieces = copy_items(c->pieces, c->piece_count, sizeof *c->pieces);
        to->found.curves = &to->curves;
    }
    if (found->depths != NULL) {
        to->depths = *found->depths;
        to->depths.items = copy_items(to->depths.items, to->depths.count, sizeof *to->depths.items);
        to->found.depths = &to->depths;
    }
}

void recorded_frames_copy(recorded_frame *to, const cscd_intersections *found,
                          const cscd_contacts *contacts) {
    if (found != NULL) copy_found(to, found);
    to->contact_count = contacts != NULL ? contacts->count : 0;
    if (contacts != NULL)
        to->contacts = copy_items(contacts->items, contacts->count, sizeof *contacts->items);
}

void recorded_frames_free(recorded_frames *r) {
    for (uint32_t i = 0; i < r->frame_count; i++) {
        recorded_frame *f = &r->frames[i];
        free((void *)f->found.items);
        free((void *)f->curves.items);
        free((void *)f->curves.points);
        free((void *)f->curves.pieces);
        free((void *)f->depths.items);
        free(f->contacts);
    }
    free(r->labels);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_event_tracker *recorded_tracker(const recorded_frames *r) {
    cscd_event_tracker *tracker = NULL;
    cscd_event_options options = r->options;
    assert_int_equal(cscd_event_tracker_create(r->context, r->mesh, &options, &tracker), CSCD_OK);
    return tracker;
}

void recorded_frames_add(const recorded_frames *r, cscd_event_tracker *tracker, uint32_t begin,
                         uint32_t end) {
    for (uint32_t i = begin; i < end; i++) {
        const recorded_frame *f = &r->frames[i];
        size_t half = f->contact_count / 2;
        assert_int_equal(cscd_event_tracker_add_contacts(tracker, f->contacts, half), CSCD_OK);
        assert_int_equal(
            cscd_event_tracker_add_contacts(tracker, f->contacts + half, f->contact_count - half), CSCD_OK);
        assert_int_equal(cscd_event_tracker_add_frame(tracker, f->number, f->looked ? &f->found : NULL),
                         CSCD_OK);
    }
}
