/* The old names of IndexLists [base/lists.h]. */
#ifndef CORCAST_SCENE_NUMBERLISTS_H
#define CORCAST_SCENE_NUMBERLISTS_H

#include "base/base.h"

#define NumberLists IndexLists
#define numberlists_release indexlists_release
#define numberlists_hold indexlists_hold

#endif
