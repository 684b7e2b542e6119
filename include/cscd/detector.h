/* Context, positions, mesh and detector: what every program needs. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_DETECTOR_API_H
#define CSCD_DETECTOR_API_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef CSCD_API
#if defined(__GNUC__)
#define CSCD_API __attribute__((visibility("default")))
#else
#define CSCD_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Context =============================================================================================== */

/* The context: what everything is created from. It holds the allocator, the threads, the instruction set
 * and the sentence behind the last failure. */

/* How a call ended. Later versions may add values; cscd_status_string knows those of the library. */
typedef enum cscd_status {
    CSCD_OK = 0,
    CSCD_OUT_OF_MEMORY,    /* an allocation failed */
    CSCD_INVALID_ARGUMENT, /* NULL, out of range, not finite, or options that no _defaults() function made */
    CSCD_INVALID_MESH,     /* no triangle, too many, an index beyond vertex_count, a triangle with a vertex
                            * twice */
    CSCD_SYSTEM_ERROR, /* the system refused a thread, or there is no libcscd-baselines.so: CSCD_CHARGE_DENSE */
    CSCD_CANCELLED,    /* the callback in cscd_progress returned false, or cscd_context_cancel was called */
    CSCD_IN_CONTACT,   /* no step is free of contact, because the start is not: cscd_detector_max_step */
    CSCD_BUSY,         /* another call with this context is running: see the rules of callbacks */
    CSCD_NULL_OBJECT,   /* an object that the call needs is NULL. There may be no context then that could
                            * hold a sentence, so cscd_context_detail is what it was before */
    CSCD_LIST_TOO_LONG, /* there is more to list than longest_list allows (cscd_detector_options), or max_memory
                         * (cscd_intersection_options) */
    CSCD_STATUS_MAX_ENUM = 0x7fffffff
} cscd_status;

/* A short English phrase for a status, "unknown status" for any other value; static storage, never NULL. */
CSCD_API const char *cscd_status_string(cscd_status status);

/* The enumerations whose values have names. */
typedef enum cscd_enumeration {
    CSCD_SIMDS,   /* cscd_simd: "auto", "scalar", "avx2", "avx512", "neon" */
    CSCD_METHODS, /* cscd_method: "auto", "none", "single", "kmeans", "charge", and those of cscd/research.h */
    CSCD_MODES,   /* cscd_mode: "all", "earliest" */
    CSCD_VOLUMES, /* cscd_volume: "box", "kdop14" */
    CSCD_REASONS, /* cscd_reason: a part of a sentence, as "open, non-manifold or inconsistently oriented" */
    CSCD_CONTACT_KINDS, /* cscd_contact_kind: "vf", "ee", "tt", "vv", "ev", "vh" */
    CSCD_INTERSECTION_KINDS, /* cscd_intersection_kind: "crossing", "coplanar", "folded", "duplicate", "touching" */
    CSCD_LEFT_OUTS, /* cscd_left_out: "pairs", "curves", "patches", "overlaps", "cut-offs", "depths", "parts" */
    CSCD_CURVE_ENDS, /* cscd_curve_end: "none", "vertex", "border", "junction", "left out" */
    CSCD_ENUMERATION_MAX_ENUM = 0x7fffffff
} cscd_enumeration;

/* The name of a value, "unknown" for any that the library does not know; static storage, never NULL. */
CSCD_API const char *cscd_name(cscd_enumeration of, uint32_t value);

/* The value with this name. False, and *out untouched, if there is none. */
CSCD_API bool cscd_from_name(cscd_enumeration of, const char *name, uint32_t *out);

/* The bytes that max_memory stands for where options have 0: a quarter of the memory that is free now, at least 1. */
CSCD_API size_t cscd_max_memory_default(void);

/* ---- context: allocator, threads, progress ---------------------------------------------------------- */

/* Allocator, threads, instruction set and the last failure's sentence. */
typedef struct cscd_context cscd_context;

/* What holds for callbacks: the allocator, parallel_for and its tasks, progress and ignore.
 *   calls     A call that creates, changes or uses an object of a context in which a call is running fails with
 *             CSCD_BUSY and changes nothing, whether it comes from a callback or from another thread. Functions of
 *             a mesh that return no status may be called at any time, from any thread
 *   destroy   A _destroy function may be called at any time; objects of a context in which a call is running live
 *             until that call ends
 *   floats    The library computes with rounding to nearest, without flushing to zero and without traps, whatever
 *             the caller's floating-point environment is. Every call gives the caller's back, flags included, and
 *             callbacks run in it; so do allocator calls on threads of the library. Tasks of parallel_for give the
 *             environment of the thread that runs them back
 *   failing   A callback must return: it throws no C++ exception, and does not call longjmp. One that cannot go on
 *             calls cscd_context_cancel() and returns: the call that it was called from then fails, and may be
 *             repeated. cscd/cscd.hpp and bindings do so when a callback throws
 *   forking   After fork(), the child has a copy of every object, and its calls run on the thread that makes them,
 *             with the same results: threads of the library stay in the parent. A context in which a call was
 *             running at that moment stays busy in the child, where destroying its objects does nothing. A child
 *             that a callback has forked must not return from it, and no thread may be making a plan with
 *             CSCD_CHARGE_DENSE at that moment. A host's own parallel_for is the host's affair */

/* The host's allocator. Set both functions, or neither for aligned_alloc and free. allocate returns NULL
 * when it fails; alignment is a power of two. release is given the size that was asked for. They are never
 * called from two threads at once, but from any thread: the context's own, and the one that destroys the last
 * object that keeps something of the context. That may be an object of another context, made from a mesh of
 * this one: the memory of a mesh is that of the context in which it was created. */
typedef struct cscd_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *block, size_t size);
    void *user;
} cscd_allocator;

