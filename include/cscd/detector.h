/* Context, positions, mesh and detector. cscd/cscd.h says what holds for every function. */
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

/* The outcome of a call. */
typedef enum cscd_status {
    CSCD_OK = 0,
    CSCD_OUT_OF_MEMORY,    /* an allocation failed */
    CSCD_INVALID_ARGUMENT, /* NULL, out of range, not finite, or options that no _defaults() function made */
    CSCD_INVALID_MESH,     /* no triangle, too many, an index out of range, or a vertex twice in one */
    CSCD_SYSTEM_ERROR,     /* the system refused a thread, or has no libcscd-baselines.so */
    CSCD_CANCELLED,        /* by cscd_progress or cscd_context_cancel */
    CSCD_IN_CONTACT,       /* the start is in contact, so no step is free: cscd_detector_max_step */
    CSCD_BUSY,             /* another call is running in this context */
    CSCD_NULL_OBJECT,      /* an object is NULL; cscd_context_detail may stay as it was */
    CSCD_LIST_TOO_LONG,    /* the list exceeds longest_list, or max_memory (cscd_intersection_options) */
    CSCD_STATUS_MAX_ENUM = 0x7fffffff
} cscd_status;

/* Returns an English phrase for a status, "unknown status" for any other value; static storage, never
 * NULL. */
CSCD_API const char *cscd_status_string(cscd_status status);

/* The enumerations whose values have names. */
typedef enum cscd_enumeration {
    CSCD_SIMDS,   /* cscd_simd: "auto", "scalar", "avx2", "avx512", "neon" */
    CSCD_METHODS, /* cscd_method: "auto", "none", "single", "kmeans", "charge"; more in cscd/research.h */
    CSCD_MODES,   /* cscd_mode: "all", "earliest" */
    CSCD_VOLUMES, /* cscd_volume: "box", "kdop14" */
    CSCD_REASONS, /* cscd_reason: a part of a sentence, as "open, non-manifold or inconsistently oriented" */
    CSCD_CONTACT_KINDS, /* cscd_contact_kind: "vf", "ee", "tt", "vv", "ev", "vh" */
    /* cscd_intersection_kind: "crossing", "coplanar", "folded", "duplicate", "touching" */
    CSCD_INTERSECTION_KINDS,
    /* cscd_left_out: "pairs", "curves", "patches", "overlaps", "cut-offs", "depths", "parts" */
    CSCD_LEFT_OUTS,
    CSCD_CURVE_ENDS, /* cscd_curve_end: "none", "vertex", "border", "junction", "left out" */
    /* cscd_lens_reason: "buried", "inside out", "looks out", "smaller side", "edge", "flush" */
    CSCD_LENS_REASONS,
    CSCD_ENUMERATION_MAX_ENUM = 0x7fffffff
} cscd_enumeration;

/* Returns the name of a value, "unknown" for one that the library does not know; static storage, never
 * NULL. */
CSCD_API const char *cscd_name(cscd_enumeration of, uint32_t value);

/* Finds the value with this name. Returns false and leaves *out untouched if there is none. */
CSCD_API bool cscd_from_name(cscd_enumeration of, const char *name, uint32_t *out);

/* ---- context: allocator, threads, progress ---------------------------------------------------------- */

/* Everything is created from a context, which holds allocator, threads, instruction set and the last
 * failure's sentence. */
typedef struct cscd_context cscd_context;

/* The rules of callbacks: the allocator, parallel_for and its tasks, progress and ignore.
 *   destroy   A _destroy function may be called at any time; objects live until a running call ends
 *   floats    Callbacks run in the caller's floating-point environment, which every call gives back, flags
 *             included
 *   failing   A callback must return, without a C++ exception or longjmp; if it cannot go on, it calls
 *             cscd_context_cancel(). cscd/cscd.hpp and bindings do this for you
 *   forking   A child of fork() may use its copies of objects, with the same results. A context with a
 *             running call stays busy there, and destroying its objects does nothing. A callback must not
 *             return in a child that it has forked. During fork() no thread may be making a plan with
 *             CSCD_CHARGE_DENSE. The host sees to its own parallel_for */

/* The host's allocator. Set both functions, or neither for aligned_alloc and free. allocate returns NULL when
 * it fails; alignment is a power of two. release gets the size that was allocated. One thread at a time calls
 * them: any that uses the context, or that destroys the last object that keeps something of it. */
typedef struct cscd_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *block, size_t size);
    void *user;
} cscd_allocator;

