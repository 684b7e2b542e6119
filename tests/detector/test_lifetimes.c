/* Objects hold what they need: they may be destroyed in any order, and what is left goes on working. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <string.h>

/* In the order of creation. */
enum { CONTEXT, MESH, PLAN, DETECTOR, LINE, KINDS };

/* One object of each kind, made from one another; NULL: destroyed. */
typedef struct family {
    counting_allocator counter;
    void *members[KINDS];
} family;

static const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
static const double x0[24] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4, 1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};
static double x1[24]; /* the second tetrahedron has run into the first one from below */

static int move_up(void **state) {
    (void)state;
    for (int i = 0; i < 24; i++) x1[i] = x0[i] + (i >= 12 && i % 3 == 2 ? 1.5 : 0.0);
    return 0;
}

static cscd_status member_create(void *const members[KINDS], int kind, counting_allocator *counter,
                                 uint32_t thread_count, void **made) {
    cscd_context_options options = cscd_context_defaults();
    cscd_plan_options by_single = cscd_plan_defaults();
    cscd_object_desc desc = cscd_object_of_triangles(8, 8, triangles);
    switch (kind) {
    case CONTEXT:
        options.allocator = counting_allocator_interface(counter);
        options.thread_count = thread_count;
        return cscd_context_create(&options, (cscd_context **)made);
    case MESH:
        return cscd_mesh_create(members[CONTEXT], &desc, 1, (cscd_mesh **)made);
    case PLAN:
        by_single.method = CSCD_METHOD_SINGLE;
        return plan_create_packed(members[MESH], x0, &by_single, (cscd_plan **)made);
    case DETECTOR:
        return detector_create_here(members[MESH], members[PLAN], NULL, (cscd_detector **)made);
    default:
        return cscd_line_search_create(members[DETECTOR], (cscd_line_search **)made);
    }
}

/* Creates the members of the kinds below end. */
static void family_create(family *f, uint32_t thread_count, int end) {
    *f = (family){.counter = counting_allocator_start()};
    for (int kind = 0; kind < end; kind++) {
        void **member = &f->members[kind];
        expect_ok(member_create(f->members, kind, &f->counter, thread_count, member));
        if (kind == LINE) expect_ok(line_begin_packed(*member, x0, x1, 0.5));
    }
}

/* What a member that is left does must be what it did before the others were destroyed. */
static void member_use(void *const members[KINDS], int kind) {
    void *member = members[kind];
    double reached[24];
    cscd_contacts contacts;
    cscd_free_step step;
    switch (kind) {
    case CONTEXT:
        assert_true(cscd_context_describe(member).bytes > 0);
        break;
    case MESH:
        assert_int_equal(cscd_mesh_edge_count(member), 12);
        break;
    case PLAN:
        assert_int_equal(cscd_plan_region_count(member), 2);
        break;
    case DETECTOR:
        expect_ok(step_packed(member, x0, x1, &contacts));
        assert_int_equal(contacts.count, 1);
        break;
    default:
        expect_ok(line_max_step_packed(member, 1.0, reached, &step));
        assert_true(step.limited);
    }
}

static void member_destroy(void *members[KINDS], int kind) {
    void *member = members[kind];
    members[kind] = NULL;
    switch (kind) {
    case CONTEXT:
        cscd_context_destroy(member);
        break;
    case MESH:
        cscd_mesh_destroy(member);
        break;
    case PLAN:
        cscd_plan_destroy(member);
        break;
    case DETECTOR:
        cscd_detector_destroy(member);
        break;
    default:
        cscd_line_search_destroy(member);
    }
}

/* Destroys the members in the order, and uses all that are left after each. */
static void destroy_in_order(const int order[KINDS]) {
    family f;
    family_create(&f, 1, KINDS);
    for (int i = 0; i < KINDS; i++) {
        assert_true(f.counter.live > 0);
        member_destroy(f.members, order[i]);
        for (int kind = 0; kind < KINDS; kind++) {
            if (f.members[kind] != NULL) member_use(f.members, kind);
        }
    }
    assert_int_equal(f.counter.live, 0);
    assert_int_equal(f.counter.bytes, 0);
}

/* Writes the permutation of a number below KINDS factorial. */
static void order_of_number(int number, int order[KINDS]) {
    for (int i = 0; i < KINDS; i++) order[i] = i;
    for (int i = 0; i < KINDS; i++) {
        int chosen = i + number % (KINDS - i), kept = order[i];
        number /= KINDS - i;
        order[i] = order[chosen];
        order[chosen] = kept;
    }
}

TEST(every_order) {
    int factorial = 1, order[KINDS];
    for (int i = 2; i <= KINDS; i++) factorial *= i;
    for (int number = 0; number < factorial; number++) {
        order_of_number(number, order);
        destroy_in_order(order);
    }
}

/* The threads of a context are joined by whichever object goes last. */
TEST(threads_outlive_their_context) {
    for (int last = 0; last < KINDS; last++) {
        family f;
        family_create(&f, 3, KINDS);
        for (int kind = 0; kind < KINDS; kind++) {
            if (kind != last) member_destroy(f.members, kind);
        }
        for (int i = 0; i < 3; i++) member_use(f.members, last);
        member_destroy(f.members, last);
        assert_int_equal(f.counter.live, 0);
    }
}

/* ---- on many threads ----------------------------------------------------------------------------------- */

typedef struct destroyer {
    pthread_t thread;
    pthread_barrier_t *all_ready;
    family *of;
    int kind;
} destroyer;

static void *destroy_at_once(void *argument) {
    destroyer *d = argument;
    pthread_barrier_wait(d->all_ready);
    member_destroy(d->of->members, d->kind);
    return NULL;
}

/* As the finalizers of a language with a garbage collector do: each object on a thread of its own. */
TEST(all_at_once) {
    for (int round = 0; round < 50; round++) {
        family f;
        destroyer destroyers[KINDS];
        pthread_barrier_t all_ready;
        family_create(&f, 1 + (uint32_t)round % 2, KINDS);
        assert_int_equal(pthread_barrier_init(&all_ready, NULL, KINDS), 0);
        for (int kind = 0; kind < KINDS; kind++) {
            destroyers[kind] = (destroyer){.all_ready = &all_ready, .of = &f, .kind = kind};
            assert_int_equal(
                pthread_create(&destroyers[kind].thread, NULL, destroy_at_once, &destroyers[kind]), 0);
        }
        for (int kind = 0; kind < KINDS; kind++)
            assert_int_equal(pthread_join(destroyers[kind].thread, NULL), 0);
        pthread_barrier_destroy(&all_ready);
        assert_int_equal(f.counter.live, 0);
        assert_int_equal(f.counter.bytes, 0);
    }
}

AROUND_ALL(move_up, NULL)
