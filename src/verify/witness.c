/* One scene gives both planes: segments have flat colours, which Tachyon's low shading shows as
 * they are, and in its medium shading fog that grows linearly with the way along the ray covers
 * them, black as they are without light. Tachyon cuts codes off, so a depth lies half a step beyond
 * its code.
 *
 * The tolerance is tier A's but for what single precision does: a coordinate of 100 mm is off by up
 * to 4e-6 mm, which moves an edge by 10^-5 of a pixel or so, and takes a pixel or two of a million
 * to its other side. */
#include "verify/witness.h"

#include "verify/tool.h"
#include "verify/verify.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the program ----------------------------------------------------------------------------- */

static Status add_arguments(const void *context, const char *scene, const char *picture,
                            Arguments *arguments, Err *err)
{
    const WitnessParams *params = context;
    const bool ids = params->plane == WITNESS_ID;
    const char *const words[] = {params->program ? params->program : "tachyon",
                                 scene,
                                 ids ? "-lowshade" : "-mediumshade",
                                 "-format",
                                 ids ? "PPM" : "PPM48",
                                 "-o",
                                 picture};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        TRY(arguments_add(arguments, err, "%s", words[i]));
    if (params->threads == 0)
        return STATUS_OK;
    TRY(arguments_add(arguments, err, "-numthreads"));
    return arguments_add(arguments, err, "%d", params->threads);
}

/* Whether what stands there is the picture that was asked for. */
static bool is_whole_picture(const char *path, const WitnessParams *params)
{
    Picture picture;
    Err ignored;
    if (picture_read(&picture, path, ALPHA_REFUSED, &ignored) != STATUS_OK)
        return false;
    bool whole = picture.width == params->width && picture.height == params->height &&
                 picture.channels == 3 && picture.bits == (params->plane == WITNESS_ID ? 8 : 16);
    picture_release(&picture);
    return whole;
}

/* The last line in which it says that something is wrong; it exits with 0 even then. */
static void reason_of_failure(const Text *said, char *reason, size_t size)
{
    static const char *const marks[] = {"rror", "ailed", "ound"};
    snprintf(reason, size, "it gave no reason");
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        const char *at = strstr(text_chars(said), marks[i]);
        if (!at)
            continue;
        while (at > text_chars(said) && at[-1] != '\n')
            at--;
        snprintf(reason, size, "%.*s", (int)strcspn(at, "\n"), at);
        return;
    }
}

static Status judge(const void *context, const Text *said, int exit_status, const char *picture,
                    Err *err)
{
    const WitnessParams *params = context;
    char reason[200];
    if (exit_status == 0 && is_whole_picture(picture, params))
        return STATUS_OK;
    reason_of_failure(said, reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "Tachyon drew no picture of %s (exit status %d): %s",
                   params->scene, exit_status, reason);
}

Status witness_run(const WitnessParams *params, double *seconds, char version[16], Err *err)
{
    static const char mark[] = "Version ";
    Text said = TEXT_INIT;
    const Tool tool = {.name = "Tachyon",
                       .package = "tachyon",
                       .scene = params->scene,
                       .output = params->output,
                       .patience = "CORCAST_POVRAY_PATIENCE",
                       .patience_s = params->patience_s,
                       .add_arguments = add_arguments,
                       .judge = judge,
                       .context = params};
    Status status = tool_draw(&tool, &said, seconds, err);
    const char *at = status == STATUS_OK ? strstr(text_chars(&said), mark) : NULL;
    snprintf(version, 16, "%s", "unknown");
    if (at)
        snprintf(version, 16, "%.*s", (int)strspn(at + strlen(mark), "0123456789."),
                 at + strlen(mark));
    text_release(&said);
    return status;
}

/* ---- planes ---------------------------------------------------------------------------------- */

Status witness_read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    return status;
}

Status witness_read_depth(Plane *depth, const char *path, const IdPlane *ids, double near_mm,
                          double far_mm, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = plane_init(depth, picture.width, picture.height, 1, err);
    size_t pixels = (size_t)picture.width * (size_t)picture.height;
    for (size_t i = 0; status == STATUS_OK && i < pixels; i++) {
        double fraction = (picture.codes16[3 * i] + 0.5) / 65535;
        depth->values[i] =
            ids->ids[i] ? (float)(near_mm + fraction * (far_mm - near_mm)) : HUGE_VALF;
    }
    picture_release(&picture);
    return status;
}

/* ---- comparison ------------------------------------------------------------------------------ */

/* 20 of a million pixels, or 2 of fewer. */
static double ppm_of(size_t pixels)
{
    return fmax(20, 2.5e6 / (double)pixels);
}

