/* The sizes of the structs that callers fill, as they were first released: no caller has smaller ones. Made by
 * make freeze-api, which leaves the rows of released versions as they are. */
#pragma once

#include <stddef.h>

#define STRUCT_THROUGH(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))
#define LEAST_SIZE(type)             LEAST_##type

#define LEAST_cscd_context_options      STRUCT_THROUGH(cscd_context_options, reason_size)
#define LEAST_cscd_object_desc          STRUCT_THROUGH(cscd_object_desc, normal)
#define LEAST_cscd_detector_options     STRUCT_THROUGH(cscd_detector_options, ours)
#define LEAST_cscd_energy_options       STRUCT_THROUGH(cscd_energy_options, slip)
#define LEAST_cscd_event_options        STRUCT_THROUGH(cscd_event_options, max_memory)
#define LEAST_cscd_object_change        STRUCT_THROUGH(cscd_object_change, triangle_origins)
#define LEAST_cscd_plan_options         STRUCT_THROUGH(cscd_plan_options, growing)
#define LEAST_cscd_plan_parts           STRUCT_THROUGH(cscd_plan_parts, origin)
#define LEAST_cscd_sensor_options       STRUCT_THROUGH(cscd_sensor_options, seed)
#define LEAST_cscd_response_options     STRUCT_THROUGH(cscd_response_options, friction)
#define LEAST_cscd_intersection_options STRUCT_THROUGH(cscd_intersection_options, max_work)
#define LEAST_cscd_untangle_options     STRUCT_THROUGH(cscd_untangle_options, max_seconds)
