// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "commands.h"
#include "options.h"
#include "picture_surface.h"

#include <stdio.h>
#include <string.h>

// Colours that most colour-blind eyes tell apart (Okabe and Ito 2008), and a grey.
const canvas_color picture_colors[PICTURE_VERDICTS] = {
    {196, 200, 206}, {227, 119, 51}, {184, 84, 150}, {42, 164, 120}};
const canvas_color picture_occluder_color = {38, 98, 178};
const canvas_color picture_culprit_color = {240, 206, 40};
const canvas_color picture_ink = {32, 36, 44};
const canvas_color picture_paper = {255, 255, 255};

static const canvas_color picture_margin = {241, 242, 244};

typedef struct picture_arguments {
    const char *scene, *out, *frame_text, *size_text, *method, *object_text;
    const char *model;
    picture_wish wish;
    options_extent extent;
    division_options division;
    picture_surface surface;
} picture_arguments;

static const char picture_usage[] =
    "usage: occlude-bench picture F.obs --frame K --out P.png [options]\n"
    "\n"
    "Draws what was decided in a frame, from above and from the camera: the visible objects, the\n"
    "hidden ones, those outside the frustum, and the occluders that were used.\n"
    "\n"
    "  --frame K     which frame of the file, from 0 (default 0)\n"
    "  --out P.png   where to\n"
    "  --method M    single (default), or fused, which tells apart what one occluder hides and "
    "what\n"
    "                several hide together\n"
    "  --explain N   show which occluders hide object N, and of the other hidden objects none; "
    "print\n"
    "                its fate and these occluders, by their places in the file, nearest first\n"
    "  --vis R.vis   take the verdicts from this file (of occlude-bench cull) instead of deciding\n"
    "  --size WxH    of the picture (default 1600x672)\n"
    "  --model MODEL draw the camera's view with the triangles of the model that the scene was\n"
    "                converted from, and over them the file's sheets and boxes; --triangles,\n"
    "                --split, --up and --see-through as they were given to convert\n"
    "  --bounds      with --model: draw the boxes around the visible objects too\n"
    "\n"
    "Boxes are drawn: objects are what lies inside them. From above nothing is buried under\n"
    "anything, whatever its height; what is very large is drawn pale.\n"
    "\n"
    "Example: occlude-bench picture city.obs --frame 20 --method fused --out city.png\n";

// What was told about a model. Returns 0, or 2 after a complaint.
static int complete_model(const char *command, picture_arguments *arguments)
{
    const division_options defaults = division_defaults();
    division_options *dividing = &arguments->division;
    bool told = dividing->most || dividing->split || dividing->up || dividing->see_through;
    if (!arguments->model && (told || arguments->surface.bounds))
        return options_complain(
            command, "--triangles, --split, --up, --see-through and --bounds go with --model");
    if (arguments->model && arguments->wish.explain)
        return options_complain(command, "--explain goes without --model");
    if (!dividing->most) dividing->most = defaults.most;
    if (!dividing->split) dividing->split = defaults.split;
    const char *complaint = division_complete(dividing);
    return complaint ? options_complain(command, complaint) : 0;
}

// The numbers and names among the options. Returns 0, or 2 after a complaint.
static int read_options(const char *command, picture_arguments *arguments)
{
    const options_extent least = {800, 400};
    picture_wish *wish = &arguments->wish;
    uint64_t frame = 0, object = 0;
    if (arguments->frame_text && !options_number(arguments->frame_text, 0, UINT32_MAX, &frame))
        return options_complain(command, "expected a number from 0 after --frame");
    if (arguments->object_text && !options_number(arguments->object_text, 0, UINT32_MAX, &object))
        return options_complain(command, "expected a number from 0 after --explain");
    if (arguments->method && strcmp(arguments->method, "single") != 0 &&
        strcmp(arguments->method, "fused") != 0)
        return options_complain(command, "expected single or fused after --method");
    if (wish->vis_path && (arguments->method || arguments->object_text))
        return options_complain(command, "--vis goes with neither --method nor --explain");
    if (arguments->size_text &&
        !options_size(arguments->size_text, least, 4096, &arguments->extent))
        return options_complain(command, "expected WxH after --size, from 800x400 to 4096x4096");
    wish->frame = (uint32_t)frame;
    wish->object = (uint32_t)object;
    wish->explain = arguments->object_text != NULL;
    wish->fused = arguments->method && strcmp(arguments->method, "fused") == 0;
    return 0;
}