static Tolerance witness_tolerance(double depth_step_mm, const IdPlane *ids)
{
    const size_t pixels = (size_t)ids->width * (size_t)ids->height;
    size_t seen = 0;
    for (size_t i = 0; i < pixels; i++)
        seen += ids->ids[i] != 0;
    Tolerance tolerance = tolerance_none();
    tolerance.tier = "witness";
    tolerance.id_ppm = tolerance.coverage_ppm = ppm_of(pixels);
    tolerance.depth_ppm = ppm_of(seen);
    tolerance.depth_max_mm = depth_step_mm;
    tolerance.region_pixels = 2;
    return tolerance;
}

static Status compare_pair(const Testimony *a, const Testimony *b, double depth_step_mm,
                           Witness *witness, WitnessPair pair, Err *err)
{
    Tolerance tolerance = witness_tolerance(depth_step_mm, a->ids);
    CompareResult **ids = &witness->pairs[pair].ids, **depth = &witness->pairs[pair].depth;
    TRY(mem_calloc(ids, 1, sizeof **ids, "a comparison", err));
    TRY(mem_calloc(depth, 1, sizeof **depth, "a comparison", err));
    snprintf(witness->pairs[pair].title, sizeof witness->pairs[pair].title, "%s and %s", a->name,
             b->name);
    TRY(compare_ids(a->ids, b->ids, &tolerance, *ids, err));
    tolerance.region_pixels = SIZE_MAX; /* as judged of the ids */
    TRY(compare_planes(PLANE_DEPTH, a->depth, b->depth, a->ids, b->ids, &tolerance, *depth, err));
    witness->pairs[pair].agrees = (*ids)->agrees && (*depth)->agrees;
    return STATUS_OK;
}

/* The program that is in neither side of the only pair that agrees stands alone. */
static void judge_three(const Testimony three[3], Witness *witness)
{
    static const int other[WITNESS_PAIRS] = {[PAIR_SIDES] = 2, [PAIR_A] = 1, [PAIR_B] = 0};
    int agreeing = 0, last = 0;
    for (int pair = 0; pair < WITNESS_PAIRS; pair++)
        if (witness->pairs[pair].agrees) {
            agreeing++;
            last = pair;
        }
    witness->agrees = agreeing == WITNESS_PAIRS;
    if (witness->agrees)
        snprintf(witness->sentence, sizeof witness->sentence,
                 "%s, %s and %s agree on what is seen where and how far away", three[0].name,
                 three[1].name, three[2].name);
    else if (agreeing == 1)
        snprintf(witness->sentence, sizeof witness->sentence, "%s agree, and %s stands alone",
                 witness->pairs[last].title, three[other[last]].name);
    else
        snprintf(witness->sentence, sizeof witness->sentence,
                 agreeing ? "%s, %s and %s: two of the three pairs agree, and one does not"
                          : "%s, %s and %s: no two agree",
                 three[0].name, three[1].name, three[2].name);
}

Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness, Err *err)
{
    static const int sides[WITNESS_PAIRS][2] = {
        [PAIR_SIDES] = {0, 1}, [PAIR_A] = {0, 2}, [PAIR_B] = {1, 2}};
    witness->name = three[2].name;
    Status status = STATUS_OK;
    for (int pair = 0; pair < WITNESS_PAIRS && status == STATUS_OK; pair++)
        status = compare_pair(&three[sides[pair][0]], &three[sides[pair][1]], depth_step_mm,
                              witness, (WitnessPair)pair, err);
    if (status == STATUS_OK)
        judge_three(three, witness);
    else
        witness_release(witness);
    return status;
}

void witness_release(Witness *witness)
{
    for (int pair = 0; pair < WITNESS_PAIRS; pair++) {
        free(witness->pairs[pair].ids);
        free(witness->pairs[pair].depth);
        witness->pairs[pair].ids = witness->pairs[pair].depth = NULL;
    }
}

json_t *witness_json(const Witness *witness)
{
    json_t *pairs = json_object();
    for (int pair = 0; pair < WITNESS_PAIRS; pair++)
        pairs = json_with(pairs, witness->pairs[pair].title,
                          json_pack("{s:o, s:o, s:o}", "verdict",
                                    json_text(witness->pairs[pair].agrees ? "agree" : "differ"),
                                    "id", compare_json(witness->pairs[pair].ids), "depth",
                                    compare_json(witness->pairs[pair].depth)));
    const JsonMember members[] = {{"verdict", json_text(witness->agrees ? "agree" : "differ")},
                                  {"sentence", json_text(witness->sentence)},
                                  {"name", json_text(witness->name)},
                                  {"version", json_text(witness->version)},
                                  {"seconds", json_number(witness->seconds)},
                                  {"pairs", pairs}};
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}
