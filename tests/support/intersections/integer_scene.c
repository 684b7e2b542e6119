/* Random meshes on small integers, and all their pairs by the oracle. */
#include "tests/support/intersections/integer_scene.h"

#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

/* ---- meshes -------------------------------------------------------------------------------------------- */

static void make_points(random_stream *random, integer_scene *s) {
    int flat = (int)stream_below(random, 3);
    uint32_t range = 3 + stream_below(random, 4);
    for (uint32_t v = 0; v < ALL_VERTICES; v++) {
        integer_vector *p = &s->points[v];
        p->x = stream_below(random, range);
        p->y = stream_below(random, range);
        p->z = flat > 0 && stream_below(random, 2) == 0 ? 0 : stream_below(random, range);
        s->positions[3 * v] = (double)p->x;
        s->positions[3 * v + 1] = (double)p->y;
        s->positions[3 * v + 2] = (double)p->z;
    }
}

/* Some triangles repeat another one of their object, in another order of corners. */
static void make_triangles(random_stream *random, integer_scene *s) {
    for (uint32_t t = 0; t < ALL_TRIANGLES; t++) {
        uint32_t first = t - t % PART_TRIANGLES, *v = s->own[t];
        if (t > first && stream_below(random, 8) == 0) {
            const uint32_t *twin = s->own[first + stream_below(random, t - first)];
            for (int i = 0; i < 3; i++) v[i] = twin[(i + 1) % 3];
        } else {
            do {
                for (int i = 0; i < 3; i++) v[i] = stream_below(random, PART_VERTICES);
            } while (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]);
        }
        for (int i = 0; i < 3; i++) s->triangles[t][i] = v[i] + t / PART_TRIANGLES * PART_VERTICES;
    }
}

/* ---- what leaves pairs out ------------------------------------------------------------------------------- */

static void unite_names(integer_scene *s) {
    for (uint32_t v = 0; v < ALL_VERTICES; v++) s->names[v] = v;
    for (size_t i = 0; i < s->seam_count; i++) {
        uint32_t a = s->names[s->seams[i][0]], b = s->names[s->seams[i][1]];
        for (uint32_t v = 0; v < ALL_VERTICES; v++) {
            if (s->names[v] == b) s->names[v] = a;
        }
    }
}

static bool names_differ_in_triangles(const integer_scene *s) {
    for (uint32_t t = 0; t < ALL_TRIANGLES; t++) {
        const uint32_t *v = s->triangles[t], *names = s->names;
        if (names[v[0]] == names[v[1]] || names[v[1]] == names[v[2]] || names[v[2]] == names[v[0]])
            return false;
    }
    return true;
}

/* Sews single vertices, at one place or not, or a triangle to one of another object, at one place. */
static void make_seams(random_stream *random, integer_scene *s) {
    s->seam_count = stream_below(random, 2) == 0 ? 0 : stream_below(random, PAIRS_LEFT_OUT - 2);
    for (size_t i = 0; i < s->seam_count; i++) {
        do {
            s->seams[i][0] = stream_below(random, ALL_VERTICES);
            s->seams[i][1] = stream_below(random, ALL_VERTICES);
        } while (s->seams[i][0] == s->seams[i][1]);
    }
    if (s->seam_count >= 3) {
        uint32_t a = stream_below(random, PART_TRIANGLES),
                 b = PART_TRIANGLES + stream_below(random, PART_TRIANGLES);
        for (int i = 0; i < 3; i++) {
            uint32_t v = s->triangles[a][i], w = s->triangles[b][(i + 1) % 3];
            s->seams[i][0] = v;
            s->seams[i][1] = w;
            s->points[w] = s->points[v];
            memcpy(s->positions + 3 * (size_t)w, s->positions + 3 * (size_t)v, sizeof(double[3]));
        }
    }
    unite_names(s);
    if (names_differ_in_triangles(s)) return;
    s->seam_count = 0;
    unite_names(s);
}

static void make_rules(random_stream *random, integer_scene *s) {
    s->has_rules = stream_below(random, 3) == 0;
    for (int i = 0; i < SCENE_PARTS; i++) {
        s->obstacles[i] = stream_below(random, 5) == 0;
        s->rules[i] = cscd_object_rule_default();
        s->rules[i].category = 1 + stream_below(random, 3);
        s->rules[i].mask = 1 + stream_below(random, 3);
        s->rules[i].self = stream_below(random, 3) > 0;
        s->rules[i].obstacle_pairs = stream_below(random, 2) == 0;
    }
}

