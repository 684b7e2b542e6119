/* What the thesis measured: figures 5.2 to 5.4 and 6.4. */
#pragma once

/* Prints the thesis's rows for its experiment that this scene stands for; nothing for other scenes. */
void thesis_numbers_print(const char *scene);
