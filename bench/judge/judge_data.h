// SPDX-License-Identifier: Apache-2.0
// What the parts of the judge share. All of it works in coordinates local to the eye (perspective)
// or to the camera's origin (direction): there the eye is (0, 0, 0, 1) or (toward, 0), and planes
// are (n, d) with n.x + d >= 0 inside. Everything exists twice: as nums in world units, made at
// once, and as integers in a unit of their own, made when a sign needs them.
//
// judge_camera.c makes a judge; judge_body.c turns boxes into half-spaces, judge_shadow.c these
// into shadows; judge_grow.c widens; judge_piece.c cuts polygons; judge.c and judge_single.c
// answer.
#ifndef OCC_JUDGE_DATA_H
#define OCC_JUDGE_DATA_H

#include "exact.h"
#include "judge.h"
#include "judge_num.h"

enum {
    JUDGE_CLIPS = 6,
    JUDGE_NEAR = 4,
    JUDGE_SIDES = 10,               // of a box: five slabs at most
    JUDGE_HALVES = JUDGE_SIDES + 2, // and the near and the far plane
    JUDGE_PLANES = 6 + 6 * 6,       // a shadow's, from so many half-spaces, at most
    JUDGE_EDGES = 120,              // of a piece, at most: more than that aborts
};

typedef mpz_t exact4[4];

// What kind of thing a body is. Rank 3: a solid. 2: flat, axes `pick` + 1 and `pick` + 2 span it.
// 1: a segment along axis `pick`. 0: a point.
typedef struct judge_shape {
    int rank, pick;
} judge_shape;

// A box or a triangle in local coordinates, and the half-spaces whose intersection it is: sides 2 k
// and 2 k + 1 are opposite where both are below `paired`. A triangle's axes 0 and 1 are its edges
// from corner 0, which is in the place of the center. Its sides 0 and 1 are its plane's, side 0 the
// one that is positive where the corners go counterclockwise; 2 to 4 are its edges'.
typedef struct judge_body {
    bool triangle;
    occ_box box; // of a triangle: its corners, as center, axis[0] and axis[1]
    judge_shape shape;
    int sides, paired;
    num center[3], axis[3][3];
    num side[JUDGE_SIDES][4];
    int sign[JUDGE_SIDES]; // at the eye
} judge_body;

// A shadow, as planes: half-space `one`, or the combination of `one` and `two` that vanishes at the
// eye.
typedef struct judge_shadow {
    judge_body body;
    int owner;
    bool empty;
    bool grown;          // its silhouette planes are as judge_grow() made them
    int halves, clip[2]; // beyond the sides: which clip planes
    int count;
    int one[JUDGE_PLANES], two[JUDGE_PLANES];
    num plane[JUDGE_PLANES][4];
    exact4 *exact;
    long version; // of the unit in which `exact` is
} judge_shadow;

// A plane restricted to the sheet in hand: q.(s, t, 1) >= 0.
typedef enum judge_origin { JUDGE_LITERAL, JUDGE_CLIP, JUDGE_SIDE, JUDGE_SHADOW } judge_origin;

typedef struct judge_line {
    judge_origin origin;
    int index; // of the clip plane, side, or shadow's plane
    judge_shadow *shadow;
    double literal[3];
    num q[3];
    bool exact;
    mpz_t x[3];
} judge_line;

// A convex polygon within a sheet, counterclockwise in (s, t), as the lines it was cut along: twice
// a line's number, plus 1 where its outside is kept. Vertex i is between edges i and i + 1.
typedef struct judge_piece {
    int count;
    int edge[JUDGE_EDGES];
    num vertex[JUDGE_EDGES][3];
} judge_piece;

// A part of a plane: the points o + s u + t v, homogeneous.
typedef struct judge_sheet {
    const judge_body *body;
    int clip; // the clip plane in which it is, or -1: a face of the body
    int face; // then: the axis it is at the end of
    int end;  // and which end: -1, 0 (that axis is zero or not counted) or 1
    num o[4], u[4], v[4];
    double reach; // s and t run over ±reach
    double area;  // in the world, for each unit of area in (s, t)
    bool exact;
} judge_sheet;

typedef struct judge_candidate {
    judge_shadow *shadow;
    int line; // the number of the first of its lines in the sheet in hand, or -1
} judge_candidate;

