/* The linear system of the IPC solver: its product is compared with a matrix; then its solution, and
 * vertices with prescribed motions. */
#include "models/common/vec3.h"
#include "models/ipc/newton_system.h"
#include "models/shapes/catalogue.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 60, CONTACTS = 30, FIXED = 5 };

typedef struct system_fixture {
    body shape;
    ipc_springs springs;
    cscd_energy_pattern pattern;
    size_t *rows;
    uint32_t *columns;
    ipc_system system;
    double *contacts, *inertia, *positions, *gradient, *x, *product;
    uint32_t count; /* number of coordinates */
} system_fixture;

/* A full matrix of contacts, each a positive number times a square. */
static void add_contacts(system_fixture *f, random_stream *random) {
    uint32_t n = f->shape.vertex_count;
    f->rows = body_allocate(n + 1, sizeof *f->rows);
    f->columns = body_allocate((size_t)n * n, sizeof *f->columns);
    f->contacts = body_allocate((size_t)n * n, 9 * sizeof *f->contacts);
    for (uint32_t v = 0; v <= n; v++) f->rows[v] = (size_t)v * n;
    for (uint32_t i = 0; i < n * n; i++) f->columns[i] = i % n;
    f->pattern = (cscd_energy_pattern){f->rows, f->columns, (size_t)n * n};
    for (int i = 0; i < CONTACTS; i++) {
        double u = stream_between(random, 0.0, 1.0), v = stream_between(random, 0.0, 1.0), normal[3];
        const double weights[4] = {1.0 - u, u, v - 1.0, -v}, curvature = stream_between(random, 0.0, 3000.0);
        uint32_t vertices[4];
        for (uint32_t k = 0; k < 4; k++) vertices[k] = (stream_below(random, n / 4) * 4 + k) % n;
        for (int k = 0; k < 3; k++) normal[k] = stream_between(random, -1.0, 1.0);
        vec3_normalize(normal);
        for (size_t e = 0; e < 144; e++) {
            size_t r = e / 12, c = e % 12, block = (size_t)vertices[r / 3] * n + vertices[c / 3];
            f->contacts[9 * block + 3 * (r % 3) + c % 3] +=
                curvature * weights[r / 3] * weights[c / 3] * normal[r % 3] * normal[c % 3];
        }
    }
}

/* In place, since the system keeps the address of the contacts. */
static void make_system(system_fixture *f, uint64_t seed) {
    static const ipc_stuff stuff = {.density = 1.0, .membrane = 100.0, .solid = 500.0};
    *f = (system_fixture){.count = 0};
    random_stream random = stream_start(seed);
    io_error error;
    if (!body_make(BODY_SPHERE, TRIANGLES, &f->shape, &error)) fail_msg("%s", error.text);
    f->count = f->shape.vertex_count * 3;
    ipc_springs_add_body(&f->springs, &f->shape, 0, &stuff);
    add_contacts(f, &random);
    f->inertia = body_allocate(f->shape.vertex_count, sizeof *f->inertia);
    for (uint32_t v = FIXED; v < f->shape.vertex_count; v++)
        f->inertia[v] = stream_between(&random, 1.0, 20.0);
    double **arrays[] = {&f->positions, &f->gradient, &f->x, &f->product};
    for (int k = 0; k < 4; k++) *arrays[k] = body_allocate(f->count, sizeof(double));
    for (uint32_t i = 0; i < f->count; i++) {
        f->positions[i] = f->shape.positions[i] + stream_between(&random, -0.1, 0.1);
        f->gradient[i] = stream_between(&random, -1.0, 1.0);
    }
    f->system = ipc_system_make(f->shape.vertex_count, f->inertia, &f->springs);
    ipc_system_set(&f->system, f->positions, &f->pattern, f->contacts);
}

static void free_system(system_fixture *f) {
    ipc_system_free(&f->system);
    free(f->rows);
    free(f->columns);
    free(f->contacts);
    ipc_springs_free(&f->springs);
    body_free(&f->shape);
    free(f->inertia);
    free(f->positions);
    free(f->gradient);
    free(f->x);
    free(f->product);
}

