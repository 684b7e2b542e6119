/*
 * cscd - continuous self-collision detection for deforming triangle meshes.
 *
 * A solver needs these 27 functions:
 *   create      cscd_context_create(), cscd_mesh_create(), cscd_detector_defaults(), cscd_detector_create().
 *               Before the last, cscd_plan_create() makes steps faster if the mesh is closed and deforms for
 *               long
 *   contacts    cscd_detector_step(): all contacts of a motion; cscd_mesh_stencil(): the weights behind each
 *   barrier     cscd_detector_find_near(): all pairs within a distance at one moment, in the form
 *               CSCD_NEAR_UNIQUE each once with its count
 *   certified   cscd_detector_max_step(): how far the vertices may go without contact;
 *               cscd_detector_set_separation()
 *   search      cscd_line_search_create(), _begin(), _max_step(), _find_near(): the same two, many times
 *               along one motion
 *   state       cscd_detector_check(): intersections at one moment; cscd_detector_guarantee(): what the last
 *               list promises; cscd_detector_timings()
 *   helpers     cscd_view_doubles(), cscd_view_floats(), cscd_mesh_edge(), cscd_status_string(),
 *               cscd_context_detail()
 *   destroy     cscd_line_search_destroy(), cscd_detector_destroy(), cscd_plan_destroy(),
 *               cscd_mesh_destroy(), cscd_context_destroy()
 *
 * All functions follow these rules:
 *   positions   are given as views (cscd/detector.h). A coordinate is 0 or of magnitude 2^-300 to 2^300; a
 *               call with another one fails and names array, vertex and coordinate
 *   units       any one unit of length. A length is 0 or from 2^-300 to 2^300
 *   time        the fraction of the interval, from 0 to 1, in which every vertex moves in a straight line.
 *               Timings are milliseconds of wall clock
 *   features    vertices, edges (also wires) and faces (triangles), borders included. Indices begin at 0
 *   contact     a vertex and a face, or two edges, without a common vertex, that touch or, with a minimum
 *               separation, come within it; those in contact at the start are reported at time 0
 *   ownership   the library copies what it is given. One _destroy call gives back what a _create function
 *               made, in any order, since objects keep what they were made from; the pointer is then dead.
 *               Destroying NULL does nothing
 *   results     lists belong to the object that was asked; each says how long it lives
 *   threads     one call at a time works in a context; another one, also from a callback, fails with
 *               CSCD_BUSY and changes nothing. Contexts are independent. A mesh never changes: any contexts
 *               and threads use it, and call its functions, at once. A calling thread needs 256 KiB of stack.
 *               cscd/detector.h has the rules of callbacks and of fork
 *   errors      functions that can fail return cscd_status. They write *out only with CSCD_OK; with
 *               CSCD_LIST_TOO_LONG it says how long the list would be. cscd_context_detail() then says what
 *               is wrong, where, and what to do. All may return CSCD_INVALID_ARGUMENT, CSCD_OUT_OF_MEMORY
 *               and, if an object is NULL, CSCD_NULL_OBJECT; functions name further ones. The last has no
 *               sentence if the context itself is unknown. Objects stay valid after a failure, and the call
 *               may be repeated
 *   unchecked   functions without a cscd_status need a valid object, and indices below its counts, unless
 *               they say otherwise
 *   defaults    options come from the _defaults() function and are then changed; {0} is refused. NULL options
 *               mean the defaults. Members of other structs that you do not need are 0
 *   versions    options, cscd_object_desc, cscd_object_change and cscd_plan_parts may grow: functions that
 *               end in _sized take their size, and inline twins pass it on. Bindings call the _sized ones.
 *               Enumerations with a _MAX_ENUM may grow: give a switch a default. docs/solver/abi.md has all
 *               rules
 *   complete    a list is whole, or the call fails
 *   repeatable  one build and the same inputs give the same results in the same order, bit for bit, for any
 *               number of threads and on every instruction set
 *
 * Not included here: cscd/research.h (methods to compare with) and cscd/sensors.h (particle sensors).
 * docs/solver has the promises (guarantees.md) and programs; cscd/cscd.hpp is the library in C++17.
 */
#ifndef CSCD_H
#define CSCD_H

#include <cscd/detector.h>
#include <cscd/energy.h>
#include <cscd/events.h>
#include <cscd/live.h>
#include <cscd/plan.h>
#include <cscd/solver.h>
#include <cscd/surface.h>
#include <cscd/untangle.h>

#define CSCD_VERSION_MAJOR 2
#define CSCD_VERSION_MINOR 0
#define CSCD_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the version of the library in use, as "2.0.0"; static storage. */
CSCD_API const char *cscd_version_string(void);

#ifdef __cplusplus
}
#endif

#endif
