/* Divides parts into cells: connected groups of near vertices with similar normals. */
#include "sensors/cells.h"

#include "src/mesh/surface.h"

#include <string.h>

/* ---- connected labels ---------------------------------------------------------------------------------- */

enum { NO_LABEL = UINT32_MAX };

/* Finds pieces breadth first; the vertices of a piece are consecutive in the queue. */
static uint32_t find_pieces(const connect_work *work, const uint32_t *vertices, uint32_t count) {
    uint32_t piece_count = 0, end = 0;
    for (uint32_t i = 0; i < count; i++) work->pieces[vertices[i]] = NO_LABEL;
    for (uint32_t i = 0; i < count; i++) {
        if (work->pieces[vertices[i]] != NO_LABEL) continue;
        uint32_t next = end, label = work->labels[vertices[i]];
        work->piece_offsets[piece_count] = end;
        work->piece_labels[piece_count] = label;
        work->pieces[vertices[i]] = piece_count;
        for (work->queue[end++] = vertices[i]; next < end; next++) {
            uint32_t v = work->queue[next];
            for (uint32_t j = work->offsets[v]; j < work->offsets[v + 1]; j++) {
                uint32_t neighbour = work->neighbours[j];
                if (work->pieces[neighbour] != NO_LABEL || work->labels[neighbour] != label) continue;
                work->pieces[neighbour] = piece_count;
                work->queue[end++] = neighbour;
            }
        }
        piece_count++;
    }
    work->piece_offsets[piece_count] = end;
    return piece_count;
}

static uint32_t piece_size(const connect_work *work, uint32_t piece) {
    return work->piece_offsets[piece + 1] - work->piece_offsets[piece];
}

static void settle_largest(const connect_work *work, uint32_t piece_count, uint32_t label_count) {
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = NO_LABEL;
    for (uint32_t p = 0; p < piece_count; p++) {
        uint32_t *best = &work->best[work->piece_labels[p]];
        if (*best == NO_LABEL || piece_size(work, p) > piece_size(work, *best)) *best = p;
    }
    for (uint32_t p = 0; p < piece_count; p++) work->settled[p] = work->best[work->piece_labels[p]] == p;
}

/* Returns the label with most edges to this piece among its settled neighbours; NO_LABEL if there is none. */
static uint32_t most_common(const connect_work *work, uint32_t piece) {
    uint32_t most = NO_LABEL, *edges = work->best, begin = work->piece_offsets[piece];
    for (uint32_t i = begin; i < work->piece_offsets[piece + 1]; i++) {
        uint32_t v = work->queue[i];
        for (uint32_t j = work->offsets[v]; j < work->offsets[v + 1]; j++) {
            uint32_t other = work->pieces[work->neighbours[j]];
            if (other == piece || !work->settled[other]) continue;
            uint32_t label = work->piece_labels[other];
            edges[label]++;
            if (most == NO_LABEL || edges[label] > edges[most] ||
                (edges[label] == edges[most] && label < most))
                most = label;
        }
    }
    for (uint32_t i = begin; i < work->piece_offsets[piece + 1]; i++) {
        uint32_t v = work->queue[i];
        for (uint32_t j = work->offsets[v]; j < work->offsets[v + 1]; j++)
            edges[work->piece_labels[work->pieces[work->neighbours[j]]]] = 0;
    }
    return most;
}

static bool join_neighbours(const connect_work *work, uint32_t piece_count) {
    bool joined = false;
    for (uint32_t p = 0; p < piece_count; p++) {
        if (work->settled[p]) continue;
        uint32_t label = most_common(work, p);
        if (label == NO_LABEL) continue;
        work->piece_labels[p] = label;
        work->settled[p] = joined = true;
    }
    return joined;
}

/* Settles all pieces, and returns how many labels there are afterwards. */
static uint32_t settle_all(const connect_work *work, uint32_t piece_count, uint32_t label_count) {
    uint32_t p = 0;
    for (;;) {
        while (join_neighbours(work, piece_count)) {
        }
        while (p < piece_count && work->settled[p]) p++;
        if (p == piece_count) return label_count;
        work->best[label_count] = 0;
        work->piece_labels[p] = label_count++;
        work->settled[p] = true;
    }
}

/* vertices: all of a part, ascending; labels are below label_count. A label keeps its largest connected piece
 * (ties: the first). Another piece joins the neighbouring label with most edges to it (ties: the smaller),
 * and gets a label of its own if it reaches no piece with a label. Then labels are numbered again from
 * 0, by their first vertices; returns how many there are. */
