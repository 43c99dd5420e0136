/* Makes the problem of the lower bound from a tree: its joints (inlets, bifurcations and outlets)
 * with their flows and pressure drops.
 *
 * Flow shares are summed towards the inlets. Pressure drops of the tree are summed away from the
 * inlets, in units that leave out the factors common to all segments, so that neither viscosity nor
 * flow must be known: the drop on a segment is share * length / radius^4. Nodes inside a vessel,
 * and branches without flow, are left out.
 *
 * Free joints begin with the drops that are best at their positions. These have a closed form if
 * all outlets have the same drop D: a segment and all below it cost at least W^(1 + a) D^-a, with W
 * = w + (sum of W^(1 + a) over its daughters)^(1 / (1 + a)) and w = flow^(a / (1 + a)) length, and
 * the segment's part of D is w / W. Lengths are smoothed, as at the first step. If outlets have
 * different drops, the least drop of all outlets below is divided in this manner, so that drops
 * rise along every path. */
#include "grow/bound/bound_problem.h"

#include "grow/bound/bound.h"
#include <stdlib.h>

/* A node of the tree. */
typedef struct SurveyedNode {
    double flow;   /* sum of the flow shares at and below it */
    double drop;   /* pressure drop from the inlet */
    int32_t ways;  /* number of children with flow, plus 1 at an outlet */
    int32_t joint; /* index of its joint, or of the joint that its flow comes from; -1: none */
} SurveyedNode;

/* The nodes of the tree. Both arrays have an entry per node and are owned. */
typedef struct ProblemSurvey {
    double *share; /* flow shares */
    SurveyedNode *node;
} ProblemSurvey;

/* Returns true if blood flows through segment i. */
static bool is_open(const Tree *tree, const ProblemSurvey *survey, size_t i)
{
    return tree_is_segment(tree, i) && survey->node[i].flow > 0;
}

/* Returns true if blood leaves the tree at node i. */
static bool is_outlet(const Tree *tree, const ProblemSurvey *survey, size_t i)
{
    return tree_is_segment(tree, i) && survey->share[i] > 0;
}

/* Computes the pressure drop of node i, and adds its segment to the target and the mean length. */
static Status survey_node(const Tree *tree, ProblemSurvey *survey, size_t i, Problem *problem,
                          Err *err)
{
    double length = tree_segment_length(tree, i), radius = tree->radius_mm[i];
    if (!(radius > 0))
        return err_set(err, STATUS_INPUT,
                       "node %d: blood flows to it through a radius of 0, where all pressure drops",
                       tree->id[i]);
    double radius2 = radius * radius;
    survey->node[i].drop =
        survey->node[tree->parent[i]].drop + survey->node[i].flow * length / (radius2 * radius2);
    if (is_outlet(tree, survey, i) && !(survey->node[i].drop > 0))
        return err_set(err, STATUS_INPUT,
                       "node %d: blood leaves the tree where its root is, without a path to it",
                       tree->id[i]);
    if (!isfinite(survey->node[i].drop))
        return err_set(err, STATUS_INPUT, "node %d: radius %g mm lets too little blood through",
                       tree->id[i], radius);
    problem->target += length * elementary_pow(radius, 4 * problem->a);
    problem->mean_length += length;
    return STATUS_OK;
}

/* Computes flows, numbers of branches and pressure drops of all nodes. */
static Status survey_init(ProblemSurvey *survey, const Tree *tree, Problem *problem, Err *err)
{
    size_t n = tree->n;
    TRY(tree_flow_shares(tree, &survey->share, err));
    TRY(mem_calloc(&survey->node, n, sizeof *survey->node, "nodes", err));
    for (size_t i = n; i-- > 0;) {
        survey->node[i].flow += survey->share[i];
        survey->node[i].ways += is_outlet(tree, survey, i);
        if (!is_open(tree, survey, i))
            continue;
        survey->node[tree->parent[i]].flow += survey->node[i].flow;
        survey->node[tree->parent[i]].ways++;
    }
    for (size_t i = 0; i < n; i++)
        if (is_open(tree, survey, i))
            TRY(survey_node(tree, survey, i, problem, err));
    return STATUS_OK;
}

/* Returns true if node i becomes a joint, and false if it is left out. */
static bool is_joint(const Tree *tree, const ProblemSurvey *survey, size_t i)
{
    return !tree_is_segment(tree, i) || (survey->node[i].flow > 0 && survey->node[i].ways > 1) ||
           is_outlet(tree, survey, i);
}