/* The vector instructions in use. */
typedef enum cscd_simd {
    CSCD_SIMD_AUTO,   /* the best that the processor has */
    CSCD_SIMD_SCALAR, /* what every processor of the architecture has */
    CSCD_SIMD_AVX2,
    CSCD_SIMD_AVX512, /* AVX-512 F, VL, DQ and BW */
    CSCD_SIMD_NEON,   /* what every processor of aarch64 has */
    CSCD_SIMD_MAX_ENUM = 0x7fffffff
} cscd_simd;

/* The host's own parallel loop, in place of threads of cscd; docs/solver/tuning.md has one. run calls
 * task(data, index) once for every index below task_count, in any order, on any threads, and returns after
 * all of them; otherwise the call fails with INVALID_ARGUMENT. Tasks throw nothing. */
typedef struct cscd_parallel_for {
    void (*run)(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);
    void *user;
} cscd_parallel_for;

/* A callback that shows progress and may cancel. cscd_plan_create, cscd_line_search_begin and the calls that
 * find something for a detector or a line search call it every few milliseconds, on the calling thread; short
 * ones do not. stage is a word or two in static storage. fraction, an estimate in [0,1], never falls during a
 * call. If report returns false, the call ends with CSCD_CANCELLED. */
typedef struct cscd_progress {
    bool (*report)(void *user, const char *stage, double fraction);
    void *user;
} cscd_progress;

/* Options of a context; start from cscd_context_defaults. */
typedef struct cscd_context_options {
    uint32_t struct_size; /* set by cscd_context_defaults */
    /* 1 by default, 256 at most; 0: one per processor. With parallel_for: the number of tasks for long
     * work. */
    uint32_t thread_count;
    cscd_simd simd;                 /* AUTO by default; INVALID_ARGUMENT if the processor lacks it */
    cscd_allocator allocator;       /* aligned_alloc and free by default */
    cscd_parallel_for parallel_for; /* none by default: the context has its own threads */
    cscd_progress progress;         /* none by default */
    /* Receives the sentence of a failed cscd_context_create, cut to reason_size bytes with the 0. NULL by
     * default. */
    char *reason;
    size_t reason_size;
} cscd_context_options;