/* Which vector instructions are used. Results are the same on every level, bit for bit. Later versions may
 * add values. */
typedef enum cscd_simd {
    CSCD_SIMD_AUTO,   /* the best that the processor has */
    CSCD_SIMD_SCALAR, /* what every processor of the architecture has */
    CSCD_SIMD_AVX2,
    CSCD_SIMD_AVX512, /* AVX-512 F, VL, DQ and BW */
    CSCD_SIMD_NEON,   /* what every processor of aarch64 has */
    CSCD_SIMD_MAX_ENUM = 0x7fffffff
} cscd_simd;

/* The host's own parallel loop, for hosts that have a thread pool: cscd then starts no threads. run calls
 * task(data, index) once for every index below task_count, in any order, on any threads, and returns when
 * all of these calls have returned. Tasks never wait for each other, so calling them one after the other
 * is correct. A call whose tasks were left out, repeated, or still running when run returned fails with
 * INVALID_ARGUMENT and their numbers; it may be repeated. While a thread waits in run, the pool may give it
 * work that calls cscd with objects of other contexts. Tasks throw nothing. */
typedef struct cscd_parallel_for {
    void (*run)(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);
    void *user;
} cscd_parallel_for;

/* A callback that shows how far a long call is, and may cancel it. cscd_plan_create, cscd_line_search_begin,
 * and the calls that find something for a detector or a line search call it every few milliseconds, on
 * the thread that called them; calls that end sooner do not call it at all. stage: a word or two, static
 * storage. fraction: an estimate in [0,1] of how much of the call is done, which never falls during a
 * call. When report returns false, the call ends with CSCD_CANCELLED. */
typedef struct cscd_progress {
    bool (*report)(void *user, const char *stage, double fraction);
    void *user;
} cscd_progress;

/* Options of a context; start from cscd_context_defaults. */
typedef struct cscd_context_options {
    uint32_t struct_size;           /* set by cscd_context_defaults */
    uint32_t thread_count;          /* 1 by default, 256 at most; 0: one per processor. With parallel_for
                                     * no thread is started, and this says into how many tasks long work is
                                     * cut */
    cscd_simd simd;                 /* AUTO by default; a level that the processor lacks is
                                     * INVALID_ARGUMENT */
    cscd_allocator allocator;       /* aligned_alloc and free by default */
    cscd_parallel_for parallel_for; /* none by default: the context has its own threads */
    cscd_progress progress;         /* none by default: nothing is shown, and nothing can be cancelled */
    char *reason;                   /* where the sentence of a failed cscd_context_create is written, because
                                     * there is no context then that could hold it; NULL by default */
    size_t reason_size; /* bytes that fit there, the 0 at the end included; a longer sentence is cut */
} cscd_context_options;

/* The default options. */
CSCD_API void cscd_context_defaults_sized(cscd_context_options *out, size_t size);
static inline cscd_context_options cscd_context_defaults(void) {
    cscd_context_options options;
    cscd_context_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a context; options may be NULL. SYSTEM_ERROR: the system refused a thread. The sentence of a
 * failure is written where the options say. */
CSCD_API cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);

/* Gives the context back. Objects that were created from it go on working, with its allocator and its
 * threads, until the last of them is destroyed; it frees the memory and ends the threads. The sentences of
 * their failures can no longer be read. */
CSCD_API void cscd_context_destroy(cscd_context *context);

/* Why the last call with an object of the context failed, "" if it succeeded. The sentence lives until the
 * next such call. */
CSCD_API const char *cscd_context_detail(const cscd_context *context);

/* Ends the call that is running in the context with CSCD_CANCELLED, as soon as it can and with nothing written,
 * unless it is done already or is none that says CANCELLED of itself; without a call it does nothing. Any
 * callback may call this, and any thread, which may come too late, though, and then meet the call that comes
 * next. NULL is allowed. An example, a function `ignore` that asks a host in another language:
 *
 *     static bool ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
 *         binding *host = user;
 *         if (!host->failed && !ask_host(host, kind, a, b)) { // it has thrown, and we have caught
 *             host->failed = true;                           // to be thrown again after the call
 *             cscd_context_cancel(host->context);
 *         }
 *         return !host->failed && host->answer;
 *     }
 */
CSCD_API void cscd_context_cancel(cscd_context *context);

/* The number of threads, or with parallel_for of tasks, that long work is shared by. */
CSCD_API uint32_t cscd_context_thread_count(const cscd_context *context);

/* The instruction set in use, never AUTO. */
CSCD_API cscd_simd cscd_context_simd(const cscd_context *context);

/* How many bytes the context and its objects hold at present through the allocator. */
CSCD_API size_t cscd_context_bytes(const cscd_context *context);

/* ==== Positions ============================================================================================= */

/* Views: positions as a solver stores them. Every function that takes positions takes views of them, so
 * nothing has to be copied or converted first. */

/* The type of a coordinate. */
typedef enum cscd_scalar { CSCD_SCALAR_DOUBLE, CSCD_SCALAR_FLOAT } cscd_scalar;

/* Positions, floats or doubles, in structs of any size or by columns: x of vertex i lies at byte i * stride,
 * y and z coordinate_stride and twice coordinate_stride bytes behind it. No alignment is needed. For a matrix
 * with the columns x, y and z, stride is the size of a scalar and coordinate_stride that of a column.
 *
 * A function that takes `const cscd_view *x0` takes an array of views, which hold the vertices of the mesh's
 * objects, object by object. Often that is one view of all vertices: object_count 0 says that it holds all
 * objects that the views before it do not hold. A view that is shorter than its objects is refused. An example,
 * cloth in an array of structs and, as the mesh's second object, a floor in doubles by columns:
 *
 *     struct particle {
 *         float position[3], velocity[3];
 *     } cloth[16] = {{{0}, {0}}};
 *     double floor[3][16] = {{0}}; // x of all vertices, then y, then z
 *     const cscd_view positions[2] = {
 *         {cloth, sizeof cloth, sizeof cloth[0], 0, CSCD_SCALAR_FLOAT, 1},
 *         {floor, sizeof floor, sizeof(double), sizeof floor[0], CSCD_SCALAR_DOUBLE, 1}};
 *     cscd_intersections found;
 *     cscd_status status = cscd_detector_check(detector, positions, &found);
 *     if (status == CSCD_OK) printf("%zu pairs intersect\n", found.count);
 *
 * Views never grow, so they carry no size of their own. */
