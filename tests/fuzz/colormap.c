#include "fuzz.h"

#include "image/image.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file("map.txt", bytes, size);
    Colormap map;
    Err err = {{0}};
    Status status = colormap_read(&map, path, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return 0;
    for (int i = -1; i <= 4; i++) {
        float rgb[3];
        colormap_linear(&map, i / 3.0, rgb);
        for (int c = 0; c < 3; c++)
            assert(rgb[c] >= 0 && rgb[c] <= 1);
    }
    for (size_t i = 0; i <= map.n; i += map.n) {
        float rgb[3];
        colormap_color(&map, i, rgb);
        assert(rgb[0] >= 0 && rgb[0] <= 1);
    }
    colormap_release(&map);
    return 0;
}
