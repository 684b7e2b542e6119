/* Measurements of the thesis: figures 5.2 to 5.4 and 6.4. */
#pragma once

/* Prints the rows of the thesis for the experiment that this scene represents; nothing for other scenes. */
void thesis_numbers_print(const char *scene);