typedef struct cscd_view {
    const void *data;
    size_t size;              /* of the memory at data, in bytes */
    size_t stride;            /* in bytes; 0: that of three scalars */
    size_t coordinate_stride; /* in bytes; 0: that of one scalar */
    cscd_scalar scalar;       /* doubles by default */
    uint32_t object_count;    /* how many consecutive objects it holds; 0: all that are left */
} cscd_view;

/* The same for positions that a function writes. Its vertices must not overlap each other. Doubles are
 * rounded to the nearest float where scalar says so. */
typedef struct cscd_mutable_view {
    void *data;
    size_t size;
    size_t stride;
    size_t coordinate_stride;
    cscd_scalar scalar;
    uint32_t object_count;
} cscd_mutable_view;

/* Views of vertex_count packed positions x, y, z. */
static inline cscd_view cscd_view_doubles(const double *positions, size_t vertex_count) {
    cscd_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_DOUBLE, 0};
    return view;
}
static inline cscd_view cscd_view_floats(const float *positions, size_t vertex_count) {
    cscd_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_FLOAT, 0};
    return view;
}
static inline cscd_mutable_view cscd_mutable_view_doubles(double *positions, size_t vertex_count) {
    cscd_mutable_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_DOUBLE, 0};
    return view;
}
static inline cscd_mutable_view cscd_mutable_view_floats(float *positions, size_t vertex_count) {
    cscd_mutable_view view = {positions, vertex_count * 3 * sizeof *positions, 0, 0, CSCD_SCALAR_FLOAT, 0};
    return view;
}

/* In C, the same as pointers, which live until the block ends in which they stand:
 *   cscd_detector_step(detector, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), &contacts); */
#ifndef __cplusplus
#define CSCD_DOUBLES(positions, vertex_count)                                                                \
    ((const cscd_view[1]){cscd_view_doubles(positions, vertex_count)})
#define CSCD_FLOATS(positions, vertex_count) ((const cscd_view[1]){cscd_view_floats(positions, vertex_count)})
#define CSCD_MUTABLE_DOUBLES(positions, vertex_count)                                                        \
    ((const cscd_mutable_view[1]){cscd_mutable_view_doubles(positions, vertex_count)})
#define CSCD_MUTABLE_FLOATS(positions, vertex_count)                                                         \
    ((const cscd_mutable_view[1]){cscd_mutable_view_floats(positions, vertex_count)})
#endif

/* ==== Mesh ================================================================================================== */

/* A mesh: the triangles of one object or of a scene of several, which never change, and what follows from
 * them: edges, components, neighbours. Objects may also be wires, points or half-spaces. It holds no
 * positions. */

/* The connectivity of one object or of a scene. */
typedef struct cscd_mesh cscd_mesh;

/* What an object is made of. Later versions may add values. Objects that are not of triangles are *loose*: their
 * features belong to no triangle, and no component. */
typedef enum cscd_object_kind {
    CSCD_OBJECT_TRIANGLES,
    CSCD_OBJECT_WIRES,      /* segments between its vertices, as of hair: edges of the mesh. A vertex that
                             * no wire has takes no part in contacts */
    CSCD_OBJECT_POINTS,     /* its vertices, as of particles; spheres with a thickness (cscd_object_rule) */
    CSCD_OBJECT_HALF_SPACE, /* all that is behind a plane, as the ground. Its one vertex is a point of the
                             * plane and moves as others do; its normal never changes */
    CSCD_OBJECT_KIND_MAX_ENUM = 0x7fffffff
} cscd_object_kind;

/* An object of a mesh. Set members that you do not need to 0. */
typedef struct cscd_object_desc {
    uint32_t vertex_count;     /* 1 or more, below 2^32 - 1; of a half-space 1, of all points at most 2^26 */
    uint32_t triangle_count;   /* 1 or more, at most (2^32 - 1) / 3; 0 unless it is of triangles */
    const uint32_t *triangles; /* triangle_count * 3 indices of the object's own vertices, from 0 on,
                                * counter-clockwise from outside */
    bool obstacle;             /* the caller moves it: pairs within it, and pairs with other obstacles, are
                                * not looked at, neither for contacts nor for intersections nor for proximity */
    uint8_t reserved[7];       /* 0 */
    cscd_object_kind kind;
    uint32_t wire_count;   /* of wires: 1 or more; else 0 */
    const uint32_t *wires; /* wire_count * 2 indices of the object's own vertices; twins count as one */
    double normal[3];      /* of a half-space: out of it, of any length but 0; else 0 */
} cscd_object_desc;

/* Describes a moving object of triangles; all other members are 0. */
static inline cscd_object_desc cscd_object_of_triangles(uint32_t vertex_count, uint32_t triangle_count,
                                                        const uint32_t *triangles) {
    cscd_object_desc desc = {vertex_count, triangle_count, triangles, false, {0}, CSCD_OBJECT_TRIANGLES, 0,
                             NULL,         {0.0, 0.0, 0.0}};
    return desc;
}

