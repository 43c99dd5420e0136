/* Converts the RGB colors of a PDF or an EPS that cairo wrote to CMYK, and adds the output profile
 * to a PDF.
 *
 * cairo writes a list of objects and a cross-reference table, without object streams. Three
 * constructs contain colors: the operators rg and RG of content streams, the pixels of images, and
 * the entries C0 and C1 of the functions of gradients. Each object is copied with its colors
 * converted, and a new cross-reference table is written. */
#include "figure/pdf_inks.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* The file that is converted. */
typedef struct PdfFile {
    const Inks *inks;
    bool is_eps;
    const char *pdf; /* terminated by a zero byte, as all strings below */
    size_t length;
    Text out;
} PdfFile;

static Status conversion_error(const char *what, Err *err)
{
    return err_set(err, STATUS_IO, "the page: cairo's file cannot be converted to inks: %s", what);
}

/* Returns true if the text at `at` begins with `word`. */
static bool begins(const char *at, const char *word)
{
    return strncmp(at, word, strlen(word)) == 0;
}

/* ---- colors ---------------------------------------------------------------------------------- */

/* Appends the inks of a color as four numbers. With `black_ink_only`, black becomes black ink only.
 */
static void put_inks(const PdfFile *file, const double rgb[3], bool black_ink_only, Text *out)
{
    uint8_t codes[3], cmyk[4];
    for (int c = 0; c < 3; c++)
        codes[c] = (uint8_t)lround(255 * fmin(1, fmax(0, rgb[c])));
    inks_convert(file->inks, codes, cmyk, 1);
    if (black_ink_only && codes[0] + codes[1] + codes[2] == 0)
        text_puts(out, "0 0 0 1");
    else
        for (int c = 0; c < 4; c++)
            text_printf(out, c ? " %.4g" : "%.4g", cmyk[c] / 255.0);
}

/* Returns the position after a string in parentheses that begins at `at`. */
static const char *skip_string(const char *at)
{
    int depth = 0;
    do {
        depth += *at == '(' ? 1 : *at == ')' ? -1 : 0;
        at += *at == '\\' && at[1] ? 2 : 1;
    } while (*at && depth > 0);
    return at;
}

/* Appends a content stream, or the operators of an EPS, with rg and RG replaced by the operators of
 * CMYK. Strings are copied unchanged, because a text may contain the letters of an operator, and so
 * are the comments of an EPS. */
static void put_content(const PdfFile *file, const char *content, Text *out)
{
    const char *copied = content, *number[3] = {0};
    for (const char *at = content; *at;) {
        if (*at == '(' || (*at == '%' && file->is_eps)) {
            at = *at == '(' ? skip_string(at) : at + strcspn(at, "\n");
            continue;
        }
        const size_t length = strcspn(at, " \r\n\t([<>/");
        const bool fill = length == 2 && begins(at, "rg");
        if ((fill || (length == 2 && begins(at, "RG"))) && number[0]) {
            const double rgb[3] = {atof(number[0]), atof(number[1]), atof(number[2])};
            text_append(out, copied, (size_t)(number[0] - copied));
            put_inks(file, rgb, true, out);
            text_puts(out, file->is_eps ? " setcmykcolor" : fill ? " k" : " K");
            copied = at + length;
        }
        if (length > 0) {
            const bool is_number = isdigit((unsigned char)*at) || *at == '-' || *at == '.';
            number[0] = is_number ? number[1] : NULL;
            number[1] = is_number ? number[2] : NULL;
            number[2] = is_number ? at : NULL;
        }
        at += length > 0 ? length : 1;
    }
    text_puts(out, copied);
}

/* Appends the dictionary of an object, `length` bytes, with its RGB colors and color spaces
 * replaced by CMYK. */
