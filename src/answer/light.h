/* The color of a surface in a beam: forms of its ambient light, of what each light adds, and of the
 * faces that block the light. */
#ifndef CORCAST_ANSWER_LIGHT_H
#define CORCAST_ANSWER_LIGHT_H

#include "answer/answerplan.h"

/* A color with a proven error. */
typedef struct FormColor {
    Form channels[3];
} FormColor;

/* The surface at a hit. */
typedef struct FormSurface {
    const FaceHit *hit;
    const Finish *finish;
    Rgb pigment;
    Form3 point, normal;
    Form3 view;     /* unit, of the camera's rays */
    Form keep;      /* the fraction of the vessel's color that fading leaves */
    FormColor base; /* the light that no lamp sends: ambient light and fading */
} FormSurface;

FormSurface surface_at(const AnswerPlan *plan, const Beam *beam, const FaceHit *hit);

/* What a light adds to a surface if nothing blocks it. */
typedef struct Lit {
    bool dark;  /* nothing: the surface faces away */
    bool faces; /* all of the surface faces the light by more than LIGHT_GRAZES */
    FormColor adds;
} Lit;

/* Where the cosine is below this, shadows are not looked for: the light, which is at most this
 * bright there, may be blocked or not. Rounding errors would decide. */
#define LIGHT_GRAZES 2e-5

Lit light_at(const AnswerPlan *plan, const FormSurface *surface, size_t light);

/* The rays from a surface to point `point` of a light. */
Beam light_beam(const AnswerPlan *plan, const FormSurface *surface, size_t light, int point);
/* Computes the hit of a blocker in a light beam. Returns false if the face surely blocks no ray.
 * The hit has up to two more edges, which say that it lies between surface and light. */
typedef struct LightBlocker {
    FaceHit hit;
    Form between[2];
    int pending; /* number of these edges that may be negative */
} LightBlocker;
bool blocker_at(const AnswerPlan *plan, const FormSurface *surface, const Beam *beam, size_t light,
                uint32_t face, LightBlocker *blocker);
/* Returns 1 if the ground blocks all rays to the point of the light, 0 if none, -1 if it may. */
int ground_blocks(const AnswerPlan *plan, const FormSurface *surface, const Beam *beam,
                  size_t light);

/* Renderers do not look for blockers within SHADOW_FROM_MM of a surface. A ray that leaves its own
 * solid within that path, whose length is at least 2 radius cosine, may be blocked or not. */
#define SHADOW_FROM_MM 1.01e-3

/* Returns the same of the solid that the surface belongs to, which blocks the rays that begin
 * inwards: those to points of a light behind the surface, of which other points are before it. */
int own_solid_blocks(const FormSurface *surface, const Beam *beam);

#endif
