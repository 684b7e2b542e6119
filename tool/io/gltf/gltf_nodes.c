/* The nodes of a glTF file: a forest, where its parts stand at rest, and which of them the scene shows. */
#include "tool/io/gltf/gltf_nodes.h"

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

/* The node behind this one and all that is below it, in the order of its tree; GLTF_NONE behind the last one. */
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

/* What is below a node that is shown is shown already, and is not walked through again: a scene may name every node of a chain. */
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
