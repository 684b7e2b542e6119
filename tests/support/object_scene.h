/* Scenes of several objects with random rules, and what rules mean, told without the library. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/oracle.h"
#include "tests/support/random_stream.h"
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
