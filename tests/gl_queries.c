// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#define GL_GLEXT_PROTOTYPES
#include "gl_queries.h"

#include "kit.h"
#include "support.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    BATCH = 1020, // boxes in a vertex buffer, and queries under way
    MARKS = 255,  // boxes that the stencil can tell apart
};

struct gl_queries {
    EGLDisplay display;
    EGLContext context;
    GLuint framebuffer, depth, program, array, buffer, queries[BATCH];
    int width, height, subpixel_bits;
    glb_vertex *vertices;
};

// --- the context ---------------------------------------------------------------------------------

// NULL, or what is missing.
static const char *open_context(gl_queries *q)
{
    static const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                    4,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_NONE};
    q->display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (q->display == EGL_NO_DISPLAY) return "no EGL display without a surface";
    if (!eglInitialize(q->display, NULL, NULL)) return "EGL does not start";
    if (!eglBindAPI(EGL_OPENGL_API)) return "EGL has no OpenGL";
    q->context = eglCreateContext(q->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (q->context == EGL_NO_CONTEXT) return "no context of OpenGL 4.5";
    if (!eglMakeCurrent(q->display, EGL_NO_SURFACE, EGL_NO_SURFACE, q->context))
        return "the context needs a surface";
    return NULL;
}

static void close_context(gl_queries *q)
{
    if (q->display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(q->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (q->context != EGL_NO_CONTEXT) eglDestroyContext(q->display, q->context);
    eglTerminate(q->display);
}

static bool is_present(void)
{
    gl_queries q = {.width = 0};
    const char *missing = open_context(&q);
    if (missing) fprintf(stderr, "OpenGL: %s\n", missing);
    return !missing;
}

int glq_skip(void)
{
    return test_skip_unless(is_present, "OpenGL 4.5 without a window", "OCC_REQUIRE_GL");
}

const char *glq_renderer(const gl_queries *q)
{
    (void)q; // it is the current one
    return (const char *)glGetString(GL_RENDERER);
}

static void check(const gl_queries *q, const char *what)
{
    GLenum error = glGetError();
    KIT_CHECK(error == GL_NO_ERROR, "OpenGL (%s): error 0x%x after %s", glq_renderer(q), error,
              what);
}

// --- what is drawn with --------------------------------------------------------------------------

static GLuint compile(GLenum stage, const char *text)
{
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    GLint good = 0;
    char log[1000] = "";
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    KIT_CHECK(good, "OpenGL: %s", log);
    return shader;
}

static GLuint link_program(void)
{
    GLuint program = glCreateProgram();
    GLuint vertex = compile(GL_VERTEX_SHADER, "#version 450 core\n"
                                              "layout(location = 0) in vec4 corner;\n"
                                              "void main() { gl_Position = corner; }\n");
    GLuint fragment = compile(GL_FRAGMENT_SHADER, "#version 450 core\nvoid main() {}\n");
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    KIT_CHECK(good, "OpenGL: the program does not link");
    return program;
}

static void make_framebuffer(gl_queries *q)
{
    glGenRenderbuffers(1, &q->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, q->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH32F_STENCIL8, q->width, q->height);
    glGenFramebuffers(1, &q->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, q->framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              q->depth);
    glDrawBuffer(GL_NONE);
    KIT_CHECK(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "OpenGL (%s): no framebuffer of %d x %d", glq_renderer(q), q->width, q->height);
}

static void set_state(void)
{
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0.0);
    glDepthFunc(GL_GREATER);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP); // what lies in the near plane must not be cut by a rounding
    glEnable(GL_SCISSOR_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
}

gl_queries *glq_open(int width, int height)
{
    gl_queries *q = calloc(1, sizeof *q);
    ck_assert_ptr_nonnull(q);
    q->width = width + 2 * GLB_BORDER;
    q->height = height + 2 * GLB_BORDER;
    const char *missing = open_context(q);
    KIT_CHECK(!missing, "OpenGL: %s", missing);
    make_framebuffer(q);
    q->program = link_program();
    glGenVertexArrays(1, &q->array);
    glBindVertexArray(q->array);
    glGenBuffers(1, &q->buffer);
    glBindBuffer(GL_ARRAY_BUFFER, q->buffer);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(glb_vertex), NULL);
    glGenQueries(BATCH, q->queries);
    glUseProgram(q->program);
    glGetIntegerv(GL_SUBPIXEL_BITS, &q->subpixel_bits);
    set_state();
    q->vertices = malloc(sizeof *q->vertices * BATCH * GLB_MOST_VERTICES);
    ck_assert_ptr_nonnull(q->vertices);
    check(q, "its set-up");
    return q;
}

