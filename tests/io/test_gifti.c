/* GIFTI surfaces: all encodings, and each error with its line. */
#include "src/io/animation.h"
#include "src/io/growable.h"
#include "tests/support/io/gifti_fixture.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST(reads_all_styles) {
    uint32_t count = 0;
    for (int i = 0; i < 48; i++) {
        const gifti_style style = {.encoding = i % 3,
                                   .big_endian = i / 3 % 2 != 0,
                                   .column_major = i / 6 % 2 != 0,
                                   .doubles = i / 12 % 2 != 0,
                                   .gzip_header = i / 24 != 0};
        if (style.gzip_header && style.encoding != 2) continue;
        gifti_text file;
        gifti_fixture_square(&file, style);
        mesh_check_square(gifti_fixture_file(&file));
        count++;
    }
    assert_int_equal(count, 32);
}

/* Numbers of a file are its floats; as text they are rounded to the type that the file names. */
TEST(rounds_text_to_its_type) {
    static const uint32_t triangle[] = {0, 1, 2};
    for (int doubles = 0; doubles < 2; doubles++) {
        char text[1200];
        snprintf(
            text, sizeof text,
            "<GIFTI><DataArray Intent='NIFTI_INTENT_TRIANGLE' DataType='NIFTI_TYPE_INT32' ArrayIndexingOrder="
            "'RowMajorOrder' Dimensionality='2' Dim0='1' Dim1='3' Encoding='ASCII'><Data>0 1 2</Data></DataArray>"
            "<DataArray Intent='NIFTI_INTENT_POINTSET' DataType='NIFTI_TYPE_FLOAT%d' ArrayIndexingOrder="
            "'RowMajorOrder' Dimensionality='2' Dim0='3' Dim1='3' Encoding='ASCII'><Data>0.1 -2.5e3 1e-3\n"
            "0 0 0\t1 1 1</Data></DataArray></GIFTI>",
            doubles ? 64 : 32);
        const double expected[] = {doubles ? 0.1 : 0.1f, -2500, doubles ? 1e-3 : 1e-3f, 0, 0, 0, 1, 1, 1};
        mesh_check_equal((file_bytes){"brain.xml", text, strlen(text)}, 3, expected, 1, triangle);
    }
}

/* The parser takes a megabyte at a time: no byte is lost or read twice between two. */
TEST(reads_files_of_several_megabytes) {
    enum { POINTS = 100000, ROOM = 32 * POINTS };
    static const char array[] =
        "<DataArray Intent='NIFTI_INTENT_%s' DataType='NIFTI_TYPE_%s' Dim0='%d' Dim1='3' "
        "Dimensionality='2' ArrayIndexingOrder='RowMajorOrder' Encoding='ASCII'><Data>";
    char *text = malloc(ROOM);
    assert_non_null(text);
    int length = snprintf(text, ROOM, "<GIFTI>");
    length += snprintf(text + length, (size_t)(ROOM - length), array, "POINTSET", "FLOAT64", POINTS);
    for (int i = 0; i < POINTS; i++)
        length += snprintf(text + length, (size_t)(ROOM - length), "%d.125 0.5 %d.75\n", 1000000 + i, i);
    length += snprintf(text + length, (size_t)(ROOM - length), "</Data></DataArray>");
    length += snprintf(text + length, (size_t)(ROOM - length), array, "TRIANGLE", "INT32", 1);
    length += snprintf(text + length, (size_t)(ROOM - length), "0 1 99999</Data></DataArray></GIFTI>");
    assert_true(length > 2 << 20);
    mesh_file mesh;
    io_error error;
    if (!mesh_check_read((file_bytes){"lh.gii", text, (size_t)length}, &mesh, &error))
        fail_msg("%s", error.text);
    assert_int_equal(mesh.vertex_count, POINTS);
    for (int i = 0; i < POINTS; i++) {
        const double *p = mesh.positions + 3 * (size_t)i;
        assert_true(p[0] == 1000000.125 + i && p[1] == 0.5 && p[2] == i + 0.75);
    }
    assert_int_equal(mesh.triangles[2], POINTS - 1);
    mesh_file_free(&mesh);
    free(text);
}

/* The file in ASCII with one text replaced. */
static void check_replaced(gifti_style style, const char *text, const char *by, const char *place,
                           const char *found, const char *expected) {
    gifti_text file, other;
    gifti_fixture_square(&file, style);
    const char *at = strstr(file.text, text);
    assert_non_null(at);
    snprintf(other.text, sizeof other.text, "%.*s%s%s", (int)(at - file.text), file.text, by,
             at + strlen(text));
    mesh_check_error(gifti_fixture_file(&other), place, found, expected);
}

