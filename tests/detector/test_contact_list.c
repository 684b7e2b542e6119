/* The contacts of all workers form one list, sorted by time and names, without those that the caller
 * ignores; long lists are moved, not copied, and are the same. */
#include "runtime/detector/detector.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene shape; /* large; one test at a time */

static const double times[] = {1.0, 0.25, 0.0, -0.0, 0.25, 1.0, 0.25, 0.0};
enum { CONTACT_COUNT = sizeof times / sizeof *times };

/* Makes contacts of two kinds, some at equal times, and deals them out to all workers. */
static void fill_workers(cscd_context *context, search_space *s) {
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) contact_worker_reset(&s->workers[i]);
    for (uint32_t i = 0; i < CONTACT_COUNT; i++) {
        elementary_contact hit = {.toi = times[i]};
        cscd_contact_kind kind = i % 3 == 0 ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
        contact_worker_add(context, &s->workers[i % s->traversal.worker_count], kind, (7 * i) % 5, 20 - i,
                           &hit, i == 5);
    }
    s->traversal.busy_workers = s->traversal.worker_count;
}

static bool in_order(const cscd_contact *a, const cscd_contact *b) {
    if (a->toi != b->toi) return a->toi < b->toi;
    if (a->kind != b->kind) return a->kind < b->kind;
    return a->a != b->a ? a->a < b->a : a->b < b->b;
}

/* What a list is collected from, and into. */
typedef struct collection {
    rig rig;
    search_space space;
    exclusions excluded;
    result_buffer buffer;
    cscd_counters counters;
} collection;

static collection collection_begin(uint32_t threads, const cscd_detector_options *options) {
    collection c = {.rig = rig_create(&shape, threads, NULL)};
    expect_ok(search_space_create(c.rig.mesh, &c.space));
    expect_ok(exclusions_create(c.rig.mesh, options, &c.excluded));
    return c;
}

static void collection_end(collection *c) {
    result_buffer_free(c->rig.context, &c->buffer);
    exclusions_free(c->rig.context, &c->excluded);
    search_space_destroy(&c->space);
    rig_destroy(&c->rig);
}

static cscd_contacts collect_contacts(collection *c) {
    cscd_contacts found = {.count = 0};
    c->counters = (cscd_counters){.vf = 0};
    fill_workers(c->rig.context, &c->space);
    c->space.workers[0].feature_pairs = 3;
    c->space.workers[0].decided[ELEMENTARY_SIGNS] = 2;
    expect_ok(contact_list_collect(&c->space, &c->excluded, &c->buffer, &c->counters, &found));
    return found;
}

TEST(lists_are_sorted_for_any_worker_count) {
    static cscd_contact expected[CONTACT_COUNT];
    const cscd_detector_options options = cscd_detector_defaults();
    scene_make(SCENE_SPIKE, 1, &shape);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        collection c = collection_begin(threads, &options);
        const cscd_contacts found = collect_contacts(&c);
        const cscd_counters *counted = &c.counters;
        assert_int_equal(found.count, CONTACT_COUNT);
        for (size_t i = 1; i < found.count; i++) assert_true(in_order(&found.items[i - 1], &found.items[i]));
        assert_true(counted->vf == 5 && counted->ee == 3 && counted->bounded == 1);
        assert_true(counted->feature_pairs == 3 && counted->by_signs == 2 && counted->tests == 2);
        if (threads == 1)
            memcpy(expected, found.items, sizeof expected);
        else
            assert_memory_equal(found.items, expected, sizeof expected);
        collection_end(&c);
    }
}

static bool ignore_everything(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (kind == CSCD_CONTACT_VF || a < b);
}

TEST(what_the_caller_ignores_is_not_counted) {
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignore_everything;
    scene_make(SCENE_SPIKE, 1, &shape);
    collection c = collection_begin(1, &options);
    assert_int_equal(collect_contacts(&c).count, 0);
    assert_true(c.counters.vf == 0 && c.counters.ee == 0 && c.counters.bounded == 0 &&
                c.counters.feature_pairs == 3);
    collection_end(&c);
}

