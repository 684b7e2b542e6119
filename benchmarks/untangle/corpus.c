/* The list of scenes, and recordings read from files. */
#include "benchmarks/untangle/corpus.h"

#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_LENGTH = 4096, SMALL_TRIANGLES = 10000, LARGE_TRIANGLES = 100000 };

/* ---- the list ------------------------------------------------------------------------------------------ */

static const char *const class_names[TANGLE_CLASS_COUNT] = {"limbs", "folds", "bodies", "rods",
                                                            "cloth", "flush", "heavy"};
static const char *const class_titles[TANGLE_CLASS_COUNT] = {"one body, limb in limb or trunk",
                                                             "skin folded at a joint",
                                                             "several closed bodies",
                                                             "a rod through a body",
                                                             "open cloth",
                                                             "flush, stacked, coplanar",
                                                             "cloth with thousands of curves"};

const char *tangle_class_name(tangle_class class) {
    return class_names[class];
}

const char *tangle_class_title(tangle_class class) {
    return class_titles[class];
}

bool tangle_class_from_name(const char *name, tangle_class *out) {
    for (int i = 0; i < TANGLE_CLASS_COUNT; i++) {
        if (strcmp(class_names[i], name) != 0) continue;
        *out = (tangle_class)i;
        return true;
    }
    return false;
}

/* Scenes that are made here: seeds 1 to `small` at about 10,000 triangles, and 1 to `large` at about 100,000. Even seeds are
 * held out. */
typedef struct made_row {
    const char *name;
    tangle_class class;
    tangle_maker *make;
    uint32_t small, large;
} made_row;

static const made_row made_rows[] = {
    {"worm", TANGLE_LIMBS, tangle_make_worm, 12, 2},
    {"hook", TANGLE_LIMBS, tangle_make_hook, 6, 2},
    {"ring", TANGLE_LIMBS, tangle_make_ring, 4, 2},
    {"coil", TANGLE_LIMBS, tangle_make_coil, 4, 2},
    {"hand", TANGLE_LIMBS, tangle_make_hand, 6, 2},
    {"octopus", TANGLE_LIMBS, tangle_make_octopus, 4, 2},
    {"arms", TANGLE_LIMBS, tangle_make_figure_arms, 4, 2},
    {"legs", TANGLE_LIMBS, tangle_make_figure_legs, 2, 2},
    {"letter", TANGLE_LIMBS, tangle_make_letter_limbs, 6, 2},
    {"knot", TANGLE_LIMBS, tangle_make_knot, 1, 1},
    {"elbow", TANGLE_FOLDS, tangle_make_elbow, 10, 2},
    {"finger", TANGLE_FOLDS, tangle_make_finger, 8, 2},
    {"waist", TANGLE_FOLDS, tangle_make_waist, 6, 2},
    {"spikes", TANGLE_FOLDS, tangle_make_spikes, 1, 1},
    {"balls", TANGLE_BODIES, tangle_make_balls, 10, 3},
    {"boxes", TANGLE_BODIES, tangle_make_boxes, 8, 2},
    {"tori", TANGLE_BODIES, tangle_make_tori, 8, 2},
    {"shapes", TANGLE_BODIES, tangle_make_mixed, 12, 2},
    {"lattice", TANGLE_BODIES, tangle_make_lattice, 1, 1},
    {"slab-ball", TANGLE_BODIES, tangle_make_slab_ball, 4, 2},
    {"obstacle", TANGLE_BODIES, tangle_make_obstacle, 6, 2},
    {"rod", TANGLE_RODS, tangle_make_rods, 15, 5},
    {"skewer", TANGLE_RODS, tangle_make_skewers, 9, 3},
    {"layers", TANGLE_CLOTH, tangle_make_layers, 10, 2},
    {"ribbon", TANGLE_CLOTH, tangle_make_ribbon, 8, 2},
    {"flap", TANGLE_CLOTH, tangle_make_flap, 10, 2},
    {"spike", TANGLE_CLOTH, tangle_make_spike, 6, 2},
    {"tubes", TANGLE_CLOTH, tangle_make_tubes, 9, 3},
    {"drape", TANGLE_CLOTH, tangle_make_drape, 6, 2},
    {"bag", TANGLE_CLOTH, tangle_make_bag, 4, 2},
    {"stack", TANGLE_FLUSH, tangle_make_stack, 12, 2},
    {"wall", TANGLE_FLUSH, tangle_make_wall, 4, 2},
    {"aligned", TANGLE_FLUSH, tangle_make_aligned, 6, 2},
    {"copies", TANGLE_FLUSH, tangle_make_copies, 8, 2},
    {"letters", TANGLE_FLUSH, tangle_make_letters, 4, 2},
    {"meander", TANGLE_FLUSH, tangle_make_meander, 6, 2},
};