static void put_dictionary(const PdfFile *file, const char *at, size_t length, Text *out)
{
    static const char rgb_space[] = "/DeviceRGB", jpeg_filter[] = "/DCTDecode";
    static const char rgb_range[] = "/Decode [ 0 1 0 1 0 1 ]";
    for (const char *end = at + length; at < end;) {
        double rgb[3];
        int taken = 0;
        if (begins(at, rgb_space)) {
            text_puts(out, "/DeviceCMYK");
            at += sizeof rgb_space - 1;
        } else if (begins(at, jpeg_filter)) {
            text_puts(out, "/FlateDecode"); /* put_deflated writes this compression */
            at += sizeof jpeg_filter - 1;
        } else if (begins(at, rgb_range)) {
            text_puts(out, "/Decode [ 0 1 0 1 0 1 0 1 ]");
            at += sizeof rgb_range - 1;
        } else if ((begins(at, "/C0 [") || begins(at, "/C1 [")) &&
                   sscanf(at + 5, "%lf %lf %lf ]%n", &rgb[0], &rgb[1], &rgb[2], &taken) == 3 &&
                   taken > 0) {
            text_append(out, at, 5);
            text_puts(out, " ");
            put_inks(file, rgb, false, out);
            text_puts(out, " ]");
            at += 5 + taken;
        } else {
            text_append(out, at++, 1);
        }
    }
}

/* ---- streams --------------------------------------------------------------------------------- */

/* Decompresses a stream. The caller frees *out. The buffer begins at four times the stream plus 1
 * KB, enough for most content streams, and grows until the result fits. A smaller buffer would be
 * tried in vain more often; a larger one takes more memory than most streams need. */
static Status inflate_all(const char *from, size_t n, char **out, size_t *size, Err *err)
{
    for (size_t capacity = 4 * n + 1024;; capacity *= 4) {
        char *bytes;
        TRY(mem_calloc(&bytes, capacity + 1, 1, "the page", err));
        uLongf made = capacity;
        const int code = uncompress((Bytef *)bytes, &made, (const Bytef *)from, n);
        if (code == Z_OK) {
            *out = bytes;
            *size = made;
            return STATUS_OK;
        }
        free(bytes);
        if (code != Z_BUF_ERROR)
            return conversion_error("a stream cannot be decompressed", err);
    }
}

/* Appends bytes in zlib's format. */
static Status put_deflated(const char *bytes, size_t n, Text *out, Err *err)
{
    uLongf size = compressBound(n);
    char *packed;
    TRY(mem_calloc(&packed, size, 1, "the page", err));
    const int code = compress((Bytef *)packed, &size, (const Bytef *)bytes, n);
    if (code == Z_OK)
        text_append(out, packed, size);
    free(packed);
    return code == Z_OK ? text_check(out, err) : mem_out_of("for", "the page", err);
}

/* Appends the converted content of a stream, deflated: the pixels of an image, or the operators of
 * a content stream. */
static Status put_colors(const PdfFile *file, bool image, const char *bytes, size_t size,
                         Text *packed, Err *err)
{
    Text plain = TEXT_INIT;
    char *cmyk = NULL;
    Status status;
    if (image) {
        TRY_GOTO(mem_calloc(&cmyk, size / 3 + 1, 4, "the page", err));
        inks_convert(file->inks, bytes, cmyk, size / 3);
        status = put_deflated(cmyk, size / 3 * 4, packed, err);
    } else {
        put_content(file, bytes, &plain);
        TRY_GOTO(text_check(&plain, err));
        status = put_deflated(text_chars(&plain), plain.length, packed, err);
    }
done:
    text_release(&plain);
    free(cmyk);
    return status;
}

/* Returns true if `word` is between `from` and `to`. */
static bool has(const char *from, const char *to, const char *word)
{
    return memmem(from, (size_t)(to - from), word, strlen(word)) != NULL;
}

/* Decodes a JPEG to 8-bit codes of three channels. The caller frees *out. */
static Status decode_jpeg(const char *from, size_t n, char **out, size_t *size, Err *err)
{
    Image image;
    TRY(image_decode(&image, "a JPEG of a .pdf panel", from, n, ALPHA_REFUSED, err));
    if (image.picture.channels != 3 || !image.picture.codes8) {
        image_release(&image);
        return conversion_error("a JPEG declared as RGB does not have three channels of 8 bits",
                                err);
    }
    *size = picture_stride(&image.picture) * (size_t)image.picture.height;
    *out = (char *)image.picture.codes8;
    return STATUS_OK;
}

