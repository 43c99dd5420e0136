/* The options of growth, and what they name: the domain, and a tree to grow on from. */
#ifndef CORCAST_APP_GROWING_H
#define CORCAST_APP_GROWING_H

#include "app/options.h"
#include "grow/grow.h"

enum { GROWING_OPTIONS = 20 };

typedef struct Growing {
    GrowParams params;
    Domain domain;
    Tree from;
    const char *domain_spec, *from_path; /* NULL: not given */
    VectorList inlets;
    NumberList shares;
    int toss, viscosity_law, terminal_flow; /* GrowToss, ViscosityLaw, TerminalFlow */
    struct {
        bool gamma, lambda, p_perf, p_term, q_perf, viscosity;
        bool viscosity_law, hematocrit, plasma_viscosity, terminal_flow;
    } given;
    Option table[GROWING_OPTIONS];
} Growing;

/* grow_defaults, and the table that sets them; `growing` must not move afterwards. */
void growing_init(Growing *growing);

/* Reads what the options name, takes note of the domain's file, and completes the parameters; what
 * they do not give is taken from the header of the tree to grow on from, where it tells.
 * STATUS_USAGE, too, for options without effect. */
MUST_CHECK Status growing_prepare(Growing *growing, Parsed *parsed, Err *err);

void growing_release(Growing *growing);

#endif