// Returns 0, 2 after a complaint, or OPTIONS_HELP.
static int parse_picture(int argc, char **argv, picture_arguments *arguments)
{
    *arguments = (picture_arguments){.extent = {1600, 672}};
    const options_entry entries[] = {
        {"--frame", OPTIONS_TEXT, &arguments->frame_text},
        {"--out", OPTIONS_TEXT, &arguments->out},
        {"--vis", OPTIONS_TEXT, &arguments->wish.vis_path},
        {"--method", OPTIONS_TEXT, &arguments->method},
        {"--explain", OPTIONS_TEXT, &arguments->object_text},
        {"--size", OPTIONS_TEXT, &arguments->size_text},
        {"--model", OPTIONS_TEXT, &arguments->model},
        {"--triangles", OPTIONS_COUNT, &arguments->division.most},
        {"--split", OPTIONS_TEXT, &arguments->division.split},
        {"--up", OPTIONS_TEXT, &arguments->division.up},
        {"--see-through", OPTIONS_TEXT, &arguments->division.see_through},
        {"--bounds", OPTIONS_FLAG, &arguments->surface.bounds},
        {NULL, OPTIONS_FLAG, NULL}};
    int status = options_parse_scene(argc, argv, entries, &arguments->scene);
    if (status) return status;
    if (!arguments->out) return options_complain(argv[0], "expected --out P.png");
    status = read_options(argv[0], arguments);
    return status ? status : complete_model(argv[0], arguments);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// 1234567 as 1,234,567.
static const char *grouped(uint64_t number, char out[32])
{
    char digits[32];
    int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)number), place = 0;
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0) out[place++] = ',';
        out[place++] = digits[i];
    }
    out[place] = '\0';
    return out;
}

// Distances are thought for a picture 1600 pixels wide and grow with it.
static int scaled(const canvas *c, double pixels)
{
    return (int)(pixels * c->width / 1600);
}

static int dot_size(const canvas *c)
{
    return scaled(c, 2) > 0 ? scaled(c, 2) : 1;
}

static uint32_t hidden_of(const picture_facts *facts)
{
    return facts->counts[PICTURE_HIDDEN] + facts->counts[PICTURE_TOGETHER];
}

static void draw_title(canvas *c, const picture_arguments *arguments, const picture_facts *facts)
{
    char text[240], hidden[32], inside[32];
    uint32_t in_frustum = facts->counts[PICTURE_VISIBLE] + hidden_of(facts);
    double share = in_frustum ? 100.0 * hidden_of(facts) / in_frustum : 0;
    snprintf(text, sizeof text,
             "%.60s, frame %u of %u: %s of %s objects in the frustum are hidden (%.1f %%)",
             base_name(arguments->scene), (unsigned)arguments->wish.frame,
             facts->scene->frame_count, grouped(hidden_of(facts), hidden),
             grouped(in_frustum, inside), share);
    canvas_text(c, scaled(c, 16), scaled(c, 12), dot_size(c), picture_ink, text);
}

// Returns where the next one goes.
static int draw_key(canvas *c, int x, int y, canvas_color color, const char *label)
{
    canvas_rect swatch = {x, y - scaled(c, 2), scaled(c, 18), scaled(c, 18)};
    canvas_fill(c, swatch, color);
    canvas_frame(c, swatch, CANVAS_FINE, picture_ink);
    canvas_text(c, x + scaled(c, 26), y, dot_size(c), picture_ink, label);
    return x + scaled(c, 56) + canvas_text_width(label, dot_size(c));
}

static void draw_legend(canvas *c, int y, const picture_facts *facts)
{
    const struct {
        picture_verdict verdict;
        const char *text;
    } keys[PICTURE_VERDICTS] = {
        {PICTURE_VISIBLE, "visible"},
        {PICTURE_HIDDEN, facts->fused ? "hidden by one" : "hidden, not drawn"},
        {PICTURE_TOGETHER, "hidden by several together"},
        {PICTURE_OUTSIDE, "outside the frustum"}};
    char label[128], number[32], all[32];
    int x = scaled(c, 16);
    for (int i = 0; i < PICTURE_VERDICTS; i++) {
        if (keys[i].verdict == PICTURE_TOGETHER && !facts->fused) continue;
        snprintf(label, sizeof label, "%s %s", grouped(facts->counts[keys[i].verdict], number),
                 keys[i].text);
        x = draw_key(c, x, y, picture_colors[keys[i].verdict], label);
    }
    if (facts->explained) {
        snprintf(label, sizeof label, "%zu that hide object %u", facts->culprit_count,
                 (unsigned)facts->object);
        draw_key(c, x, y, picture_culprit_color, label);
        return;
    }
    if (!facts->used_known) return;
    snprintf(label, sizeof label, "%s of %s occluders used", grouped(facts->used_count, number),
             grouped(obs_occluder_total(facts->scene), all));
    draw_key(c, x, y, picture_occluder_color, label);
}

// What the camera's view shows, in the line above it.
static void draw_camera_caption(canvas *c, int x, int y, const picture_arguments *arguments,
                                const picture_facts *facts)
{
    const obs_scene *scene = facts->scene;
    char text[96], number[32];
    if (!arguments->model) {
        canvas_text(c, x, y, dot_size(c), picture_ink,
                    facts->explained
                        ? "from the camera: the object, striped, shines through what hides it"
                        : "from the camera: hidden objects, striped, shine through what hides "
                          "them");
        return;
    }
    snprintf(text, sizeof text, "from the camera: %s triangles",
             grouped(arguments->surface.model.triangle_count, number));
    canvas_text(c, x, y, dot_size(c), picture_ink, text);
    x += canvas_text_width(text, dot_size(c)) + scaled(c, 30);
    snprintf(text, sizeof text, "%s sheets", grouped(scene->sheet_count, number));
    x = draw_key(c, x, y, picture_sheet_color, text);
    snprintf(text, sizeof text, "%s inner boxes", grouped(scene->occluder_count, number));
    x = draw_key(c, x, y, picture_inner_color, text);
    if (arguments->surface.bounds) draw_key(c, x, y, picture_colors[PICTURE_VISIBLE], "bounds");
}

