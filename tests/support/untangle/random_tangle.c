/* Random small tangles, and which of their pairs count. */
#include "tests/support/untangle/random_tangle.h"

#include "tests/support/solver/exact_distance.h"

#include <math.h>
#include <string.h>

static const double half_turn = 3.14159265358979323846;

const char *random_tangle_name(random_tangle_class of) {
    static const char *const names[TANGLE_CLASSES] = {"bodies", "sheets", "folds",     "rods",
                                                      "boxes",  "soups",  "one place", "mixtures"};
    return names[of];
}

static bool one_in(random_stream *random, uint32_t count) {
    return stream_below(random, count) == 0;
}

static double signed_unit(random_stream *random) {
    return stream_between(random, -1.0, 1.0);
}

/* ---- objects ------------------------------------------------------------------------------------------- */

/* Where the next object's vertices and triangles go. */
typedef struct object_maker {
    random_tangle *t;
    random_stream *random;
    double *x;
    uint32_t (*own)[3];
    uint32_t vertices, triangles;
} object_maker;

static object_maker begin_object(random_tangle *t, random_stream *random) {
    const uint32_t o = t->object_count;
    return (object_maker){t, random, t->x + 3 * (size_t)t->first_vertex[o], t->own + t->first_triangle[o],
                          0, 0};
}

static void add_vertex(object_maker *m, double x, double y, double z) {
    double *at = m->x + 3 * (size_t)m->vertices++;
    at[0] = x;
    at[1] = y;
    at[2] = z;
}

static void add_triangle(object_maker *m, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *at = m->own[m->triangles++];
    at[0] = a;
    at[1] = b;
    at[2] = c;
}

static void add_square(object_maker *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_triangle(m, a, b, c);
    add_triangle(m, a, c, d);
}

static void end_object(object_maker *m) {
    random_tangle *t = m->t;
    const uint32_t o = t->object_count++;
    t->objects[o] = cscd_object_of_triangles(m->vertices, m->triangles, m->own[0]);
    t->first_vertex[o + 1] = t->first_vertex[o] + m->vertices;
    t->first_triangle[o + 1] = t->first_triangle[o] + m->triangles;
}

/* Turns and moves the object's vertices by a random map, which may flatten them. */
static void place_object(object_maker *m, double most) {
    double map[3][3], middle[3];
    for (int k = 0; k < 9; k++) map[k / 3][k % 3] = signed_unit(m->random);
    for (int k = 0; k < 3; k++) middle[k] = most * signed_unit(m->random);
    for (uint32_t v = 0; v < m->vertices; v++) {
        double *at = m->x + 3 * (size_t)v, p[3];
        for (int k = 0; k < 3; k++)
            p[k] = middle[k] + map[k][0] * at[0] + map[k][1] * at[1] + map[k][2] * at[2];
        memcpy(at, p, sizeof p);
    }
}

static void make_ball(random_tangle *t, random_stream *random, bool pole) {
    object_maker m = begin_object(t, random);
    const uint32_t rings = 3 + stream_below(random, 3), sides = 4 + stream_below(random, 4);
    const double radius = stream_between(random, 0.3, 0.7), flat = one_in(random, 5) ? 0.2 : 1.0;
    add_vertex(&m, 0.0, 0.0, -radius * flat);
    for (uint32_t i = 1; i < rings; i++) {
        for (uint32_t j = 0; j < sides; j++) {
            const double a = half_turn * i / rings, b = 2.0 * half_turn * (j + 0.1) / sides;
            add_vertex(&m, radius * sin(a) * cos(b), radius * sin(a) * sin(b), -radius * flat * cos(a));
        }
    }
    const uint32_t top = m.vertices;
    add_vertex(&m, 0.0, 0.0, radius * flat);
    for (uint32_t j = 0; j < sides; j++) {
        const uint32_t k = (j + 1) % sides, last = 1 + (rings - 2) * sides;
        add_triangle(&m, 0, 1 + k, 1 + j);
        add_triangle(&m, top, last + j, last + k);
        for (uint32_t i = 0; i + 2 < rings; i++) {
            const uint32_t v = 1 + i * sides;
            add_square(&m, v + j, v + k, v + sides + k, v + sides + j);
        }
    }
    if (pole) m.x[3 * (size_t)top + 2] -= radius * flat * stream_between(random, 2.0, 4.0);
    for (uint32_t i = 0; one_in(random, 8) && i < m.triangles; i++) {
        const uint32_t a = m.own[i][0];
        m.own[i][0] = m.own[i][1];
        m.own[i][1] = a;
    }
    const double x = 0.5 * signed_unit(random), y = 0.5 * signed_unit(random), z = 0.5 * signed_unit(random);
    for (uint32_t v = 0; v < m.vertices; v++) {
        m.x[3 * (size_t)v] += x;
        m.x[3 * (size_t)v + 1] += y;
        m.x[3 * (size_t)v + 2] += z;
    }
    end_object(&m);
}