/* Compares column by column: the matrix is symmetric and positive where vertices are free, and the
 * preconditioner has the inverses of the blocks on its diagonal. */
TEST(product_is_that_of_a_symmetric_positive_matrix) {
    system_fixture f;
    make_system(&f, 1);
    double *matrix = body_allocate((size_t)f.count * f.count, sizeof *matrix);
    for (uint32_t j = 0; j < f.count; j++) {
        memset(f.x, 0, f.count * sizeof *f.x);
        f.x[j] = 1.0;
        ipc_system_product(&f.system, f.x, matrix + (size_t)j * f.count);
    }
    for (uint32_t i = 0; i < f.count; i++) {
        for (uint32_t j = FIXED * 3; j < f.count; j++) {
            double here = matrix[(size_t)i * f.count + j], there = matrix[(size_t)j * f.count + i];
            if (i < FIXED * 3)
                assert_true(there == 0.0);
            else
                assert_true(fabs(here - there) <= 1e-9);
        }
    }
    for (uint32_t v = FIXED; v < f.shape.vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            static const uint32_t places[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
            const double *column = matrix + (size_t)(v * 3 + k) * f.count + v * 3;
            for (uint32_t i = 0; i < 3; i++) {
                double back = 0.0;
                for (uint32_t j = 0; j < 3; j++) back += f.system.inverses[v].m[places[i][j]] * column[j];
                assert_true(fabs(back - (i == k)) <= 1e-9);
            }
        }
    }
    for (uint64_t seed = 0; seed < 50; seed++) {
        random_stream random = stream_start(seed);
        double square = 0.0, inertia = 0.0;
        for (uint32_t i = 0; i < f.count; i++)
            f.x[i] = i < FIXED * 3 ? 0.0 : stream_between(&random, -1.0, 1.0);
        ipc_system_product(&f.system, f.x, f.product);
        for (uint32_t i = 0; i < f.count; i++) {
            square += f.x[i] * f.product[i];
            inertia += f.inertia[i / 3] * f.x[i] * f.x[i];
        }
        assert_true(square >= inertia);
    }
    free(matrix);
    free_system(&f);
}

/* The solution satisfies matrix * x = -gradient where vertices are free; the others move as prescribed. */
TEST(solution_solves) {
    for (uint64_t seed = 0; seed < 10; seed++) {
        system_fixture f;
        make_system(&f, seed);
        for (uint32_t i = 0; i < FIXED * 3; i++) f.x[i] = 0.01 * i;
        f.x[FIXED * 3] = 77.0; /* has no effect */
        uint32_t iterations = ipc_system_solve(&f.system, f.gradient, 1e-10, 10 * f.count, f.x);
        assert_true(iterations > 0 && iterations < 10 * f.count);
        ipc_system_product(&f.system, f.x, f.product);
        for (uint32_t i = 0; i < f.count; i++) {
            if (i < FIXED * 3)
                assert_true(f.x[i] == 0.01 * i);
            else
                assert_true(fabs(f.product[i] + f.gradient[i]) < 1e-7);
        }
        free_system(&f);
    }
}

/* Every iterate is a descent direction, however early the solver stops. */
TEST(every_iterate_leads_down) {
    system_fixture f;
    make_system(&f, 5);
    double last = 0.0;
    for (uint32_t most = 1; most < 30; most++) {
        double slope = 0.0;
        memset(f.x, 0, f.count * sizeof *f.x);
        assert_int_equal(ipc_system_solve(&f.system, f.gradient, 1e-12, most, f.x), most);
        for (uint32_t i = 0; i < f.count; i++) slope += f.gradient[i] * f.x[i];
        assert_true(slope < last);
        last = slope;
    }
    free_system(&f);
}

TEST(nothing_to_solve_takes_nothing) {
    system_fixture f;
    make_system(&f, 6);
    memset(f.gradient, 0, f.count * sizeof *f.gradient);
    assert_int_equal(ipc_system_solve(&f.system, f.gradient, 1e-3, 100, f.x), 0);
    for (uint32_t i = 0; i < f.count; i++) assert_true(f.x[i] == 0.0);
    free_system(&f);
}