/* Returns the default options of a context. */
CSCD_API void cscd_context_defaults_sized(cscd_context_options *out, size_t size);
static inline cscd_context_options cscd_context_defaults(void) {
    cscd_context_options options;
    cscd_context_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a context. SYSTEM_ERROR: the system refused a thread. */
CSCD_API cscd_status cscd_context_create(const cscd_context_options *options, cscd_context **out);

/* Frees the context. Its objects keep what they need of it until the last of them is destroyed, but the
 * sentences of their failures can no longer be read. */
CSCD_API void cscd_context_destroy(cscd_context *context);

/* Tells why the last call with an object of the context failed, "" if it succeeded. The sentence lives until
 * the next such call. */
CSCD_API const char *cscd_context_detail(const cscd_context *context);

/* Ends the call that is running in the context with CSCD_CANCELLED and nothing written. It does nothing to
 * calls that do not name CANCELLED. Any callback and any thread may call it; a thread that is late may end
 * the next call. NULL is allowed. An example, a function `ignore` that asks a host in another language:
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

/* Facts about a context. */
typedef struct cscd_context_info {
    uint32_t thread_count; /* that share long work; with parallel_for the number of tasks */
    cscd_simd simd;        /* the instruction set in use, never AUTO */
    size_t bytes;          /* that the context and its objects hold now through the allocator */
    uint64_t reserved[4];  /* 0 */
} cscd_context_info;

/* Tells what the context works with, and how much memory it holds. */
CSCD_API cscd_context_info cscd_context_describe(const cscd_context *context);

/* Returns what a max_memory of 0 stands for: a quarter of the memory that the system has free now, in
 * bytes. */
CSCD_API size_t cscd_context_memory_share(const cscd_context *context);

/* ==== Positions ============================================================================================= */

/* The type of a coordinate. */
typedef enum cscd_scalar { CSCD_SCALAR_DOUBLE, CSCD_SCALAR_FLOAT } cscd_scalar;

/* Positions as a solver stores them: x of vertex i lies at byte i * stride, y and z coordinate_stride and
 * twice coordinate_stride bytes behind it. No alignment is needed. For a matrix with the columns x, y and z,
 * stride is the size of a scalar and coordinate_stride that of a column.
 *
 * `const cscd_view *x0` is an array of views, which hold the vertices object by object; one that is too short
 * is refused. An example, cloth in an array of structs and, as the mesh's second object, a floor in doubles
 * by columns:
 *
 *     struct particle {
 *         float position[3], velocity[3];
 *     } cloth[16] = {{{0}, {0}}};
 *     double floor[3][16] = {{0}}; // x of all vertices, then y, then z
 *     const cscd_view positions[2] = {
 *         {cloth, sizeof cloth, sizeof cloth[0], 0, CSCD_SCALAR_FLOAT, 1},
 *         {floor, sizeof floor, sizeof(double), sizeof floor[0], CSCD_SCALAR_DOUBLE, 1}};
 *     cscd_intersections found; // cscd/surface.h
 *     cscd_status status = cscd_detector_check(detector, positions, &found);
 *     if (status == CSCD_OK) printf("%zu pairs intersect\n", found.count);
 */
typedef struct cscd_view {
    const void *data;
    size_t size;              /* of the memory at data, in bytes */
    size_t stride;            /* in bytes; 0: that of three scalars */
    size_t coordinate_stride; /* in bytes; 0: that of one scalar */
    cscd_scalar scalar;       /* doubles by default */
    uint32_t object_count;    /* how many consecutive objects it holds; 0: all that earlier views do not */
} cscd_view;

/* Positions that a function writes, as a cscd_view. Vertices must not overlap. Doubles are rounded to the
 * nearest float where scalar says so. */
typedef struct cscd_mutable_view {
    void *data;
    size_t size;
    size_t stride;
    size_t coordinate_stride;
    cscd_scalar scalar;
    uint32_t object_count;
} cscd_mutable_view;

/* Makes a view of vertex_count packed positions x, y, z. */
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

/* In C, these make a pointer to such a view, which lives until its block ends:
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

/* The connectivity of one object or of a scene, without positions. It never changes. */
typedef struct cscd_mesh cscd_mesh;

/* The kind of an object. Features of *loose* objects, those not of triangles, belong to no triangle and
 * no component. */
typedef enum cscd_object_kind {
    CSCD_OBJECT_TRIANGLES,
    CSCD_OBJECT_WIRES,  /* segments between its vertices, such as hair: edges of the mesh */
    CSCD_OBJECT_POINTS, /* its vertices, such as particles; spheres with a thickness (cscd_object_rule) */
    /* All behind a plane, such as the ground. Its one vertex, a point of the plane, moves as others do; its
     * normal never changes. */
    CSCD_OBJECT_HALF_SPACE,
    CSCD_OBJECT_KIND_MAX_ENUM = 0x7fffffff
} cscd_object_kind;

/* An object of a mesh. */
typedef struct cscd_object_desc {
    uint32_t vertex_count;   /* 1 or more, below 2^32 - 1; of a half-space 1, of all points at most 2^26 */
    uint32_t triangle_count; /* 1 or more, at most (2^32 - 1) / 3; 0 unless it is of triangles */
    /* triangle_count * 3 indices of the object's own vertices, from 0 on, counter-clockwise from outside. */
    const uint32_t *triangles;
    /* The caller moves it: no function looks at pairs within it or, without obstacle_pairs
     * (cscd_object_rule), with other obstacles. */
    bool obstacle;
    uint8_t reserved[7]; /* 0 */
    cscd_object_kind kind;
    uint32_t wire_count;   /* of wires: 1 or more; else 0 */
    const uint32_t *wires; /* wire_count * 2 indices of the object's own vertices; twins count as one */
    double normal[3];      /* of a half-space: out of it, of any length but 0; else 0 */
} cscd_object_desc;

/* Describes a moving object of triangles. */
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

/* Creates a mesh of object_count objects, 1 or more. Vertices, edges and triangles are numbered object by
 * object, in the given order. Vertices of no triangle or wire, except points, take no part in contacts.
 * Surfaces may have any defects, which only costs culling (cscd_component). INVALID_MESH: the sentence names
 * object and triangle.
 *
 * Loose objects take part in everything except the static check. docs/solver/guarantees.md says which pairs
 * are tested, and docs/solver/surfaces.md has a program. */
CSCD_API cscd_status cscd_mesh_create_sized(cscd_context *context, const cscd_object_desc *objects,
                                            size_t object_size, uint32_t object_count, cscd_mesh **out);
static inline cscd_status cscd_mesh_create(cscd_context *context, const cscd_object_desc *objects,
                                           uint32_t object_count, cscd_mesh **out) {
    return cscd_mesh_create_sized(context, objects, sizeof *objects, object_count, out);
}

/* Frees the mesh. */
CSCD_API void cscd_mesh_destroy(cscd_mesh *mesh);

/* Returns the context that the mesh was created in. */
CSCD_API cscd_context *cscd_mesh_context(const cscd_mesh *mesh);

/* The elements of a mesh, each numbered from 0 on. */
typedef enum cscd_element {
    CSCD_VERTICES,   /* also those without a triangle, and points of half-spaces */
    CSCD_EDGES,      /* wires, too; in the order of (smaller vertex, larger vertex), each once */
    CSCD_TRIANGLES,  /* of all objects */
    CSCD_COMPONENTS, /* see cscd_component */
    CSCD_OBJECTS,    /* in the order in which they were given */
    CSCD_ELEMENT_MAX_ENUM = 0x7fffffff
} cscd_element;

/* Returns how many elements of a kind the mesh has. */
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

/* The places of an object's features in the numbering of the mesh. */
typedef struct cscd_object {
    bool obstacle;
    cscd_object_kind kind;
    uint32_t first_vertex, vertex_count;
    uint32_t first_edge, edge_count;
    uint32_t first_triangle, triangle_count;
} cscd_object;

/* Tells where the features of an object lie; object is its place among those given to cscd_mesh_create. */
CSCD_API cscd_object cscd_mesh_object(const cscd_mesh *mesh, uint32_t object);

/* Returns the object that a vertex belongs to. */
CSCD_API uint32_t cscd_mesh_vertex_object(const cscd_mesh *mesh, uint32_t vertex);

/* ---- its features ------------------------------------------------------------------------------------ */

/* The arrays of a mesh. */
typedef enum cscd_mesh_array_kind {
    CSCD_TRIANGLE_VERTICES,   /* three for each triangle, in the given order */
    CSCD_TRIANGLE_EDGES,      /* three for each triangle: from its vertex 0 to 1, from 1 to 2, from 2 to 0 */
    CSCD_TRIANGLE_COMPONENTS, /* one for each triangle: labels for cscd_detector_set_parts */
    CSCD_EDGE_VERTICES,       /* two for each edge, the smaller one first */
    CSCD_MESH_ARRAY_KIND_MAX_ENUM = 0x7fffffff
} cscd_mesh_array_kind;

/* Returns one of the mesh's arrays, which lives as long as the mesh. */
CSCD_API const uint32_t *cscd_mesh_array(const cscd_mesh *mesh, cscd_mesh_array_kind kind);
static inline void cscd_mesh_triangle(const cscd_mesh *mesh, uint32_t triangle, uint32_t vertices[3]) {
    const size_t first = triangle;
    const uint32_t *all = cscd_mesh_array(mesh, CSCD_TRIANGLE_VERTICES) + 3 * first;
    for (int i = 0; i < 3; i++) vertices[i] = all[i];
}
static inline void cscd_mesh_triangle_edges(const cscd_mesh *mesh, uint32_t triangle, uint32_t edges[3]) {
    const size_t first = triangle;
    const uint32_t *all = cscd_mesh_array(mesh, CSCD_TRIANGLE_EDGES) + 3 * first;
    for (int i = 0; i < 3; i++) edges[i] = all[i];
}
static inline void cscd_mesh_edge(const cscd_mesh *mesh, uint32_t edge, uint32_t vertices[2]) {
    const size_t first = edge;
    const uint32_t *all = cscd_mesh_array(mesh, CSCD_EDGE_VERTICES) + 2 * first;
    for (int i = 0; i < 2; i++) vertices[i] = all[i];
}

/* Returns the triangles that contain a vertex or an edge, in ascending order, and their number in *count, 0
 * for loose ones. The array lives as long as the mesh. */
CSCD_API const uint32_t *cscd_mesh_vertex_triangles(const cscd_mesh *mesh, uint32_t vertex, uint32_t *count);
CSCD_API const uint32_t *cscd_mesh_edge_triangles(const cscd_mesh *mesh, uint32_t edge, uint32_t *count);

/* All triangles that can be reached from one of them over common vertices, numbered in the order of their
 * first triangles. Only closed manifolds are culled. */
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

/* Describes a component by its counts and its defects. */
CSCD_API cscd_component cscd_mesh_component(const cscd_mesh *mesh, uint32_t component);

/* Returns the component that a triangle belongs to. */
static inline uint32_t cscd_mesh_triangle_component(const cscd_mesh *mesh, uint32_t triangle) {
    return cscd_mesh_array(mesh, CSCD_TRIANGLE_COMPONENTS)[triangle];
}

/* Returns a hash of vertex count and triangles in their order, and of all objects if some are loose. A saved
 * plan fits a mesh with the same hash. */
CSCD_API uint64_t cscd_mesh_hash(const cscd_mesh *mesh);

/* ---- surfaces of tetrahedra ---------------------------------------------------------------------------- */

/* The boundary of a mesh of tetrahedra, for solvers whose elements these are: the triangles for
 * cscd_object_of_triangles, and the way from their vertices back. docs/solver/surfaces.md has a program. */
typedef struct cscd_tet_surface cscd_tet_surface;

/* Finds the faces that only one tetrahedron has. tetrahedra: tetrahedron_count * 4 indices below vertex_count,
 * in the order in which the fourth vertex is on the side of the normal of the first three, counter-clockwise
 * from there: (b - a) x (c - a) . (d - a) > 0. INVALID_MESH: an index is too large, a vertex is twice in a
 * tetrahedron, three have one face, or two lie on one side of theirs; the sentence names them. */
CSCD_API cscd_status cscd_tet_surface_create(cscd_context *context, const uint32_t *tetrahedra,
                                             size_t tetrahedron_count, uint32_t vertex_count,
                                             cscd_tet_surface **out);

/* Frees the surface and its arrays. */
CSCD_API void cscd_tet_surface_destroy(cscd_tet_surface *surface);

/* The arrays of a surface, which live as long as it. */
typedef struct cscd_tet_surface_arrays {
    uint32_t vertex_count, triangle_count;
    const uint32_t
        *triangles; /* three for each, by their numbers on the surface, counter-clockwise from outside */
    const uint32_t *vertices;   /* per vertex of the surface: the index among all vertices, ascending */
    const uint32_t *tetrahedra; /* per triangle: its tetrahedron, ascending */
} cscd_tet_surface_arrays;

/* Returns the arrays. Vertex v of the surface is where vertices[v] is among all, and its gradient is added there. */
CSCD_API cscd_tet_surface_arrays cscd_tet_surface_get(const cscd_tet_surface *surface);

/* ==== Detector ============================================================================================== */

/* Finds the contacts of one mesh, interval by interval. docs/solver/guarantees.md has all promises,
 * docs/theory/culling.md (Yeh 2012) and docs/theory/elementary.md the proofs. */
typedef struct cscd_detector cscd_detector;

/* The way to leave out pairs of triangles. Methods differ in time only; cscd/research.h has further ones. */
typedef enum cscd_method {
    /* Culls by the plan, without one as SINGLE, wherever that pays; else as NONE (docs/solver/tuning.md). */
    CSCD_METHOD_AUTO,
    CSCD_METHOD_NONE,   /* bounding volumes only */
    CSCD_METHOD_SINGLE, /* culls by orientation, one region for each component */
    CSCD_METHOD_KMEANS, /* the same, regions by k-means */
    CSCD_METHOD_CHARGE, /* the same, regions by charge density */
    CSCD_METHOD_MAX_ENUM = 0x7fffffff
} cscd_method;

/* Returns the name of a method. */
static inline const char *cscd_method_name(cscd_method method) {
    return cscd_name(CSCD_METHODS, method);
}

/* The regions of a mesh and their detector points: cscd/plan.h. */
typedef struct cscd_plan cscd_plan;

/* The promise of a step, except with the published methods and after a start that was wrongly vouched for. In
 * both modes an empty list proves that there is no contact. */
typedef enum cscd_mode {
    CSCD_MODE_ALL, /* every contact of the interval, on any mesh, whatever its state at the start */
    /* As ALL; but of the contacts of a component with itself only those whose toi is at most 1e-9 above the
     * least, unless there are pairs to leave out. Over a recording ALL costs less. */
    CSCD_MODE_EARLIEST,
    CSCD_MODE_MAX_ENUM = 0x7fffffff
} cscd_mode;

/* The source of a step's knowledge which triangles are clean at its start; only these are culled.
 * docs/about/glossary.md says what *clean* and *embedded* mean. */
typedef enum cscd_start {
    CSCD_START_PROVE,   /* the step checks the triangles that are not known to be clean */
    CSCD_START_VOUCHED, /* you say that every start is embedded; if not, contacts may be lost */
    CSCD_START_UNKNOWN, /* only what cscd_detector_find_intersections has shown clean is culled */
    CSCD_START_MAX_ENUM = 0x7fffffff
} cscd_start;

/* The bounding volumes of the trees. They differ in time only; boxes are mostly faster. */
typedef enum cscd_volume {
    CSCD_VOLUME_BOX,    /* three axes */
    CSCD_VOLUME_KDOP14, /* seven axes, so 14 planes */
    CSCD_VOLUME_MAX_ENUM = 0x7fffffff
} cscd_volume;

/* Whether a step may reuse the pairs that an earlier one has listed. Contacts stay the same; counters, and
 * what AUTO culls, may not. */
typedef enum cscd_coherence {
    CSCD_COHERENCE_AUTO, /* in closed meshes while little moves (docs/theory/coherence.md) */
    CSCD_COHERENCE_OFF,  /* every step looks at the whole mesh */
    CSCD_COHERENCE_MAX_ENUM = 0x7fffffff
} cscd_coherence;

/* Pairs of a vertex and a face (VF), two edges (EE), two triangles (TT, static check), two vertices (VV), an
 * edge and a vertex (EV), a vertex and a half-space (VH). VV and EV occur with points, with wires, and in the
 * form CSCD_NEAR_UNIQUE. */
typedef enum cscd_contact_kind {
    CSCD_CONTACT_VF,
    CSCD_CONTACT_EE,
    CSCD_CONTACT_TT,
    CSCD_CONTACT_VV,
    CSCD_CONTACT_EV,
    CSCD_CONTACT_VH,
    CSCD_CONTACT_KIND_MAX_ENUM = 0x7fffffff
} cscd_contact_kind;

/* Returns the name of a kind of contact. */
static inline const char *cscd_contact_kind_name(cscd_contact_kind kind) {
    return cscd_name(CSCD_CONTACT_KINDS, kind);
}

/* An object's relation to the others; start from cscd_object_rule_default. */
typedef struct cscd_object_rule {
    /* Two objects are looked at when the category of each has a bit in common with the mask of the other;
     * else their pairs are neither contacts nor intersections nor proximities. */
    uint64_t category, mask;

    /* A length, 0 for none. Two objects keep half the sum of theirs as their min_separation, and an object
     * keeps its own from itself. Proximity and the static check ignore it. With a thickness_matrix it is 0,
     * and thickness_class names the row. */
    double thickness;
    uint32_t thickness_class;

    bool self;           /* looked at with itself, whatever its mask; else neither proven nor culled */
    bool obstacle_pairs; /* obstacles: looked at with others that say this, too, if their masks agree */
    uint16_t reserved;   /* 0 */
} cscd_object_rule;

/* Returns the rule that changes nothing: category 1, all bits in the mask, no thickness, looked at with
 * itself. */
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

    /* Leaves out contacts and proximities for whose kind and features it returns true, and intersections, for
     * TT and triangles a < b. It is called on the calling thread for each pair that was found. */
    bool (*ignore)(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);
    void *ignore_user;

    /* ignored_count pairs of triangles, in any order. Their intersections are left out. So are contacts and
     * proximities of a feature of the one triangle with a feature of the other, the triangles included. */
    const uint32_t *ignored;
    size_t ignored_count;

    /* seam_count pairs, or chains of pairs, of vertices that count as one. Features that have such vertices
     * are neighbours, and so never reported. INVALID_ARGUMENT: a vertex with itself. */
    const uint32_t *seams;
    size_t seam_count;

    /* A length d, and a share of it, at most 1. With d = 0, the default, a contact is a touch, else coming
     * within d. toi is never after the first moment at distance d, and the distance at toi is at most (1 +
     * tolerance) d, up to rounding (docs/solver/guarantees.md). tolerance 0, the default, stands for 1e-6; it
     * holds for thicknesses and floors, too. */
    double min_separation, tolerance;

    /* cscd_detector_max_step goes at most this share of the way to its limiting contact; in (0,1), 0.8 by
     * default. */
    double step_factor;

    /* One rule for each object of the mesh, or none. */
    const cscd_object_rule *rules;

    /* Distances by thickness_class, in place of thicknesses: a symmetric matrix of thickness_class_count
     * rows, at most 256. With it or a thickness, min_separation is 0. At distance 0 a contact is a touch. */
    const double *thickness_matrix;
    uint32_t rule_count, thickness_class_count;

    /* The ratio of floors, below which pairs that start nearer than min_separation never come in
     * cscd_detector_max_step and line searches (docs/solver/guarantees.md). In (0,0.999], 0.9 by default. */
    double floor_ratio;

    /* A length: how far apart the vertices of a seam may be in the first positions that the detector is
     * given; INVALID_ARGUMENT names a pair that is farther apart. 0, the default: the longest edge at the
     * two; INFINITY: any distance. */
    double seam_reach;

    /* The most items of a list of contacts, intersections or proximities; 0, the default: any number. A
     * longer one fails with LIST_TOO_LONG and changes nothing; *out then has no items, but their number.
     * EARLIEST drops later contacts of a component with itself instead. What max_memory bounds
     * (cscd_intersection_options) is not bounded here. In the form CSCD_NEAR_UNIQUE the pairs behind the
     * items count, in displacement bounds and truncation the near pairs. */
    size_t longest_list;

    cscd_coherence coherence; /* AUTO by default */
    uint32_t reserved;        /* 0 */
    uint64_t ours;            /* the published methods: see cscd/research.h. 0 by default */
} cscd_detector_options;

