/* The equations of the charge by a dense system, which libcscd-baselines solves. */
#pragma once

#include "preprocess/charge/charge_solution.h"

/* SYSTEM_ERROR: there is no libcscd-baselines, or one of another version. */
cscd_status dense_charges_find(cscd_context *context, charge_solution *out);
