/* Separating directions of level one: planes that keep two moving features apart during the whole interval.
 */
#pragma once

#include "runtime/ccd/elementary.h"

/* These return true only for features that are certainly apart. They compare the points at one time, so the
 * axes and the diagonals together reject whatever swept 14-DOPs of the features would reject, and more. */
bool separated_by_axes(const elementary_query *query, cscd_contact_kind kind);
bool separated_by_diagonals(const elementary_query *query, cscd_contact_kind kind);

/* Tries directions in the features' common plane at mid-interval, for points that are nearly coplanar. */
bool separated_in_plane(const elementary_query *query, cscd_contact_kind kind);

/* The same from one time to another, both in [0, 1], also for features that have no common normal: parallel edges, and a face
 * that is a segment. The shorter the part, the fewer pairs that stay apart are left. */
bool separated_in_part(const elementary_query *query, cscd_contact_kind kind, double begin, double end);