/* Appends a stream with its colors converted, preceded by its dictionary with the new length. */
static Status put_stream(PdfFile *file, const char *dictionary, const char *stream, const char *end,
                         Err *err)
{
    const bool image = has(dictionary, stream, "/Subtype /Image");
    char *bytes = NULL;
    size_t size = 0;
    Text packed = TEXT_INIT;
    Status status;
    stream += strlen("stream\n");
    TRY((has(dictionary, stream, "/DCTDecode") ? decode_jpeg : inflate_all)(
        stream, (size_t)(end - stream), &bytes, &size, err));
    TRY_GOTO(put_colors(file, image, bytes, size, &packed, err));
    const char *length = strstr(dictionary, "/Length ");
    put_dictionary(file, dictionary, (size_t)(length - dictionary), &file->out);
    text_printf(&file->out, "/Length %zu", packed.length);
    length += strlen("/Length ");
    length += strcspn(length, "\n/>");
    put_dictionary(file, length, (size_t)(stream - length), &file->out);
    text_append(&file->out, text_chars(&packed), packed.length);
    text_puts(&file->out, "\nendstream\n");
done:
    text_release(&packed);
    free(bytes);
    return status;
}

/* ---- objects --------------------------------------------------------------------------------- */

/* Returns true if a stream with this dictionary is a font program: cairo embeds TrueType and Type 1
 * fonts (Length1) and CFF fonts (Type1C, CIDFontType0C). */
static bool is_font(const char *dictionary, const char *end)
{
    return has(dictionary, end, "/Length1") || has(dictionary, end, "Type0C") ||
           has(dictionary, end, "Type1C");
}

/* Appends the body of an object, which ends at `end`. Fonts, and images that are not RGB, are
 * copied unchanged. */
static Status put_object(PdfFile *file, const char *body, const char *end, Err *err)
{
    const char *stream = memmem(body, (size_t)(end - body), "stream\n", strlen("stream\n"));
    if (!stream) {
        put_dictionary(file, body, (size_t)(end - body), &file->out);
        return STATUS_OK;
    }
    const bool image = has(body, stream, "/Subtype /Image");
    const bool colors = image ? has(body, stream, "/DeviceRGB")
                              : !is_font(body, stream) && has(body, stream, "/Length ");
    const char *last = end;
    while (last > stream && !begins(last, "\nendstream"))
        last--;
    if (last == stream)
        return conversion_error("a stream has no end", err);
    if (colors)
        return put_stream(file, body, stream, last, err);
    text_append(&file->out, body, (size_t)(end - body));
    return STATUS_OK;
}

/* Appends the output profile as object `number`. Sets *offset to its offset in the new file. After
 * an error, the object is incomplete, and the caller drops the file. */
static Status put_profile(PdfFile *file, size_t number, size_t *offset, Err *err)
{
    size_t size;
    const void *profile = inks_profile(file->inks, &size);
    Text packed = TEXT_INIT;
    *offset = file->out.length;
    Status status = put_deflated(profile, size, &packed, err);
    text_printf(&file->out,
                "%zu 0 obj\n<< /N 4\n   /Length %zu\n   /Filter /FlateDecode\n>>\nstream\n", number,
                packed.length);
    text_add(&file->out, &packed);
    text_puts(&file->out, "\nendstream\nendobj\n");
    text_release(&packed);
    return status;
}

typedef struct PdfObject {
    size_t old_offset, new_offset; /* in the file of cairo, and in the converted file */
} PdfObject;

/* Appends all objects with their colors converted, and the profile as a further object. The offsets
 * are not sorted, so the end of an object is found as the last "endobj" before the next larger
 * offset. The catalog gets an entry that refers to the profile. */
