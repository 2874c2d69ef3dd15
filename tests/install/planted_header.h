// SPDX-License-Identifier: Apache-2.0
// A header that does not include what it needs: the header tests must refuse it.
size_t planted_header(uint32_t number);