/* turns: 0: nearly flat; else it is rolled up so far, through itself. */
static void make_sheet(random_tangle *t, random_stream *random, double turns) {
    object_maker m = begin_object(t, random);
    const uint32_t columns = 2 + stream_below(random, 7),
                   rows = 2 + stream_below(random, turns > 0.0 ? 3 : 7);
    const double wave = one_in(random, 2) ? 0.2 * signed_unit(random) : 0.0;
    for (uint32_t i = 0; i < columns; i++) {
        for (uint32_t j = 0; j < rows; j++) {
            const double u = (double)i / (columns - 1) - 0.5, v = (double)j / (rows - 1) - 0.5;
            const double a = 2.0 * half_turn * turns * u;
            if (turns > 0.0)
                add_vertex(&m, 0.3 * cos(a) * (1.0 + 0.3 * u * v), 0.3 * sin(a) + 0.05 * v, v);
            else
                add_vertex(&m, u, v, wave * sin(7.0 * u) * cos(9.0 * v));
        }
    }
    for (uint32_t i = 0; i + 1 < columns; i++) {
        for (uint32_t j = 0; j + 1 < rows; j++) {
            const uint32_t v = i * rows + j;
            add_square(&m, v, v + rows, v + rows + 1, v + 1);
        }
    }
    place_object(&m, 0.3);
    end_object(&m);
}

static void add_box(object_maker *m, const double low[3], const double size[3]) {
    static const uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const uint32_t first = m->vertices;
    for (int i = 0; i < 8; i++)
        add_vertex(m, low[0] + (i & 1 ? size[0] : 0.0), low[1] + (i & 2 ? size[1] : 0.0),
                   low[2] + (i & 4 ? size[2] : 0.0));
    for (int i = 0; i < 6; i++)
        add_square(m, first + sides[i][0], first + sides[i][1], first + sides[i][2], first + sides[i][3]);
}

/* One box or more in one object, with their corners on a grid of few planes. */
static void make_boxes(random_tangle *t, random_stream *random) {
    object_maker m = begin_object(t, random);
    const uint32_t count = 1 + stream_below(random, 3);
    for (uint32_t i = 0; i < count; i++) {
        double low[3], size[3];
        for (int k = 0; k < 3; k++) {
            low[k] = 0.25 * ((double)stream_below(random, 5) - 2.0);
            size[k] = 0.25 * (1.0 + stream_below(random, 4));
        }
        add_box(&m, low, size);
    }
    end_object(&m);
}

static void make_rod(random_tangle *t, random_stream *random) {
    object_maker m = begin_object(t, random);
    const double thick = stream_between(random, 0.02, 0.2), low[3] = {-1.0, -0.5 * thick, -0.5 * thick},
                 size[3] = {2.0, thick, thick};
    add_box(&m, low, size);
    place_object(&m, 0.2);
    end_object(&m);
}

static void make_soup(random_tangle *t, random_stream *random) {
    object_maker m = begin_object(t, random);
    const uint32_t count = 4 + stream_below(random, 14), triangles = 1 + stream_below(random, 24);
    const bool grid = one_in(random, 2);
    for (uint32_t v = 0; v < count; v++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = grid ? 0.25 * ((double)stream_below(random, 5) - 2.0) : 0.6 * signed_unit(random);
        if (v > 0 && one_in(random, 6)) memcpy(p, m.x, sizeof p); /* two at one place */
        add_vertex(&m, p[0], p[1], p[2]);
    }
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t a = stream_below(random, count), b = (a + 1 + stream_below(random, count - 1)) % count;
        uint32_t c = stream_below(random, count);
        while (c == a || c == b) c = (c + 1) % count;
        add_triangle(&m, a, b, c);
    }
    if (one_in(random, 4)) add_triangle(&m, m.own[0][1], m.own[0][2], m.own[0][0]); /* twice */
    end_object(&m);
}

