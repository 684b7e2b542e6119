/* Prints the bits of what a detector finds, and of plans, so that builds for different machines can be compared: contacts MODEL.obj
 * FRAMES.pc2, or contacts alone, for two sheets that wave through each other and the plan of a body. Nothing here calls a function of mathematics, whose last bits
 * differ from machine to machine. */
#include <cscd/cscd.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 24, SHEET = SIDE * SIDE, FRAMES = 12, FRAMES_MAX = 1000, LENGTH = 30, WIDTH = 10 };

typedef struct played_scene {
    uint32_t vertex_count, triangle_count, frame_count;
    uint32_t *triangles;
    float *positions; /* of all frames */
} played_scene;

static void stop_with(const char *sentence) {
    fprintf(stderr, "contacts: %s\n", sentence);
    exit(1);
}

static void *room_for(size_t count, size_t size) {
    void *room = calloc(count, size);
    if (room == NULL) stop_with("there is not enough memory");
    return room;
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

static void add_sheet(played_scene *s, uint32_t first) {
    for (uint32_t y = 0; y + 1 < SIDE; y++) {
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            uint32_t a = first + y * SIDE + x,
                     corners[6] = {a, a + 1, a + SIDE, a + 1, a + SIDE + 1, a + SIDE};
            memcpy(s->triangles + 3 * (size_t)s->triangle_count, corners, sizeof corners);
            s->triangle_count += 2;
        }
    }
}

/* Heights are parabolas with some noise of a linear congruential generator. */
static played_scene waving_sheets(void) {
    played_scene s = {.vertex_count = 2 * SHEET, .frame_count = FRAMES};
    s.triangles = room_for((size_t)4 * SHEET * 3, sizeof *s.triangles);
    s.positions = room_for((size_t)FRAMES * s.vertex_count * 3, sizeof *s.positions);
    add_sheet(&s, 0);
    add_sheet(&s, SHEET);
    uint32_t noise = 1;
    for (uint32_t i = 0; i < FRAMES * s.vertex_count; i++) {
        uint32_t frame = i / s.vertex_count, vertex = i % s.vertex_count, x = vertex % SIDE,
                 y = vertex / SIDE % SIDE;
        noise = noise * 1664525u + 1013904223u;
        float bend = (float)((x - SIDE / 2.0) * (y - SIDE / 2.0) * 0.01),
              shake = (float)(noise >> 8) * 0x1p-25f;
        float side = vertex < SHEET ? 1.0f : -1.0f;
        float *p = s.positions + (size_t)i * 3;
        p[0] = (float)x + shake;
        p[1] = (float)y - shake;
        p[2] = side * (4.0f - (float)frame * 0.5f) + bend * side + shake;
    }
    return s;
}

/* Two boxes and a bar between them, of cubes. */
static bool is_body(int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x >= LENGTH || y >= WIDTH || z >= WIDTH) return false;
    return x < WIDTH || x >= 2 * WIDTH || (y > 2 && y < 7 && z > 2 && z < 7);
}

/* The number of a corner of the cubes, from 0 in the order in which they are asked for. */
static uint32_t corner_vertex(played_scene *s, uint32_t *numbers, const int corner[3]) {
    uint32_t *number = &numbers[(corner[0] * (WIDTH + 1) + corner[1]) * (WIDTH + 1) + corner[2]];
    if (*number == 0) {
        for (int k = 0; k < 3; k++) s->positions[3 * (size_t)s->vertex_count + (size_t)k] = (float)corner[k];
        *number = ++s->vertex_count;
    }
    return *number - 1;
}

/* The square between a cube and its neighbour along an axis, seen from outside. */
static void add_square(played_scene *s, uint32_t *numbers, const int cube[3], int axis, int side) {
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    uint32_t square[4];
    for (int i = 0; i < 4; i++) {
        int corner[3] = {cube[0], cube[1], cube[2]};
        corner[axis] += side;
        corner[(axis + 1) % 3] += around[side ? i : 3 - i][0];
        corner[(axis + 2) % 3] += around[side ? i : 3 - i][1];
        square[i] = corner_vertex(s, numbers, corner);
    }
    const uint32_t corners[6] = {square[0], square[1], square[2], square[0], square[2], square[3]};
    memcpy(s->triangles + 3 * (size_t)s->triangle_count, corners, sizeof corners);
    s->triangle_count += 2;
}

