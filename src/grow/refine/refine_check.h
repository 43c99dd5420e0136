/* Which trees can be refined. */
#ifndef CORCAST_GROW_REFINE_CHECK_H
#define CORCAST_GROW_REFINE_CHECK_H

#include "grow/grow.h"

/* STATUS_USAGE or STATUS_INPUT with a sentence that says what refine_tree does not accept. */
MUST_CHECK Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree,
                               Err *err);

#endif
