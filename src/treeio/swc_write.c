#include "treeio/swc.h"

/* Lines in order, known keys from their fields; then the known fields that no line names. */
static void write_header(const TreeHeader *header, FILE *stream)
{
    bool written[SWC_N_KEYS] = {false};
    for (size_t i = 0; i < header->n_lines; i++) {
        const char *line = header->lines[i];
        int key = swc_key_of_line(line);
        if (key == SWC_NO_KEY)
            fprintf(stream, *line ? "# %s\n" : "#%s\n", line);
        else if (swc_key_known(header, key) && !written[key])
            swc_key_write(header, key, stream);
        if (key != SWC_NO_KEY)
            written[key] = true;
    }
    for (int key = 0; key < SWC_N_KEYS; key++)
        if (swc_key_known(header, key) && !written[key])
            swc_key_write(header, key, stream);
}

static void write_row(const Tree *tree, size_t i, FILE *stream)
{
    char x[NUMBER_TEXT_SIZE], y[NUMBER_TEXT_SIZE], z[NUMBER_TEXT_SIZE], radius[NUMBER_TEXT_SIZE];
    Vec3 position = tree->position[i];
    int32_t parent = tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : -1;
    fprintf(stream, "%d %d %s %s %s %s %d\n", tree->id[i], tree->type[i],
            number_text(position.x, x), number_text(position.y, y), number_text(position.z, z),
            number_text(tree->radius_mm[i], radius), parent);
}

Status swc_write(const Tree *tree, const char *path, Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    write_header(&tree->header, file.stream);
    swc_flow_shares_write(tree, file.stream);
    for (size_t i = 0; i < tree->n; i++)
        write_row(tree, i, file.stream);
    return outfile_commit(&file, err);
}