/* Returns the default options of a detector. */
CSCD_API void cscd_detector_defaults_sized(cscd_detector_options *out, size_t size);
static inline cscd_detector_options cscd_detector_defaults(void) {
    cscd_detector_options options;
    cscd_detector_defaults_sized(&options, sizeof options);
    return options;
}

/* Creates a detector. It allocates from `context` and fails into it; the mesh may be of another one. plan is
 * of the same mesh, or NULL: CHARGE and KMEANS need one of their kind, the others take any or none. */
CSCD_API cscd_status cscd_detector_create(cscd_context *context, const cscd_mesh *mesh, const cscd_plan *plan,
                                          const cscd_detector_options *options, cscd_detector **out);

/* Frees the detector and its lists. */
CSCD_API void cscd_detector_destroy(cscd_detector *detector);

/* Returns the mesh that the detector was created for. */
CSCD_API const cscd_mesh *cscd_detector_mesh(const cscd_detector *detector);

/* A contact: two features, when they touch, and where. u and v name the points that touch at toi or, with
 * min_separation, the nearest points then:
 *   VF  a is a vertex, b a triangle (p0, p1, p2); the point on it is (1-u-v) p0 + u p1 + v p2
 *   EE  a < b are edges; the points are (1-u) a0 + u a1 and (1-v) b0 + v b1
 *   VV  a < b are points
 *   EV  a is a wire, b a point; the point on the wire is (1-u) a0 + u a1
 *   VH  a is a vertex, b a half-space, by its object; its point is the one below the vertex. At time 0 the
 *       vertex may be anywhere behind the plane */
