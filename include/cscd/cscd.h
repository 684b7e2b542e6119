/*
 * cscd - continuous self-collision detection for deforming triangle meshes.
 *
 * You give a mesh and two sets of vertex positions, the start and the end of an interval in which every vertex
 * moves in a straight line. You get every contact: every pair of a vertex and a face, or of two edges, that
 * touches on the way, and when it first does.
 *
 * What holds for every function:
 *   positions   are given as views (cscd/detector.h): floats or doubles, packed, in structs, or by columns. Each
 *               coordinate is 0 or has a magnitude from 2^-300 to 2^300; a function that is given another one
 *               fails and names array, vertex and coordinate
 *   units       any one unit of length; nothing inside depends on it. A length is 0 or from 2^-300 to 2^300
 *   time        fraction of the interval: 0 is its start, 1 its end. Timings are milliseconds of wall clock
 *   features    vertices, edges and faces (triangles), borders included; wires are edges, and cscd_object_kind has
 *               points and half-spaces. Indices begin at 0
 *   contact     two features without a common vertex touch during the interval or, with a minimum separation,
 *               come within it. Features in contact at the start are reported at time 0
 *   ownership   the library copies what it is given. What a _create function makes, one _destroy call gives back,
 *               in any order: an object keeps what it was made from, so a detector goes on working when its mesh
 *               and its context have been destroyed, and the last of their objects frees them. After _destroy
 *               the caller's pointer must not be used. Destroying NULL does nothing
 *   results     lists that a function gives out belong to the object that was asked; each says how long they live
 *   threads     one call at a time works in a context: another one fails with CSCD_BUSY, as calls from callbacks do.
 *               Separate contexts are independent. A mesh never changes: objects of any contexts use it on any
 *               threads at the same time, and its functions may be called from any thread. A thread that calls
 *               needs 256 KiB of stack. cscd/detector.h has the rules of callbacks and of fork
 *   errors      functions that can fail return cscd_status; *out is written only with CSCD_OK. Afterwards
 *               cscd_context_detail() gives a sentence: what is wrong, where, and what to do; "" after a call
 *               that succeeded. A function that needs an object and is given NULL returns CSCD_NULL_OBJECT; the
 *               sentence says which, unless it is the object whose context would keep it. All may return CSCD_INVALID_ARGUMENT and CSCD_OUT_OF_MEMORY;
 *               other statuses are named at the function. Objects stay valid after any failure, and the call may
 *               be repeated
 *   unchecked   functions that do not return cscd_status are given a valid object and indices below its counts;
 *               they check nothing
 *   defaults    options come from the matching _defaults() function and are then changed; {0} is refused. A NULL
 *               options pointer means the defaults. Members of other structs that you do not need are 0
 *   versions    options, cscd_object_desc, cscd_object_change and cscd_plan_parts are as large as your header says,
 *               whatever library is loaded: functions that end in _sized take that size, and their inline twins
 *               pass it on. Bindings call the _sized ones. No other struct grows. Enumerations that may grow end in
 *               _MAX_ENUM; give a switch a default. The name of a value that the library does not know is
 *               "unknown". docs/solver/abi.md has all rules
 *   complete    a list is whole, or the call fails
 *   repeatable  one build and the same inputs give the same results in the same order, bit for bit, for any
 *               number of threads and on every instruction set
 *
 * What a solver needs, 26 of the functions:
 *   create      cscd_context_create(), cscd_mesh_create(), cscd_detector_defaults(), cscd_detector_create(); if
 *               the mesh is closed and deforms for long, cscd_plan_create() first, which makes steps faster
 *   contacts    cscd_detector_step(): all contacts of a motion; cscd_mesh_stencil(): the weights behind each
 *   barrier     cscd_detector_find_near(): all pairs within a distance at one moment, each once with its number
 *               in the form CSCD_NEAR_UNIQUE
 *   certified   cscd_detector_max_step(): how far the vertices may go without contact;
 *               cscd_detector_set_separation()
 *   search      cscd_line_search_create(), _begin(), _max_step(), _find_near(): the same two, many times along
 *               one motion
 *   state       cscd_detector_check(): intersections at one moment; cscd_detector_guarantee(): what the last list
 *               promises; cscd_detector_timings()
 *   helpers     cscd_view_doubles(), cscd_view_floats(), cscd_mesh_edge(), cscd_status_string(),
 *               cscd_context_detail()
 *   destroy     cscd_line_search_destroy(), cscd_detector_destroy(), cscd_plan_destroy(),
 *               cscd_mesh_destroy(), cscd_context_destroy()
 *
 * cscd/research.h (methods to compare with) and cscd/sensors.h (particle sensors) are not included here.
 *
 * docs/solver has the promises (guarantees.md) and complete programs; cscd/cscd.hpp is the library in C++17.
 */
#ifndef CSCD_H
#define CSCD_H

#include <cscd/detector.h>
#include <cscd/events.h>
#include <cscd/live.h>
#include <cscd/plan.h>
#include <cscd/solver.h>
#include <cscd/surface.h>

#define CSCD_VERSION_MAJOR 2
#define CSCD_VERSION_MINOR 0
#define CSCD_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library in use, as "2.0.0"; static storage. */
CSCD_API const char *cscd_version_string(void);

#ifdef __cplusplus
}
#endif

#endif