static Status put_objects(PdfFile *file, PdfObject *object, size_t n, Err *err)
{
    for (size_t i = 1; i < n; i++) {
        const char *at = file->pdf + object[i].old_offset, *body = strstr(at, " obj\n");
        size_t next = file->length;
        for (size_t k = 1; k < n; k++)
            if (object[k].old_offset > object[i].old_offset && object[k].old_offset < next)
                next = object[k].old_offset;
        const char *end = file->pdf + next;
        while (body && end > body && !begins(end, "endobj"))
            end--;
        if (!body || end <= body)
            return conversion_error("an object has no end", err);
        object[i].new_offset = file->out.length;
        text_printf(&file->out, "%zu 0 obj\n", i);
        body += strlen(" obj\n");
        if (has(body, end, "/Type /Catalog"))
            text_printf(&file->out,
                        "<< /OutputIntents [ << /Type /OutputIntent /S /GTS_PDFX\n"
                        "   /OutputConditionIdentifier (Custom) /DestOutputProfile %zu 0 R >> ]\n",
                        n);
        /* The "<<" of the catalog is already written, before /OutputIntents. */
        body += has(body, end, "/Type /Catalog") ? strlen("<<") : 0;
        TRY(put_object(file, body, end, err));
        text_puts(&file->out, "endobj\n");
    }
    return put_profile(file, n, &object[n].new_offset, err);
}

/* Appends the cross-reference table and the trailer, which refers to the document's catalog. */
static void put_table(PdfFile *file, const PdfObject *object, size_t n, const char *trailer)
{
    const size_t at = file->out.length;
    text_printf(&file->out, "xref\n0 %zu\n0000000000 65535 f \n", n + 1);
    for (size_t i = 1; i <= n; i++)
        text_printf(&file->out, "%010zu 00000 n \n", object[i].new_offset);
    const char *root = strstr(trailer, "/Root");
    text_printf(&file->out, "trailer\n<< /Size %zu\n   %.*s>>\nstartxref\n%zu\n%%%%EOF\n", n + 1,
                root ? (int)strcspn(root, ">") : 0, root ? root : "", at);
}

/* Reads the cross-reference table of the file, to which its end refers, and writes the new file:
 * the two lines of the header, the objects, the new table. */
static Status convert_pdf(PdfFile *file, Err *err)
{
    PdfObject *object = NULL;
    /* start: the line "startxref"; first: the table's first row, after two lines of its own */
    const char *start = NULL, *first, *trailer;
    size_t n = 0, at = 0;
    Status status;
    for (const char *c = file->pdf + file->length; c > file->pdf && !start; c--)
        start = begins(c, "startxref\n") ? c : NULL;
    if (!start || sscanf(start, "startxref %zu", &at) != 1 || at >= file->length ||
        sscanf(file->pdf + at, "xref 0 %zu", &n) != 1 || n < 2 || n > file->length)
        return conversion_error("it has no cross-reference table", err);
    first = strchr(strchr(file->pdf + at, '\n') + 1, '\n') + 1;
    trailer = strstr(first, "trailer");
    TRY(mem_calloc(&object, n + 1, sizeof *object, "the page", err));
    for (size_t i = 0; i < n; i++) /* a line of the table has 20 bytes */
        object[i].old_offset = strtoul(first + 20 * i, NULL, 10);
    text_append(&file->out, file->pdf,
                (size_t)(strchr(strchr(file->pdf, '\n') + 1, '\n') + 1 - file->pdf));
    TRY_GOTO(put_objects(file, object, n, err));
    put_table(file, object, n, trailer ? trailer : "");
done:
    free(object);
    return status;
}

/* ---- EPS ------------------------------------------------------------------------------------- */

/* Appends the first n bytes of a group of four. */
static void put_group(uint64_t group, int n, char *out, size_t *size)
{
    for (int k = 0; k < n; k++)
        out[(*size)++] = (char)(group >> (24 - 8 * k));
}

/* Decodes ASCII85 up to `end`: five characters are four bytes, z is four zero bytes, and a last
 * group of n characters, padded with u, is n - 1 bytes. The caller frees *out. */
