/* GIFTI in a build without expat: the files are known, and not read. */
#include "tool/io/gifti.h"

#include "tool/io/path_name.h"

bool gifti_recognise(const file_reader *reader) {
    return path_has_extension(reader->path, ".gii");
}

bool gifti_read(file_reader *reader, mesh_file *out) {
    (void)out;
    return file_reader_fail(
        reader, "is a GIFTI surface, and this build of the program has no expat to read it; build it with "
                "expat (Debian: libexpat1-dev)");
}
