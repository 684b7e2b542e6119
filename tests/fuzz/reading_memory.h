/* How much memory the program takes, as the address sanitizer counts it. */
#pragma once

#include <stddef.h>

/* Begins to count, from 0. */
void reading_memory_begin(void);

/* The most that was allocated at once since then; 0 in a program without the sanitizer. */
size_t reading_memory_peak(void);
