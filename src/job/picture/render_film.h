/* The pictures of one command, drawn and written band by band. */
#ifndef CORCAST_JOB_PICTURE_RENDER_FILM_H
#define CORCAST_JOB_PICTURE_RENDER_FILM_H

#include "job/picture/animation.h"
#include "job/picture/frames.h"
#include "job/picture/shard.h"
#include "render/render.h"

/* What is drawn, and how. */
typedef struct Film {
    AnimationSubject subject;
    const Animation *animation;
    const RenderParams *params;
    const Parsed *parsed;
    bool resume, part; /* what is there is kept; a note says what the picture is */
    Shard shard;       /* of each picture; its hash is still to be made */
    double memory_mb;  /* of a band */
} Film;

/* Rows of a band so that it takes about `memory_mb`, or less. `params` NULL: pixels share no light;
 * `view` NULL: no light of an area. */
int film_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                   double memory_mb);

/* Draws one picture of the film by a renderer of the scene's geometry. STATUS_MEMORY, STATUS_IO. */
MUST_CHECK Status film_draw_one(const Film *film, Renderer *renderer, const Scene *scene,
                                const FramesForm *form, Err *err);

/* Draws all pictures of the animation, but those that are there if the film is resumed; the form
 * is that of all. *stats gets the sums. */
MUST_CHECK Status film_draw(const Film *film, const FramesForm *form, RenderStats *stats, Err *err);

#endif
