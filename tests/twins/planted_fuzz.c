// SPDX-License-Identifier: Apache-2.0
// A reader that believes the length in its input, for libFuzzer and AddressSanitizer to find.

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || data[0] != 'O' || data[1] != 'B') {
        return 0;
    }
    volatile unsigned sum = 0;
    for (size_t i = 0; i < data[2]; i++) {
        sum = sum + data[i]; // reads past the end where data[2] > size
    }
    return 0;
}
