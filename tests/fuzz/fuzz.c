#include "fuzz.h"

#include "image/image.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <unistd.h>

static char folder[64];

static void remove_folder(void)
{
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0)
        fprintf(stderr, "%s stays\n", folder);
}

const char *fuzz_file(const char *name, const void *bytes, size_t size)
{
    static char path[128];
    if (!*folder) {
        strcpy(folder, access("/dev/shm", W_OK) == 0 ? "/dev/shm/corcast-fuzz-XXXXXX"
                                                     : "/tmp/corcast-fuzz-XXXXXX");
        if (!mkdtemp(folder))
            abort();
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        abort();
    return path;
}

FuzzPart fuzz_part(const uint8_t **bytes, size_t *size)
{
    const uint8_t *zero = *size ? memchr(*bytes, '\0', *size) : NULL;
    FuzzPart part = {*bytes, zero ? (size_t)(zero - *bytes) : *size};
    size_t skip = part.size + (zero != NULL);
    *bytes += skip;
    *size -= skip;
    return part;
}

void fuzz_check_refusal(Status status, const Err *err, const char *path)
{
    if (status == STATUS_OK)
        return;
    assert(status_exit(status) >= 2);
    if (!strstr(err->text, path))
        fprintf(stderr, "%s\n", err->text);
    assert(strstr(err->text, path));
}

/* Reads a picture row by row. The codes must equal those of the picture read as a whole. */
static void read_by_rows(const char *path, const Picture *whole)
{
    Err err = {{0}};
    ImageReader *reader;
    Picture row;
    Status status = imagereader_open(&reader, path, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return;
    const ImageForm *form = imagereader_form(reader);
    status = picture_init(&row, form->width, 1, form->channels, form->bits, &err);
    assert(status == STATUS_OK);
    for (int y = 0; y < form->height && y < 5000 && status == STATUS_OK; y++) {
        status = imagereader_codes(reader, &row, &err);
        fuzz_check_refusal(status, &err, path);
        if (status != STATUS_OK || whole->channels != row.channels)
            continue;
        assert(whole->width == row.width && whole->bits == row.bits);
        for (size_t i = 0; i < picture_stride(&row); i++)
            assert(picture_code(&row, i) ==
                   picture_code(whole, (size_t)y * picture_stride(whole) + i));
    }
    picture_release(&row);
    imagereader_close(reader);
}

void fuzz_image(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file("picture", bytes, size);
    Err err = {{0}};
    Image image;
    Status status = image_read(&image, path, ALPHA_REFUSED, NULL, &err);
    fuzz_check_refusal(status, &err, path);
    const Picture none = {0};
    read_by_rows(path, status == STATUS_OK ? &image.picture : &none);
    if (status == STATUS_OK)
        image_release(&image);
}