void integer_scene_make(uint64_t seed, integer_scene *out) {
    random_stream random = stream_start(seed);
    memset(out, 0, sizeof *out);
    make_points(&random, out);
    make_triangles(&random, out);
    make_seams(&random, out);
    make_rules(&random, out);
    out->ignored_count = stream_below(&random, 2) == 0 ? 0 : stream_below(&random, PAIRS_LEFT_OUT);
    for (size_t i = 0; i < out->ignored_count; i++) {
        out->ignored[i][0] = stream_below(&random, ALL_TRIANGLES);
        out->ignored[i][1] = stream_below(&random, ALL_TRIANGLES);
    }
    out->ignores = stream_below(&random, 4) == 0;
    if (stream_below(&random, 4) > 0) return;
    for (uint32_t v = 0; v < ALL_VERTICES; v++) {
        if (stream_below(&random, 5) == 0) out->active[out->active_count++] = v;
    }
}

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_TT && (a * 7 + b) % 5 == 0;
}

cscd_mesh *integer_scene_mesh(const integer_scene *s, cscd_context *context) {
    cscd_object_desc objects[SCENE_PARTS];
    cscd_mesh *mesh = NULL;
    for (int i = 0; i < SCENE_PARTS; i++) {
        objects[i] = cscd_object_of_triangles(PART_VERTICES, PART_TRIANGLES, s->own[i * PART_TRIANGLES]);
        objects[i].obstacle = s->obstacles[i];
    }
    expect_ok(cscd_mesh_create(context, objects, SCENE_PARTS, &mesh));
    return mesh;
}

cscd_detector *integer_scene_detector(const integer_scene *s, const cscd_mesh *mesh, cscd_method method) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    options.method = method;
    options.ours = ours_of_method(method);
    options.seams = s->seam_count > 0 ? s->seams[0] : NULL;
    options.seam_count = s->seam_count;
    options.seam_reach = INFINITY;
    options.ignored = s->ignored_count > 0 ? s->ignored[0] : NULL;
    options.ignored_count = s->ignored_count;
    options.rules = s->has_rules ? s->rules : NULL;
    options.rule_count = s->has_rules ? SCENE_PARTS : 0;
    options.ignore = s->ignores ? ignore_some : NULL;
    if (method == CSCD_METHOD_KMEANS) {
        cscd_plan_options plan_options = cscd_plan_defaults();
        plan_options.method = CSCD_METHOD_KMEANS;
        expect_ok(plan_create_packed(mesh, s->positions, &plan_options, &plan));
    }
    expect_ok(detector_create_here(mesh, plan, &options, &detector));
    cscd_plan_destroy(plan);
    if (s->active_count > 0) expect_ok(cscd_detector_set_active(detector, s->active, s->active_count));
    return detector;
}

/* ---- the oracle ---------------------------------------------------------------------------------------- */

static bool objects_look(const integer_scene *s, uint32_t i, uint32_t j) {
    const cscd_object_rule *p = &s->rules[i], *q = &s->rules[j];
    if (s->obstacles[i] && s->obstacles[j]) {
        if (i == j || !s->has_rules || !p->obstacle_pairs || !q->obstacle_pairs) return false;
    }
    if (!s->has_rules) return true;
    return i == j ? p->self : (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

static bool is_active(const integer_scene *s, uint32_t triangle) {
    for (size_t i = 0; i < s->active_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (s->triangles[triangle][k] == s->active[i]) return true;
        }
    }
    return s->active_count == 0;
}

static bool is_left_out(const integer_scene *s, uint32_t a, uint32_t b) {
    if (!is_active(s, a) && !is_active(s, b)) return true;
    if (!objects_look(s, a / PART_TRIANGLES, b / PART_TRIANGLES)) return true;
    if (s->ignores && ignore_some(NULL, CSCD_CONTACT_TT, a, b)) return true;
    for (size_t i = 0; i < s->ignored_count; i++) {
        uint32_t p = s->ignored[i][0], q = s->ignored[i][1];
        if ((p == a && q == b) || (p == b && q == a)) return true;
    }
    return false;
}

/* The component of a triangle, as it is in the mesh, is asked of the mesh; the object is known. */
size_t integer_scene_pairs(const integer_scene *s, uint64_t kinds, cscd_intersection out[PAIRS_MAX]) {
    size_t count = 0;
    for (uint32_t a = 0; a < ALL_TRIANGLES; a++) {
        for (uint32_t b = a + 1; b < ALL_TRIANGLES; b++) {
            if (is_left_out(s, a, b)) continue;
            int kind = oracle_kind(s->triangles[a], s->triangles[b], s->names, false, s->points);
            if (kind < 0 || (kinds >> kind & 1) == 0) continue;
            out[count++] =
                (cscd_intersection){.a = a,
                                    .b = b,
                                    .kind = (cscd_intersection_kind)kind,
                                    .shared = oracle_shared(s->triangles[a], s->triangles[b], s->names),
                                    .objects = {a / PART_TRIANGLES, b / PART_TRIANGLES}};
        }
    }
    return count;
}
