/* Methods to compare with: brute force, published methods, and the plan of the thesis. No solver needs
 * this header, so cscd/cscd.h does not include it; what that says of every function holds here, too. */
#ifndef CSCD_RESEARCH_API_H
#define CSCD_RESEARCH_API_H

#include <cscd/detector.h>

/* Further values of cscd_method. The published ones lose contacts, report some that do not exist, and promise
 * nothing. */
#define CSCD_METHOD_BRUTE          ((cscd_method)64) /* every pair of features is tested; quadratic in time */
#define CSCD_METHOD_PUBLISHED      ((cscd_method)65) /* the whole pipeline as published (Yeh 2012) */
#define CSCD_METHOD_ICCD           ((cscd_method)66) /* normal cones and contours (Tang et al. 2009), corrected */
#define CSCD_METHOD_ICCD_PUBLISHED ((cscd_method)67) /* the same as published */
#define CSCD_METHOD_CONES                                                                                    \
    ((cscd_method)68) /* normal cones and star-shaped contours (Wang et al. 2017), proven */

/* PUBLISHED makes plans by section 3 of the thesis (docs/theory/thesis.md). cscd_plan_options.ours, a sum of
 * these, takes single steps from CHARGE instead. */
#define CSCD_OURS_CHARGE 1u /* the charge by charge_solver */
#define CSCD_OURS_RANKS  2u /* densities become ranks */
#define CSCD_OURS_CUTS   4u /* regions by what their points see; needs CSCD_OURS_RANKS */
#define CSCD_OURS_POINTS 8u /* points where they see the most; needs CSCD_OURS_CUTS */

/* PUBLISHED, with any plan, and ICCD_PUBLISHED run by chapters 4 and 5.1 (docs/theory/thesis.md), on one
 * thread; with a distance to keep they search as NONE. cscd_detector_create fails with SYSTEM_ERROR without
 * libcscd-baselines, unless CSCD_OURS_TESTS is set. cscd_detector_options.ours, a sum of these, takes single
 * steps from CHARGE instead. */
#define CSCD_OURS_MOTION 16u /* detector points move with their regions */
#define CSCD_OURS_STARTS 32u /* the start is proven, and what is not clean is not culled */
#define CSCD_OURS_REPRESENTATIVES                                                                            \
    64u                           /* features are tested by the first pair of triangles that is looked at */
#define CSCD_OURS_NEIGHBOURS 128u /* adjacent triangles are tested */
#define CSCD_OURS_TESTS      256u /* elementary tests are exact */
#define CSCD_OURS_BOXES      512u /* boxes in place of 14-DOPs */

#ifdef __cplusplus
extern "C" {
#endif

/* Returns how a triangle faced the detector point of its region during the whole last step: 1, away (S+); -1,
 * towards it (S-); 0, neither. It is also 0 if the triangle was not clean at the start, or if a list answered
 * (cscd_coherence) and it may change. Without meaning after a failed step. */
CSCD_API int cscd_detector_orientation(const cscd_detector *detector, uint32_t triangle);

/* Writes where the detector point of a region was at the start and the end of the last step, up to rounding,
 * and returns true; without meaning before the first step and after a failed one. Returns false and writes
 * nothing if the detector does not cull by this region: the regions are those of its plan, or else the
 * components, and with a distance to keep there are none. */
CSCD_API bool cscd_detector_region_point(const cscd_detector *detector, uint32_t region, double p0[3],
                                         double p1[3]);

/* Facts about a method. */
typedef struct cscd_method_info {
    const char *name;
    bool makes_plan;     /* cscd_plan_create makes plans by it */
    bool needs_plan;     /* a detector needs a plan that was made by it */
    bool loses_contacts; /* it follows published rules that lose contacts */
    bool available;      /* this build has it: baselines can be left out */
    bool by_orientation; /* culls by orientation, so a plan makes it faster; AUTO: where that pays */
    bool by_contours;    /* culls by normal cones and contours */
    bool by_charge;      /* its plans have the charge of each triangle */
    uint8_t reserved[1]; /* 0 */
} cscd_method_info;

/* Writes facts about a method. Returns false and leaves *out untouched if there is no such method. */
CSCD_API bool cscd_method_describe(cscd_method method, cscd_method_info *out);

#ifdef __cplusplus
}
#endif

#endif
