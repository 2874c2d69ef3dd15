// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include "image_gl.h"

#include "image_context.h"
#include "timing.h"

#include <GL/glcorearb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The attachments of the framebuffer.
enum { FRONT, VEIL, LAYERS };

// The vertex array's inputs: a corner's position, and the first place of the object being drawn.
enum { POSITION, FIRST, INPUTS };

struct image_gl {
    image_context context;
    const image_parts *parts;
    GLsizei width, height;
    GLuint framebuffer, layers[LAYERS], depth;
    GLuint program, array, buffers[INPUTS], corners;
    GLuint clock; // a query
};

static bool complain(const char *what)
{
    fprintf(stderr, "occlude-bench: OpenGL: %s\n", what);
    return false;
}

static bool check(const char *what)
{
    GLenum error = glGetError();
    if (error == GL_NO_ERROR) return true;
    fprintf(stderr, "occlude-bench: OpenGL: error 0x%x %s\n", error, what);
    return false;
}

// --- what is drawn with --------------------------------------------------------------------------

// A corner is carried into clip space in double and rounded once: pictures are to differ by what
// was left out, not by how a matrix far from the origin rounds.
static const char vertex_text[] = "#version 450 core\n"
                                  "layout(location = 0) in vec3 position;\n"
                                  "layout(location = 1) in uint first;\n"
                                  "layout(location = 0) uniform dmat4 camera;\n"
                                  "flat out uint object_first;\n"
                                  "invariant gl_Position;\n"
                                  "void main()\n"
                                  "{\n"
                                  "    gl_Position = vec4(camera * dvec4(position, 1));\n"
                                  "    object_first = first;\n"
                                  "}\n";

// In see-through draws `place` is not the triangle's own, but it is nobody else's.
// Veils are combined by exclusive or; stirring the number first (in a way that can be undone, so
// that none becomes 0 or another's) keeps small numbers from cancelling.
static const char fragment_text[] = "#version 450 core\n"
                                    "flat in uint object_first;\n"
                                    "layout(location = 0) out uint front;\n"
                                    "layout(location = 1) out uint veil;\n"
                                    "void main()\n"
                                    "{\n"
                                    "    uint place = object_first + uint(gl_PrimitiveID);\n"
                                    "    front = place + 1u;\n"
                                    "    veil = front * 0x9e3779b1u;\n"
                                    "    veil = (veil ^ veil >> 15) * 0x85ebca77u;\n"
                                    "}\n";

static GLuint compile(GLenum stage, const char *text)
{
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    return shader;
}

static bool make_program(image_gl *gl)
{
    GLuint vertex = compile(GL_VERTEX_SHADER, vertex_text);
    GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_text);
    gl->program = glCreateProgram();
    glAttachShader(gl->program, vertex);
    glAttachShader(gl->program, fragment);
    glLinkProgram(gl->program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint good = 0;
    char log[1000] = "";
    glGetProgramiv(gl->program, GL_LINK_STATUS, &good);
    glGetProgramInfoLog(gl->program, sizeof log, NULL, log);
    if (!good) return complain(log);
    glUseProgram(gl->program);
    return true;
}

