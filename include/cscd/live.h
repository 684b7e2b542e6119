/* EXPERIMENTAL: what this header declares may change in a minor version. Meshes and
 * detectors change here between two calls. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_LIVE_API_H
#define CSCD_LIVE_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Another mesh ========================================================================================== */

/* A new mesh for what tears, is refined, comes or goes, with maps between the features of both meshes. A
 * change costs little more than the objects that change. */

/* An old mesh, a new mesh, and what has become of each feature. */
typedef struct cscd_mesh_change cscd_mesh_change;

/* The change of one object. */
typedef struct cscd_object_change {
    uint32_t object;   /* of the old mesh; UINT32_MAX: a new one, after all others in the order given */
    uint32_t reserved; /* 0 */
    const cscd_object_desc *desc; /* the object as it is now; NULL: it is removed */

    /* For each vertex of desc the vertex that it was, in the numbering of the old object; UINT32_MAX: it is
     * new. Vertices that came apart have one origin. NULL: vertex i was vertex i, where both exist. A new
     * object has no origins. */
    const uint32_t *vertex_origins;
    const uint32_t *triangle_origins; /* the same of its triangles */
} cscd_object_change;

/* Makes the new mesh in `context`; old may be of another one. Objects that no change names stay, and those
 * after a removed one move up. The mesh is what cscd_mesh_create would make, bit for bit. Any thread may read
 * both meshes meanwhile. INVALID_ARGUMENT: an object does not exist or is named twice, or an origin does not
 * exist. INVALID_MESH: as cscd_mesh_create, with the object's new number; or no object is left. An example,
 * object 0 that tears at a vertex, where triangle t takes a new one:
 *
 *     uint32_t origins[17], torn[18][3];
 *     const uint32_t t = 0, corner = 1;
 *     for (uint32_t v = 0; v < 16; v++) origins[v] = v;
 *     memcpy(torn, triangles, sizeof torn);
 *     origins[16] = torn[t][corner];
 *     torn[t][corner] = 16;
 *     cscd_object_desc desc = cscd_object_of_triangles(17, 18, &torn[0][0]);
 *     cscd_object_change tear = {0, 0, &desc, origins, NULL};
 *     cscd_mesh_change *change = NULL;
 *     if (cscd_mesh_change_create(context, mesh, &tear, 1, &change) == CSCD_OK) {
 *         uint32_t count;
 *         const uint32_t *from = cscd_mesh_change_to_old(change, CSCD_VERTICES, &count);
 *         for (uint32_t v = 0; v < count; v++) memcpy(&moved[3 * v], &x0[3 * from[v]], 3 * sizeof *moved);
 *     }
 *     cscd_mesh_change_destroy(change);
 */
CSCD_API cscd_status cscd_mesh_change_create_sized(cscd_context *context, const cscd_mesh *old,
                                                   const cscd_object_change *changes, size_t change_size,
                                                   size_t object_size, uint32_t change_count,
                                                   cscd_mesh_change **out);
static inline cscd_status cscd_mesh_change_create(cscd_context *context, const cscd_mesh *old,
                                                  const cscd_object_change *changes, uint32_t change_count,
                                                  cscd_mesh_change **out) {
    return cscd_mesh_change_create_sized(context, old, changes, sizeof *changes, sizeof(cscd_object_desc),
                                         change_count, out);
}

/* Frees the maps, and both meshes unless something else keeps them. */
CSCD_API void cscd_mesh_change_destroy(cscd_mesh_change *change);

/* Returns the new mesh. It belongs to the change; what is made from it keeps it, too. */
CSCD_API const cscd_mesh *cscd_mesh_change_mesh(const cscd_mesh_change *change);

/* Returns the new number of each vertex, edge, triangle, object or component of the old mesh; UINT32_MAX: it
 * is gone. Of several that came from one it is the first. *old_count, which may be NULL, becomes the number
 * of the old ones. An edge stays one where its vertices do and are still joined. A component stays one if it
 * has the same triangles with the same corners, and its object is an obstacle, or none, as before. The array
 * belongs to the change. */
