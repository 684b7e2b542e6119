/* Curves in the half plane (radius, height), of straight lines and arcs. */
#include "models/shapes/outline.h"

#include <assert.h>
#include <math.h>

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