static bool make_framebuffer(image_gl *gl)
{
    static const GLenum targets[LAYERS] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glCreateRenderbuffers(LAYERS, gl->layers);
    glCreateRenderbuffers(1, &gl->depth);
    glCreateFramebuffers(1, &gl->framebuffer);
    for (int i = 0; i < LAYERS; i++) {
        glNamedRenderbufferStorage(gl->layers[i], GL_R32UI, gl->width, gl->height);
        glNamedFramebufferRenderbuffer(gl->framebuffer, targets[i], GL_RENDERBUFFER, gl->layers[i]);
    }
    glNamedRenderbufferStorage(gl->depth, GL_DEPTH_COMPONENT32F, gl->width, gl->height);
    glNamedFramebufferRenderbuffer(gl->framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                   gl->depth);
    glNamedFramebufferDrawBuffers(gl->framebuffer, LAYERS, targets);
    if (!check("at a framebuffer of this size")) return false;
    if (glCheckNamedFramebufferStatus(gl->framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return complain("no framebuffer of this size");
    glBindFramebuffer(GL_FRAMEBUFFER, gl->framebuffer);
    glViewport(0, 0, gl->width, gl->height);
    return true;
}

static bool make_buffers(image_gl *gl)
{
    const image_parts *p = gl->parts;
    glCreateBuffers(INPUTS, gl->buffers);
    glCreateBuffers(1, &gl->corners);
    glCreateVertexArrays(1, &gl->array);
    glNamedBufferStorage(gl->buffers[POSITION],
                         (GLsizeiptr)((p->vertex_count + (size_t)1) * sizeof *p->positions), NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(gl->buffers[POSITION], 0,
                         (GLsizeiptr)(p->vertex_count * sizeof *p->positions), p->positions);
    glNamedBufferStorage(gl->buffers[FIRST],
                         (GLsizeiptr)((p->object_count + (size_t)1) * sizeof *p->first), p->first,
                         0);
    glNamedBufferStorage(gl->corners,
                         (GLsizeiptr)((p->triangle_count + (size_t)1) * sizeof *p->corners), NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(gl->corners, 0, (GLsizeiptr)(p->triangle_count * sizeof *p->corners),
                         p->corners);
    glVertexArrayVertexBuffer(gl->array, POSITION, gl->buffers[POSITION], 0, sizeof *p->positions);
    glVertexArrayAttribFormat(gl->array, POSITION, 3, GL_FLOAT, GL_FALSE, 0);
    // The second one goes on with the instance: an object is drawn as the instance of its number.
    glVertexArrayVertexBuffer(gl->array, FIRST, gl->buffers[FIRST], 0, sizeof *p->first);
    glVertexArrayAttribIFormat(gl->array, FIRST, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayBindingDivisor(gl->array, FIRST, 1);
    glVertexArrayElementBuffer(gl->array, gl->corners);
    for (GLuint i = 0; i < INPUTS; i++) {
        glVertexArrayAttribBinding(gl->array, i, i);
        glEnableVertexArrayAttrib(gl->array, i);
    }
    glBindVertexArray(gl->array);
    return check("where the model is copied");
}

static void set_state(bool one_sided)
{
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER); // of equal depths the first that is drawn shows
    glDisable(GL_DITHER);
    glLogicOp(GL_XOR);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    if (one_sided) glEnable(GL_CULL_FACE);
}

image_gl *image_gl_open(const image_parts *parts, const image_gl_options *options)
{
    image_gl *gl = calloc(1, sizeof *gl);
    if (!gl) {
        complain("not enough memory");
        return NULL;
    }
    gl->parts = parts;
    gl->width = (GLsizei)options->width;
    gl->height = (GLsizei)options->height;
    const char *missing = image_context_open(&gl->context);
    bool good =
        missing ? complain(missing) : make_framebuffer(gl) && make_buffers(gl) && make_program(gl);
    if (good) {
        glCreateQueries(GL_TIME_ELAPSED, 1, &gl->clock);
        set_state(options->one_sided);
        good = check("in setting up");
    }
    if (good) return gl;
    image_gl_close(gl);
    return NULL;
}

void image_gl_close(image_gl *gl)
{
    if (!gl) return;
    image_context_close(&gl->context); // and with it all that is in it
    free(gl);
}

const char *image_gl_renderer(const image_gl *gl)
{
    (void)gl; // it is the current one
    return (const char *)glGetString(GL_RENDERER);
}

// --- drawing -------------------------------------------------------------------------------------

static void clear(void)
{
    static const GLuint nothing[4] = {0};
    static const GLfloat far[1] = {0};
    for (GLint i = 0; i < LAYERS; i++) {
        glColorMaski((GLuint)i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glClearBufferuiv(GL_COLOR, i, nothing);
    }
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, far);
}

// Opaque triangles write the front and the depth; see-through ones add to the veil.
static void set_layer(int layer)
{
    bool is_front = layer == FRONT;
    for (GLuint i = 0; i < LAYERS; i++)
        glColorMaski(i, (int)i == layer, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(is_front);
    (is_front ? glDisable : glEnable)(GL_COLOR_LOGIC_OP);
}

static void draw_places(const image_gl *gl, uint32_t object, uint32_t first, uint32_t end)
{
    uintptr_t offset = first * sizeof *gl->parts->corners;
    const void *place; // OpenGL takes an offset for a pointer
    memcpy(&place, &offset, sizeof place);
    glDrawElementsInstancedBaseInstance(GL_TRIANGLES, (GLsizei)(3 * (end - first)), GL_UNSIGNED_INT,
                                        place, 1, object);
}

static void draw_fronts(const image_gl *gl, const uint32_t *objects, size_t count, image_pass *pass)
{
    const image_parts *p = gl->parts;
    set_layer(FRONT);
    for (size_t i = 0; i < count; i++) {
        uint32_t first = p->first[objects[i]], end = p->see_through[objects[i]];
        if (first == end) continue;
        draw_places(gl, objects[i], first, end);
        pass->draws++;
        pass->triangles += end - first;
    }
}

static void draw_veils(const image_gl *gl, const uint32_t *objects, size_t count, image_pass *pass)
{
    const image_parts *p = gl->parts;
    if (p->see_through_count == 0) return;
    set_layer(VEIL);
    for (size_t i = 0; i < count; i++) {
        uint32_t first = p->see_through[objects[i]], end = p->first[objects[i] + 1];
        if (first == end) continue;
        draw_places(gl, objects[i], first, end);
        pass->draws++;
        pass->triangles += end - first;
    }
}

bool image_gl_draw(image_gl *gl, const double clip[16], const uint32_t *objects, size_t count,
                   image_pass *pass)
{
    *pass = (image_pass){0};
    clear();
    glFinish(); // what came before is not this picture's
    double start = timing_now();
    glBeginQuery(GL_TIME_ELAPSED, gl->clock);
    glUniformMatrix4dv(0, 1, GL_FALSE, clip);
    draw_fronts(gl, objects, count, pass);
    draw_veils(gl, objects, count, pass);
    glEndQuery(GL_TIME_ELAPSED);
    pass->cpu_ms = timing_now() - start;
    glFinish();
    pass->whole_ms = timing_now() - start;
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(gl->clock, GL_QUERY_RESULT, &nanoseconds);
    pass->gpu_ms = 1e-6 * (double)nanoseconds;
    return check("in drawing");
}

static bool read_layer(const image_gl *gl, GLenum layer, uint32_t *pixels)
{
    glReadBuffer(GL_COLOR_ATTACHMENT0 + layer);
    glReadPixels(0, 0, gl->width, gl->height, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels);
    return check("in reading a picture");
}

bool image_gl_read(image_gl *gl, uint32_t *front, uint32_t *veil)
{
    return read_layer(gl, FRONT, front) && read_layer(gl, VEIL, veil);
}

bool image_gl_veil(image_gl *gl, uint32_t object, uint32_t *veil)
{
    static const GLuint nothing[4] = {0};
    image_pass pass = {0};
    set_layer(VEIL);
    glClearBufferuiv(GL_COLOR, VEIL, nothing);
    draw_veils(gl, &object, 1, &pass);
    return read_layer(gl, VEIL, veil);
}