typedef struct cscd_contact {
    cscd_contact_kind kind;
    uint32_t a, b; /* two features, in the numbering of the mesh */
    /* Only with min_separation: work was limited, so toi may be early, and the pair may stay farther
     * apart. */
    bool bounded;
    uint32_t vertices[4]; /* VF: the vertex, three of b; EE: two of a, two of b; else: cscd_stencil */
    double toi;           /* in [0,1], never late; early by less than 1e-9 without min_separation */
    double u, v;          /* in [0,1], up to rounding */
    double point[3];      /* the middle between the two points at toi */
    /* A unit vector across the features at toi, against the motion of a relative to b; 0 if there is none, as
     * between parallel edges. With min_separation it points from b's nearest point to a's, unless they
     * touch. */
    double normal[3];
} cscd_contact;

/* Contacts, sorted by (toi, kind, a, b). They live until the next call of the detector or one of its line
 * searches. */
typedef struct cscd_contacts {
    const cscd_contact *items;
    size_t count;
} cscd_contacts;

/* Finds the contacts from positions x0 to positions x1, as the mode promises. The first call is slower. A
 * steady step with fewer than 2^18 contacts allocates nothing. CANCELLED: see cscd_progress. LIST_TOO_LONG:
 * see longest_list. */
CSCD_API cscd_status cscd_detector_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                        cscd_contacts *out);

