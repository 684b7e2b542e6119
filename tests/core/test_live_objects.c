/* The list of live objects: the first fault is found, whatever comes and goes; and in debug builds the next call of a
 * context reports a structure that was broken behind its back. */
#include "src/core/entry.h"
#include "src/mesh/mesh.h"
#include "tests/support/test.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { OBJECTS = 6 };

typedef struct listed_object {
    reference_count references;
    const char *fault;
} listed_object;

static const char *validate_object(const reference_count *object) {
    return ((const listed_object *)object)->fault;
}

TEST(faults_are_found_in_any_order) {
    listed_object objects[OBJECTS] = {{.fault = NULL}};
    live_objects list;
    assert_true(live_objects_begin(&list));
    assert_null(live_objects_fault(&list));
    for (int i = 0; i < OBJECTS; i++) {
        reference_begin(&objects[i].references, NULL);
        live_objects_add(&list, &objects[i].references, validate_object);
    }
    for (int i = 0; i < OBJECTS; i++) {
        objects[i].fault = "a fault";
        assert_string_equal(live_objects_fault(&list), "a fault");
        objects[i].fault = NULL;
        assert_null(live_objects_fault(&list));
    }
    static const int order[OBJECTS] = {2, 5, 0, 3, 4, 1};
    for (int i = 0; i < OBJECTS; i++) {
        objects[order[i]].fault = "a fault";
        live_objects_remove(&list, &objects[order[i]].references);
        live_objects_remove(&list, &objects[order[i]].references); /* it is not in the list */
        assert_null(live_objects_fault(&list));
        for (int k = i + 1; k < OBJECTS; k++) { /* the others still are */
            objects[order[k]].fault = "another fault";
            assert_string_equal(live_objects_fault(&list), "another fault");
            objects[order[k]].fault = NULL;
        }
    }
    assert_null(list.first);
    live_objects_end(&list);
}

TEST(freed_objects_are_noticed) {
    listed_object object = {.fault = NULL};
    live_objects list;
    assert_true(live_objects_begin(&list));
    reference_begin(&object.references, NULL);
    live_objects_add(&list, &object.references, validate_object);
    object.references.alive = 0;
    assert_string_equal(live_objects_fault(&list), "an object was freed that is still in use");
    live_objects_end(&list);
}

/* Calls with a mesh of which one index is wrong; returns how the process ended. */
static int call_with_broken_mesh(void) {
    static const uint32_t triangles[] = {0, 1, 2, 2, 1, 3};
    cscd_object_desc object = cscd_object_of_triangles(4, 2, triangles);
    cscd_context *context;
    cscd_mesh *mesh, *other;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &object, 1, &mesh), CSCD_OK);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (freopen("/dev/null", "w", stderr) == NULL) _exit(2);
        mesh->triangles[1][0] = 77;
        _exit(cscd_mesh_create(context, &object, 1, &other) == CSCD_OK ? 0 : 1);
    }
    int outcome = 0;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_int_equal(cscd_mesh_create(context, &object, 1, &other), CSCD_OK); /* our own mesh is whole */
    cscd_mesh_destroy(other);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return outcome;
}

TEST(the_next_call_of_a_debug_build_stops) {
    int outcome = call_with_broken_mesh();
#ifdef NDEBUG
    assert_true(WIFEXITED(outcome) && WEXITSTATUS(outcome) == 0); /* release builds look at nothing */
#else
    assert_true(WIFSIGNALED(outcome) && WTERMSIG(outcome) == SIGABRT);
#endif
}
