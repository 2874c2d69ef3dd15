// SPDX-License-Identifier: Apache-2.0
// One public header, alone, as C or C++; the build names it.
#include OCC_HEADER

extern int occ_header_stands_alone;
