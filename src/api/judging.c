/* Implements the functions of the library that compare two pictures, and that verify a picture with
 * POV-Ray. */
#include "api/image.h"
#include "api/reports.h"
#include "api/request.h"

#include "job/verify/compare.h"
#include "job/verify/verify.h"
#include <string.h>

/* ---- compare --------------------------------------------------------------------------------- */

/* The parts of an image that are compared. All members are borrowed. */
typedef struct ImagePart {
    Image image;
    GivenImage given; /* points to `image` */
} ImagePart;

/* Finds the planes of an image that are compared. The color of an image may itself be a plane of
 * depths or normals, if it was read from such a file. */
static Status take_part(const corcast_image *of, PlaneKind kind, ImagePart *part, Err *err)
{
    part->image = of->color;
    if (kind == PLANE_DEPTH && of->depth.values)
        part->image = (Image){.plane = of->depth};
    if (kind == PLANE_NORMAL && of->normal.values)
        part->image = (Image){.plane = of->normal};
    const bool has_ids = of->ids.ids != NULL;
    const bool has_image = part->image.picture.width > 0 || part->image.plane.values;
    if (kind == PLANE_ID ? !has_ids : !has_image)
        return err_set(err, STATUS_USAGE, "an image lacks the plane that is to be compared");
    part->given = (GivenImage){.image = kind == PLANE_ID ? NULL : &part->image,
                               .ids = has_ids ? &of->ids : NULL};
    return STATUS_OK;
}

/* Finds the parts that are compared: the colors, and the ids if both images have ids. */
static Status take_parts(const corcast_image *a, const corcast_image *b, CompareOptions *options,
                         ImagePart parts[2], Err *err)
{
    TRY(take_part(a, options->kind, &parts[0], err));
    TRY(take_part(b, options->kind, &parts[1], err));
    const bool both = parts[0].given.ids && parts[1].given.ids;
    for (int i = 0; i < 2; i++) {
        options->given[i] = parts[i].given;
        options->given[i].ids = both ? parts[i].given.ids : NULL;
    }
    return STATUS_OK;
}

static Status report_comparison(const CompareOptions *options, const Parsed *parsed,
                                const Comparison *found, corcast_report **report, Err *err)
{
    TRY(compare_write(options, parsed, found, err));
    if (report)
        TRY(report_new(comparison_json(found), report, err));
    if (found->agrees)
        return STATUS_OK;
    return err_set(err, STATUS_DIFFERS, "%s", found->result.cause);
}

static Status compare(const corcast_image *a, const corcast_image *b,
                      const corcast_options *options, corcast_report **report, const Call *call,
                      Err *err)
{
    const RequestArguments form = {.commands = "compare", .options = options};
    Request request = {0};
    ImagePart parts[2];
    Comparison found = {0};
    Status status = STATUS_OK;
    TRY(handle_check(a, HANDLE_IMAGE, "a", err));
    TRY(handle_check(b, HANDLE_IMAGE, "b", err));
    TRY_GOTO(request_open(&request, &form, call, err));
    CompareOptions *own = request.parsed.options;
    own->json = report != NULL;
    TRY_GOTO(take_parts(a, b, own, parts, err));
    TRY_GOTO(compare_make(own, &request.parsed, &found, err));
    status = report_comparison(own, &request.parsed, &found, report, err);
    comparison_release(&found);
done:
    return request_close(&request, status, err);
}

int corcast_compare(const corcast_image *a, const corcast_image *b, const corcast_options *options,
                    corcast_report **report, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, compare(a, b, options, report, &call, &call.err));
}

/* ---- verify ---------------------------------------------------------------------------------- */

static Status report_verification(const Verification *result, corcast_report **report, Err *err)
{
    if (report)
        TRY(report_new(verify_json(result), report, err));
    if (result->agrees)
        return STATUS_OK;
    return err_set(err, STATUS_DIFFERS, "%s", result->found.planes[PLANE_COLOR].cause);
}

static Status verify(const RequestArguments *form, corcast_report **report, const Call *call,
                     Err *err)
{
    Request request = {0};
    Verification result;
    Status status = STATUS_OK;
    TRY(handle_check(form->tree, HANDLE_TREE, "tree", err));
    TRY(path_check(form->output, "folder", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(verify_run(request.parsed.options, &request.parsed, &result, err));
    status = report_verification(&result, report, err);
    verification_release(&result);
done:
    return request_close(&request, status, err);
}

int corcast_verify(const corcast_tree *tree, const corcast_options *options, const char *folder,
                   corcast_report **report, corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {
        .commands = "verify", .options = options, .tree = tree, .output = folder};
    return call_end(&call, verify(&form, report, &call, &call.err));
}