static uint32_t connect_labels(const connect_work *work, const uint32_t *vertices, uint32_t count,
                               uint32_t label_count) {
    uint32_t piece_count = find_pieces(work, vertices, count), numbered = 0;
    settle_largest(work, piece_count, label_count);
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = 0;
    label_count = settle_all(work, piece_count, label_count);
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = NO_LABEL;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *number = &work->best[work->piece_labels[work->pieces[vertices[i]]]];
        if (*number == NO_LABEL) *number = numbered++;
        work->labels[vertices[i]] = *number;
    }
    return numbered;
}

/* ---- cells --------------------------------------------------------------------------------------------- */

/* Lists the edges between vertices of equal labels, in both directions, ascending from each vertex. Vertices
 * with the label PARTITION_NONE have no edge. offsets has vertex_count + 1 elements, neighbours 2 *
 * edge_count. */
static void list_neighbours(const cscd_mesh *mesh, const uint32_t *labels, uint32_t *offsets,
                            uint32_t *neighbours) {
    uint32_t *ends = offsets + 1, begin = 0;
    memset(offsets, 0, ((size_t)mesh->vertex_count + 1) * sizeof *offsets);
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *v = mesh->edges[e];
        if (labels[v[0]] != labels[v[1]]) continue;
        ends[v[0]]++;
        ends[v[1]]++;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t count = ends[v];
        ends[v] = begin;
        begin += count;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *v = mesh->edges[e];
        if (labels[v[0]] != labels[v[1]]) continue;
        neighbours[ends[v[0]]++] = v[1];
        neighbours[ends[v[1]]++] = v[0];
    }
}

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_arrays(cell_maker *maker) {
    const cscd_mesh *mesh = maker->partition->mesh;
    connect_work *c = &maker->connecting;
    size_t vertices = mesh->vertex_count, parts = maker->partition->part_count, largest = maker->largest;
    return (array_list){
        {ARRAY(maker->offsets, vertices + 1), ARRAY(maker->neighbours, 2 * (size_t)mesh->edge_count),
         ARRAY(maker->labels, vertices), ARRAY(maker->counts, parts),
         ARRAY(maker->vectors, largest * LBG_DIMENSIONS), ARRAY(maker->vector_labels, largest),
         ARRAY(maker->order, largest), ARRAY(maker->candidates, largest), ARRAY(maker->codes, largest),
         ARRAY(c->pieces, vertices), ARRAY(c->queue, largest), ARRAY(c->piece_offsets, largest + 1),
         ARRAY(c->piece_labels, largest), ARRAY(c->settled, largest), ARRAY(c->best, largest)}};
}

void cell_maker_free(cell_maker *maker) {
    context_free_all(maker->partition->context, list_arrays(maker));
}

/* Takes over the partition's present cells, numbered from 0 in each part. */
static void take_cells(cell_maker *maker) {
    const sensor_partition *partition = maker->partition;
    for (uint32_t v = 0; v < partition->mesh->vertex_count; v++) {
        uint32_t part = partition->vertex_parts[v];
        if (part != PARTITION_NONE)
            maker->labels[v] = partition->vertex_cells[v] - partition->parts[part].first_cell;
    }
    for (uint32_t p = 0; p < partition->part_count; p++) maker->counts[p] = partition->parts[p].cell_count;
}

cscd_status cell_maker_create(sensor_partition *partition, const double *positions, uint32_t largest,
                              cell_maker *out) {
    *out = (cell_maker){.partition = partition, .positions = positions, .largest = largest};
    if (!context_allocate_all(partition->context, list_arrays(out)))
        return context_out_of_memory(partition->context);
    list_neighbours(partition->mesh, partition->vertex_parts, out->offsets, out->neighbours);
    out->connecting.offsets = out->offsets;
    out->connecting.neighbours = out->neighbours;
    out->connecting.labels = out->labels;
    take_cells(out);
    return CSCD_OK;
}

/* ---- vectors ------------------------------------------------------------------------------------------- */

/* The normal of the triangles around a vertex, weighted by their areas; its length is 1, or 0. */
static void vertex_normal(const cscd_mesh *mesh, const double *positions, uint32_t vertex, double out[3]) {
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        double normal[3];
        surface_normal(mesh, positions, mesh->vertex_stars[i], normal);
        for (int k = 0; k < 3; k++) out[k] += normal[k];
    }
    double norm = surface_norm(out);
    for (int k = 0; k < 3 && norm > 0.0; k++) out[k] /= norm;
}

