/* ICC profiles through lcms2: the one of sRGB that files carry, and the way from sRGB to the inks
 * of a press. lcms writes the time into a profile that it makes; a fixed one takes its place, so
 * that equal pictures are equal files. With the relative intent, the black of the screen becomes
 * the black of the press (black point compensation), as layout programs do. */
#include "image/formats.h"

#include <assert.h>
#include <errno.h>
#include <lcms2_plugin.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

struct Inks {
    cmsContext context;
    cmsHTRANSFORM transform;
    int bits;
    InkIntent intent;
    ImageProfile profile; /* owned */
    const char *fault;    /* of the profile, in our words; NULL: none */
    char complaint[200];  /* and in lcms's, "" when there is none */
};

/* ---- memory ---------------------------------------------------------------------------------- */

static _Thread_local jmp_buf *way_out; /* NULL outside of guarded */

static void *take(cmsContext context, cmsUInt32Number size)
{
    (void)context;
    void *memory = malloc(size);
    if (!memory && way_out)
        longjmp(*way_out, 1);
    return memory;
}

static void *take_more(cmsContext context, void *memory, cmsUInt32Number size)
{
    (void)context;
    void *moved = realloc(memory, size);
    if (!moved && way_out)
        longjmp(*way_out, 1);
    return moved;
}

static void give(cmsContext context, void *memory)
{
    (void)context;
    free(memory);
}

static cmsContext make_context(char *complaint)
{
    cmsPluginMemHandler plugin = {.base = {.Magic = cmsPluginMagicNumber,
                                           .ExpectedVersion = LCMS_VERSION,
                                           .Type = cmsPluginMemHandlerSig},
                                  .MallocPtr = take,
                                  .FreePtr = give,
                                  .ReallocPtr = take_more};
    return cmsCreateContext(&plugin, complaint);
}

/* Whether `work`, which calls lcms, came to its end. Where it did not, what it had is lost. */
static bool guarded(void (*work)(void *self), void *self)
{
    jmp_buf here;
    if (setjmp(here)) {
        way_out = NULL;
        return false;
    }
    way_out = &here;
    work(self);
    way_out = NULL;
    return true;
}

static void on_error(cmsContext context, cmsUInt32Number code, const char *message)
{
    (void)code;
    char *complaint = cmsGetContextUserData(context);
    if (complaint && !*complaint) {
        snprintf(complaint, 200, "%s", message);
        image_plain_text(complaint);
    }
}

/* ---- the profile of sRGB --------------------------------------------------------------------- */

/* Leaves the profile without bytes when there is no room for them. */
static void save(cmsHPROFILE from, ImageProfile *profile)
{
    static const uint8_t date[12] = {2026 >> 8, 2026 & 255, 0, 1, 0, 1};
    enum { DATE = 24 };
    cmsUInt32Number size = 0;
    if (!cmsSaveProfileToMem(from, NULL, &size) || !(profile->bytes = malloc(size)))
        return;
    profile->size = size;
    cmsSaveProfileToMem(from, profile->bytes, &size);
    memcpy(profile->bytes + DATE, date, sizeof date);
}

static void make_srgb(void *profile)
{
    cmsContext context = make_context(NULL);
    cmsHPROFILE srgb = cmsCreate_sRGBProfileTHR(context);
    save(srgb, profile);
    cmsCloseProfile(srgb);
    cmsDeleteContext(context);
}

static Status srgb_profile(ImageProfile *profile, Err *err)
{
    ImageProfile made = {0};
    errno = 0;
    if (guarded(make_srgb, &made) && made.bytes && errno != ENOMEM) {
        *profile = made;
        return STATUS_OK;
    }
    free(made.bytes);
    return mem_out_of("for", "the colour profile", err);
}

