/* The public header of the module page: a tree as an HTML page, in which the user can rotate it.
 *
 * The page is a file that needs no other file. It consists of a template [templates/page/], the
 * viewer, a JavaScript program [templates/viewer/], and the tree's numbers in base64. The viewer
 * draws cylinders and spheres from the numbers. The user selects the field and the map of the
 * colors. */
#ifndef CORCAST_PAGE_PAGE_H
#define CORCAST_PAGE_PAGE_H

#include "base/base.h"
#include "derive/derive.h"
#include "image/image.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* A color map that the user can select. The owner of a PageMap frees both members. */
typedef struct PageMap {
    char *name;
    Colormap map;
} PageMap;

/* The content of a page. All members are borrowed. */
typedef struct PageParams {
    const char *templates;     /* the folder of templates */
    const char *viewer;        /* path of the viewer, a bundled script */
    const char *title;         /* name of the tree, one line */
    const char *generator;     /* program and version */
    const char *command;       /* the command line that makes the page */
    const Tree *tree;          /* its coordinates are written as floats relative to `origin` */
    Vec3 origin;               /* a point near the tree, mm, so that floats are precise */
    const FieldSeries *fields; /* fields of the tree that the user can select */
    size_t n_fields;
    const PageMap *maps;
    size_t n_maps;
    const Look *look;
    const char *look_name;   /* name of the look, as `render --look` takes it */
    bool is_look_chosen;     /* an option specifies the look; else the viewer has its own light */
    const ColorScale *scale; /* initial scale, of the field with its name; NULL: no field */
    const char *map;         /* name of the scale's map, which need not be in `maps` */
    /* Options specify the ends of the scale, or that it is logarithmic. False: the viewer selects
     * the scale by the field's values. */
    bool is_scale_chosen;
} PageParams;

/* Appends the page to `out`.
 *
 * Errors   STATUS_INPUT if a template or the viewer is missing or does not fit; STATUS_IO if a file
 *          cannot be read; STATUS_MEMORY. */
MUST_CHECK Status page_put(const PageParams *params, Text *out, Err *err);

#endif
