/* Makes the labels of vertices connected along edges. */
#include "preprocess/partition/connect.h"

enum { NONE = UINT32_MAX };

/* Finds pieces breadth first; the vertices of a piece are consecutive in the queue. */
static uint32_t find_pieces(const connect_work *work, const uint32_t *vertices, uint32_t count) {
    uint32_t piece_count = 0, end = 0;
    for (uint32_t i = 0; i < count; i++) work->pieces[vertices[i]] = NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (work->pieces[vertices[i]] != NONE) continue;
        uint32_t next = end, label = work->labels[vertices[i]];
        work->piece_offsets[piece_count] = end;
        work->piece_labels[piece_count] = label;
        work->pieces[vertices[i]] = piece_count;
        for (work->queue[end++] = vertices[i]; next < end; next++) {
            uint32_t v = work->queue[next];
            for (uint32_t j = work->offsets[v]; j < work->offsets[v + 1]; j++) {
                uint32_t neighbour = work->neighbours[j];
                if (work->pieces[neighbour] != NONE || work->labels[neighbour] != label) continue;
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
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = NONE;
    for (uint32_t p = 0; p < piece_count; p++) {
        uint32_t *best = &work->best[work->piece_labels[p]];
        if (*best == NONE || piece_size(work, p) > piece_size(work, *best)) *best = p;
    }
    for (uint32_t p = 0; p < piece_count; p++) work->settled[p] = work->best[work->piece_labels[p]] == p;
}

/* Returns the label with most edges to this piece among the settled pieces beside it; NONE without any. */
static uint32_t most_common(const connect_work *work, uint32_t piece) {
    uint32_t most = NONE, *edges = work->best, begin = work->piece_offsets[piece];
    for (uint32_t i = begin; i < work->piece_offsets[piece + 1]; i++) {
        uint32_t v = work->queue[i];
        for (uint32_t j = work->offsets[v]; j < work->offsets[v + 1]; j++) {
            uint32_t other = work->pieces[work->neighbours[j]];
            if (other == piece || !work->settled[other]) continue;
            uint32_t label = work->piece_labels[other];
            edges[label]++;
            if (most == NONE || edges[label] > edges[most] || (edges[label] == edges[most] && label < most))
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
        if (label == NONE) continue;
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

uint32_t connect_labels(const connect_work *work, const uint32_t *vertices, uint32_t count,
                        uint32_t label_count) {
    uint32_t piece_count = find_pieces(work, vertices, count), numbered = 0;
    settle_largest(work, piece_count, label_count);
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = 0;
    label_count = settle_all(work, piece_count, label_count);
    for (uint32_t label = 0; label < label_count; label++) work->best[label] = NONE;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *number = &work->best[work->piece_labels[work->pieces[vertices[i]]]];
        if (*number == NONE) *number = numbered++;
        work->labels[vertices[i]] = *number;
    }
    return numbered;
}
