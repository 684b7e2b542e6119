/* Affine maps of glTF nodes. */
#include "tool/io/gltf/gltf_transform.h"

gltf_transform gltf_transform_identity(void) {
    return (gltf_transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

gltf_transform gltf_transform_of_placement(const gltf_placement *placement) {
    const double *q = placement->rotation, *s = placement->scale, *t = placement->translation;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double length =
        x * x + y * y + z * z + w * w; /* squared: so it needs no root, and right angles are exact */
    const double d = length > 0 ? 2 / length : 0;
    return (gltf_transform){{
        {(1 - d * (y * y + z * z)) * s[0], d * (x * y - z * w) * s[1], d * (x * z + y * w) * s[2], t[0]},
        {d * (x * y + z * w) * s[0], (1 - d * (x * x + z * z)) * s[1], d * (y * z - x * w) * s[2], t[1]},
        {d * (x * z - y * w) * s[0], d * (y * z + x * w) * s[1], (1 - d * (x * x + y * y)) * s[2], t[2]},
    }};
}

gltf_transform gltf_transform_of_columns(const double columns[16]) {
    gltf_transform out;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) out.rows[row][column] = columns[4 * column + row];
    return out;
}

gltf_transform gltf_transform_multiply(const gltf_transform *a, const gltf_transform *b) {
    gltf_transform out;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a->rows[row][3] : 0;
            for (int k = 0; k < 3; k++) sum += a->rows[row][k] * b->rows[k][column];
            out.rows[row][column] = sum;
        }
    return out;
}

void gltf_transform_apply(const gltf_transform *a, const double x[3], double out[3]) {
    double moved[3];
    for (int row = 0; row < 3; row++) {
        const double *r = a->rows[row];
        moved[row] = r[0] * x[0] + r[1] * x[1] + r[2] * x[2] + r[3];
    }
    for (int axis = 0; axis < 3; axis++) out[axis] = moved[axis];
}

int gltf_transform_mirrors(const gltf_transform *a) {
    const double(*m)[4] = a->rows;
    const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return determinant < 0;
}