/* Appends a joint at node i. */
static Joint *add_joint(Problem *problem, const Tree *tree, size_t i, int32_t parent, double flow)
{
    Joint *joint = &problem->joint[problem->n++];
    const Vec3 at = tree->position[i];
    *joint = (Joint){.at = {at.x, at.y, at.z},
                     .flow = flow,
                     .factor = elementary_pow(flow, problem->a),
                     .parent = parent,
                     .outlet = -1};
    return joint;
}

/* Sets the joint of node i: a new joint, or the joint of its parent if node i is left out. If blood
 * both leaves and flows on at node i, it becomes two joints, a free one and an outlet. */
static void add_node(Problem *problem, const Tree *tree, ProblemSurvey *survey, size_t i)
{
    int32_t parent = tree_is_segment(tree, i) ? survey->node[tree->parent[i]].joint : -1;
    survey->node[i].joint = parent;
    if (!is_joint(tree, survey, i))
        return;
    survey->node[i].joint = (int32_t)problem->n;
    Joint *joint = add_joint(problem, tree, i, parent, survey->node[i].flow);
    joint->is_free = parent >= 0 && survey->node[i].ways > 1;
    if (!is_outlet(tree, survey, i))
        return;
    if (joint->is_free)
        joint = add_joint(problem, tree, i, survey->node[i].joint, survey->share[i]);
    joint->at[DROP] = survey->node[i].drop;
    joint->outlet = (int32_t)problem->outlets;
    problem->node[problem->outlets++] = (int32_t)i;
}

/* The subtree below a joint, at the start of the search. */
typedef struct Hanging {
    double weight; /* w of the segment to the joint */
    double costs;  /* the sum of W^(1 + a) over its daughters */
    double least;  /* the least drop of the outlets below */
} Hanging;

/* Sums up the subtrees below all joints into `hanging`, which is zeroed before. */
static void gather(const Problem *problem, Hanging *hanging)
{
    const double a = problem->a, smoothing = FIRST_SMOOTHING * problem->mean_length;
    for (size_t i = 0; i < problem->n; i++)
        hanging[i].least = INFINITY;
    for (size_t i = problem->n; i-- > 0;) {
        const Joint *joint = &problem->joint[i];
        Hanging *at = &hanging[i];
        if (joint_is_inlet(joint))
            continue;
        if (!joint->is_free)
            at->least = joint->at[DROP];
        JointDifference reach = problem_reach(problem, i, smoothing);
        at->weight = elementary_pow(joint->flow, a / (1 + a)) * sqrt(reach.length2);
        Hanging *above = &hanging[joint->parent];
        above->costs += elementary_pow(at->weight + elementary_pow(at->costs, 1 / (1 + a)), 1 + a);
        above->least = fmin(above->least, at->least);
    }
}

/* Sets the first pressure drops of the free joints, from the inlets to the outlets. */
static void set_first_drops(Problem *problem, const Hanging *hanging)
{
    for (size_t i = 0; i < problem->n; i++) {
        Joint *joint = &problem->joint[i];
        if (!joint->is_free)
            continue;
        const Hanging *at = &hanging[i];
        double below = elementary_pow(at->costs, 1 / (1 + problem->a));
        double from = problem->joint[joint->parent].at[DROP];
        joint->at[DROP] = from + (at->least - from) * at->weight / (at->weight + below);
    }
}

static Status build(Problem *problem, const Tree *tree, ProblemSurvey *survey, Err *err)
{
    TRY(survey_init(survey, tree, problem, err));
    size_t outlets = 0;
    for (size_t i = 0; i < tree->n; i++)
        outlets += is_outlet(tree, survey, i);
    if (outlets == 0)
        return err_set(err, STATUS_INPUT, "no blood flows through the tree");
    size_t most = tree->n + outlets;
    TRY(mem_calloc(&problem->joint, most, sizeof *problem->joint, "joints", err));
    TRY(mem_calloc(&problem->node, outlets, sizeof *problem->node, "outlets", err));
    for (size_t i = 0; i < tree->n; i++)
        add_node(problem, tree, survey, i);
    problem->mean_length /= (double)problem->n;
    Hanging *hanging = NULL;
    TRY(mem_calloc(&hanging, problem->n, sizeof *hanging, "sums", err));
    gather(problem, hanging);
    set_first_drops(problem, hanging);
    free(hanging);
    return STATUS_OK;
}

Status problem_init(Problem *problem, const Tree *tree, double lambda, Err *err)
{
    Problem made = {.a = lambda / 4};
    ProblemSurvey survey = {0};
    Status status = build(&made, tree, &survey, err);
    free(survey.share);
    free(survey.node);
    if (status == STATUS_OK)
        *problem = made;
    else
        problem_release(&made);
    return status;
}

void problem_release(Problem *problem)
{
    free(problem->joint);
    free(problem->node);
    *problem = (Problem){0};
}
