/* The door of the room page: a tree as one page for browsers, in which it can be turned.
 *
 * The page is a file that needs nothing else: a template, the viewer [templates/viewer/], and the
 * tree's numbers in base64, from which the viewer draws cylinders and balls. */
#ifndef CORCAST_PAGE_PAGE_H
#define CORCAST_PAGE_PAGE_H

#include "base/base.h"
#include "derive/derive.h"
#include "image/image.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* A colour map that the viewer can be switched to. */
typedef struct PageMap {
    char *name; /* owned */
    Colormap map;
} PageMap;

/* What a page shows and says; all of it borrowed. */
typedef struct PageParams {
    const char *templates;     /* the folder of templates */
    const char *viewer;        /* the viewer's file, a script */
    const char *title;         /* a line: what the tree is called */
    const char *generator;     /* program and version */
    const char *command;       /* that makes the page, one line */
    const Tree *tree;          /* coordinates are its own, written as float from `origin` on */
    Vec3 origin;               /* near the tree */
    const FieldSeries *fields; /* of the tree */
    size_t n_fields;
    const PageMap *maps;
    size_t n_maps;
    const Look *look;
    const char *look_name;   /* as `render` knows it */
    const ColorScale *scale; /* that the page opens with, of a field of that name; or NULL */
    const char *map;         /* the name of its map, which need not be among the others */
} PageParams;

/* Appends the page. STATUS_INPUT when a file of the templates or the viewer is missing or does not
 * fit, and as file_read and text_check. */
MUST_CHECK Status page_put(const PageParams *params, Text *out, Err *err);

#endif
