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
    AT_ONCE = 51, // queries before a flush
};

// Into which the nearest occluders, those of another owner, and objects are drawn.
enum { NEAREST, SECOND, OBJECTS, TARGETS };

struct gl_queries {
    EGLDisplay display;
    EGLContext context;
    GLuint framebuffers[TARGETS], programs[TARGETS], depths[2], owners, stencil;
    GLuint array, buffer, queries[BATCH];
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

static const char vertex_text[] = "#version 450 core\n"
                                  "layout(location = 0) in vec4 corner;\n"
                                  "layout(location = 1) in uint number;\n"
                                  "flat out uint who;\n"
                                  "void main() { gl_Position = corner; who = number; }\n";

// Texture 0 is the nearest occluder's number, 1 its depth, 2 the depth of the second one.
#define FRAGMENT(outputs, body)                                                                    \
    "#version 450 core\n"                                                                          \
    "layout(binding = 0) uniform usampler2D owners;\n"                                             \
    "layout(binding = 1) uniform sampler2D nearest;\n"                                             \
    "layout(binding = 2) uniform sampler2D second;\n"                                              \
    "flat in uint who;\n" outputs "void main() {\n"                                                \
    "    ivec2 at = ivec2(gl_FragCoord.xy);\n" body "}\n"

static const char *const fragment_texts[TARGETS] = {
    FRAGMENT("out uint owner;\n", "    owner = who;\n"),
    FRAGMENT("", "    uint first = texelFetch(owners, at, 0).r;\n"
                 "    if (first == who && who != 0xffffffffu) discard;\n"),
    FRAGMENT("", "    bool own = texelFetch(owners, at, 0).r == who;\n"
                 "    float limit = texelFetch(nearest, at, 0).r;\n"
                 "    if (own) limit = texelFetch(second, at, 0).r;\n"
                 "    if (!(gl_FragCoord.z > limit)) discard;\n"),
};

static GLuint link_program(const char *fragment_text)
{
    GLuint program = glCreateProgram();
    GLuint vertex = compile(GL_VERTEX_SHADER, vertex_text);
    GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_text);
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

static GLuint make_texture(const gl_queries *q, GLuint unit, GLenum format)
{
    GLuint texture;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, q->width, q->height);
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTextureUnit(unit, texture);
    return texture;
}

static void make_framebuffers(gl_queries *q)
{
    q->owners = make_texture(q, 0, GL_R32UI);
    q->depths[NEAREST] = make_texture(q, 1, GL_DEPTH_COMPONENT32F);
    q->depths[SECOND] = make_texture(q, 2, GL_DEPTH_COMPONENT32F);
    glCreateRenderbuffers(1, &q->stencil);
    glNamedRenderbufferStorage(q->stencil, GL_DEPTH24_STENCIL8, q->width, q->height);
    glCreateFramebuffers(TARGETS, q->framebuffers);
    for (int i = 0; i < TARGETS; i++) {
        GLuint f = q->framebuffers[i];
        glNamedFramebufferDrawBuffer(f, i == NEAREST ? GL_COLOR_ATTACHMENT0 : GL_NONE);
        if (i == NEAREST) glNamedFramebufferTexture(f, GL_COLOR_ATTACHMENT0, q->owners, 0);
        if (i != OBJECTS) glNamedFramebufferTexture(f, GL_DEPTH_ATTACHMENT, q->depths[i], 0);
        if (i == OBJECTS)
            glNamedFramebufferRenderbuffer(f, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                                           q->stencil);
        KIT_CHECK(glCheckNamedFramebufferStatus(f, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
                  "OpenGL (%s): no framebuffer of %d x %d", glq_renderer(q), q->width, q->height);
    }
}

static void make_buffer(gl_queries *q)
{
    glGenVertexArrays(1, &q->array);
    glBindVertexArray(q->array);
    glGenBuffers(1, &q->buffer);
    glBindBuffer(GL_ARRAY_BUFFER, q->buffer);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(glb_vertex), NULL);
    q->vertices = malloc(sizeof *q->vertices * BATCH * GLB_MOST_VERTICES);
    ck_assert_ptr_nonnull(q->vertices);
}

static void set_state(void)
{
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(GL_GREATER);
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
    make_framebuffers(q);
    make_buffer(q);
    for (int i = 0; i < TARGETS; i++)
        q->programs[i] = link_program(fragment_texts[i]);
    glGenQueries(BATCH, q->queries);
    glGetIntegerv(GL_SUBPIXEL_BITS, &q->subpixel_bits);
    set_state();
    check(q, "its set-up");
    return q;
}

