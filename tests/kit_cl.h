// SPDX-License-Identifier: Apache-2.0
// Every OpenCL call of the library goes through here: it may fail on demand, what it makes is
// counted, and what it sends is noted. Linked with --wrap; see occ_test_<module>_WRAP.
#ifndef OCC_TEST_KIT_CL_H
#define OCC_TEST_KIT_CL_H

#include "kit.h"

#include <occlude/opencl.h>

enum { KIT_CL_SENDS = 256 };

// A copy of rows to the device.
typedef struct kit_cl_send {
    size_t origin[3], region[3];
} kit_cl_send;

typedef struct kit_cl {
    // what is asked of it
    uint64_t fail_at; // the number of the call that fails; 0: none
    cl_int code;      // with this error
    bool no_platform; // no loader entry: -1001
    bool zero_platforms;
    bool no_device;
    bool broken_kernels; // a line that does not compile is appended to the sources
    size_t group;        // the largest work-group, if not 0
    cl_ulong largest;    // the largest buffer, if not 0
    // what it has seen
    uint64_t calls;
    const char *failed; // the call that failed
    unsigned failures;
    // contexts, queues, programs, kernels, buffers, mappings and events held, counting references
    int64_t live;
    uint64_t buffer_bytes; // of the buffers held
    unsigned created;      // of them
    unsigned in_flight;    // enqueued since the queue was last waited for
    unsigned whole;        // writes of whole buffers
    uint64_t whole_bytes;
    unsigned rows; // writes of rows
    kit_cl_send row[KIT_CL_SENDS];
} kit_cl;

extern kit_cl kit_cl_state;

// Forgets all but what is held.
void kit_cl_reset(void);

#endif