TEST(refuses_what_is_no_surface) {
    const gifti_style ascii = {0};
    check_replaced(ascii, "NIFTI_INTENT_TRIANGLE", "NIFTI_INTENT_SHAPE", ": ",
                   "no data array of NIFTI_INTENT_TRIANGLE", "points and triangles");
    check_replaced(ascii, "ASCII\" Endian=\"LittleEndian\" ExternalFileName=\"\"",
                   "ExternalFileBinary\" Endian=\"LittleEndian\" ExternalFileName=\"lh.dat\"",
                   ":7: ", "another file, 'lh.dat'", "save the surface with its data inside");
    check_replaced(ascii, "NIFTI_TYPE_FLOAT32", "NIFTI_TYPE_UINT8", ":7: ", "DataType is 'NIFTI_TYPE_UINT8'",
                   "NIFTI_TYPE_FLOAT32 or NIFTI_TYPE_FLOAT64");
    check_replaced(ascii, "Dim1=\"3\"", "Dim1=\"2\"", ":7: ", "Dim1 is '2'", "of 3");
    check_replaced(ascii, "Dimensionality=\"2\"", "Dimensionality=\"3\"", ":7: ", "expected two dimensions",
                   "");
    check_replaced(ascii, "Dim0=\"4\" Dim1", "Dim0=\"-4\" Dim1", ":7: ", "Dim0 is '-4'", "1 to 2147483647");
    check_replaced(ascii, "Dim0=\"4\" Dim1", "Dim0=\"4e9\" Dim1", ":7: ", "Dim0 is '4e9'", "1 to 2147483647");
    check_replaced(ascii, "Dim0=\"4\" Dim1", "Dim0=\"2147483647\" Dim1", ":10: ", "characters",
                   "6442450941 numbers");
    check_replaced(ascii, "\"RowMajorOrder\" Dimensionality=\"2\"", "\"Diagonal\" Dimensionality=\"2\"",
                   ":7: ", "ArrayIndexingOrder is 'Diagonal'", "RowMajorOrder or ColumnMajorOrder");
    check_replaced((gifti_style){.encoding = 1}, "LittleEndian\" Ex", "MiddleEndian\" Ex",
                   ":7: ", "Endian is 'MiddleEndian'", "LittleEndian or BigEndian");
    check_replaced(ascii, "</GIFTI>", "</GIFTY>", ":", "no valid XML: mismatched tag", "");
    mesh_check_error(FILE_OF("lh.gii", "<surface/>"), ": ", "no element GIFTI", "");
    mesh_check_error(FILE_OF("lh.gii", "\n<GIFTI>"), ":2: ", "no valid XML", "");
}

TEST(refuses_wrong_data) {
    const gifti_style ascii = {0}, base64 = {.encoding = 1}, zipped = {.encoding = 2};
    check_replaced(ascii, "<Data>0 0 0", "<Data>0 0 x", ":10: ", "found 'x'", "a number");
    check_replaced(ascii, "<Data>0 1 2", "<Data>0 1 2.5", ":", "found '2.5'", "a whole number");
    check_replaced(ascii, "<Data>0 1 2", "<Data>0 1 4294967298", ":", "found '4294967298'", "a whole number");
    check_replaced(ascii, "<Data>0 1 2", "<Data>0 1 4", ":", "triangle 0 names vertex 4", "there are 4");
    check_replaced(ascii, "<Data>0 1 2", "<Data>0 1 -1", ":", "triangle 0 names vertex -1", "there are 4");
    check_replaced(ascii, "<Data>0 0 0", "<Data>0 0", ":10: ", "have 11 numbers", "expected 12");
    check_replaced(ascii, "<Data>0 0 0", "<Data>0 0 0 7", ":10: ", "after the last of 12", "");
    check_replaced(ascii, "<Data>0 0 0", "<Data>0 0 1e39", ":", "coordinate z of vertex 0 is inf", "finite");
    check_replaced(base64, "<Data>AAAA", "<Data>AA*A", ":10: ", "no base64 at character 2", "");
    check_replaced(base64, "<Data>AAAA", "<Data>AAAAA", ":10: ", "no base64 at character 65", "");
    check_replaced(base64, "<Data>AAAA", "<Data>", ":10: ", "the data have 45 bytes",
                   "expected 48 for 4 rows");
    check_replaced(base64, "<Data>AAAA", "<Data>AAAAAAAA", ":10: ", "the data have 51 bytes",
                   "expected 48 for 4 rows");
    check_replaced(zipped, "Dim0=\"4\" Dim1", "Dim0=\"3\" Dim1", ":10: ", "the data have 37 bytes",
                   "expected 36");
    check_replaced(zipped, "Dim0=\"4\" Dim1", "Dim0=\"5\" Dim1", ":10: ", "the data have 48 bytes",
                   "expected 60");
    check_replaced(zipped, "Dim0=\"4\" Dim1", "Dim0=\"2147483647\" Dim1", ":10: ", "bytes", "25769803764");
    check_replaced(zipped, "<Data>e", "<Data>f", ":10: ", "cannot be unzipped", "damaged");
}

/* All numbers are there, but not the sum that is to prove them. */
TEST(refuses_zipped_data_without_their_end) {
    gifti_text file, other;
    gifti_fixture_square(&file, (gifti_style){.encoding = 2});
    const char *end = strstr(strstr(file.text, "<Data>e"), "</Data>");
    snprintf(other.text, sizeof other.text, "%.*s%s", (int)(end - 4 - file.text), file.text, end);
    mesh_check_error(gifti_fixture_file(&other), ":10: ", "cannot be unzipped", "damaged or cut off");
}

