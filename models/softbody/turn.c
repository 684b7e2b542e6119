/* Rotations that are the same on every machine. */
#include "models/softbody/turn.h"
#include "models/common/vec3.h"

/* Rodrigues' formula. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]) {
    double unit[3] = {axis[0], axis[1], axis[2]}, angle = degrees * 3.14159265358979323846 / 180.0;
    if (!vec3_normalize(unit)) angle = 0.0;
    for (int i = 0; i < 3; i++) {
        double row[3] = {i == 0, i == 1, i == 2}, crossed[3];
        vec3_cross(row, unit, crossed);
        for (int j = 0; j < 3; j++)
            out[i][j] = (float)(cos(angle) * row[j] + sin(angle) * crossed[j] +
                                (1.0 - cos(angle)) * unit[i] * unit[j]);
    }
}