/* Recordings, and those that nothing is tuned to. */
typedef struct read_row {
    const char *name;
    tangle_class class;
    bool held_out;
    const char *kind; /* the folder of the data; NULL: ours */
} read_row;

static const read_row read_rows[] = {
    {"capsule-bend", TANGLE_LIMBS, false, NULL},
    {"pawn-drop", TANGLE_LIMBS, false, NULL},
    {"figure-balls", TANGLE_LIMBS, true, NULL},
    {"dumbbell-stairs", TANGLE_LIMBS, true, NULL},
    {"folds", TANGLE_FOLDS, true, NULL},
    {"mannequin", TANGLE_BODIES, false, NULL},
    {"t-pair", TANGLE_BODIES, true, NULL},
    {"w-pair", TANGLE_BODIES, true, NULL},
    {"two-spheres", TANGLE_BODIES, false, NULL},
    {"two-spheres-unequal", TANGLE_BODIES, true, NULL},
    {"three-spheres", TANGLE_BODIES, false, NULL},
    {"three-spheres-unequal", TANGLE_BODIES, true, NULL},
    {"v-shape", TANGLE_BODIES, true, NULL},
    {"u-pair", TANGLE_BODIES, false, NULL},
    {"u-three", TANGLE_BODIES, true, NULL},
    {"mixed", TANGLE_BODIES, false, NULL},
    {"tumble", TANGLE_BODIES, true, NULL},
    {"capsule_bend", TANGLE_LIMBS, false, "sequences"},
    {"coil_compress", TANGLE_LIMBS, true, "sequences"},
    {"hand_fist", TANGLE_LIMBS, false, "sequences"},
    {"fertility_bend", TANGLE_LIMBS, true, "sequences"},
    {"elephant_dance", TANGLE_FOLDS, false, "sequences"},
    {"tori_chain_pull", TANGLE_BODIES, true, "sequences"},
    {"cloth_funnel227", TANGLE_CLOTH, false, "frames"},
    {"cloth_funnel228", TANGLE_CLOTH, false, "frames"},
    {"cloth_ball92", TANGLE_HEAVY, false, "frames"},
    {"cloth_ball93", TANGLE_HEAVY, false, "frames"},
};

static corpus_entry *add_entry(corpus *c) {
    if (c->count == c->capacity) {
        c->capacity = 2 * c->capacity + 64;
        corpus_entry *grown = body_allocate(c->capacity, sizeof *grown);
        if (c->count > 0) memcpy(grown, c->entries, c->count * sizeof *grown);
        free(c->entries);
        c->entries = grown;
    }
    return &c->entries[c->count++];
}

static void add_made(corpus *c, const made_row *row) {
    for (uint32_t i = 0; i < row->small + row->large; i++) {
        corpus_entry *e = add_entry(c);
        e->class = row->class;
        e->make = row->make;
        e->large = i >= row->small;
        e->seed = e->large ? i - row->small + 1 : i + 1;
        e->held_out = e->seed % 2 == 0;
        e->quick = i == 0;
        e->triangle_count = e->large ? LARGE_TRIANGLES : SMALL_TRIANGLES;
        snprintf(e->name, sizeof e->name, "%s-%u%s", row->name, e->seed, e->large ? "-large" : "");
    }
}

