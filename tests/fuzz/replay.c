/* Passes the files of a folder to a harness: replay FOLDER. Prints each name first, so the last
 * name printed is the file that broke the harness. */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>

static const FileForm any = {.name = "a file of a corpus", .most_bytes = 1e7};

int main(int argc, char **argv)
{
    struct dirent **entries = NULL;
    int n = argc == 2 ? scandir(argv[1], &entries, NULL, alphasort) : -1;
    if (n <= 2) {
        fprintf(stderr, "usage: replay FOLDER, which holds the files\n");
        return 2;
    }
    for (int i = 0; i < n; i++) {
        char *path = NULL, *bytes = NULL;
        size_t size;
        Err err;
        if (entries[i]->d_name[0] != '.') {
            fprintf(stderr, "%s/%s\n", argv[1], entries[i]->d_name);
            if (file_join(argv[1], entries[i]->d_name, &path, &err) != STATUS_OK ||
                file_read(path, &any, &bytes, &size, &err) != STATUS_OK) {
                fprintf(stderr, "%s\n", err.text);
                return 2;
            }
            LLVMFuzzerTestOneInput((const uint8_t *)bytes, size);
        }
        free(path);
        free(bytes);
        free(entries[i]);
    }
    free(entries);
    return 0;
}
