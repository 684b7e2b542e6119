/* A world in which the calls of a row are made: what the driver of proofs chooses, and what it sees afterwards. */
#pragma once

#include "tests/support/proofs/proof.h"

/* A world of so many threads in which the call number `at` of a source fails or cancels. */
proof proof_world(const proof_row *row, uint32_t thread_count, proof_source source, size_t at);

/* Tasks are run by the host, on one thread and the last ones first. */
void proof_host_loop(proof *p);

/* Makes the calls, and destroys everything; any promise that is not kept fails the test. */
void proof_live(proof *p);
