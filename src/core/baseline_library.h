/* Opens libcscd-baselines, which holds the methods that cscd is compared with, and which needs LAPACKE,
 * OpenBLAS and GSL. Nothing links it; the first call that needs it opens it. Libraries of two builds may
 * meet. So they share only functions that are looked up by their names, and numbered interfaces that these
 * functions hand out: structs of functions whose headers count their changes. */
#pragma once

#include "src/core/context.h"

/* Returns the functions of an interface, or NULL for one that the library does not know. */
typedef const void *baseline_entry(uint32_t interface);

/* Writes the functions that the library hands out under this name. SYSTEM_ERROR: there is no library, or it is of another version;
 * OUT_OF_MEMORY: a limit of the address space leaves no room for it. The sentence begins with `what`, who asks: "charge: the dense
 * solver". */
cscd_status baseline_library_find(cscd_context *context, const char *entry_name, uint32_t interface,
                                  const char *what, const void **out);
