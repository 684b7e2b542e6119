/* Curves, patches and winding numbers of so many random small scenes against the oracle; prints the scenes on which they
 * differ. Usage: fuzz_surfaces SCENES SEED. */
#include "tests/support/intersections/surface_oracle.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { DIFFERENCES_SHOWN = 5, PROGRESS_STEP = 1024 };

static surface_trial trial; /* large */

/* Half of all scenes are of the smallest family, in which most cases are. */
static grid_family choose_family(random_stream *random) {
    return stream_below(random, 2) == 0 ? GRID_TWO_TETRAHEDRA
                                        : (grid_family)stream_below(random, GRID_FAMILIES);
}

static trial_spread choose_spread(random_stream *random) {
    return stream_below(random, 2) == 0 ? SPREAD_NONE : (trial_spread)stream_below(random, SPREAD_COUNT);
}

static void show_difference(const char *problem, grid_family family, trial_spread spread, uint64_t seed) {
    printf("%s: family %d, spread %d, seed %llu\n", problem, (int)family, (int)spread,
           (unsigned long long)seed);
    surface_trial_print(&trial);
    fflush(stdout);
}

static void print_totals(uint64_t differences, uint64_t seed) {
    const trial_totals *sum = &trial.totals;
    printf(
        "%llu scenes, seed %llu: %llu piercings (%llu at an end of their edge), %llu pieces, %llu curves (%llu open)\n",
        (unsigned long long)sum->scenes, (unsigned long long)seed, (unsigned long long)sum->piercings,
        (unsigned long long)sum->degenerate, (unsigned long long)sum->pieces, (unsigned long long)sum->curves,
        (unsigned long long)sum->open_curves);
    printf(
        "%llu corners of patches (%llu scenes are cut), wound around %llu times, more than once %llu times\n",
        (unsigned long long)sum->corners, (unsigned long long)sum->cut, (unsigned long long)sum->wound,
        (unsigned long long)sum->twice);
    printf("%llu differences\n", (unsigned long long)differences);
}

int main(int argument_count, char **arguments) {
    if (argument_count != 3) {
        fprintf(stderr, "usage: %s SCENES SEED\n", arguments[0]);
        return 2;
    }
    uint64_t scenes = strtoull(arguments[1], NULL, 0), seed = strtoull(arguments[2], NULL, 0);
    uint64_t differences = 0;
    random_stream random = stream_start(seed);
    for (uint64_t i = 0; i < scenes; i++) {
        grid_family family = choose_family(&random);
        trial_spread spread = choose_spread(&random);
        uint64_t its_seed = stream_bits(&random) >> 1;
        const char *problem = surface_trial_run(&trial, family, spread, its_seed);
        if (problem != NULL && differences++ < DIFFERENCES_SHOWN)
            show_difference(problem, family, spread, its_seed);
        if (i % PROGRESS_STEP == 0 && isatty(STDERR_FILENO))
            fprintf(stderr, "\r%llu scenes, %llu differences ", (unsigned long long)i,
                    (unsigned long long)differences);
    }
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\n");
    print_totals(differences, seed);
    return differences > 0 ? 1 : 0;
}
