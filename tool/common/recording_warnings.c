/* Warnings about a mesh, which a person should know before trusting its results. */
#include "tool/common/command.h"
#include "tool/common/recording.h"
#include "tool/io/io.h"
#include "tool/io/weld.h"

#include <stdio.h>
#include <stdlib.h>

enum { COMPONENTS_NAMED = 3 };

static int append_edges(const recording *r, char *text, size_t size, uint32_t count, uint32_t first,
                        const char *what) {
    if (count == 0) return 0;
    uint32_t ends[2];
    cscd_mesh_edge(r->mesh, first, ends);
    return snprintf(text, size, ", %u %s edge%s (the first joins vertices %u and %u)", count, what,
                    count == 1 ? "" : "s", recording_file_vertex(r, ends[0]),
                    recording_file_vertex(r, ends[1]));
}

static void warn_component(const recording *r, uint32_t index, const cscd_component *c) {
    char text[600] = "";
    int n = append_edges(r, text, sizeof text, c->open_edges, c->first_open_edge, "open");
    n += append_edges(r, text + n, sizeof text - (size_t)n, c->non_manifold_edges, c->first_non_manifold_edge,
                      "non-manifold");
    n += append_edges(r, text + n, sizeof text - (size_t)n, c->inconsistent_edges, c->first_inconsistent_edge,
                      "inconsistently oriented");
    if (c->non_manifold_vertices > 0)
        snprintf(text + n, sizeof text - (size_t)n, ", %u non-manifold vertices (the first is %u)",
                 c->non_manifold_vertices, recording_file_vertex(r, c->first_non_manifold_vertex));
    warn("component %u is not a closed surface: %s; all its pairs are tested (mode all)", index, text + 2);
}

/* Open, and nothing else: a cloth, not a fault. */
static bool is_cloth(const cscd_component *c) {
    return c->open_edges > 0 && c->non_manifold_edges == 0 && c->inconsistent_edges == 0 &&
           c->non_manifold_vertices == 0;
}

/* One sentence for all open components, about what it means for the results. */
static void note_open_surfaces(const recording *r) {
    uint32_t count = 0, first = 0, open_edges = 0;
    for (uint32_t i = cscd_mesh_component_count(r->mesh); i-- > 0;) {
        cscd_component component = cscd_mesh_component(r->mesh, i);
        if (!is_cloth(&component)) continue;
        count++;
        first = i;
        open_edges += component.open_edges;
    }
    if (count == 0) return;
    uint32_t ends[2];
    cscd_mesh_edge(r->mesh, cscd_mesh_component(r->mesh, first).first_open_edge, ends);
    char which[64];
    snprintf(which, sizeof which,
             count == 1 ? "component %u is an open surface" : "%u components are open surfaces",
             count == 1 ? first : count);
    note(
        "%s, as cloth is (%u open edges, the first joins vertices %u and %u): nothing is missed there, but there "
        "is no inside, and a plan makes it no faster",
        which, open_edges, recording_file_vertex(r, ends[0]), recording_file_vertex(r, ends[1]));
}

static uint32_t count_open_edges(const cscd_mesh *mesh) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++)
        sum += cscd_mesh_component(mesh, i).open_edges;
    return sum;
}

/* Does a component of the object have an open edge? */
static bool object_is_open(const recording *r, const recorded_object *object) {
    for (uint32_t t = 0; t < object->triangle_count; t++) {
        uint32_t component = cscd_mesh_triangle_component(r->mesh, object->first_triangle + t);
        if (cscd_mesh_component(r->mesh, component).open_edges > 0) return true;
    }
    return false;
}

/* Would welding the vertices that are equal in all frames leave no open edge? */
static bool welding_closes(const recording *r, recorded_object *object) {
    weld welded;
    weld_parting parting;
    if (!recorded_object_weld(object, NULL, 0.0, &welded, &parting, NULL)) return false;
    if (welded.vertex_count == welded.file_vertex_count) {
        weld_free(&welded);
        return false;
    }
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc =
        cscd_object_of_triangles(welded.vertex_count, welded.triangle_count, welded.triangles);
    bool closes = cscd_mesh_create(r->context, &desc, 1, &mesh) == CSCD_OK && count_open_edges(mesh) == 0;
    cscd_mesh_destroy(mesh);
    weld_free(&welded);
    return closes;
}

/* Faces are counted from 0, as everywhere. */
static void warn_repair(const char *name, const char *colon, uint32_t count, uint32_t first,
                        const char *what) {
    if (count > 0)
        warn("%s%s%u face%s %s (the first is face %u)", name, colon, count, count == 1 ? "" : "s", what,
             first);
}

static void warn_repairs(const char *name, const char *colon, const mesh_repairs *repairs) {
    warn_repair(name, colon, repairs->shortened, repairs->first_shortened,
                "named a vertex twice in a row, which counts once");
    warn_repair(name, colon, repairs->dropped, repairs->first_dropped,
                "left out for having fewer than three different corners");
    warn_repair(name, colon, repairs->fanned, repairs->first_fanned,
                "crossed themselves or had no area as seen along every axis, filled by fans");
    if (repairs->skipped_primitives > 0)
        warn("%s%s%u primitive%s of points or lines %s left out", name, colon, repairs->skipped_primitives,
             repairs->skipped_primitives == 1 ? "" : "s", repairs->skipped_primitives == 1 ? "is" : "are");
}

