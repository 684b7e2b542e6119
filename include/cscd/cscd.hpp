/*
 * cscd in C++17: classes that destroy what they own, views of a program's own arrays, lists as ranges, lambdas as
 * callbacks, and one exception. Header only, over the functions of cscd/cscd.h, which says what each of them
 * promises; the names are the same without cscd_ and the object's name.
 *
 *     cscd::context context;
 *     cscd::mesh mesh(context, {cscd::object_of_triangles(vertex_count, triangles)});
 *     cscd::detector detector(context, mesh);
 *     for (const cscd_contact &contact : detector.step(x0, x1)) ...
 *
 * What holds for all of it:
 *   objects     context, mesh, plan, detector, line_search, energy, event_tracker and mesh_change are moved and not copied. Each keeps what it was made
 *               from, so they may go in any order. One that was moved from may be destroyed or assigned to; its
 *               calls fail, but functions that only ask, such as vertex_count(), must not be called. get() gives
 *               the object of C, for what has no class here; C objects made from it go before the C++ ones
 *   positions   arguments are containers of floats, doubles or points, views of a member of structs
 *               (view_of(particles, &particle::position)), of columns (view_of_columns), or containers of views
 *               that hold the objects of the mesh in turn. They are read in place. Outputs take the same forms
 *   lists       ranges over the library's memory: they belong to the detector, and live until the next call of it
 *               or of one of its line searches
 *   errors      cscd::error, with the status and, as what(), the sentence. Nothing else is thrown but what
 *               callbacks throw and std::bad_alloc of strings and vectors; destructors throw nothing
 *   callbacks   may throw, all but `release`. The call is cancelled, and the exception is thrown again, the same
 *               object, when the call has ended; the context and its objects work on, and the call may be repeated.
 *               The first exception is the one that arrives. What a call has made or listed is lost with it. In
 *               functions of C that are called with get(), callbacks must not throw
 *   plain       functions without an object (cscd_method_name, cscd_version_string ...) and structs are used as in C
 *
 * cscd/sensors.hpp has classes for cscd/sensors.h; cscd/research.h is used as in C.
 */
#ifndef CSCD_HPP
#define CSCD_HPP

#include <cscd/context.hpp>
#include <cscd/cscd.h>
#include <cscd/detector.hpp>
#include <cscd/energy.hpp>
#include <cscd/error.hpp>
#include <cscd/events.hpp>
#include <cscd/lists.hpp>
#include <cscd/mesh.hpp>
#include <cscd/mesh_change.hpp>
#include <cscd/pairs.hpp>
#include <cscd/plan.hpp>
#include <cscd/solver.hpp>
#include <cscd/view.hpp>

#endif