void glq_close(gl_queries *q)
{
    if (!q) return;
    glDeleteQueries(BATCH, q->queries);
    glDeleteBuffers(1, &q->buffer);
    glDeleteVertexArrays(1, &q->array);
    for (int i = 0; i < TARGETS; i++)
        glDeleteProgram(q->programs[i]);
    glDeleteFramebuffers(TARGETS, q->framebuffers);
    glDeleteRenderbuffers(1, &q->stencil);
    glDeleteTextures(2, q->depths);
    glDeleteTextures(1, &q->owners);
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

static void begin(const gl_queries *q, int target, const glb_camera *camera, const glq_rect *rect)
{
    static const GLfloat none[] = {0};
    static const GLuint nobody[] = {GLQ_NOBODY};
    glTextureBarrier();
    glBindFramebuffer(GL_FRAMEBUFFER, q->framebuffers[target]);
    glUseProgram(q->programs[target]);
    glViewport(0, 0, (int)camera->pixels[0] + 2 * GLB_BORDER,
               (int)camera->pixels[1] + 2 * GLB_BORDER);
    glScissor(rect->x, rect->y, rect->width, rect->height);
    (target == OBJECTS ? glDisable : glEnable)(GL_DEPTH_TEST);
    (target == OBJECTS ? glEnable : glDisable)(GL_STENCIL_TEST);
    if (target != OBJECTS) glClearBufferfv(GL_DEPTH, 0, none);
    if (target == NEAREST) glClearBufferuiv(GL_COLOR, 0, nobody);
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

static void occlude(gl_queries *q, const occ_box *boxes, const uint32_t *owners, size_t count,
                    const glb_camera *camera, glb_manner manner)
{
    int first[BATCH + 1];
    for (size_t done = 0; done < count; done += BATCH) {
        size_t some = count - done < BATCH ? count - done : BATCH;
        load(q, camera, boxes + done, some, manner, first);
        for (size_t i = 0; i < some; i++) {
            if (first[i + 1] == first[i]) continue;
            glVertexAttribI1ui(1, owners ? owners[done + i] : GLQ_NOBODY);
            glDrawArrays(GL_TRIANGLES, first[i], first[i + 1] - first[i]);
        }
    }
}

void glq_occlude(gl_queries *q, const glb_camera *camera, const glq_rect *rect,
                 const occ_box *boxes, const uint32_t *owners, size_t count, glb_manner manner)
{
    begin(q, NEAREST, camera, rect);
    occlude(q, boxes, owners, count, camera, manner);
    begin(q, SECOND, camera, rect);
    if (owners) occlude(q, boxes, owners, count, camera, manner);
    check(q, "occluders");
}

// A box marks the samples where it passed: none of them counts for two of its faces.
// llvmpipe miscounts (Mesa 22.3) where the commands of a query do not fit into what it holds of a
// frame, which a flush empties.
static void count_box(GLuint query, size_t mark, uint32_t number, GLint first, GLsizei count)
{
    static const GLint none[] = {0};
    if (mark % AT_ONCE == 0) glFlush();
    if (mark % MARKS == 0) glClearBufferiv(GL_STENCIL, 0, none);
    if (count == 0) return;
    glVertexAttribI1ui(1, number);
    glStencilFunc(GL_NOTEQUAL, (GLint)(mark % MARKS) + 1, 0xff);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glDrawArrays(GL_TRIANGLES, first, count);
    glEndQuery(GL_SAMPLES_PASSED);
}

void glq_count(gl_queries *q, const glb_camera *camera, const glq_rect *rect, const occ_box *boxes,
               const uint32_t *numbers, size_t count, glb_manner manner, uint32_t *samples)
{
    int first[BATCH + 1];
    begin(q, OBJECTS, camera, rect);
    for (size_t done = 0; done < count; done += BATCH) {
        size_t some = count - done < BATCH ? count - done : BATCH;
        load(q, camera, boxes + done, some, manner, first);
        for (size_t i = 0; i < some; i++)
            count_box(q->queries[i], i, numbers ? numbers[done + i] : (uint32_t)(done + i),
                      first[i], first[i + 1] - first[i]);
        for (size_t i = 0; i < some; i++) {
            samples[done + i] = 0;
            if (first[i + 1] > first[i])
                glGetQueryObjectuiv(q->queries[i], GL_QUERY_RESULT, &samples[done + i]);
        }
    }
    check(q, "queries");
}
