/* Writes a bar that is soft at one place. */
#include "tests/support/tool/soft_bar.h"

#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

enum {
    RINGS = 40,
    AROUND = 12,
    SIDES = (RINGS - 1) * AROUND,
    FACES = SIDES + 2,
    CORNERS = SIDES * 4 + 2 * AROUND
};

typedef struct bar_face {
    int count, corners[AROUND]; /* ring times AROUND, and the place on it */
    double stiffness;
} bar_face;

static void make_faces(bar_face *faces, double soft) {
    for (int face = 0; face < SIDES; face++) {
        const int ring = face / AROUND, a = ring * AROUND + face % AROUND,
                  b = ring * AROUND + (face + 1) % AROUND;
        faces[face] = (bar_face){4, {a, b, b + AROUND, a + AROUND}, ring >= 26 && ring < 28 ? soft : 3.0};
    }
    faces[SIDES] = faces[SIDES + 1] = (bar_face){.count = AROUND, .stiffness = 3.0};
    for (int i = 0; i < AROUND; i++) {
        faces[SIDES].corners[i] = AROUND - 1 - i;
        faces[SIDES + 1].corners[i] = (RINGS - 1) * AROUND + i;
    }
}

static void print_vertex(FILE *file, int corner) {
    const double angle = 0.5235987755982988 * (corner % AROUND);
    fprintf(file, "%.9g %.9g %.9g\n", cos(angle), sin(angle), 0.25 * (corner / AROUND));
}

static temp_path write_faces(const temp_folder *folder, const char *name, const bar_face *faces, bool split) {
    temp_path path = temp_file_path(folder, name);
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
            "element face %d\nproperty list uchar int vertex_indices\nproperty float stiffness\nend_header\n",
            split ? CORNERS : RINGS * AROUND, FACES);
    for (int i = 0; i < RINGS * AROUND && !split; i++) print_vertex(file, i);
    for (int face = 0; face < FACES && split; face++)
        for (int i = 0; i < faces[face].count; i++) print_vertex(file, faces[face].corners[i]);
    for (int face = 0, corner = 0; face < FACES; face++) {
        fprintf(file, "%d", faces[face].count);
        for (int i = 0; i < faces[face].count; i++, corner++)
            fprintf(file, " %d", split ? corner : faces[face].corners[i]);
        fprintf(file, " %g\n", faces[face].stiffness);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

temp_path soft_bar_write(const temp_folder *folder, const char *name, double soft, bool split) {
    bar_face faces[FACES];
    make_faces(faces, soft);
    return write_faces(folder, name, faces, split);
}

temp_path soft_bar_write_bad(const temp_folder *folder, const char *name, int bad_face, double bad) {
    bar_face faces[FACES];
    make_faces(faces, 3.0);
    faces[bad_face].stiffness = bad;
    return write_faces(folder, name, faces, false);
}
