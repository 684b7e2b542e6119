/* The limits of this machine on one thread: bandwidth, arithmetic, random reads, latency. */
#include "benchmarks/lib/machine_kernels.h"
#include "models/shapes/body.h"
#include "src/core/system.h"
#include "src/core/timer.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 7, SET_COUNT = 5, STEPS = 2000000, LINE = 64 };

static const char help[] =
    "usage: machine [--quick]\n"
    "\n"
    "Measures the limits of one thread of this machine, the best of some repeats each: bandwidth of reads,\n"
    "writes and copies and random reads of points (24 bytes) in working sets of several sizes, latency of\n"
    "reads that depend on one another, rates of multiplications and additions (separate, as in the library)\n"
    "and of tests of boxes. --quick: no working set beyond 64 MiB.\n";

/* Bytes of the working sets: in the first and second level of cache, twice in the third, and in memory. */
static const size_t sets[SET_COUNT] = {1 << 14, 1 << 20, 1 << 24, 1 << 26, (size_t)3 << 29};
static const char *const set_names[SET_COUNT] = {"16 KiB", "1 MiB", "16 MiB", "64 MiB", "1.5 GiB"};

static volatile uint64_t seen; /* results go here, so that the loops are not optimised away */

static double lesser_time(double least, double ms) {
    return least < 0.0 || ms < least ? ms : least;
}

/* Returns how often to run over a set, so that about as many bytes are moved for each size. */
static uint32_t rounds_of(size_t size) {
    size_t count = ((size_t)1 << 27) / size;
    return count > 0 ? (uint32_t)count : 1;
}

/* ---- bandwidth --------------------------------------------------------------------------------------- */

typedef enum transfer { TRANSFER_READ, TRANSFER_WRITE, TRANSFER_COPY } transfer;

/* Measures GB/s of the bytes that the program moves: a copy counts both its reads and its writes. */
static double measure_bandwidth(const machine_kernels *k, transfer kind, char *memory, size_t size) {
    double least = -1.0;
    uint32_t count = rounds_of(size);
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double since = timer_now_ms(), ms = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            if (kind == TRANSFER_READ) seen = k->read(memory, size);
            if (kind == TRANSFER_WRITE) k->write(memory, size, i);
            if (kind == TRANSFER_COPY) k->copy(memory, memory + size / 2, size / 2);
        }
        timer_lap(&since, &ms);
        least = lesser_time(least, ms);
    }
    return (double)size * count / least * 1e-6;
}

static void print_bandwidth(const machine_kernels *const *levels, int level_count, char *memory,
                            int set_count) {
    printf("GB/s of the bytes that a program reads and writes\n  %-8s %-8s", "set", "level");
    printf(" %8s %8s %8s\n", "read", "write", "copy");
    for (int i = 0; i < set_count; i++) {
        for (int l = 0; l < level_count; l++) {
            printf("  %-8s %-8s", set_names[i], levels[l]->name);
            for (int kind = TRANSFER_READ; kind <= TRANSFER_COPY; kind++)
                printf(" %8.1f", measure_bandwidth(levels[l], (transfer)kind, memory, sets[i]));
            putchar('\n');
            fflush(stdout);
        }
    }
}

/* ---- random reads ------------------------------------------------------------------------------------ */

/* Returns the successor of each of 0 .. count - 1 on one random cycle through all, by Sattolo's shuffle. */
static uint32_t *random_cycle(uint32_t count) {
    uint32_t *next = body_allocate(count, sizeof *next);
    uint64_t state = 1;
    for (uint32_t i = 0; i < count; i++) next[i] = i;
    for (uint32_t i = count - 1; i > 0; i--) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        uint32_t j = (uint32_t)((state >> 33) % i), kept = next[i];
        next[i] = next[j];
        next[j] = kept;
    }
    return next;
}

/* Returns the ns of a read of three doubles at random places that are known ahead. */
static double random_point_ns(const double *points, size_t size) {
    uint32_t count = (uint32_t)(size / sizeof(double[3])), reads = count < 1 << 22 ? count : 1 << 22;
    uint32_t *order = random_cycle(count);
    uint32_t repeats = (1u << 22) / reads;
    double least = -1.0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double sums[3] = {0.0, 0.0, 0.0}, since = timer_now_ms(), ms = 0.0;
        for (uint32_t round = 0; round < repeats; round++) {
            for (uint32_t i = 0; i < reads; i++) {
                for (int k = 0; k < 3; k++) sums[k] += points[(size_t)order[i] * 3 + (size_t)k];
            }
        }
        timer_lap(&since, &ms);
        seen = (uint64_t)(sums[0] + sums[1] + sums[2]);
        least = lesser_time(least, ms);
    }
    free(order);
    return least * 1e6 / ((double)reads * repeats);
}

