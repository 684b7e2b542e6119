/* Scenes whose surfaces are in each other, at one moment or in a sequence of frames: what benchmarks/untangle tries. */
#pragma once

#include "models/shapes/body.h"
#include "models/shapes/catalogue.h"
#include "tool/io/io.h"

/* limbs    one closed body, limb in limb or trunk
 * folds    skin folded at a joint, or in its folds
 * bodies   several closed bodies
 * rods     a rod through a body
 * cloth    open surfaces
 * flush    stacked, coplanar, the same twice
 * heavy    cloth with thousands of curves */
typedef enum tangle_class {
    TANGLE_LIMBS,
    TANGLE_FOLDS,
    TANGLE_BODIES,
    TANGLE_RODS,
    TANGLE_CLOTH,
    TANGLE_FLUSH,
    TANGLE_HEAVY,
    TANGLE_CLASS_COUNT
} tangle_class;

enum { TANGLE_OBJECTS_MAX = 40 };

typedef struct tangle_scene {
    uint32_t object_count;
    body objects[TANGLE_OBJECTS_MAX]; /* in the same coordinates, as they begin */
    bool obstacles[TANGLE_OBJECTS_MAX];
    uint32_t vertex_count, triangle_count;
    uint32_t *triangles; /* of all objects, by the vertices of all */
    uint32_t frame_count;
    double *frames;              /* frame_count * vertex_count * 3, in single precision */
    double *weights;             /* per vertex; INFINITY pins it; NULL: 1 each */
    uint32_t *seams, seam_count; /* pairs of vertices that are sewn together */
} tangle_scene;

void tangle_scene_free(tangle_scene *s);

const double *tangle_scene_frame(const tangle_scene *s, uint32_t frame);

/* ---- making scenes ------------------------------------------------------------------------------------- */

/* Adds an empty object; the caller fills it. */
body *tangle_add_object(tangle_scene *s);

/* Adds a body of the catalogue with about this number of triangles, about the origin. */
bool tangle_add_body(tangle_scene *s, body_kind kind, uint32_t triangle_count, io_error *error);

/* When all objects are there: gives the scene so many frames, each as the objects begin. */
void tangle_begin_frames(tangle_scene *s, uint32_t frame_count);

/* When it has frames: pins all vertices that are below a height in the first one. */
void tangle_pin_below(tangle_scene *s, double height);

/* At last: rounds all frames to single precision. */
void tangle_round_frames(tangle_scene *s);

/* A capsule of exactly this number of triangles, an even one, about the origin along z. */
void body_add_rod(body *b, uint32_t triangle_count, double radius, double length);

/* A block of about this number of triangles from the origin to size, of equal squares. */
void body_add_block(body *b, uint32_t triangle_count, const double size[3]);

/* A sheet of rows x columns squares in the plane z = 0, from the origin to (width, depth). */
void body_add_grid(body *b, uint32_t rows, uint32_t columns, double width, double depth);

void body_scale(body *b, double x, double y, double z);
void body_rotate(body *b, double matrix[3][3]);
void body_move(body *b, double x, double y, double z);

/* ---- random numbers, the same every time --------------------------------------------------------------- */

uint64_t tangle_seed(uint32_t seed);
double tangle_random(uint64_t *state, double low, double high);
void tangle_random_rotation(uint64_t *state, double matrix[3][3]);

/* A smooth function of one or two numbers from 0 to 1, of a few waves; about from -1 to 1. */
enum { TANGLE_WAVES = 5 };
typedef struct tangle_waves {
    double along[TANGLE_WAVES], across[TANGLE_WAVES], phases[TANGLE_WAVES];
} tangle_waves;
tangle_waves tangle_random_waves(uint64_t *state, double most);
double tangle_wave_height(const tangle_waves *w, double along, double across);

/* ---- scenes by class ----------------------------------------------------------------------------------- */

/* Makes a scene of about this number of triangles; each seed gives another one. */
typedef bool tangle_maker(uint32_t triangle_count, uint32_t seed, tangle_scene *out, io_error *error);

tangle_maker tangle_make_balls, tangle_make_boxes, tangle_make_tori, tangle_make_mixed, tangle_make_lattice,
    tangle_make_slab_ball, tangle_make_obstacle, tangle_make_rods, tangle_make_skewers;
tangle_maker tangle_make_stack, tangle_make_wall, tangle_make_aligned, tangle_make_copies,
    tangle_make_letters, tangle_make_meander;
tangle_maker tangle_make_worm, tangle_make_hook, tangle_make_coil, tangle_make_ring, tangle_make_hand,
    tangle_make_octopus, tangle_make_figure_arms, tangle_make_figure_legs, tangle_make_letter_limbs,
    tangle_make_knot;
tangle_maker tangle_make_elbow, tangle_make_finger, tangle_make_waist, tangle_make_spikes;
tangle_maker tangle_make_layers, tangle_make_ribbon, tangle_make_flap, tangle_make_spike, tangle_make_tubes,
    tangle_make_drape, tangle_make_bag;
