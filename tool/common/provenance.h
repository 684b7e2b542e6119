/* The origin of a result: version, machine, options and hashes of the inputs. */
#pragma once

#include "tool/io/json.h"

#include <stddef.h>
#include <stdint.h>

/* The commit that the tool was built from, "unknown" outside a repository. */
const char *provenance_commit(void);

/* The name of the program that wrote a file: "cscd 1.1.0 (commit)". */
enum { PROVENANCE_GENERATOR_SIZE = 80 };
void provenance_generator(char text[PROVENANCE_GENERATOR_SIZE]);

/* 64-bit FNV-1a; the first hash is PROVENANCE_HASH_START. It tells versions of an input apart, and does
 * not protect against forgery. */
#define PROVENANCE_HASH_START 0xcbf29ce484222325u
uint64_t provenance_hash(uint64_t hash, const void *bytes, size_t size);
/* The same of `count` numbers of `size` bytes each, which count from the lowest byte on, whatever the
 * machine. */
uint64_t provenance_hash_numbers(uint64_t hash, const void *numbers, size_t count, size_t size);

/* Writes the members "version", "commit", "compiler" and "flags" into the open object: what does not change
 * from run to run. */
void provenance_write_build(json *out);

/* The same, and "date", "machine", "threads" and "arguments". */
void provenance_write(json *out, int argument_count, char **arguments, uint32_t thread_count);

/* Writes {"name": ..., "fnv1a64": ...} into the open array. */
void provenance_write_input(json *out, const char *name, uint64_t hash);
