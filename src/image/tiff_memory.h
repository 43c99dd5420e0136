/* Leaving libtiff when memory runs out; private to the room image. */
#ifndef CORCAST_IMAGE_TIFF_MEMORY_H
#define CORCAST_IMAGE_TIFF_MEMORY_H

#include "base/base.h"

typedef Status TiffWork(void *self, Err *err);

/* work(self, err), which calls libtiff. Where an allocation of libtiff's fails, `work` is left at
 * that place and *handle, the TIFF in use, becomes NULL: it is in no state to be closed, and what
 * it holds is lost. STATUS_MEMORY then, with a sentence that names `name`. */
MUST_CHECK Status tiff_guard(TiffWork *work, void *self, void **handle, const char *name, Err *err);

#endif
