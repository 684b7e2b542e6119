/* Plugin of qemu-user that counts instructions by place in the program: qemu-ARCH -plugin count_instructions.so,out=FILE PROGRAM...
 *
 * FILE has one line for each piece of code that ran: its address from the start of the program's code on, and how many instructions
 * were executed there. count_table.py adds them up by source file. One thread only: the counters are not atomic. Debian ships no
 * header for plugins, so the few functions are declared here, as in qemu's documentation of TCG plugins. */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
enum { QEMU_PLUGIN_INLINE_ADD_U64, PLUGIN_VERSION_OF_QEMU_7 = 1 };

size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *block);
uint64_t qemu_plugin_start_code(void);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*call)(qemu_plugin_id_t, struct qemu_plugin_tb *));
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb *block, int operation, void *counter,
                                              uint64_t by);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*call)(qemu_plugin_id_t, void *), void *data);
int qemu_plugin_install(qemu_plugin_id_t id, const void *info, int count, char **arguments);

int qemu_plugin_version = PLUGIN_VERSION_OF_QEMU_7;

typedef struct piece_of_code {
    struct piece_of_code *next;
    uint64_t address, executed;
} piece_of_code;

static piece_of_code *pieces;
static FILE *counts;

/* Code that is translated more than once, as after a jump into its middle, has a counter for each time. */
static void count_piece(qemu_plugin_id_t id, struct qemu_plugin_tb *block) {
    (void)id;
    piece_of_code *piece = calloc(1, sizeof *piece);
    if (piece == NULL) abort();
    *piece = (piece_of_code){pieces, qemu_plugin_tb_vaddr(block), 0};
    pieces = piece;
    qemu_plugin_register_vcpu_tb_exec_inline(block, QEMU_PLUGIN_INLINE_ADD_U64, &piece->executed,
                                             qemu_plugin_tb_n_insns(block));
}

static void write_counts(qemu_plugin_id_t id, void *data) {
    (void)id;
    (void)data;
    uint64_t start = qemu_plugin_start_code();
    for (const piece_of_code *piece = pieces; piece != NULL; piece = piece->next)
        if (piece->executed > 0)
            fprintf(counts, "%" PRId64 " %" PRIu64 "\n", (int64_t)(piece->address - start), piece->executed);
    fclose(counts);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void *info,
                                                               int count, char **arguments) {
    (void)info;
    if (count != 1 || strncmp(arguments[0], "out=", 4) != 0 ||
        (counts = fopen(arguments[0] + 4, "w")) == NULL) {
        fprintf(stderr, "count_instructions: wants out=FILE, a file that can be written\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, count_piece);
    qemu_plugin_register_atexit_cb(id, write_counts, NULL);
    return 0;
}
