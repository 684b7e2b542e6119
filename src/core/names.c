/* The names of the enumerations of the public API, and facts about each method that are known without running it. */
#include "src/core/names.h"

#include "cscd/cscd.h"

#include <string.h>

/* ---- methods ------------------------------------------------------------------------------------------- */

static const method_traits traits[] = {
    {CSCD_METHOD_AUTO, .name = "auto", .by_orientation = true},
    {CSCD_METHOD_NONE, .name = "none"},
    {CSCD_METHOD_BRUTE, .name = "brute"},
    {CSCD_METHOD_SINGLE, .name = "single", .makes_plan = true, .by_orientation = true},
    {CSCD_METHOD_KMEANS, .name = "kmeans", .makes_plan = true, .needs_plan = true, .by_orientation = true},
    {CSCD_METHOD_CHARGE, .name = "charge", .makes_plan = true, .by_charge = true, .needs_plan = true,
     .by_orientation = true},
    {CSCD_METHOD_PUBLISHED, .name = "published", .makes_plan = true, .by_charge = true,
     .loses_contacts = true, .by_orientation = true},
    {CSCD_METHOD_ICCD, .name = "iccd", .by_contours = true},
    {CSCD_METHOD_ICCD_PUBLISHED, .name = "iccd-published", .loses_contacts = true, .by_contours = true},
    {CSCD_METHOD_CONES, .name = "cones", .by_contours = true},
};

enum { METHOD_COUNT = sizeof traits / sizeof *traits };

const method_traits *method_traits_of(cscd_method method) {
    for (int i = 0; i < METHOD_COUNT; i++) {
        if (traits[i].method == method) return &traits[i];
    }
    return NULL;
}

const method_traits *method_traits_named(const char *name) {
    for (int i = 0; i < METHOD_COUNT; i++) {
        if (strcmp(traits[i].name, name) == 0) return &traits[i];
    }
    return NULL;
}

/* ---- status and version -------------------------------------------------------------------------------- */

#define STRING(x)        #x
#define VERSION(a, b, c) STRING(a) "." STRING(b) "." STRING(c)

const char *cscd_version_string(void) {
    return VERSION(CSCD_VERSION_MAJOR, CSCD_VERSION_MINOR, CSCD_VERSION_PATCH);
}

const char *cscd_status_string(cscd_status status) {
    switch (status) {
    case CSCD_OK:
        return "ok";
    case CSCD_OUT_OF_MEMORY:
        return "out of memory";
    case CSCD_INVALID_ARGUMENT:
        return "invalid argument";
    case CSCD_INVALID_MESH:
        return "invalid mesh";
    case CSCD_SYSTEM_ERROR:
        return "the system refused a resource";
    case CSCD_CANCELLED:
        return "cancelled";
    case CSCD_IN_CONTACT:
        return "in contact at the start";
    case CSCD_BUSY:
        return "busy: a call with this context is running, perhaps the one that this callback belongs to";
    case CSCD_NULL_OBJECT:
        return "an object that the call needs is NULL";
    case CSCD_LIST_TOO_LONG:
        return "the list is longer than the caller allows";
    default:
        return "unknown status";
    }
}

/* ---- names ----------------------------------------------------------------------------------------------- */

static const char *const simds[] = {"auto", "scalar", "avx2", "avx512", "neon"};
static const char *const volumes[] = {"box", "kdop14"};
static const char *const modes[] = {"all", "earliest"};
static const char *const contact_kinds[] = {"vf", "ee", "tt", "vv", "ev", "vh"};
static const char *const intersection_kinds[] = {"crossing", "coplanar", "folded", "duplicate", "touching"};
static const char *const left_outs[] = {"pairs",    "curves", "patches", "overlaps",
                                        "cut-offs", "depths", "parts"};
static const char *const curve_ends[] = {"none", "vertex", "border", "junction", "left out"};
static const char *const lens_reasons[] = {"buried",       "inside out", "looks out",
                                           "smaller side", "edge",       "flush"};
static const char *const reasons[] = {
    [CSCD_REASON_METHOD] = "every pair of features whose volumes overlap is tested",
    [CSCD_REASON_SURFACE] = "open, non-manifold or inconsistently oriented",
    [CSCD_REASON_CROSSING] = "crosses or touches itself at the start; culled where it does not",
    [CSCD_REASON_UNPROVEN] = "not known to be free of self-contact at the start; culled where it is",
    [CSCD_REASON_CLEAN] = "embedded at the start, and no contact",
    [CSCD_REASON_FINISHED] = "embedded at the start; all contacts found",
    [CSCD_REASON_PUBLISHED] = "culled as published, which loses contacts",
    [CSCD_REASON_CONTOUR] = "pairs in patches that cannot touch themselves are left out; all contacts found",
    [CSCD_REASON_EARLIEST] = "only the earliest are listed; later contacts may be missing",
    [CSCD_REASON_OBSTACLE] = "an obstacle; contacts with itself are not looked for",
    [CSCD_REASON_MASK] = "masked by its rule; contacts with itself are not looked for",
    [CSCD_REASON_COLLAPSED] = "collapsed at an end; contacts with itself are not looked for"};

#define NAMES(array)                                                                                         \
    { array, sizeof(array) / sizeof *(array) }

/* All but those of methods, which are not numbered one after the other. */
static const struct name_list {
    const char *const *names;
    uint32_t count;
} lists[] = {[CSCD_SIMDS] = NAMES(simds),
             [CSCD_METHODS] = {NULL, 0},
             [CSCD_MODES] = NAMES(modes),
             [CSCD_VOLUMES] = NAMES(volumes),
             [CSCD_REASONS] = NAMES(reasons),
             [CSCD_CONTACT_KINDS] = NAMES(contact_kinds),
             [CSCD_INTERSECTION_KINDS] = NAMES(intersection_kinds),
             [CSCD_LEFT_OUTS] = NAMES(left_outs),
             [CSCD_CURVE_ENDS] = NAMES(curve_ends),
             [CSCD_LENS_REASONS] = NAMES(lens_reasons)};

static struct name_list list_of(cscd_enumeration of) {
    const bool known = (unsigned)of < sizeof lists / sizeof *lists;
    return known ? lists[of] : (struct name_list){NULL, 0};
}

const char *cscd_name(cscd_enumeration of, uint32_t value) {
    const struct name_list list = list_of(of);
    const method_traits *method = of == CSCD_METHODS ? method_traits_of((cscd_method)value) : NULL;
    if (method != NULL) return method->name;
    return value < list.count ? list.names[value] : "unknown";
}

bool cscd_from_name(cscd_enumeration of, const char *name, uint32_t *out) {
    if (name == NULL) return false;
    if (of == CSCD_METHODS) {
        const method_traits *method = method_traits_named(name);
        if (method != NULL) *out = method->method;
        return method != NULL;
    }
    const struct name_list list = list_of(of);
    for (uint32_t i = 0; i < list.count; i++) {
        if (strcmp(list.names[i], name) != 0) continue;
        *out = i;
        return true;
    }
    return false;
}
