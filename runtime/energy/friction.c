/* Friction of near pairs, whose normal forces and tangents are frozen (Li et al. 2020, section 5). */
#include "runtime/energy/energy.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* The smooth |y|: f0, f0' / y and f0'' (Li et al. 2020, eqs. 13 to 17). */
static energy_curve smooth_length(double y, double slip) {
    if (y >= slip) return (energy_curve){y, 1.0 / y, 0.0};
    double share = y / slip;
    return (energy_curve){slip * (1.0 / 3.0 + share * share * (1.0 - share / 3.0)), (2.0 - share) / slip,
                          2.0 * (1.0 - share) / slip};
}

/* The displacement of a's point relative to b's, along both tangents. */
static void sliding_of(const friction_motion *m, const friction_term *f, double out[2]) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        size_t v = (size_t)f->vertices[i] * 3;
        for (int k = 0; k < 3; k++) sum[k] += f->weights[i] * (m->x1[v + (size_t)k] - m->x0[v + (size_t)k]);
    }
    for (int j = 0; j < 2; j++) out[j] = vec3_dot(sum, f->tangents[j]);
}

/* The Hessian by the sliding s: (f0'/y) 1 + (f0'' - f0'/y) s s^T / y^2, in the plane of the tangents. */
static void set_hessian(const friction_term *f, const energy_curve *c, const double s[2], double length,
                        double (*hessian)[12]) {
    double turn = length > 0.0 ? (c->curvature - c->slope) / (length * length) : 0.0, of_sliding[2][2],
           block[3][3];
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) of_sliding[i][j] = f->force * ((i == j) * c->slope + turn * s[i] * s[j]);
    }
    for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) {
            block[k][l] = 0.0;
            for (int i = 0; i < 2; i++) {
                for (int j = 0; j < 2; j++)
                    block[k][l] += of_sliding[i][j] * f->tangents[i][k] * f->tangents[j][l];
            }
        }
    }
    for (int i = 0; i < 12; i++) {
        for (int j = 0; j < 12; j++)
            hessian[i][j] = f->weights[i / 3] * f->weights[j / 3] * block[i % 3][j % 3];
    }
}

void friction_term_evaluate(const void *motion, size_t i, energy_term *term) {
    const friction_motion *m = motion;
    const friction_term *f = &m->terms[i];
    double s[2];
    sliding_of(m, f, s);
    double length = sqrt(s[0] * s[0] + s[1] * s[1]);
    energy_curve c = smooth_length(length, m->slip);
    term->value = f->force * c.value;
    term->gap = length;
    for (int v = 0; term->gradient != NULL && v < 4; v++) {
        for (int k = 0; k < 3; k++)
            term->gradient[v][k] =
                f->force * c.slope * f->weights[v] * (s[0] * f->tangents[0][k] + s[1] * f->tangents[1][k]);
    }
    if (term->hessian != NULL) set_hessian(f, &c, s, length, term->hessian);
}