struct judge {
    bool filter;
    judge_effort effort;
    // the camera: eye = origin + from / (from_w 2^from_places); direction: toward `from`
    bool at_infinity, has_clips;
    double origin[3];
    exact3 from;
    mpz_t from_w;
    long from_places;
    exact4 clip_source[JUDGE_CLIPS]; // d: in world units
    num toward[3], reference[3], clip[JUDGE_CLIPS][4];
    // the unit, and what is in it
    long places, version;
    mpz_t unit; // how many local units one world unit is
    exact3 exact_reference;
    exact4 exact_clip[JUDGE_CLIPS];
    // occluders
    judge_shadow *shadows;
    size_t shadow_count, shadow_room;
    judge_shadow single;
    // the object in hand
    judge_body body;
    judge_sheet sheet;
    exact4 xo, xu, xv;
    judge_line *lines;
    int line_count, line_room;
    judge_candidate *candidates;
    size_t candidate_count;
    bool measuring;
    double seen_area, whole_area;
    bool has_witness;
    double witness[3];
    // scratch
    exact3 c, a[3], m, s;
    exact4 half[JUDGE_HALVES];
    mpz_t at_eye[JUDGE_HALVES], t[4];
    exact3 v;
};

// --- judge_camera.c ------------------------------------------------------------------------------

judge *judge_make(void);
// Brings the unit up to what the box needs.
void judge_admit(judge *j, const occ_box *box);
// Recomputes the camera in the unit, and as nums.
void judge_refresh(judge *j);
// An eye at a corner of a box.
judge *judge_of_corner(const occ_box *eyes, unsigned corner);

// --- judge_body.c --------------------------------------------------------------------------------

// The body in the unit, as j->c and j->a.
void judge_load(judge *j, const judge_body *body);
void judge_make_body(judge *j, judge_body *body, const occ_box *box);
// Of three corners, in floats as they are.
void judge_make_triangle(judge *j, judge_body *body, const float *a, const float *b,
                         const float *c);
// The body's sides in the unit, as j->half; leaves the body in j->c and j->a.
void judge_exact_sides(judge *j, const judge_body *body);
// The sign of a plane where it is least (-1) or greatest (1) on a body. Without `exact` NUM_UNSURE
// is an answer.
int judge_extreme_sign(judge *j, const judge_body *body, const num *plane, mpz_t *exact, int which);
// Counts, and lets the filter speak.
int judge_ask(judge *j, num value);
bool judge_holds_eye(const judge *j, const judge_body *body);

// --- judge_shadow.c ------------------------------------------------------------------------------

// Of the body that is in the shadow. The near and the far plane count where it is to be clipped.
void judge_make_shadow(judge *j, judge_shadow *shadow, bool clipped);
// Of a triangle that hides from its front alone: without a shadow unless the eye is before it.
void judge_keep_front(judge_shadow *shadow);
void judge_exact_shadow(judge *j, judge_shadow *shadow);
void judge_free_shadow(judge_shadow *shadow);

// --- judge_grow.c --------------------------------------------------------------------------------

// A silhouette plane of a shadow that has grown, as integers.
void judge_grown_plane(const judge_shadow *shadow, int p, mpz_t *out);

// --- judge_sheet.c -------------------------------------------------------------------------------

// Each makes j->sheet. A section is false if the plane has no normal.
void judge_face_sheet(judge *j, const judge_body *body, int face, int end);
void judge_thread_sheet(judge *j, const judge_body *body);
bool judge_section_sheet(judge *j, const judge_body *body, int clip);
void judge_exact_sheet(judge *j);
// The sheet in hand as a piece, cut by clip planes and, where it is a section, by the body's sides.
// False if nothing is left.
bool judge_cut_sheet(judge *j, judge_piece *piece);

// --- judge_piece.c -------------------------------------------------------------------------------

int judge_add_line(judge *j, judge_origin origin, judge_shadow *shadow, int index);
// Turns j->sheet into a piece: the square that s and t run over.
void judge_start_piece(judge *j, judge_piece *piece);
// The signs of a line at all vertices, 1 and -1 counted.
void judge_signs(judge *j, int line, const judge_piece *piece, signed char *signs, int counts[2]);
// The part of `piece` on one side (1 or -1) of a line that crosses it. `part` is not `piece`.
void judge_cut(judge *j, int line, const judge_piece *piece, const signed char *signs, int side,
               judge_piece *part);
double judge_piece_area(const judge_piece *piece);
// The mean of its vertices, rounded.
void judge_piece_middle(const judge_piece *piece, double middle[2]);

// --- judge.c -------------------------------------------------------------------------------------

// Whether the clip planes leave something of the body in hand.
bool judge_has_inside(judge *j);

#endif
