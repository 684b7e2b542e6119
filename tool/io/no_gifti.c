/* GIFTI in a build without expat: the files are known, and not read. */
#include "tool/io/format_reader.h"

#include "tool/io/io.h"

static bool recognise_gifti(const file_reader *reader) {
    return path_has_extension(reader->path, ".gii");
}

static bool read_gifti(file_reader *reader, mesh_file *out) {
    (void)out;
    return file_reader_fail(
        reader, "is a GIFTI surface, and this build of the program has no expat to read it; build it with "
                "expat (Debian: libexpat1-dev)");
}

const format_reader gifti_reader = {MESH_FORMAT_GIFTI, .recognise = recognise_gifti, .read = read_gifti};
