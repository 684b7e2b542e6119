/* Elastic tetrahedra as constraints of XPBD: neo-Hookean, with separate constraints for volume and shape. */
#include "models/common/vec3.h"
#include "models/shapes/body.h"
#include "models/softbody/softbody.h"

#include <string.h>

/* The two ways to cut a cube into five tetrahedra; cells of different parity fit together. */
static const uint8_t cuts[2][5][4] = {
    {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}},
    {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 6, 0}, {7, 6, 5, 3}, {0, 3, 5, 6}},
};

static double determinant_of(double m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Computes the derivatives of the determinant. */
static void find_cofactors(double m[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++) {
        int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; j++) {
            int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            out[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
        }
    }
}

/* Fills the columns of `out` with the edges from the first node to the others. */
static void edges_of(const tetrahedron *t, const double *nodes, double out[3][3]) {
    const double *origin = nodes + t->nodes[0] * 3;
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++) out[i][j] = nodes[t->nodes[j + 1] * 3 + (uint32_t)i] - origin[i];
    }
}

static void deformation_gradient(const tetrahedron *t, const double *nodes, double out[3][3]) {
    double edges[3][3];
    edges_of(t, nodes, edges);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out[i][j] = edges[i][0] * t->to_rest[0][j] + edges[i][1] * t->to_rest[1][j] +
                        edges[i][2] * t->to_rest[2][j];
    }
}

static tetrahedron make_tetrahedron(const lattice *l, uint32_t cell, const uint8_t corners[4],
                                    const material *m) {
    tetrahedron t;
    double edges[3][3], minors[3][3], young = m->young;
    for (int i = 0; i < 4; i++) t.nodes[i] = l->cells[cell][corners[i]];
    edges_of(&t, l->rest, edges);
    if (determinant_of(edges) < 0.0) {
        uint32_t swapped = t.nodes[2];
        t.nodes[2] = t.nodes[3];
        t.nodes[3] = swapped;
        edges_of(&t, l->rest, edges);
    }
    double sixfold = determinant_of(edges);
    find_cofactors(edges, minors);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) t.to_rest[i][j] = minors[j][i] / sixfold;
    }
    t.volume = sixfold / 6.0;
    t.shear = young / (2.0 * (1.0 + m->poisson));
    t.bulk = young * m->poisson / ((1.0 + m->poisson) * (1.0 - 2.0 * m->poisson));
    return t;
}

tetrahedron *tetrahedra_make(const lattice *l, const material *m) {
    tetrahedron *out = body_allocate((size_t)l->cell_count * 5, sizeof *out);
    for (uint32_t cell = 0; cell < l->cell_count; cell++) {
        for (uint32_t i = 0; i < 5; i++)
            out[cell * 5 + i] = make_tetrahedron(l, cell, cuts[l->parities[cell]][i], m);
    }
    return out;
}

/* Moves the nodes along the gradient of the constraint, which is given by the deformation gradient, until
 * the constraint holds to first order with its compliance. */
static void correct_nodes(const tetrahedron *t, double by_gradient[3][3], double value, double compliance,
                          const double *inverse_masses, double *nodes) {
    double gradients[4][3] = {{0.0}};
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++) {
            gradients[j + 1][i] = vec3_dot(by_gradient[i], t->to_rest[j]);
            gradients[0][i] -= gradients[j + 1][i];
        }
    }
    double weight = compliance;
    for (int i = 0; i < 4; i++) weight += inverse_masses[t->nodes[i]] * vec3_dot(gradients[i], gradients[i]);
    double multiplier = -value / weight;
    for (int i = 0; i < 4; i++)
        vec3_add_scaled(nodes + t->nodes[i] * 3, inverse_masses[t->nodes[i]] * multiplier, gradients[i]);
}

void tetrahedra_solve(const tetrahedron *tetrahedra, uint32_t count, const double *inverse_masses,
                      double step, double *nodes) {
    for (uint32_t i = 0; i < count; i++) {
        const tetrahedron *t = &tetrahedra[i];
        double f[3][3], gradient[3][3];
        deformation_gradient(t, nodes, f);
        double size = sqrt(vec3_dot(f[0], f[0]) + vec3_dot(f[1], f[1]) + vec3_dot(f[2], f[2]));
        for (int k = 0; k < 9; k++) gradient[k / 3][k % 3] = f[k / 3][k % 3] / size;
        correct_nodes(t, gradient, size, 1.0 / (t->shear * t->volume * step * step), inverse_masses, nodes);

        deformation_gradient(t, nodes, f);
        find_cofactors(f, gradient);
        double growth = determinant_of(f) - 1.0 - t->shear / t->bulk;
        correct_nodes(t, gradient, growth, 1.0 / (t->bulk * t->volume * step * step), inverse_masses, nodes);
    }
}

double tetrahedra_energy(const tetrahedron *tetrahedra, uint32_t count, const double *nodes) {
    double energy = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const tetrahedron *t = &tetrahedra[i];
        double f[3][3], rest_growth = t->shear / t->bulk;
        deformation_gradient(t, nodes, f);
        double squared = vec3_dot(f[0], f[0]) + vec3_dot(f[1], f[1]) + vec3_dot(f[2], f[2]);
        double growth = determinant_of(f) - 1.0 - rest_growth;
        energy += 0.5 * t->volume *
                  (t->shear * (squared - 3.0) + t->bulk * (growth * growth - rest_growth * rest_growth));
    }
    return energy;
}
