/* The extension EXT_mesh_gpu_instancing of nodes: many copies of one mesh, each with a place of its own. */
#include "tool/io/gltf/gltf_instancing.h"

#include <inttypes.h>

/* Reads one attribute, and checks that all of them are of as many copies. */
static bool read_attribute(gltf_document *document, const gltf_element *attributes, const char *key,
                           uint32_t components, gltf_accessor *accessor, bool *given, uint32_t *count) {
    if (!gltf_accessor_open(document, attributes, key, components, accessor, given)) return false;
    if (!*given) return true;
    if (*count != 0 && accessor->count != *count)
        return gltf_fail(attributes, "%s is of %" PRIu32 " instances, the attribute before it of %" PRIu32,
                         key, accessor->count, *count);
    *count = accessor->count;
    return true;
}

/* Without bytes of its own in the file, an accessor stands for any number of zeros. */
static bool holds_data(const gltf_accessor *accessor, bool given) {
    return given && accessor->data != NULL;
}

static bool read_attributes(gltf_document *document, const gltf_element *attributes,
                            gltf_instancing *copies) {
    if (!read_attribute(document, attributes, "TRANSLATION", 3, &copies->translation,
                        &copies->has_translation, &copies->count) ||
        !read_attribute(document, attributes, "ROTATION", 4, &copies->rotation, &copies->has_rotation,
                        &copies->count) ||
        !read_attribute(document, attributes, "SCALE", 3, &copies->scale, &copies->has_scale, &copies->count))
        return false;
    return holds_data(&copies->translation, copies->has_translation) ||
           holds_data(&copies->rotation, copies->has_rotation) ||
           holds_data(&copies->scale, copies->has_scale) ||
           gltf_fail(attributes,
                     GLTF_INSTANCING " has neither TRANSLATION nor ROTATION nor SCALE with data, so "
                                     "nothing says where its instances are");
}

bool gltf_instancing_open(gltf_document *document, uint32_t node, gltf_instancing *out) {
    gltf_element element, extensions, extension, attributes;
    gltf_instancing copies = {0};
    *out = copies;
    if (!gltf_element_at(&document->root, "nodes", "node", node, &element) ||
        !gltf_object(&element, "extensions", &extensions))
        return false;
    if (extensions.value == NULL) return true;
    if (!gltf_object(&extensions, GLTF_INSTANCING, &extension)) return false;
    if (extension.value == NULL) return true;
    if (gltf_has(&element, "skin"))
        return gltf_fail(&element, "has a skin and " GLTF_INSTANCING
                                   ", and the format does not say where its instances are then");
    if (!gltf_object(&extension, "attributes", &attributes)) return false;
    if (attributes.value == NULL) return gltf_fail(&element, GLTF_INSTANCING " has no attributes");
    if (!read_attributes(document, &attributes, &copies)) return false;
    *out = copies;
    return true;
}

gltf_transform gltf_instancing_place(const gltf_instancing *copies, uint32_t copy) {
    gltf_placement placement = {.rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    if (copies->has_translation) gltf_accessor_get(&copies->translation, copy, placement.translation);
    if (copies->has_rotation) gltf_accessor_get(&copies->rotation, copy, placement.rotation);
    if (copies->has_scale) gltf_accessor_get(&copies->scale, copy, placement.scale);
    return gltf_transform_of_placement(&placement);
}