/* Hair, particles or the ground: they intersect nothing, and come too near. */
static void make_loose(random_tangle *t, random_stream *random) {
    object_maker m = begin_object(t, random);
    const uint32_t kind = stream_below(random, 3), count = kind == 2 ? 1 : 3 + stream_below(random, 8);
    const uint32_t o = t->object_count;
    for (uint32_t v = 0; v < count; v++)
        add_vertex(&m, kind == 2 ? 0.0 : 0.5 * signed_unit(random),
                   kind == 2 ? 0.0 : 0.5 * signed_unit(random), kind == 2 ? -0.5 : 0.5 * signed_unit(random));
    for (uint32_t i = 0; i + 1 < count; i++) {
        t->wires[i][0] = i;
        t->wires[i][1] = i + 1;
    }
    end_object(&m);
    t->normal[2] = 1.0;
    t->objects[o] = kind == 0   ? cscd_object_of_wires(count, count - 1, t->wires[0])
                    : kind == 1 ? cscd_object_of_points(count)
                                : cscd_object_half_space(t->normal);
}

static void make_object(random_tangle *t, random_stream *random, random_tangle_class of) {
    switch (of) {
    case TANGLE_BODIES:
        make_ball(t, random, false);
        break;
    case TANGLE_SHEETS:
        make_sheet(t, random, 0.0);
        break;
    case TANGLE_FOLDS:
        if (one_in(random, 2))
            make_ball(t, random, true);
        else
            make_sheet(t, random, stream_between(random, 1.0, 1.5));
        break;
    case TANGLE_RODS:
        if (t->object_count == 0)
            make_ball(t, random, false);
        else
            make_rod(t, random);
        break;
    case TANGLE_BOXES:
        make_boxes(t, random);
        break;
    default:
        make_soup(t, random);
        break;
    }
}

static void make_objects(random_tangle *t, random_stream *random) {
    static const uint32_t least[TANGLE_CLASSES] = {2, 2, 1, 2, 1, 1, 1, 2},
                          most[TANGLE_CLASSES] = {3, 3, 2, 3, 3, 2, 2, 3};
    t->of = (random_tangle_class)stream_below(random, TANGLE_CLASSES);
    const uint32_t count = least[t->of] + stream_below(random, most[t->of] - least[t->of] + 1);
    random_tangle_class of = t->of;
    for (uint32_t o = 0; o < count; o++) {
        if (t->of == TANGLE_MIXTURES || (t->of == TANGLE_PLACES && o == 0))
            of = (random_tangle_class)stream_below(random, TANGLE_PLACES);
        make_object(t, random, of);
    }
    if (one_in(random, 12)) make_loose(t, random);
    t->vertex_count = t->first_vertex[t->object_count];
    t->triangle_count = t->first_triangle[t->object_count];
    for (uint32_t o = 0; o < t->object_count; o++) {
        if (t->objects[o].kind != CSCD_OBJECT_HALF_SPACE) t->objects[o].obstacle = one_in(random, 8);
        for (uint32_t i = t->first_triangle[o]; i < t->first_triangle[o + 1]; i++) {
            for (int k = 0; k < 3; k++) t->triangles[i][k] = t->own[i][k] + t->first_vertex[o];
        }
    }
}

/* ---- positions ----------------------------------------------------------------------------------------- */

static uint32_t object_of_vertex(const random_tangle *t, uint32_t vertex) {
    uint32_t o = 0;
    while (vertex >= t->first_vertex[o + 1]) o++;
    return o;
}

static uint32_t object_of_triangle(const random_tangle *t, uint32_t triangle) {
    uint32_t o = 0;
    while (triangle >= t->first_triangle[o + 1]) o++;
    return o;
}

/* Vertices of one object, or of all, come to one point, line or plane. */
static void flatten_vertices(random_tangle *t, random_stream *random) {
    const uint32_t o = stream_below(random, t->object_count), axes = 1 + stream_below(random, 3);
    const bool all = one_in(random, 2);
    const uint32_t first = all ? 0 : t->first_vertex[o], end = all ? t->vertex_count : t->first_vertex[o + 1];
    for (uint32_t v = first; v < end; v++) {
        for (size_t k = 0; k < axes; k++) t->x[3 * (size_t)v + k] = t->x[3 * (size_t)first + k];
    }
}

