/* Uses Little CMS (lcms2) to make the sRGB profile that is embedded in files, and to convert sRGB
 * to the inks of an output profile. Little CMS writes the current time into each profile. A fixed
 * time replaces it, so that equal pictures give equal files. With the intent INKS_RELATIVE, black
 * of sRGB becomes the black of the inks (black point compensation), as in layout programs. */
#include "image/formats.h"

#include <lcms2_plugin.h>
#include <stdlib.h>
#include <string.h>

struct Inks {
    Guard guard;
    cmsContext context;
    cmsHTRANSFORM transform;
    int bits; /* bits per channel of colors and inks: 8 or 16 */
    InkIntent intent;
    ImageProfile profile; /* the output profile; bytes owned */
    const char *fault;    /* the reason why the profile cannot be used; NULL: it can */
};

/* ---- memory and errors ----------------------------------------------------------------------- */

/* Little CMS crashes if some of its allocations fail, so a failed allocation leaves the guard. */
static void *on_malloc(cmsContext context, cmsUInt32Number size)
{
    (void)context;
    void *memory = malloc(size);
    if (!memory)
        guard_leave_without_memory();
    return memory;
}

static void *on_realloc(cmsContext context, void *memory, cmsUInt32Number size)
{
    (void)context;
    void *moved = realloc(memory, size);
    if (!moved)
        guard_leave_without_memory();
    return moved;
}

static void on_free(cmsContext context, void *memory)
{
    (void)context;
    free(memory);
}

static void on_error(cmsContext context, cmsUInt32Number code, const char *message)
{
    (void)context;
    (void)code;
    guard_note_message(message);
}

static cmsContext make_context(void)
{
    cmsPluginMemHandler plugin = {.base = {.Magic = cmsPluginMagicNumber,
                                           .ExpectedVersion = LCMS_VERSION,
                                           .Type = cmsPluginMemHandlerSig},
                                  .MallocPtr = on_malloc,
                                  .FreePtr = on_free,
                                  .ReallocPtr = on_realloc};
    cmsContext context = cmsCreateContext(&plugin, NULL);
    cmsSetLogErrorHandlerTHR(context, on_error);
    return context;
}

/* ---- the profile of sRGB --------------------------------------------------------------------- */

/* Stores the bytes of a profile, dated 1 January 2026. The date is at offset DATE of the header
 * [ICC.1]: six numbers of 16 bits. Leaves the profile without bytes, and ENOMEM in errno, if memory
 * runs out. */
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

/* A GuardedWork: makes the ImageProfile of sRGB. */
static Status make_srgb(void *profile, Err *err)
{
    (void)err;
    cmsContext context = make_context();
    cmsHPROFILE srgb = cmsCreate_sRGBProfileTHR(context);
    save(srgb, profile);
    cmsCloseProfile(srgb);
    cmsDeleteContext(context);
    return STATUS_OK;
}

Status image_profile(const ImageForm *form, ImageProfile *profile, Err *err)
{
    const Inks *inks = form->packing.inks;
    Guard guard = {.format = "ICC", .name = "the color profile"};
    *profile = (ImageProfile){0};
    if (!inks && (form->channels < 3 || form->encoding != ENCODING_SRGB))
        return STATUS_OK;
    if (!inks)
        return guard_run(&guard, make_srgb, profile, err);
    TRY(mem_calloc(&profile->bytes, inks->profile.size, 1, "bytes of a profile", err));
    memcpy(profile->bytes, inks->profile.bytes, inks->profile.size);
    profile->size = inks->profile.size;
    return STATUS_OK;
}

/* ---- inks ------------------------------------------------------------------------------------ */

static void make_transform(Inks *inks, cmsHPROFILE output_profile)
{
    static const cmsUInt32Number intents[] = {
        [INKS_PERCEPTUAL] = INTENT_PERCEPTUAL, [INKS_RELATIVE] = INTENT_RELATIVE_COLORIMETRIC};
    bool deep = inks->bits == 16;
    cmsHPROFILE srgb = cmsCreate_sRGBProfileTHR(inks->context);
    inks->transform =
        cmsCreateTransformTHR(inks->context, srgb, deep ? TYPE_RGB_16 : TYPE_RGB_8, output_profile,
                              deep ? TYPE_CMYK_16 : TYPE_CMYK_8, intents[inks->intent],
                              inks->intent == INKS_RELATIVE ? cmsFLAGS_BLACKPOINTCOMPENSATION : 0);
    cmsCloseProfile(srgb);
}

/* A GuardedWork. Sets inks->fault. */
static Status open_profile(void *self, Err *err)
{
    (void)err;
    Inks *inks = self;
    inks->fault = "is not a valid ICC profile";
    inks->context = make_context();
    cmsHPROFILE output_profile = cmsOpenProfileFromMemTHR(inks->context, inks->profile.bytes,
                                                          (cmsUInt32Number)inks->profile.size);
    if (!output_profile)
        return STATUS_OK;
    inks->fault = "is not a CMYK profile";
    if (cmsGetColorSpace(output_profile) == cmsSigCmykData) {
        make_transform(inks, output_profile);
        inks->fault = inks->transform ? NULL : "cannot convert colors to inks";
    }
    cmsCloseProfile(output_profile);
    return STATUS_OK;
}

static Status prepare(Inks *inks, const char *path, Err *err)
{
    inks->guard.format = "ICC";
    inks->guard.name = path;
    TRY(guard_run(&inks->guard, open_profile, inks, err));
    const char *message = inks->guard.message;
    if (!inks->fault)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: %s%s%s", path, inks->fault, *message ? ": " : "",
                   message);
}

/* Returns true if a file has the signature of an ICC profile, "acsp" at offset 36. */
static bool is_profile(const char *start, size_t count)
{
    return count >= 40 && memcmp(start + 36, "acsp", 4) == 0;
}

Status inks_read(Inks **out, const char *path, InkIntent intent, int bits, Err *err)
{
    /* Output profiles have 0.5 to 3 MB; 64 MB allows for any of them. */
    static const FileForm form = {
        .name = "an ICC profile", .most_bytes = 64e6, .begins = is_profile};
    Inks *inks = NULL;
    char *bytes = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&inks, 1, sizeof *inks, "profiles", err));
    inks->bits = bits;
    inks->intent = intent;
    TRY_GOTO(file_read(path, &form, &bytes, &inks->profile.size, err));
    inks->profile.bytes = (uint8_t *)bytes;
    TRY_GOTO(prepare(inks, path, err));
    *out = inks;
    return STATUS_OK;
done:
    inks_free(inks);
    return status;
}

/* A context of Little CMS whose guard was left is in an undefined state. It is not released, and
 * its memory leaks. */
void inks_free(Inks *inks)
{
    if (!inks)
        return;
    if (inks->transform && !inks->guard.failed)
        cmsDeleteTransform(inks->transform);
    if (inks->context && !inks->guard.failed)
        cmsDeleteContext(inks->context);
    free(inks->profile.bytes);
    free(inks);
}

void inks_convert(const Inks *inks, const void *rgb, void *cmyk, size_t n)
{
    cmsDoTransform(inks->transform, rgb, cmyk, (cmsUInt32Number)n);
}

const void *inks_profile(const Inks *inks, size_t *size)
{
    *size = inks->profile.size;
    return inks->profile.bytes;
}

int inks_bits(const Inks *inks)
{
    return inks->bits;
}
