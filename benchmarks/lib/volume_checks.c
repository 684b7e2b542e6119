/* Checks of what searches with volumes find: nothing that is in contact is missing, and k-DOPs nest. */
#include "benchmarks/lib/volume_checks.h"

#include <stdlib.h>
#include <string.h>

/* ---- contacts ---------------------------------------------------------------------------------------- */

static uint64_t key_of(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static bool add_key(wanted_pairs *p, uint64_t key) {
    if (p->count == p->capacity) {
        size_t capacity = 2 * p->capacity + 64;
        uint64_t *keys = realloc(p->keys, capacity * sizeof *keys);
        if (keys == NULL) return false;
        p->keys = keys;
        bool *marks = realloc(p->marks, capacity * sizeof *marks);
        if (marks == NULL) return false;
        p->marks = marks;
        p->capacity = capacity;
    }
    p->keys[p->count++] = key;
    return true;
}

/* Triangles that have a feature. */
typedef struct feature_star {
    const uint32_t *triangles;
    uint32_t count;
} feature_star;

static feature_star star_of(const uint32_t *offsets, const uint32_t *stars, uint32_t feature) {
    return (feature_star){stars + offsets[feature], offsets[feature + 1] - offsets[feature]};
}

static bool share_vertex(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (int i = 0; i < 9; i++) {
        if (mesh->triangles[a][i / 3] == mesh->triangles[b][i % 3]) return true;
    }
    return false;
}

static bool add_stars(wanted_pairs *p, const cscd_mesh *mesh, const culling *by, feature_star a,
                      feature_star b) {
    for (uint32_t i = 0; i < a.count; i++) {
        for (uint32_t j = 0; j < b.count; j++) {
            uint32_t first = a.triangles[i], second = b.triangles[j];
            if (share_vertex(mesh, first, second)) continue;
            if (by != NULL && !culling_keeps(by, first, second)) continue;
            if (!add_key(p, key_of(first, second))) return false;
        }
    }
    return true;
}

static int compare_keys(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

bool wanted_pairs_collect(wanted_pairs *p, const cscd_mesh *mesh, const culling *by,
                          const cscd_contacts *contacts) {
    p->count = 0;
    for (size_t i = 0; i < contacts->count; i++) {
        const cscd_contact *c = &contacts->items[i];
        feature_star a, b = {&c->b, 1};
        if (c->kind == CSCD_CONTACT_VF) {
            a = star_of(mesh->vertex_star_offsets, mesh->vertex_stars, c->a);
        } else {
            a = star_of(mesh->edge_star_offsets, mesh->edge_stars, c->a);
            b = star_of(mesh->edge_star_offsets, mesh->edge_stars, c->b);
        }
        if (!add_stars(p, mesh, by, a, b)) return false;
    }
    if (p->count == 0) return true;
    qsort(p->keys, p->count, sizeof *p->keys, compare_keys);
    size_t kept = 1;
    for (size_t i = 1; i < p->count; i++) {
        if (p->keys[i] != p->keys[i - 1]) p->keys[kept++] = p->keys[i];
    }
    p->count = kept;
    return true;
}

void wanted_pairs_free(wanted_pairs *p) {
    free(p->keys);
    free(p->marks);
    *p = (wanted_pairs){0};
}

bool wanted_pairs_found(wanted_pairs *p, const volume_search *s) {
    size_t found = 0;
    if (p->count == 0) return true;
    memset(p->marks, 0, p->count * sizeof *p->marks);
    for (size_t i = 0; i < s->count; i++) {
        uint64_t key = key_of(s->pairs[i][0], s->pairs[i][1]);
        const uint64_t *at = bsearch(&key, p->keys, p->count, sizeof *p->keys, compare_keys);
        if (at == NULL || p->marks[at - p->keys]) continue;
        p->marks[at - p->keys] = true;
        found++;
    }
    return found == p->count;
}

/* ---- nesting ----------------------------------------------------------------------------------------- */

bool volume_search_within(const volume_search *s, const volume_search *of) {
    size_t at = 0;
    if (s->tests > of->tests || s->adjacent > of->adjacent) return false;
    for (size_t i = 0; i < s->count; i++) {
        while (at < of->count && memcmp(of->pairs[at], s->pairs[i], sizeof *s->pairs) != 0) at++;
        if (at++ == of->count) return false;
    }
    return true;
}
