/* What each kind of domain supplies to domain.c, all in the domain's own coordinates; private to
 * the room. */
#ifndef CORCAST_DOMAIN_KINDS_H
#define CORCAST_DOMAIN_KINDS_H

#include "domain/domain.h"

typedef struct DomainOps {
    const char *name;       /* "disc" */
    const char *parameters; /* "R" */
    bool is_convex;
    /* Reads the text behind the colon into a domain that is zeroed but for its ops: fills sizes,
     * file, dimension, bounds, volume and inlet. Of STATUS_USAGE the sentence lacks "`domain` TEXT:
     * ". On failure the caller releases what there is. */
    Status (*load)(Domain *domain, const char *values, Err *err);
    bool (*inside)(const Domain *domain, Vec3 point, double tolerance_mm);
    /* For segments longer than slack_mm; NULL for convex kinds. */
    bool (*holds_segment)(const Domain *domain, Vec3 a, Vec3 b);
    /* NULL: rejection from the bounds. */
    Vec3 (*sample)(const Domain *domain, Random *random);
    /* The point of the domain that a fork near it is moved to; NULL: it stays. */
    Vec3 (*settle)(const Domain *domain, Vec3 point);
    /* Frees what the union holds; NULL for the kinds that read no file. */
    void (*release)(Domain *domain);
} DomainOps;

extern const DomainOps disc_ops, ball_ops, rect_ops, box_ops, ellipsoid_ops, shell_ops;
extern const DomainOps polygon_ops, mask_ops, mesh_ops, hull_ops, surface_ops;

/* Reads FILE[,MM] into file, size and n_sizes; size[0] is 1 where MM is not given. */
MUST_CHECK Status domain_load_file_name(Domain *domain, const char *values, Err *err);

/* STATUS_INPUT, naming the file and the line (0: there are none), unless the point is finite and
 * within DOMAIN_MAX_MM of the origin on each axis. */
MUST_CHECK Status domain_check_point(const char *file, size_t line, Vec3 point, Err *err);

#endif
