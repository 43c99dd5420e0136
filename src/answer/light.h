/* Computes the shading of the surface that a beam hits: the ambient color, the color that each
 * light adds, and the faces that block the light. All are affine forms [affine.h] in the two
 * coordinates of the beam's rectangle in the picture. Private to the module answer.
 *
 * For a hit, call surface_at. For each light, call light_term. Unless is_zero, then call light_beam
 * for each point of the light. For each such beam, ground_blocks and own_solid_blocks test two
 * possible blockers; light_blockers, with the reach of surface_reach, lists the other faces, and
 * blocker_at tests one of them. light_beam_leaves is needed only for isosurface_blocks. */
#ifndef CORCAST_ANSWER_LIGHT_H
#define CORCAST_ANSWER_LIGHT_H

#include "answer/answerplan.h"

/* A linear color with a proven error. */
typedef struct FormColor {
    Form channels[3]; /* red, green, blue */
} FormColor;

/* The surface at a hit. All pointers are borrowed; the FaceHit must not be moved or changed. */
typedef struct FormSurface {
    const FaceHit *hit;
    const Finish *finish;
    Rgb pigment;
    Form3 point, normal;
    Form3 view; /* unit direction of the camera rays */
    Form keep;  /* fraction of the vessel's color that is left after fading with depth; 1 - keep is
                 * the fraction of the background's color */
    FormColor base; /* the color without any light source: ambient color plus faded background */
} FormSurface;

/* Returns the surface at a hit of the beam. */
FormSurface surface_at(const AnswerPlan *plan, const Beam *beam, const FaceHit *hit);

/* The color that a light adds to a surface if nothing blocks the light. */
typedef struct LightTerm {
    bool is_zero;    /* the light adds nothing, because all of the surface faces away from it */
    bool is_facing;  /* the cosine of the incidence angle is above LIGHT_GRAZES everywhere */
    FormColor color; /* not set if `is_zero` */
} LightTerm;

/* Cosine of the incidence angle up to which no single shadow rays are traced. There, rounding
 * errors would decide whether the surface blocks its own light, so the interval of the pixel's
 * color contains both the color with this light and the color without it. Diffuse light at this
 * angle is at most LIGHT_GRAZES times the full light, so little is lost: about one step of a 16-bit
 * color (1.5e-5). */
#define LIGHT_GRAZES 2e-5

/* Returns the color that the light with this index adds to a surface if nothing blocks it. An area
 * light shades as a point light at its location. */
LightTerm light_term(const AnswerPlan *plan, const FormSurface *surface, size_t light);

/* Returns the beam of shadow rays from a surface to point `point` of a light, 0 <= point <
 * max(LightRays.points, 1). Depth along the beam is 0 at the surface and 1 at the light; a
 * parallel light is at infinity. */
Beam light_beam(const AnswerPlan *plan, const FormSurface *surface, size_t light, int point);

/* Returns the largest difference, mm, between a coordinate of a surface point and the constant term
 * of its form. */
double surface_reach(const FormSurface *surface);
/* Lists the faces that may block a beam of light_beam, for surface points whose coordinates differ
 * by up to `reach` mm from the constant terms of surface->point. `list` must have space for all
 * faces. */
void light_blockers(const AnswerPlan *plan, const FormSurface *surface, const Beam *beam,
                    size_t light, double reach, FaceList *list);

/* A face that may block the shadow rays of a beam. A ray is blocked where all edge functions of
 * `hit` and all forms in `between` are >= 0. `blocker->hit.frame` may point into the blocker
 * itself. */
typedef struct LightBlocker {
    FaceHit hit;
    Form between[2]; /* forms that are >= 0 where the hit is between the surface and the light */
    int n_between;   /* number of forms in `between`, which has no form that is >= 0 everywhere */
} LightBlocker;
/* Computes the hit of a shadow beam with the face of this index. Returns false if the face surely
 * blocks no ray of the beam, for example because it is part of the surface's own convex solid. */
bool blocker_at(const AnswerPlan *plan, const FormSurface *surface, const Beam *beam, size_t light,
                uint32_t face, LightBlocker *blocker);
/* Returns 1 if the ground blocks all rays of the shadow beam, 0 if it blocks none, and -1 if this
 * is not decided. */
int ground_blocks(const AnswerPlan *plan, const FormSurface *surface, const Beam *beam,
                  size_t light);

/* Returns true if all rays of a shadow beam are proven to start outwards from the surface. */
bool light_beam_leaves(const FormSurface *surface, const Beam *beam);
/* Tests whether the convex solid of the surface itself blocks the rays of a shadow beam. It blocks
 * the rays that start inwards: those to the points of an area light that are behind the surface.
 * Returns 1 if all rays are blocked, 0 if none is, and -1 if this is not decided. Returns 0 for
 * segments, triangles and joints, whose solids are not convex. */
int own_solid_blocks(const FormSurface *surface, const Beam *beam);

#endif
