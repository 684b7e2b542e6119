/* Orientation predicates that are never 0: each point is thought to be moved by an infinitely small amount of its own.
 *
 * A matrix has a row (x, y, z, 1) per point, sorted by names. Its determinant is a sum over sets of entries, no two in
 * a row or column: the product of what moves them, times the minor that is left without their rows and columns, times
 * a sign. The power of epsilon in front of a minor is the sum of its entries' powers, so that comparing the powers is
 * comparing the sets as binary numbers, bit 3 r + k for coordinate k of row r. */
#include "src/mesh/predicates.h"

#include <assert.h>
#include <stdbool.h>

/* The sets in the order of their powers, up to the first one that leaves the number 1: later ones are never reached. */
static const uint8_t SETS_OF_FOUR[] = {0, 1, 2, 4, 8, 10, 12, 16, 17, 20, 32, 33, 34, 64, 66, 68, 80, 84};

enum { POINTS_MAX = 4 };

/* The part of the matrix that a set of entries leaves. */
typedef struct minor_of_set {
    uint8_t rows[POINTS_MAX], columns[3];
    int row_count, column_count; /* the column of ones is not counted */
    int sign;                    /* in front of the minor */
} minor_of_set;

static minor_of_set leave_out_entries(uint32_t set, int point_count, uint32_t columns) {
    minor_of_set m = {.sign = 1};
    uint32_t used = 0;
    int removed_columns[3], removed = 0, parity = 0;
    for (int r = 0; r < point_count; r++) {
        uint32_t entry = set >> (3 * r) & 7;
        if (entry == 0) {
            m.rows[m.row_count++] = (uint8_t)r;
            continue;
        }
        int column = __builtin_ctz(entry), place = __builtin_popcount(columns & (entry - 1));
        parity += r + place;
        for (int i = 0; i < removed; i++) parity += removed_columns[i] > column;
        removed_columns[removed++] = column;
        used |= entry;
    }
    for (uint8_t k = 0; k < 3; k++) {
        if ((columns & ~used) >> k & 1) m.columns[m.column_count++] = k;
    }
    if (parity % 2 != 0) m.sign = -1;
    return m;
}

/* The sign of the minor with a last column of ones; x and y are coordinates, of which fewer may be left. */
static int minor_sign(const symbolic_point *p, const uint8_t *order, const minor_of_set *m) {
    const double *row[POINTS_MAX];
    for (int i = 0; i < m->row_count; i++) row[i] = p[order[m->rows[i]]].x;
    int x = m->columns[0], y = m->columns[1];
    switch (m->column_count) {
    case 3:
        return -orient3d(row[0], row[1], row[2], row[3]); /* which is that of (b-a), (c-a), (d-a) */
    case 2:
        return orient2d(row[0][x], row[0][y], row[1][x], row[1][y], row[2][x], row[2][y]);
    case 1:
        return (row[0][x] > row[1][x]) - (row[0][x] < row[1][x]);
    default:
        return 1;
    }
}

/* Sorts by names, and returns the sign of the permutation. */
static int sort_points(const symbolic_point *p, int count, uint8_t order[POINTS_MAX]) {
    int sign = 1;
    for (int i = 0; i < count; i++) {
        int j = i;
        for (; j > 0 && p[order[j - 1]].name > p[i].name; j--) {
            order[j] = order[j - 1];
            sign = -sign;
        }
        assert(j == 0 || p[order[j - 1]].name != p[i].name);
        order[j] = (uint8_t)i;
    }
    return sign;
}

symbolic_term symbolic_orient3d_term(const symbolic_point p[4]) {
    symbolic_term term = {.sign = orient3d(p[0].x, p[1].x, p[2].x, p[3].x)};
    int permutation = sort_points(p, 4, term.order);
    for (uint32_t i = 1; term.sign == 0; i++) {
        assert(i < sizeof SETS_OF_FOUR);
        minor_of_set m = leave_out_entries(SETS_OF_FOUR[i], 4, 7);
        term.moved = SETS_OF_FOUR[i];
        term.sign = -permutation * m.sign * minor_sign(p, term.order, &m);
    }
    return term;
}

symbolic_minor symbolic_minor_of(const symbolic_term *term) {
    minor_of_set m = leave_out_entries(term->moved, 4, 7);
    symbolic_minor left = {.point_count = m.row_count};
    for (int i = 0; i < m.row_count; i++) left.points[i] = term->order[m.rows[i]];
    for (int i = 0; i < m.column_count; i++) left.columns[i] = m.columns[i];
    return left;
}

/* Do the entries of the set lie in different columns, all of them among those given? */
static bool is_set_of(uint32_t set, uint32_t columns) {
    uint32_t first = set & 7, second = set >> 3 & 7;
    return (first & (first - 1)) == 0 && (second & (second - 1)) == 0 && (first & second) == 0 &&
           ((first | second) & ~columns) == 0;
}

int symbolic_orient_along(symbolic_point a, symbolic_point b, symbolic_point c, int axis) {
    const symbolic_point p[3] = {a, b, c};
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    int sign = orient2d(a.x[x], a.x[y], b.x[x], b.x[y], c.x[x], c.x[y]);
    if (sign != 0) return sign;
    uint32_t columns = 7u & ~(1u << axis);
    uint8_t order[POINTS_MAX];
    int permutation = sort_points(p, 3, order);
    if (x > y) permutation = -permutation;
    for (uint32_t set = 1; sign == 0; set++) {
        assert(set < 64);
        if (!is_set_of(set, columns)) continue;
        minor_of_set m = leave_out_entries(set, 3, columns);
        sign = permutation * m.sign * minor_sign(p, order, &m);
    }
    return sign;
}

/* The numbers 3 name + coordinate of what moves a term, greatest first. */
static int list_moved(const symbolic_term *term, const symbolic_point *p, uint64_t list[3]) {
    int count = 0;
    for (uint32_t left = term->moved; left != 0;) {
        uint32_t bit = 31 - (uint32_t)__builtin_clz(left);
        left &= ~(1u << bit);
        list[count++] = (uint64_t)p[term->order[bit / 3]].name * 3 + bit % 3;
    }
    return count;
}

int symbolic_compare_terms(const symbolic_term *first, const symbolic_point p[4], const symbolic_term *second,
                           const symbolic_point q[4]) {
    uint64_t a[3], b[3];
    int a_count = list_moved(first, p, a), b_count = list_moved(second, q, b);
    for (int i = 0; i < a_count && i < b_count; i++) {
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    }
    return (a_count > b_count) - (a_count < b_count);
}
