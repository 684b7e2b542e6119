/* Writes a bar that is soft at one place. */
#include "tests/support/tool/soft_bar.h"

#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

enum { RINGS = 40, AROUND = 12, SIDES = (RINGS - 1) * AROUND };

static void print_face(FILE *file, const int *corners, int count, double stiffness) {
    fprintf(file, "%d", count);
    for (int i = 0; i < count; i++) fprintf(file, " %d", corners[i]);
    fprintf(file, " %g\n", stiffness);
}

temp_path soft_bar_write(const temp_folder *folder, const char *name, double soft, int bad_face, double bad) {
    temp_path path = temp_file_path(folder, name);
    FILE *file = fopen(path.text, "w");
    int ends[2][AROUND];
    assert_non_null(file);
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
            "element face %d\nproperty list uchar int vertex_indices\nproperty float stiffness\nend_header\n",
            RINGS * AROUND, SIDES + 2);
    for (int i = 0; i < RINGS * AROUND; i++) {
        const double angle = 0.5235987755982988 * (i % AROUND);
        fprintf(file, "%.9g %.9g %.9g\n", cos(angle), sin(angle), 0.25 * (i / AROUND));
    }
    for (int face = 0; face < SIDES; face++) {
        const int ring = face / AROUND, a = face % AROUND, b = (a + 1) % AROUND;
        const int corners[4] = {ring * AROUND + a, ring * AROUND + b, (ring + 1) * AROUND + b,
                                (ring + 1) * AROUND + a};
        const double stiffness = ring >= 26 && ring < 28 ? soft : 3.0;
        print_face(file, corners, 4, face == bad_face ? bad : stiffness);
    }
    for (int i = 0; i < AROUND; i++) {
        ends[0][i] = AROUND - 1 - i;
        ends[1][i] = (RINGS - 1) * AROUND + i;
    }
    for (int end = 0; end < 2; end++) print_face(file, ends[end], AROUND, 3.0);
    assert_int_equal(fclose(file), 0);
    return path;
}
