/* One process of `cscd` at a time, a shard or the merge. */
#pragma once

#include "tool/mpi/launch_options.h"

/* What became of a shard, as ranks tell it to rank 0. */
typedef struct shard_report {
    int shard;  /* 0: there was none, the rank asks for its first one */
    int code;   /* its exit code; with `error`, 127 */
    int signal; /* that ended it; 0: none */
    int error;  /* errno: it could not be started */
} shard_report;

/* Exit codes of a shard that did not run all its jobs; any other shard would end so too. */
enum { SHARD_USAGE = 2, SHARD_UNDONE = 4 };

/* From now on SIGINT, SIGTERM and SIGHUP only set a flag, those aside that are ignored. */
void stop_signals_catch(void);
int stop_signal_seen(void); /* 0: none has come */

/* Start a process; false: it could not be, as *report says. None may run. */
bool shard_start(const launch_options *o, int shard, int count, shard_report *report);
bool merge_start(const launch_options *o, int count, shard_report *report);

bool process_runs(void);

/* Whether our process has ended; how is in *report then. Never waits. */
bool process_ended(shard_report *report);
