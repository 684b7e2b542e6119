/* OFF (Object File Format) in text, with normals, colours or texture coordinates ignored. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>

/* The first word of the file is one of OFF's keywords. */
bool off_recognise(const file_reader *reader);

/* The keyword may be missing. On false *out is untouched and the reader's error set. */
bool off_read(file_reader *reader, mesh_file *out);