/* Describes a moving object of wires. */
static inline cscd_object_desc cscd_object_of_wires(uint32_t vertex_count, uint32_t wire_count,
                                                    const uint32_t *wires) {
    cscd_object_desc desc = {vertex_count,      0,          NULL,  false,          {0},
                             CSCD_OBJECT_WIRES, wire_count, wires, {0.0, 0.0, 0.0}};
    return desc;
}

/* Describes a moving object of points. */
static inline cscd_object_desc cscd_object_of_points(uint32_t vertex_count) {
    cscd_object_desc desc = {vertex_count, 0, NULL, false, {0}, CSCD_OBJECT_POINTS, 0, NULL, {0.0, 0.0, 0.0}};
    return desc;
}

/* Describes a half-space that moves with its one vertex. */
static inline cscd_object_desc cscd_object_half_space(const double normal[3]) {
    cscd_object_desc desc = {
        1, 0, NULL, false, {0}, CSCD_OBJECT_HALF_SPACE, 0, NULL, {normal[0], normal[1], normal[2]}};
    return desc;
}

/* Creates a mesh of object_count objects, 1 or more, of any kinds. Vertices, edges and triangles are numbered
 * object by object, in the given order. Vertices without a triangle are allowed and, unless they are loose, take
 * no part in contacts. Open, non-manifold and inconsistently oriented surfaces are allowed, too; they cost culling
 * only (see cscd_component). INVALID_MESH: the sentence names object and triangle.
 *
 * Loose objects take part in everything that a detector does, but the static check, which is about triangles:
 *   points     against triangles (VF), exactly; against points (VV) and wires (EV) only where these have to keep a
 *              distance, since a point that moves meets no other one exactly
 *   wires      against triangles (VF, EE) and wires (EE), exactly
 *   half-space every vertex of another object that takes part in contacts (VH), exactly. A vertex that is behind the
 *              plane is in contact. Two half-spaces have nothing to do with each other
 * With a distance (min_separation, thickness) all of them keep it. An example, rain on a roof above the ground:
 *
 *     const double up[3] = {0, 0, 1};
 *     cscd_object_desc objects[3] = {cscd_object_of_triangles(vertex_count, triangle_count, roof),
 *                                    cscd_object_of_points(1000), cscd_object_half_space(up)};
 *     objects[2].obstacle = true;
 *     cscd_mesh_create(context, objects, 3, &mesh); // positions: roof, drops, and one point of the ground
 */
CSCD_API cscd_status cscd_mesh_create_sized(cscd_context *context, const cscd_object_desc *objects,
                                            size_t object_size, uint32_t object_count, cscd_mesh **out);
static inline cscd_status cscd_mesh_create(cscd_context *context, const cscd_object_desc *objects,
                                           uint32_t object_count, cscd_mesh **out) {
    return cscd_mesh_create_sized(context, objects, sizeof *objects, object_count, out);
}

/* Gives the mesh back. Objects that were made from it keep it. */
CSCD_API void cscd_mesh_destroy(cscd_mesh *mesh);

/* The context that the mesh was created in. */
CSCD_API cscd_context *cscd_mesh_context(const cscd_mesh *mesh);

/* What a mesh has. Each is numbered from 0 on. */
typedef enum cscd_element {
    CSCD_VERTICES,   /* of all objects, also those without a triangle, and points of half-spaces */
    CSCD_EDGES,      /* wires are edges, too; in the order of (smaller vertex, larger vertex), each once */
    CSCD_TRIANGLES,  /* of all objects */
    CSCD_COMPONENTS, /* see cscd_component */
    CSCD_OBJECTS,    /* in the order in which they were given */
    CSCD_ELEMENT_MAX_ENUM = 0x7fffffff
} cscd_element;

/* How many of them the mesh has. */
CSCD_API uint32_t cscd_mesh_count(const cscd_mesh *mesh, cscd_element what);
static inline uint32_t cscd_mesh_vertex_count(const cscd_mesh *mesh) {
    return cscd_mesh_count(mesh, CSCD_VERTICES);
}
static inline uint32_t cscd_mesh_edge_count(const cscd_mesh *mesh) {
    return cscd_mesh_count(mesh, CSCD_EDGES);
}
static inline uint32_t cscd_mesh_triangle_count(const cscd_mesh *mesh) {
    return cscd_mesh_count(mesh, CSCD_TRIANGLES);
}
static inline uint32_t cscd_mesh_component_count(const cscd_mesh *mesh) {
    return cscd_mesh_count(mesh, CSCD_COMPONENTS);
}
static inline uint32_t cscd_mesh_object_count(const cscd_mesh *mesh) {
    return cscd_mesh_count(mesh, CSCD_OBJECTS);
}

/* ---- its objects --------------------------------------------------------------------------------------- */

/* Where an object's features lie in the numbering of the mesh. Subtract the first index to have the
 * object's own. */
typedef struct cscd_object {
    bool obstacle;
    cscd_object_kind kind;
    uint32_t first_vertex, vertex_count;
    uint32_t first_edge, edge_count;
    uint32_t first_triangle, triangle_count;
} cscd_object;

/* An object, by its place among those given to cscd_mesh_create. */
CSCD_API cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object);

/* The object that a vertex belongs to. */
CSCD_API uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);

/* ---- its features ------------------------------------------------------------------------------------ */

/* Writes the three vertices of a triangle, in the given order. */
CSCD_API void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]);

/* Writes the two vertices of an edge, the smaller one first. */
CSCD_API void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]);

/* Writes the three edges of a triangle: from its vertex 0 to 1, from 1 to 2, from 2 to 0. */
CSCD_API void cscd_mesh_triangle_edges(const cscd_mesh *mesh, uint32_t triangle, uint32_t edges[3]);

