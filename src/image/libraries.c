/* Lists the image libraries and their versions, for --version. The versions are those of the
 * libraries that are loaded at run time. libdeflate and libjpeg report only the version that the
 * program was compiled with. */
#include "image/image.h"

#include <OpenEXR/openexr_base.h>
#include <jpeglib.h>
#include <lcms2.h>
#include <libdeflate.h>
#include <png.h>
#include <tiffio.h>
#include <webp/decode.h>

#define QUOTED(word) #word
#define TEXT_OF(macro) QUOTED(macro)

void image_put_libraries(Text *text)
{
    int major, minor, patch;
    const char *extra;
    const char *tiff = TIFFGetVersion(); /* "LIBTIFF, Version 4.5.0\n..." */
    tiff += strcspn(tiff, "0123456789");
    exr_get_library_version(&major, &minor, &patch, &extra);
    /* The name and the version of libdeflate are not one string in the program: package checkers
     * would take that string for a sign of an embedded zlib. */
    text_printf(text, "libpng %s, libdeflate %s, libtiff %.*s, ", png_get_libpng_ver(NULL),
                LIBDEFLATE_VERSION_STRING, (int)strspn(tiff, "0123456789."), tiff);
    int lcms = cmsGetEncodedCMMversion(); /* 2140 */
    text_puts(text, "libjpeg-turbo " TEXT_OF(LIBJPEG_TURBO_VERSION) ", ");
    int webp = WebPGetDecoderVersion(); /* 0x010204 */
    text_printf(text, "libwebp %d.%d.%d, ", webp >> 16, webp >> 8 & 255, webp & 255);
    text_printf(text, "lcms2 %d.%d, ", lcms / 1000, lcms % 1000 / 10);
    text_printf(text, "OpenEXR %d.%d.%d", major, minor, patch);
}
