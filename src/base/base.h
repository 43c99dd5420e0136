/* The public header of the module base: status codes, memory, text, files, numbers, random numbers,
 * threads and small data structures. All other modules use base; base uses no other module. */
#ifndef CORCAST_BASE_BASE_H
#define CORCAST_BASE_BASE_H

#include "base/array.h"      // IWYU pragma: export
#include "base/clock.h"      // IWYU pragma: export
#include "base/elementary.h" // IWYU pragma: export
#include "base/file.h"       // IWYU pragma: export
#include "base/fileset.h"    // IWYU pragma: export
#include "base/firstfail.h"  // IWYU pragma: export
#include "base/hash.h"       // IWYU pragma: export
#include "base/heap.h"       // IWYU pragma: export
#include "base/ini.h"        // IWYU pragma: export
#include "base/isolated.h"   // IWYU pragma: export
#include "base/json.h"       // IWYU pragma: export
#include "base/keymap.h"     // IWYU pragma: export
#include "base/lists.h"      // IWYU pragma: export
#include "base/logcurve.h"   // IWYU pragma: export
#include "base/memory.h"     // IWYU pragma: export
#include "base/number.h"     // IWYU pragma: export
#include "base/random.h"     // IWYU pragma: export
#include "base/range.h"      // IWYU pragma: export
#include "base/readable.h"   // IWYU pragma: export
#include "base/sets.h"       // IWYU pragma: export
#include "base/slab.h"       // IWYU pragma: export
#include "base/sort.h"       // IWYU pragma: export
#include "base/status.h"     // IWYU pragma: export
#include "base/suggest.h"    // IWYU pragma: export
#include "base/system.h"     // IWYU pragma: export
#include "base/text.h"       // IWYU pragma: export
#include "base/threads.h"    // IWYU pragma: export
#include "base/units.h"      // IWYU pragma: export
#include "base/version.h"    // IWYU pragma: export

#endif
