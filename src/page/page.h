/* The public header of the module page: writes a tree as an HTML page in which the user can rotate
 * the tree.
 *
 * The page is one file that needs no other file. It has three parts: a template [templates/page/];
 * the viewer, which is a JavaScript program [templates/viewer/]; and the numbers of the tree in
 * base64. The viewer draws cylinders and spheres from the numbers. The user selects the field that
 * is shown and the color map. */
#ifndef CORCAST_PAGE_PAGE_H
#define CORCAST_PAGE_PAGE_H

#include "base/base.h"
#include "derive/derive.h"
#include "image/image.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* A color map that the user can select. The owner of a PageColormap frees `name`, and releases
 * `map` with colormap_release. */
typedef struct PageColormap {
    char *name;
    Colormap map;
} PageColormap;

/* The content of a page. All members are borrowed. */
typedef struct PageParams {
    const char *templates;     /* the folder of templates */
    const char *viewer;        /* path of the viewer, a bundled script */
    const char *title;         /* name of the tree, one line */
    const char *generator;     /* program and version */
    const char *command;       /* the command line that makes the page */
    const Tree *tree;          /* the tree; its coordinates are written as floats relative to
                                * `origin` */
    Vec3 origin;               /* a point near the tree, mm; keeps coordinates small, so that floats
                                * are precise */
    const FieldSeries *fields; /* fields of the tree that the user can select */
    size_t n_fields;
    const PageColormap *maps;
    size_t n_maps;
    const Look *look;        /* colors, lights and finish of the vessels */
    const char *look_name;   /* name of the look, as in `render --look` */
    bool is_look_chosen;     /* true: an option specifies the look, and the viewer uses its lights;
                              * false: the viewer uses its own light */
    const ColorScale *scale; /* initial color scale; scale->name is the name of its field; NULL:
                              * initially no field is shown */
    const char *map;         /* name of the color map that is selected first. If it is not in
                              * `maps`, the viewer selects viridis, or else the first map */
    /* true: options specify the ends of the scale, or that it is logarithmic. false: the viewer
     * computes the ends from the values of the field. */
    bool is_scale_chosen;
} PageParams;

/* Appends the page to `out`. Escapes all texts for HTML except `generator`, which corcast itself
 * makes and which must need no escapes. After an error `out` may be incomplete.
 *
 * Errors   STATUS_INPUT if a template or the viewer is missing, or if the template lacks a
 *          placeholder; STATUS_IO if a file cannot be read; STATUS_MEMORY. */
MUST_CHECK Status page_write(const PageParams *params, Text *out, Err *err);

#endif