static Status decode_ascii85(const char *at, const char *end, char **out, size_t *size, Err *err)
{
    uint64_t group = 0;
    int n = 0;
    *size = 0;
    TRY(mem_calloc(out, 4 * (size_t)(end - at) + 4, 1, "the page", err));
    for (; at < end; at++) {
        if (*at == 'z')
            put_group(0, 4, *out, size);
        if (*at < '!' || *at > 'u')
            continue;
        group = 85 * group + (uint64_t)(*at - '!');
        if (++n < 5)
            continue;
        put_group(group, 4, *out, size);
        group = 0;
        n = 0;
    }
    for (int k = n; k < 5; k++)
        group = 85 * group + 84;
    put_group(group, n - 1, *out, size);
    return STATUS_OK;
}

/* Appends bytes as ASCII85: 15 groups of five characters per line. */
static void put_ascii85(const char *bytes, size_t size, Text *out)
{
    for (size_t i = 0; i < size; i += 4) {
        const size_t n = size - i < 4 ? size - i : 4;
        uint32_t group = 0;
        char digits[5];
        for (size_t k = 0; k < 4; k++)
            group = group << 8 | (k < n ? (uint8_t)bytes[i + k] : 0);
        for (int k = 4; k >= 0; k--, group /= 85)
            digits[k] = (char)('!' + group % 85);
        text_append(out, digits, n + 1);
        if (i / 4 % 15 == 14)
            text_puts(out, "\n");
    }
    text_puts(out, "~>");
}

/* Appends the operators of an EPS from `at` to `end`. */
static Status put_operators(PdfFile *file, const char *at, const char *end, Err *err)
{
    Text converted = TEXT_INIT;
    Status status;
    put_dictionary(file, at, (size_t)(end - at), &converted);
    TRY_GOTO(text_check(&converted, err));
    put_content(file, text_chars(&converted), &file->out);
done:
    text_release(&converted);
    return status;
}

/* Appends the converted pixels of an image, which are between `at` and `end`. */
static Status put_pixels(PdfFile *file, const char *at, const char *end, Err *err)
{
    char *packed = NULL, *codes = NULL;
    size_t size = 0, n_codes = 0;
    Text inks = TEXT_INIT;
    Status status;
    TRY_GOTO(decode_ascii85(at, end, &packed, &size, err));
    TRY_GOTO(inflate_all(packed, size, &codes, &n_codes, err));
    TRY_GOTO(put_colors(file, true, codes, n_codes, &inks, err));
    put_ascii85(text_chars(&inks), inks.length, &file->out);
done:
    text_release(&inks);
    free(packed);
    free(codes);
    return status;
}

/* Returns true if the last color space that is set between `at` and `end` is RGB. */
static bool is_rgb_image(const char *at, const char *end)
{
    const char *rgb = NULL;
    for (; at < end; at++)
        if (begins(at, "/Device"))
            rgb = begins(at, "/DeviceRGB") ? at : NULL;
    return rgb;
}

/* Converts an EPS: operators up to an image, the pixels of the image, operators up to the next
 * image, and so on. */
static Status convert_eps(PdfFile *file, Err *err)
{
    static const char before[] = "\ncairo_image\n",
                      source[] = "/DataSource cairo_ascii85_file /Flate";
    const char *at = file->pdf, *image;
    while ((image = strstr(at, before)) != NULL) {
        const char *pixels = image + strlen(before), *end = strstr(pixels, "~>");
        if (!end || !has(at, image, source))
            return conversion_error("an image is not compressed as expected", err);
        const bool is_rgb = is_rgb_image(at, image);
        TRY(put_operators(file, at, pixels, err));
        if (is_rgb)
            TRY(put_pixels(file, pixels, end, err));
        else
            text_append(&file->out, pixels, (size_t)(end + 2 - pixels));
        at = end + 2;
    }
    return put_operators(file, at, file->pdf + file->length, err);
}

Status page_to_inks(const Inks *inks, bool is_eps, Text *page, Err *err)
{
    PdfFile file = {inks, is_eps, text_chars(page), page->length, TEXT_INIT};
    Status status;
    TRY_GOTO(text_check(page, err));
    TRY_GOTO(is_eps ? convert_eps(&file, err) : convert_pdf(&file, err));
    TRY_GOTO(text_check(&file.out, err));
    text_clear(page);
    text_add(page, &file.out);
    status = text_check(page, err);
done:
    text_release(&file.out);
    return status;
}
