/* EXPERIMENTAL: what this header declares may change in a minor version. Changes between two calls: to a detector, how far
 * apart features have to stay and which pairs are left out, and to a mesh. Part of cscd/cscd.h, which says what holds for
 * every function. */
#ifndef CSCD_LIVE_API_H
#define CSCD_LIVE_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Another mesh ========================================================================================== */

/* A mesh made from another one, for what tears, is refined, comes or goes, with maps between the features of
 * both. What has not changed is copied, so a change costs little more than the objects that change. */

/* Two meshes, the old one and the new one, and what has become of each feature. */
typedef struct cscd_mesh_change cscd_mesh_change;

/* What happens to one object. Set members that you do not need to 0. */
typedef struct cscd_object_change {
    uint32_t object;   /* of the old mesh; UINT32_MAX: a new object. New objects come after all others, in
                                   * the order of their changes */
    uint32_t reserved; /* 0 */
    const cscd_object_desc *desc; /* what the object is now; NULL: it is removed */

    /* For each vertex of desc the vertex of the old object that it was, in the numbering of that object;
     * UINT32_MAX: it is new. Two vertices that came apart have one origin. NULL: vertex i was vertex i, where
     * both exist. A new object has no origins. */
    const uint32_t *vertex_origins;
    const uint32_t *triangle_origins; /* the same of its triangles */
} cscd_object_change;

/* Makes the new mesh in `context`; old may be of another one. Objects that no change names stay what they are. An
 * object that goes moves up all that come after it. The new mesh is what cscd_mesh_create would make of all
 * descriptions, bit for bit. Both meshes may be read meanwhile and afterwards, from any thread. INVALID_ARGUMENT:
 * an object that does not exist or is named twice, or an origin that does not exist. INVALID_MESH: as
 * cscd_mesh_create, with the object's number in the new mesh; or no object is left. An example, object 0 that
 * tears at a vertex: triangle t takes a new vertex there, whose position is that of the old one:
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

/* Gives the maps back, and both meshes unless something else keeps them. */
CSCD_API void cscd_mesh_change_destroy(cscd_mesh_change *change);

/* The new mesh. It belongs to the change; plans, detectors and changes that were made from it keep it, too. */
CSCD_API const cscd_mesh *cscd_mesh_change_mesh(const cscd_mesh_change *change);

/* What has become of each vertex, edge, triangle, object or component of the old mesh: its number in the new mesh,
 * UINT32_MAX if it is gone. Of several that came from one, the first. *old_count, which may be NULL, is how many the
 * old mesh has. An edge stays one where both of its vertices do and an edge still joins them. A component stays one if
 * it is untouched: the same triangles with the same corners, in an object that is an obstacle as before or none as
 * before. The array belongs to the change. */
CSCD_API const uint32_t *cscd_mesh_change_to_new(const cscd_mesh_change *change, cscd_element what,
                                                 uint32_t *old_count);

/* The same the other way: which element of the old mesh each one of the new mesh was, UINT32_MAX if it is new. */
CSCD_API const uint32_t *cscd_mesh_change_to_old(const cscd_mesh_change *change, cscd_element what,
                                                 uint32_t *new_count);

/* ==== A live detector ======================================================================================= */

/* Changes min_separation and tolerance (see the options) from the next call on, for solvers that have to
 * go closer. If the change ends culling, what is known of the start is forgotten. A line search that was begun
 * with a smaller separation must begin again; until then its max_step returns INVALID_ARGUMENT. */
CSCD_API cscd_status cscd_detector_set_separation(cscd_detector *detector, double min_separation,
                                                  double tolerance);

/* Changes longest_list (see the options) from the next call on; 0: lists may have any length. A call that failed with
 * LIST_TOO_LONG may then be made again. */
CSCD_API cscd_status cscd_detector_set_longest_list(cscd_detector *detector, size_t longest_list);

/* ---- what is left out, on a live detector ----------------------------------------------------------------
 *
 * Pairs that such a change uncovers may touch, or cross, where they are, as the two sides of a seam that opens. They
 * wait: they count as pairs to leave out until they have once been apart, and from then on as all others. A pair of
 * features begins to wait if it is left out before the change, not left out after it, and not farther apart than
 * min_separation, or its thickness, in the first positions that the detector is given then; without a distance, if it
 * touches. It waits until it is farther apart than that in positions where a motion starts, that is, in x0 of any
 * call, or in those of cscd_detector_check. While it waits, no list has it: a pair that parts and comes back
 * within one motion passes unseen. cscd_detector_max_step, cscd_line_search_max_step and cscd_detector_truncate,
 * however, leave out only what touches at x0: a pair that waits and does not touch has its floor, as any pair that
 * is too near. The check has pairs of triangles instead, which wait while they intersect or
 * touch. Results count the pairs that wait. A pair that is left out anew, by a later change, waits no more.
 *
 * What the function `ignore` leaves out is asked for each list: if its answers change, nothing waits. An example, the
 * second sheet on the first one, sewn to it, then torn off, which prints "0 contacts, pairs wait":
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
 *     printf("%d contacts, %s\n", (int)contacts.count, contacts.waiting > 0 ? "pairs wait" : "no pair waits");
 */