/* A closed body, which a plan by charge cuts where the bar begins. */
static played_scene cube_body(void) {
    const size_t corners = (size_t)(LENGTH + 1) * (WIDTH + 1) * (WIDTH + 1);
    played_scene s = {.frame_count = 1};
    s.triangles = room_for(corners * 12 * 3, sizeof *s.triangles);
    s.positions = room_for(corners * 3, sizeof *s.positions);
    uint32_t *numbers = room_for(corners, sizeof *numbers);
    for (int i = 0; i < LENGTH * WIDTH * WIDTH; i++) {
        const int cube[3] = {i / (WIDTH * WIDTH), i / WIDTH % WIDTH, i % WIDTH};
        for (int face = 0; face < 6 && is_body(cube[0], cube[1], cube[2]); face++) {
            int next[3] = {cube[0], cube[1], cube[2]};
            next[face / 2] += face % 2 ? 1 : -1;
            if (!is_body(next[0], next[1], next[2])) add_square(&s, numbers, cube, face / 2, face % 2);
        }
    }
    free(numbers);
    return s;
}

static void read_triangles(const char *path, played_scene *s) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) stop_with("the model cannot be opened");
    char line[256];
    size_t room = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        uint32_t v[3];
        if (sscanf(line, "f %" SCNu32 "%*[^ ] %" SCNu32 "%*[^ ] %" SCNu32, &v[0], &v[1], &v[2]) != 3 &&
            sscanf(line, "f %" SCNu32 " %" SCNu32 " %" SCNu32, &v[0], &v[1], &v[2]) != 3)
            continue;
        if (s->triangle_count == room) {
            room = room == 0 ? 1024 : 2 * room;
            s->triangles = realloc(s->triangles, room * 3 * sizeof *s->triangles);
            if (s->triangles == NULL) stop_with("there is not enough memory");
        }
        for (int k = 0; k < 3; k++) s->triangles[3 * (size_t)s->triangle_count + (size_t)k] = v[k] - 1;
        s->triangle_count++;
    }
    fclose(file);
}

/* Both machines are little-endian, as the file is. */
static void read_frames(const char *path, played_scene *s) {
    FILE *file = fopen(path, "rb");
    unsigned char head[32];
    if (file == NULL || fread(head, 1, sizeof head, file) != sizeof head ||
        memcmp(head, "POINTCACHE2", 12) != 0)
        stop_with("the frames are not a point cache");
    memcpy(&s->vertex_count, head + 16, 4);
    memcpy(&s->frame_count, head + 28, 4);
    if (s->vertex_count > 10000000 || s->frame_count > FRAMES_MAX) stop_with("the point cache is too large");
    size_t numbers = (size_t)s->vertex_count * 3 * s->frame_count;
    s->positions = room_for(numbers, sizeof *s->positions);
    if (fread(s->positions, sizeof *s->positions, numbers, file) != numbers)
        stop_with("the point cache ends early");
    fclose(file);
}

/* ---- what is found ----------------------------------------------------------------------------------- */

static uint64_t add_bits(uint64_t hash, const void *value, size_t size) {
    const unsigned char *bytes = value;
    for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t hash_of(const cscd_contacts *contacts) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < contacts->count; i++) {
        const cscd_contact *c = &contacts->items[i];
        const uint32_t kind = (uint32_t)c->kind;
        hash = add_bits(hash, &kind, sizeof kind);
        hash = add_bits(hash, &c->a, sizeof c->a);
        hash = add_bits(hash, &c->b, sizeof c->b);
        hash = add_bits(hash, c->vertices, sizeof c->vertices);
        hash = add_bits(hash, &c->toi, sizeof c->toi);
        hash = add_bits(hash, &c->u, sizeof c->u);
        hash = add_bits(hash, &c->v, sizeof c->v);
        hash = add_bits(hash, c->point, sizeof c->point);
        hash = add_bits(hash, c->normal, sizeof c->normal);
        const unsigned char bounded = c->bounded;
        hash = add_bits(hash, &bounded, sizeof bounded);
    }
    return hash;
}