/* The arrays of a mesh. */
typedef enum cscd_mesh_array_kind {
    CSCD_TRIANGLE_VERTICES,   /* three for each triangle, as cscd_mesh_triangle writes them */
    CSCD_TRIANGLE_EDGES,      /* three for each triangle, as cscd_mesh_triangle_edges writes them */
    CSCD_TRIANGLE_COMPONENTS, /* one for each triangle: labels for cscd_detector_set_parts */
    CSCD_EDGE_VERTICES,       /* two for each edge, as cscd_mesh_edge writes them */
    CSCD_MESH_ARRAY_KIND_MAX_ENUM = 0x7fffffff
} cscd_mesh_array_kind;

/* One of these arrays. It belongs to the mesh and lives as long. */
CSCD_API const uint32_t *cscd_mesh_array(const cscd_mesh *mesh, cscd_mesh_array_kind kind);

/* The triangles that contain a vertex or an edge, in ascending order; their number, 0 for loose ones, is written
 * to *count. The array belongs to the mesh and lives as long. */
CSCD_API const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count);
CSCD_API const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count);

/* A component: all triangles that can be reached from one of them over common vertices, so it lies in one
 * object. Components are numbered in the order of their first triangles. Only components that are closed
 * manifolds are culled. */
typedef struct cscd_component {
    bool closed_manifold; /* closed, manifold and consistently oriented */
    uint32_t vertex_count, edge_count, triangle_count;
    uint32_t open_edges;            /* edges of one triangle only */
    uint32_t non_manifold_edges;    /* edges of three triangles or more */
    uint32_t non_manifold_vertices; /* vertices whose triangles do not form one fan */
    uint32_t inconsistent_edges;    /* edges whose two triangles run through them in the same direction */
    uint32_t first_open_edge;       /* an example of each defect, UINT32_MAX if there is none */
    uint32_t first_non_manifold_edge;
    uint32_t first_non_manifold_vertex;
    uint32_t first_inconsistent_edge;
    int64_t euler_characteristic; /* V - E + F; a closed oriented component has genus 1 - euler / 2 */
} cscd_component;

/* A component, its counts and its defects. */
CSCD_API cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);

/* The component that a triangle belongs to. */
CSCD_API uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle);

/* A hash of the vertex count and of the triangles in their order, and of all objects where some are loose. A plan
 * that was saved fits a mesh with the same hash. */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

/* ==== Detector ============================================================================================== */

/* A detector finds the contacts of one mesh, interval by interval. It is created once for a mesh, keeps
 * its bounding volume trees between intervals, and is told the positions at the start and at the end of
 * each.
 *
 * A step looks for pairs of triangles that may touch, leaves out by orientation those that certainly do
 * not (culling), and decides each remaining pair of features by an elementary test, whose verdict is that
 * of exact arithmetic on the given doubles. Culling needs a start that is embedded: the mesh neither
 * intersects nor touches itself there. docs/solver/guarantees.md has all promises; docs/theory/culling.md (Yeh
 * 2012) and docs/theory/elementary.md say why they hold. */

/* Finds the contacts of one mesh. */
typedef struct cscd_detector cscd_detector;

/* How triangle pairs that need no test are found and left out. Methods differ in time only: every method
 * promises what the mode says. Later versions may add values; cscd/research.h has methods to compare with. */
typedef enum cscd_method {
    CSCD_METHOD_AUTO, /* by the regions of the plan, without a plan as SINGLE; but only in the components and
                         * intervals in which culling pays, as counts of work tell, else as NONE. A later version
                         * may choose better, with the same results */
    CSCD_METHOD_NONE, /* bounding volumes only */
    CSCD_METHOD_SINGLE, /* culling by orientation, one region for each component */
    CSCD_METHOD_KMEANS, /* culling by orientation, regions by k-means */
    CSCD_METHOD_CHARGE, /* culling by orientation, regions by charge density */
    CSCD_METHOD_MAX_ENUM = 0x7fffffff
} cscd_method;

/* Its name. */
static inline const char *cscd_method_name(cscd_method method) {
    return cscd_name(CSCD_METHODS, method);
}

/* The regions of a mesh and their detector points. */
typedef struct cscd_plan cscd_plan;

/* What a step promises. Later versions may add values. In both modes an empty list proves that there is no contact. Neither promise holds
 * for the published methods, nor after a start that was vouched for and is not embedded. */
typedef enum cscd_mode {
    CSCD_MODE_ALL,      /* every contact of the interval, on any mesh, whatever its state at the start */
    CSCD_MODE_EARLIEST, /* of the contacts of a component with itself those whose toi is the least, or at most
                        * 1e-9 more. All other contacts, and all contacts when there are pairs to leave
                        * out, as in ALL. After such a contact the whole next start is checked, so that
                        * over a recording ALL costs less. See cscd_detector_guarantee */
    CSCD_MODE_MAX_ENUM = 0x7fffffff
} cscd_mode;

/* How a step knows which triangles are clean at its start, because only clean triangles may be culled. A
 * triangle is clean when it neither intersects nor touches its component, neighbours at common corners
 * aside, and lies in the main such part of it; a component is embedded when all of its triangles are
 * clean. A triangle that is clean at the start and takes part in no contact is clean at the end, so most
 * of a start is known from the step before. */
typedef enum cscd_start {
    CSCD_START_PROVE,   /* the step checks the triangles that are not known to be clean */
    CSCD_START_VOUCHED, /* you say that every start is embedded; if that is wrong, contacts may be lost */
    CSCD_START_UNKNOWN, /* only what a cscd_detector_check of the start has shown to be clean is culled */
    CSCD_START_MAX_ENUM = 0x7fffffff
} cscd_start;

/* The bounding volumes of the trees. They differ in time only; boxes are mostly faster (docs/solver/tuning.md). Later
 * versions may add values. */
typedef enum cscd_volume {
    CSCD_VOLUME_BOX,    /* three axes */
    CSCD_VOLUME_KDOP14, /* seven axes, so 14 planes */
    CSCD_VOLUME_MAX_ENUM = 0x7fffffff
} cscd_volume;

