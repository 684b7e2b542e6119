/* What a replay says to people. */
#pragma once

#include "tool/replay/replay_run.h"

/* Prints the answer, the events, the contacts, and what limits them; with --timings more. The replay has ended, be it earlier
 * than expected; without an interval there is the answer alone. */
void replay_print_results(const replay *r);

/* Prints what a person should know beside the results: faults of the mesh, and pairs that are left out. */
void replay_print_remarks(replay *r);