static void scale_positions(random_tangle *t, random_stream *random) {
    static const double scales[] = {1e6, 1e-6, 1e30, 1e-30, 1e80, 1e-80};
    double shift = 0.0;
    t->size = 1.0;
    if (one_in(random, 4)) t->size = scales[stream_below(random, sizeof scales / sizeof *scales)];
    if (one_in(random, 10)) shift = 100.0 * t->size;
    for (size_t i = 0; i < 3 * (size_t)t->vertex_count; i++) t->x[i] = t->x[i] * t->size + shift;
}

static void round_positions(random_tangle *t) {
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        for (size_t k = 3 * (size_t)v; k < 3 * (size_t)v + 3; k++) {
            if (t->is_float[object_of_vertex(t, v)]) t->x[k] = (double)(float)t->x[k];
        }
    }
}

/* What is written to one of two vertices can be stored in both. */
static void join_seams(random_tangle *t) {
    for (size_t i = 0; i < t->seam_count; i++) {
        const uint32_t a = t->seams[i][0], b = t->seams[i][1];
        const bool is_float = t->is_float[object_of_vertex(t, a)] || t->is_float[object_of_vertex(t, b)];
        for (size_t k = 0; k < 3; k++) {
            const double x = t->x[3 * (size_t)a + k];
            t->x[3 * (size_t)a + k] = t->x[3 * (size_t)b + k] = is_float ? (double)(float)x : x;
        }
    }
}

static void make_positions(random_tangle *t, random_stream *random) {
    const size_t n = 3 * (size_t)t->vertex_count;
    if (t->of == TANGLE_PLACES) flatten_vertices(t, random);
    if (one_in(random, 6)) {
        for (size_t i = 0; i < n; i++) t->x[i] = round(8.0 * t->x[i]) / 8.0;
    }
    scale_positions(t, random);
    const bool floats = t->size < 1e35 && t->size > 1e-35;
    const uint32_t scalars = floats ? stream_below(random, 4) : 0;
    for (uint32_t o = 0; o < t->object_count; o++)
        t->is_float[o] = scalars == 1 || (scalars == 2 && one_in(random, 2));
    if (one_in(random, 20)) {
        for (size_t i = 0; i < n; i++) {
            if (t->x[i] == 0.0 || one_in(random, 20)) t->x[i] = -0.0;
        }
    }
    if (one_in(random, 25)) t->x[stream_below(random, (uint32_t)n)] = (double)NAN;
    if (one_in(random, 25)) t->x[stream_below(random, (uint32_t)n)] = t->size * 0x1p-100;
    round_positions(t);
    t->in_place = one_in(random, 2);
}

/* ---- options ------------------------------------------------------------------------------------------- */

static bool has_seam(const random_tangle *t, uint32_t vertex) {
    for (size_t i = 0; i < t->seam_count; i++) {
        if (t->seams[i][0] == vertex || t->seams[i][1] == vertex) return true;
    }
    return false;
}

static void make_seams(random_tangle *t, random_stream *random) {
    for (uint32_t v = 0; v < t->vertex_count; v++) t->names[v] = v;
    const uint32_t tries = one_in(random, 3) ? 1 + stream_below(random, 6) : 0;
    for (uint32_t i = 0; i < tries; i++) {
        const uint32_t a = stream_below(random, t->vertex_count), b = stream_below(random, t->vertex_count);
        const uint32_t o = object_of_vertex(t, a), p = object_of_vertex(t, b);
        if (o == p || has_seam(t, a) || has_seam(t, b) || t->objects[o].triangle_count == 0 ||
            t->objects[p].triangle_count == 0)
            continue;
        t->seams[t->seam_count][0] = a;
        t->seams[t->seam_count++][1] = b;
        t->names[a < b ? b : a] = a < b ? a : b;
    }
    if (!one_in(random, 5)) join_seams(t); /* else their vertices are anywhere */
}

