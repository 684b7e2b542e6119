/* The files of a room of tests are one program. Each registers what was its main, and runs in a process of its own: as the program that
 * has its name (a link), or by its name as the first argument. A name of cases may follow, with * and ?. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif
void room_add(const char *name, int (*run)(void));

/* What stands behind the name of the file; argv[0] of the program is first, as in main. */
int room_argument_count(void);
const char *room_argument(int index);
#ifdef __cplusplus
}
#endif