/* Replaces seams (see the options) from the next call on. seam_reach holds for them at the first positions that the
 * detector is given then. */
CSCD_API cscd_status cscd_detector_set_seams(cscd_detector *detector, const uint32_t *seams,
                                             size_t seam_count);

/* Replaces ignored (see the options) from the next call on. */
CSCD_API cscd_status cscd_detector_set_ignored(cscd_detector *detector, const uint32_t *ignored,
                                               size_t ignored_count);

/* Replaces rules and thickness_matrix (see the options) from the next call on; they are checked and copied. Rules
 * between objects do not change what is known of the start; an object that is looked at with itself again is
 * proven anew. A line search that was begun before must begin again. An example, cloth 2 thick and a body 0 thick,
 * which therefore is culled, and so stay 1 apart:
 *
 *     cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
 *     rules[0].thickness = 2.0;
 *     cscd_status status = cscd_detector_set_rules(detector, rules, 2, NULL, 0);
 */
CSCD_API cscd_status cscd_detector_set_rules(cscd_detector *detector, const cscd_object_rule *rules,
                                             uint32_t rule_count, const double *thickness_matrix,
                                             uint32_t thickness_class_count);

/* ---- active vertices ---------------------------------------------------------------------------------- */

/* Makes only these count vertices active, from the next call on; NULL and 0: all are, as at first. Other arrays may be
 * empty, may be given again as often as they change, and may name a vertex twice. For solvers that let most of a scene
 * rest, or move one part of it at a time: the search costs as much as the active part and what is near it.
 *
 * A feature is active if one of its vertices is, and a half-space if its point is. All other vertices must stay where they
 * are: a call with two positions fails with INVALID_ARGUMENT and names the first that does not, as does max_step, where
 * rounding to floats would move it. Pairs of two features that are not active are not looked for: they are in no list,
 * whether they touch or not, and hold up no motion. All other pairs, and all bits of what is said of them, are those of a
 * detector without active vertices. In cscd_detector_check the features are triangles.
 *
 *   guarantees    "complete" speaks of the pairs that are looked for, and so does an empty list
 *   starts        steps prove the whole start as ever, once; a check leaves open what it did not compare
 *   bounds        of vertices that are not active are those of their pairs with active features
 *   waiting       pairs begin to wait, and wait, whether they are active or not
 *   line search   must begin again, after the set has changed
 *   other meshes  what has come from an active vertex is active, and so are vertices without an origin
 *
 * An example, a vertex that is pulled through a sheet that rests, which prints "8 contacts":
 *
 *     const uint32_t pulled = 5;
 *     memcpy(x1, x0, sizeof x0);
 *     x1[3 * pulled + 2] += 1.0;
 *     cscd_status status = cscd_detector_set_active(detector, &pulled, 1);
 *     if (status == CSCD_OK) status = cscd_detector_step(detector, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), &contacts);
 *     if (status == CSCD_OK) status = cscd_detector_set_active(detector, NULL, 0);
 *     printf("%d contacts\n", (int)contacts.count);
 */
CSCD_API cscd_status cscd_detector_set_active(cscd_detector *detector, const uint32_t *vertices,
                                              size_t count);

/* ---- another mesh ---------------------------------------------------------------------------------------- */

/* Moves the detector over to the new mesh of a change whose old mesh is the detector's, and which may be of another
 * context. On failure the detector stays as it was.
 *   trees         components that are untouched keep theirs, all others get new ones at the next call
 *   regions       untouched components keep theirs, with detector points and weights, numbered first and in their
 *                 order; each other component becomes one region, as method SINGLE does. The method stays
 *   starts        what is known of untouched components stays known, if the next call begins where the last ended
 *   pairs         a seam joins what has become of its vertices: of vertices that came apart, the first. A pair of
 *                 ignored triangles becomes all pairs of triangles that came from the two. Pairs that wait go on to
 *                 wait, and so do neighbours that the change parts: features of vertices that were one vertex, or one
 *                 seam, unless they are apart at the first positions that the detector is given then. Pairs of
 *                 obstacles of which one becomes free count as uncovered, as by a change of rules
 *   rules         each object keeps its rule; a new one gets cscd_object_rule_default
 *   parts         each triangle keeps the label of its origin; without an origin it is in no part
 *   rest          edges keep the lengths of their origins; for all others the mollifier's threshold is 0 until
 *                 cscd_detector_set_rest
 * Lists, timings, counters, guarantees and orientations of earlier calls are gone. Line searches must begin again;
 * until then they return INVALID_ARGUMENT. */
CSCD_API cscd_status cscd_detector_change_mesh(cscd_detector *detector, const cscd_mesh_change *change);

/* Creates a second detector on the same mesh in a context that may be another one. It begins with a copy of all that
 * the first one has: trees, regions, options, rules, pairs to leave out and pairs that wait, rest lengths, parts, and what is known of the start.
 * From then on they have nothing to do with each other. It has no lists, and no line searches. BUSY also where the
 * first one's context is inside another call. */
CSCD_API cscd_status cscd_detector_clone(cscd_context *context, const cscd_detector *detector,
                                         cscd_detector **out);

#ifdef __cplusplus
}
#endif

#endif
