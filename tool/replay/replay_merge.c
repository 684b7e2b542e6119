/* The shards of one recording, brought together. */
#include "tool/replay/replay_merge.h"

#include "tool/common/command.h"
#include "tool/replay/replay_run.h"

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
