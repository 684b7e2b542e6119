/* Mesh files with random damage: each is refused in one line or read, under sanitizers without a complaint. Usage: fuzz_files
 * ROUNDS SEED FILE...; a file must be whole in itself. */
#include "src/io/file_reader.h"
#include "src/io/path_name.h"
#include "tests/support/io/file_damage.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argument_count, char **arguments) {
    if (argument_count < 4) {
        fprintf(stderr, "usage: %s ROUNDS SEED FILE...\n", arguments[0]);
        return 2;
    }
    const uint32_t rounds = (uint32_t)strtoul(arguments[1], NULL, 0);
    const uint64_t seed = strtoull(arguments[2], NULL, 0);
    for (int i = 3; i < argument_count; i++) {
        file_reader reader;
        io_error error;
        if (!file_reader_open(&reader, arguments[i], &error)) {
            fprintf(stderr, "%s\n", error.text);
            return 2;
        }
        const char *name = path_file_name(arguments[i]);
        const file_damage_counts counts =
            file_damage_rounds((file_bytes){name, reader.bytes, reader.size}, rounds, seed);
        printf("%s: %u refused, %u read, %u of them with frames\n", name, counts.refused, counts.read,
               counts.animated);
        file_reader_close(&reader);
    }
    return 0;
}
