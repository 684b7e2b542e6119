/* What the thesis measured: figures 5.2 to 5.4 and 6.4. */
#ifndef CSCD_BENCHMARK_THESIS_NUMBERS_H
#define CSCD_BENCHMARK_THESIS_NUMBERS_H

/* Prints the thesis's rows for its experiment that this scene stands for; nothing for other scenes. */
void thesis_numbers_print(const char *scene);

#endif
