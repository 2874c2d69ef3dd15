// SPDX-License-Identifier: Apache-2.0
#include "image_context.h"

#include <EGL/eglext.h>
#include <stddef.h>

enum { MOST_DEVICES = 16 };

// NULL, or what this display lacks.
static const char *open_on(EGLDisplay display, image_context *out)
{
    static const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                    4,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_NONE};
    if (display == EGL_NO_DISPLAY) return "EGL has no display without a window";
    if (!eglInitialize(display, NULL, NULL)) return "EGL does not start without a window";
    *out = (image_context){display, EGL_NO_CONTEXT};
    const char *missing = NULL;
    if (!eglBindAPI(EGL_OPENGL_API))
        missing = "EGL has no OpenGL";
    else if ((out->context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT,
                                              wanted)) == EGL_NO_CONTEXT)
        missing = "EGL has no context of OpenGL 4.5";
    else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, out->context))
        missing = "OpenGL needs a window here";
    if (missing) image_context_close(out);
    return missing;
}

// The devices that EGL knows; none where it cannot be asked.
static EGLint list_devices(EGLDeviceEXT devices[MOST_DEVICES])
{
    EGLint count = 0;
    PFNEGLQUERYDEVICESEXTPROC query =
        (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    if (!query || !query(MOST_DEVICES, devices, &count)) return 0;
    return count;
}

const char *image_context_open(image_context *out)
{
    EGLDeviceEXT devices[MOST_DEVICES];
    EGLint count = list_devices(devices);
    *out = (image_context){EGL_NO_DISPLAY, EGL_NO_CONTEXT};
    for (EGLint i = 0; i < count; i++) {
        EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
        if (!open_on(display, out)) return NULL;
    }
    return open_on(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL),
                   out);
}

void image_context_close(image_context *c)
{
    if (c->display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (c->context != EGL_NO_CONTEXT) eglDestroyContext(c->display, c->context);
    eglTerminate(c->display);
    *c = (image_context){EGL_NO_DISPLAY, EGL_NO_CONTEXT};
}
