/* What there is to compare with: brute force, the methods as they were published, and the plan of the thesis.
 * No solver needs this header, so cscd/cscd.h does not include it. What cscd/cscd.h says of every function
 * holds here, too. */
#ifndef CSCD_RESEARCH_API_H
#define CSCD_RESEARCH_API_H

#include <cscd/detector.h>

/* Further values of cscd_method. The published ones lose contacts, so their lists promise nothing. */
#define CSCD_METHOD_BRUTE          ((cscd_method)64) /* every pair of features is tested; quadratic in time */
#define CSCD_METHOD_PUBLISHED      ((cscd_method)65) /* culling by orientation as published (Yeh 2012) */
#define CSCD_METHOD_ICCD           ((cscd_method)66) /* normal cones and contours (Tang et al. 2009), corrected */
#define CSCD_METHOD_ICCD_PUBLISHED ((cscd_method)67) /* the same as published */

/* A value of cscd_plan_options.variant. CHARGE: cuts by the published rules (Yeh 2012): densities are equalized with 256
 * bins, clusters of low density grow until they part a body, and detector points are centroids. */
#define CSCD_PLAN_VARIANT_PUBLISHED 1u

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of a method without running it. */
typedef struct cscd_method_info {
    const char *name;
    bool makes_plan;     /* cscd_plan_create makes plans by it */
    bool needs_plan;     /* a detector needs a plan that was made by it */
    bool loses_contacts; /* it follows published rules that lose contacts */
    bool available;      /* this build has it: baselines can be left out */
    bool
        by_orientation; /* culls by orientation, so it takes a plan and gains from one; AUTO: where that pays */
    bool by_contours;   /* culls by normal cones and contours */
    uint8_t reserved[2]; /* 0 */
} cscd_method_info;

/* The number of methods, those of this header included. */
CSCD_API uint32_t cscd_method_count(void);

/* The method at this place, from 0 to cscd_method_count() - 1. */
CSCD_API cscd_method cscd_method_at(uint32_t place);

/* Facts about a method; false if there is no such method, and then *out is left untouched. */
CSCD_API bool cscd_method_describe_sized(cscd_method method, cscd_method_info *out, size_t size);
static inline bool cscd_method_describe(cscd_method method, cscd_method_info *out) {
    return cscd_method_describe_sized(method, out, sizeof *out);
}

#ifdef __cplusplus
}
#endif

#endif