/* Elements where the format has none, in the data of each encoding, of every name that is known and of none. */
TEST(refuses_elements_out_of_place) {
    static const char *const names[] = {"DataArray", "Data", "GIFTI", "MetaData", "b"};
    static const char *const starts[] = {"<Data>0 0 0", "<Data>AAAA", "<Data>e"};
    for (int i = 0; i < 15; i++) {
        const gifti_style style = {.encoding = i / 5};
        const char *name = names[i % 5];
        char element[100], found[80];
        snprintf(found, sizeof found, "an element '%s' inside Data", name);
        snprintf(element, sizeof element, "<Data><%s/>0", name);
        check_replaced(style, starts[i / 5], element, ":10: ", found, "numbers alone");
        snprintf(element, sizeof element, "<Data>0\n<%s Intent='NIFTI_INTENT_TRIANGLE'>0</%s>0", name, name);
        check_replaced(style, starts[i / 5], element, ":11: ", found, "numbers alone");
    }
    const gifti_style ascii = {0};
    check_replaced(ascii, starts[0], "<DataArray/><Data>", ":10: ", "'DataArray' inside a DataArray",
                   "its data");
    check_replaced(ascii, starts[0], "<MetaData><DataArray/></MetaData><Data>",
                   ":10: ", "an element 'DataArray' inside a DataArray", "its data");
    check_replaced(ascii, starts[0], "<Data/><Data>", ":10: ", "a second element Data", "expected one");
    check_replaced(ascii, starts[0], "<Data>0</Data><Data>", ":10: ", "a second element Data",
                   "expected one");
    check_replaced(ascii, "<Data>1 2", "<Data><DataArray/>1 2", ":6: ", "'DataArray' inside a DataArray", "");
}

/* Text that grows a hundredfold, from the file or from another one, whether it is used or not. */
TEST(refuses_entities) {
    const gifti_style ascii = {0};
    check_replaced(ascii, ".dtd\">", ".dtd\" [<!ENTITY a '0 0 0 0 0 0 0 0'>\n<!ENTITY b '&a;&a;&a;&a;'>]>",
                   ":2: ", "the entity 'a'", "without any");
    check_replaced(ascii, ".dtd\">", ".dtd\" [\n<!ENTITY a SYSTEM 'file:///etc/passwd'>]>",
                   ":3: ", "the entity 'a'", "without any");
    check_replaced(ascii, ".dtd\">", ".dtd\" [\n<!ENTITY % a '0'>]>", ":3: ", "the entity 'a'",
                   "without any");
    check_replaced(ascii, "<Data>0 0 0", "<Data>&a;0 0 0", ":10: ", "the entity 'a'", "without any");
}

TEST(plays_files_as_frames) {
    const temp_folder folder = temp_folder_make();
    char pattern[300];
    for (int frame = 0; frame < 3; frame++) {
        gifti_text file;
        char name[32];
        gifti_fixture_square(&file, (gifti_style){.encoding = frame});
        snprintf(name, sizeof name, "f%d.surf.gii", frame);
        temp_file_write(&folder, name, file.text, strlen(file.text));
    }
    snprintf(pattern, sizeof pattern, "%s/f%%d.surf.gii", folder.path);
    const char *path = pattern;
    animation *frames;
    io_error error;
    double positions[12];
    if (!animation_open(&path, 1, 4, NULL, &frames, &error)) fail_msg("%s", error.text);
    assert_int_equal(animation_frame_count(frames), 3);
    for (uint32_t frame = 0; frame < 3; frame++) {
        assert_true(animation_read(frames, frame, positions, &error));
        assert_true(positions[3] == 1 && positions[10] == 1);
    }
    animation_close(frames);
    temp_folder_remove(&folder);
}

TEST(survives_failed_allocations) {
    for (int encoding = 0; encoding < 3; encoding++) {
        gifti_text file;
        gifti_fixture_square(&file, (gifti_style){.encoding = encoding});
        mesh_check_memory(gifti_fixture_file(&file), MESH_PARTS_BY_FILE);
    }
}

/* Every byte of the file would be thousands of readings: a fault in each third one, a different one each time. */
TEST(survives_damage) {
    for (int encoding = 0; encoding < 3; encoding++) {
        gifti_text file;
        gifti_fixture_square(&file, (gifti_style){.encoding = encoding});
        const size_t size = strlen(file.text);
        for (size_t i = 0; i < size; i += 3) {
            gifti_text damaged = file;
            mesh_check_survives((file_bytes){"lh.surf.gii", file.text, i});
            damaged.text[i] = (char)(damaged.text[i] ^ 1 << i / 3 % 7);
            mesh_check_survives((file_bytes){"lh.surf.gii", damaged.text, size});
            memmove(damaged.text + i, damaged.text + i + 1, size - i);
            mesh_check_survives((file_bytes){"lh.surf.gii", damaged.text, size - 1});
        }
    }
}
