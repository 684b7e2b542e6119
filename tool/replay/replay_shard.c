/* Shards of a recording: which frames one of them has, the file of its results, and bringing all together. */
#include "tool/common/command.h"
#include "tool/common/provenance.h"
#include "tool/replay/replay.h"
#include "tool/replay/replay_run.h"
#include "tool/replay/shard_file.h"

#include <string.h>

static uint64_t hash_build(void) {
    const uint64_t layout = step_bytes_layout();
    char name[PROVENANCE_GENERATOR_SIZE];
    provenance_generator(name);
    return provenance_hash(provenance_hash(PROVENANCE_HASH_START, name, strlen(name)), &layout,
                           sizeof layout);
}

static uint64_t hash_list(uint64_t hash, const ignored_pair *items, size_t count) {
    return count > 0 ? provenance_hash(hash, items, count * sizeof *items) : hash;
}

/* The hash of the objects, their parts, and what is left out of them. */
static uint64_t hash_model(const replay *r) {
    uint64_t hash = PROVENANCE_HASH_START;
    for (uint32_t i = 0; i < r->recording.object_count; i++) {
        const recorded_object *object = &r->recording.objects[i];
        const uint64_t of_file = recorded_object_hash_model(object);
        hash = provenance_hash(hash, &of_file, sizeof of_file);
        hash = provenance_hash(hash, object->source.name, strlen(object->source.name) + 1);
        hash = provenance_hash(hash, recorded_object_triangles(object),
                               (size_t)object->triangle_count * 3 * sizeof(uint32_t));
    }
    const ignore_pairs *ignored = &r->ignored;
    const part_names *parts = &ignored->parts;
    hash = provenance_hash(hash, parts->labels,
                           cscd_mesh_triangle_count(r->recording.mesh) * sizeof *parts->labels);
    for (uint32_t i = 0; i < parts->count; i++)
        hash = provenance_hash(hash, parts->names[i], strlen(parts->names[i]) + 1);
    hash = hash_list(hash, ignored->triangles, ignored->triangle_count);
    hash = hash_list(hash, ignored->components, ignored->component_count);
    return hash_list(hash, ignored->separated, ignored->separated_count);
}

/* The hash of what a step depends on: regions and their points. */
static uint64_t hash_plan(const replay *r) {
    const cscd_plan *plan = r->plan.plan;
    const cscd_method method = r->plan.steps_by;
    uint64_t hash = provenance_hash(PROVENANCE_HASH_START, &method, sizeof method);
    if (plan == NULL) return hash;
    for (uint32_t i = 0; i < cscd_plan_region_count(plan); i++) {
        const cscd_region region = cscd_plan_region(plan, i);
        hash = provenance_hash(hash, region.detector_point, sizeof region.detector_point);
    }
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(r->recording.mesh); t++) {
        const uint32_t region = cscd_plan_triangle_region(plan, t);
        hash = provenance_hash(hash, &region, sizeof region);
    }
    return hash;
}

static shard_identity identity_of(const replay *r) {
    return (shard_identity){.build = hash_build(),
                            .model = hash_model(r),
                            .plan = hash_plan(r),
                            .options = r->options->hash,
                            .first = r->whole_first,
                            .last = r->whole_last,
                            .shard_first = r->first,
                            .shard_last = r->last,
                            .shard = r->options->list.shard,
                            .object_count = r->recording.object_count,
                            .component_count = cscd_mesh_component_count(r->recording.mesh),
                            .triangle_count = cscd_mesh_triangle_count(r->recording.mesh)};
}

bool replay_shard_prepare(replay *r, io_error *error) {
    const replay_options *o = r->options;
    uint32_t next;
    if (o->list.shard.count == 0) return true;
    chunks_of_shard(r->whole_first, r->whole_last, o->list.shard, &r->first, &r->last);
    const shard_identity identity = identity_of(r);
    if (!shard_file_open(o->list.results_path, o->list.resume != RESUME_NOTHING, &identity, o->argument_count,
                         o->arguments, &r->results, &next, error))
        return false;
    r->source.results = &r->results;
    if (next == r->first) return true;
    if (!shard_series_open_part(o->list.results_path, next, &r->resumed, error)) return false;
    r->source.shards = &r->resumed;
    return true;
}

bool replay_shard_matches(const replay *r, io_error *error) {
    if (r->merged == NULL) return true;
    const shard_identity identity = identity_of(r);
    const shard_entry *entry = &r->merged->entries[0];
    shard_identity theirs = entry->identity;
    theirs.shard.count = identity.shard.count;
    const char *difference = shard_identity_difference(&theirs, &identity);
    return difference == NULL ||
           io_fail(error, "%s: the shard is of %s than %s is now; has a file been edited since?", entry->path,
                   difference, recording_options_path(&r->options->source));
}

bool replay_shard_close(replay *r, io_error *error) {
    shard_series_close(&r->resumed);
    return r->source.results == NULL || append_file_close(&r->results, error);
}

/* ---- the shards of one recording, brought together ------------------------------------------------------- */

/* The command line of the shards, with the outputs of this one. */
static int choose_options(const merge_request *request, const shard_series *shards, replay_options *o) {
    given_options given;
    io_error error;
    int code;
    if (!replay_options_read(shards->argument_count, shards->arguments, o, &given, &code)) return code;
    o->list = (list_options){.path = NULL};
    for (size_t i = 0; i < request->output_count; i++) {
        const merged_output *output = &request->outputs[i];
        if (output->value != NULL &&
            !option_table_set(&replay_table, output->option, output->value, o, &given, &error))
            return fail_usage("merge", "%s", error.text);
    }
    code = replay_options_finish(o, &given);
    o->quiet = request->quiet;
    o->reproducible = o->reproducible || request->reproducible;
    o->argument_count = request->argument_count;
    o->arguments = request->arguments;
    return code;
}

int replay_merge(const merge_request *request) {
    replay_options options;
    shard_series shards;
    io_error error;
    if (!shard_series_open(request->paths, request->path_count, &shards, &error))
        return fail_input("%s", error.text);
    int code = choose_options(request, &shards, &options);
    if (code == EXIT_RAN) code = replay_run(&options, &shards, NULL, NULL);
    shard_series_close(&shards);
    return code;
}