static void make_rules(random_tangle *t, random_stream *random) {
    if (one_in(random, 4)) t->min_separation = stream_between(random, 0.0, 0.04) * t->size;
    t->has_rules = t->min_separation == 0.0 && one_in(random, 4);
    for (uint32_t o = 0; o < t->object_count; o++) {
        t->rules[o] = cscd_object_rule_default();
        if (one_in(random, 2)) t->rules[o].thickness = stream_between(random, 0.0, 0.03) * t->size;
        t->rules[o].self = !one_in(random, 4);
        t->rules[o].obstacle_pairs = one_in(random, 3);
        if (!one_in(random, 4)) continue;
        t->rules[o].category = 1 + stream_below(random, 3);
        t->rules[o].mask = 1 + stream_below(random, 3);
    }
}

static void make_left_out(random_tangle *t, random_stream *random) {
    t->ignores = one_in(random, 10);
    if (t->triangle_count > 1 && one_in(random, 6)) t->ignored_count = 1 + stream_below(random, TANGLE_PAIRS);
    for (size_t i = 0; i < t->ignored_count; i++) {
        t->ignored[i][0] = stream_below(random, t->triangle_count);
        t->ignored[i][1] =
            (t->ignored[i][0] + 1 + stream_below(random, t->triangle_count - 1)) % t->triangle_count;
    }
    const bool some = one_in(random, 8);
    for (uint32_t v = 0; v < t->vertex_count; v++) t->is_active[v] = !some || !one_in(random, 4);
    for (size_t i = 0; i < t->seam_count; i++)
        t->is_active[t->seams[i][0]] = t->is_active[t->seams[i][1]] =
            t->is_active[t->seams[i][0]] || t->is_active[t->seams[i][1]];
    for (uint32_t v = 0; some && v < t->vertex_count; v++) {
        if (t->is_active[v]) t->active[t->active_count++] = v;
    }
    for (uint32_t v = 0; t->active_count == 0 && v < t->vertex_count; v++) t->is_active[v] = true;
}

static void make_weights(random_tangle *t, random_stream *random) {
    const uint32_t kind = stream_below(random, 4);
    const bool all = one_in(random, 20);
    t->has_weights = one_in(random, 3);
    for (uint32_t v = 0; v < t->vertex_count; v++) {
        const double r = stream_between(random, 0.0, 1.0);
        t->weights[v] = 0.5 + r;
        if (kind == 0) t->weights[v] = pow(10.0, 60.0 * r - 30.0);
        if (kind == 1 && r < 0.4) t->weights[v] = (double)INFINITY;
        if (kind == 2) t->weights[v] = r < 0.3 ? (double)INFINITY : r < 0.6 ? 1e-300 : 1e300;
        if (all) t->weights[v] = (double)INFINITY;
    }
}

void random_tangle_make(uint64_t seed, random_tangle *out) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_AUTO, CSCD_METHOD_SINGLE};
    random_stream random = stream_start(seed);
    memset(out, 0, sizeof *out);
    make_objects(out, &random);
    make_positions(out, &random);
    make_seams(out, &random);
    make_rules(out, &random);
    make_left_out(out, &random);
    make_weights(out, &random);
    out->method = methods[stream_below(&random, 3)];
    out->max_rounds = one_in(&random, 8) ? 20 : stream_below(&random, 10);
    out->max_steps = one_in(&random, 8) ? 20 : stream_below(&random, 8);
    if (one_in(&random, 6)) out->spread = out->size * pow(10.0, 2.0 * signed_unit(&random));
}

void random_tangle_move(random_tangle *t, random_stream *random) {
    const double far = t->size * pow(10.0, -3.0 * stream_between(random, 0.0, 1.0));
    const bool each = one_in(random, 3), pins_stay = one_in(random, 2);
    for (uint32_t o = 0; o < t->object_count; o++) {
        double way[3];
        for (int k = 0; k < 3; k++) way[k] = far * signed_unit(random);
        for (uint32_t v = t->first_vertex[o]; v < t->first_vertex[o + 1]; v++) {
            const bool stays = pins_stay && random_tangle_held(t, v);
            for (size_t k = 0; !stays && k < 3; k++)
                t->x[3 * (size_t)v + k] += each ? far * signed_unit(random) : way[k];
        }
    }
    round_positions(t);
    join_seams(t);
}

/* ---- the library --------------------------------------------------------------------------------------- */

cscd_mesh *random_tangle_mesh(const random_tangle *t, cscd_context *context) {
    cscd_mesh *mesh = NULL;
    return cscd_mesh_create(context, t->objects, t->object_count, &mesh) == CSCD_OK ? mesh : NULL;
}

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_TT && (a * 7 + b) % 11 == 0;
}

