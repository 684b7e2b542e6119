/* Where a result comes from: version, machine, options, input hashes. */
#pragma once

#include "src/io/json.h"

#include <stddef.h>
#include <stdint.h>

/* The commit that the tool was built from, "unknown" outside a repository. */
const char *provenance_commit(void);

/* "cscd 1.1.0 (commit)": what wrote a file. */
enum { PROVENANCE_GENERATOR_SIZE = 80 };
void provenance_generator(char text[PROVENANCE_GENERATOR_SIZE]);

/* 64-bit FNV-1a; start with PROVENANCE_HASH_START. Names a version of an input; no protection against
 * forgery. */
#define PROVENANCE_HASH_START 0xcbf29ce484222325u
uint64_t provenance_hash(uint64_t hash, const void *bytes, size_t size);

/* Members "version", "commit", "date", "machine" and "arguments" of the object that is open. */
void provenance_write(json *out, int argument_count, char **arguments, uint32_t thread_count);

/* {"name": ..., "hash": ...} in the array that is open. */
void provenance_write_input(json *out, const char *name, uint64_t hash);
