/* Relations: changes of a scene whose effect on the picture is known. */
#ifndef CORCAST_METAMORPH_RELATIONS_H
#define CORCAST_METAMORPH_RELATIONS_H

#include "metamorph/adapters.h"

/* A row of the table of relations. */
typedef struct Relation {
    const char *name;   /* "translation" */
    const char *change; /* how the second scene is made, and when, for reports */
    unsigned formats;   /* formats that have this relation: bits 1 << TrialFormat */
    int codes;          /* difference of 8-bit codes that is allowed */
    bool flips;         /* the second picture is the mirror image of the first */
    bool crops;         /* the first picture is the middle half of the second one's rows */
    /* Changes `scene`. Returns false if the relation makes no promise about the scene. */
    bool (*apply)(TrialScene *scene, TrialFormat format, Random *random);
} Relation;

/* The table; a row without a name ends it. */
extern const Relation relations[];

/* A relation and the first scene of a pair. */
typedef struct TrialPair {
    const Relation *relation;
    TrialFormat format;
    uint64_t seed; /* of the choices that the relation makes */
    TrialScene first;
} TrialPair;

/* Makes the second scene. Returns false if the relation makes no promise about the first scene. */
bool pair_second(const TrialPair *pair, TrialScene *second);

/* Returns true if the relation multiplies all lengths by a power of two. */
bool relation_scales(const Relation *relation);
/* Multiplies all lengths of the scene by 2^k. */
void scene_scale(TrialScene *scene, int k);

#endif
