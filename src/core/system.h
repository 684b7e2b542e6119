/* The services of the operating system that the library needs beyond C11 and POSIX threads; system.c alone
 * knows the system. */
#pragma once

#include "cscd/cscd.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Memory whose address is a multiple of alignment, a power of two; NULL: there is none. */
void *system_memory(size_t size, size_t alignment);

/* Takes back what system_memory gave; NULL does nothing. */
void system_memory_free(void *block);

/* Bytes of physical memory that are free or can be freed without swapping, within the limit of the control group (container)
 * that the system shows; SIZE_MAX where the system does not tell. */
size_t system_memory_left(void);

/* Returns the memory that a control group's limit leaves, by the files that say so; UINT64_MAX where they do
 * not. Linux alone has it. */
uint64_t system_group_memory_left(const char *limit_path, const char *usage_path, const char *stat_path);

/* The processors of the machine, at least 1. */
uint32_t system_processors(void);

/* Those of them on which this process may run, at least 1. */
uint32_t system_processors_for_us(void);

/* False where a program has but one thread, as a build for WebAssembly without -pthread. */
bool system_has_threads(void);

/* Returns the number of forks between this process and the one that called first: another number in every
 * child. 0 where there is no fork. */
uint32_t system_forks(void);

/* ---- vector instructions of the processor -------------------------------------------------------------- */

/* Levels are the values from CSCD_SIMD_SCALAR to this one. */
#define SIMD_LAST CSCD_SIMD_NEON

/* The best level that this processor, its operating system and this build have; never AUTO. */
cscd_simd processor_best_simd(void);

/* Returns whether they have this level; false for AUTO and for any number that is no level. */
bool processor_has_simd(cscd_simd simd);
