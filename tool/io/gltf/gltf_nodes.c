/* The nodes of a glTF file: a forest, where its parts stand at rest, which of them the scene shows, and their
 * instances. */
#include "tool/io/gltf/gltf_scene.h"

#include <inttypes.h>
#include <stdlib.h>

static bool read_placement(const gltf_element *element, gltf_node *node) {
    double columns[16];
    bool given;
    node->placement = (gltf_placement){.rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    if (!gltf_numbers(element, "matrix", 16, columns, &node->has_matrix)) return false;
    if (node->has_matrix) {
        node->matrix = gltf_transform_of_columns(columns);
        return true;
    }
    return gltf_numbers(element, "translation", 3, node->placement.translation, &given) &&
           gltf_numbers(element, "rotation", 4, node->placement.rotation, &given) &&
           gltf_numbers(element, "scale", 3, node->placement.scale, &given);
}

static bool read_children(const gltf_element *element, gltf_nodes *nodes, uint32_t parent) {
    size_t count;
    if (!gltf_array_length(element, "children", &count)) return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t child;
        if (!gltf_index_at(element, "children", i, "nodes", nodes->count, &child)) return false;
        gltf_node *above = &nodes->nodes[parent], *below = &nodes->nodes[child];
        if (below->parent != GLTF_NONE)
            return gltf_fail(
                element, "children[%zu] is node %" PRIu32 ", which is a child of node %" PRIu32 " already", i,
                child, below->parent);
        below->parent = parent;
        if (above->last_child == GLTF_NONE)
            above->first_child = child;
        else
            nodes->nodes[above->last_child].next_sibling = child;
        above->last_child = child;
    }
    return true;
}

static bool read_nodes(gltf_document *document, size_t mesh_count, size_t skin_count, gltf_nodes *nodes) {
    for (uint32_t i = 0; i < nodes->count; i++) {
        gltf_node *node = &nodes->nodes[i];
        node->parent = node->first_child = node->last_child = node->next_sibling = GLTF_NONE;
        node->mesh = node->skin = GLTF_NONE;
    }
    for (uint32_t i = 0; i < nodes->count; i++) {
        gltf_element element;
        gltf_node *node = &nodes->nodes[i];
        if (!gltf_element_at(&document->root, "nodes", "node", i, &element) ||
            !read_placement(&element, node) ||
            !gltf_index(&element, "mesh", "meshes", mesh_count, &node->mesh) ||
            !gltf_index(&element, "skin", "skins", skin_count, &node->skin) ||
            !read_children(&element, nodes, i))
            return false;
        node->name = gltf_string(&element, "name");
    }
    return true;
}

/* The node behind this one and all that is below it, in the order of its tree; GLTF_NONE behind the last
 * one. */
static uint32_t node_behind(const gltf_nodes *nodes, uint32_t root, uint32_t index) {
    while (index != root && nodes->nodes[index].next_sibling == GLTF_NONE) index = nodes->nodes[index].parent;
    return index == root ? GLTF_NONE : nodes->nodes[index].next_sibling;
}

/* The next node in that order, in which parents come before their children. */
static uint32_t next_node(const gltf_nodes *nodes, uint32_t root, uint32_t index) {
    const uint32_t child = nodes->nodes[index].first_child;
    return child != GLTF_NONE ? child : node_behind(nodes, root, index);
}

/* Walks up from a node that no root leads to: after as many steps as there are nodes it is on the circle. */
static bool fail_circle(const gltf_document *document, const gltf_nodes *nodes) {
    uint32_t index = 0;
    while (nodes->nodes[index].reached) index++;
    for (uint32_t step = 0; step < nodes->count; step++) index = nodes->nodes[index].parent;
    return file_reader_fail(document->reader, "node %" PRIu32 " is its own ancestor: the nodes form a circle",
                            index);
}

static bool order_nodes(gltf_document *document, gltf_nodes *nodes) {
    uint32_t ordered = 0;
    nodes->order = gltf_allocate(document->reader, nodes->count, sizeof *nodes->order);
    if (nodes->order == NULL) return false;
    for (uint32_t root = 0; root < nodes->count; root++) {
        if (nodes->nodes[root].parent != GLTF_NONE) continue;
        for (uint32_t i = root; i != GLTF_NONE; i = next_node(nodes, root, i)) {
            nodes->order[ordered++] = i;
            nodes->nodes[i].reached = true;
        }
    }
    return ordered == nodes->count || fail_circle(document, nodes);
}