CSCD_API const uint32_t *cscd_mesh_change_to_new(const cscd_mesh_change *change, cscd_element what,
                                                 uint32_t *old_count);

/* Returns the old number of each element of the new mesh, in the same way; UINT32_MAX: it is new. */
CSCD_API const uint32_t *cscd_mesh_change_to_old(const cscd_mesh_change *change, cscd_element what,
                                                 uint32_t *new_count);

/* ==== A live detector ======================================================================================= */

/* Changes min_separation and tolerance (see the options) from the next call on. If this ends culling, what is
 * known of the start is forgotten. A line search that began with a smaller separation must begin again; until
 * then its max_step returns INVALID_ARGUMENT. */
CSCD_API cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation,
                                                  double tolerance);

/* Changes longest_list (see the options) from the next call on. 0: lists may have any length. After
 * LIST_TOO_LONG the call may be made again. */
CSCD_API cscd_status cscd_detector_set_longest_list(cscd_detector *detector, size_t longest_list);

/* ---- what is left out, on a live detector ----------------------------------------------------------------
 *
 * A pair that such a change uncovers while it touches, or is within its distance, waits: it is left out until
 * it is farther apart than that in x0 of a call or in positions of cscd_detector_find_intersections
 * (docs/solver/guarantees.md). The first positions given after the change decide. But cscd_detector_max_step,
 * cscd_line_search_max_step, cscd_detector_truncate and _make_safe leave out only what touches at x0; other waiting pairs
 * keep their floors. Pairs of triangles wait while they intersect or touch. A pair that a later change leaves
 * out waits no more. If the answers of `ignore` change, no pair waits. An example, the second sheet on the
 * first one, sewn to it, then torn off, which prints "0 contacts, pairs wait":
 *
 *     uint32_t seams[SHEET][2];
 *     for (uint32_t v = 0; v < SHEET; v++) {
 *         seams[v][0] = v;
 *         seams[v][1] = SHEET + v;
 *         memcpy(&x0[3 * (SHEET + v)], &x0[3 * v], sizeof(double[3]));
 *     }
 *     const cscd_view *here = CSCD_DOUBLES(x0, n);
 *     cscd_status status = cscd_detector_set_seams(detector, &seams[0][0], SHEET);
 *     if (status == CSCD_OK) status = cscd_detector_step(detector, here, here, &contacts);
 *     if (status == CSCD_OK) status = cscd_detector_set_seams(detector, NULL, 0);
 *     if (status == CSCD_OK) status = cscd_detector_step(detector, here, here, &contacts);
 *     const bool wait = cscd_detector_waiting(detector).features > 0;
 *     printf("%d contacts, %s\n", (int)contacts.count, wait ? "pairs wait" : "no pair waits");
 */

/* The numbers of pairs that wait. */
typedef struct cscd_waiting {
    size_t features;  /* pairs of features, left out of contacts and proximities */
    size_t triangles; /* pairs of triangles, left out of intersections */
} cscd_waiting;

/* Returns how many pairs wait since the last call that looked at positions, also of a line search, and also
 * if it failed. */
CSCD_API cscd_waiting cscd_detector_waiting(const cscd_detector *detector);

/* Replaces seams (see the options) from the next call on. For them seam_reach holds at the first positions
 * given then. */
CSCD_API cscd_status cscd_detector_set_seams(cscd_detector *detector, const uint32_t *seams,
                                             size_t seam_count);

/* Replaces ignored (see the options) from the next call on. */
CSCD_API cscd_status cscd_detector_set_ignored(cscd_detector *detector, const uint32_t *ignored,
                                               size_t ignored_count);

