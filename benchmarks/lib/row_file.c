/* The JSON file of a benchmark: an object with its rows and where they come from. */
#include "benchmarks/lib/row_file.h"
#include "tool/common/provenance.h"

#include <errno.h>
#include <string.h>

bool row_file_open(const char *path, json *out, io_error *error) {
    *out = (json){.file = NULL};
    if (path == NULL) return true;
    out->file = fopen(path, "w");
    if (out->file == NULL) return io_fail(error, "%s: %s", path, strerror(errno));
    json_begin_object(out, NULL);
    return true;
}

void row_file_begin(json *out) {
    if (out->file != NULL) json_begin_array(out, "rows");
}

bool row_file_close(const char *path, int argument_count, char **arguments, uint32_t thread_count, json *out,
                    io_error *error) {
    if (out->file == NULL) return true;
    json_end_array(out);
    json_begin_object(out, "provenance");
    provenance_write(out, argument_count, arguments, thread_count);
    json_end_object(out);
    json_end_object(out);
    fputc('\n', out->file);
    const bool written = !ferror(out->file);
    return (fclose(out->file) == 0 && written) || io_fail(error, "%s could not be written", path);
}