/* What a step makes of it that vertices have hardly moved since the one before. Contacts are the same either way, counters
 * are not, nor are the components that AUTO culls. Later versions may add values. */
typedef enum cscd_coherence {
    CSCD_COHERENCE_AUTO, /* in a closed mesh where nothing touches and little moves, the pairs that may come together
                          * are listed once, and tested alone for as long as vertices stay near (docs/solver/tuning.md) */
    CSCD_COHERENCE_OFF, /* every step looks at the whole mesh */
    CSCD_COHERENCE_MAX_ENUM = 0x7fffffff
} cscd_coherence;

/* A vertex and a face, or two edges; for the static check two triangles; with points and wires, and in lists of
 * proximities without repetitions, also two vertices, and an edge and a vertex; a vertex and a half-space. Later
 * versions may add values. */
typedef enum cscd_contact_kind {
    CSCD_CONTACT_VF,
    CSCD_CONTACT_EE,
    CSCD_CONTACT_TT,
    CSCD_CONTACT_VV,
    CSCD_CONTACT_EV,
    CSCD_CONTACT_VH,
    CSCD_CONTACT_KIND_MAX_ENUM = 0x7fffffff
} cscd_contact_kind;

/* Its name. */
static inline const char *cscd_contact_kind_name(cscd_contact_kind kind) {
    return cscd_name(CSCD_CONTACT_KINDS, kind);
}

/* What one object has to do with the others; start from cscd_object_rule_default. It never grows. */
typedef struct cscd_object_rule {
    /* Two objects are looked at when the category of each has a bit in common with the mask of the other. An
     * object that is not looked at with another one touches it unseen: none of their pairs is a contact, an
     * intersection or a proximity. */
    uint64_t category, mask;

    /* A length, 0 for none. Two objects have to stay apart by half of both thicknesses together, an object
     * from itself by its thickness, as if that were their min_separation. Proximity and the static check know
     * no thickness. With a thickness_matrix this is 0, and thickness_class says the row. */
    double thickness;
    uint32_t thickness_class;

    bool self; /* it is looked at with itself, whatever its mask; obstacles never are. Without, it is
                          * neither proven nor culled */
    bool obstacle_pairs; /* an obstacle is looked at with other obstacles that say this, too, if their masks
                          * agree; other objects do not care */
    uint16_t reserved;   /* 0 */
} cscd_object_rule;

/* The rule that changes nothing: category 1, all bits in the mask, no thickness, looked at with itself. */
static inline cscd_object_rule cscd_object_rule_default(void) {
    cscd_object_rule rule = {1, UINT64_MAX, 0.0, 0, true, false, 0};
    return rule;
}

/* Options of a detector; start from cscd_detector_defaults. Arrays are copied; NULL, the default, means
 * none. */
typedef struct cscd_detector_options {
    uint32_t struct_size; /* set by cscd_detector_defaults */
    cscd_method method;   /* AUTO by default */
    cscd_mode mode;       /* ALL by default */
    cscd_start start;     /* PROVE by default */
    cscd_volume volume;   /* BOX by default */

    /* Leaves out pairs: a contact or proximity is not reported when ignore returns true for its kind and
     * features a and b, nor an intersection when it returns true for the kind TT and its triangles a < b. It is
     * called on the calling thread, only for pairs that were found. NULL by default. */
    bool (*ignore)(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);
    void *ignore_user;

    /* Leaves out pairs of triangles, ignored_count of them in any order: intersections of the two, and contacts
     * and proximities of features of which one is in (or is) the one triangle, the other in the other. */
    const uint32_t *ignored;
    size_t ignored_count;

    /* Seams: seam_count pairs of vertices that count as one vertex, as where panels of cloth are sewn
     * together or a texture splits a surface. Features that have such vertices are neighbours, and so
     * never reported. In a chain of pairs all vertices count as one. A vertex has no seam with itself:
     * INVALID_ARGUMENT. */
    const uint32_t *seams;
    size_t seam_count;

    /* A length, and a share of it. With min_separation 0, the default, a contact is a touch. With min_separation
     * d a contact is coming within d: every pair that comes within d is reported, toi is not after the first
     * moment at which its distance is d, and at toi the distance is at most (1 + tolerance) d. So no pair that
     * stays farther apart is reported, except contacts marked as bounded. tolerance is at most 1; 0, the
     * default, stands for 1e-6. It holds for thicknesses of objects, too, and in cscd_detector_max_step and
     * line searches for each pair's floor instead of d. What it allows is never below 2^-42 of the pair's extent
     * along x, y or z, motion included: that is the limit that rounding sets. */
    double min_separation, tolerance;

    /* cscd_detector_max_step goes at most this share of the way to its limiting contact; in (0,1), 0.8 by default. */
    double step_factor;

    /* Who is looked at with whom: one rule for each object of the mesh, or none. */
    const cscd_object_rule *rules;

    /* The distances of objects by their thickness_class: thickness_class_count rows of as many lengths, at most
     * 256, symmetric; in place of thicknesses. With a matrix or a thickness min_separation is 0. Pairs at distance
     * 0 must not touch, as without. */
    const double *thickness_matrix;
    uint32_t rule_count, thickness_class_count;

    /* A pair that starts nearer than min_separation d has a floor in cscd_detector_max_step and line searches, below
     * which it never comes: one of d, s d, s^2 d, ... with s = floor_ratio. In (0,0.999], 0.9 by default. */
    double floor_ratio;

    /* A length: how far apart the two vertices of a seam may be in the first positions that the detector is
     * given; later they may part. A call with positions in which they are farther apart returns
     * INVALID_ARGUMENT and names the pair, since mostly its indices are wrong. 0, the default, stands for
     * the longest edge at the two vertices; INFINITY allows any distance, as for panels that are to be
     * pulled together. */
    double seam_reach;

    /* The most items that a list of contacts, intersections or proximities may have; 0, the default: any number. The
     * call whose list would be longer fails with LIST_TOO_LONG and changes nothing, as one that is cancelled; *out
     * then has no items, but the number that there would be, counted without keeping them. So memory is bounded by
     * this number; in mode EARLIEST, where later contacts are dropped instead, only as far as contacts are not
     * between components or at the same time. Of lists in the form CSCD_NEAR_UNIQUE it bounds the pairs that the items stand for, and of
     * displacement bounds and truncation the near pairs. Functions without a list, as cscd_detector_max_step,
     * know no cap. `ignore` is asked for each pair that is found, also where the list becomes too long. */
    size_t longest_list;

    cscd_coherence coherence; /* AUTO by default */
    uint32_t reserved;        /* 0 */
    uint64_t
        ours; /* the published methods: what is done as CHARGE does it; see cscd/research.h. 0 by default */
} cscd_detector_options;