/* The nodes below one that is shown are shown already, and are not walked through again: a scene may name
 * every node of a chain. */
static void show_tree(gltf_nodes *nodes, uint32_t root) {
    for (uint32_t i = root; i != GLTF_NONE;) {
        const bool before = nodes->nodes[i].shown;
        nodes->nodes[i].shown = true;
        i = before ? node_behind(nodes, root, i) : next_node(nodes, root, i);
    }
}

/* The scene that the file names, else its first; a file without scenes shows all nodes. */
static bool show_scene(gltf_document *document, gltf_nodes *nodes) {
    uint32_t index = 0;
    size_t scene_count, root_count;
    gltf_element scene;
    if (!gltf_array_length(&document->root, "scenes", &scene_count) ||
        !gltf_index(&document->root, "scene", "scenes", scene_count, &index))
        return false;
    if (scene_count == 0) {
        for (uint32_t i = 0; i < nodes->count; i++) nodes->nodes[i].shown = true;
        return true;
    }
    if (!gltf_element_at(&document->root, "scenes", "scene", index, &scene) ||
        !gltf_array_length(&scene, "nodes", &root_count))
        return false;
    for (size_t i = 0; i < root_count; i++) {
        uint32_t root;
        if (!gltf_index_at(&scene, "nodes", i, "nodes", nodes->count, &root)) return false;
        if (!nodes->nodes[root].shown) show_tree(nodes, root);
    }
    return true;
}

bool gltf_nodes_open(gltf_document *document, size_t mesh_count, size_t skin_count, gltf_nodes *out) {
    size_t count;
    gltf_nodes nodes = {0};
    if (!gltf_array_length(&document->root, "nodes", &count)) return false;
    if (count >= GLTF_NONE) return gltf_fail(&document->root, "has %zu nodes, too many", count);
    nodes.count = (uint32_t)count;
    nodes.nodes = gltf_allocate(document->reader, count, sizeof *nodes.nodes);
    if (nodes.nodes == NULL || !read_nodes(document, mesh_count, skin_count, &nodes) ||
        !order_nodes(document, &nodes) || !show_scene(document, &nodes)) {
        gltf_nodes_close(&nodes);
        return false;
    }
    *out = nodes;
    return true;
}

void gltf_nodes_close(gltf_nodes *nodes) {
    free(nodes->nodes);
    free(nodes->order);
    *nodes = (gltf_nodes){0};
}

/* ---- the extension EXT_mesh_gpu_instancing of nodes ------------------------------------------------------ */

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

/* ---- affine maps of glTF nodes --------------------------------------------------------------------------- */

gltf_transform gltf_transform_identity(void) {
    return (gltf_transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

gltf_transform gltf_transform_of_placement(const gltf_placement *placement) {
    const double *q = placement->rotation, *s = placement->scale, *t = placement->translation;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double length =
        x * x + y * y + z * z + w * w; /* squared: so it needs no root, and right angles are exact */
    const double d = length > 0 ? 2 / length : 0;
    return (gltf_transform){{
        {(1 - d * (y * y + z * z)) * s[0], d * (x * y - z * w) * s[1], d * (x * z + y * w) * s[2], t[0]},
        {d * (x * y + z * w) * s[0], (1 - d * (x * x + z * z)) * s[1], d * (y * z - x * w) * s[2], t[1]},
        {d * (x * z - y * w) * s[0], d * (y * z + x * w) * s[1], (1 - d * (x * x + y * y)) * s[2], t[2]},
    }};
}

gltf_transform gltf_transform_of_columns(const double columns[16]) {
    gltf_transform out;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) out.rows[row][column] = columns[4 * column + row];
    return out;
}

gltf_transform gltf_transform_multiply(const gltf_transform *a, const gltf_transform *b) {
    gltf_transform out;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a->rows[row][3] : 0;
            for (int k = 0; k < 3; k++) sum += a->rows[row][k] * b->rows[k][column];
            out.rows[row][column] = sum;
        }
    return out;
}

void gltf_transform_apply(const gltf_transform *a, const double x[3], double out[3]) {
    double moved[3];
    for (int row = 0; row < 3; row++) {
        const double *r = a->rows[row];
        moved[row] = r[0] * x[0] + r[1] * x[1] + r[2] * x[2] + r[3];
    }
    for (int axis = 0; axis < 3; axis++) out[axis] = moved[axis];
}

int gltf_transform_mirrors(const gltf_transform *a) {
    const double(*m)[4] = a->rows;
    const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return determinant < 0;
}
