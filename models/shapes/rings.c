/* Bodies of revolution: curves in the half plane (radius, height), and rings of vertices around the axis. */
#include "models/shapes/rings.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* ---- outlines, of straight lines and arcs -------------------------------------------------------------- */

static const double degree = 3.14159265358979323846 / 180.0;

static void add_piece(outline *o, outline_piece piece) {
    assert(o->piece_count < OUTLINE_PIECES_MAX);
    o->pieces[o->piece_count++] = piece;
    o->length += piece.length;
    for (int k = 0; k < 2; k++) o->end[k] = piece.to[k];
}

void outline_line(outline *o, double radius, double height) {
    outline_piece piece = {.from = {o->end[0], o->end[1]}, .to = {radius, height}};
    piece.length = hypot(radius - o->end[0], height - o->end[1]);
    if (piece.length > 1e-9) add_piece(o, piece);
}

static void arc_point(const outline_piece *piece, double angle, double point[2]) {
    point[0] = fmax(piece->centre[0] + piece->size * cos(angle), 0.0);
    point[1] = piece->centre[1] + piece->size * sin(angle);
}

void outline_arc(outline *o, double centre_radius, double centre_height, double size, double from,
                 double to) {
    outline_piece piece = {
        .centre = {centre_radius, centre_height}, .size = size, .angle = {from * degree, to * degree}};
    piece.length = size * fabs(to - from) * degree;
    arc_point(&piece, piece.angle[0], piece.from);
    arc_point(&piece, piece.angle[1], piece.to);
    outline_line(o, piece.from[0], piece.from[1]);
    add_piece(o, piece);
}

/* Returns the angle of the tangent at the start or end of a piece. */
static double tangent_angle(const outline_piece *piece, int end) {
    if (piece->size == 0.0) return atan2(piece->to[1] - piece->from[1], piece->to[0] - piece->from[0]);
    return piece->angle[end] + (piece->angle[1] > piece->angle[0] ? 90.0 : -90.0) * degree;
}

void outline_turn(outline *o, double size, double by) {
    double side = by > 0.0 ? 1.0 : -1.0, heading = tangent_angle(&o->pieces[o->piece_count - 1], 1) / degree;
    double from = heading - 90.0 * side;
    outline_arc(o, o->end[0] - size * cos(from * degree), o->end[1] - size * sin(from * degree), size, from,
                from + by);
}

void outline_at(const outline *o, double along, double point[2]) {
    uint32_t i = 0;
    while (i + 1 < o->piece_count && along > o->pieces[i].length) along -= o->pieces[i++].length;
    const outline_piece *piece = &o->pieces[i];
    double part = fmin(fmax(along / piece->length, 0.0), 1.0);
    if (piece->size > 0.0) {
        arc_point(piece, piece->angle[0] + part * (piece->angle[1] - piece->angle[0]), point);
        return;
    }
    for (int k = 0; k < 2; k++) point[k] = piece->from[k] + part * (piece->to[k] - piece->from[k]);
}

double outline_section(const outline *o, uint32_t *piece) {
    double sum = 0.0;
    while (*piece < o->piece_count) {
        const outline_piece *last = &o->pieces[(*piece)++];
        sum += last->length;
        if (*piece < o->piece_count &&
            cos(tangent_angle(last + 1, 0) - tangent_angle(last, 1)) < cos(20.0 * degree))
            break;
    }
    return sum;
}

/* ---- rings --------------------------------------------------------------------------------------------- */

static const double pi = 3.14159265358979323846;

enum { SIZE_LEAST = 3, SAMPLES = 4000 };

typedef struct ring {
    double radius, height, share; /* share: of the vertices, before it is made a whole number */
    double turn;                  /* of its first corner, in whole turns */
    uint32_t size, first, shift;  /* vertices; corner i is vertex first + (i + shift) % size */
} ring;

static void revolve_point(double radius, double height, double angle, double point[3]) {
    point[0] = radius * cos(angle);
    point[1] = radius * sin(angle);
    point[2] = height;
}

/* Returns the distance between rings: a triangle's height, if triangles are equilateral and rings have `total`
 * vertices in all. */
static double ring_distance(const outline *o, uint32_t total) {
    double sum = 0.0, point[2];
    for (int i = 0; i < SAMPLES; i++) {
        outline_at(o, o->length * (i + 0.5) / SAMPLES, point);
        sum += point[0];
    }
    double area = 2.0 * pi * o->length * sum / SAMPLES, rise = 0.5 * sqrt(3.0);
    return rise * sqrt(area / (rise * total));
}

/* Places rings as evenly as possible, with one at each corner of the outline and none at poles, and returns their
 * number. With rings NULL it only counts them. */
static uint32_t place_rings(const outline *o, double distance, ring *rings) {
    uint32_t piece = 0, count = 0;
    double before = 0.0;
    while (piece < o->piece_count) {
        double length = outline_section(o, &piece), point[2];
        uint32_t steps =
            (uint32_t)fmax(length / distance + 0.5, piece == o->piece_count && o->closed ? 3.0 : 1.0);
        for (uint32_t i = 0; i < steps; i++) {
            if (!o->closed && before == 0.0 && i == 0) continue;
            if (rings != NULL) {
                outline_at(o, before + length * i / steps, point);
                rings[count].radius = point[0];
                rings[count].height = point[1];
            }
            count++;
        }
        before += length;
    }
    return count;
}

