/* GIFTI files, in each encoding, when memory fails and when they are damaged. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"
#include "tool/io/io.h"

#include <stdlib.h>
#include <string.h>

#define ARRAY(intent, type, rows, encoding, data)                                                            \
    " <DataArray Intent=\"NIFTI_INTENT_" intent "\" DataType=\"NIFTI_TYPE_" type                             \
    "\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"2\" Dim0=\"" rows                              \
    "\" Dim1=\"3\" Encoding=\"" encoding "\" Endian=\"LittleEndian\">\n  <MetaData/>\n  <Data>" data         \
    "</Data>\n </DataArray>\n"
/* A square, whose points and triangles are written like this. */
#define SQUARE(encoding, points, triangles)                                                                  \
    FILE_OF("lh.surf.gii",                                                                                   \
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE GIFTI SYSTEM \"gifti.dtd\">\n<GIFTI>\n"   \
            "<MetaData><MD><Name><![CDATA[Who]]></Name><Value>a</Value></MD></MetaData>\n" ARRAY(            \
                "POINTSET", "FLOAT32", "4", encoding, points)                                                \
                ARRAY("TRIANGLE", "INT32", "2", encoding, triangles) "</GIFTI>\n")

static const file_bytes squares[] = {
    SQUARE("ASCII", "0 0 0 1 0 0\n1 1 0 0 1 0", "0 1 2 0 2 3"),
    SQUARE("Base64Binary", "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAA",
           "AAAAAAEAAAACAAAAAAAAAAIAAAADAAAA"),
    SQUARE("GZipBase64Binary", "eJxjYEAGDfaobHQ+AwMAOuQC/Q==", "eJxjYGBgYARiJgYIANHMQAwAAGgACQ=="),
};

TEST(survives_failed_allocations) {
    for (int encoding = 0; encoding < 3; encoding++) {
        mesh_check_square(squares[encoding]);
        mesh_check_memory(squares[encoding], MESH_PARTS_BY_FILE);
    }
}

/* Every byte of the file would be thousands of readings: a fault in each third one, a different one each time. */
TEST(survives_damage) {
    for (int encoding = 0; encoding < 3; encoding++) {
        const size_t size = squares[encoding].size;
        char *damaged = malloc(size);
        assert_non_null(damaged);
        for (size_t i = 0; i < size; i += 3) {
            memcpy(damaged, squares[encoding].bytes, size);
            mesh_check_survives((file_bytes){"lh.surf.gii", damaged, i});
            damaged[i] = (char)(damaged[i] ^ 1 << i / 3 % 7);
            mesh_check_survives((file_bytes){"lh.surf.gii", damaged, size});
            memmove(damaged + i, damaged + i + 1, size - i - 1);
            mesh_check_survives((file_bytes){"lh.surf.gii", damaged, size - 1});
        }
        free(damaged);
    }
}
