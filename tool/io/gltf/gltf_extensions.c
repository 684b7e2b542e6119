/* The extensions of a glTF file: those that it requires must be read, and those that it only uses are
 * named. */
#include "tool/io/gltf/gltf_scene.h"

#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool begins_with_any(const char *text, const char *const *prefixes, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strncmp(text, prefixes[i], strlen(prefixes[i])) == 0) return true;
    return false;
}

static bool is_read(const char *extension) {
    return strcmp(extension, "KHR_mesh_quantization") == 0 || strcmp(extension, GLTF_INSTANCING) == 0;
}

/* These say how a surface looks, and leave it where it is. */
static bool is_harmless(const char *extension) {
    static const char *const prefixes[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_",
                                           "EXT_lights_",    "KHR_xmp",      "MSFT_texture_"};
    return begins_with_any(extension, prefixes, sizeof prefixes / sizeof *prefixes);
}

/* These only say what a thing is or may be used for. */
static bool is_remark(const char *extension) {
    static const char *const prefixes[] = {"EXT_mesh_features",
                                           "EXT_instance_features",
                                           "EXT_structural_metadata",
                                           "EXT_feature_metadata",
                                           "CESIUM_primitive_outline",
                                           "FB_geometry_metadata",
                                           "KHR_audio",
                                           "KHR_node_selectability",
                                           "KHR_node_hoverability",
                                           "KHR_physics_rigid_bodies",
                                           "MSFT_packing_",
                                           "OMI_"};
    return begins_with_any(extension, prefixes, sizeof prefixes / sizeof *prefixes);
}

static bool is_compression(const char *extension) {
    return strstr(extension, "draco") != NULL || strstr(extension, "meshopt") != NULL;
}

bool gltf_extensions_check(const gltf_element *root) {
    size_t count;
    if (!gltf_array_length(root, "extensionsRequired", &count)) return false;
    for (size_t i = 0; i < count; i++) {
        const char *name = gltf_string_at(root, "extensionsRequired", i);
        if (name == NULL) return gltf_fail(root, "extensionsRequired[%zu] is no string", i);
        if (is_harmless(name) || is_read(name)) continue;
        return gltf_fail(root, "requires the extension %.*s, which is not read%s", TEXT_CUT(name, 80),
                         is_compression(name) ? "; export it without compression" : "");
    }
    return true;
}

/* ---- those that are only used ------------------------------------------------------------------------ */

enum { NAMES_MAX = 8, NAME_SIZE = 64 };

/* The extensions found so far. */
typedef struct unread_extensions {
    uint32_t count, more; /* names, and how many uses of further ones there are */
    struct {
        char name[NAME_SIZE];
        char where[96]; /* the first element that has it */
        uint32_t uses;
    } of[NAMES_MAX];
} unread_extensions;

typedef struct extension_user {
    unread_extensions *found;
    const gltf_element *element;
} extension_user;

static void add_use(const char *name, void *user) {
    const extension_user *u = user;
    unread_extensions *found = u->found;
    if (is_read(name) || is_harmless(name) || is_remark(name)) return;
    char shown[NAME_SIZE];
    snprintf(shown, sizeof shown, "%.*s", TEXT_CUT(name, NAME_SIZE - 1));
    uint32_t i = 0;
    while (i < found->count && strcmp(found->of[i].name, shown) != 0) i++;
    if (i == NAMES_MAX) {
        found->more++;
        return;
    }
    if (i == found->count) {
        found->count++;
        memcpy(found->of[i].name, shown, sizeof shown);
        snprintf(found->of[i].where, sizeof found->of[i].where, "%s", u->element->name);
    }
    found->of[i].uses++;
}

static bool look_at(const gltf_element *element, unread_extensions *found) {
    gltf_element extensions;
    extension_user user = {found, element};
    if (!gltf_object(element, "extensions", &extensions)) return false;
    if (extensions.value != NULL) gltf_visit_members(&extensions, add_use, &user);
    return true;
}

static bool look_at_array(const gltf_element *owner, const char *key, const char *label,
                          unread_extensions *found) {
    size_t count;
    if (!gltf_array_length(owner, key, &count)) return false;
    for (size_t i = 0; i < count; i++) {
        gltf_element element;
        if (!gltf_element_at(owner, key, label, i, &element) || !look_at(&element, found)) return false;
    }
    return true;
}

static bool look_at_nodes(const gltf_scene *scene, unread_extensions *found) {
    for (uint32_t i = 0; i < scene->nodes.count; i++) {
        gltf_element element;
        if (!scene->nodes.nodes[i].shown) continue;
        if (!gltf_element_at(&scene->document.root, "nodes", "node", i, &element) ||
            !look_at(&element, found))
            return false;
    }
    return true;
}

/* Those that the scene shows: their vertices were read. */
static bool look_at_meshes(const gltf_scene *scene, unread_extensions *found) {
    for (size_t i = 0; i < scene->mesh_count; i++) {
        gltf_element element;
        if (scene->meshes[i].vertices == NULL) continue;
        if (!gltf_element_at(&scene->document.root, "meshes", "mesh", i, &element) ||
            !look_at(&element, found) || !look_at_array(&element, "primitives", "primitive", found))
            return false;
    }
    return true;
}

/* "KHR_x (node 3 and 2 more)", and what that means. Of compressed data a plain copy was read, or the file
 * would have been refused. */
static void write_note(const unread_extensions *found, char *text, size_t size) {
    size_t used = (size_t)snprintf(text, size, "the glTF extension%s ", found->count > 1 ? "s" : "");
    bool all_compressed = found->more == 0;
    for (uint32_t i = 0; i < found->count; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s%s (%s", i > 0 ? ", " : "", found->of[i].name,
                                 found->of[i].where);
        if (found->of[i].uses > 1)
            used +=
                (size_t)snprintf(text + used, size - used, " and %" PRIu32 " more", found->of[i].uses - 1);
        used += (size_t)snprintf(text + used, size - used, ")");
        all_compressed = all_compressed && is_compression(found->of[i].name);
    }
    if (found->more > 0) used += (size_t)snprintf(text + used, size - used, " and others");
    snprintf(text + used, size - used, " %s not read: %s", found->count > 1 ? "are" : "is",
             all_compressed ? "the uncompressed data beside them are looked at, which may be others"
                            : "if they move, shape or hide surfaces, what is looked at is not what other "
                              "programs show");
}

bool gltf_extensions_note(const gltf_scene *scene, char **out) {
    unread_extensions found = {0};
    const size_t size = (size_t)NAMES_MAX * 200 + 400;
    *out = NULL;
    if (!look_at_nodes(scene, &found) || !look_at_meshes(scene, &found) ||
        !look_at_array(&scene->document.root, "bufferViews", "buffer view", &found))
        return false;
    if (found.count == 0) return true;
    *out = gltf_allocate(scene->document.reader, size, 1);
    if (*out == NULL) return false;
    write_note(&found, *out, size);
    return true;
}
