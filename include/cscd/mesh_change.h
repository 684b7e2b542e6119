/* A mesh made from another one, for what tears, is refined, comes or goes, with maps between the features of
 * both. What has not changed is copied, so a change costs little more than the objects that change. Part of
 * cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_MESH_CHANGE_API_H
#define CSCD_MESH_CHANGE_API_H

#include <cscd/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

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
 *         const uint32_t *from = cscd_mesh_change_vertex_origins(change, &count);
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

/* What has become of each feature of the old mesh: its number in the new mesh, UINT32_MAX if it is gone. Of several
 * that came from one, the first. *old_count, which may be NULL, is their number in the old mesh. An edge stays one
 * where both of its vertices do and an edge still joins them. The arrays belong to the change. */
CSCD_API const uint32_t *cscd_mesh_change_vertices(const cscd_mesh_change *change, uint32_t *old_count);
CSCD_API const uint32_t *cscd_mesh_change_edges(const cscd_mesh_change *change, uint32_t *old_count);
CSCD_API const uint32_t *cscd_mesh_change_triangles(const cscd_mesh_change *change, uint32_t *old_count);
CSCD_API const uint32_t *cscd_mesh_change_objects(const cscd_mesh_change *change, uint32_t *old_count);

/* The same the other way: the origin of each feature of the new mesh, UINT32_MAX if it is new. */
CSCD_API const uint32_t *cscd_mesh_change_vertex_origins(const cscd_mesh_change *change, uint32_t *new_count);
CSCD_API const uint32_t *cscd_mesh_change_edge_origins(const cscd_mesh_change *change, uint32_t *new_count);
CSCD_API const uint32_t *cscd_mesh_change_triangle_origins(const cscd_mesh_change *change,
                                                           uint32_t *new_count);
CSCD_API const uint32_t *cscd_mesh_change_object_origins(const cscd_mesh_change *change, uint32_t *new_count);

/* Components that are untouched: the same triangles with the same corners, in an object that is an obstacle as
 * before or is none as before. All others are UINT32_MAX: an old one has changed or is gone, a new one has changed
 * or is new. */
CSCD_API const uint32_t *cscd_mesh_change_components(const cscd_mesh_change *change, uint32_t *old_count);
CSCD_API const uint32_t *cscd_mesh_change_component_origins(const cscd_mesh_change *change,
                                                            uint32_t *new_count);

#ifdef __cplusplus
}
#endif

#endif
