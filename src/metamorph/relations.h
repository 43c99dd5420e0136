/* The table of metamorphic relations: changes of a scene whose effect on the picture is known. The
 * first scene of a pair is random [trial.h]. The relation changes a copy of the first scene, which
 * becomes the second scene. */
#ifndef CORCAST_METAMORPH_RELATIONS_H
#define CORCAST_METAMORPH_RELATIONS_H

#include "metamorph/adapters.h"

/* A row of the table of relations. */
typedef struct Relation {
    const char *name;   /* "translation" */
    const char *change; /* sentence for reports: the change, and the scenes to which it applies */
    unsigned formats;   /* formats that have this relation: bits 1 << TrialFormat */
    int codes;          /* allowed difference of two 8-bit codes */
    bool flips;         /* the second picture is the mirror image of the first */
    bool crops;         /* the first picture is the middle half of the second one's rows */
    unsigned kinds;     /* with `form`: the kinds of shapes that get it: bits 1 << ShapeKind */
    unsigned form; /* a ShapeForm that the change gives to shapes; 0: `apply` makes the change */
    /* Changes `scene`; NULL with `form`. Returns false if the relation does not apply to the scene;
     * the scene must not be used then. */
    bool (*apply)(TrialScene *scene, TrialFormat format, Random *random);
} Relation;

/* The table of relations. The last row has the name NULL. */
extern const Relation relations[];

/* A relation and the first scene of a pair. */
typedef struct TrialPair {
    const Relation *relation;
    TrialFormat format;
    uint64_t seed; /* seed of the random choices that the relation makes */
    TrialScene first;
} TrialPair;

/* Makes the second scene of a pair. Returns false if the relation does not apply to the first
 * scene; *second must not be used then. The same pair always gives the same scene. */
bool pair_second(const TrialPair *pair, TrialScene *second);

/* Returns true if the relation multiplies all lengths by a power of two. */
bool relation_scales(const Relation *relation);
/* Multiplies all lengths of the scene, including those of the camera and lights, by 2^k. */
void scene_scale(TrialScene *scene, int k);

#endif