static void warn_object(const recording *r, recorded_object *object) {
    const char *name = r->object_count > 1 ? object->source.name : "",
               *colon = r->object_count > 1 ? ": " : "";
    if (object->frames != NULL && animation_note(object->frames) != NULL)
        note("%s%s%s", name, colon, animation_note(object->frames));
    if (object->file.unread != NULL) warn("%s%s%s", name, colon, object->file.unread);
    const char *format = recorded_object_split_format(object);
    if (object->welded && format != NULL && object->weld.vertex_count < object->file.vertex_count)
        warn("%s%sthe %u vertices of the %s file are joined to %u; --weld none keeps them apart", name, colon,
             object->file.vertex_count, format, object->weld.vertex_count);
    if (object->welded && object->parting.count > 0)
        note(
            "%s%s%u %s on others in the first frame alone, as where something is hidden by a scale of 0, and stay%s apart in "
            "all, as they should (the first is vertex %u, which has left in frame %d)",
            name, colon, object->parting.count, object->parting.count > 1 ? "vertices lie" : "vertex lies",
            object->parting.count > 1 ? "" : "s", object->parting.vertex,
            r->frame_numbers[object->parting.frame]);
    if (object->source.parts_by != MESH_PARTS_BY_FILE && object->file.parts.count == 0) {
        char reason[120];
        recorded_object_explain_parts(object, reason, sizeof reason);
        note("%s%s%s, so that it is one part", name, colon, reason);
    }
    warn_repairs(name, colon, &object->file.repairs);
    if (object->welded && object->weld.collapsed_triangles > 0)
        warn("%s%swelding collapsed %u triangle%s, left out from here on", name, colon,
             object->weld.collapsed_triangles, object->weld.collapsed_triangles == 1 ? "" : "s");
}

/* Objects with frames may be called by different numbers: body from 1001, shirt from 1. */
static void warn_numbers(const recording *r) {
    const recorded_object *first = NULL;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        if (object->frames == NULL) continue;
        if (first == NULL) first = object;
        const uint32_t last = r->frame_count - 1;
        const int32_t own[2] = {animation_frame_number(object->frames, 0),
                                animation_frame_number(object->frames, last)};
        const int32_t named[2] = {animation_frame_number(first->frames, 0),
                                  animation_frame_number(first->frames, last)};
        if (own[0] == named[0] && own[1] == named[1]) continue;
        warn(
            "%s calls its frames %d to %d, and %s calls them %d to %d: the first frames of both are taken together",
            object->source.name, own[0], own[1], first->source.name, named[0], named[1]);
    }
}

/* In the first frame. What lies on others there alone must not be joined, and what welding has joined is. */
static bool find_near_seams(const recording *r, uint32_t index, near_seams *out) {
    recorded_object *object = &r->objects[index];
    if (object->welded && object->parting.count > 0) return false;
    double *positions = malloc((size_t)object->vertex_count * 3 * sizeof *positions);
    near_seams near;
    const bool found = positions != NULL && recorded_object_read(object, 0, positions, NULL) &&
                       near_seams_find(r->mesh, index, positions, &near) &&
                       !(object->welded && near.gap > 0.0 && near.distance <= object->weld.epsilon);
    free(positions);
    if (found) *out = near;
    return found;
}

/* Vertices that lie on each other, or all but, and are not joined. */
static void warn_seams(const recording *r, uint32_t index) {
    recorded_object *object = &r->objects[index];
    const char *name = r->object_count > 1 ? object->source.name : "",
               *colon = r->object_count > 1 ? ": " : "";
    near_seams near;
    if (!object_is_open(r, object)) return;
    if (!object->welded && welding_closes(r, object)) {
        warn("%s%svertices are split along seams; --weld exact would close %s", name, colon,
             r->object_count > 1 ? "it" : "the mesh");
    } else if (find_near_seams(r, index, &near)) {
        char distance[48] = "", option[24] = "exact";
        if (near.gap > 0.0) {
            snprintf(distance, sizeof distance, " but for %.2g", near.gap);
            snprintf(option, sizeof option, "%.2g", near.distance);
        }
        warn("%s%s%u of %u open edges lie on others%s%s; --weld %s joins them", name, colon,
             near.joined_edges, near.open_edges, object->frames != NULL ? " in the first frame" : "",
             distance, option);
    }
}

void recording_warn(recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++) warn_object(r, &r->objects[i]);
    warn_numbers(r);
    for (uint32_t i = 0; i < r->object_count; i++) warn_seams(r, i);
    note_open_surfaces(r);
    uint32_t defective = 0;
    for (uint32_t i = 0; i < cscd_mesh_component_count(r->mesh); i++) {
        cscd_component component = cscd_mesh_component(r->mesh, i);
        if (!component.closed_manifold && !is_cloth(&component) && ++defective <= COMPONENTS_NAMED)
            warn_component(r, i, &component);
    }
    if (defective > COMPONENTS_NAMED) warn("%u more components are like that", defective - COMPONENTS_NAMED);
}