void glq_close(gl_queries *q)
{
    if (!q) return;
    glDeleteQueries(BATCH, q->queries);
    glDeleteBuffers(1, &q->buffer);
    glDeleteVertexArrays(1, &q->array);
    glDeleteProgram(q->program);
    glDeleteFramebuffers(1, &q->framebuffer);
    glDeleteRenderbuffers(1, &q->depth);
    close_context(q);
    free(q->vertices);
    free(q);
}

// --- drawing -------------------------------------------------------------------------------------

glb_camera glq_camera(const gl_queries *q, const occ_camera_desc *desc, int width, int height)
{
    ck_assert_int_le(width + 2 * GLB_BORDER, q->width);
    ck_assert_int_le(height + 2 * GLB_BORDER, q->height);
    return glb_camera_of(desc, width, height, q->subpixel_bits);
}

glq_rect glq_frustum(const glb_camera *camera, int inset)
{
    int border = GLB_BORDER + inset;
    return (glq_rect){border, border, (int)camera->pixels[0] - 2 * inset,
                      (int)camera->pixels[1] - 2 * inset};
}

static void begin(const glb_camera *camera, const glq_rect *rect)
{
    glViewport(0, 0, (int)camera->pixels[0] + 2 * GLB_BORDER,
               (int)camera->pixels[1] + 2 * GLB_BORDER);
    glScissor(rect->x, rect->y, rect->width, rect->height);
}

// Loads up to BATCH boxes into the buffer; first[i] is where the vertices of box i begin.
static void load(gl_queries *q, const glb_camera *camera, const occ_box *boxes, size_t count,
                 glb_manner manner, int first[BATCH + 1])
{
    first[0] = 0;
    for (size_t i = 0; i < count; i++)
        first[i + 1] = first[i] + glb_triangles(camera, &boxes[i], manner, q->vertices + first[i]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)sizeof *q->vertices * (first[count] + 1), q->vertices,
                 GL_STREAM_DRAW);
}

void glq_occlude(gl_queries *q, const glb_camera *camera, const glq_rect *rect,
                 const occ_box *boxes, size_t count, glb_manner manner)
{
    int first[BATCH + 1];
    begin(camera, rect);
    glDepthMask(GL_TRUE);
    glDisable(GL_STENCIL_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    for (size_t done = 0; done < count; done += BATCH) {
        size_t some = count - done < BATCH ? count - done : BATCH;
        load(q, camera, boxes + done, some, manner, first);
        glDrawArrays(GL_TRIANGLES, 0, first[some]);
    }
    check(q, "occluders");
}

// A box marks the samples where it passed: none of them counts for two of its faces.
static void count_box(GLuint query, size_t number, GLint first, GLsizei count)
{
    if (number % MARKS == 0) glClear(GL_STENCIL_BUFFER_BIT);
    glStencilFunc(GL_NOTEQUAL, (GLint)(number % MARKS) + 1, 0xff);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glDrawArrays(GL_TRIANGLES, first, count);
    glEndQuery(GL_SAMPLES_PASSED);
}

void glq_count(gl_queries *q, const glb_camera *camera, const glq_rect *rect, const occ_box *boxes,
               size_t count, glb_manner manner, uint32_t *samples)
{
    int first[BATCH + 1];
    begin(camera, rect);
    glDepthMask(GL_FALSE);
    glEnable(GL_STENCIL_TEST);
    for (size_t done = 0; done < count; done += BATCH) {
        size_t some = count - done < BATCH ? count - done : BATCH;
        load(q, camera, boxes + done, some, manner, first);
        for (size_t i = 0; i < some; i++)
            count_box(q->queries[i], i, first[i], first[i + 1] - first[i]);
        for (size_t i = 0; i < some; i++)
            glGetQueryObjectuiv(q->queries[i], GL_QUERY_RESULT, &samples[done + i]);
    }
    check(q, "queries");
}