/* The reason why the contacts of a component with itself are complete, or why not. */
typedef enum cscd_reason {
    CSCD_REASON_METHOD,    /* complete: the method does not cull, or not with a distance from itself */
    CSCD_REASON_SURFACE,   /* complete: open, non-manifold or inconsistently oriented, so not culled */
    CSCD_REASON_CROSSING,  /* complete: the start intersects or touches itself */
    CSCD_REASON_UNPROVEN,  /* complete: the start is not known to be embedded */
    CSCD_REASON_CLEAN,     /* complete: the start is embedded; no contact */
    CSCD_REASON_FINISHED,  /* complete: the start is embedded; contacts, mode ALL */
    CSCD_REASON_PUBLISHED, /* some may be missing: method PUBLISHED or ICCD_PUBLISHED */
    CSCD_REASON_CONTOUR,   /* complete: method ICCD or CONES */
    CSCD_REASON_EARLIEST,  /* later contacts are left out: mode EARLIEST */
    CSCD_REASON_OBSTACLE,  /* not looked for: an obstacle */
    CSCD_REASON_MASK,      /* not looked for: its object's rule has self = false */
    CSCD_REASON_COLLAPSED, /* not looked for: collapsed at an end */
    CSCD_REASON_MAX_ENUM = 0x7fffffff
} cscd_reason;

