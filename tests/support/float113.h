/* Floats of 113 bits: an own type of compilers for x86, and what long double is on other 64-bit processors. */
#pragma once

#include <float.h>

#if LDBL_MANT_DIG == 113
typedef long double float113;
#else
typedef __float128 float113;
#endif
