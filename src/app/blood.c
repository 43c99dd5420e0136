/* One set of options wherever fields of flow are derived from a tree. */
#include "app/blood.h"

#include "derive/derive.h"

static const char of_tree[] = "the tree's";

#define SAYS(KEY) SETS_KEY(BloodOptions, said.number[META_##KEY], said.known, KEY)

static const Option rows[] = {
    {.name = "q-perf",
     SAYS(Q_PERF),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "flow through the inlet"},
    {.name = "p-perf",
     SAYS(P_PERF),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "pressure at the inlet"},
    {.name = "viscosity",
     SAYS(VISCOSITY),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "of the blood"},
    {.name = "viscosity-law",
     SETS(CHOICE, BloodOptions, law),
     GIVEN(BloodOptions, said.known[META_VISCOSITY_LAW]),
     .choices = viscosity_law_names,
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "the same in all vessels, or by their diameter"},
    {.name = "hematocrit",
     SAYS(HEMATOCRIT),
     .group = GROUP_BLOOD,
     .argument = "H",
     .otherwise = of_tree,
     .help = "of the blood, for pries"},
    {.name = "plasma-viscosity",
     SAYS(PLASMA_VISCOSITY),
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "of the plasma, for pries"},
};

const OptionTable blood_table = OPTION_TABLE(rows);

TreeMeta blood_said(const BloodOptions *blood)
{
    TreeMeta said = blood->said;
    said.number[META_VISCOSITY_LAW] = blood->law;
    return said;
}

Status blood_check_law(ViscosityLaw law, const Parsed *parsed, Err *err)
{
    bool pries = law == VISCOSITY_PRIES;
    static const char of_pries[] = "is for --viscosity-law pries";
    const OptionNeed needs[] = {{"viscosity", !pries, "is for --viscosity-law constant"},
                                {"hematocrit", pries, of_pries},
                                {"plasma-viscosity", pries, of_pries},
                                {0}};
    return options_check_needs(parsed, needs, err);
}

Status blood_check(const BloodOptions *blood, const Tree *tree, const Parsed *parsed, Err *err)
{
    const TreeMeta said = blood_said(blood);
    return blood_check_law(derive_viscosity_law(tree, &said), parsed, err);
}