cscd_detector *random_tangle_detector(const random_tangle *t, const cscd_mesh *mesh, cscd_context *context) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    options.method = t->method;
    options.min_separation = t->min_separation;
    options.seams = t->seam_count > 0 ? t->seams[0] : NULL;
    options.seam_count = t->seam_count;
    options.seam_reach = (double)INFINITY;
    options.ignored = t->ignored_count > 0 ? t->ignored[0] : NULL;
    options.ignored_count = t->ignored_count;
    options.rules = t->has_rules ? t->rules : NULL;
    options.rule_count = t->has_rules ? t->object_count : 0;
    options.ignore = t->ignores ? ignore_some : NULL;
    if (cscd_detector_create(context, mesh, NULL, &options, &detector) != CSCD_OK) return NULL;
    if (t->active_count == 0 || cscd_detector_set_active(detector, t->active, t->active_count) == CSCD_OK)
        return detector;
    cscd_detector_destroy(detector);
    return NULL;
}

/* ---- what counts --------------------------------------------------------------------------------------- */

bool random_tangle_pinned(const random_tangle *t, uint32_t vertex) {
    const uint32_t o = object_of_vertex(t, vertex);
    if (t->objects[o].kind != CSCD_OBJECT_TRIANGLES || t->objects[o].obstacle || !t->is_active[vertex] ||
        (t->has_weights && isinf(t->weights[vertex])))
        return true;
    for (uint32_t i = t->first_triangle[o]; i < t->first_triangle[o + 1]; i++) {
        for (int k = 0; k < 3; k++) {
            if (t->triangles[i][k] == vertex) return false;
        }
    }
    return true;
}

bool random_tangle_held(const random_tangle *t, uint32_t vertex) {
    bool held = random_tangle_pinned(t, vertex);
    for (size_t i = 0; i < t->seam_count; i++) {
        for (int k = 0; k < 2; k++)
            held |= t->seams[i][k] == vertex && random_tangle_pinned(t, t->seams[i][1 - k]);
    }
    return held;
}

static bool objects_look(const random_tangle *t, uint32_t i, uint32_t j) {
    const cscd_object_rule *p = &t->rules[i], *q = &t->rules[j];
    if (t->objects[i].obstacle && t->objects[j].obstacle) {
        if (i == j || !t->has_rules || !p->obstacle_pairs || !q->obstacle_pairs) return false;
    }
    if (!t->has_rules) return true;
    return i == j ? p->self : (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

static bool any_active(const random_tangle *t, const uint32_t *vertices, int count) {
    for (int k = 0; k < count; k++) {
        if (t->is_active[vertices[k]]) return true;
    }
    return false;
}

static bool is_ignored(const random_tangle *t, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < t->ignored_count; i++) {
        const uint32_t p = t->ignored[i][0], q = t->ignored[i][1];
        if ((p == a && q == b) || (p == b && q == a)) return true;
    }
    return false;
}

static bool is_left_out(const random_tangle *t, uint32_t a, uint32_t b) {
    if (!any_active(t, t->triangles[a], 3) && !any_active(t, t->triangles[b], 3)) return true;
    return !objects_look(t, object_of_triangle(t, a), object_of_triangle(t, b)) ||
           (t->ignores && ignore_some(NULL, CSCD_CONTACT_TT, a, b)) || is_ignored(t, a, b);
}

/* Marks triangles of components without area: they intersect nothing. Components are connected at vertices. */
static void mark_collapsed(const random_tangle *t, const whole_oracle *oracle, bool *collapsed) {
    uint32_t labels[TANGLE_VERTICES];
    bool has_area[TANGLE_VERTICES] = {false}, changed = true;
    for (uint32_t v = 0; v < t->vertex_count; v++) labels[v] = v;
    while (changed) {
        changed = false;
        for (uint32_t i = 0; i < 3 * t->triangle_count; i++) {
            uint32_t *a = &labels[t->triangles[i / 3][i % 3]], *b = &labels[t->triangles[i / 3][(i + 1) % 3]];
            changed |= *a != *b;
            *a = *b = *a < *b ? *a : *b;
        }
    }
    for (uint32_t i = 0; i < t->triangle_count; i++)
        has_area[labels[t->triangles[i][0]]] |= whole_oracle_has_area(oracle, i);
    for (uint32_t i = 0; i < t->triangle_count; i++) collapsed[i] = !has_area[labels[t->triangles[i][0]]];
}

size_t random_tangle_pairs(const random_tangle *t, whole_oracle *oracle, const double *x) {
    bool collapsed[TANGLE_TRIANGLES];
    size_t count = 0;
    whole_oracle_take(oracle, t->vertex_count, t->triangle_count, (const uint32_t(*)[3])t->triangles,
                      t->names, x);
    mark_collapsed(t, oracle, collapsed);
    for (uint32_t a = 0; a < t->triangle_count; a++) {
        for (uint32_t b = a + 1; b < t->triangle_count; b++)
            count +=
                !collapsed[a] && !collapsed[b] && whole_oracle_counts(oracle, a, b) && !is_left_out(t, a, b);
    }
    return count;
}

/* ---- gaps ---------------------------------------------------------------------------------------------- */

static double separation_of(const random_tangle *t, uint32_t i, uint32_t j) {
    if (!t->has_rules) return t->min_separation;
    return i == j ? t->rules[i].thickness : 0.5 * (t->rules[i].thickness + t->rules[j].thickness);
}

static bool share_names(const random_tangle *t, const uint32_t *a, int a_count, const uint32_t *b,
                        int b_count) {
    for (int i = 0; i < a_count; i++) {
        for (int j = 0; j < b_count; j++) {
            if (t->names[a[i]] == t->names[b[j]]) return true;
        }
    }
    return false;
}

static bool boxes_are_near(const double *x, const uint32_t *a, int a_count, const uint32_t *b, int b_count,
                           double distance) {
    for (size_t k = 0; k < 3; k++) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < a_count + b_count; i++) {
            const double at = x[3 * (size_t)(i < a_count ? a[i] : b[i - a_count]) + k];
            low[i >= a_count] = fmin(low[i >= a_count], at);
            high[i >= a_count] = fmax(high[i >= a_count], at);
        }
        if (low[1] - high[0] > distance || low[0] - high[1] > distance) return false;
    }
    return true;
}

