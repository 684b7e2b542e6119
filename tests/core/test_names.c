/* Names of enumerators: those of values that a later version may have are "unknown"; and the list of methods. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/test.h"

#include <string.h>

TEST(names_of_unknown_values) {
    static const int values[] = {77, -1, 0x7fffffff, 1000};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        int value = values[i];
        assert_string_equal(cscd_status_string((cscd_status)value), "unknown status");
        assert_string_equal(cscd_name(CSCD_SIMDS, (cscd_simd)value), "unknown");
        assert_string_equal(cscd_method_name((cscd_method)value), "unknown");
        assert_string_equal(cscd_name(CSCD_MODES, (cscd_mode)value), "unknown");
        assert_string_equal(cscd_name(CSCD_VOLUMES, (cscd_volume)value), "unknown");
        assert_string_equal(cscd_contact_kind_name((cscd_contact_kind)value), "unknown");
        assert_string_equal(cscd_reason_text((cscd_reason)value), "unknown");
    }
}

/* Every reason has a sentence of its own, which says whether contacts are all found. */
TEST(reasons_say_what_they_mean) {
    static const struct {
        cscd_reason reason;
        const char *words;
    } reasons[] = {
        {CSCD_REASON_METHOD, "every pair of features"},
        {CSCD_REASON_SURFACE, "open, non-manifold"},
        {CSCD_REASON_CROSSING, "crosses or touches itself"},
        {CSCD_REASON_UNPROVEN, "not known to be free"},
        {CSCD_REASON_CLEAN, "no contact"},
        {CSCD_REASON_FINISHED, "embedded at the start; all contacts found"},
        {CSCD_REASON_PUBLISHED, "loses contacts"},
        {CSCD_REASON_CONTOUR, "patches that cannot touch themselves"},
        {CSCD_REASON_EARLIEST, "only the earliest"},
        {CSCD_REASON_OBSTACLE, "an obstacle"},
        {CSCD_REASON_MASK, "masked by its rule"},
        {CSCD_REASON_COLLAPSED, "collapsed at an end"},
    };
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
        assert_non_null(strstr(cscd_reason_text(reasons[i].reason), reasons[i].words));
}

/* "unknown" is no name that a function reads. */
TEST(unknown_is_not_read) {
    cscd_method method = CSCD_METHOD_SINGLE;
    cscd_mode mode = CSCD_MODE_EARLIEST;
    cscd_volume volume = CSCD_VOLUME_KDOP14;
    cscd_simd simd = CSCD_SIMD_SCALAR;
    assert_false(cscd_from_name(CSCD_METHODS, "unknown", (uint32_t *)&method) ||
                 cscd_from_name(CSCD_MODES, "unknown", (uint32_t *)&mode) ||
                 cscd_from_name(CSCD_VOLUMES, "unknown", (uint32_t *)&volume) ||
                 cscd_from_name(CSCD_SIMDS, "unknown", (uint32_t *)&simd));
    assert_true(method == CSCD_METHOD_SINGLE && mode == CSCD_MODE_EARLIEST && volume == CSCD_VOLUME_KDOP14 &&
                simd == CSCD_SIMD_SCALAR);
}

TEST(methods_are_described) {
    static const cscd_method methods[] = {
        CSCD_METHOD_AUTO,           CSCD_METHOD_NONE,  CSCD_METHOD_SINGLE,    CSCD_METHOD_KMEANS,
        CSCD_METHOD_CHARGE,         CSCD_METHOD_BRUTE, CSCD_METHOD_PUBLISHED, CSCD_METHOD_ICCD,
        CSCD_METHOD_ICCD_PUBLISHED, CSCD_METHOD_CONES};
    uint32_t plan_makers = 0;
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        const cscd_method method = methods[i];
        cscd_method read = CSCD_METHOD_MAX_ENUM;
        cscd_method_info info;
        assert_true(cscd_method_describe(method, &info));
        assert_string_equal(info.name, cscd_method_name(method));
        assert_true(cscd_from_name(CSCD_METHODS, info.name, (uint32_t *)&read));
        assert_int_equal(read, method);
        assert_false(info.needs_plan && !info.makes_plan);
        assert_false(info.by_orientation && info.by_contours);
        assert_int_equal(info.loses_contacts, strstr(info.name, "published") != NULL);
        assert_int_equal(info.by_contours, strstr(info.name, "iccd") != NULL || method == CSCD_METHOD_CONES);
        plan_makers += info.makes_plan;
        assert_int_equal(info.by_charge, method == CSCD_METHOD_CHARGE || method == CSCD_METHOD_PUBLISHED);
    }
    assert_int_equal(plan_makers, 4);
}

TEST(other_methods_are_refused) {
    cscd_method_info info, before;
    memset(&info, 0xa5, sizeof info);
    before = info;
    assert_false(cscd_method_describe((cscd_method)77, &info));
    assert_memory_equal(&info, &before, sizeof info);
}