// Both panels have one height; the map is square, and the other as wide as the camera sees.
static void place_panels(const canvas *c, const obs_frame *frame, canvas_rect *map,
                         canvas_rect *camera)
{
    int margin = scaled(c, 16), top = scaled(c, 68), bottom = scaled(c, 46);
    float aspect = frame->proj[0] != 0.0f ? frame->proj[5] / frame->proj[0] : 1.0f;
    if (!(aspect > 0.2f && aspect < 5.0f)) aspect = 16.0f / 9.0f;
    int height = c->height - top - bottom;
    int widest = (int)((float)(c->width - 3 * margin) / (1.0f + aspect));
    if (height > widest) height = widest;
    *map = (canvas_rect){margin, top, height, height};
    *camera = (canvas_rect){2 * margin + height, top, (int)((float)height * aspect), height};
}

static bool draw_all(canvas *c, const picture_arguments *arguments, const picture_facts *facts)
{
    canvas_rect map, camera;
    char caption[96];
    place_panels(c, facts->frame, &map, &camera);
    bool good = picture_draw_map(c, map, facts, caption, sizeof caption) &&
                (arguments->model ? picture_draw_surface(c, camera, facts, &arguments->surface)
                                  : picture_draw_camera(c, camera, facts));
    if (!good) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    int y = map.y - scaled(c, 22);
    canvas_text(c, map.x, y, dot_size(c), picture_ink, caption);
    draw_camera_caption(c, camera.x, y, arguments, facts);
    canvas_frame(c, map, CANVAS_FINE, picture_ink);
    canvas_frame(c, camera, CANVAS_FINE, picture_ink);
    draw_title(c, arguments, facts);
    draw_legend(c, map.y + map.height + scaled(c, 20), facts);
    return true;
}

static bool draw_picture(const picture_arguments *arguments, const picture_facts *facts)
{
    canvas c;
    if (!canvas_create(&c, (int)arguments->extent.width, (int)arguments->extent.height,
                       picture_margin)) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    bool good = draw_all(&c, arguments, facts) && canvas_write_png(&c, arguments->out);
    canvas_free(&c);
    return good;
}

static void print_facts(const picture_wish *wish, const picture_facts *facts)
{
    static const char *const fates[PICTURE_VERDICTS] = {"outside", "hidden", "hidden", "visible"};
    printf("frame=%u objects=%u visible=%u hidden=%u outside=%u occluders_used=%zu", wish->frame,
           facts->scene->object_count, facts->counts[PICTURE_VISIBLE], hidden_of(facts),
           facts->counts[PICTURE_OUTSIDE], facts->used_count);
    if (facts->fused) printf(" together=%u", facts->counts[PICTURE_TOGETHER]);
    putchar('\n');
    if (!facts->explained) return;
    printf("object=%u fate=%s occluders=", facts->object, fates[facts->verdicts[facts->object]]);
    for (size_t i = 0; i < facts->culprit_count; i++)
        printf("%s%u", i ? "," : "", facts->culprits[i]);
    puts(facts->culprit_count ? "" : "none");
}

static bool picture_of(picture_arguments *arguments, const obs_scene *scene)
{
    picture_facts facts;
    const picture_wish *wish = &arguments->wish;
    if (wish->frame >= scene->frame_count) {
        fprintf(stderr, "occlude-bench: %s: no frame %u among %u\n", arguments->scene, wish->frame,
                scene->frame_count);
        return false;
    }
    if (wish->explain && wish->object >= scene->object_count) {
        fprintf(stderr, "occlude-bench: %s: no object %u among %u\n", arguments->scene,
                wish->object, scene->object_count);
        return false;
    }
    const picture_files files = {arguments->scene, arguments->model};
    if (files.model &&
        !picture_surface_read(files, &arguments->division, scene, &arguments->surface))
        return false;
    bool decided = picture_decide(scene, wish, &facts);
    bool good = decided && draw_picture(arguments, &facts);
    if (good) print_facts(wish, &facts);
    if (decided) picture_facts_free(&facts);
    picture_surface_free(&arguments->surface);
    return good;
}

int bench_picture(int argc, char **argv)
{
    picture_arguments arguments;
    int status = parse_picture(argc, argv, &arguments);
    if (status == OPTIONS_HELP) return fputs(picture_usage, stdout) < 0;
    if (status != 0) return status;
    obs_scene scene;
    if (!obs_read(arguments.scene, &scene)) return 1;
    bool good = picture_of(&arguments, &scene);
    obs_free(&scene);
    return good ? 0 : 1;
}