static void check_status(cscd_context *context, cscd_status status) {
    if (status != CSCD_OK) stop_with(cscd_context_detail(context));
}

static void run_scene(const played_scene *s, double min_separation) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK) stop_with("there is no context");
    const cscd_object_desc object =
        cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = min_separation;
    check_status(context, cscd_mesh_create(context, &object, 1, &mesh));
    check_status(context, cscd_detector_create(context, mesh, NULL, &options, &detector));
    const size_t numbers = (size_t)s->vertex_count * 3;
    for (uint32_t i = 0; i + 1 < s->frame_count; i++) {
        const float *x0 = s->positions + i * numbers, *x1 = x0 + numbers;
        cscd_contacts contacts = {.count = 0};
        cscd_intersections crossing = {.count = 0};
        check_status(context, cscd_detector_step(detector, CSCD_FLOATS(x0, s->vertex_count),
                                                 CSCD_FLOATS(x1, s->vertex_count), &contacts));
        printf("interval %u: %zu contacts %016" PRIx64, i, contacts.count, hash_of(&contacts));
        check_status(context, cscd_detector_check(detector, CSCD_FLOATS(x1, s->vertex_count), &crossing));
        uint64_t hash = 0;
        for (size_t p = 0; p < crossing.count; p++)
            hash = add_bits(hash, &crossing.items[p], sizeof crossing.items[p]);
        printf(", %zu intersections %016" PRIx64 "\n", crossing.count, hash);
    }
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

static uint64_t hash_of_plan(const cscd_plan *plan, uint32_t triangle_count) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (uint32_t t = 0; t < triangle_count; t++) {
        const double charge = cscd_plan_triangle_charge(plan, t);
        const uint32_t region = cscd_plan_triangle_region(plan, t);
        hash = add_bits(hash, &charge, sizeof charge);
        hash = add_bits(hash, &region, sizeof region);
    }
    for (uint32_t r = 0; r < cscd_plan_region_count(plan); r++) {
        const cscd_region region = cscd_plan_region(plan, r);
        hash = add_bits(hash, region.detector_point, sizeof region.detector_point);
        hash = add_bits(hash, &region.visible_share, sizeof region.visible_share);
    }
    return hash;
}

/* The plan by charge of the first frame; or why there is none, which is the same everywhere too. */
static void run_plan(const played_scene *s) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    if (cscd_context_create(NULL, &context) != CSCD_OK) stop_with("there is no context");
    const cscd_object_desc object =
        cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    check_status(context, cscd_mesh_create(context, &object, 1, &mesh));
    if (cscd_plan_create(context, mesh, CSCD_FLOATS(s->positions, s->vertex_count), NULL, &plan) == CSCD_OK)
        printf("plan: %u regions of %u triangles, %016" PRIx64 "\n", cscd_plan_region_count(plan),
               s->triangle_count, hash_of_plan(plan, s->triangle_count));
    else
        printf("no plan: %s\n", cscd_context_detail(context));
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

int main(int argc, char **argv) {
    if (argc != 1 && argc != 3) stop_with("give a model and a point cache, or nothing");
    played_scene s = {.triangle_count = 0};
    if (argc == 1) {
        s = waving_sheets();
    } else {
        read_triangles(argv[1], &s);
        read_frames(argv[2], &s);
    }
    run_scene(&s, 0.0);
    if (argc == 1) {
        played_scene body = cube_body();
        run_scene(&s, 0.01);
        run_plan(&body);
        free(body.triangles);
        free(body.positions);
    } else {
        run_plan(&s);
    }
    free(s.triangles);
    free(s.positions);
    return 0;
}
