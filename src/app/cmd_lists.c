/* What there is to choose from, one name a line, for people and scripts. */
#include "app/commands.h"
#include "app/options.h"
#include "app/picture.h"
#include "app/templates.h"
#include "derive/derive.h"
#include "domain/domain.h"
#include <stdio.h>

/* Fills `lines`. */
typedef Status ListNames(Text *lines, Err *err);

static Status list(const char *name, const char *summary, ListNames *names, int argc, char **argv,
                   Err *err)
{
    const Command command = {.name = name, .summary = summary, .operands = ""};
    const Option *const tables[] = {NULL};
    Text lines = TEXT_INIT;
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    if (!parsed.common.help)
        status = names(&lines, err);
    if (status == STATUS_OK)
        status = text_check(&lines, err);
    if (status == STATUS_OK && text_chars(&lines))
        fputs(text_chars(&lines), stdout);
    text_release(&lines);
    parsed_release(&parsed);
    return status;
}

static Status list_models(Text *lines, Err *err)
{
    for (size_t i = 0; model_names[i]; i++)
        text_printf(lines, "%s\n", model_names[i]);
    return text_check(lines, err);
}

static Status list_fields(Text *lines, Err *err)
{
    for (size_t i = 0; derive_field_name(i); i++)
        text_printf(lines, *derive_field_unit(i) ? "%s\t%s\n" : "%s\n", derive_field_name(i),
                    derive_field_unit(i));
    return text_check(lines, err);
}

static Status list_domains(Text *lines, Err *err)
{
    for (size_t i = 0; domain_shape_name(i); i++)
        text_printf(lines, "%s:%s\n", domain_shape_name(i), domain_shape_parameters(i));
    return text_check(lines, err);
}

static Status list_looks(Text *lines, Err *err)
{
    return template_names("looks", ".ini", lines, err);
}

static Status list_colormaps(Text *lines, Err *err)
{
    return template_names("colormaps", ".txt", lines, err);
}

Status run_models(int argc, char **argv, Err *err)
{
    return list("models", "the values of --model", list_models, argc, argv, err);
}

Status run_fields(int argc, char **argv, Err *err)
{
    return list("fields", "the values of --color-by, with their units", list_fields, argc, argv,
                err);
}

Status run_domains(int argc, char **argv, Err *err)
{
    return list("domains", "the shapes of --domain", list_domains, argc, argv, err);
}

Status run_looks(int argc, char **argv, Err *err)
{
    return list("looks", "the values of --look", list_looks, argc, argv, err);
}

Status run_colormaps(int argc, char **argv, Err *err)
{
    return list("colormaps", "the values of --colormap", list_colormaps, argc, argv, err);
}