/* The default options. */
CSCD_API void cscd_detector_defaults_sized(cscd_detector_options *out, size_t size);
static inline cscd_detector_options cscd_detector_defaults(void) {
    cscd_detector_options options;
    cscd_detector_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a detector, which allocates from `context` and fails into it; the mesh may be of another context.
 * The detector keeps the mesh. plan: a plan of the same mesh, of which the detector copies what it needs,
 * or NULL; the methods CHARGE and KMEANS need one of their kind, the others take any or none.
 * options may be NULL. */
CSCD_API cscd_status cscd_detector_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                          const cscd_detector_options *options, cscd_detector **out);

/* Gives the detector back, and with it its lists. Its line searches keep it, and go on working. */
CSCD_API void cscd_detector_destroy(cscd_detector *detector);

/* The mesh that the detector was created for. */
CSCD_API const cscd_mesh *cscd_detector_mesh(const cscd_detector *detector);

/* A contact: two features, when they touch, and where. u and v name the points that touch at time toi or,
 * with min_separation, the nearest points then:
 *   VF  a is a vertex, b a triangle (p0, p1, p2); the point on it is (1-u-v) p0 + u p1 + v p2
 *   EE  a < b are edges; the points are (1-u) a0 + u a1 and (1-v) b0 + v b1
 *   VV  a < b are points
 *   EV  a is a wire, b a point; the point on the wire is (1-u) a0 + u a1
 *   VH  a is a vertex, b a half-space, by its object; its point is the one below the vertex. At time 0 the vertex
 *       may be anywhere behind the plane */
typedef struct cscd_contact {
    cscd_contact_kind kind;
    uint32_t a, b;        /* two features, in the numbering of the mesh */
    bool bounded;         /* only with min_separation: the limit of work was reached, so toi is safe but may
                           * be early, and the pair may stay farther apart than min_separation */
    uint32_t vertices[4]; /* VF: the vertex, then the triangle's three; EE: the two of a, then those of b;
                           * other kinds: see cscd_stencil */
    double toi;           /* time of impact in [0,1], never after the true time; without min_separation it is
                       * before it by less than 1e-9 */
    double u, v;          /* in [0,1], up to rounding */
    double point[3];      /* the middle between the two points at toi */
    double normal[3];     /* unit vector across the features at toi, against the motion of a relative to b; 0
                       * where there is none, as between parallel edges. With min_separation from b's
                       * nearest point to a's, unless the features touch */
} cscd_contact;

/* Contacts, sorted by (toi, kind, a, b). The list belongs to the detector and lives until the next call of
 * it or of one of its line searches. */
typedef struct cscd_contacts {
    const cscd_contact *items;
    size_t count;
    size_t waiting; /* so many pairs of features wait, and are left out: see cscd_detector_set_seams */
    uint32_t collapsed, reserved; /* so many components are, at an end: see cscd_detector_collapsed */
} cscd_contacts;

/* Finds the contacts from positions x0 to positions x1, as the mode promises. The first call
 * builds the trees, so it is slower. Later calls allocate memory only when a list has to grow or has 2^18
 * contacts or more, when a long deformation has made the trees so loose that they are built again, or in the
 * first interval without culling. CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_detector_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                        cscd_contacts *out);

/* Two triangles a < b that intersect or touch at one moment: a vertex or an edge of one and the face of
 * the other, or edges of both, have a point in common. Features that share a vertex do not count, but
 * triangles that share one are tested, too. */
typedef struct cscd_intersection {
    uint32_t a, b;
} cscd_intersection;

/* The state of the mesh at one moment. The list is sorted by (a, b); it belongs to the detector and lives
 * until its next call. */
typedef struct cscd_intersections {
    const cscd_intersection *items;
    size_t count; /* 0: the mesh neither intersects nor touches itself, pairs to leave out aside */
    uint32_t zero_area_triangles; /* how many triangles have all corners on one line */
    uint32_t first_zero_area;     /* the first of them; UINT32_MAX if there is none */
    size_t waiting; /* so many pairs of triangles wait, and are left out: see cscd_detector_set_seams */
    uint32_t collapsed, reserved; /* so many components are: see cscd_detector_collapsed */
} cscd_intersections;

/* The static check: lists exactly the triangle pairs that intersect or touch at the given positions
 * (docs/theory/static-check.md); of wires, points and half-spaces it says nothing. A step that starts there need not check
 * them again. CANCELLED: see cscd_progress. Of the timings only check_ms changes; counters stay those of the last step. */
CSCD_API cscd_status cscd_detector_check(cscd_detector *detector, const cscd_view *positions,
                                         cscd_intersections *out);

/* Why the contacts of a component with itself are complete, or why some may be missing. Later versions
 * may add values. */