Status image_profile(const ImageForm *form, ImageProfile *profile, Err *err)
{
    const Inks *inks = form->packing.inks;
    *profile = (ImageProfile){0};
    if (!inks)
        return form->channels >= 3 && form->encoding == ENCODING_SRGB ? srgb_profile(profile, err)
                                                                      : STATUS_OK;
    TRY(mem_calloc(&profile->bytes, inks->profile.size, 1, "bytes of a profile", err));
    memcpy(profile->bytes, inks->profile.bytes, inks->profile.size);
    profile->size = inks->profile.size;
    return STATUS_OK;
}

/* ---- inks ------------------------------------------------------------------------------------ */

static void make_transform(Inks *inks, cmsHPROFILE press)
{
    static const cmsUInt32Number intents[] = {
        [INKS_PERCEPTUAL] = INTENT_PERCEPTUAL, [INKS_RELATIVE] = INTENT_RELATIVE_COLORIMETRIC};
    bool deep = inks->bits == 16;
    cmsHPROFILE srgb = cmsCreate_sRGBProfileTHR(inks->context);
    inks->transform =
        cmsCreateTransformTHR(inks->context, srgb, deep ? TYPE_RGB_16 : TYPE_RGB_8, press,
                              deep ? TYPE_CMYK_16 : TYPE_CMYK_8, intents[inks->intent],
                              inks->intent == INKS_RELATIVE ? cmsFLAGS_BLACKPOINTCOMPENSATION : 0);
    cmsCloseProfile(srgb);
}

/* Leaves in inks->fault what is wrong with the profile, NULL when nothing is. */
static void open_profile(void *self)
{
    Inks *inks = self;
    inks->fault = "is not a sound ICC profile";
    inks->context = make_context(inks->complaint);
    cmsSetLogErrorHandlerTHR(inks->context, on_error);
    cmsHPROFILE press = cmsOpenProfileFromMemTHR(inks->context, inks->profile.bytes,
                                                 (cmsUInt32Number)inks->profile.size);
    if (!press)
        return;
    inks->fault = "is the profile of other colours than cyan, magenta, yellow and black";
    if (cmsGetColorSpace(press) == cmsSigCmykData) {
        make_transform(inks, press);
        inks->fault = inks->transform ? NULL : "is no profile that colours can be printed by";
    }
    cmsCloseProfile(press);
}

static Status prepare(Inks *inks, const char *path, Err *err)
{
    errno = 0;
    if (!guarded(open_profile, inks)) {
        inks->context = inks->transform = NULL;
        return mem_out_of("for the profile", path, err);
    }
    if (errno == ENOMEM)
        return mem_out_of("for the profile", path, err);
    if (!inks->fault)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: %s%s%s", path, inks->fault, *inks->complaint ? ": " : "",
                   inks->complaint);
}

static bool is_profile(const char *start, size_t count)
{
    return count >= 40 && memcmp(start + 36, "acsp", 4) == 0;
}

Status inks_read(Inks **out, const char *path, InkIntent intent, int bits, Err *err)
{
    static const FileForm form = {
        .name = "an ICC profile", .most_bytes = 64e6, .begins = is_profile};
    Inks *inks;
    char *bytes = NULL;
    TRY(mem_calloc(&inks, 1, sizeof *inks, "profiles", err));
    inks->bits = bits;
    inks->intent = intent;
    Status status = file_read(path, &form, &bytes, &inks->profile.size, err);
    inks->profile.bytes = (uint8_t *)bytes;
    if (status == STATUS_OK)
        status = prepare(inks, path, err);
    if (status != STATUS_OK) {
        inks_free(inks);
        return status;
    }
    *out = inks;
    return STATUS_OK;
}

void inks_free(Inks *inks)
{
    if (!inks)
        return;
    if (inks->transform)
        cmsDeleteTransform(inks->transform);
    if (inks->context)
        cmsDeleteContext(inks->context);
    free(inks->profile.bytes);
    free(inks);
}

void inks_convert(const Inks *inks, const void *rgb, void *cmyk, size_t n)
{
    cmsDoTransform(inks->transform, rgb, cmyk, (cmsUInt32Number)n);
}

int inks_bits(const Inks *inks)
{
    return inks->bits;
}