/* a: a vertex, b: the three of a face; or the two ends of edges each. */
static bool pair_is_too_near(const random_tangle *t, const double *x, const uint32_t *a, int a_count,
                             const uint32_t *b, double distance) {
    const int b_count = 4 - a_count;
    if (share_names(t, a, a_count, b, b_count) || !boxes_are_near(x, a, a_count, b, b_count, distance) ||
        (!any_active(t, a, a_count) && !any_active(t, b, b_count)))
        return false;
    double points[4][3];
    mpq_t length;
    for (int i = 0; i < 4; i++)
        memcpy(points[i], x + 3 * (size_t)(i < a_count ? a[i] : b[i - a_count]), sizeof points[i]);
    mpq_init(length);
    mpq_set_d(length, distance);
    const int sign = distance_sign(a_count == 1 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE, points, length);
    mpq_clear(length);
    return sign < 0;
}

static bool triangles_too_near(const random_tangle *t, const double *x, uint32_t i, uint32_t j,
                               double distance) {
    const uint32_t *a = t->triangles[i], *b = t->triangles[j];
    if (!boxes_are_near(x, a, 3, b, 3, distance)) return false;
    for (int k = 0; k < 3; k++) {
        const uint32_t edge[2] = {a[k], a[(k + 1) % 3]};
        if (pair_is_too_near(t, x, a + k, 1, b, distance) || pair_is_too_near(t, x, b + k, 1, a, distance))
            return true;
        for (int l = 0; l < 3; l++) {
            const uint32_t other[2] = {b[l], b[(l + 1) % 3]};
            if (pair_is_too_near(t, x, edge, 2, other, distance)) return true;
        }
    }
    return false;
}

bool random_tangle_too_near(const random_tangle *t, const double *x) {
    if (t->ignored_count > 0) return false; /* features of ignored triangles belong to others as well */
    for (uint32_t a = 0; a < t->triangle_count; a++) {
        for (uint32_t b = a; b < t->triangle_count; b++) {
            const uint32_t i = object_of_triangle(t, a), j = object_of_triangle(t, b);
            const double distance = separation_of(t, i, j) * (1.0 - 1e-6);
            if (distance > 0.0 && objects_look(t, i, j) && triangles_too_near(t, x, a, b, distance))
                return true;
        }
    }
    return false;
}