typedef enum cscd_reason {
    CSCD_REASON_METHOD,    /* complete: the method does not cull, or does not with min_separation or a
                            * thickness of its own */
    CSCD_REASON_SURFACE,   /* complete: open, non-manifold or inconsistently oriented, so it was not culled */
    CSCD_REASON_CROSSING,  /* complete: the start intersects or touches itself; only the rest was culled,
                            * if any */
    CSCD_REASON_UNPROVEN,  /* complete: the start is not known to be embedded; only what is known was
                            * culled */
    CSCD_REASON_CLEAN,     /* complete: the start is embedded, and there is no contact */
    CSCD_REASON_FINISHED,  /* complete: the start is embedded, there are contacts, and mode ALL found all */
    CSCD_REASON_PUBLISHED, /* contacts may be missing: the method is PUBLISHED or ICCD_PUBLISHED */
    CSCD_REASON_CONTOUR,   /* complete: method ICCD or CONES, which need no embedded start */
    CSCD_REASON_EARLIEST,  /* later contacts are left out, because the mode is EARLIEST */
    CSCD_REASON_OBSTACLE,  /* an obstacle: its contacts with itself are not looked for */
    CSCD_REASON_MASK,      /* its object's rule has self = false: contacts with itself are not looked for */
    CSCD_REASON_COLLAPSED, /* it is collapsed at an end: contacts with itself are not looked for */
    CSCD_REASON_MAX_ENUM = 0x7fffffff
} cscd_reason;

/* The reason as a part of a sentence. */
static inline const char *cscd_reason_text(cscd_reason reason) {
    return cscd_name(CSCD_REASONS, reason);
}

/* What the last step promises for the contacts of a component with itself. */
typedef struct cscd_guarantee {
    bool complete;       /* every contact of the component with itself was reported */
    bool start_embedded; /* the component was embedded at the start: by proof, or because the caller
                          * vouched for it */
    cscd_reason reason;
} cscd_guarantee;

/* The guarantee of the last step for a component; without meaning before the first step. Contacts between
 * two components are complete in every step. */
CSCD_API cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component);

/* How a triangle faced the detector point of its region during the whole last step: 1, away from it (S+);
 * -1, towards it (S-); 0, neither, or the triangle was not clean at the start, or the step was answered from a
 * list (cscd_coherence) and the triangle may not stay so. Without meaning after a step that failed. */
CSCD_API int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle);

/* The number of regions that the detector culls by: those of its plan, or else the components; 0 if it
 * does not cull by orientation, because of its method or with min_separation. */
CSCD_API uint32_t cscd_detector_region_count(const cscd_detector *detector);

/* Writes where the detector point of a region was at the start and at the end of the last step, up to
 * rounding. In between it moved in a straight line. Without meaning before the first step and after a step
 * that failed. */
CSCD_API void cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double p0[3],
                                         double p1[3]);

/* Milliseconds per pipeline stage of the last step. */
typedef struct cscd_timings {
    double update_ms;      /* moving the trees to the new positions */
    double orientation_ms; /* moving the detector points, and finding the triangles that face them */
    double contour_ms;     /* ICCD and CONES only: normal cones and contour tests */
    double traversal_ms;   /* finding the triangle pairs whose volumes overlap */
    double contact_ms;     /* from triangle pairs to contacts: representatives, elementary tests, sorting */
    double total_ms;       /* the whole step, checks of the input included */
    double proof_ms;       /* the static check of the start within the step, a part of the total */
    double check_ms;       /* the last cscd_detector_check, not a part of the total */
    double reserved[4];    /* 0 */
} cscd_timings;

/* What the last step did, in numbers: exact, and the same for any number of threads. */
typedef struct cscd_counters {
    uint64_t static_checks;    /* static checks of the start, or of a part of it, within the step */
    uint64_t clean;            /* triangles that were clean at the start; only these are culled */
    uint64_t rebuilds;         /* 1 if the trees had become loose and were built again, else 0 */
    uint64_t passes;           /* further traversals, for pairs that contacts have uncovered */
    uint64_t plus, minus;      /* triangles that are S+, and S-: see cscd_detector_orientation */
    uint64_t contours, sealed; /* ICCD, CONES: contour tests; and patches that passed theirs, whose pairs were
                                * left out */
    uint64_t boxes_tested;     /* pairs of bounding volumes that the traversal compared */
    uint64_t pcp;              /* potentially colliding pairs: triangle pairs whose volumes overlap */
    uint64_t adjacent;         /* those of them that share a vertex and were left out, because other pairs
                                * test their features (not so in the published methods) */
    uint64_t feature_pairs;    /* pairs of features whose own volumes overlap, each counted once; with
                                * BRUTE all */
    uint64_t tests;            /* elementary tests, one for each of these feature pairs */
    uint64_t by_signs;         /* tests that orientation signs have rejected */
    uint64_t by_roots;         /* tests that intervals around the roots of the coplanarity cubic have
                                * decided */
    uint64_t by_exact;         /* tests that took exact arithmetic, also those of features at rest; the three
                                * add up to all tests, and with min_separation they are 0 */
    uint64_t vf, ee;           /* contacts reported */
    uint64_t bounded;          /* contacts that are marked as bounded */
    uint64_t loose;            /* contacts of other kinds reported: VV, EV and VH */
    uint64_t coherent;         /* 1: the interval was answered from a list of pairs (cscd_coherence). Then
                                * boxes_tested and pcp are 0, and S+ and S- are those that last as long as
                                * the list; else 0 */
    uint64_t reserved[6];      /* 0 */
} cscd_counters;

/* The timings of the last step, and of the last check. */
CSCD_API cscd_timings cscd_detector_timings(const cscd_detector *detector);

/* The counters of the last step. */
CSCD_API cscd_counters cscd_detector_counters(const cscd_detector *detector);

#ifdef __cplusplus
}
#endif

#endif