static bool is_moment(const char *kind) {
    return strcmp(kind, "frames") == 0;
}

static void add_recording(corpus *c, const read_row *row, const char *models, const char *data) {
    char path[PATH_LENGTH];
    const char *folder = row->kind == NULL ? models : data, *kind = row->kind == NULL ? "." : row->kind;
    if (folder == NULL) return;
    snprintf(path, sizeof path, "%s/%s/%s.%s", folder, kind, row->name, is_moment(kind) ? "ply" : "obj");
    if (access(path, F_OK) != 0) {
        printf("%s is missing%s\n", path, row->kind == NULL ? ": `make models` makes it" : "");
        return;
    }
    corpus_entry *e = add_entry(c);
    e->class = row->class;
    e->held_out = row->held_out;
    e->quick = row->kind == NULL && !row->held_out;
    e->folder = folder;
    e->kind = kind;
    e->large = row->class == TANGLE_HEAVY;
    snprintf(e->name, sizeof e->name, "%s", row->name);
}

corpus corpus_list(const char *models, const char *data) {
    corpus c = {.count = 0};
    if (data == NULL) printf("the recordings of CSCD_DATA are left out: it does not name a folder\n");
    for (int class = 0; class < TANGLE_CLASS_COUNT; class ++) {
        for (size_t i = 0; i < sizeof read_rows / sizeof *read_rows; i++)
            if (read_rows[i].class == (tangle_class) class) add_recording(&c, &read_rows[i], models, data);
        for (size_t i = 0; i < sizeof made_rows / sizeof *made_rows; i++)
            if (made_rows[i].class == (tangle_class) class) add_made(&c, &made_rows[i]);
    }
    return c;
}

void corpus_free(corpus *c) {
    free(c->entries);
    *c = (corpus){.count = 0};
}

/* ---- opening ------------------------------------------------------------------------------------------- */

static void take_mesh(const mesh_file *mesh, tangle_scene *s) {
    body *b = tangle_add_object(s);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *p = mesh->positions + 3 * (size_t)v;
        body_add_vertex(b, p[0], p[1], p[2]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = mesh->triangles + 3 * (size_t)t;
        body_add_triangle(b, c[0], c[1], c[2]);
    }
}

static bool read_recorded(const char *path, tangle_scene *s, io_error *error) {
    animation *frames;
    const uint32_t vertex_count = s->objects[0].vertex_count;
    if (!animation_open(&path, 1, vertex_count, NULL, &frames, error)) return false;
    tangle_begin_frames(s, animation_frame_count(frames));
    bool good = true;
    for (uint32_t f = 0; good && f < s->frame_count; f++)
        good = animation_read(frames, f, s->frames + (size_t)f * vertex_count * 3, error);
    animation_close(frames);
    return good;
}

static bool open_files(const corpus_entry *e, tangle_scene *s, io_error *error) {
    char model[PATH_LENGTH], frames[PATH_LENGTH];
    const bool moment = is_moment(e->kind);
    mesh_file mesh;
    snprintf(model, sizeof model, "%s/%s/%s.%s", e->folder, e->kind, e->name, moment ? "ply" : "obj");
    snprintf(frames, sizeof frames, "%s/%s/%s.pc2", e->folder, e->kind, e->name);
    if (!mesh_file_read(model, &mesh, error)) return false;
    take_mesh(&mesh, s);
    mesh_file_free(&mesh);
    if (!moment) return read_recorded(frames, s, error);
    tangle_begin_frames(s, 1);
    return true;
}

bool corpus_open(const corpus_entry *entry, tangle_scene *out, io_error *error) {
    tangle_scene s = {.object_count = 0};
    const bool good = entry->make != NULL ? entry->make(entry->triangle_count, entry->seed, &s, error)
                                          : open_files(entry, &s, error);
    if (good)
        *out = s;
    else
        tangle_scene_free(&s);
    return good;
}
