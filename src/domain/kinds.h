/* The functions that each kind of domain supplies to domain.c. All coordinates are those of the
 * domain itself. Private to the module domain. */
#ifndef CORCAST_DOMAIN_KINDS_H
#define CORCAST_DOMAIN_KINDS_H

#include "domain/domain.h"

typedef struct DomainOps {
    DomainShape shape;
    bool is_convex;
    /* Reads the text after the colon. Before the call only domain->ops is set, and all else is
     * zero. Sets sizes, file, dimension, bounds, volume and inlet. The sentence of a STATUS_USAGE
     * does not name the option, which the caller adds. The caller releases the domain, also after
     * an error. */
    Status (*load)(Domain *domain, const char *values, Err *err);
    /* Returns true if the point is in the domain, or outside it by at most the tolerance, >= 0. */
    bool (*inside)(const Domain *domain, Vec3 point, double tolerance_mm);
    /* Returns true if the whole segment, which is longer than slack_mm, is in the domain. NULL for
     * convex kinds, where the two ends decide. */
    bool (*holds_segment)(const Domain *domain, Vec3 a, Vec3 b);
    /* Returns a random point. NULL: domain.c draws points in the bounds until one is inside. */
    Vec3 (*sample)(const Domain *domain, Random *random);
    /* Returns the point of the domain to which a bifurcation near `point` is moved. NULL:
     * bifurcations stay where they are. */
    Vec3 (*project)(const Domain *domain, Vec3 point);
    /* Frees what the union holds; NULL for the kinds that read no file. */
    void (*release)(Domain *domain);
} DomainOps;

/* Disc, ball, rectangle, box and ellipsoid. */
enum { SIMPLE_SHAPES = 5 };
extern const DomainOps simple_ops[SIMPLE_SHAPES];
extern const DomainOps shell_ops;
extern const DomainOps polygon_ops, mask_ops, mesh_ops, hull_ops, surface_ops;

/* Cuts the number after the last comma off a text, with the comma. Returns false, and leaves both
 * arguments unchanged, if the text does not end so. */
bool domain_cut_number(char *text, double *number);

/* Reads FILE[,MM] into file, size and n_sizes. size[0] is the mm per unit of the file, 1 if MM is
 * not given. Errors: STATUS_USAGE, STATUS_MEMORY. */
MUST_CHECK Status domain_load_file_name(Domain *domain, const char *values, Err *err);

/* Checks that a point of a file is finite and within DOMAIN_MAX_MM of the origin on each axis. Else
 * fails with STATUS_INPUT, which names the file and the line (0: the file has no lines). */
MUST_CHECK Status domain_check_point(const char *file, size_t line, Vec3 point, Err *err);

#endif