/* ---- mode EARLIEST ------------------------------------------------------------------------------------- */

/* Of five contacts of a component with itself two were seen. Those stay that are at most 0.05 later than the earliest, and so
 * is the number of those that were seen among them. */
TEST(dropped_contacts_are_not_seen_any_more) {
    static const double tois[] = {0.9, 0.1, 0.16, 0.95, 0.14};
    scene_make(SCENE_SPIKE, 1, &shape);
    rig r = rig_create(&shape, 1, NULL);
    cscd_detector *d = r.detector;
    contact_worker *worker = &d->space.workers[0];
    contact_worker_reset(worker);
    for (size_t i = 0; i < sizeof tois / sizeof *tois; i++) {
        elementary_contact hit = {.toi = tois[i]};
        contact_worker_add(r.context, worker, CSCD_CONTACT_VF, r.mesh->triangles[0][0], 1, &hit, false);
    }
    d->interval.contacts_seen[0] = 0;
    earliest_begin(&d->interval);
    earliest_note(&d->interval);
    d->interval.contacts_seen[0] = 2;
    earliest_drop_later(&d->interval, 0.05);
    assert_int_equal(worker->count, 2);
    assert_true(contact_worker_at(worker, 0)->toi == 0.1 && contact_worker_at(worker, 1)->toi == 0.14);
    assert_int_equal(d->interval.contacts_seen[0], 1);
    contact_worker_reset(worker);
    rig_destroy(&r);
}

/* ---- long lists ---------------------------------------------------------------------------------------- */

TEST(workers_of_long_lists_give_back_their_memory) {
    const cscd_detector_options options = cscd_detector_defaults();
    scene_make(SCENE_SPIKE, 1, &shape);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        collection copying = collection_begin(threads, &options),
                   moving = collection_begin(threads, &options);
        const cscd_contacts expected = collect_contacts(&copying);
        moving.space.moves_from = 1;
        for (int round = 0; round < 2; round++) {
            const cscd_contacts found = collect_contacts(&moving);
            assert_int_equal(found.count, expected.count);
            assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
            assert_memory_equal(&moving.counters, &copying.counters, sizeof moving.counters);
            assert_true(moving.buffer.keys == NULL && moving.buffer.spare_keys == NULL);
            for (uint32_t i = 0; i < moving.space.traversal.worker_count; i++)
                assert_true(moving.space.workers[i].count == 0 && moving.space.workers[i].block_count == 0);
        }
        collection_end(&copying);
        collection_end(&moving);
    }
}

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (a + b + (uint32_t)kind) % 3 == 0;
}

/* Whole steps there and back, with lists that are copied and lists that are moved. */
TEST(steps_with_long_lists_are_the_same) {
    static scene back;
    size_t contacts = 0;
    for (uint32_t seed = 0; seed < 4 * SCENE_FAMILY_COUNT; seed++) {
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed, &shape);
        back = shape;
        memcpy(back.x0, shape.x1, sizeof back.x0);
        memcpy(back.x1, shape.x0, sizeof back.x1);
        cscd_detector_options options = cscd_detector_defaults();
        if (seed % 2 == 1) options.ignore = ignore_some;
        rig copying = rig_create(&shape, 1 + seed % 3, &options),
            moving = rig_create(&shape, 1 + seed % 3, &options);
        moving.detector->space.moves_from = 1;
        for (int step = 0; step < 4; step++) {
            const scene *interval = step % 2 == 0 ? &shape : &back;
            const cscd_contacts expected = rig_step(&copying, interval), found = rig_step(&moving, interval);
            assert_int_equal(found.count, expected.count);
            assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
            contacts += found.count;
        }
        rig_destroy(&copying);
        rig_destroy(&moving);
    }
    assert_true(contacts > 1000);
}
