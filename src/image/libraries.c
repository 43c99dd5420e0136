/* Asked of the libraries themselves, as they are loaded; libdeflate alone tells its version only
 * when it is compiled against. */
#include "image/image.h"

#include <libdeflate.h>
#include <openexr_base.h>
#include <png.h>
#include <tiffio.h>

void image_put_libraries(Text *text)
{
    int major, minor, patch;
    const char *extra;
    const char *tiff = TIFFGetVersion(); /* "LIBTIFF, Version 4.5.0\n..." */
    tiff += strcspn(tiff, "0123456789");
    exr_get_library_version(&major, &minor, &patch, &extra);
    text_printf(text, "libpng %s, libdeflate " LIBDEFLATE_VERSION_STRING ", libtiff %.*s, ",
                png_get_libpng_ver(NULL), (int)strspn(tiff, "0123456789."), tiff);
    text_printf(text, "OpenEXR %d.%d.%d", major, minor, patch);
}
