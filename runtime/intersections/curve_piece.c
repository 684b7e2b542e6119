/* The piece of an intersection curve that lies in two triangles, under a symbolic perturbation of the vertices:
 * docs/theory/curves.md, whose lemmas are cited here. */
#include "runtime/intersections/curve_piece.h"

/* A triangle of the pair, with its corners as points and by their numbers. */
typedef struct pair_corners {
    uint32_t triangle, vertices[3];
    symbolic_point points[3];
} pair_corners;

static bool load_corners(const named_surface *s, uint32_t triangle, pair_corners *out) {
    out->triangle = triangle;
    for (int i = 0; i < 3; i++) {
        out->vertices[i] = s->mesh->triangles[triangle][i];
        out->points[i] = surface_point(s, out->vertices[i]);
    }
    const symbolic_point *p = out->points;
    return p[0].name != p[1].name && p[1].name != p[2].name && p[2].name != p[0].name;
}

/* How the edge (p, q) passes through the triangle: 1 towards the side of its normal, -1 the other way, 0 not. from and to
 * are the sides on which p and q lie. */
static int ends_pass(symbolic_point p, symbolic_point q, int from, int to, const pair_corners *face) {
    const symbolic_point *f = face->points;
    if (from == to) return 0;
    int turn = symbolic_orient3d(p, q, f[0], f[1]);
    if (symbolic_orient3d(p, q, f[1], f[2]) != turn || symbolic_orient3d(p, q, f[2], f[0]) != turn) return 0;
    return to;
}

/* The same of edge i of another triangle. */
static int edge_passes(const pair_corners *t, int i, int from, int to, const pair_corners *face) {
    return ends_pass(t->points[i], t->points[(i + 1) % 3], from, to, face);
}

/* Lemma 2: an edge of a that passes towards the normal of b begins the piece, one of b towards that of a ends it. */
static void set_end(const named_surface *s, const pair_corners *t, int i, const pair_corners *face, int end,
                    curve_piece *piece) {
    piece->ends[end] = (surface_event){s->mesh->triangle_edges[t->triangle][i], face->triangle};
}

static void find_sides(const pair_corners *t, const pair_corners *face, int sides[3]) {
    const symbolic_point *f = face->points;
    for (int i = 0; i < 3; i++) sides[i] = symbolic_orient3d(f[0], f[1], f[2], t->points[i]);
}

static bool all_on_one_side(const int sides[3]) {
    return sides[0] == sides[1] && sides[1] == sides[2];
}

/* Looks for ends on the edges of one of the triangles; towards is 0 for a and 1 for b. Returns their number. */
static int find_ends(const named_surface *s, const pair_corners *t, const int sides[3],
                     const pair_corners *face, int towards, curve_piece *piece) {
    int found = 0;
    for (int i = 0; i < 3; i++) {
        int passes = edge_passes(t, i, sides[i], sides[(i + 1) % 3], face);
        if (passes == 0) continue;
        set_end(s, t, i, face, passes > 0 ? towards : 1 - towards, piece);
        found++;
    }
    return found;
}

static bool piece_of_strangers(const named_surface *s, const pair_corners *a, const pair_corners *b,
                               curve_piece *piece) {
    int sides_a[3], sides_b[3];
    find_sides(a, b, sides_a);
    if (all_on_one_side(sides_a)) return false;
    find_sides(b, a, sides_b);
    if (all_on_one_side(sides_b)) return false;
    return find_ends(s, a, sides_a, b, 0, piece) + find_ends(s, b, sides_b, a, 1, piece) == 2;
}

/* The edge opposite to a corner, against the other triangle, with which it has no vertex in common. */
static int pass_of_opposite(const pair_corners *t, int corner, const pair_corners *face) {
    const symbolic_point *f = face->points;
    int i = (corner + 1) % 3, j = (corner + 2) % 3;
    int from = symbolic_orient3d(f[0], f[1], f[2], t->points[i]);
    int to = symbolic_orient3d(f[0], f[1], f[2], t->points[j]);
    return edge_passes(t, i, from, to, face);
}

/* Lemma 3: corner i of a is corner j of b. */
static bool piece_at_vertex(const named_surface *s, const pair_corners *a, int i, const pair_corners *b,
                            int j, curve_piece *piece) {
    piece->ends[0] = piece->ends[1] = (surface_event){NO_EDGE, a->vertices[i]};
    int of_a = pass_of_opposite(a, i, b), of_b = of_a != 0 ? 0 : pass_of_opposite(b, j, a);
    if (of_a != 0) set_end(s, a, (i + 1) % 3, b, of_a > 0 ? 0 : 1, piece);
    if (of_b != 0) set_end(s, b, (j + 1) % 3, a, of_b > 0 ? 1 : 0, piece);
    return of_a != 0 || of_b != 0;
}

bool curve_piece_of_pair(const named_surface *s, uint32_t a, uint32_t b, curve_piece *out) {
    pair_corners of_a, of_b;
    int shared = 0, at_a = 0, at_b = 0;
    if (!load_corners(s, a, &of_a) || !load_corners(s, b, &of_b)) return false;
    for (int i = 0; i < 9; i++) {
        if (of_a.points[i / 3].name != of_b.points[i % 3].name) continue;
        at_a = i / 3;
        at_b = i % 3;
        shared++;
    }
    out->a = a;
    out->b = b;
    if (shared == 0) return piece_of_strangers(s, &of_a, &of_b, out);
    return shared == 1 && piece_at_vertex(s, &of_a, at_a, &of_b, at_b, out);
}

/* ---- one event ------------------------------------------------------------------------------------------- */

/* Does the edge have a triangle whose corners are different vertices? Others have no pieces. */
static bool edge_has_sheet(const named_surface *s, uint32_t edge) {
    const cscd_mesh *mesh = s->mesh;
    pair_corners corners;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++) {
        if (load_corners(s, mesh->edge_stars[i], &corners)) return true;
    }
    return false;
}

bool surface_event_happens(const named_surface *s, surface_event event) {
    pair_corners face;
    if (!load_corners(s, event.triangle, &face) || !edge_has_sheet(s, event.edge)) return false;
    const symbolic_point *f = face.points;
    const uint32_t *vertices = s->mesh->edges[event.edge];
    symbolic_point p = surface_point(s, vertices[0]), q = surface_point(s, vertices[1]);
    for (int i = 0; i < 3; i++) {
        if (f[i].name == p.name || f[i].name == q.name) return false;
    }
    int from = symbolic_orient3d(f[0], f[1], f[2], p), to = symbolic_orient3d(f[0], f[1], f[2], q);
    return ends_pass(p, q, from, to, &face) != 0;
}