/* Returns the reason as a part of a sentence. */
static inline const char *cscd_reason_text(cscd_reason reason) {
    return cscd_name(CSCD_REASONS, reason);
}

/* The promise of the last step for the contacts of a component with itself. */
typedef struct cscd_guarantee {
    bool complete;       /* all of them were reported */
    bool start_embedded; /* it was embedded at the start, by proof or because the caller vouched */
    cscd_reason reason;
} cscd_guarantee;

/* Returns what the last step promises for a component; before the first step it means nothing. Contacts
 * between two components are always complete. */
CSCD_API cscd_guarantee cscd_detector_guarantee(const cscd_detector *detector, uint32_t component);

/* Tells whether the component was collapsed at the positions that the last step, max_step or
 * cscd_detector_find_intersections looked at, also a failed one: all corners of each of its triangles were on
 * one line, exactly. docs/solver/guarantees.md says what is not looked for then. False before the first call,
 * and for a component that the mesh does not have. */
CSCD_API bool cscd_detector_collapsed(const cscd_detector *detector, uint32_t component);

/* The milliseconds of each stage of the last step. */
typedef struct cscd_timings {
    double update_ms;      /* moving the trees */
    double orientation_ms; /* detector points, and the triangles that face them */
    double contour_ms;     /* ICCD, CONES */
    double traversal_ms;   /* finding triangle pairs whose volumes overlap */
    double contact_ms;     /* from these to sorted contacts */
    double total_ms;       /* the whole step */
    double proof_ms;       /* of the total, the static check of the start */
    double check_ms;       /* the last cscd_detector_find_intersections, apart */
    double reserved[4];    /* 0 */
} cscd_timings;

