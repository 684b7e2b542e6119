/*
 * cscd - continuous self-collision detection for deforming triangle meshes.
 *
 * One mesh, two sets of vertex positions (start and end of an interval), every vertex moving in a
 * straight line between them: cscd reports every vertex-face and edge-edge pair of the mesh that touches.
 *
 * Conventions, true for every function below:
 *   positions   packed x,y,z doubles, vertex_count * 3 values, in any one unit of length; each value is
 *               0 or has a magnitude in [2^-300, 2^300]
 *   time        fraction of the interval, 0 = start, 1 = end
 *   contact     two features that touch, or come within min_separation; features that share a vertex are
 *               never reported, features in contact at the start already are reported at time 0
 *   timings     milliseconds of wall clock
 *   errors      functions that can fail return cscd_status and leave *out untouched unless CSCD_OK;
 *               cscd_context_detail then says in a sentence what is wrong, where, and what to do (a NULL
 *               context, mesh, detector or line has no place for a sentence). Functions that cannot fail
 *               want an object, and numbers below its counts
 *   ownership   the library copies what it is given; a _create has one _destroy; destroy in reverse
 *               order of creation; destroying NULL does nothing
 *   threads     an object, and what was created from it, is used by one thread at a time; separate
 *               contexts are independent
 *   defaults    a NULL options pointer means the matching _defaults(); start from those, never from {0}
 *   complete    a list is whole or the call failed
 *   repeatable  one build, the same inputs: the same contacts in the same order, bit for bit,
 *               for any thread count
 */
#ifndef CSCD_H
#define CSCD_H

#include <cscd/context.h>
#include <cscd/detector.h>
#include <cscd/mesh.h>
#include <cscd/plan.h>
#include <cscd/sensors.h>
#include <cscd/solver.h>

#define CSCD_VERSION_MAJOR 1
#define CSCD_VERSION_MINOR 1
#define CSCD_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/* "1.1.0", static storage. */
CSCD_API const char *cscd_version_string(void);

#ifdef __cplusplus
}
#endif

#endif