/* Returns the ns of a read whose place is the result of the read before, one in each cache line. */
static double latency_ns(char *memory, size_t size) {
    uint32_t count = (uint32_t)(size / LINE), steps = 1 << 20;
    uint32_t *cycle = random_cycle(count);
    double least = -1.0;
    for (uint32_t i = 0; i < count; i++) memcpy(memory + (size_t)i * LINE, &cycle[i], sizeof *cycle);
    free(cycle);
    for (int repeat = 0; repeat < 3; repeat++) {
        uint32_t at = 0;
        double since = timer_now_ms(), ms = 0.0;
        for (uint32_t i = 0; i < steps; i++) memcpy(&at, memory + (size_t)at * LINE, sizeof at);
        timer_lap(&since, &ms);
        seen = at;
        least = lesser_time(least, ms);
    }
    memset(memory, 0, size);
    return least * 1e6 / steps;
}

static void print_random(char *memory, int set_count) {
    printf("\nrandom reads\n  %-8s %16s %16s %16s\n", "set", "24 bytes, ns", "of these, GB/s",
           "dependent, ns");
    for (int i = 0; i < set_count; i++) {
        double ns = random_point_ns((const double *)(const void *)memory, sets[i]);
        printf("  %-8s %16.2f %16.2f", set_names[i], ns, 24.0 / ns);
        printf(" %16.1f\n", latency_ns(memory, sets[i]));
        fflush(stdout);
    }
}

/* ---- arithmetic -------------------------------------------------------------------------------------- */

/* Returns Gop/s; a multiplication and an addition are two operations. */
static double arithmetic_rate(double (*function)(uint32_t), uint32_t lanes) {
    double least = -1.0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double since = timer_now_ms(), ms = 0.0;
        seen = (uint64_t)function(STEPS);
        timer_lap(&since, &ms);
        least = lesser_time(least, ms);
    }
    return 2.0 * MACHINE_CHAINS * lanes * STEPS / least * 1e-6;
}

/* Returns pairs of boxes per ns; a step tests 64 pairs. */
static double box_rate(const machine_kernels *k) {
    double least = -1.0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double since = timer_now_ms(), ms = 0.0;
        seen = k->boxes(STEPS / 8);
        timer_lap(&since, &ms);
        least = lesser_time(least, ms);
    }
    return 64.0 * (STEPS / 8) / least * 1e-6;
}

static void print_rates(const machine_kernels *const *levels, int level_count) {
    printf(
        "\nGop/s, multiplications and additions in turn; box pairs per ns\n  %-8s %10s %10s %12s %12s %10s\n",
        "level", "float", "double", "float vector", "double vec.", "box pairs");
    for (int l = 0; l < level_count; l++) {
        const machine_kernels *k = levels[l];
        printf("  %-8s %10.1f %10.1f %12.1f %12.1f %10.2f\n", k->name, arithmetic_rate(k->f32_one, 1),
               arithmetic_rate(k->f64_one, 1), arithmetic_rate(k->f32_vector, k->f32_lanes),
               arithmetic_rate(k->f64_vector, k->f64_lanes), box_rate(k));
        fflush(stdout);
    }
}

/* ---- the program ------------------------------------------------------------------------------------- */

/* Finds the instruction sets of this build that the processor has; returns their number. */
static int find_levels(const machine_kernels *levels[3]) {
    int count = 1;
    levels[0] = &machine_scalar;
#ifdef CSCD_WITH_AVX
    if (processor_has_simd(CSCD_SIMD_AVX2)) levels[count++] = &machine_avx2;
    if (processor_has_simd(CSCD_SIMD_AVX512)) levels[count++] = &machine_avx512;
#endif
#ifdef CSCD_WITH_NEON
    levels[count++] = &machine_neon;
#endif
    return count;
}

int main(int argument_count, char **arguments) {
    const machine_kernels *levels[3];
    int level_count = find_levels(levels), set_count = SET_COUNT;
    if (argument_count == 2 && strcmp(arguments[1], "--quick") == 0) {
        set_count--;
    } else if (argument_count > 1) {
        bool asked = strcmp(arguments[1], "--help") == 0;
        fputs(help, asked ? stdout : stderr);
        return asked ? 0 : 2;
    }
    char *memory = aligned_alloc(1 << 12, sets[set_count - 1]);
    if (memory == NULL) {
        fprintf(stderr, "machine: no memory for a working set of %s\n", set_names[set_count - 1]);
        return 1;
    }
    memset(memory, 0, sets[set_count - 1]);
    print_bandwidth(levels, level_count, memory, set_count);
    print_random(memory, set_count);
    print_rates(levels, level_count);
    free(memory);
    return 0;
}
