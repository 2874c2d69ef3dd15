// SPDX-License-Identifier: Apache-2.0
// labels: opencl
// timeout: 120
// The host memory of the OpenCL backend; test_cl_upload.c counts the device's.
#include "kit_faults.h"
#include "support.h"

START_TEST(failed_allocation_is_reported_and_changes_no_answer)
{
    kit_fail_every_allocation(OCC_BACKEND_OPENCL, false, 5);
}
END_TEST

START_TEST(lasting_shortage_is_reported_and_changes_no_answer)
{
    kit_fail_every_allocation(OCC_BACKEND_OPENCL, true, 7);
}
END_TEST

START_TEST(frames_after_warm_up_allocate_nothing)
{
    kit_frames_allocate_nothing(OCC_BACKEND_OPENCL);
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_alloc_faults");
    TCase *faults = tcase_create("faults");
    tcase_add_test(faults, failed_allocation_is_reported_and_changes_no_answer);
    tcase_add_test(faults, lasting_shortage_is_reported_and_changes_no_answer);
    tcase_add_test(faults, frames_after_warm_up_allocate_nothing);
    suite_add_tcase(suite, faults);
    return test_run_suite(suite);
}