/* The work of the last step, in numbers: exact, and the same for any number of threads. */
typedef struct cscd_counters {
    uint64_t static_checks;    /* of the start, or of a part of it */
    uint64_t clean;            /* triangles that were clean at the start */
    uint64_t rebuilds;         /* 1 if loose trees were built again, else 0 */
    uint64_t passes;           /* further traversals, for pairs uncovered by contacts */
    uint64_t plus, minus;      /* S+, and S-: triangles that face away, and towards (cscd/research.h) */
    uint64_t contours, sealed; /* ICCD, CONES: contour tests, and patches left out after theirs */
    uint64_t boxes_tested;     /* pairs of bounding volumes compared */
    uint64_t pcp;              /* triangle pairs whose volumes overlap */
    uint64_t adjacent;         /* those that share a vertex, left out except by published methods */
    uint64_t feature_pairs;    /* pairs of features whose volumes overlap, each once; with BRUTE all */
    uint64_t tests;            /* elementary tests, one for each of these */
    uint64_t by_signs;         /* tests that orientation signs have rejected */
    uint64_t by_roots;         /* tests decided by intervals around the coplanarity cubic's roots */
    uint64_t by_exact;         /* all other tests, by exact arithmetic; with min_separation all three are 0 */
    uint64_t vf, ee;           /* contacts reported */
    uint64_t bounded;          /* those marked as bounded */
    uint64_t loose;            /* contacts of kinds VV, EV and VH */
    uint64_t coherent;         /* 1: answered from a list (cscd_coherence), without boxes and pcp; else 0 */
    uint64_t reserved[6];      /* 0 */
} cscd_counters;

/* Returns the timings of the last step, and of the last check. */
CSCD_API cscd_timings cscd_detector_timings(const cscd_detector *detector);

/* Returns the counters of the last step. */
CSCD_API cscd_counters cscd_detector_counters(const cscd_detector *detector);

#ifdef __cplusplus
}
#endif

#endif
