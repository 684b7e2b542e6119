/* The names of the enumerations of the public API. */
#include "cscd/cscd.h"

#include <string.h>

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

const char *cscd_contact_kind_name(cscd_contact_kind kind) {
    switch (kind) {
    case CSCD_CONTACT_VF:
        return "vf";
    case CSCD_CONTACT_EE:
        return "ee";
    case CSCD_CONTACT_TT:
        return "tt";
    case CSCD_CONTACT_VV:
        return "vv";
    case CSCD_CONTACT_EV:
        return "ev";
    case CSCD_CONTACT_VH:
        return "vh";
    default:
        return "unknown";
    }
}

static const char *const volume_names[] = {[CSCD_VOLUME_BOX] = "box", [CSCD_VOLUME_KDOP14] = "kdop14"};
static const char *const mode_names[] = {[CSCD_MODE_ALL] = "all", [CSCD_MODE_EARLIEST] = "earliest"};
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

static const char *name_at(const char *const *names, size_t count, size_t i) {
    return i < count ? names[i] : "unknown";
}

/* Returns count if no name is equal. */
static size_t find_name(const char *const *names, size_t count, const char *name) {
    size_t i = 0;
    while (name != NULL && i < count && strcmp(names[i], name) != 0) i++;
    return name != NULL ? i : count;
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

const char *cscd_volume_name(cscd_volume volume) {
    return name_at(volume_names, COUNT(volume_names), (size_t)volume);
}

bool cscd_volume_from_name(const char *name, cscd_volume *out) {
    size_t i = find_name(volume_names, COUNT(volume_names), name);
    if (i == COUNT(volume_names)) return false;
    *out = (cscd_volume)i;
    return true;
}

const char *cscd_mode_name(cscd_mode mode) {
    return name_at(mode_names, COUNT(mode_names), (size_t)mode);
}

bool cscd_mode_from_name(const char *name, cscd_mode *out) {
    size_t i = find_name(mode_names, COUNT(mode_names), name);
    if (i == COUNT(mode_names)) return false;
    *out = (cscd_mode)i;
    return true;
}

const char *cscd_reason_text(cscd_reason reason) {
    return name_at(reasons, COUNT(reasons), (size_t)reason);
}
