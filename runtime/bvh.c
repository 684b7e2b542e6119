/* A flat binary tree of 14-DOPs over the triangles of a mesh: one subtree per region. */
#include "runtime/bvh.h"

#include <string.h>

/* Things to be split from one another: regions first, the triangles of one region then. */
typedef struct item_set {
    uint32_t *order;
    double (*centres)[3]; /* indexed by what order holds */
} item_set;

/* A run of items that becomes a subtree, the right child of parent (UINT32_MAX: a left child or the root). */
typedef struct pending_run {
    const item_set *items;
    uint32_t begin, end, parent;
} pending_run;

typedef struct builder {
    const cscd_mesh *mesh;
    bvh_regions given;
    item_set regions, triangles;
    uint32_t *region_offsets; /* the triangles of region r: order[offsets[r] .. offsets[r + 1]) */
    pending_run *stack;
    bvh_node *nodes;
    uint32_t *marks;
    uint32_t node_count;
} builder;

static double project(const double p[3], int axis) {
    static const double axes[KDOP_AXIS_COUNT][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                                    {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    return axes[axis][0] * p[0] + axes[axis][1] * p[1] + axes[axis][2] * p[2];
}

/* The axis along which the centres of a run extend farthest, and the middle of that extent. */
static int longest_axis(const pending_run *run, double *middle) {
    int longest = 0;
    double longest_extent = -1.0;
    for (int axis = 0; axis < KDOP_AXIS_COUNT; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = run->begin; i < run->end; i++) {
            double value = project(run->items->centres[run->items->order[i]], axis);
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        double extent =
            (high - low) * (axis < 3 ? 1.0 : 0.57735026918962576); /* diagonals have length sqrt 3 */
        if (extent > longest_extent) {
            longest_extent = extent;
            longest = axis;
            *middle = low + 0.5 * (high - low);
        }
    }
    return longest;
}

static uint32_t partition_run(const pending_run *run) {
    double middle = 0.0;
    int axis = longest_axis(run, &middle);
    uint32_t *order = run->items->order;
    uint32_t split = run->begin;
    for (uint32_t i = run->begin; i < run->end; i++) {
        if (project(run->items->centres[order[i]], axis) < middle) {
            uint32_t item = order[i];
            order[i] = order[split];
            order[split++] = item;
        }
    }
    /* All centres coincide, or rounding puts them on one side: halve by count. */
    if (split == run->begin || split == run->end) split = run->begin + (run->end - run->begin) / 2;
    return split;
}

static void build_nodes(builder *b) {
    uint32_t depth = 0;
    b->stack[depth++] = (pending_run){&b->regions, 0, b->given.count, UINT32_MAX};
    while (depth > 0) {
        pending_run run = b->stack[--depth];
        if (run.items == &b->regions && run.end - run.begin == 1) {
            uint32_t region = b->regions.order[run.begin];
            run.items = &b->triangles;
            run.begin = b->region_offsets[region];
            run.end = b->region_offsets[region + 1];
        }
        uint32_t node = b->node_count++;
        if (run.parent != UINT32_MAX) b->nodes[run.parent].right = node;
        if (run.end - run.begin == 1) {
            b->nodes[node].triangle = run.items->order[run.begin];
            continue;
        }
        uint32_t split = partition_run(&run);
        b->stack[depth++] = (pending_run){run.items, split, run.end, node};
        b->stack[depth++] = (pending_run){run.items, run.begin, split, UINT32_MAX};
    }
}

/* Of triangles, and of regions the mean of these. Wants region_offsets. */
static void find_centres(builder *b, const double *positions) {
    const cscd_mesh *mesh = b->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t region = b->given.of_triangle[t];
        uint32_t size = b->region_offsets[region + 1] - b->region_offsets[region];
        for (int k = 0; k < 3; k++) {
            double sum = 0.0;
            for (int i = 0; i < 3; i++) sum += positions[(size_t)mesh->triangles[t][i] * 3 + (size_t)k];
            b->triangles.centres[t][k] = sum / 3.0;
            b->regions.centres[region][k] += sum / 3.0 / size;
        }
    }
}

/* Regions in order, and the triangles sorted by region. */
static void fill_orders(builder *b) {
    uint32_t triangle_count = b->mesh->triangle_count, sum = 0;
    uint32_t *next =
        b->region_offsets + 1; /* counts, then the next free places: these move to the runs' ends */
    for (uint32_t t = 0; t < triangle_count; t++) next[b->given.of_triangle[t]]++;
    for (uint32_t r = 0; r < b->given.count; r++) {
        uint32_t size = next[r];
        b->regions.order[r] = r;
        next[r] = sum;
        sum += size;
    }
    for (uint32_t t = 0; t < triangle_count; t++) b->triangles.order[next[b->given.of_triangle[t]]++] = t;
}

static bool allocate_builder(cscd_context *context, builder *b) {
    uint32_t triangle_count = b->mesh->triangle_count, region_count = b->given.count;
    b->triangles.order = context_allocate(context, triangle_count, sizeof(uint32_t));
    b->triangles.centres = context_allocate(context, triangle_count, sizeof(double[3]));
    b->regions.order = context_allocate(context, region_count, sizeof(uint32_t));
    b->regions.centres = context_allocate(context, region_count, sizeof(double[3]));
    b->region_offsets = context_allocate(context, (size_t)region_count + 1, sizeof(uint32_t));
    /* Every run on the stack holds at least one triangle of its own. */
    b->stack = context_allocate(context, (size_t)triangle_count + 1, sizeof *b->stack);
    b->nodes = context_allocate(context, (size_t)triangle_count * 2 - 1, sizeof *b->nodes);
    b->marks = context_allocate(context, (size_t)triangle_count * 2 - 1, sizeof *b->marks);
    return b->triangles.order != NULL && b->triangles.centres != NULL && b->regions.order != NULL &&
           b->regions.centres != NULL && b->region_offsets != NULL && b->stack != NULL && b->nodes != NULL &&
           b->marks != NULL;
}

static void free_builder(cscd_context *context, builder *b) {
    void *blocks[] = {b->triangles.order, b->triangles.centres, b->regions.order,
                      b->regions.centres, b->region_offsets,    b->stack};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
}

cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, bvh *out) {
    builder b = {.mesh = mesh, .given = regions};
    bool allocated = allocate_builder(mesh->context, &b);
    if (allocated) {
        fill_orders(&b);
        find_centres(&b, positions);
        build_nodes(&b);
        *out = (bvh){b.nodes, b.marks, b.node_count};
    } else {
        context_free(mesh->context, b.nodes);
        context_free(mesh->context, b.marks);
    }
    free_builder(mesh->context, &b);
    return allocated ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

void bvh_free(cscd_context *context, bvh *tree) {
    context_free(context, tree->nodes);
    context_free(context, tree->marks);
    *tree = (bvh){0};
}

void bvh_refit(bvh *tree, const cscd_mesh *mesh, const kdop *vertex_volumes) {
    for (uint32_t i = tree->node_count; i-- > 0;) {
        bvh_node *node = &tree->nodes[i];
        if (bvh_is_leaf(node)) {
            node->volume = kdop_triangle(vertex_volumes, mesh->triangles[node->triangle]);
        } else {
            node->volume = kdop_union(&tree->nodes[i + 1].volume, &tree->nodes[node->right].volume);
        }
    }
}

/* Gives inner nodes the region that their children have in common, and their flags or'ed. */
static void join_marks(bvh *tree) {
    static const uint32_t flags = (1 << BVH_FLAG_BITS) - 1;
    for (uint32_t i = tree->node_count; i-- > 0;) {
        const bvh_node *node = &tree->nodes[i];
        if (bvh_is_leaf(node)) continue;
        uint32_t left = tree->marks[i + 1], right = tree->marks[node->right];
        uint32_t region = (left ^ right) >> BVH_FLAG_BITS == 0 ? left >> BVH_FLAG_BITS : BVH_SEVERAL;
        tree->marks[i] = region << BVH_FLAG_BITS | ((left | right) & flags);
    }
}

void bvh_mark(bvh *tree, bvh_regions regions, const uint8_t *orientations) {
    for (uint32_t i = 0; i < tree->node_count; i++) {
        uint32_t t = tree->nodes[i].triangle;
        if (bvh_is_leaf(&tree->nodes[i]))
            tree->marks[i] = regions.of_triangle[t] << BVH_FLAG_BITS | orientations[t];
    }
    join_marks(tree);
}

void bvh_mark_fresh(bvh *tree, bvh_regions regions, const uint8_t *earlier, const uint8_t *orientations) {
    for (uint32_t i = 0; i < tree->node_count; i++) {
        uint32_t t = tree->nodes[i].triangle;
        if (!bvh_is_leaf(&tree->nodes[i])) continue;
        uint32_t before = earlier[t] == ORIENTATION_ZERO ? 0 : earlier[t];
        uint32_t fresh = orientations[t] == ORIENTATION_ZERO ? before : 0;
        tree->marks[i] = regions.of_triangle[t] << BVH_FLAG_BITS | fresh << BVH_ORIENTATION_BITS | before;
    }
    join_marks(tree);
}

void bvh_mark_suspects(bvh *tree, const bool *suspects) {
    for (uint32_t i = tree->node_count; i-- > 0;) {
        const bvh_node *node = &tree->nodes[i];
        tree->marks[i] =
            bvh_is_leaf(node) ? suspects[node->triangle] : tree->marks[i + 1] | tree->marks[node->right];
    }
}
