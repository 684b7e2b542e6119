/* Hands the jobs of a list out to shards. */
#include "tool/jobs/job_shards.h"

#include "tool/common/command.h"

#include <stdlib.h>
#include <string.h>

bool read_shard(const char *text, void *place) {
    shard_choice shard;
    char index[16];
    const char *slash = strchr(text, '/');
    if (slash == NULL || (size_t)(slash - text) >= sizeof index) return false;
    memcpy(index, text, (size_t)(slash - text));
    index[slash - text] = '\0';
    if (!parse_unsigned(index, &shard.index) || !parse_unsigned(slash + 1, &shard.count)) return false;
    if (shard.index < 1 || shard.index > shard.count || shard.count > SHARD_COUNT_MAX) return false;
    *(shard_choice *)place = shard;
    return true;
}

/* ---- the shard with the least --------------------------------------------------------------------------- */

typedef struct shard_load {
    uint64_t size;
    uint32_t shard; /* from 0 */
} shard_load;

static bool load_less(const shard_load *a, const shard_load *b) {
    return a->size != b->size ? a->size < b->size : a->shard < b->shard;
}

/* Moves the first load of a heap, which has grown, to its place. */
static void sink_first(shard_load *heap, uint32_t count) {
    const shard_load moved = heap[0];
    uint32_t hole = 0;
    for (uint32_t child; (child = 2 * hole + 1) < count; hole = child) {
        if (child + 1 < count && load_less(&heap[child + 1], &heap[child])) child++;
        if (!load_less(&heap[child], &moved)) break;
        heap[hole] = heap[child];
    }
    heap[hole] = moved;
}

/* ---- jobs by size ---------------------------------------------------------------------------------------- */

typedef struct sized_job {
    uint64_t size;
    uint32_t job;
} sized_job;

/* The largest first. */
static int compare_sizes(const void *a, const void *b) {
    const sized_job *x = a, *y = b;
    if (x->size != y->size) return x->size > y->size ? -1 : 1;
    return x->job < y->job ? -1 : 1;
}

static void assign_sized(sized_job *sized, uint32_t count, shard_load *heap, uint32_t shard_count,
                         uint32_t *shards) {
    for (uint32_t i = 0; i < shard_count; i++) heap[i] = (shard_load){0, i};
    qsort(sized, count, sizeof *sized, compare_sizes);
    for (uint32_t i = 0; i < count; i++) {
        shards[sized[i].job] = heap[0].shard;
        heap[0].size += sized[i].size;
        sink_first(heap, shard_count);
    }
}

static uint32_t gather_sized(const job_list *list, uint32_t shard_count, sized_job *sized, uint32_t *shards) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        shards[i] = i % shard_count;
        if (list->jobs[i].size != NO_JOB_SIZE) sized[count++] = (sized_job){list->jobs[i].size, i};
    }
    return count;
}

bool job_shard_choose(const job_list *list, shard_choice shard, uint32_t **jobs, uint32_t *count,
                      io_error *error) {
    const uint32_t shard_count = shard.count > 0 ? shard.count : 1,
                   index = shard.count > 0 ? shard.index - 1 : 0;
    uint32_t *shards = malloc(list->count * sizeof *shards), *chosen = malloc(list->count * sizeof *chosen);
    sized_job *sized = malloc(list->count * sizeof *sized);
    shard_load *heap = malloc(shard_count * sizeof *heap);
    const bool good = (shards != NULL && chosen != NULL && sized != NULL && heap != NULL) ||
                      io_fail(error, "out of memory for %u jobs", list->count);
    *count = 0;
    if (good) {
        assign_sized(sized, gather_sized(list, shard_count, sized, shards), heap, shard_count, shards);
        for (uint32_t i = 0; i < list->count; i++)
            if (shards[i] == index) chosen[(*count)++] = i;
        *jobs = chosen;
    } else
        free(chosen);
    free(shards);
    free(sized);
    free(heap);
    return good;
}
