/* The functions that each kind of domain supplies to domain.c, in a table DomainOps. Positions are
 * in the domain's own coordinates [Domain.origin]. Private to the module domain. */
#ifndef CORCAST_DOMAIN_KINDS_H
#define CORCAST_DOMAIN_KINDS_H

#include "domain/domain.h"

/* The functions of one kind. Pointers may be NULL where the comment says so. */
typedef struct DomainOps {
    DomainShape shape;
    bool is_convex;
    /* Makes a domain from `values`, the text after the colon of a domain such as "ball:10". Before
     * the call only domain->ops is set; all other members are zero. Sets parameter, n_parameters,
     * file, dimension, bounds, volume and inlet. Errors are those of domain_parse; the sentence of
     * STATUS_USAGE does not name the option, which the caller adds. The caller releases the domain,
     * also after an error. */
    Status (*load)(Domain *domain, const char *values, Err *err);
    /* As domain_inside. */
    bool (*inside)(const Domain *domain, Vec3 point, double tolerance_mm);
    /* Returns true if the whole segment is in the domain. Called only for segments longer than
     * domain->slack_mm. NULL for convex kinds: the segment is inside if its two ends are. */
    bool (*holds_segment)(const Domain *domain, Vec3 a, Vec3 b);
    /* Returns a random candidate for a point of the domain. domain.c draws candidates until one is
     * inside the domain. The accepted points are uniformly distributed. NULL: candidates are
     * uniformly distributed in the bounds. */
    Vec3 (*sample)(const Domain *domain, Random *random);
    /* As domain_project: returns the point that replaces `point` as the position of a bifurcation.
     * NULL: bifurcations stay where they are. */
    Vec3 (*project)(const Domain *domain, Vec3 point);
    /* Frees the members of the union in Domain, and Domain.surface; NULL for kinds that read no
     * file. */
    void (*release)(Domain *domain);
} DomainOps;

/* Disc, ball, rectangle, box and ellipsoid. */
enum { SIMPLE_SHAPES = 5 };
extern const DomainOps simple_ops[SIMPLE_SHAPES];
extern const DomainOps shell_ops;
extern const DomainOps polygon_ops, mask_ops, mesh_ops, hull_ops, surface_ops;

/* Removes the last comma of a text and the number after it, and sets *number. Returns false, and
 * leaves both arguments unchanged, if there is no comma or no number after the last one. */
bool domain_cut_number(char *text, double *number);

/* Reads the text FILE[,MM], and sets file, parameter and n_parameters of the domain. parameter[0]
 * receives MM, the length in mm of one unit of the file; it receives 1 if the text has no MM.
 * Errors: STATUS_USAGE, STATUS_MEMORY. */
MUST_CHECK Status domain_load_file_name(Domain *domain, const char *values, Err *err);

/* Checks that the coordinates of a point of a file are finite and within +- DOMAIN_MAX_MM. `line`
 * is the line of the file; 0: the file has no lines. Errors: STATUS_INPUT, with file and line. */
MUST_CHECK Status domain_check_point(const char *file, size_t line, Vec3 point, Err *err);

#endif