static double share_at(const ring *r, double scale) {
    return fmax(SIZE_LEAST, scale * r->radius);
}

static int by_remainder(const void *a, const void *b) {
    const ring *r = *(ring *const *)a, *s = *(ring *const *)b;
    double x = r->share - r->size, y = s->share - s->size;
    return x > y ? -1 : x < y ? 1 : (r > s) - (r < s);
}

/* Distributes the vertices in proportion to the radii, by largest remainders. */
static void apportion_vertices(ring *rings, uint32_t count, uint32_t total) {
    double low = 0.0, high = 1.0, sum = 0.0;
    assert(total >= SIZE_LEAST * count);
    for (int round = 0; round < 200; round++) {
        double scale = 0.5 * (low + high);
        sum = 0.0;
        for (uint32_t k = 0; k < count; k++) sum += share_at(&rings[k], round == 0 ? high : scale);
        if (round == 0 && sum < total) {
            high *= 2.0;
            round = -1;
        } else if (round > 0 && sum < total) {
            low = scale;
        } else if (round > 0) {
            high = scale;
        }
    }
    uint32_t given = 0;
    ring **order = body_allocate(count, sizeof *order);
    for (uint32_t k = 0; k < count; k++) {
        rings[k].share = share_at(&rings[k], low);
        rings[k].size = (uint32_t)rings[k].share;
        given += rings[k].size;
        order[k] = &rings[k];
    }
    qsort(order, count, sizeof(ring *), by_remainder);
    for (uint32_t k = 0; given < total; k = (k + 1) % count, given++) order[k]->size++;
    free(order);
}

static void add_vertices(body *b, ring *rings, uint32_t count, rings_place *place) {
    for (uint32_t k = 0; k < count; k++) {
        ring *r = &rings[k];
        r->first = b->vertex_count;
        r->turn = k == 0 ? 0.0 : rings[k - 1].turn + 0.5 / r->size;
        for (uint32_t i = 0; i < r->size; i++) {
            double p[3];
            place(r->radius, r->height, 2.0 * pi * (r->turn + (double)i / r->size), p);
            body_add_vertex(b, p[0], p[1], p[2]);
        }
    }
}

static uint32_t ring_vertex(const ring *r, uint32_t i) {
    return r->first + (i + r->shift) % r->size;
}

/* Joins two rings of any sizes, always stepping on along the one whose next edge has its middle first. */
static void stitch_rings(body *b, const ring *low, const ring *high) {
    uint32_t i = 0, j = 0;
    while (i < low->size || j < high->size) {
        double low_middle = low->turn + (i + 0.5) / low->size,
               high_middle = high->turn + (j + 0.5) / high->size;
        bool along_low = i < low->size && (j == high->size || low_middle <= high_middle);
        uint32_t here = ring_vertex(low, i), above = ring_vertex(high, j);
        if (along_low)
            body_add_triangle(b, here, ring_vertex(low, ++i), above);
        else
            body_add_triangle(b, here, ring_vertex(high, ++j), above);
    }
}

/* Joins the last ring to the first, which starts at the corner that fits. */
static void stitch_around(body *b, const ring *last, ring first) {
    double offset = (last->turn - first.turn) * first.size;
    uint32_t steps = (uint32_t)floor(offset + 0.5);
    first.turn += (double)steps / first.size;
    first.shift = steps % first.size;
    stitch_rings(b, last, &first);
}

static void add_pole(body *b, const ring *r, double height, bool lower, rings_place *place) {
    double p[3];
    place(0.0, height, 0.0, p);
    uint32_t pole = body_add_vertex(b, p[0], p[1], p[2]);
    for (uint32_t i = 0; i < r->size; i++)
        body_add_triangle(b, pole, ring_vertex(r, lower ? i + 1 : i), ring_vertex(r, lower ? i : i + 1));
}

void body_add_rings(body *b, const outline *o, uint32_t triangle_count, rings_place *place) {
    uint32_t total = triangle_count / 2, count;
    double distance = ring_distance(o, total);
    while ((count = place_rings(o, distance, NULL)) * SIZE_LEAST > total) distance *= 1.1;
    ring *rings = body_allocate(count, sizeof *rings);
    place_rings(o, distance, rings);
    if (place == NULL) place = revolve_point;
    apportion_vertices(rings, count, total);
    add_vertices(b, rings, count, place);
    for (uint32_t k = 0; k + 1 < count; k++) stitch_rings(b, &rings[k], &rings[k + 1]);
    if (o->closed)
        stitch_around(b, &rings[count - 1], rings[0]);
    else {
        double end[2];
        outline_at(o, 0.0, end);
        add_pole(b, &rings[0], end[1], true, place);
        add_pole(b, &rings[count - 1], o->end[1], false, place);
    }
    free(rings);
}
