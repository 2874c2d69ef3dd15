// SPDX-License-Identifier: Apache-2.0
// How fuzz targets read their input: bytes, and then zeros without end.
#ifndef OCC_FUZZ_BYTES_H
#define OCC_FUZZ_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What must hold for every input. A failure is a crash, which libFuzzer keeps the input of.
#define FUZZ_CHECK(condition)                                                                      \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                        \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct fuzz_bytes {
    const uint8_t *data;
    size_t left;
} fuzz_bytes;

static inline bool fuzz_same_bits(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

static inline void fuzz_take(fuzz_bytes *from, void *to, size_t size)
{
    size_t there = size < from->left ? size : from->left;
    memset(to, 0, size);
    if (there) memcpy(to, from->data, there);
    if (there) from->data += there;
    from->left -= there;
}

static inline uint8_t fuzz_byte(fuzz_bytes *from)
{
    uint8_t byte;
    fuzz_take(from, &byte, sizeof byte);
    return byte;
}

// Any float: NaN, infinities and denormals as well.
static inline float fuzz_float(fuzz_bytes *from)
{
    float value;
    fuzz_take(from, &value, sizeof value);
    return value;
}

static inline double fuzz_double(fuzz_bytes *from)
{
    double value;
    fuzz_take(from, &value, sizeof value);
    return value;
}

#endif
