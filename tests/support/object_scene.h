/* Scenes of several objects with random rules, and brute force over what rules, seams and ignored pairs leave out,
 * and what waits after changes. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"

enum { SCENE_OBJECTS = 4, RULE_CLASSES = 3, OBJECT_TRIANGLES_MAX = 300 };

/* The objects together, the motion that is looked at, the object of each vertex, and triangles that name the vertices of
 * their object. */
extern scene objects_joined, objects_motion;
extern uint32_t objects_of_vertices[SCENE_VERTICES_MAX], objects_triangles[SCENE_TRIANGLES_MAX * 3];

/* Makes the objects, of any kind and all in one place, so that they have contacts. */
void object_scene_make(random_stream *random);

/* Makes the motion from one share of the way of all objects to another. */
void object_scene_go(double begin, double end);

typedef struct random_rules {
    cscd_object_rule objects[SCENE_OBJECTS];
    double matrix[RULE_CLASSES * RULE_CLASSES];
    bool uses_matrix, obstacles[SCENE_OBJECTS];
    double distances[SCENE_OBJECTS * SCENE_OBJECTS]; /* as the oracle takes them */
} random_rules;

/* Rules that change nothing. */
void random_rules_neutral(random_rules *set);

/* kind 0: masks alone, 1: thicknesses, 2: a matrix whose diagonal is often 0. The obstacles stay. */
void random_rules_make(random_stream *random, uint32_t kind, random_rules *set);

/* A detector for the objects, without rules yet; options: of the detector. Any failure fails the test. */
rig rules_rig(const random_rules *set, const cscd_detector_options *options, uint32_t threads);
void rules_set(cscd_detector *detector, const random_rules *set);

/* How much was compared. */
typedef struct rules_tally {
    size_t contacts, culled, later, masked, thick_and_culled, embedded;
} rules_tally;

/* Compares a step's contacts with those of the oracle. Of a component whose guarantee is EARLIEST, all but one of the first
 * contacts with itself may be missing. */
void rules_rig_compare(const rig *s, const oracle_list *truth, const cscd_contacts *found, rules_tally *sum);

/* ---- what waits ---------------------------------------------------------------------------------------- */

enum { LEFT_OUT_SEAMS_MAX = 64, LEFT_OUT_IGNORED_MAX = 256 };

/* What a caller leaves out at one time, in the words of the API. */
typedef struct left_out {
    uint32_t seams[LEFT_OUT_SEAMS_MAX][2], ignored[LEFT_OUT_IGNORED_MAX][2];
    size_t seam_count, ignored_count;
    oracle_rules rules; /* distances below 0: objects that are not looked at */
} left_out;

/* The same, and the name of each vertex: the smallest that is sewn to it. */
typedef struct named_left_out {
    left_out what;
    uint32_t names[SCENE_VERTICES_MAX];
} named_left_out;

typedef struct waiting_oracle {
    const cscd_mesh *mesh; /* for the ends of edges */
    const scene *scene;
    named_left_out now;
    named_left_out *former; /* since positions were last seen */
    size_t former_count;
    oracle_list pairs; /* of features and of triangles that wait */
    oracle_list touching;
} waiting_oracle;

waiting_oracle waiting_oracle_start(const cscd_mesh *mesh, const scene *s, const left_out *now);
void waiting_oracle_free(waiting_oracle *o);

/* The caller changes what is left out. */
void waiting_oracle_change(waiting_oracle *o, const left_out *next);

/* Positions are seen; where a motion starts, pairs are let go. */
void waiting_oracle_see(waiting_oracle *o, const double *x, bool motion_starts);

/* Is the pair left out now, because of what the caller says, or because it waits? Intersections are those at x. */
bool waiting_oracle_covers(const waiting_oracle *o, cscd_contact_kind kind, uint32_t a, uint32_t b,
                           const double *x);

/* Drops what is left out from a list of features. */
void waiting_oracle_filter(const waiting_oracle *o, oracle_list *list);

/* Lists all pairs of triangles that intersect, with a time of 0, and without what is left out. */
void waiting_oracle_intersections(const waiting_oracle *o, const double *x, oracle_list *out);

/* How many pairs of features wait, and how many of triangles. */
size_t waiting_oracle_features(const waiting_oracle *o);
size_t waiting_oracle_triangles(const waiting_oracle *o);
