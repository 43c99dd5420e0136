/* How much of a beam towards the sky vessels leave free. */
#ifndef CORCAST_RENDER_BEAMS_H
#define CORCAST_RENDER_BEAMS_H

#include "base/base.h"
#include "scene/scene.h"

/* Capsules that stand together, as one direction sees them: x and y across it, z along it, mm.
 * A capsule of no radius, below everything, fills up the last of a tile. */
enum { CAPSULES = 16 };
typedef struct CapsuleBlock {
    float x[CAPSULES], y[CAPSULES], z[CAPSULES]; /* one end */
    float ux[CAPSULES], uy[CAPSULES];            /* unit, across the view, towards the other */
    float length[CAPSULES], slope[CAPSULES];     /* across the view, and rise of z with it */
    float radius[CAPSULES];
    float round[CAPSULES]; /* what its ends add to it where a beam is wider than it is */
} CapsuleBlock;

/* One of them. */
typedef struct SeenCapsule {
    float x, y, z, ux, uy, length, slope, radius, round;
    float low[2], high[2]; /* of x and y where it, or a beam that begins there, is touched */
} SeenCapsule;

/* The vessels as one direction sees them: tiles across it, each with blocks of the capsules that a
 * beam in it may touch. */
typedef struct BeamView {
    float axes[3][3]; /* across, across, and towards the sky */
    float left, top, per_tile;
    int columns, rows;
    SeenCapsule *seen; /* owned, as all that follows; of each capsule */
    uint32_t *first;   /* blocks of tile i are [first[i], first[i + 1]) */
    CapsuleBlock *blocks;
    uint32_t *taken; /* capsules of each tile */
    Status status;   /* of making it, for the user */
    size_t seen_capacity, tiles_capacity, taken_capacity, blocks_capacity;
} BeamView;

/* The capsules of a geometry, which stand for its vessels in any model. */
typedef struct Beams {
    struct Capsule *capsules; /* owned */
    size_t n;
    BeamView *views; /* owned; of so many directions, made by the user */
    int room,
        kept;    /* how many there are; and of how many directions they are all the views, or 0 */
    Vec3 origin; /* the middle of the geometry; places are relative to it */
    float wide;  /* mm: half of what a beam is wide at most */
    int tiles;   /* on a side of a view */
} Beams;

/* Lists the capsules of a geometry. O(n). STATUS_MEMORY. */
MUST_CHECK Status beams_new(const Geometry *geometry, Beams *beams, Err *err);
void beams_release(Beams *beams);

/* Of `n` directions, evenly spread over the sphere, number k: unit. */
Vec3 beams_direction(int n, int k);

/* Makes room in beams->views for those of `n` directions, or for fewer, in *room, but at least for
 * each thread one, where they would take more than 256 MB. STATUS_MEMORY. */
MUST_CHECK Status beams_make_room(Beams *beams, int n, int threads, int *room, Err *err);

/* Makes the view of a direction, in what is zeroed or has held another view of these capsules.
 * O(n). STATUS_MEMORY. */
MUST_CHECK Status beamview_make(const Beams *beams, Vec3 direction, BeamView *view, Err *err);

#endif