/* Replaces rules and thickness_matrix (see the options) from the next call on, and copies them. What is known
 * of the start stays, but an object that is looked at with itself again is proven again. Line searches must
 * begin again. An example, cloth 2 thick and a body 0 thick, which is therefore culled; they stay 1 apart:
 *
 *     cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
 *     rules[0].thickness = 2.0;
 *     cscd_status status = cscd_detector_set_rules(detector, rules, 2, NULL, 0);
 */
CSCD_API cscd_status cscd_detector_set_rules(cscd_detector *detector, const cscd_object_rule *rules,
                                             uint32_t rule_count, const double *thickness_matrix,
                                             uint32_t thickness_class_count);

/* ---- active vertices ---------------------------------------------------------------------------------- */

/* Makes only these vertices active, from the next call on; NULL and 0: all are, as at first. Other arrays may
 * be empty, and may name a vertex twice. The search costs as much as the active part and what is near it.
 *
 * A feature is active if one of its vertices is, and a half-space if its point is. All other vertices must
 * stay where they are: otherwise a call with two positions fails with INVALID_ARGUMENT and names the first,
 * also where max_step would round one to floats. Pairs without an active feature are in no list and stop no
 * motion; "complete" speaks of the others, which are reported as ever, bit for bit. In
 * cscd_detector_find_intersections the features are triangles.
 *
 *   starts        steps prove the whole start, once; a check leaves open what it did not compare
 *   bounds        of other vertices are those of their pairs with active features
 *   waiting       pairs begin to wait, and wait, whether they are active or not
 *   line search   must begin again after a change of the set
 *   other meshes  vertices are active if their origins are, or if they have none
 *
 * An example, a vertex that is pulled through a sheet that rests, which prints "8 contacts":
 *
 *     const uint32_t pulled = 5;
 *     memcpy(x1, x0, sizeof x0);
 *     x1[3 * pulled + 2] += 1.0;
 *     cscd_status status = cscd_detector_set_active(detector, &pulled, 1);
 *     if (status == CSCD_OK)
 *         status = cscd_detector_step(detector, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), &contacts);
 *     if (status == CSCD_OK) status = cscd_detector_set_active(detector, NULL, 0);
 *     printf("%d contacts\n", (int)contacts.count);
 */
CSCD_API cscd_status cscd_detector_set_active(cscd_detector *detector, const uint32_t *vertices,
                                              size_t count);

/* ---- another mesh ---------------------------------------------------------------------------------------- */

/* Moves the detector to the new mesh of a change, whose old mesh is its own. The change may be of another
 * context. On failure the detector stays as it was.
 *   trees    untouched components keep theirs; others get new ones at the next call
 *   regions  untouched components keep theirs, numbered first and in their order; each other one becomes one
 *            region, as in method SINGLE. The method stays
 *   starts   what is known of untouched components stays, if the next call begins where the last ended
 *   pairs    a seam joins what its vertices have become: of several, the first. An ignored pair becomes all
 *            pairs of triangles that came from the two. Pairs that wait go on to wait, and so do neighbours
 *            that the change parts at a vertex or a seam, unless they are apart at the first positions given
 *            then. A pair of obstacles of which one becomes free counts as uncovered
 *   rules    each object keeps its rule; a new one gets cscd_object_rule_default
 *   parts    each triangle keeps the label of its origin; a new one is in no part
 *   rest     edges keep the lengths of their origins, and triangles the areas; others have none until
 *            cscd_detector_set_rest
 * Lists, timings, counters, guarantees and orientations are gone. Line searches return INVALID_ARGUMENT until
 * they begin again. */
CSCD_API cscd_status cscd_detector_change_mesh(cscd_detector *detector, const cscd_mesh_change *change);

/* Creates a second detector on the same mesh, in any context. It copies all that the first one has and knows,
 * except lists and line searches; then the two are independent. BUSY also where the first one's context is
 * inside another call. */
CSCD_API cscd_status cscd_detector_clone(cscd_context *context, const cscd_detector *detector,
                                         cscd_detector **out);

#ifdef __cplusplus
}
#endif

#endif