/* Only differences to the first vertex count, so that a part that is moved without rounding keeps its
 * vectors. */
static void offset_from_first(const cell_maker *maker, const uint32_t *vertices, uint32_t i, double out[3]) {
    const double *p = maker->positions + (size_t)vertices[i] * 3;
    const double *first = maker->positions + (size_t)vertices[0] * 3;
    for (int k = 0; k < 3; k++) out[k] = p[k] - first[k];
}

/* Fills each vector with the position relative to the mean, scaled to a root mean square of 1, and the
 * weighted normal. */
static void fill_vectors(const cell_maker *maker, const uint32_t *vertices, uint32_t count) {
    double mean[3] = {0, 0, 0}, squares = 0.0, d[3];
    for (uint32_t i = 0; i < count; i++) {
        offset_from_first(maker, vertices, i, d);
        for (int k = 0; k < 3; k++) mean[k] += d[k] / count;
    }
    for (uint32_t i = 0; i < count; i++) {
        offset_from_first(maker, vertices, i, d);
        for (int k = 0; k < 3; k++) squares += (d[k] - mean[k]) * (d[k] - mean[k]);
    }
    double radius = sqrt(squares / count), weight = maker->partition->options->normal_weight;
    for (uint32_t i = 0; i < count; i++) {
        double *vector = maker->vectors + (size_t)i * LBG_DIMENSIONS;
        offset_from_first(maker, vertices, i, d);
        for (int k = 0; k < 3; k++) vector[k] = radius > 0.0 ? (d[k] - mean[k]) / radius : 0.0;
        vertex_normal(maker->partition->mesh, maker->positions, vertices[i], vector + 3);
        for (int k = 3; k < LBG_DIMENSIONS; k++) vector[k] *= weight;
    }
}

/* ---- cells --------------------------------------------------------------------------------------------- */

void make_cells(cell_maker *maker, uint32_t part) {
    const sensor_partition *partition = maker->partition;
    const uint32_t *vertices = partition->part_vertices + partition->part_vertex_offsets[part];
    uint32_t count = partition->part_vertex_offsets[part + 1] - partition->part_vertex_offsets[part];
    if (count == 0) return;
    fill_vectors(maker, vertices, count);
    lbg l = {.vectors = maker->vectors,
             .vector_count = count,
             .codes_max = maker->counts[part],
             .epsilon = partition->options->epsilon,
             .labels = maker->vector_labels,
             .codes = maker->codes,
             .order = maker->order,
             .candidates = maker->candidates};
    uint32_t code_count = lbg_run(&l);
    for (uint32_t i = 0; i < count; i++) maker->labels[vertices[i]] = l.labels[i];
    maker->counts[part] = connect_labels(&maker->connecting, vertices, count, code_count);
}

static void list_cells(sensor_partition *partition) {
    uint32_t *ends = partition->cell_offsets + 1, begin = 0;
    memset(partition->cell_offsets, 0, ((size_t)partition->cell_count + 1) * sizeof *ends);
    for (uint32_t v = 0; v < partition->mesh->vertex_count; v++) {
        if (partition->vertex_cells[v] != PARTITION_NONE) ends[partition->vertex_cells[v]]++;
    }
    for (uint32_t c = 0; c < partition->cell_count; c++) {
        uint32_t count = ends[c];
        ends[c] = begin;
        begin += count;
    }
    for (uint32_t v = 0; v < partition->mesh->vertex_count; v++) {
        uint32_t cell = partition->vertex_cells[v];
        if (cell != PARTITION_NONE) partition->cell_vertices[ends[cell]++] = v;
    }
}

void hand_over_cells(const cell_maker *maker) {
    sensor_partition *partition = maker->partition;
    uint32_t cell_count = 0;
    for (uint32_t p = 0; p < partition->part_count; p++) {
        partition->parts[p].first_cell = cell_count;
        partition->parts[p].cell_count = maker->counts[p];
        for (uint32_t i = 0; i < maker->counts[p]; i++) partition->cell_parts[cell_count++] = p;
    }
    partition->cell_count = cell_count;
    for (uint32_t v = 0; v < partition->mesh->vertex_count; v++) {
        uint32_t part = partition->vertex_parts[v];
        partition->vertex_cells[v] =
            part == PARTITION_NONE ? PARTITION_NONE : partition->parts[part].first_cell + maker->labels[v];
    }
    list_cells(partition);
    list_neighbours(partition->mesh, partition->vertex_cells, partition->neighbour_offsets,
                    partition->neighbours);
}
